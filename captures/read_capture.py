"""A capture -> frame.json and its files for each light. Runs confined, as the child of capture.py."""
import json
import os
import sys
import tempfile

import numpy as np
import renderdoc as rd

import copies
import lookup
import scene
import solve
import visibility
from replay import Capture, Refusal

SAMPLE_0 = {2: (0.75, 0.75), 4: (0.375, 0.125), 8: (0.5625, 0.3125)}  # Vulkan's and OpenGL's standard places; others: the centre

MOVED = 1e-4  # clip units by which vertices of a map are off its own matrix, before a bias in its shader is said
EMPTY = 0.3  # of the receivers that read an empty texel, before the ground is taken for no caster of the map
UNEXPLAINED = 0.01  # of the receivers: a tenth of that is left where the lookup is one of those that are known
TEXELS_BEFORE = 4  # how far before the map's depths a caster lies that the map lacks: more than a slope does within a texel


def top_first(image):
    return np.ascontiguousarray(image[::-1], '<f4')


class Reader:
    def __init__(self, options):
        self.options, self.folder = options, options.out
        self.capture = Capture(options.capture)
        c = self.capture
        self.draws = c.draws()
        self.vertices = solve.Vertices(c, self.say)
        self.passes = solve.passes_of(self.draws)
        self.camera, self.maps = solve.camera_and_maps(c, self.passes, self.vertices, self.say)
        self.lights = solve.lights_of(self.maps)
        self.zero_to_one = self.camera.draws[0].zero_to_one
        self.found = {'api': c.driver, 'draws': len(self.draws), 'lights': []}

    def say(self, text):
        print(text, flush=True)

    def save(self, name, image):
        np.save(os.path.join(self.folder, name), top_first(image))
        return {'file': name}

    def describe(self):
        c, cam = self.capture, self.camera
        self.say(f'{c.driver}, {len(self.draws)} draws; the picture: {cam.name}, {cam.viewport[2]:.0f} x {cam.viewport[3]:.0f}, '
                 f'{"orthographic" if cam.camera.orthographic else "perspective"} camera (from {cam.camera.draws} rigid draws)')
        for n, group in enumerate(self.lights, 1):
            for m in group:
                f, u = m.drawn.draws[0].polygon_offset
                self.say(f'light {n}, {solve.light_of(group)["kind"]}: map {c.describe(m.drawn.target)} "{c.names.get(m.drawn.target[0], "")}", '
                         f'{m.drawn.name}, {len(m.pairs)} of {len(m.drawn.draws)} draws are in the picture too, residual '
                         f'{m.residual:.1e}' + (f', polygon offset {f:g} / {u:g}' if f or u else '')
                         + ('' if m.cull == 'none' else f', without {m.cull} faces by their winding') + self.unfilled(m))

    def unfilled(self, m):
        """Of a map that is drawn into a part of a texture into which nothing else is drawn."""
        t, (_, _, w, h) = self.capture.textures[m.drawn.target[0]], m.drawn.viewport
        alone = all(p is m.drawn or m.drawn.target not in (p.depth, *p.outputs) for p in self.passes)
        return f'; its viewport {w:.0f} x {h:.0f} fills a part of the texture, and nothing fills the rest: an atlas, or a forgotten viewport' if alone and w * h < t.width * t.height else ''

    def depth(self):
        cam = self.camera
        if not cam.depth:
            raise Refusal('the picture is drawn without a depth buffer')
        image = visibility.crop(self.capture.image(cam.depth, cam.last), cam.viewport)[..., 0]
        if np.ptp(image) == 0:
            raise Refusal('the depth buffer of the picture reads as one value (OpenGL ES cannot read some depths); nothing can be judged')
        return image

    def matrix(self):
        """Of the camera, through the place of sample 0."""
        jitter = np.eye(4)
        x, y = SAMPLE_0.get(self.camera.draws[0].samples, (0.5, 0.5))
        jitter[0, 3], jitter[1, 3] = (2 * (0.5 - s) / n for s, n in zip((x, y), self.camera.viewport[2:]))
        return jitter @ self.camera.camera.clip

    def run(self):
        self.describe()
        c, depth = self.capture, self.depth()
        for m in self.maps:
            m.depths = visibility.crop(c.image(m.drawn.target, m.drawn.last), m.drawn.viewport)[..., 0]
        parts = scene.casters(self.camera, self.maps, self.vertices, c, self.say, self.options.casters)
        scene.write_glb(os.path.join(self.folder, 'scene.glb'), parts, c)
        far = 0.0 if self.camera.draws[0].reversed else 1.0
        place, normal = lookup.receivers(depth, self.camera.camera, self.zero_to_one)
        surface = depth != far
        with tempfile.TemporaryDirectory() as work:
            edited = copies.Copies(self.options.capture, work)
            pictures = visibility.Pictures(c, self.camera, self.maps, self.passes, self.draws, edited, self.say)
            if self.options.light > len(self.lights):
                raise Refusal(f'there is no light {self.options.light}: it has {len(self.lights)}')
            for n, group in enumerate(self.lights, 1):
                if self.options.light in (0, n):
                    try:
                        self.light(n, group, pictures, parts, depth, place, normal, surface)
                    except Refusal as why:
                        self.say(f'light {n}: refused: {why}')
                        self.found['lights'].append({'light': n, 'refused': str(why)})
        with open(os.path.join(self.folder, 'capture.json'), 'w') as f:
            json.dump(self.found, f, indent=1)
        if not any('frames' in l for l in self.found['lights']):
            raise Refusal('no light of this capture can be judged: ' + '; '.join(sorted({l['refused'] for l in self.found['lights']})))

    def light(self, n, group, pictures, parts, depth, place, normal, surface):
        c = self.capture
        v, lit, dark, target, notes = visibility.measure(pictures, group)
        light = solve.light_of(group)
        facing = (normal * lookup.to_light(light, place)).sum(-1) > 0
        reacts = np.isfinite(v)
        mute = surface & ~reacts & facing
        if (reacts & surface & facing).sum() < 100:
            raise Refusal(f'only {(reacts & surface & facing).sum()} pixels that face the light react to the map of {group[0].drawn.name}')
        marks = np.where(reacts, v, np.where(facing, visibility.NOT_JUDGED, 0))
        marks[~surface] = visibility.NO_SURFACE
        if mute.any():
            notes.append(f'{mute.sum()} pixels face the light and do not react to its map: they are not judged')
        shares = visibility.shares(pictures, group, target, lit, dark)
        lookups, frames, missing = [], [], set(self.not_in(group, parts))
        for k, m in enumerate(group):
            mine = surface & reacts & facing & (shares[k] > 0.99 if shares else self.first_inside(group, k, place))
            why = self.why_unknown(m, mine, place, pictures.colour[id(m)], missing)
            found = None if why else lookup.explain(m, place[mine], normal[mine], v[mine], self.options.filter, self.options.bias)
            lookups.append((m, mine, found))
            notes.append(f'map {c.describe(m.drawn.target)}, {m.drawn.name}: {self.words(m, found, why)}')
        if missing:
            notes.append(f'not in the map although in the picture: {", ".join(sorted(missing))}')
        light = self.true_light(m, light, notes, target, [f.wrong if f else None for *_, f in lookups])
        if light.get('position') != group[0].light.get('position'):
            lookups = [(m, mine, None) for m, mine, _ in lookups]
        base = {'noonmark_frame': 1, 'scene': 'scene.glb', 'light': light,
                'camera': {'clip_from_world': self.matrix().flatten().tolist(), 'order': 'row',
                           'depth_range': '0..1' if self.zero_to_one else '-1..1', 'reversed': self.camera.draws[0].reversed},
                'depth': dict(self.save('depth.npy', depth), measure='window'), 'notes': notes} | ({'not_in_map': sorted(missing)} if missing else {})
        decoded = any(f and f.decoded for *_, f in lookups)
        name = f'light-{n}'
        picture = lambda stem, marks: dict(self.save(f'{stem}.npy', marks), normalised=True, **({'encoding': 'srgb'} if decoded else {}))
        frames.append((name, base | {'visibility': picture(name, marks)} | (self.map(name, lookups[0][0], lookups[0][2]) if len(group) == 1 else {})))
        for k, (m, mine, found) in enumerate(lookups, 1):
            if len(group) > 1 and found:
                only = np.where(mine | ~surface | ~facing, marks, visibility.NOT_JUDGED)
                frames.append((f'{name}-map-{k}', base | {'light': m.light, 'visibility': picture(f'{name}-map-{k}', only)}
                               | self.map(f'{name}-map-{k}', m, found)))
        for stem, frame in frames:
            with open(os.path.join(self.folder, stem + '.json'), 'w') as f:
                json.dump(frame, f, indent=1)
        for note in notes:
            self.say(f'light {n}: {note}')
        self.found['lights'].append({'light': n, 'kind': light['kind'], 'frames': [f + '.json' for f, _ in frames], 'notes': notes})

    def first_inside(self, group, k, place):
        """Cascades in one texture: the map with the smallest texels that holds the receiver."""
        order = sorted(range(len(group)), key=lambda i: -np.linalg.norm(group[i].clip[0, :3]))
        taken = np.zeros(place.shape[:2], bool)
        for i in order:
            u, v, z = group[i].window(place.reshape(-1, 3))
            inside = ((u > 0) & (u < 1) & (v > 0) & (v < 1) & (z > 0) & (z < 1)).reshape(taken.shape) & ~taken
            if i == k:
                return inside
            taken |= inside

    def why_unknown(self, m, mine, place, is_colour, missing):
        """Why the lookup of this map cannot be known; '' where it can."""
        if np.abs(m.depth_off).max() > MOVED:
            return (f'its shader moves the casters by {m.depth_off[0] / 2:.2g} to {m.depth_off[2] / 2:.2g} of window depth (a bias that grows '
                    'with the slope)')
        if is_colour:
            return 'it holds moments or packed depths, whose lookup is not known'
        if np.ptp(m.depths) == 0:
            return 'its depths read as one value'
        if mine.sum() < 100:
            return f'only {mine.sum()} pixels look it up'
        if self.unfilled(m):
            return 'its viewport fills a part of the texture'
        if not missing:
            return ''
        taps = lookup.Taps(m, place[mine])
        empty = (taps.read('none')[0][0][taps.inside] <= taps.z[taps.inside] - 1).mean() if taps.inside.any() else 1.0
        return f'it holds nothing under {100 * empty:.0f}% of the receivers, which are no casters in it' if empty > EMPTY else ''

    def words(self, m, found, why):
        if not found:
            return (why or 'too few receivers for its lookup') + '; judged by place'
        per_unit = np.linalg.norm(m.clip[2, :3]) / (1 if m.zero_to_one else 2)
        length = f' ({found.constant / per_unit:.4g} units of length)' if m.light['kind'] == 'directional' and not self.camera.camera.orthographic else ''
        low, high = found.between or (found.constant, found.constant)
        alike = f' (from {low:.3g} to {high:.3g} alike)' if high - low > max(lookup.ROUNDING, 0.05 * abs(found.constant)) else ''
        return (f'filter {found.filter}, bias {found.constant:.4g} of window depth{length}{alike}'
                + (f' and {found.tan:.3g} tan' if found.tan else '')
                + f', which leaves {100 * found.misses:.2f}% unexplained'
                + (f', AND {100 * found.wrong:.2f}% ARE WRONG: they do not follow from the map at their own places' if found.wrong > UNEXPLAINED else '')
                + (', after sRGB is decoded' if found.decoded else '')
                + ('; A BIAS BELOW 0: its sign is wrong, or another value is compared; judged by place' if found.constant < 0 else ''))

    def not_in(self, group, parts):
        """Names of the draws of the picture that no map's pass draws, and whose places lie behind nothing in the maps that see them."""
        drawn = {d.event for m in group for d in m.pairs.values()}
        seeds = np.random.default_rng(0)
        for part in parts:
            if part.role != 'camera' or part.draw.event in drawn:
                continue
            weights = seeds.dirichlet((1, 1, 1), max(8, 800 // len(part.triangles)))
            places = np.einsum('sk,tkc->tsc', weights, part.triangles).reshape(-1, 3)
            places = places[np.linspace(0, len(places) - 1, min(len(places), 2000)).astype(int)]
            farther = np.concatenate([lookup.Taps(m, places).farther() for m in group])
            # A closed caster has a half of its faces at the map's depths or behind them, or all of those that are not culled.
            if len(farther) >= 12 and np.percentile(farther, 90 if group[0].cull == 'front' else 50) < -TEXELS_BEFORE:
                yield part.name

    def true_light(self, m, light, notes, target, wrong):
        """The light of the lookup's own matrix, where the map's vertices are moved and the constants hold it; and what the lookup does
        with another matrix. wrong: the share that the lookup of each map does not explain, None where that is not known."""
        maps = {o[0] for o in (m.drawn.depth, *m.drawn.outputs) if o}
        lit = [d for d in self.draws if target in d.outputs and maps & set(d.reads)]
        if not lit:
            return light
        t, (x, y, w, h) = self.capture.textures[m.drawn.target[0]], m.drawn.viewport
        part = [w / t.width / 2, (x + w / 2) / t.width, h / t.height / 2, (y + h / 2) / t.height]
        miss = lambda rows: min(np.abs([rows[0][0], rows[0][1], abs(rows[1][0]), rows[1][1]] - np.array(want)).max()
                                for want in ([1, 0, 1, 0], [0.5, 0.5, 0.5, 0.5], part))
        found = lookup.own_matrix(self.capture.matrices(lit[-1]), self.camera.camera, m)
        exact = [(miss(rows), name, rows) for rest, name, rows, *_ in found if rest < 1e-3]
        if light['kind'] == 'spot' and found:
            _, name, _, matrix = min(found, key=lambda e: e[0])
            centre = np.linalg.svd(matrix[[0, 1, 3]])[2][3]
            centre = centre[:3] / centre[3]
            way = centre - light['position']
            moved, axis = np.linalg.norm(way), m.clip[3, :3]
            is_along = abs(way @ axis) > 0.999 * moved * np.linalg.norm(axis)  # aside it would be another light, or another frame's
            if is_along and 1e-4 < moved / max(1, np.linalg.norm(centre)) < 0.1:
                notes.append(f'the map\'s vertices are moved by {moved:.4g} along the light (a bias in the map\'s shader); the truth is of '
                             f'the light that {name} looks up from')
                return light | {'position': centre.tolist()}
        # Of many constants some look alike by chance, moved by a draw's own place: that is a finding only where the lookup does not
        # follow from the map, and where that is not known, another scale is.
        scale = lambda rows: min(max(abs(rows[0][0] - want[0]), abs(abs(rows[1][0]) - want[2])) for want in ([1, 0, 1, 0], [0.5, 0.5, 0.5, 0.5], part))
        is_wrong, is_unknown = any(x and x > UNEXPLAINED for x in wrong), any(x is None for x in wrong)
        if exact and (is_wrong and min(e[0] for e in exact) > 1e-2 or is_unknown and min(scale(e[2]) for e in exact) > 1e-2):
            _, name, rows = min(exact, key=lambda e: e[0])
            notes.append(f'MAP AND LOOKUP DIFFER: the matrix {name} reads x = {rows[0][0]:.4f} X + {rows[0][1]:.4f}, y = {rows[1][0]:.4f} Y + '
                         f'{rows[1][1]:.4f}, where X and Y are those of the map as it is drawn; {part[0]:g} and {part[1]:g}, {part[2]:g} and '
                         f'{part[3]:g} would read it')
        elif (found and not exact and is_wrong
              and not self.camera.camera.orthographic):  # whose scale is not known, and so neither what leads to the world
            rest, name, *_ = min(found, key=lambda e: e[0])
            notes.append(f'MAP AND LOOKUP DIFFER: the matrix {name} is not that of the map, but off by {100 * rest:.2g}% (of another frame or '
                         'another light?), and no constant of the lit draw is nearer')
        elif is_wrong or is_unknown:
            astray = lookup.without_model(self.capture, self.camera.camera, m, lit)
            if astray:
                notes.append(f'MAP AND LOOKUP DIFFER: {", ".join(f"draw {d.event}" for d, _ in astray)}: {astray[0][1]} times their own vertices is '
                             'not where the map has them: the lookup lacks their model matrix')
        return light

    def map(self, name, m, found):
        if not found or found.constant < 0:
            return {}
        factor, units = m.drawn.draws[0].polygon_offset
        technique = found.technique | {'map.cull': m.cull}
        if factor or units:
            sign = -1 if m.reversed else 1
            technique |= {'bias.polygon_factor': repr(sign * factor), 'bias.polygon_units': repr(sign * units)}
        return {'map': dict(self.save(f'{name}-depths.npy', m.depths[::-1]), first_row='bottom', clip_from_world=m.clip.flatten().tolist(),
                            order='row', depth_range='0..1' if m.zero_to_one else '-1..1', reversed=m.reversed,
                            technique=technique)}


def main(options):
    rd.InitialiseReplay(rd.GlobalEnvironment(), [])
    try:
        Reader(options).run()
        code = 0
    except Refusal as why:
        print(f'noonmark: {options.capture}: {why}', file=sys.stderr)
        code = 3
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # RenderDoc's own ending can wait for a display that is gone
