"""The frame's visibility of one light: (I - I0) / (I1 - I0), from the frame as captured, with its maps all lit and all dark.

Light that other lamps, ambience or history add is in all three pictures and drops out, and so do albedo and N.L. The two others are
of copies of the capture with other calls. RenderDoc's replay can replace shaders, but no contents of a texture, and a shader of the
map may be the picture's as well; a copy without the map's draws is right in every case.
"""
import os

import numpy as np
import renderdoc as rd

from replay import Capture, Refusal, step_of

MASK = 0.9  # of the pixels that react: more of them at the end of the format are no highlights
STEPS_OF_REACTION = 8  # of the target's format, between lit and dark, that a pixel must show
FEWEST_PIXELS = 100  # that react to a map
COUNTS = ('count', 'indexCount', 'vertexCount', 'drawCount', 'instanceCount')  # of the calls that draw
CLEARS = ('glClear', 'glClearBufferfv', 'glClearBufferfi', 'vkCmdBeginRenderPass')
INTEGERS = (rd.SDBasic.SignedInteger, rd.SDBasic.UnsignedInteger)
GL_COLOR, GL_DEPTH, GL_READ_FRAMEBUFFER = 0x1800, 0x1801, 0x8ca8
CLEAR_BUFFER = 1696  # RenderDoc's number of the call glClearBufferfv


def divided(part, span):
    """The share of the span that the part is, by least squares over the channels; NaN without a span."""
    with np.errstate(invalid='ignore'):
        return (part * span).sum(2) / (span * span).sum(2)


def leaves(part):
    for child in (part.GetChild(k) for k in range(part.NumChildren())):
        yield from leaves(child) if child.NumChildren() else [child]


def clear(calls, at, value, is_colour):
    """Lets the call there clear to `value`; returns how many calls are put in for it."""
    if calls[at].name != 'glClear':
        of_pass = calls[at].FindChildRecursively('pClearValues')  # Vulkan's, a union: its members are written one over the other
        for leaf in leaves(of_pass or calls[at]):
            if leaf.type.basetype == rd.SDBasic.Float:
                leaf.data.basic.d = value
            elif of_pass and leaf.type.basetype in INTEGERS:
                leaf.data.basic.u = 0x3f800000 if value == 1 else 0
        return 0
    bound = [calls[k].FindChild('framebuffer').AsResourceId() for k in range(at)
             if calls[k].name == 'glBindFramebuffer' and calls[k].FindChild('target').AsInt() != GL_READ_FRAMEBUFFER]
    call, values = rd.SDChunk('glClearBufferfv'), rd.makeSDArray('value')
    call.metadata.chunkID = CLEAR_BUFFER
    for _ in range(4 if is_colour else 1):
        values.AddChild(rd.makeSDFloat('$el', value))
    for part in (rd.makeSDResourceId('framebuffer', bound[-1]), rd.makeSDEnum('buffer', GL_COLOR if is_colour else GL_DEPTH),
                 rd.makeSDInt32('drawbuffer', 0), values, rd.makeSDArray('DebugMessages')):
        call.AddChild(part)
    calls.insert(at + 1, call)
    return 1


