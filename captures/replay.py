"""RenderDoc's replay of one capture: its draws, their vertices after the vertex shader, textures and constants.

Everything that this package knows of RenderDoc's state stands here. Conventions, for every API:
rows of an image start at the bottom, y of clip space grows upwards, matrices multiply column vectors.
"""
import functools

import numpy as np
import renderdoc as rd

NULL = rd.ResourceId.Null()
MOST_INSTANCES = 4096  # of one draw; GetPostVSData is one call for each
STAGES = (rd.ShaderStage.Vertex, rd.ShaderStage.Pixel)


class Refusal(Exception):
    """The capture cannot be judged; the text says why and what to do."""


class Draw:
    """A draw call, and the state that it is made in."""

    def __init__(self, action, state, capture):
        self.event, self.action, self.count, self.topology = action.eventId, action, action.numIndices, state.GetPrimitiveTopology()
        chunk = action
        while chunk.parent and chunk.parent.flags & rd.ActionFlags.MultiAction:
            chunk = chunk.parent  # of a draw out of a call for several RenderDoc counts on from the call's own place
        self.chunk = chunk.events[-1].chunkIndex  # of the capture's list of calls
        has_geometry_shader, instances = state.GetShader(rd.ShaderStage.Geometry) != NULL, max(1, action.numInstances)
        self.stage = rd.MeshDataStage.GSOut if has_geometry_shader else rd.MeshDataStage.VSOut
        self.instances = 1 if has_geometry_shader else instances  # that are read one by one: a geometry shader's output holds all
        self.geometry = (*_mesh(action, state), self.count, instances)  # equal in every pass that draws the same mesh
        self.depth, self.outputs = (  # (texture, slice, mip), or (); and such of colours
            [(t.resourceId, max(0, t.firstSlice), max(0, t.firstMip)) for t in targets if t.resourceId != NULL]
            for targets in ([state.GetDepthTarget()], state.GetOutputTargets()))
        self.depth, self.outputs = tuple(*self.depth), tuple(self.outputs)
        self.reads = set()  # textures, only those that its shaders use: OpenGL's others are bound by chance
        place = lambda point: (point.bindset, point.bind)
        for stage in STAGES:
            used = {place(point) for point in state.GetBindpointMapping(stage).readOnlyResources if point.used}
            self.reads |= {r.resourceId for b in state.GetReadOnlyResources(stage) if place(b.bindPoint) in used for r in b.resources}
        self.reads.discard(NULL)
        own, view = capture.control.GetGLPipelineState() if capture.gl else capture.control.GetVulkanPipelineState(), state.GetViewport(0)
        if capture.gl:
            raster, test, bottom = own.rasterizer.state, own.depthState, view.y
            self.writes_depth = test.depthEnable and test.depthWrites
        else:
            raster, test, bottom = own.rasterizer, own.depthStencil, -max(view.y, view.y + view.height)
            self.writes_depth = test.depthTestEnable and test.depthWriteEnable
        self.zero_to_one = not (capture.gl and own.vertexProcessing.clipNegativeOneToOne)  # depths of clip space
        self.y_down = not capture.gl and view.height > 0
        self.samples = 1
        for texture, _, mip in (*self.outputs, *filter(None, [self.depth]))[:1]:
            self.samples = max(1, capture.textures[texture].msSamp)
            bottom += 0 if capture.gl else capture.textures[texture].height >> mip
        self.viewport = (view.x, bottom, view.width, abs(view.height))  # pixels, from the bottom
        self.reversed = test.depthFunction in (rd.CompareFunction.Greater, rd.CompareFunction.GreaterEqual)
        self.polygon_offset = raster.slopeScaledDepthBias, raster.depthBias  # factor, units
        self.culls = 'none'  # or the turn on the screen of the triangles that are not drawn
        if raster.cullMode in (rd.CullMode.Front, rd.CullMode.Back):
            self.culls = 'ccw' if (raster.cullMode == rd.CullMode.Front) == bool(raster.frontCCW) else 'cw'
        self.discards = discards(state.GetShaderReflection(rd.ShaderStage.Pixel))


