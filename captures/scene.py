"""The casters and receivers of the frame as triangles in the camera's axes, written as a GLB: one node a draw."""
import dataclasses
import itertools
import json
import struct

import numpy as np
import renderdoc as rd

from lookup import Taps
from replay import Refusal
from solve import usable

ENOUGH = 100  # places of a part that the map tells of, before its mask is looked for
SAME_PLACE = 2e-5  # of the scene's size: rounding of the same vertices through two matrices


@dataclasses.dataclass
class Part:
    draw: object
    role: str  # 'camera', or 'map': drawn into a map alone
    triangles: np.ndarray  # n x 3 x 3
    coordinates: np.ndarray = None  # n x 3 x 2, of a mask
    mask: object = None  # (texture, channel, cutoff)

    @property
    def name(self):
        return f'draw {self.draw.event}'


def triangle_rows(topology, count):
    """Rows of the vertices of each triangle; None for points and lines."""
    if topology == rd.Topology.TriangleList:
        return np.arange(count // 3 * 3).reshape(-1, 3)
    i = np.arange(max(0, count - 2))
    if topology == rd.Topology.TriangleStrip:
        return np.stack([i + i % 2, i + 1 - i % 2, i + 2], 1)
    if topology == rd.Topology.TriangleFan:
        return np.stack([0 * i, i + 1, i + 2], 1)
    return None


def parts_of(draw, role, to_camera, vertices):
    """The triangles of each instance of the draw."""
    found = vertices.of(draw)
    if found is None:
        return []
    clip, coordinates = found
    count = len(clip) if draw.has_geometry_shader else len(clip) // draw.instances
    rows = triangle_rows(draw.topology, count)
    parts = []
    for i in range(len(clip) // count if rows is not None and count >= 3 else 0):
        one = clip[i * count:(i + 1) * count]
        places = one @ to_camera.T
        good = usable(one) & (np.abs(places[:, 3]) > 1e-12)
        places = places[:, :3] / np.where(good, places[:, 3], 1)[:, None]
        keep = good[rows].all(1)
        uv = coordinates[i * count:(i + 1) * count][rows][keep] if coordinates is not None else None
        parts.append(Part(draw, role, places[rows][keep], uv))
    return [p for p in parts if len(p.triangles)]


def mask_of(part, m, draw, capture):
    """((texture, channel, cutoff) that explain best where the captured map holds the part, or None; whether it has holes there).

    The shader's text tells nothing: a `discard` may stand under a constant that is 0.
    """
    seeds = np.random.default_rng(1)
    pick = seeds.integers(len(part.triangles), size=6000)
    weight = seeds.dirichlet((1, 1, 1), size=6000)[:, :, None]
    taps = Taps(m, (part.triangles[pick] * weight).sum(1))
    beyond = taps.read('none')[0][0]
    slack = 4 * np.linalg.norm(m.clip[2, :3]) / np.linalg.norm(m.clip[0, :3]) / taps.columns
    told = taps.inside & (beyond < slack)  # elsewhere something nearer hides it
    if told.sum() < ENOUGH:
        return None, False
    there, uv = (np.abs(beyond) < slack)[told], ((part.coordinates[pick] * weight).sum(1) % 1)[told]
    best = (max(there.mean(), 1 - there.mean()), None)
    for texture in draw.reads:
        try:
            image = capture.image((texture, 0, 0), draw.event)
        except Refusal:
            continue
        image = image if capture.gl else image[::-1]
        rows, columns = image.shape[:2]
        value = image[(uv[:, 1] * rows).astype(int) % rows, (uv[:, 0] * columns).astype(int) % columns]
        for channel in range(image.shape[2]):
            for cut in np.linspace(0.05, 0.95, 19):
                agrees = ((value[:, channel] >= cut) == there).mean()
                if agrees > best[0] + 0.01 or (agrees > best[0] - 1e-9 and best[1] and best[1][1] == channel and abs(cut - 0.5) < abs(best[1][2] - 0.5)):
                    best = (agrees, (texture, channel, float(cut)))
    return best[1], there.mean() < 0.95


def described(triangles):
    """Centre and radius of each triangle: n x 4."""
    centre = triangles.mean(1)
    return np.c_[centre, np.linalg.norm(triangles - centre[:, None], axis=2).max(1)]


def among(rows, known, near):
    """Which rows lie within `near` of a known one along each axis: they share a cell of a grid, or of one that is moved by half a cell."""
    odd = np.array([0x9e3779b97f4a7c15, 0xc2b2ae3d27d4eb4f, 0x165667b19e3779f9, 0xd6e8feb86659fd93], 'u8')  # of a hash, modulo 2^64
    found = np.zeros(len(rows), bool)
    for moved in itertools.product((0, 0.5), repeat=4):
        cell = lambda d: (np.floor(d / (4 * near) + moved).astype('i8').astype('u8') * odd).sum(1)
        found |= np.isin(cell(rows), cell(known))
    return found


def casters(camera, maps, vertices, capture, say, which='union'):
    """Opaque draws of the picture, and what is only in the maps; the triangles of several passes once."""
    to_camera = np.linalg.inv(camera.camera.clip)
    a = camera.camera.clip[2]
    parts = []
    for draw in camera.draws if which != 'map' else []:
        if not draw.writes_depth:
            continue
        clip = vertices.clip(draw)
        if clip is None:
            continue
        if not camera.camera.orthographic:
            good = clip[usable(clip)]
            line = good[:, 2] + a[2] * good[:, 3] - a[3]  # z = -a.z w + a.w, see camera_of
            if len(good) and np.median(np.abs(line) / np.abs(good[:, 3])) > 1e-3:
                say(f'draw {draw.event} does not lie on the depths of the camera (a sky, a full screen): it is no caster')
                continue
        parts += parts_of(draw, 'camera', to_camera, vertices)
    masks = {}
    for m in maps:
        back = np.linalg.inv(m.clip)
        for draw in m.drawn.draws:
            if draw.discards and draw.reads:  # a shader with "discard" in a branch that reads nothing drops nothing
                masks[draw.geometry] = (m, draw)
            if which == 'map' or which == 'union':
                if which == 'union' and draw.event in m.pairs:
                    continue
                parts += parts_of(draw, 'map', back, vertices)
    if not parts:
        raise Refusal('the frame has no triangles that cast shadows')
    size = np.linalg.norm(np.ptp(np.concatenate([p.triangles.reshape(-1, 3) for p in parts]), axis=0))
    known, before = np.zeros((0, 4)), sum(len(p.triangles) for p in parts)
    for drawn in [camera, *(m.drawn for m in maps)]:
        events = {d.event for d in drawn.draws}
        mine = [p for p in parts if p.draw.event in events]
        if not mine:
            continue
        rows = described(np.concatenate([p.triangles for p in mine]))
        new = ~among(rows, known, SAME_PLACE * size)
        for part, keep in zip(mine, np.split(new, np.cumsum([len(p.triangles) for p in mine])[:-1])):
            part.triangles = part.triangles[keep]
            part.coordinates = part.coordinates[keep] if part.coordinates is not None else None
        known = np.concatenate([known, rows[new]])
    kept, holed = [p for p in parts if len(p.triangles)], []
    say(f'{len(known)} triangles of {len({p.draw.event for p in kept})} draws; {sum(len(p.triangles) for p in kept if p.role == "map")} of them '
        f'only in the maps; {before - len(known)} are drawn again in other passes')
    for part in kept:
        if part.draw.geometry in masks:
            m, draw = masks[part.draw.geometry]
            part.mask, has_holes = mask_of(part, m, draw, capture) if part.coordinates is not None else (None, True)
            if part.mask:
                texture, channel, cut = part.mask
                say(f'draw {draw.event} drops fragments by channel {channel} of "{capture.names.get(texture, "")}" below {cut:.2f}')
            elif has_holes:
                holed.append(draw.event)
    if holed:
        say(f'{"draws" if len(holed) > 1 else "draw"} {", ".join(map(str, dict.fromkeys(holed)))} may drop fragments, and no texture explains which: solid casters '
            'here, so the shadows through their holes are not to be trusted')
    return kept


def png(pixels):
    """An RGBA picture of 8 bits; the top row first."""
    import zlib
    height, width, _ = pixels.shape
    rows = b''.join(b'\0' + pixels[y].tobytes() for y in range(height))
    chunk = lambda kind, data: struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 6, 0, 0, 0))
            + chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))


