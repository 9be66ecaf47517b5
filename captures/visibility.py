"""The frame's visibility of one light: (I - I0) / (I1 - I0), from the frame as captured, with its maps all lit and all dark.

Light that other lamps, ambience or history add is in all three pictures and drops out, and so do albedo and N.L.
"""
import numpy as np

from replay import Refusal, format_of

NO_SURFACE, NOT_JUDGED = -1.0, -2.0  # marks of frame.json
MASK = 0.9  # of the pixels that react: more of them at the end of the format are no highlights
STEPS_OF_REACTION = 8  # of the target's format, between lit and dark, that a pixel must show
FEWEST_PIXELS = 100  # that react to a map


def crop(image, viewport):
    x, y, w, h = (int(v) for v in viewport)
    return image[y:y + h, x:x + w]


class Pictures:
    """What the frame draws at the picture's size after its maps, in the replay of each copy."""

    def __init__(self, reader, copies):
        self.capture, self.draws, self.camera, self.maps, self.copies = reader.capture, reader.draws, reader.camera, reader.maps, copies
        later = [p for p in reader.passes if p.last > self.maps[-1].drawn.first and p.viewport[2:] == self.camera.viewport[2:]]
        ends = {target: p.last for p in sorted(later, key=lambda p: p.last) for target in p.outputs}
        self.targets = dict(sorted(ends.items(), key=lambda t: t[1]))
        self.frame = self.read(self.capture, 0)

    def reads_colour(self, m):
        """A pass may write a depth and colours; what a later draw reads is the map."""
        read = set().union(*(d.reads for d in self.draws if d.event > self.maps[0].drawn.first))
        return bool(m.drawn.outputs) and (not m.drawn.depth or any(o[0] in read for o in m.drawn.outputs))

    def read(self, capture, shift):
        images = {}
        for target, event in self.targets.items():
            own = (capture.same(target[0], self.capture), *target[1:])
            try:
                images[target] = crop(capture.image(own, event + shift), self.camera.viewport)[..., :3].astype('f8')
            except Refusal as why:
                if capture is self.capture:
                    print(str(why))
        return images

    def replay(self, lit=(), dark=(), value=None):
        """The pictures with some maps empty, and with others cleared to a value (None: the nearest depth)."""
        edits, shift = self.copies.without([d for m in (*lit, *dark) for d in m.drawn.draws]), 0
        for m in dark:
            to = int(m.drawn.reversed) if value is None else value
            clear, more = self.copies.cleared(m.drawn, self.capture.clears(), self.reads_colour(m), to)
            shift += 0 if set(clear) & set(edits) else more
            edits |= clear
        copy = self.copies.open(edits)
        images = self.read(copy, shift)
        copy.close()
        return images


def divided(part, span):
    """The share of the span that the part is, by least squares over the channels; NaN without a span."""
    with np.errstate(invalid='ignore'):
        return (part * span).sum(2) / (span * span).sum(2)


def no_effect(pictures, group):
    """Why nothing changes with the light's maps."""
    read = set().union(*(d.reads for d in pictures.draws if d.event > group[-1].drawn.last))
    why = f'the map of {group[0].drawn.name} has no effect on the picture'
    if any(m.drawn.textures & read for m in group):
        return f'{why}, although draws read it: is its bias so large that nothing is in shadow?'
    others = sorted({m.drawn.name for m in pictures.maps if m.drawn.target[0] in read})
    return f'{why}: no later draw reads it' + (f'; they read the map of another light ({", ".join(others)})' if others else '')


def measure(pictures, group):
    """(V, picture all lit, picture all dark, target, notes): V has NaN where the picture does not react to the light's maps."""
    capture, values = pictures.capture, [None]
    if pictures.reads_colour(group[0]):  # moments: which number means dark is not known, so the pictures say it
        values = [0, 1, 1e30] if capture.textures[group[0].drawn.outputs[0][0]].format.compByteWidth > 1 else [0, 1]
    shots = [pictures.replay(lit=group), *(pictures.replay(dark=group, value=v) for v in values)]
    for target in pictures.targets:
        if any(target not in s for s in (pictures.frame, *shots)):
            continue
        by_light = sorted((s[target] for s in shots), key=lambda image: np.nansum(np.clip(image, 0, 100)))
        dark, lit = by_light[0], by_light[-1]
        reaction = np.abs(lit - dark).max(2)
        if (reaction > 1 / 256).sum() >= FEWEST_PIXELS:
            break
    else:
        raise Refusal(no_effect(pictures, group))
    form = capture.textures[target[0]].format
    frame, step, span = pictures.frame[target], format_of(form)[2], lit - dark
    last = pictures.targets[target]
    entry = [d for d in pictures.draws if target in d.outputs and d.reads]
    notes = [f'visibility from {capture.describe(target)} after event {last}' +
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


def shares(pictures, group, target, lit, dark):
    """For each map of a light the share of the pixel's shadow that it decides, 0 to 1; None where maps share a texture."""
    if len(group) == 1:
        return [np.ones(lit.shape[:2])]
    if len({m.drawn.target for m in group}) < len(group) or any(map(pictures.reads_colour, group)):
        return None
    return [divided(lit - pictures.replay(lit=[o for o in group if o is not m], dark=[m])[target], lit - dark) for m in group]
