"""The frame's visibility of one light: (I - I0) / (I1 - I0), from the frame as captured, with its maps all lit and all dark.

Light that other lamps, ambience or history add is in all three pictures and drops out, and so do albedo and N.L. The two others are
of copies of the capture with other calls. RenderDoc's replay can replace shaders, but no contents of a texture, and a shader of the
map may be the picture's as well; a copy without the map's draws is right in every case.
"""
import os

import numpy as np
import renderdoc as rd

from replay import Capture, Refusal, step_of, walk

MASK = 0.9  # of the pixels that react: more of them at the end of the format are no highlights
STEPS_OF_REACTION = 8  # of the target's format, between lit and dark, that a pixel must show
FEWEST_PIXELS = 100  # that react to a map
COUNTS = ('count', 'indexCount', 'vertexCount', 'drawCount', 'instanceCount')  # of the calls that draw
CLEARS = ('glClear', 'glClearBufferfv', 'glClearBufferfi', 'vkCmdBeginRenderPass')
INTEGERS = (rd.SDBasic.SignedInteger, rd.SDBasic.UnsignedInteger)
GL_COLOR, GL_DEPTH, GL_READ_FRAMEBUFFER = 0x1800, 0x1801, 0x8ca8
PARTS = lambda item: map(item.GetChild, range(item.NumChildren()))  # of a call or its arguments
CLEAR_BUFFER = 1696  # RenderDoc's number of the call glClearBufferfv


def divided(part, span):
    """The share of the span that the part is, by least squares over the channels; NaN without a span."""
    return (part * span).sum(2) / (span * span).sum(2)


