"""The casters and receivers of the frame as triangles in the camera's axes, written as a GLB: one node a draw."""
import dataclasses
import json
import struct

import numpy as np
import renderdoc as rd

from replay import Refusal
from solve import usable

SAME_PLACE = 2e-5  # of the scene's size: rounding of the same vertices through two matrices

MASK_SAMPLES, ENOUGH = 200, 20  # places: of a triangle; that say whether its mask is one


@dataclasses.dataclass
class Part:
    draw: object
    role: str  # 'camera', or 'map': drawn into a map alone
    triangles: np.ndarray  # n x 3 x 3
    coordinates: np.ndarray = None  # n x 3 x 2, of a mask
    mask: object = None  # texture

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


def drops(m, draw, texture, vertices, capture):
    """Whether the map lacks the draw's own depths where the texture's alpha is below a half: a shader may have a `discard` that a
    constant switches off."""
    alpha = alpha_of(capture, texture, draw.event)
    size = np.array(draw.viewport[2:])
    depths = capture.image(m.drawn.target, m.drawn.last)[..., 0]
    clip, coordinates = vertices.of(draw) or (None, None)
    rows = triangle_rows(draw.topology, 0 if coordinates is None else len(clip))
    rows = rows[(clip[rows, 3] > 0).all(1)] if coordinates is not None and rows is not None else []
    if not len(rows):
        return False
    weights = np.random.default_rng(0).dirichlet((1, 1, 1), MASK_SAMPLES)
    q, uv = (np.einsum('sk,tkc->tsc', weights, a[rows]) for a in (clip, coordinates))
    window = lambda c: np.c_[(c[:, :2] / c[:, 3:] / 2 + 0.5) * size, c[:, 2] / c[:, 3] if draw.zero_to_one else c[:, 2] / c[:, 3] / 2 + 0.5]
    edges = np.diff(window(clip[rows].reshape(-1, 4)).reshape(-1, 3, 3), axis=1)
    normal = np.abs(np.cross(edges[:, 0], edges[:, 1]))
    slope = np.repeat((normal[:, 0] + normal[:, 1]) / np.maximum(normal[:, 2], 1e-12), MASK_SAMPLES)  # window depth a texel, at most
    at = window(q.reshape(-1, 4))
    inside = ((at > 0) & (at < (*size, 1))).all(1)
    column, row = (np.where(inside, at[:, k] + draw.viewport[k], 0).astype(int) for k in (0, 1))
    held = np.abs(at[:, 2] - depths[row, column]) < slope + 1e-4
    texel = lambda k, n: np.floor(uv[..., k].ravel() % 1 * n).astype(int) % n
    is_open = alpha[texel(1, alpha.shape[0]), texel(0, alpha.shape[1])] < 0.5
    holes, solid = inside & is_open, inside & ~is_open
    return bool(held[solid].sum() >= ENOUGH <= holes.sum()) and held[holes].mean() < 0.5 * held[solid].mean()


def alpha_of(capture, texture, event):
    """Rows by v, upwards."""
    rgba = np.clip(capture.image((texture, 0, 0), event), 0, 1)
    rgba = rgba if capture.gl else rgba[::-1]
    return rgba[..., 3] if rgba.shape[2] == 4 else rgba[..., 0]


def casters(camera, maps, vertices, capture, say, which='union'):
    """Opaque draws of the picture, and what is only in the maps; the triangles of several passes once."""
    to_camera = np.linalg.inv(camera.camera.clip)
    a, b = camera.camera.clip[2], camera.camera.clip[3]
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
            texture = next(iter(draw.reads), None) if draw.discards else None
            if texture is not None and drops(m, draw, texture, vertices, capture):
                masks[draw.geometry] = (draw, texture)
            if which == 'map' or which == 'union':
                if which == 'union' and draw.event in m.pairs:
                    continue
                parts += parts_of(draw, 'map', back, vertices)
    if not parts:
        raise Refusal('the frame has no triangles that cast shadows')
    kept, known = [], {}
    size = np.linalg.norm(np.ptp(np.concatenate([p.triangles.reshape(-1, 3) for p in parts]), axis=0))
    for part in parts:
        same = known.setdefault(part.draw.geometry[:-1] + (len(part.triangles),), [])
        if not any(np.abs(part.triangles - other).max() < SAME_PLACE * size for other in same):
            same.append(part.triangles)
            kept.append(part)
    say(f'{sum(len(p.triangles) for p in kept)} triangles of {len({p.draw.event for p in kept})} draws; '
        f'{sum(len(p.triangles) for p in parts if p.role == "map")} of them only in the maps; {len(parts) - len(kept)} draws again')
    for part in kept:
        if part.draw.geometry in masks:
            _, part.mask = masks[part.draw.geometry]
    for draw, texture in masks.values():
        say(f'draw {draw.event} drops fragments by the texture "{capture.names.get(texture, "")}": its alpha is taken as a mask')
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
            alpha = alpha_of(capture, part.mask, part.draw.event)
            pixels = np.full(alpha.shape + (4,), 255, 'u1')
            pixels[..., 3] = np.rint(alpha * 255)
            # The first row of the file is v = 0, in glTF as in the program.
            images.append({'bufferView': view(png(pixels)), 'mimeType': 'image/png'})
            textures.append({'source': len(images) - 1})
            materials.append({'doubleSided': True, 'alphaMode': 'MASK', 'alphaCutoff': 0.5,
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
