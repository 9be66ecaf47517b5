"""From vertices that two passes draw: the camera, the matrices of the maps, the lights. No name is read.

The world is the camera's own axes: right, up, backwards, in the program's unit; `up` of the scene is not known, nor needed.
A pass is all draws into one depth target, its colour targets and one viewport: a cascade, a cube's face or the picture.
"""
import collections
import dataclasses

import numpy as np

from replay import Refusal

ON_MATRIX = 2e-3  # of the clip unit: vertices of the same draw lie within 1e-5, another draw's are off by far more
SAME_LIGHT = 1e-3
ON_LINE = 0.3  # of a pass's vertices, on the depths of one camera: the others are skies and quads


@dataclasses.dataclass
class Pass:
    draws: list
    depth: tuple
    outputs: tuple
    viewport: tuple
    camera: object = None

    @property
    def first(self):
        return self.draws[0].event

    @property
    def last(self):
        return self.draws[-1].event

    @property
    def target(self):
        return self.depth or self.outputs[0]

    @property
    def name(self):
        return f'pass {self.first}-{self.last}' if self.last > self.first else f'draw {self.first}'


@dataclasses.dataclass
class Camera:
    clip: np.ndarray  # 4 x 4: clip from the camera's axes
    orthographic: bool
    draws: int  # rigid draws that agree


@dataclasses.dataclass
class Map:
    drawn: Pass
    clip: np.ndarray  # 4 x 4: the light's clip space from the camera's axes
    light: dict  # frame.json's light
    pairs: dict  # event of the map's draw -> draw of the camera's pass
    residual: float  # 99 in 100 vertices are nearer to the matrix, in clip units
    depth_off: tuple  # 1, 50, 99 in 100: how far the vertices' depths lie off the matrix, clip units
    square: float  # cosine of its axes
    depths: np.ndarray = None  # as captured; rows start at the bottom

    @property
    def zero_to_one(self):
        return self.drawn.draws[0].zero_to_one

    @property
    def reversed(self):
        return self.drawn.draws[0].reversed

    @property
    def near(self):
        return 1 if self.reversed else 0

    @property
    def cull(self):
        """map.cull: the side of the triangles that most of the map's draws leave out."""
        turn = max(self.drawn.draws, key=lambda d: sum(e.count for e in self.drawn.draws if e.culls == d.culls)).culls
        mirrored = (np.linalg.det(self.clip[:3, :3]) > 0) != self.reversed
        return turn if turn == 'none' else 'front' if (turn == 'ccw') != mirrored else 'back'


    def window(self, place):
        """(u, v, depth) of places in the map, 0 to 1, near = 0."""
        q = np.c_[place, np.ones(len(place))] @ self.clip.T
        q = q[:, :3] / np.where(np.abs(q[:, 3:]) > 1e-12, q[:, 3:], 1)
        z = q[:, 2] if self.zero_to_one else q[:, 2] / 2 + 0.5
        return q[:, 0] / 2 + 0.5, q[:, 1] / 2 + 0.5, 1 - z if self.reversed else z


class Vertices:
    """The clip positions of draws, read once. Draws that cannot be read are named once and left out."""

    def __init__(self, capture, say):
        self.capture, self.say, self.known = capture, say, {}

    def of(self, draw):
        if draw.event not in self.known:
            try:
                self.known[draw.event] = self.capture.after_vertex_shader(draw)
            except Refusal as why:
                self.say(f'{why}; this draw is left out')
                self.known[draw.event] = None
        return self.known[draw.event]

    def clip(self, draw):
        found = self.of(draw)
        return None if found is None else found[0]


def passes_of(draws):
    found = collections.OrderedDict()
    for draw in draws:
        if draw.count >= 3 and (draw.depth or draw.outputs):
            found.setdefault(draw.place, []).append(draw)
    return [Pass(d, *key) for key, d in found.items()]


