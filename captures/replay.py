"""RenderDoc's replay of one capture: its draws, their vertices after the vertex shader, textures and constants.

Everything that this package knows of RenderDoc's state stands here. Conventions, for every API:
rows of an image start at the bottom, y of clip space grows upwards, matrices multiply column vectors.
"""
import functools
import os

import numpy as np
import renderdoc as rd

NULL = rd.ResourceId.Null()
MOST_INSTANCES = 4096  # of one draw; GetPostVSData is one call for each
KILLS = [1 << 16 | code for code in (252, 4416, 5380)]  # of SPIR-V: OpKill, OpTerminateInvocation, OpDemoteToHelper
STAGES = (rd.ShaderStage.Vertex, rd.ShaderStage.Pixel)


class Refusal(Exception):
    """The capture cannot be judged; the text says why and what to do."""


def walk(items, inside):
    """All items of a tree, each before those inside it."""
    for item in items:
        yield item
        yield from walk(inside(item), inside)


class Draw:
    """A draw call, and the state that it is made in."""

    def __init__(self, action, state, capture):
        self.event, self.count, self.name = action.eventId, action.numIndices, f'draw {action.eventId}'
        self.index = (NULL, 0, 0, action.vertexOffset)  # buffer, byte offset, bytes of an index, what is added to each
        buffers, inputs = state.GetVBuffers(), state.GetVertexInputs()
        mesh = [(b.resourceId, b.byteOffset) for b in buffers[inputs[0].vertexBuffer:][:1]] if len(inputs) else []
        if action.flags & rd.ActionFlags.Indexed:
            buffer = state.GetIBuffer()
            offset = buffer.byteOffset + action.indexOffset * buffer.byteStride
            mesh = self.index = (buffer.resourceId, offset, buffer.byteStride, action.baseVertex)
        self.instances = max(1, action.numInstances)
        self.geometry = (*mesh, action.vertexOffset, self.count, self.instances)  # equal in every pass that draws the same mesh
        is_last = all(state.GetShader(stage) == NULL for stage in (rd.ShaderStage.Geometry, rd.ShaderStage.Tess_Eval))
        self.stage = rd.MeshDataStage.VSOut if is_last else rd.MeshDataStage.GSOut
        while action.parent and action.parent.flags & rd.ActionFlags.MultiAction:
            action = action.parent  # of a draw out of a call for several RenderDoc counts on from the call's own place
        self.chunk = action.events[-1].chunkIndex  # of the capture's list of calls
        self.reads = set()  # textures, only those that its shaders use: OpenGL's others are bound by chance
        for stage in STAGES:
            used = {(p.bindset, p.bind) for p in state.GetBindpointMapping(stage).readOnlyResources if p.used}
            self.reads |= {r.resourceId for b in state.GetReadOnlyResources(stage) for r in b.resources
                           if r.resourceId != NULL and (b.bindPoint.bindset, b.bindPoint.bind) in used}
        depths, colours = (  # each (texture, slice, mip)
            [(t.resourceId, max(0, t.firstSlice), max(0, t.firstMip)) for t in targets if t.resourceId != NULL]
            for targets in ([state.GetDepthTarget()], state.GetOutputTargets()))
        self.depth, self.outputs = tuple(*depths), tuple(colours)  # () without any
        gl, view = capture.gl, state.GetViewport(0)
        own = capture.control.GetGLPipelineState() if gl else capture.control.GetVulkanPipelineState()
        raster, test = (own.rasterizer.state, own.depthState) if gl else (own.rasterizer, own.depthStencil)
        self.writes_depth = test.depthEnable and test.depthWrites if gl else test.depthTestEnable and test.depthWriteEnable
        self.zero_to_one = not (gl and own.vertexProcessing.clipNegativeOneToOne)  # depths of clip space
        self.y_down = not gl and view.height > 0
        self.samples, bottom = 1, view.y
        for texture, _, mip in (colours + depths)[:1]:
            self.samples = max(1, capture.textures[texture].msSamp)
            bottom = view.y if gl else (capture.textures[texture].height >> mip) - max(view.y, view.y + view.height)
        self.viewport = (view.x, bottom, view.width, abs(view.height))  # pixels, from the bottom
        self.reversed = test.depthFunction in (rd.CompareFunction.Greater, rd.CompareFunction.GreaterEqual)
        self.polygon_offset = raster.slopeScaledDepthBias, raster.depthBias  # factor, units
        # Whether the triangles that are not drawn turn counterclockwise on the screen; None where all are drawn.
        self.culls_ccw = {rd.CullMode.Front: bool(raster.frontCCW), rd.CullMode.Back: not raster.frontCCW}.get(raster.cullMode)
        pixel = rd.ShaderStage.Pixel
        self.shader = f'{capture.names.get(state.GetShader(pixel), "")} {state.GetShaderEntryPoint(pixel)}()'  # as the debugger shows it
        reflection = state.GetShaderReflection(pixel)
        code, of_binary = (bytes(reflection.rawBytes), reflection.encoding == rd.ShaderEncoding.SPIRV) if reflection else (b'', False)
        self.discards = np.isin(rows_of(code, '<u4', 1), KILLS).any() if of_binary else b'discard' in code