class Pictures:
    """What the frame draws at the picture's size after its maps, as captured and in copies."""

    def __init__(self, options, capture, draws, passes, camera, maps):
        self.options, self.capture, self.draws, self.camera, self.maps = options, capture, draws, camera, maps
        self.clears = capture.clears()
        later = [p for p in passes if p.last > maps[-1].first and p.viewport[2:] == camera.viewport[2:]]
        ends = {target: p.last for p in sorted(later, key=lambda p: p.last) for target in p.outputs}
        self.targets = dict(sorted(ends.items(), key=lambda t: t[1]))
        self.frame = self._read(capture, 0)

    def _read(self, capture, shift):
        images = {}
        for target, event in self.targets.items():
            own = (capture.same(target[0], self.capture), *target[1:])
            try:
                images[target] = capture.image(own, event + shift, self.camera.viewport)[..., :3].astype('f8')
            except Refusal as why:
                if capture is self.capture:
                    print(why)
        return images

    def _cleared_at(self, m, calls):
        """Where this frame clears the map last before drawing."""
        outputs = {o[0] for o in m.outputs}
        mine = [c for c, z, o in self.clears if c < m.draws[0].chunk and calls[c].name in CLEARS
                and (z == m.depth[0] if m.depth else outputs & set(o))]
        if not mine:
            raise Refusal(f'the map of {m.name} is not cleared in this frame, so it keeps what earlier frames drew; move '
                          'the light a little while the frame is captured')
        return mine[-1]

    def replay(self, lit=(), dark=(), value=None):
        """The pictures with some maps empty, and with others cleared to a value (None: the nearest depth)."""
        path, source, made = os.path.join(self.options.scratch, 'copy.rdc'), rd.OpenCaptureFile(), rd.OpenCaptureFile()
        source.OpenFile(self.options.capture, '', None)
        data = source.GetStructuredData()
        calls = data.chunks
        for draw in (d for m in (*lit, *dark) for d in m.draws):  # which stay and draw nothing, so the numbers of events stay
            counts = [c for c in map(calls[draw.chunk].FindChildRecursively, COUNTS) if c and c.type.basetype in INTEGERS]
            if not counts:
                raise Refusal(f'draw {draw.event} takes its vertices from {calls[draw.chunk].name}, which cannot be emptied')
            for count in counts:
                count.data.basic.u = 0
        cleared = {self._cleared_at(m, calls): m for m in dark}
        shift = sum(clear(calls, at, int(cleared[at].reversed) if value is None else value, self.reads_colour(cleared[at]))
                    for at in sorted(cleared, reverse=True))
        made.SetMetadata(source.DriverName(), 0, rd.FileType.JPG, 0, 0, b'', 0, 1.0)
        made.SetStructuredData(data)
        result = made.Convert(path, 'rdc', None, None)
        if result.code != rd.ResultCode.Succeeded:
            raise Refusal(f'RenderDoc writes no copy of it: {result.Message()}')
        copy = Capture(path)
        images = self._read(copy, shift)
        copy.close()
        made.Shutdown()
        source.Shutdown()
        return images

    def _reads_after(self, event):
        return set().union(*(d.reads for d in self.draws if d.event > event))

    def reads_colour(self, m):
        """A pass may write a depth and colours; what a later draw reads is the map."""
        read = self._reads_after(self.maps[0].first)
        return bool(m.outputs) and (not m.depth or any(o[0] in read for o in m.outputs))

    def _no_effect(self, group):
        """Why nothing changes with the light's maps."""
        read = self._reads_after(group[-1].last)
        why = f'the map of {group[0].name} has no effect on the picture'
        if any(m.textures & read for m in group):
            return f'{why}, although draws read it: is its bias so large that nothing is in shadow?'
        others = sorted({m.name for m in self.maps if m.target[0] in read})
        return f'{why}: no later draw reads it' + (f'; they read the map of another light ({", ".join(others)})' if others else '')

    def visibility(self, group):
        """(V, picture all lit, picture all dark, target, notes): V has NaN where the picture does not react to the light's maps."""
        capture, values = self.capture, [None]
        if self.reads_colour(group[0]):  # moments: which number means dark is not known, so the pictures say it
            values = [0, 1, 1e30] if capture.textures[group[0].outputs[0][0]].format.compByteWidth > 1 else [0, 1]
        shots = [self.replay(lit=group), *(self.replay(dark=group, value=v) for v in values)]
        for target in self.targets:
            if all(target in s for s in (self.frame, *shots)):
                dark, *_, lit = sorted((s[target] for s in shots), key=lambda image: np.nansum(np.clip(image, 0, 100)))
                reaction = np.abs(lit - dark).max(2)
                if (reaction > 1 / 256).sum() >= FEWEST_PIXELS:
                    break
        else:
            raise Refusal(self._no_effect(group))
        form, frame, span = capture.textures[target[0]].format, self.frame[target], lit - dark
        step = step_of(form)
        entry = [d for d in self.draws if target in d.outputs and d.reads]
        notes = [f'visibility from {capture.describe(target)} after event {self.targets[target]}' +
                 (f', drawn by {capture.fragment_shader(entry[-1])}' if entry else '')]
        if form.compByteWidth == 1:  # where a channel is at its end, the light may go further than it shows
            clamped = (np.maximum(lit, frame) >= 1 - step / 2) & (span != 0)
            if 0 < clamped.any(2).sum() <= MASK * (span != 0).any(2).sum():  # more is not a bright picture: a mask whose 1 is lit
                span = np.where(clamped, 0, span)
                notes.append(f'{clamped.any(2).sum()} pixels reach the end of their format in a channel, which is left out')
        v = divided(frame - dark, span)
        v[np.abs(span).max(2) < max(STEPS_OF_REACTION * step, 0.004 * np.percentile(reaction, 99))] = np.nan
        strong = np.abs(span) > 0.2 * np.abs(span).max(2, keepdims=True)
        each = np.divide(frame - dark, span, out=np.full_like(span, np.nan), where=strong)
        partly = (v > 0.1) & (v < 0.9)
        steps = 4 * step / np.where(strong, np.abs(span), np.inf).min(2)  # what the format's steps do
        apart = (np.nanmax(each[partly], 1) - np.nanmin(each[partly], 1) - steps[partly]) if partly.any() else np.zeros(1)
        if np.median(apart) > 0.01:
            notes.append(f'the channels of the picture disagree about the visibility by {np.median(apart):.2g}: the target is '
                         'not linear in the light (a tone curve, or colours mixed after it)')
        outside = ((v < -0.02) | (v > 1.02)).sum()
        if outside:
            notes.append(f'{outside} of {np.isfinite(v).sum()} pixels are outside of what all lit and all dark give, by more than 0.02')
        return np.clip(v, 0, 1), lit, dark, target, notes

    def shares(self, group, target, lit, dark):
        """For each map of a light the share of the pixel's shadow that it decides, 0 to 1; None where maps share a texture."""
        if len(group) == 1:
            return [np.ones(lit.shape[:2])]
        if len({m.target for m in group}) < len(group) or any(map(self.reads_colour, group)):
            return None
        return [divided(lit - self.replay(lit=[o for o in group if o is not m], dark=[m])[target], lit - dark) for m in group]
