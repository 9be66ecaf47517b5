"""RenderDoc's replay of one capture: its draws, their vertices after the vertex shader, textures and constants.

Everything that this package knows of RenderDoc's state stands here. Conventions, for every API:
rows of an image start at the bottom, y of clip space grows upwards, matrices multiply column vectors.
"""
import dataclasses

import numpy as np
import renderdoc as rd

NULL = rd.ResourceId.Null()
MOST_INSTANCES = 4096  # of one draw; GetPostVSData is one call for each
WINDOW_ID = 10 ** 18  # RenderDoc numbers the textures of a window from here, anew at each opening
GREATER = (rd.CompareFunction.Greater, rd.CompareFunction.GreaterEqual)
STAGES = (rd.ShaderStage.Vertex, rd.ShaderStage.Pixel)
INDEX_TYPES = {1: 'u1', 2: '<u2', 4: '<u4'}


class Refusal(Exception):
    """The capture cannot be judged; the text says why and what to do."""


@dataclasses.dataclass
class Draw:
    event: int
    chunk: int  # of the capture's list of calls
    count: int
    instances: int
    indexed: bool
    first: int  # index or vertex
    base_vertex: int
    topology: rd.Topology
    geometry: tuple  # what vertices it draws; equal in every pass that draws the same mesh
    depth: tuple  # (texture, slice, mip), or ()
    outputs: tuple  # of the same
    viewport: tuple  # x, y, width, height in pixels, from the bottom
    reads: dict  # texture -> the shader's name of it, of the textures that its shaders use
    has_geometry_shader: bool
    zero_to_one: bool  # depths of clip space
    reversed: bool
    y_down: bool
    writes_depth: bool
    culls: str  # 'none', or the turn on the screen of the triangles that are not drawn: 'ccw', 'cw'
    polygon_offset: tuple  # factor, units
    discards: bool
    samples: int

    @property
    def place(self):
        return self.depth, self.outputs, self.viewport


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
        self.api = self.control.GetAPIProperties().pipelineType
        self.gl = self.api == rd.GraphicsAPI.OpenGL
        self.driver = self.file.DriverName()
        self.textures = {t.resourceId: t for t in self.control.GetTextures()}
        self.names = {r.resourceId: r.name for r in self.control.GetResources()}
        self.event = None

    def close(self):
        self.control.Shutdown()
        self.file.Shutdown()

    def at(self, event):
        if event != self.event:
            self.control.SetFrameEvent(event, True)
            self.event = event

    def actions(self):
        def walk(actions):
            for action in actions:
                yield action
                yield from walk(action.children)
        return list(walk(self.control.GetRootActions()))

    def chunk_of(self, action):
        """Of a draw out of a call for several, RenderDoc counts on from the call's own place."""
        while action.parent and action.parent.flags & rd.ActionFlags.MultiAction:
            action = action.parent
        return action.events[-1].chunkIndex

    def clears(self):
        """[(chunk, depth texture, colour textures)] that are cleared, or whose pass begins."""
        return [(a.events[-1].chunkIndex, a.depthOut, list(a.outputs)) for a in self.actions()
                if a.flags & (rd.ActionFlags.Clear | rd.ActionFlags.PassBoundary)]

    # ---- draws and their state
    def draws(self):
        found = []
        for action in self.actions():
            if not action.flags & rd.ActionFlags.Drawcall:
                continue
            self.at(action.eventId)
            state = self.control.GetPipelineState()
            found.append(self._draw(action, state))
        return found

    def _draw(self, action, state):
        depth = state.GetDepthTarget()
        view = state.GetViewport(0)
        vertex_buffers, inputs = state.GetVBuffers(), state.GetVertexInputs()
        indexed = bool(action.flags & rd.ActionFlags.Indexed)
        instances = max(1, action.numInstances)
        if indexed:
            ib = state.GetIBuffer()
            geometry = (int(ib.resourceId), ib.byteOffset + action.indexOffset * ib.byteStride, ib.byteStride, action.baseVertex)
        else:
            used = inputs[0].vertexBuffer if len(inputs) else len(vertex_buffers)
            vb = vertex_buffers[used] if used < len(vertex_buffers) else None
            geometry = (int(vb.resourceId) if vb else 0, vb.byteOffset if vb else 0, 0, action.vertexOffset)
        target = lambda t: (t.resourceId, max(0, t.firstSlice), max(0, t.firstMip))
        outputs = tuple(target(o) for o in state.GetOutputTargets() if o.resourceId != NULL)
        draw = Draw(
            event=action.eventId, chunk=self.chunk_of(action),
            count=action.numIndices, instances=instances, indexed=indexed,
            first=action.indexOffset if indexed else action.vertexOffset, base_vertex=action.baseVertex if indexed else 0,
            topology=state.GetPrimitiveTopology(), geometry=geometry + (action.numIndices, instances),
            depth=() if depth.resourceId == NULL else target(depth), outputs=outputs,
            viewport=(view.x, view.y, view.width, view.height), reads=self._reads(state),
            has_geometry_shader=state.GetShader(rd.ShaderStage.Geometry) != NULL, zero_to_one=True, reversed=False,
            y_down=False, writes_depth=True, culls='none', polygon_offset=(0.0, 0.0),
            discards=discards(state.GetShaderReflection(rd.ShaderStage.Pixel)), samples=1)
        main = outputs[0] if outputs else draw.depth
        if main:
            draw.samples = max(1, self.textures[main[0]].msSamp)
        if self.gl:
            gl = self.control.GetGLPipelineState()
            raster, test = gl.rasterizer.state, gl.depthState
            draw.zero_to_one = not gl.vertexProcessing.clipNegativeOneToOne
            draw.writes_depth = test.depthEnable and test.depthWrites
        else:
            vk = self.control.GetVulkanPipelineState()
            raster, test = vk.rasterizer, vk.depthStencil
            draw.writes_depth = test.depthTestEnable and test.depthWriteEnable
            draw.y_down = view.height > 0
            x, y, w, h = draw.viewport
            y, h = (y + h, -h) if h < 0 else (y, h)
            rows = self.textures[main[0]].height >> main[2] if main else h
            draw.viewport = (x, rows - y - h, w, h)
        draw.reversed = test.depthFunction in GREATER
        if raster.cullMode in (rd.CullMode.Front, rd.CullMode.Back):
            draw.culls = 'ccw' if (raster.cullMode == rd.CullMode.Front) == bool(raster.frontCCW) else 'cw'
        draw.polygon_offset = (raster.slopeScaledDepthBias, raster.depthBias)
        return draw

    def _reads(self, state):
        """Of OpenGL's textures a shader declares and uses only some; all others are bound by chance."""
        found = {}
        for stage in STAGES:
            reflection = state.GetShaderReflection(stage)
            if not reflection:
                continue
            points = state.GetBindpointMapping(stage).readOnlyResources
            bound = {(b.bindPoint.bindset, b.bindPoint.bind): b.resources for b in state.GetReadOnlyResources(stage)}
            for resource in reflection.readOnlyResources:
                point = points[resource.bindPoint]  # an index into the mapping, and not the place itself
                for r in bound.get((point.bindset, point.bind), []) if point.used else []:
                    if r.resourceId != NULL:
                        found[r.resourceId] = resource.name
        return found

    def entry(self, draw):
        """The names of the draw's shaders, as the debugger shows them."""
        self.at(draw.event)
        state = self.control.GetPipelineState()
        return [f'{self.names.get(state.GetShader(s), "")} {state.GetShaderEntryPoint(s)}()'
                for s in STAGES if state.GetShader(s) != NULL]

    # ---- vertices
    def _indices(self, resource, offset, stride, count):
        raw = self.control.GetBufferData(resource, offset, count * stride)
        return np.frombuffer(raw, INDEX_TYPES[stride])[:count].astype('i8')

    def after_vertex_shader(self, draw, whole=False):
        """(clip positions, texture coordinates or None), a row for each index of each instance; None without positions.

        whole: all that the shader writes behind the position, in place of the coordinates.
        """
        self.at(draw.event)
        if draw.topology == rd.Topology.PatchList_1CPs or draw.instances > MOST_INSTANCES:
            raise Refusal(f'draw {draw.event} has {draw.instances} instances or patches; {MOST_INSTANCES} instances are read')
        stage = rd.MeshDataStage.GSOut if draw.has_geometry_shader else rd.MeshDataStage.VSOut
        clips, coordinates = [], []
        for instance in range(draw.instances):
            mesh = self.control.GetPostVSData(instance, 0, stage)
            if mesh.vertexResourceId == NULL or mesh.numIndices == 0:
                continue
            stride = mesh.vertexByteStride // 4
            raw = self.control.GetBufferData(mesh.vertexResourceId, mesh.vertexByteOffset, 0)
            rows = np.frombuffer(raw, '<f4')[:len(raw) // 4 // stride * stride].reshape(-1, stride)
            if mesh.indexResourceId != NULL and mesh.indexByteStride:
                index = self._indices(mesh.indexResourceId, mesh.indexByteOffset, mesh.indexByteStride, mesh.numIndices)
                index = index + mesh.baseVertex
                rows = rows[np.clip(index, 0, len(rows) - 1)]
            else:
                rows = rows[:mesh.numIndices]
            clips.append(rows[:, :4].astype('f8'))
            coordinates.append(rows[:, 4:])
            if draw.has_geometry_shader:
                break  # its output holds all instances
        if not clips:
            return None
        clip = np.concatenate(clips)
        if draw.y_down:
            clip[:, 1] *= -1
        at = self._texture_coordinate()
        varyings = np.concatenate(coordinates)
        if whole:
            return clip, varyings
        return clip, varyings[:, at:at + 2] if at is not None and varyings.shape[1] >= at + 2 else None

    def _texture_coordinate(self):
        """Where the first output of two floats stands behind the position: a mask's texture coordinate."""
        reflection = self.control.GetPipelineState().GetShaderReflection(rd.ShaderStage.Vertex)
        at = 0
        for output in reflection.outputSignature if reflection else []:
            if output.systemValue == rd.ShaderBuiltin.Position:
                continue
            if output.compCount == 2 and output.systemValue == rd.ShaderBuiltin.Undefined:
                return at
            at += output.compCount
        return None

    def vertex_inputs(self, draw):
        """Each attribute of two or three floats, a row for each index. Which one is the place is found by a fit."""
        self.at(draw.event)
        state = self.control.GetPipelineState()
        buffers, found = state.GetVBuffers(), []
        if draw.indexed:
            ib = state.GetIBuffer()
            index = self._indices(ib.resourceId, ib.byteOffset + draw.first * ib.byteStride, ib.byteStride, draw.count)
            index = index + draw.base_vertex
        else:
            index = np.arange(draw.count) + draw.first
        for attribute in state.GetVertexInputs():
            form = attribute.format
            if (attribute.vertexBuffer >= len(buffers) or attribute.perInstance or form.compType != rd.CompType.Float
                    or form.compCount < 2 or form.compByteWidth not in (2, 4)):
                continue
            buffer, width = buffers[attribute.vertexBuffer], form.compByteWidth * form.compCount
            if buffer.resourceId == NULL:
                continue
            raw = self.control.GetBufferData(buffer.resourceId, buffer.byteOffset + attribute.byteOffset, 0)
            raw, stride = np.frombuffer(raw, 'u1'), buffer.byteStride or width
            n = (len(raw) - width) // stride + 1
            if n <= 0 or index.max() >= n or index.min() < 0:
                continue
            rows = np.ascontiguousarray(np.lib.stride_tricks.as_strided(raw, (n, width), (stride, 1))[index])
            rows = rows.view({4: '<f4', 2: '<f2'}[form.compByteWidth]).reshape(len(index), -1)[:, :3].astype('f8')
            found.append(np.pad(rows, ((0, 0), (0, 3 - rows.shape[1]))))
        return found

    # ---- constants
    def matrices(self, draw):
        """[(name, 4 x 4)]: every 16 floats in the constants of the draw's shaders that could be a matrix, as columns."""
        self.at(draw.event)
        state, found = self.control.GetPipelineState(), []
        pipeline = state.GetGraphicsPipelineObject()
        for stage in STAGES:
            reflection = state.GetShaderReflection(stage)
            for i, block in enumerate(reflection.constantBlocks if reflection else []):
                buffer = state.GetConstantBuffer(stage, i, 0)
                if buffer.resourceId != NULL:
                    size = min(buffer.byteSize, 1 << 18)
                    raw = bytes(self.control.GetBufferData(buffer.resourceId, buffer.byteOffset, size))
                    floats = np.frombuffer(raw[:len(raw) // 16 * 16], '<f4').astype('f8')
                    found += [(f'{block.name}+{4 * k}', floats[k:k + 16].reshape(4, 4).T) for k in range(0, len(floats) - 15, 4)]
                    continue
                variables = self.control.GetCBufferVariableContents(
                    pipeline, reflection.resourceId, stage, reflection.entryPoint, i, buffer.resourceId, 0, 0)
                for v in flat(variables):
                    if v.rows == 4 and v.columns == 4:
                        found.append((v.name, np.array(list(v.value.f32v)[:16], 'f8').reshape(4, 4)))
        return [(n, m) for n, m in found if np.isfinite(m).all() and 0 < np.abs(m).max() < 1e7]

    # ---- textures
    def same(self, texture, other):
        """The texture of this opening that `texture` is in the opening `other`."""
        if texture in self.textures:
            return texture
        window = lambda c: sorted((r for r in c.textures if int(r) >= WINDOW_ID), key=int)
        return window(self)[window(other).index(texture)]

    def image(self, target, event):
        """float32 height x width x channels of (texture, slice, mip) after the event; of sample 0."""
        self.at(event)
        texture, part, mip = target
        t = self.textures[texture]
        width, height = max(1, t.width >> mip), max(1, t.height >> mip)
        raw = bytes(self.control.GetTextureData(texture, rd.Subresource(mip, part, 0)))
        pixels = decode(raw, t.format, width, height, self.gl)
        return pixels if self.gl else np.ascontiguousarray(pixels[::-1])

    def describe(self, target):
        t = self.textures[target[0]]
        what = f'{t.width} x {t.height} {t.format.Name()}'
        return what + (f', slice {target[1]} of {t.arraysize}' if t.arraysize > 1 else '')


def flat(variables):
    for v in variables:
        yield from flat(v.members) if len(v.members) else [v]


def discards(reflection):
    """Whether a fragment shader can drop fragments: the word in GLSL, the instruction in SPIR-V."""
    if not reflection:
        return False
    raw = bytes(reflection.rawBytes)
    if reflection.encoding == rd.ShaderEncoding.SPIRV:
        words, at = np.frombuffer(raw[:len(raw) // 4 * 4], '<u4'), 5
        while at < len(words) and words[at] >> 16:
            if words[at] & 0xffff in (252, 4416, 5380):  # OpKill, OpTerminateInvocation, OpDemoteToHelperInvocation
                return True
            at += int(words[at] >> 16)
        return False
    return b'discard' in raw


def small_float(bits, mantissa):
    exponent, rest = bits >> mantissa, bits & ((1 << mantissa) - 1)
    return np.where(exponent == 0, rest * 2.0 ** (-14 - mantissa),
                    (1 + rest / 2.0 ** mantissa) * 2.0 ** (exponent.astype('f8') - 15))


def decode(raw, form, width, height, gl):
    """The values of a texture's bytes, as float32; sRGB formats are decoded."""
    name, shape, u = form.Name(), (height, width, 1), np.frombuffer(raw, 'u1')
    n = width * height
    if name.startswith('D32') and len(raw) == n * 8:
        return np.ascontiguousarray(u.reshape(n, 8)[:, :4]).view('<f4').reshape(shape)
    if name == 'D32' or name.startswith('R32_FLOAT'):
        x = u[:n * 4].view('<f4')
        if name == 'D32' and not (np.isfinite(x).all() and x.min() >= 0 and x.max() <= 1):
            x = (u[:n * 4].view('<u4') / (2.0 ** 32 - 1)).astype('f4')  # GL_DEPTH_COMPONENT32 has the same name
        return x.reshape(shape).copy()
    if name == 'D24':  # 24 bits, spread over 32
        return (u.view('<u4') / (2.0 ** 32 - 1)).astype('f4').reshape(shape)
    if name.startswith('D24'):  # OpenGL has depth in the high bits; Vulkan in the low ones, and the stencil behind all
        bits = u[:n * 4].view('<u4')
        return ((bits >> 8 if gl else bits & 0xffffff) / (2.0 ** 24 - 1)).astype('f4').reshape(shape)
    if name.startswith('D16'):
        return (u[:n * 2].view('<u2') / np.float32(65535)).reshape(shape)
    if name.startswith(('R11G11B10', 'R10G10B10A2')):
        v = u.view('<u4').reshape(height, width)
        if name.startswith('R11'):
            parts = [small_float(v & 0x7ff, 6), small_float(v >> 11 & 0x7ff, 6), small_float(v >> 22, 5)]
        else:
            parts = [(v & 1023) / 1023, (v >> 10 & 1023) / 1023, (v >> 20 & 1023) / 1023]
        return np.stack(parts, -1).astype('f4')
    kind = {4: '<f4', 2: '<f2' if form.compType == rd.CompType.Float else '<u2', 1: 'u1'}.get(form.compByteWidth)
    if kind is None or form.compType in (rd.CompType.UInt, rd.CompType.SInt) or len(raw) < n * form.compCount * form.compByteWidth:
        raise Refusal(f'a texture of the format {name} is not read')
    v = u[:n * form.compCount * form.compByteWidth].view(kind).reshape(height, width, form.compCount).astype('f4')
    v = v / np.float32({'u1': 255, '<u2': 65535}.get(kind, 1))
    if form.compType == rd.CompType.UNormSRGB:
        colour = v[..., :3]
        v[..., :3] = np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)
    return v[..., [2, 1, 0, 3][:form.compCount]] if name.startswith('B8G8R8') else v