def usable(clip):
    return np.isfinite(clip).all(1) & (np.abs(clip[:, 3]) > 1e-6)


def few(rows, most=3000):
    return rows if len(rows) <= most else rows[np.linspace(0, len(rows) - 1, most).astype(int)]


def fit(source, image):
    """Least squares for image = M source, columns scaled alike: (M, rank, singular values)."""
    scale = np.abs(source).max(0)
    scale[scale == 0] = 1
    x, _, rank, singular = np.linalg.lstsq(source / scale, image, rcond=None)
    return (x / scale[:, None]).T, rank, singular


def off(matrix, source, image):
    """By how much x, y and w miss, in clip units. z is left out: engines put a bias into it."""
    return np.abs(source @ matrix.T - image)[:, (0, 1, 3)].max(1) / np.maximum(1e-9, np.abs(image[:, 3]))


def robust_line(t, y, rounds=6):
    """(slope, height) of y over t, without what does not lie on it."""
    keep = np.ones(len(t), bool)
    for _ in range(rounds):
        k, b = np.linalg.lstsq(np.c_[t[keep], np.ones(keep.sum())], y[keep], rcond=None)[0]
        e = np.abs(y - k * t - b)
        keep = e <= max(1e-7, 2 * np.median(e[keep]))
    return k, b


# ---- the camera of a pass
def camera_of(capture, drawn, vertices):
    """Depth row from all vertices; field of view from rigid draws, whose three axes are of one length. None if not told."""
    clips = [c for c in (vertices.clip(d) for d in drawn.draws) if c is not None]
    clips = [c[usable(c)] for c in clips]
    if not sum(len(c) for c in clips):
        return None
    clip = np.concatenate([few(c) for c in clips])
    flat_w = np.ptp(clip[:, 3]) < 1e-5 * np.abs(clip[:, 3]).max()
    if not flat_w:
        a, b = robust_line(clip[:, 3], clip[:, 2])
        if (np.abs(clip[:, 2] - a * clip[:, 3] - b) < 1e-4 * np.abs(clip[:, 3])).mean() < ON_LINE:
            return None
    found = []
    for draw in sorted(drawn.draws, key=lambda d: -d.count)[:60]:
        c = vertices.clip(draw)
        if c is None or draw.instances > 1:
            continue
        for place in capture.vertex_inputs(draw):
            if len(place) != len(c) or not np.isfinite(place).all():
                continue
            source = np.c_[place, np.ones(len(place))]
            g, rank, _ = fit(source, c)
            if rank < 4 or np.abs(source @ g.T - c).max() > 1e-4 * np.abs(c).max():
                continue
            x, y, along = g[0, :3], g[1, :3], (g[2, :3] if flat_w else g[3, :3])
            s = np.linalg.norm(along)
            if s == 0:
                continue
            cx, cy = (0, 0) if flat_w else (x @ along / s ** 2, y @ along / s ** 2)
            hx, hy = x - cx * along, y - cy * along
            lx, ly = np.linalg.norm(hx), np.linalg.norm(hy)
            skew = max(abs(hx @ hy) / (lx * ly), abs(hx @ along) / (lx * s), abs(hy @ along) / (ly * s))
            if skew < 1e-3:
                found.append((lx / s, ly / s, cx, cy))
    if not found:
        return None
    found = np.array(found)
    aspect = drawn.viewport[3] / drawn.viewport[2]
    square = found[np.abs(found[:, 0] / found[:, 1] / aspect - 1) < 5e-3]  # a draw scaled along one axis is not
    found = square if len(square) else found
    middle = np.median(found, axis=0)
    agree = found[np.abs(found[:, 0] / middle[0] - 1) < 1e-3]
    if not len(agree):  # each draw is scaled along one axis, in its own way
        return None
    fx, fy, cx, cy = np.median(agree, axis=0)
    cx, cy = (0.0 if abs(v) < 1e-6 else v for v in (cx, cy))
    if flat_w:
        # Lengths are in units of the depth: one unit of window depth is one unit, so the scale is free; the axes are not.
        toward = -1.0 if drawn.draws[0].reversed else 1.0
        return Camera(np.array([[fx, 0, 0, 0], [0, fy, 0, 0], [0, 0, -toward, 0], [0, 0, 0, 1.0]]), True, len(agree))
    return Camera(np.array([[fx, 0, -cx, 0], [0, fy, -cy, 0], [0, 0, -a, b], [0, 0, -1.0, 0]]), False, len(agree))


