"""The casters and receivers of the frame as triangles in the camera's axes, written as a GLB: one node a draw."""
import collections
import dataclasses
import itertools
import json
import struct
import zlib

import numpy as np
import renderdoc as rd

from lookup import AT_TEXEL, Taps
from replay import Refusal
from solve import grouped, usable

HOLED = 0.05  # of the places of a part that the map lacks, with all texels around them, before it is said to have holes
MOST_NAMED = 64  # instances of a draw, each a part of its own
ENOUGH = 100  # places of a part that the map tells of, before its mask is looked for
SAME_PLACE = 2e-5  # of the scene's size: rounding of the same vertices through two matrices
FEWEST_HOLES = 0.005  # of the places of a part, before a mask is looked for
CUTS = sorted(np.linspace(0.05, 0.95, 19), key=lambda cut: abs(cut - 0.5))  # that programs drop fragments below, the usual ones first


@dataclasses.dataclass(eq=False)
class Part:
    name: str
    draw: object
    drawn: object  # the pass of the picture, or that of a map for what only that draws
    triangles: np.ndarray  # n x 3 x 3, of all instances
    coordinates: np.ndarray  # n x 3 x 2, of a mask; n x 3 x 0 if the draw has none
    shows_front: bool  # the picture has no backs of them
    mask: tuple = None  # (texture, channel, cutoff)


def part_of(draw, drawn, capture, camera):
    clip, coordinates = capture.clip(draw), capture.coordinates(draw)
    places = clip @ np.linalg.inv(drawn.clip).T
    good = usable(clip) & (np.abs(places[:, 3]) > 1e-12)
    places = places[:, :3] / np.where(good, places[:, 3], 1)[:, None]
    whole, corners = good.reshape(-1, 3).all(1), [2, 1, 0] if camera.culls_ccw else [0, 1, 2]
    triangles, coordinates = (rows.reshape(len(whole), 3, -1)[whole][:, corners] for rows in (places, coordinates))
    return Part(draw.name, draw, drawn, triangles, coordinates,
                drawn is camera and draw.culls_ccw is not None and draw.culls_ccw == camera.culls_ccw)


def by_instance(part):
    """A part for each instance, which a map's pass can lack alone."""
    n = part.draw.instances
    if not 1 < n <= MOST_NAMED or len(part.triangles) % n:
        return [part]
    each = zip(np.split(part.triangles, n), np.split(part.coordinates, n))
    return [dataclasses.replace(part, name=f'{part.name}, instance {k}', triangles=t, coordinates=c) for k, (t, c) in enumerate(each)]


def find_mask(part, shown_by, capture):
    """Sets the part's mask, if one explains where the depths of a pass hold it. Returns '', or 'holes' if none does, or 'nothing'.

    shown_by: (pass, its draw of the part). nothing: the picture has none of it. The shader's text tells nothing: a `discard` may stand under a constant that is 0.
    """
    seeds, found = np.random.default_rng(1), ''
    pick = seeds.integers(len(part.triangles), size=6000)
    weight = seeds.dirichlet((1, 1, 1), size=6000)[:, :, None]
    places, all_uv = ((corners[pick] * weight).sum(1) for corners in (part.triangles, part.coordinates))
    for drawn, draw in shown_by:
        taps = Taps(drawn, places)
        farther = taps.farther()
        told = farther < AT_TEXEL  # elsewhere something nearer hides it
        if told.sum() < ENOUGH:
            continue
        there, uv = (farther > -AT_TEXEL)[told], all_uv[taps.inside][told] % 1
        part.mask = mask_of(there, uv, draw, capture) if uv.shape[1] == 2 else None
        if part.mask:
            texture, channel, cut = part.mask
            print(f'{part.name} drops fragments by channel {channel} of "{capture.names.get(texture, "")}" below {cut:.2f}')
            return ''
        if (taps.farther('box3')[told] < -AT_TEXEL).mean() > HOLED:  # beside an outline a texel holds what is behind it
            found = 'nothing' if drawn is part.drawn and there.mean() < HOLED else 'holes'
    return found


def mask_of(there, uv, draw, capture):
    """(texture, channel, cutoff) that tells best which places are there; None if none tells a half of what one answer for all misses."""
    missed, mask = min(there.mean(), 1 - there.mean()) / 2, None
    for texture in draw.reads - capture.drawn_into if missed > FEWEST_HOLES else ():
        try:
            image = mask_image(texture, draw, capture)
        except Refusal:
            continue
        rows, columns = image.shape[:2]
        values = image[(uv[:, 1] * rows).astype(int) % rows, (uv[:, 0] * columns).astype(int) % columns]
        for channel, cut in itertools.product(range(image.shape[2]), CUTS):
            misses = ((values[:, channel] >= cut) != there).mean()
            if misses < missed:
                mask, missed = (texture, channel, float(cut)), misses
    return mask


def mask_image(texture, draw, capture):
    """Its first row is v = 0, in glTF as in the program."""
    image = capture.image((texture, 0, 0), draw.event)
    return image if capture.gl else image[::-1]


