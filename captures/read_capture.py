"""A capture -> frame.json and its files for each light. Runs confined, as the child of capture.py."""
import json
import os

import numpy as np
import renderdoc as rd

import lookup
import scene
import solve
from pictures import FEWEST_PIXELS, Pictures, divided
from replay import Capture, Refusal

SAMPLE_0 = {2: (0.75, 0.75), 4: (0.375, 0.125), 8: (0.5625, 0.3125)}  # Vulkan's and OpenGL's standard places; others: the centre
NO_SURFACE, NOT_JUDGED = -1.0, -2.0  # marks of frame.json
EMPTY = 0.3  # of the receivers that read an empty texel, before the ground is taken for no caster of the map


def space(clip, p):
    """A clip space as frame.json has it."""
    return {'clip_from_world': clip.flatten().tolist(), 'order': 'row', 'depth_range': '0..1' if p.zero_to_one else '-1..1',
            'reversed': p.reversed}


def save(name, image):
    """The top row first."""
    np.save(name, np.ascontiguousarray(image[::-1], '<f4'))
    return {'file': name}


class Reader:
    """What all lights share, which its making writes into the working folder."""

    def __init__(self, options):
        self.options, self.capture, self.frames = options, Capture(options.capture), []
        self.passes, self.camera, self.maps = solve.camera_and_maps(self.capture)
        self.lights, cam = solve.lights_of(self.maps), self.camera
        self.describe()
        depth = self.capture.image(cam.depth, cam.last, cam.viewport)[..., 0] if cam.depth else np.zeros(1)
        if np.ptp(depth) == 0:
            raise Refusal('the picture has no depth buffer, or it reads as one value (OpenGL ES cannot read some); nothing can be judged')
        cam.depths = depth
        for m in self.maps:
            m.depths = self.capture.image(m.target, m.last, m.viewport)[..., 0]
        self.parts = scene.casters(cam, self.maps, self.capture)
        scene.write_glb('scene.glb', self.parts, self.capture)
        self.place, self.normal = lookup.receivers(depth, cam)
        self.surface = depth != (0.0 if cam.reversed else 1.0)
        jitter = np.eye(4)  # through the place of sample 0
        jitter[:2, 3] = (1 - 2 * np.array(SAMPLE_0.get(cam.draws[0].samples, (0.5, 0.5)))) / cam.viewport[2:]
        self.base = {'noonmark_frame': 1, 'scene': 'scene.glb', 'depth': save('depth.npy', depth) | {'measure': 'window'},
                     'camera': space(jitter @ cam.clip, cam)}
        self.pictures = Pictures(self.capture, self.passes, cam, self.maps)

    def describe(self):
        c, cam = self.capture, self.camera
        print(f'{c.file.DriverName()}, {len(c.draws)} draws; the picture: {cam.name}, {cam.viewport[2]:.0f} x {cam.viewport[3]:.0f}, '
              f'{"orthographic" if cam.orthographic else "perspective"} camera')
        for n, m in ((n, m) for n, group in enumerate(self.lights, 1) for m in group):
            f, u = m.draws[0].polygon_offset
            print(f'light {n}, {solve.light_of(self.lights[n - 1])["kind"]}: map {c.describe(m.target)} "{c.names.get(m.target[0], "")}", '
                  f'{m.name}, {len(m.pairs)} of {len(m.draws)} draws are in the picture too, residual {m.residual:.1e}'
                  + (f', polygon offset {f:g} / {u:g}' if f or u else '')
                  + ('' if m.cull == 'none' else f', without {m.cull} faces by their winding') + self.unfilled(m))

    def unfilled(self, m):
        """Of a map that is drawn into a part of a texture into which nothing else is drawn."""
        t, (_, _, w, h) = self.capture.textures[m.target[0]], m.viewport
        alone = all(p.first == m.first or m.target not in (p.depth, *p.outputs) for p in self.passes)
        return (f'; its viewport {w:.0f} x {h:.0f} fills a part of the texture, and nothing fills the rest: an atlas, or a forgotten '
                'viewport') if alone and w * h < t.width * t.height else ''

    def light(self, name, group):
        """Writes the frames of a light: of all its maps together, and of each of several that explains its pixels. Returns notes."""
        v, step, lit, dark, target, notes = self.pictures.visibility(group)
        light, surface, options = solve.light_of(group), self.surface, self.options
        facing = (self.normal * lookup.to_light(group[0], self.place)).sum(-1) > 0
        reacts = np.isfinite(v)
        use, mute = surface & reacts & facing, surface & ~reacts & facing
        if use.sum() < FEWEST_PIXELS:
            raise Refusal(f'only {use.sum()} pixels that face the light react to the map of {group[0].name}')
        if mute.any():
            beyond = ~np.any([lookup.Taps(m, self.place[mute]).inside for m in group], axis=0)
            notes.append(f'{mute.sum()} pixels face the light and do not react to its map: they are not judged'
                         + (f'; {beyond.sum()} of them lie beyond the borders or the far end of what it holds' if beyond.any() else ''))
        marks = np.select([~surface, reacts, facing], [NO_SURFACE, v, NOT_JUDGED])
        missing, lookups = sorted(self.not_in(group)), []
        for m, decides in zip(group, self.decided(group, target, lit, dark)):
            mine = use & decides
            why = self.why_unknown(m, mine, bool(missing))
            found = None if why else lookup.explain(m, self.place[mine], self.normal[mine], v[mine], options.filter, options.bias)
            lookups.append((m, mine, found))
            notes.append(f'map {self.capture.describe(m.target)}, {m.name}: '
                         + str(found or (why or 'too few receivers for its lookup') + '; judged by place'))
        told = {'light': light, 'notes': notes, 'visibility': {'normalised': True, 'step': step}}
        if missing:
            told['not_in_map'] = missing
            notes.append(f'not in the map although in the picture: {", ".join(missing)}')
        readers = [d for d in self.capture.draws if target in d.outputs and group[-1].textures & d.reads]
        moved, note = lookup.by_matrix(self.capture, group[-1], self.camera, light, readers, [f and f.wrong for *_, f in lookups])
        notes += [note] if note else []
        if moved is not None:
            told['light'], lookups = light | {'position': moved.tolist()}, [(m, mine, None) for m, mine, _ in lookups]
        self.write(name, marks, told, group[0], lookups[0][2] if len(group) == 1 else None)
        for k, (m, mine, found) in enumerate(lookups, 1):
            if len(group) > 1 and found:
                only = np.where(mine | ~surface | ~facing, marks, NOT_JUDGED)
                self.write(f'{name}-map-{k}', only, told | {'light': solve.light_of([m])}, m, found)
        return notes

    def write(self, stem, marks, told, m, found):
        """A frame, with the map where its lookup is known."""
        told = self.base | told
        if found and found.constant >= 0:
            technique = found.technique() | {'map.cull': m.cull}
            factor, units = (-n if m.reversed else n for n in m.draws[0].polygon_offset)
            if factor or units:
                technique |= {'bias.polygon_factor': repr(factor), 'bias.polygon_units': repr(units)}
            told['map'] = (save(f'{stem}-depths.npy', m.depths[::-1]) | space(m.clip, m)
                           | {'first_row': 'bottom', 'technique': technique})
        told['visibility'] = save(f'{stem}.npy', marks) | told['visibility']
        with open(f'{stem}.json', 'w') as f:
            json.dump(told, f, indent=1)
        self.frames.append(f'{stem}.json')

    def decided(self, group, target, lit, dark):
        """For each map of a light where it decides alone; in an atlas where it has the smallest texels of those that hold the place."""
        if len(group) == 1:
            return [True]
        if len({m.target for m in group}) == len(group) and not self.pictures.in_colours & set(group):
            shots = [self.pictures.replay(lit=[other for other in group if other is not m], dark=[m]) for m in group]
            return [divided(lit - shot[target], lit - dark) > 0.99 for shot in shots]
        holds = [lookup.Taps(m, self.place.reshape(-1, 3)).inside.reshape(self.surface.shape) for m in group]
        size = [np.linalg.norm(m.clip[0, :3]) for m in group]
        return [mine & ~np.any([h for h, s in zip(holds, size) if s > own], axis=0) for mine, own in zip(holds, size)]

    def why_unknown(self, m, mine, is_missed):
        """Why the lookup of this map cannot be known; '' where it can."""
        taps = lookup.Taps(m, self.place[mine])
        empty = np.mean(taps.read('none')[0][0][taps.inside] <= taps.z[taps.inside] - 1) if taps.inside.any() else 1.0
        reasons = {
            f'its shader moves the casters by {m.depth_off[0] / 2:.2g} to {m.depth_off[2] / 2:.2g} of window depth (a bias that grows with '
            'the slope)': m.is_moved,
            'it holds moments or packed depths, whose lookup is not known': m in self.pictures.in_colours,
            'its depths read as one value': np.ptp(m.depths) == 0,
            f'only {mine.sum()} pixels look it up': mine.sum() < lookup.FEWEST_RECEIVERS,
            'its viewport fills a part of the texture': self.unfilled(m),
            f'it holds nothing under {100 * empty:.0f}% of the receivers, which are no casters in it': is_missed and empty > EMPTY}
        return next((why for why, is_so in reasons.items() if is_so), '')

    def not_in(self, group):
        """Names of the draws of the picture that no map's pass draws, and whose places lie behind nothing in the maps that see them."""
        drawn, seeds = [d for m in group for d in m.pairs.values()], np.random.default_rng(0)
        for part in self.parts:
            if part.drawn is self.camera and part.draw not in drawn:
                weights = seeds.dirichlet((1, 1, 1), max(8, 800 // len(part.triangles)))
                places = solve.few(np.einsum('sk,tkc->tsc', weights, part.triangles).reshape(-1, 3), 2000)
                farther = np.concatenate([lookup.Taps(m, places).farther() for m in group])
                # A closed caster has a half of its faces at the map's depths or behind them, or all of those that are not culled.
                if len(farther) >= 12 and np.percentile(farther, 90 if group[0].cull == 'front' else 50) < -lookup.AT_TEXEL:
                    yield part.name


def read(options):
    rd.InitialiseReplay(rd.GlobalEnvironment(), [])
    os.chdir(options.out)
    np.seterr(all='ignore')  # a number without a meaning is NaN, and is left out where it is used
    reader, refused = Reader(options), []
    wanted = [(n, group) for n, group in enumerate(reader.lights, 1) if options.light in (0, n)]
    if not wanted:
        raise Refusal(f'there is no light {options.light}: it has {len(reader.lights)}')
    for n, group in wanted:
        try:
            for note in reader.light(f'light-{n}', group):
                print(f'light {n}: {note}')
        except Refusal as why:
            print(f'light {n}: refused: {why}')
            refused.append(str(why))
    if len(refused) == len(wanted):
        raise Refusal('no light of this capture can be judged: ' + '; '.join(sorted(set(refused))))
    with open('capture.json', 'w') as f:
        json.dump({'frames': reader.frames}, f)