# ---- one pass against another
def on_depth_line(clip, camera):
    """The clip positions with z from w, in double. Their difference carries the matrix's constant, and rounds away in float where near is small."""
    if camera.orthographic:
        return clip
    z = -camera.clip[2, 2] * clip[:, 3] + camera.clip[2, 3]
    near = np.abs(z - clip[:, 2]) < 1e-6 * np.abs(clip[:, 3])
    return np.c_[clip[:, :2], np.where(near, z, clip[:, 2]), clip[:, 3]]


def matrix_between(light, camera, vertices):
    """(M, pairs, clip of the camera, clip of the light) with light = M camera over draws of both; None if none fits."""
    theirs = collections.defaultdict(list)
    for draw in camera.draws:
        theirs[draw.geometry].append(draw)
    mine = collections.defaultdict(list)
    for draw in light.draws:
        mine[draw.geometry].append(draw)
    candidates = [(a, b, len(mine[k]) == 1 == len(theirs[k])) for k in mine for a in mine[k][:6] for b in theirs.get(k, [])[:6]]
    candidates.sort(key=lambda t: (not t[2], -t[0].count))
    data = []
    for a, b, sure in candidates[:400]:
        l, c = vertices.clip(a), vertices.clip(b)
        if l is None or c is None or len(l) != len(c):
            continue
        keep = usable(l) & usable(c)
        if keep.sum() >= 3:
            data.append((a, b, sure, few(on_depth_line(c[keep], camera.camera)), few(l[keep])))
        if len(data) > 120:
            break
    seeds = [[x for x in data if x[2]]] + [[x] for x in data[:12]] + [[x, y] for x in data[:6] for y in data[:6] if x is not y]
    best = []
    for seed in filter(None, seeds):
        m, rank, singular = fit(np.concatenate([x[3] for x in seed]), np.concatenate([x[4] for x in seed]))
        if rank < 4 or singular[-1] < 1e-7 * singular[0]:
            continue  # flat geometry alone tells no matrix
        agree = [x for x in data if np.percentile(off(m, x[3], x[4]), 90) < ON_MATRIX]
        if len({x[0].event for x in agree}) > len({x[0].event for x in best}):
            best = agree
    if not best:
        return None
    c, l = (np.concatenate([x[i] for x in best]) for i in (3, 4))
    keep = np.ones(len(c), bool)
    for _ in range(4):  # what moves by itself between the passes is left out
        m, _, _ = fit(c[keep], l[keep])
        e = off(m, c, l)
        keep = e < max(1e-5, 4 * np.median(e[keep]))
    return m, {x[0].event: x[1] for x in best}, c[keep], l[keep]


def same_eye(m):
    """A prepass, a G-buffer, a picture of half the size: x stays x, y stays y."""
    mixed = np.abs(m[:2, 2:]).max() + abs(m[0, 1]) + abs(m[1, 0]) + np.abs(m[3, :2]).max() + np.abs(m[2, :2]).max()
    return mixed < 1e-4 * np.abs(m).max()