def _mesh(action, state):
    if action.flags & rd.ActionFlags.Indexed:
        buffer = state.GetIBuffer()
        return int(buffer.resourceId), buffer.byteOffset + action.indexOffset * buffer.byteStride, action.baseVertex
    buffers, inputs = state.GetVBuffers(), state.GetVertexInputs()
    first = [(int(b.resourceId), b.byteOffset) for b in buffers[inputs[0].vertexBuffer:][:1]] if len(inputs) else []
    return *first, action.vertexOffset


class Capture:
    """An open capture. Close it: RenderDoc replays one at a time well, several badly."""

    def __init__(self, path):
        self.file = rd.OpenCaptureFile()
        result = self.file.OpenFile(path, '', None)
        if result.code != rd.ResultCode.Succeeded:
            raise Refusal(f'RenderDoc does not read it: {result.Message()}')
        result, self.control = self.file.OpenCapture(rd.ReplayOptions(), None)
        if self.control is None:
            raise Refusal(f'RenderDoc cannot replay it on this machine: {result.Message()}')
        self.gl = self.control.GetAPIProperties().pipelineType == rd.GraphicsAPI.OpenGL
        self.textures = {t.resourceId: t for t in self.control.GetTextures()}
        self.names = {r.resourceId: r.name for r in self.control.GetResources()}
        self.event = None

    def close(self):
        self.control.Shutdown()
        self.file.Shutdown()

    def at(self, event):
        """The state of the pipeline at this event."""
        if event != self.event:
            self.control.SetFrameEvent(event, True)
            self.event = event
        return self.control.GetPipelineState()

    # ---- draws and their state
    def actions(self, flags):
        def walk(actions):
            for action in actions:
                yield from [action] if action.flags & flags else []
                yield from walk(action.children)
        return walk(self.control.GetRootActions())

    def clears(self):
        """[(chunk, depth texture, colour textures)] that are cleared, or whose pass begins."""
        return [(a.events[-1].chunkIndex, a.depthOut, a.outputs) for a in self.actions(rd.ActionFlags.Clear | rd.ActionFlags.PassBoundary)]

    def draws(self):
        return [Draw(a, self.at(a.eventId), self) for a in self.actions(rd.ActionFlags.Drawcall)]

    def fragment_shader(self, draw):
        """As the debugger shows it."""
        state = self.at(draw.event)
        return f'{self.names.get(state.GetShader(STAGES[1]), "")} {state.GetShaderEntryPoint(STAGES[1])}()'

    # ---- vertices
    def _rows(self, kind, columns, *buffer):
        return rows_of(self.control.GetBufferData(*buffer), kind, columns)

    def _indices(self, buffer, offset, width, count, base):
        return self._rows(f'<u{width}', 1, buffer, offset, count * width)[:, 0].astype('i8') + base

    @functools.cache
    def after_vertex_shader(self, draw):
        """(clip positions, all that the shader writes behind them), a row for each index of each instance that is read."""
        self.at(draw.event)
        is_read, found = draw.topology != rd.Topology.PatchList_1CPs and draw.instances <= MOST_INSTANCES, []
        if not is_read:
            print(f'draw {draw.event} has patches, or {draw.instances} instances where {MOST_INSTANCES} are read; this draw is left out')
        for instance in range(draw.instances if is_read else 0):
            mesh = self.control.GetPostVSData(instance, 0, draw.stage)
            if mesh.vertexResourceId == NULL or mesh.numIndices == 0:
                continue
            index = np.arange(mesh.numIndices)
            rows = self._rows('<f4', mesh.vertexByteStride // 4, mesh.vertexResourceId, mesh.vertexByteOffset, 0)
            if mesh.indexResourceId != NULL and mesh.indexByteStride:
                index = self._indices(mesh.indexResourceId, mesh.indexByteOffset, mesh.indexByteStride, mesh.numIndices, mesh.baseVertex)
            found.append(rows[np.clip(index, 0, len(rows) - 1)])
        rows = np.concatenate(found) if found else np.zeros((0, 4))
        return rows[:, :4] * np.array([1, -1 if draw.y_down else 1, 1, 1.0]), rows[:, 4:]

    def clip(self, draw):
        return self.after_vertex_shader(draw)[0]

    def coordinates(self, draw):
        """The first output of two floats, a mask's texture coordinate, a row for each index; None if there is none."""
        reflection, at = self.at(draw.event).GetShaderReflection(rd.ShaderStage.Vertex), 0
        for output in reflection.outputSignature if reflection else []:
            if output.compCount == 2 and output.systemValue == rd.ShaderBuiltin.Undefined:
                found = self.after_vertex_shader(draw)[1][:, at:at + 2]
                return found if found.shape[1] == 2 else None
            at += 0 if output.systemValue == rd.ShaderBuiltin.Position else output.compCount
        return None

    def vertex_inputs(self, draw):
        """Each attribute of two or three floats, a row for each index. Which one is the place is found by a fit."""
        state, action, found = self.at(draw.event), draw.action, []
        index, buffers = np.arange(draw.count) + action.vertexOffset, state.GetVBuffers()
        if action.flags & rd.ActionFlags.Indexed:
            ib = state.GetIBuffer()
            index = self._indices(ib.resourceId, ib.byteOffset + action.indexOffset * ib.byteStride, ib.byteStride,
                                  draw.count, action.baseVertex)
        for attribute in state.GetVertexInputs():
            form, size = attribute.format, attribute.format.compByteWidth
            if (attribute.vertexBuffer >= len(buffers) or attribute.perInstance or form.compType != rd.CompType.Float
                    or form.compCount < 2 or size not in (2, 4) or buffers[attribute.vertexBuffer].resourceId == NULL):
                continue
            buffer = buffers[attribute.vertexBuffer]
            raw = self.control.GetBufferData(buffer.resourceId, buffer.byteOffset + attribute.byteOffset, 0)
            stride = buffer.byteStride or size * form.compCount
            n = (len(raw) - size * form.compCount) // stride + 1
            if n > index.max() >= index.min() >= 0:
                rows = np.ndarray((n, min(3, form.compCount)), f'<f{size}', raw, strides=(stride, size))[index]
                found.append(np.pad(rows.astype('f8'), ((0, 0), (0, 3 - rows.shape[1]))))
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
                variables = self.control.GetCBufferVariableContents(
                    state.GetGraphicsPipelineObject(), reflection.resourceId, stage, reflection.entryPoint, i, buffer.resourceId, 0, 0)
                found += [(v.name, np.array(v.value.f32v[:16], 'f8').reshape(4, 4)) for v in flat(variables) if v.rows == 4 == v.columns]
        return [(n, m) for n, m in found if np.isfinite(m).all() and 0 < np.abs(m).max() < 1e7]

    # ---- textures
    def same(self, texture, other):
        """The texture of this opening that `texture` is in `other`: a window's are numbered anew, in their order."""
        return sorted(self.textures, key=int)[sorted(other.textures, key=int).index(texture)]

    def image(self, target, event, viewport=None):
        """float32 height x width x channels of (texture, slice, mip) after the event, or of a part of it; of sample 0."""
        self.at(event)
        texture, part, mip = target
        t = self.textures[texture]
        raw = self.control.GetTextureData(texture, rd.Subresource(mip, part, 0))
        pixels = decode(raw, t.format, max(1, t.width >> mip), max(1, t.height >> mip), self.gl)
        pixels = pixels if self.gl else np.ascontiguousarray(pixels[::-1])
        x, y, w, h = map(int, viewport or (0, 0, *pixels.shape[1::-1]))
        return pixels[y:y + h, x:x + w]

    def describe(self, target):
        t = self.textures[target[0]]
        return f'{t.width} x {t.height} {t.format.Name()}' + (f', slice {target[1]} of {t.arraysize}' if t.arraysize > 1 else '')


def rows_of(raw, kind, columns):
    """The bytes as rows of so many numbers; what does not fill a row is left out."""
    rows = len(raw) // (np.dtype(kind).itemsize * columns)
    return np.frombuffer(raw, kind, rows * columns).reshape(rows, columns)


def flat(variables):
    for v in variables:
        yield from flat(v.members) if len(v.members) else [v]


def discards(reflection):
    """Whether a fragment shader has the word of GLSL, or an instruction of SPIR-V: OpKill, OpTerminateInvocation, OpDemoteToHelper."""
    if reflection and reflection.encoding == rd.ShaderEncoding.SPIRV:
        return bool(np.isin(rows_of(reflection.rawBytes, '<u4', 1), [1 << 16 | code for code in (252, 4416, 5380)]).any())
    return bool(reflection) and b'discard' in bytes(reflection.rawBytes)


# ---- the formats of textures
def small_float(v, mantissa):
    """A half float without its sign and its last bits."""
    return ((v & 2 ** (5 + mantissa) - 1) << 10 - mantissa).astype('<u2').view('<f2')


def float_or_unorm(v, _):
    """GL_DEPTH_COMPONENT32 has the same name as the depth of floats."""
    x = v.view('<f4')
    return x if np.isfinite(x).all() and x.min() >= 0 and x.max() <= 1 else v / (2.0 ** 32 - 1)


# How the first 32 bits of a texel are read, by the beginning of the format's name; the others have numbers in a row.
PACKED = {'D24': lambda v, gl: v / (2.0 ** 32 - 1),  # spread over 32 bits
          'D24S8': lambda v, gl: (v >> 8 if gl else v & 2 ** 24 - 1) / (2.0 ** 24 - 1),  # Vulkan's has the stencil behind all depths
          'D32': float_or_unorm, 'D32S8': float_or_unorm,
          'R10G10B10A2': lambda v, gl: np.stack([(v >> at & 1023) / 1023 for at in (0, 10, 20)], -1),
          'R11G11B10': lambda v, gl: np.stack([small_float(v, 6), small_float(v >> 11, 6), small_float(v >> 22, 5)], -1)}
KINDS = {rd.CompType.UNorm: 'u', rd.CompType.UNormSRGB: 'u', rd.CompType.Depth: 'u', rd.CompType.Float: 'f'}


def step_of(form):
    """How far two values near 1 lie apart."""
    packed = {'R10G10B10A2': 1 / 1023, 'R11G11B10': 2 ** -6}.get(form.Name().split('_')[0])
    kind = 'f4' if packed else f'{KINDS[form.compType]}{form.compByteWidth}'
    return packed or (1 / np.iinfo(kind).max if kind[0] == 'u' else np.finfo(kind).epsneg)


def decode(raw, form, width, height, gl):
    """The values of a texture's bytes, as float32; sRGB formats are decoded."""
    name, pixels, v = form.Name().split('_')[0], width * height, ()
    if name in PACKED:
        v = PACKED[name](rows_of(raw, '<u4', max(1, len(raw) // 4 // pixels))[:pixels, 0], gl)
    elif form.compType in KINDS:
        v = rows_of(raw, f'<{KINDS[form.compType]}{form.compByteWidth}', form.compCount)[:pixels]
        v = v / np.iinfo(v.dtype).max if v.dtype.kind == 'u' else v
    if len(v) < pixels:  # compressed, too
        raise Refusal(f'a texture of the format {form.Name()} is not read')
    v = v.astype('f4').reshape(height, width, -1)
    if form.compType == rd.CompType.UNormSRGB:
        v[..., :3] = np.where(v[..., :3] <= 0.04045, v[..., :3] / 12.92, ((v[..., :3] + 0.055) / 1.055) ** 2.4)
    return v[..., [2, 1, 0, 3][:form.compCount]] if form.BGRAOrder() else v