class Capture:
    """An open capture."""

    def __init__(self, path):
        self.path, self.file, self.event = path, rd.OpenCaptureFile(), None
        result = self.file.OpenFile(path, '', None)
        if result.code != rd.ResultCode.Succeeded:
            raise Refusal(f'RenderDoc does not read it: {result.Message()}')
        result, self.control = self.file.OpenCapture(rd.ReplayOptions(), None)
        if self.control is None:
            raise Refusal(f'RenderDoc cannot replay it on this machine: {result.Message()}')
        self.gl = self.control.GetAPIProperties().pipelineType == rd.GraphicsAPI.OpenGL
        self.textures = {t.resourceId: t for t in self.control.GetTextures()}
        self.names = {r.resourceId: r.name for r in self.control.GetResources()}

    def at(self, event):
        """The state of the pipeline at this event."""
        if event != self.event:
            self.control.SetFrameEvent(event, True)
            self.event = event
        return self.control.GetPipelineState()

    # ---- draws and their state
    def actions(self, flags):
        return [a for a in walk(self.control.GetRootActions(), lambda action: action.children) if a.flags & flags]

    @functools.cached_property
    def draws(self):
        return [Draw(a, self.at(a.eventId), self) for a in self.actions(rd.ActionFlags.Drawcall)]

    @functools.cached_property
    def drawn_into(self):
        """Textures."""
        return {target[0] for d in self.draws for target in (d.depth, *d.outputs) if target}

    # ---- vertices
    def _rows(self, kind, columns, *buffer):
        return rows_of(self.control.GetBufferData(*buffer), kind, columns)

    def _corners(self, topology, count, restart, buffer, offset, width, base):
        """The vertices of the triangles, three in a row. restart: the index that begins a new strip, -1 without one."""
        index = at = np.arange(count)
        if buffer != NULL and width:
            index = self._rows(f'<u{width}', 1, buffer, offset, count * width)[:, 0].astype('i8')
            at, restart = at[:len(index)], restart & (1 << 8 * width) - 1 if restart > 0 else -1
        start = np.maximum.accumulate(np.where(index == restart, at + 1, 0))
        i, odd = at[:-2], ((at - start) % 2)[:-2]
        rows = {rd.Topology.TriangleList: at[:len(at) // 3 * 3].reshape(-1, 3),
                rd.Topology.TriangleStrip: np.stack([i + odd, i + 1 - odd, i + 2], 1),
                rd.Topology.TriangleFan: np.stack([start[:-2], i + 1, i + 2], 1)}.get(topology, np.zeros((0, 3), int))
        corners = index[rows]
        return corners[(corners != restart).all(1)].reshape(-1) + base

    @functools.cache
    def after_vertex_shader(self, draw):
        """(clip positions, all that the shader writes behind them), three rows for each triangle of each instance."""
        self.at(draw.event)
        found, instances = [], draw.instances
        if instances > MOST_INSTANCES:
            print(f'{draw.name} has {instances} instances where {MOST_INSTANCES} are read; this draw is left out')
            instances = 0
        for instance in range(instances):
            mesh = self.control.GetPostVSData(instance, 0, draw.stage)
            if mesh.vertexResourceId == NULL or mesh.numIndices == 0:
                continue
            rows = self._rows('<f4', mesh.vertexByteStride // 4, mesh.vertexResourceId, mesh.vertexByteOffset, 0)
            index = self._corners(mesh.topology, mesh.numIndices, mesh.restartIndex if mesh.allowRestart else -1,
                                  mesh.indexResourceId, mesh.indexByteOffset, mesh.indexByteStride, mesh.baseVertex)
            found.append(rows[np.clip(index, 0, len(rows) - 1)])
        rows = np.concatenate(found) if found else np.zeros((0, 4))
        return rows[:, :4] * np.array([1, -1 if draw.y_down else 1, 1, 1.0]), rows[:, 4:]

    def clip(self, draw):
        return self.after_vertex_shader(draw)[0]

    def coordinates(self, draw):
        """Of a mask, a row for each of the clip positions: the first output of two floats, or the first such input where RenderDoc reads none."""
        reflection, written, at = self.at(draw.event).GetShaderReflection(rd.ShaderStage.Vertex), self.after_vertex_shader(draw)[1], 0
        for output in reflection.outputSignature if reflection else []:
            found = written[:, at:at + 2]
            if output.compCount == 2 and output.systemValue == rd.ShaderBuiltin.Undefined and found.any():
                return found
            at += 0 if output.systemValue == rd.ShaderBuiltin.Position else output.compCount
        return next((rows[:, :2] for rows in self.vertex_inputs(draw) if not rows[:, 2].any()), written[:, :0])

    def vertex_inputs(self, draw):
        """Each attribute of floats as x, y, z, 1, a row for each of the clip positions. Which one is the place is found by a fit."""
        state, found = self.at(draw.event), []
        restart = state.GetRestartIndex() if state.IsRestartEnabled() else -1
        index = self._corners(state.GetPrimitiveTopology(), draw.count, restart, *draw.index)
        if len(index) != len(self.clip(draw)):
            return found
        for attribute in state.GetVertexInputs():
            form, buffers = attribute.format, state.GetVBuffers()[attribute.vertexBuffer:][:1]
            size, columns = form.compByteWidth, form.compCount
            if attribute.perInstance or form.compType != rd.CompType.Float or columns < 2 or size not in (2, 4):
                continue
            for buffer in (b for b in buffers if b.resourceId != NULL):
                raw = self.control.GetBufferData(buffer.resourceId, buffer.byteOffset + attribute.byteOffset, 0)
                stride = buffer.byteStride or size * columns
                n = (len(raw) - size * columns) // stride + 1
                if n > index.max() >= index.min() >= 0:
                    found.append(np.tile([0, 0, 0, 1.0], (len(index), 1)))
                    found[-1][:, :min(3, columns)] = np.ndarray((n, min(3, columns)), f'<f{size}', raw, strides=(stride, size))[index]
        return found

    # ---- constants
    def matrices(self, draw):
        """[(name, 4 x 4)]: every 16 floats in the constants of the draw's shaders that could be a matrix, as columns."""
        state, found = self.at(draw.event), []
        for stage in STAGES:
            reflection = state.GetShaderReflection(stage)
            for i, block in enumerate(reflection.constantBlocks if reflection else []):
                buffer = state.GetConstantBuffer(stage, i, 0)
                if buffer.resourceId != NULL:
                    rows = self._rows('<f4', 4, buffer.resourceId, buffer.byteOffset, min(buffer.byteSize, 1 << 18)).astype('f8')
                    found += [(f'{block.name}+{16 * k}', rows[k:k + 4].T) for k in range(len(rows) - 3)]
                    continue
                variables = walk(self.control.GetCBufferVariableContents(
                    state.GetGraphicsPipelineObject(), reflection.resourceId, stage, reflection.entryPoint, i, buffer.resourceId, 0, 0),
                    lambda variable: variable.members)
                found += [(v.name, np.array(v.value.f32v[:16], 'f8').reshape(4, 4)) for v in variables if v.rows == 4 == v.columns]
        return [(n, m) for n, m in found if np.isfinite(m).all() and 0 < np.abs(m).max() < 1e7]

    # ---- textures
    def image(self, target, event, viewport=None):
        """float32 height x width x channels of (texture, slice, mip) after the event, or of a part of it; of sample 0."""
        self.at(event)
        texture, part, mip = target
        t = self.textures[texture]
        width, height = max(1, t.width >> mip), max(1, t.height >> mip)
        if t.format.compByteWidth or packed(t.format):
            pixels = decode(self.control.GetTextureData(texture, rd.Subresource(mip, part, 0)), t.format, width, height, self.gl)
            pixels = pixels if self.gl else np.ascontiguousarray(pixels[::-1])
        else:  # compressed in blocks
            pixels = self._unpacked(target, width, height)
        x, y, w, h = map(int, viewport or (0, 0, *pixels.shape[1::-1]))
        return pixels[y:y + h, x:x + w]

    @functools.cache
    def _unpacked(self, target, width, height):
        """Of 8 bits, as RenderDoc decodes a channel into a file: a head of 54 bytes, rows from the bottom, three equal bytes a texel."""
        save, path, channels = rd.TextureSave(), os.path.join(os.environ['TMPDIR'], 'texture.bmp'), []
        save.resourceId, save.slice.sliceIndex, save.mip = target
        save.destType = rd.FileType.BMP
        for save.channelExtract in range(self.textures[target[0]].format.compCount):
            self.control.SaveTexture(save, path)
            channels.append(np.fromfile(path, 'u1', offset=54).reshape(height, -1)[:, :3 * width:3].astype('f4') / 255)
        return np.stack(channels, -1)

    def describe(self, target):
        t = self.textures[target[0]]
        return f'{t.width} x {t.height} {t.format.Name()}' + (f', slice {target[1]} of {t.arraysize}' if t.arraysize > 1 else '')


def rows_of(raw, kind, columns):
    """The bytes as rows of so many numbers; what does not fill a row is left out."""
    rows = len(raw) // (np.dtype(kind).itemsize * columns)
    return np.frombuffer(raw, kind, rows * columns).reshape(rows, columns)


# ---- the formats of textures
# How the first 32 bits of a texel are read, by the beginning of the format's name; the others have numbers in a row.
PACKED = {'D24': lambda v, gl: v / (2.0 ** 32 - 1),  # spread over 32 bits
          'D24S8': lambda v, gl: (v >> 8 if gl else v & 2 ** 24 - 1) / (2.0 ** 24 - 1),  # Vulkan's has the stencil behind all depths
          # Floats, or OpenGL's whole numbers of 32 bits of the same name: no float from 0 to 1 has more bits than 1.
          'D32': lambda v, gl: v.view('<f4') if (v <= 0x3f800000).all() else v / (2.0 ** 32 - 1),
          'R10G10B10A2': lambda v, gl: np.stack([(v >> at & 1023) / 1023 for at in (0, 10, 20)], -1),
          # Half floats without their signs and last bits.
          'R11G11B10': lambda v, gl: np.stack([v << 4 & 0x7ff0, v >> 7 & 0x7ff0, v >> 17 & 0x7fe0], -1).astype('<u2').view('<f2')}
KINDS = {rd.CompType.UNorm: 'u', rd.CompType.UNormSRGB: 'u', rd.CompType.Depth: 'u', rd.CompType.Float: 'f'}


def packed(form):
    """The name in PACKED, or ''."""
    name = form.Name().split('_')[0].replace('D32S8', 'D32')
    return name if name in PACKED else ''


def step_of(form):
    """How far two values near 1 lie apart."""
    steps, kind = {'R10G10B10A2': 1 / 1023, 'R11G11B10': 2 ** -6}, f'{KINDS[form.compType]}{form.compByteWidth}'
    return steps.get(packed(form)) or (1 / np.iinfo(kind).max if kind[0] == 'u' else np.finfo(kind).epsneg)


def decode(raw, form, width, height, gl):
    """The values of a texture's bytes, as float32; sRGB formats are decoded."""
    pixels, v = width * height, ()
    if packed(form):
        v = PACKED[packed(form)](rows_of(raw, '<u4', max(1, len(raw) // 4 // pixels))[:pixels, 0], gl)
    elif form.compType in KINDS:
        v = rows_of(raw, f'<{KINDS[form.compType]}{form.compByteWidth}', form.compCount)[:pixels]
        v = v / np.iinfo(v.dtype).max if v.dtype.kind == 'u' else v
    if len(v) < pixels:
        raise Refusal(f'a texture of the format {form.Name()} is not read')
    v = v.astype('f4').reshape(height, width, -1)
    if form.compType == rd.CompType.UNormSRGB:
        v[..., :3] = np.where(v[..., :3] <= 0.04045, v[..., :3] / 12.92, ((v[..., :3] + 0.055) / 1.055) ** 2.4)
    return v[..., [2, 1, 0, 3][:form.compCount]] if form.BGRAOrder() else v