def once(parts):
    """The parts without what an earlier pass has: triangles whose centre and radius share a cell of a grid, or of one moved by half."""
    triangles = np.concatenate([p.triangles for p in parts])
    order = {drawn: k for k, drawn in enumerate(dict.fromkeys(p.drawn for p in parts))}
    count = [len(p.triangles) for p in parts]
    drawn = np.repeat([order[p.drawn] for p in parts], count)
    centre, again = triangles.mean(1), np.zeros(len(triangles), bool)
    rows = np.c_[centre, np.linalg.norm(triangles - centre[:, None], axis=2).max(1)]
    cells = rows / (4 * SAME_PLACE * np.linalg.norm(np.ptp(triangles.reshape(-1, 3), axis=0)))
    for moved in itertools.product((0, 0.5), repeat=4):
        cell = np.floor(cells + moved).astype('i8')
        _, cell = np.unique((cell - cell.min(0)) @ (1 << np.arange(0, 60, 15)), return_inverse=True)  # no axis has 2^15 cells
        first = np.full(len(cells), len(order))
        np.minimum.at(first, cell, drawn)
        again |= first[cell] < drawn
    return [dataclasses.replace(p, triangles=p.triangles[new], coordinates=p.coordinates[new])
            for p, new in zip(parts, np.split(~again, np.cumsum(count))) if new.any()]


def casters(camera, maps, capture):
    """Opaque draws of the picture, and what is only in the maps; the triangles of several passes once."""
    parts, paired = [], {b for m in maps for b in m.pairs.values()}
    for draw in (d for d in camera.draws if d.writes_depth):
        clip = capture.clip(draw)
        if camera.orthographic or not usable(clip).any() or np.median(camera.off_depths(clip[usable(clip)])) <= 1e-3:
            part = part_of(draw, camera, capture, camera)
            parts += [part] if draw in paired else by_instance(part)
        else:
            print(f'{draw.name} does not lie on the depths of the camera (a sky, a full screen): it is no caster')
    for m in maps:
        parts += [part_of(d, m, capture, camera) for d in m.draws if d.event not in m.pairs]
    parts = [p for p in parts if len(p.triangles)]
    if not parts:
        raise Refusal('the frame has no triangles that cast shadows')
    kept = once(parts)
    all_of, left, of_maps = (sum(len(p.triangles) for p in some) for some in (parts, kept, [p for p in kept if p.drawn is not camera]))
    print(f'{left} triangles of {len(kept)} draws; {of_maps} of them only in the maps; {all_of - left} are drawn again in other passes')
    in_maps = {}
    for m, d in ((m, d) for m in maps for d in m.draws if d.discards and (d.reads or not m.is_moved)):
        in_maps.setdefault(d.geometry, {})[m] = d

    def holes_of(part):
        is_shown = part.drawn is camera and part.draw.discards and part.draw.culls_ccw is None  # from both sides
        return find_mask(part, [*in_maps.get(part.draw.geometry, {}).items()] + [(camera, part.draw)] * is_shown, capture)

    found = grouped(kept, holes_of)
    holed = [str(part.draw.event) for part in found.get('holes', ())]
    if holed:
        print(f'these draws may drop fragments, and no texture explains which: {", ".join(dict.fromkeys(holed))}; they are '
              'solid casters here, so the shadows through their holes are not to be trusted')
    dropped = found.get('nothing', ())
    if dropped:
        print(f'these draws drop all their fragments, and are left out: {", ".join(part.name for part in dropped)}')
    return [part for part in kept if part not in dropped]


def png(alpha):
    """A white picture of 8 bits with this alpha, 0 to 1; the top row first."""
    pixels = np.full(alpha.shape + (4,), 255, 'u1')
    pixels[..., 3] = np.rint(255 * np.clip(alpha, 0, 1))
    rows = b''.join(b'\0' + row.tobytes() for row in pixels)
    chunk = lambda kind, data: struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    head = struct.pack('>IIBBBBB', *alpha.shape[::-1], 8, 6, 0, 0, 0)
    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', head) + chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b'')


def write_glb(path, parts, capture):
    """One node a draw, named as the debugger numbers it."""
    blob, gltf = bytearray(), collections.defaultdict(list)

    def add(kind, **item):
        gltf[kind].append(item)
        return len(gltf[kind]) - 1

    def view(data):
        number = add('bufferViews', buffer=0, byteOffset=len(blob), byteLength=len(data))
        blob.extend(data + b'\0' * (-len(data) % 4))
        return number

    materials = {}
    for part in sorted(parts, key=lambda p: p.draw.event):
        attributes = {}
        for name, rows in [('POSITION', part.triangles), ('TEXCOORD_0', part.coordinates)][:2 if part.mask else 1]:
            rows = np.ascontiguousarray(rows.reshape(-1, rows.shape[-1]), '<f4')
            attributes[name] = add('accessors', bufferView=view(rows.tobytes()), componentType=5126, count=len(rows),
                                   type=f'VEC{rows.shape[1]}', min=rows.min(0).tolist(), max=rows.max(0).tolist())
        look = part.mask, part.shows_front
        if look not in materials:
            masked = {}
            if part.mask:
                texture, channel, cut = part.mask
                alpha = mask_image(texture, part.draw, capture)[..., channel]
                texture = add('textures', source=add('images', bufferView=view(png(alpha)), mimeType='image/png'))
                masked = {'alphaMode': 'MASK', 'alphaCutoff': cut, 'pbrMetallicRoughness': {'baseColorTexture': {'index': texture}}}
            materials[look] = add('materials', doubleSided=not part.shows_front, **masked)
        mesh = add('meshes', name=part.name, primitives=[{'attributes': attributes, 'material': materials[look]}])
        add('nodes', mesh=mesh, name=part.name)
    gltf |= {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': list(range(len(parts)))}],
             'buffers': [{'byteLength': len(blob)}]}
    text = json.dumps(gltf).encode()
    text += b' ' * (-len(text) % 4)
    with open(path, 'wb') as f:
        f.write(struct.pack('<4sIII4s', b'glTF', 2, 28 + len(text) + len(blob), len(text), b'JSON') + text)
        f.write(struct.pack('<I4s', len(blob), b'BIN\0') + blob)