def clear(calls, at, value, is_colour):
    """Lets the call there clear to `value`; returns how many calls are put in for it."""
    if calls[at].name != 'glClear':
        of_pass = calls[at].FindChildRecursively('pClearValues')  # Vulkan's, a union: its members are written one over the other
        for item in walk([of_pass or calls[at]], PARTS):
            if item.type.basetype == rd.SDBasic.Float:
                item.data.basic.d = value
            elif of_pass and item.type.basetype in INTEGERS:
                item.data.basic.u = 0x3f800000 if value == 1 else 0
        return 0
    bound = [call.FindChild('framebuffer').AsResourceId() for call in calls[:at]
             if call.name == 'glBindFramebuffer' and call.FindChild('target').AsInt() != GL_READ_FRAMEBUFFER]
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

    def __init__(self, capture, passes, camera, maps):
        self.capture, self.camera, self.maps = capture, camera, maps
        later = sorted((p for p in passes if p.last > maps[-1].first and p.viewport[2:] == camera.viewport[2:]), key=lambda p: p.last)
        self.ends, self.frame = {target: p.last for p in later for target in p.outputs}, {}
        for target in sorted(self.ends, key=self.ends.get):
            try:
                self.frame[target] = self._picture(capture, target, 0)
            except Refusal as why:
                print(why)
        read = set().union(*(d.reads for d in capture.draws if d.event > maps[0].first))
        # A pass may write a depth and colours; what a later draw reads is the map.
        self.in_colours = {m for m in maps if m.outputs and (not m.depth or any(o[0] in read for o in m.outputs))}

    def _picture(self, capture, target, shift):
        numbered = [sorted(opened.textures, key=int) for opened in (self.capture, capture)]  # a window's are numbered anew, in their order
        own = numbered[1][numbered[0].index(target[0])], *target[1:]
        return capture.image(own, self.ends[target] + shift, self.camera.viewport)[..., :3].astype('f8')

    def _cleared_at(self, m, calls):
        """Where this frame clears the map last before drawing."""
        clears = [(a.events[-1].chunkIndex, a) for a in self.capture.actions(rd.ActionFlags.Clear | rd.ActionFlags.PassBoundary)]
        mine = [at for at, a in clears if at < m.draws[0].chunk and calls[at].name in CLEARS
                and (a.depthOut == m.depth[0] if m.depth else m.textures & set(a.outputs))]
        if not mine:
            raise Refusal(f'the map of {m.name} is not cleared in this frame, so it keeps what earlier frames drew; move '
                          'the light a little while the frame is captured')
        return mine[-1]

    def replay(self, lit=(), dark=(), value=None):
        """The pictures with some maps empty, and with others cleared to a value (None: the nearest depth)."""
        path, source, made = os.path.join(os.environ['TMPDIR'], 'copy.rdc'), rd.OpenCaptureFile(), rd.OpenCaptureFile()
        source.OpenFile(self.capture.path, '', None)
        data = source.GetStructuredData()
        calls = data.chunks
        for draw in (d for m in (*lit, *dark) for d in m.draws):  # which stay and draw nothing, so the numbers of events stay
            counts = [c for c in walk([calls[draw.chunk]], PARTS) if c.name in COUNTS and c.type.basetype in INTEGERS]
            if not counts:
                raise Refusal(f'{draw.name} takes its vertices from {calls[draw.chunk].name}, which cannot be emptied')
            for count in counts:
                count.data.basic.u = 0
        cleared = {self._cleared_at(m, calls): m for m in dark}
        shift = sum(clear(calls, at, int(m.reversed) if value is None else value, m in self.in_colours)
                    for at, m in sorted(cleared.items(), reverse=True))
        made.SetMetadata(source.DriverName(), 0, rd.FileType.JPG, 0, 0, b'', 0, 1.0)
        made.SetStructuredData(data)
        result = made.Convert(path, 'rdc', None, None)
        if result.code != rd.ResultCode.Succeeded:
            raise Refusal(f'RenderDoc writes no copy of it: {result.Message()}')
        copy = Capture(path)
        images = {target: self._picture(copy, target, shift) for target in self.frame}
        for opened in (copy.control, copy.file, made, source):  # RenderDoc replays one at a time well, several badly
            opened.Shutdown()
        return images

    def _no_effect(self, group):
        """Why nothing changes with the light's maps."""
        read = set().union(*(d.reads for d in self.capture.draws if d.event > group[-1].last))
        why = f'the map of {group[0].name} has no effect on the picture'
        if any(m.textures & read for m in group):
            return f'{why}, although draws read it: is its bias so large that nothing is in shadow?'
        others = sorted({m.name for m in self.maps if m.target[0] in read})
        return f'{why}: no later draw reads it' + (f'; they read the map of another light ({", ".join(others)})' if others else '')

    def visibility(self, group):
        """(V, its step, picture all lit, picture all dark, target, notes): V has NaN where the picture does not react to the light's maps.

        A channel of each of the three pictures is off by up to a step, so V by up to one of the span; where it is all lit or all dark by
        nothing. A pixel in a thousand is off by more.
        """
        capture, values = self.capture, [None]
        if group[0] in self.in_colours:  # moments: which number means dark is not known, so the pictures say it
            values = [0, 1, 1e30] if capture.textures[group[0].outputs[0][0]].format.compByteWidth > 1 else [0, 1]
        shots = [self.replay(lit=group), *(self.replay(dark=group, value=v) for v in values)]
        for target, frame in self.frame.items():
            dark, *_, lit = sorted((s[target] for s in shots), key=lambda image: np.nansum(np.clip(image, 0, 100)))
            reaction = np.abs(lit - dark).max(2)
            if (reaction > 1 / 256).sum() >= FEWEST_PIXELS:
                break
        else:
            raise Refusal(self._no_effect(group))
        form, span = capture.textures[target[0]].format, lit - dark
        step, shaders = step_of(form), [d.shader for d in capture.draws if target in d.outputs and d.reads]
        notes = [f'visibility from {capture.describe(target)} after event {self.ends[target]}' +
                 (f', drawn by {shaders[-1]}' if shaders else '')]
        if form.compByteWidth == 1:  # where a channel is at its end, the light may go further than it shows
            clamped = (np.maximum(lit, frame) >= 1 - step / 2) & (span != 0)
            if 0 < clamped.any(2).sum() <= MASK * (span != 0).any(2).sum():  # more is not a bright picture: a mask whose 1 is lit
                span = np.where(clamped, 0, span)
                notes.append(f'{clamped.any(2).sum()} pixels reach the end of their format in a channel, which is left out')
        v = divided(frame - dark, span)
        v[np.abs(span).max(2) < max(STEPS_OF_REACTION * step, 0.004 * np.percentile(reaction, 99))] = np.nan
        size = step * (2.28 * np.clip(lit, 0, 1) ** 0.583 if form.compType == rd.CompType.UNormSRGB else np.maximum(1, lit))  # sRGB's slope
        off = np.where((v > 0) & (v < 1), divided(size * np.sign(span), span), 0)[np.isfinite(v)]
        partly = (v > 0.1) & (v < 0.9)
        part, whole = (frame - dark)[partly], span[partly]
        strong = np.abs(whole) > 0.2 * np.abs(whole).max(1, keepdims=True)
        each = np.divide(part, whole, out=np.full_like(part, np.nan), where=strong)
        steps = 4 * step / np.where(strong, np.abs(whole), np.inf).min(1)  # what the format's steps do
        apart = np.median(np.nanmax(each, 1) - np.nanmin(each, 1) - steps) if partly.any() else 0
        if apart > 0.01:
            notes.append(f'the channels of the picture disagree about the visibility by {apart:.2g}: the target is '
                         'not linear in the light (a tone curve, or colours mixed after it)')
        outside = ((v < -0.02) | (v > 1.02)).sum()
        if outside:
            notes.append(f'{outside} of {np.isfinite(v).sum()} pixels are outside of what all lit and all dark give, by more than 0.02')
        return np.clip(v, 0, 1), float(np.percentile(off, 99.9)) if off.size else 0.0, lit, dark, target, notes
