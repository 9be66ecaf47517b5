"""The frame's visibility of one light: (I - I0) / (I1 - I0), from the frame as captured, with its maps all lit and all dark.

Light that other lamps, ambience or history add is in all three pictures and drops out, and so do albedo and N.L.
"""
import numpy as np

from replay import Refusal

NO_SURFACE, NOT_JUDGED = -1.0, -2.0  # marks of frame.json
MASK = 0.9  # of the pixels that react: more of them at the end of the format are no highlights
STEPS_OF_REACTION = 8  # of the target's format, between lit and dark, that a pixel must show


def crop(image, viewport):
    x, y, w, h = (int(v) for v in viewport)
    return image[y:y + h, x:x + w]


def step_of(form):
    """How far two neighbouring values of a target lie apart, near 1."""
    name = form.Name()
    if name.startswith('R10G10B10A2'):
        return 1 / 1023
    if name.startswith('R11G11B10'):
        return 2.0 ** -6
    return {1: 1 / 255, 2: 2.0 ** -11}.get(form.compByteWidth, 2.0 ** -23)


class Pictures:
    """What the frame draws at the picture's size after its maps, in the replay of each copy."""

    def __init__(self, capture, camera, maps, passes, draws, copies, say):
        self.capture, self.camera, self.maps, self.draws, self.copies, self.say = capture, camera, maps, draws, copies, say
        last_map = max(m.drawn.first for m in maps)
        self.targets = {}
        for p in passes:
            if p.last > last_map and p.viewport[2:] == camera.viewport[2:]:
                for o in p.outputs:
                    self.targets[o] = max(self.targets.get(o, 0), p.last)
        self.targets = dict(sorted(self.targets.items(), key=lambda t: t[1]))
        self.frame = self.read(capture, 0)
        read = set().union(*(d.reads for d in draws if d.event > min(m.drawn.first for m in maps)))
        # A pass may write a depth and colours; what a later draw reads is the map.
        self.colour = {id(m): bool(m.drawn.outputs) and (any(o[0] in read for o in m.drawn.outputs) or not m.drawn.depth)
                       for m in maps}

    def read(self, capture, shift):
        images = {}
        for target, event in self.targets.items():
            own = (capture.same(target[0], self.capture), *target[1:])
            try:
                images[target] = crop(capture.image(own, event + shift), self.camera.viewport)[..., :3].astype('f8')
            except Refusal as why:
                if capture is self.capture:
                    self.say(str(why))
        return images

    def replay(self, lit=(), dark=(), values=(None,)):
        """The pictures with some maps empty, and with others cleared to a value (None: the nearest depth)."""
        shots = []
        for value in values:
            edits, shift = self.copies.without({d.event: d for m in (*lit, *dark) for d in m.drawn.draws}.values()), 0
            for m in dark:
                clear, more = self.copies.cleared(m.drawn, self.capture.clears(), self.colour[id(m)], m.near if value is None else value)
                shift += more if not set(clear) & set(edits) else 0
                edits |= clear
            copy = self.copies.open(edits)
            shots.append(self.read(copy, shift))
            copy.close()
        return shots


def measure(pictures, group):
    """(V, picture all lit, picture all dark, target, notes): V has NaN where the picture does not react to the light's maps."""
    capture, notes = pictures.capture, []
    empty = pictures.replay(lit=group)[0]
    values = (None,)
    if pictures.colour[id(group[0])]:  # moments: which number means dark is not known, so the pictures say it
        floats = capture.textures[group[0].drawn.outputs[0][0]].format.compByteWidth > 1
        values = (0, 1, 1e30) if floats else (0, 1)
    shots = [empty, *pictures.replay(dark=group, values=values)]
    for target in pictures.targets:
        if any(target not in s for s in (pictures.frame, *shots)):
            continue
        sums = [np.nansum(np.clip(s[target], 0, 100)) for s in shots]
        lit, dark = shots[int(np.argmax(sums))][target], shots[int(np.argmin(sums))][target]
        form = capture.textures[target[0]].format
        reaction = np.abs(lit - dark).max(2)
        if (reaction > 1 / 256).sum() >= 100:
            break
    else:
        own, later = {o[0] for m in group for o in (m.drawn.depth, *m.drawn.outputs) if o}, [d for d in pictures.draws if d.event > group[-1].drawn.last]
        if any(own & set(d.reads) for d in later):
            raise Refusal(f'the map of {group[0].drawn.name} has no effect on the picture, although draws read it: is its bias so large '
                          'that nothing is in shadow?')
        others = {m.drawn.name for m in pictures.maps if any(m.drawn.target[0] in d.reads for d in later)}
        raise Refusal(f'the map of {group[0].drawn.name} has no effect on the picture: no later draw reads it'
                      + (f'; they read the map of another light ({", ".join(sorted(others))})' if others else ''))
    frame, step = pictures.frame[target], step_of(form)
    span = lit - dark
    if form.compByteWidth == 1:  # where a channel is at its end, the light may go further than it shows
        clamped = (np.maximum(lit, frame) >= 1 - step / 2) & (span != 0)
        if clamped.any(2).sum() > MASK * (span != 0).any(2).sum():
            clamped[:] = False  # not a bright picture: a mask whose 1 is lit
        span = np.where(clamped, 0, span)
        if clamped.any():
            notes.append(f'{clamped.any(2).sum()} pixels reach the end of their format in a channel, which is left out')
    weight = (span * span).sum(2)
    v = np.where(weight > 0, ((frame - dark) * span).sum(2) / np.where(weight > 0, weight, 1), np.nan)
    v[np.abs(span).max(2) < max(STEPS_OF_REACTION * step, 0.004 * np.percentile(reaction, 99))] = np.nan
    reacts = np.isfinite(v)
    strong = np.abs(span) > 0.2 * np.abs(span).max(2, keepdims=True)
    each = np.divide(frame - dark, span, out=np.zeros_like(span), where=strong)
    apart = np.where(strong, each, -np.inf).max(2) - np.where(strong, each, np.inf).min(2)
    partly = reacts & (v > 0.1) & (v < 0.9)
    apart -= 4 * step / np.where(strong, np.abs(span), np.inf).min(2)  # what the format's steps do
    if partly.any() and np.median(apart[partly]) > 0.01:
        notes.append(f'the channels of the picture disagree about the visibility by {np.median(apart[partly]):.2g}: the target is '
                     'not linear in the light (a tone curve, or colours mixed after it)')
    outside = int((reacts & ((v < -0.02) | (v > 1.02))).sum())
    if outside:
        notes.append(f'{outside} of {reacts.sum()} pixels are outside of what all lit and all dark give, by more than 0.02')
    entry = [d for d in pictures.draws if target in d.outputs and d.reads]
    last = pictures.targets[target]
    notes.insert(0, f'visibility from {capture.describe(target)} after event {last}' +
                 (f', drawn by {capture.entry(entry[-1])[-1]}' if entry else ''))
    return np.clip(v, 0, 1), lit, dark, target, notes


def shares(pictures, group, target, lit, dark):
    """For each map of a light the share of the pixel's shadow that it decides, 0 to 1; None where maps share a texture."""
    if len(group) == 1:
        return [np.ones(lit.shape[:2])]
    if len({m.drawn.target for m in group}) < len(group) or any(pictures.colour[id(m)] for m in group):
        return None
    found = []
    for m in group:
        shot = pictures.replay(lit=[o for o in group if o is not m], dark=[m])[0][target]
        span = lit - dark
        weight = (span * span).sum(2)
        found.append(np.where(weight > 0, ((lit - shot) * span).sum(2) / np.where(weight > 0, weight, 1), 0))
    return found