def write_glb(path, parts, capture):
    """One node a draw, named as the debugger numbers it."""
    blob, views, accessors, meshes, nodes = bytearray(), [], [], [], []
    materials, images, textures, by_mask = [{'doubleSided': True}], [], [], {}

    def view(data):
        blob.extend(b'\0' * (-len(blob) % 4))
        views.append({'buffer': 0, 'byteOffset': len(blob), 'byteLength': len(data)})
        blob.extend(data)
        return len(views) - 1

    def accessor(rows, kind):
        rows = np.ascontiguousarray(rows, '<f4')
        accessors.append({'bufferView': view(rows.tobytes()), 'componentType': 5126, 'count': len(rows), 'type': kind,
                          'min': rows.min(0).tolist(), 'max': rows.max(0).tolist()})
        return len(accessors) - 1

    def material(part):
        if part.mask is None or part.coordinates is None:
            return 0
        if part.mask not in by_mask:
            texture, channel, cut = part.mask
            image = capture.image((texture, 0, 0), part.draw.event)
            image = np.clip(image if capture.gl else image[::-1], 0, 1)[..., channel]
            pixels = np.full(image.shape + (4,), 255, 'u1')  # its first row is v = 0, in glTF as in the program
            pixels[..., 3] = np.rint(image * 255)
            images.append({'bufferView': view(png(pixels)), 'mimeType': 'image/png'})
            textures.append({'source': len(images) - 1})
            materials.append({'doubleSided': True, 'alphaMode': 'MASK', 'alphaCutoff': cut,
                              'pbrMetallicRoughness': {'baseColorTexture': {'index': len(textures) - 1}}})
            by_mask[part.mask] = len(materials) - 1
        return by_mask[part.mask]

    for event in sorted({p.draw.event for p in parts}):
        same = [p for p in parts if p.draw.event == event]
        attributes = {'POSITION': accessor(np.concatenate([p.triangles.reshape(-1, 3) for p in same]), 'VEC3')}
        if material(same[0]):
            attributes['TEXCOORD_0'] = accessor(np.concatenate([p.coordinates.reshape(-1, 2) for p in same]), 'VEC2')
        nodes.append({'mesh': len(meshes), 'name': same[0].name})
        meshes.append({'name': same[0].name, 'primitives': [{'attributes': attributes, 'material': material(same[0])}]})
    blob.extend(b'\0' * (-len(blob) % 4))
    gltf = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': list(range(len(nodes)))}], 'nodes': nodes,
            'meshes': meshes, 'materials': materials, 'accessors': accessors, 'bufferViews': views,
            'buffers': [{'byteLength': len(blob)}]}
    if images:
        gltf |= {'images': images, 'textures': textures}
    text = json.dumps(gltf).encode()
    text += b' ' * (-len(text) % 4)
    with open(path, 'wb') as f:
        f.write(struct.pack('<4sII', b'glTF', 2, 28 + len(text) + len(blob)))
        f.write(struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(blob), b'BIN\0') + blob)