def map_of(light, camera, vertices):
    """The pass as a map of the camera's pass, or None."""
    solved = matrix_between(light, camera, vertices)
    if solved is None or same_eye(solved[0]):
        return None
    m, pairs, c, l = solved
    p = camera.camera.clip
    clip = m @ p
    parallel = np.abs(clip[3, :3]).max() < 1e-4 * abs(clip[3, 3]) * np.linalg.norm(clip[0, :3])
    if parallel:
        clip /= clip[3, 3]
        clip[3] = (0, 0, 0, 1)
        axis = np.cross(clip[0, :3], clip[1, :3])
        axis /= np.linalg.norm(axis)
    # The depth row has two numbers only: a bias in the vertex shader of the map bends a free fit.
    world = c @ np.linalg.inv(p).T
    t, z = (world[:, :3] @ axis / world[:, 3], l[:, 2] / l[:, 3]) if parallel else (l[:, 3], l[:, 2])
    k, b = robust_line(t, z)
    clip[2] = np.r_[k * axis, b] if parallel else k * clip[3] + np.r_[0, 0, 0, b]
    rest = z - k * t - b if parallel else (z - k * t - b) / l[:, 3]
    if parallel:
        toward = -1 if light.draws[0].reversed else 1
        axis = axis if clip[2, :3] @ axis * toward > 0 else -axis
        found, along = {'kind': 'directional', 'direction': axis.tolist()}, clip[2, :3]
    else:
        centre = np.linalg.svd(clip[[0, 1, 3]])[2][3]
        along = clip[3, :3]
        found = {'kind': 'spot', 'position': (centre[:3] / centre[3]).tolist(), 'direction': along.tolist(), 'cone_deg': 170.0}
    axes = [v / np.linalg.norm(v) for v in (clip[0, :3], clip[1, :3], along)]
    square = max(abs(axes[0] @ axes[1]), abs(axes[0] @ axes[2]), abs(axes[1] @ axes[2]))
    e = off(m, c, l)
    return Map(light, clip, found, pairs, float(np.percentile(e, 99)),
               tuple(np.percentile(rest, [1, 50, 99]).tolist()), float(square))


def camera_and_maps(capture, passes, vertices, say):
    """The pass of the picture, and the passes that draw its meshes from other eyes."""
    cameras = []
    for drawn in passes:
        if drawn.outputs:
            drawn.camera = camera_of(capture, drawn, vertices)
        if drawn.camera:
            cameras.append(drawn)
    if not cameras:
        raise Refusal('no pass of this frame tells a camera: its meshes are flat, or placed on the GPU without a linear '
                      'place for each vertex')
    warped = []
    for camera in sorted(cameras, key=lambda p: (-p.viewport[2] * p.viewport[3], -p.last)):
        maps = [map_of(p, camera, vertices) for p in passes
                if p is not camera and p.first < camera.last and not (p.viewport == camera.viewport and p.depth == camera.depth)]
        warped += [m.drawn.name for m in maps if m and m.square >= 0.05]
        maps = [m for m in maps if m and m.square < 0.05]
        if maps:
            return camera, maps
    if warped:
        raise Refusal(f'the map of {warped[0]} has axes that are not at right angles (a warped map, as light-space perspective shadow '
                      'maps are): its light cannot be told')
    raise Refusal('no pass draws the meshes of the picture from another eye: this frame draws no shadow map. Where a map is '
                  'kept over frames, move the light a little while the frame is captured')


def lights_of(maps):
    """Maps of one direction or of one place are those of one light."""
    groups = []
    for m in maps:
        for group in groups:
            a, b = group[0].light, m.light
            key = 'direction' if a['kind'] == 'directional' else 'position'
            if a['kind'] == b['kind'] and np.allclose(a[key], b[key], rtol=0, atol=SAME_LIGHT * max(1, np.abs(a[key]).max())):
                group.append(m)
                break
        else:
            groups.append([m])
    return groups


def light_of(group):
    """The light of a group's maps as frame.json has it: maps of one place that look in several directions are those of a point light."""
    light = group[0].light
    if light['kind'] == 'spot' and any(np.dot(m.light['direction'], light['direction']) < 0.5 * np.dot(light['direction'], light['direction'])
                                       for m in group):
        return {'kind': 'point', 'position': light['position']}
    return dict(light)
