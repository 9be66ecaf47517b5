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
SQUARE = 0.05  # cosine between the axes of a map


@dataclasses.dataclass
class Pass:
    """Of a picture or of a map. As a map it is a copy, whose clip space is the light's."""
    draws: list
    depth: tuple
    outputs: tuple
    viewport: tuple
    clip: np.ndarray = None  # 4 x 4: clip space from the camera's axes; None where the pass tells no camera
    orthographic: bool = False
    # Of a map:
    light: dict = None  # frame.json's light
    pairs: dict = None  # event of the map's draw -> draw of the camera's pass
    residual: float = None  # 99 in 100 vertices are nearer to the matrix, in clip units
    depth_off: np.ndarray = None  # 1, 50, 99 in 100: how far the vertices' depths lie off the matrix, clip units
    depths: np.ndarray = None  # as captured; rows start at the bottom

    def __post_init__(self):
        self.first, self.last = self.draws[0].event, self.draws[-1].event
        self.zero_to_one, self.reversed = self.draws[0].zero_to_one, self.draws[0].reversed
        self.target = self.depth or self.outputs[0]
        self.textures = {t[0] for t in (self.depth, *self.outputs) if t}
        self.name = f'pass {self.first}-{self.last}' if self.last > self.first else f'draw {self.first}'
        self.meshes = collections.defaultdict(list)
        for draw in self.draws:
            self.meshes[draw.geometry].append(draw)

    def window(self, place):
        """(u, v, depth) of places, 0 to 1."""
        q = with_one(place) @ self.clip.T
        q = q[:, :3] / np.where(np.abs(q[:, 3:]) > 1e-12, q[:, 3:], 1)
        return q[:, 0] / 2 + 0.5, q[:, 1] / 2 + 0.5, q[:, 2] if self.zero_to_one else q[:, 2] / 2 + 0.5

    def place(self, u, v, depth):
        """The reverse of window()."""
        with np.errstate(all='ignore'):
            q = with_one(np.c_[2 * u - 1, 2 * v - 1, depth if self.zero_to_one else 2 * depth - 1]) @ np.linalg.inv(self.clip).T
            return q[:, :3] / q[:, 3:]

    def texel(self, place):
        """The width of a map's texel at places, in units of length."""
        axis = self.clip[3, :3]
        across = self.clip[0, :3] - (self.clip[0, :3] @ axis) * axis / (axis @ axis or 1)
        return 2 * (with_one(place) @ self.clip[3]) / np.linalg.norm(across) / self.depths.shape[1]

    @property
    def cull(self):
        """map.cull: the side of the triangles that most of the map's draws leave out."""
        turns = collections.Counter()
        for draw in self.draws:
            turns[draw.culls] += draw.count
        (turn, _), *_ = turns.most_common()
        mirrored = (np.linalg.det(self.clip[:3, :3]) > 0) != self.reversed
        return turn if turn == 'none' else 'front' if (turn == 'ccw') != mirrored else 'back'


def passes_of(draws):
    found = collections.defaultdict(list)
    for draw in draws:
        if draw.count >= 3 and (draw.depth or draw.outputs):
            found[draw.depth, draw.outputs, draw.viewport].append(draw)
    return [Pass(d, *key) for key, d in found.items()]


# ---- numbers
def with_one(places):
    return np.c_[places, np.ones(len(places))]


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


def robust_line(t, y):
    """(slope, height) of y over t, without what does not lie on it."""
    keep = np.ones(len(t), bool)
    for _ in range(6):
        k, b = np.linalg.lstsq(with_one(t[keep]), y[keep], rcond=None)[0]
        e = np.abs(y - k * t - b)
        keep = e <= max(1e-7, 2 * np.median(e[keep]))
    return k, b


def centre_of(clip):
    """Where a perspective clip matrix looks from."""
    centre = np.linalg.svd(clip[[0, 1, 3]])[2][3]
    return centre[:3] / centre[3]


# ---- the camera of a pass
def field_of(g, orthographic):
    """(fx, fy, cx, cy) of the camera that draws an object by clip = g object, if the object's axes stay at right angles; else None."""
    x, y, along = g[0, :3], g[1, :3], g[2 if orthographic else 3, :3]
    if not along.any():
        return None
    cx, cy = (0, 0) if orthographic else (x @ along / (along @ along), y @ along / (along @ along))
    axes = np.array([x - cx * along, y - cy * along, along])
    length = np.linalg.norm(axes, axis=1)
    is_right = np.abs(axes @ axes.T - np.diag(length ** 2)).max() < 1e-3 * length.min() * length.max()
    return (length[0] / length[2], length[1] / length[2], cx, cy) if is_right else None


def find_camera(drawn, capture):
    """Depth row from all vertices; field of view from rigid draws, whose three axes are of one length."""
    clips = [few(c[usable(c)]) for c in map(capture.clip, drawn.draws)]
    clip = np.concatenate(clips)
    if not len(clip):
        return
    drawn.orthographic = np.ptp(clip[:, 3]) < 1e-5 * np.abs(clip[:, 3]).max()
    if not drawn.orthographic:
        a, b = robust_line(clip[:, 3], clip[:, 2])
        if (np.abs(clip[:, 2] - a * clip[:, 3] - b) < 1e-4 * np.abs(clip[:, 3])).mean() < ON_LINE:
            return
    found = []
    for draw in sorted(drawn.draws, key=lambda d: -d.count)[:60]:
        c = capture.clip(draw)
        for place in capture.vertex_inputs(draw) if draw.instances == 1 else []:
            if len(place) == len(c) > 0 and np.isfinite(place).all():
                g, rank, _ = fit(with_one(place), c)
                if rank == 4 and np.abs(with_one(place) @ g.T - c).max() <= 1e-4 * np.abs(c).max():
                    found.append(field_of(g, drawn.orthographic))
    found = np.array([f for f in found if f]).reshape(-1, 4)
    square = found[np.abs(found[:, 0] / found[:, 1] / (drawn.viewport[3] / drawn.viewport[2]) - 1) < 5e-3]
    found = square if len(square) else found  # a draw scaled along one axis is not
    agree = found[np.abs(found[:, 0] / np.median(found[:, 0]) - 1) < 1e-3] if len(found) else found
    if not len(agree):  # each draw is scaled along one axis, in its own way
        return
    fx, fy, cx, cy = np.median(agree, axis=0)
    cx, cy = (0.0 if abs(v) < 1e-6 else v for v in (cx, cy))
    # An orthographic camera's lengths are in units of the depth: one unit of window depth is one unit, so the scale is free.
    drawn.clip = (np.diag([fx, fy, 1.0 if drawn.reversed else -1.0, 1.0]) if drawn.orthographic else
                  np.array([[fx, 0, -cx, 0], [0, fy, -cy, 0], [0, 0, -a, b], [0, 0, -1.0, 0]]))


# ---- one pass against another
def on_depth_line(clip, camera):
    """The clip positions with z from w, in double. Their difference carries the matrix's constant, and rounds away in float
    where near is small."""
    if camera.orthographic:
        return clip
    z = -camera.clip[2, 2] * clip[:, 3] + camera.clip[2, 3]
    near = np.abs(z - clip[:, 2]) < 1e-6 * np.abs(clip[:, 3])
    return np.c_[clip[:, :2], np.where(near, z, clip[:, 2]), clip[:, 3]]


def matrix_between(light, camera, capture):
    """(M, pairs, clip of the camera, clip of the light) with light = M camera over draws of both; None if none fits."""
    theirs, mine = camera.meshes, light.meshes
    candidates = [(a, b, len(mine[k]) == 1 == len(theirs[k])) for k in mine for a in mine[k][:6] for b in theirs.get(k, [])[:6]]
    candidates.sort(key=lambda t: (not t[2], -t[0].count))
    data = []
    for a, b, sure in candidates[:400]:
        l, c = capture.clip(a), capture.clip(b)
        keep = usable(l) & usable(c) if len(l) == len(c) else np.zeros(0)
        if keep.sum() >= 3:
            data.append((a, b, sure, few(on_depth_line(c[keep], camera)), few(l[keep])))
        if len(data) > 120:
            break
    seeds = [[x for x in data if x[2]]] + [[x] for x in data[:12]] + [[x, y] for x in data[:6] for y in data[:6] if x is not y]
    best = []
    for seed in filter(None, seeds):
        m, rank, singular = fit(np.concatenate([x[3] for x in seed]), np.concatenate([x[4] for x in seed]))
        if rank == 4 and singular[-1] >= 1e-7 * singular[0]:  # flat geometry alone tells no matrix
            agree = [x for x in data if np.percentile(off(m, x[3], x[4]), 90) < ON_MATRIX]
            best = max(best, agree, key=lambda of: len({x[0].event for x in of}))
    if not best:
        return None
    c, l = (np.concatenate([x[i] for x in best]) for i in (3, 4))
    keep = np.ones(len(c), bool)
    for _ in range(4):  # what moves by itself between the passes is left out
        m, _, _ = fit(c[keep], l[keep])
        e = off(m, c, l)
        keep = e < max(1e-5, 4 * np.median(e[keep]))
    return m, {x[0].event: x[1] for x in best}, c[keep], l[keep]


def map_of(light, camera, capture):
    """The pass as a map of the camera's pass, or None."""
    solved = matrix_between(light, camera, capture)
    if not solved:
        return None
    m, pairs, c, l = solved
    mixed = np.abs(m[:2, 2:]).max() + abs(m[0, 1]) + abs(m[1, 0]) + np.abs(m[3, :2]).max() + np.abs(m[2, :2]).max()
    if mixed < 1e-4 * np.abs(m).max():
        return None  # x stays x, y stays y: a prepass, a G-buffer, a picture of half the size
    clip = m @ camera.clip
    parallel = np.abs(clip[3, :3]).max() < 1e-4 * abs(clip[3, 3]) * np.linalg.norm(clip[0, :3])
    # The depth row has two numbers only: a bias in the vertex shader of the map bends a free fit.
    if parallel:
        clip /= clip[3, 3]
        clip[3] = (0, 0, 0, 1)
        axis = np.cross(clip[0, :3], clip[1, :3])
        row = np.r_[axis / np.linalg.norm(axis), 0]
        world = c @ np.linalg.inv(camera.clip).T
        t, z, unit = world @ row / world[:, 3], l[:, 2] / l[:, 3], 1
    else:
        row, t, z, unit = clip[3], l[:, 3], l[:, 2], l[:, 3]
    k, b = robust_line(t, z)
    clip[2] = k * row + (0, 0, 0, b)
    along = (row if not parallel or (k > 0) != light.reversed else -row)[:3]
    axes = np.array([v / np.linalg.norm(v) for v in (clip[0, :3], clip[1, :3], along)])
    if np.abs(axes @ axes.T - np.eye(3)).max() > SQUARE:
        print(f'{light.name} draws with axes that are not at right angles (a warped map?): its light cannot be told')
        return None
    found = {'kind': 'directional', 'direction': along.tolist()} if parallel else {
        'kind': 'spot', 'position': centre_of(clip).tolist(), 'direction': along.tolist(), 'cone_deg': 170.0}
    return dataclasses.replace(light, clip=clip, light=found, pairs=pairs, residual=float(np.percentile(off(m, c, l), 99)),
                               depth_off=np.percentile((z - k * t - b) / unit, [1, 50, 99]))


def camera_and_maps(capture, passes):
    """The pass of the picture, and the passes that draw its meshes from other eyes."""
    for drawn in passes:
        if drawn.outputs:
            find_camera(drawn, capture)
    cameras = [p for p in passes if p.clip is not None]
    if not cameras:
        raise Refusal('no pass of this frame tells a camera: its meshes are flat, or placed on the GPU without a linear '
                      'place for each vertex')
    for camera in sorted(cameras, key=lambda p: (-p.viewport[2] * p.viewport[3], -p.last)):
        maps = [map_of(p, camera, capture) for p in passes
                if p is not camera and p.first < camera.last and not (p.viewport == camera.viewport and p.depth == camera.depth)]
        if any(maps):
            return camera, list(filter(None, maps))
    raise Refusal('no pass draws the meshes of the picture from another eye: this frame draws no shadow map. Where a map is '
                  'kept over frames, move the light a little while the frame is captured')


# ---- the lights
def lights_of(maps):
    """Maps of one direction or of one place are those of one light."""
    def is_same(a, b):
        key = 'direction' if a['kind'] == 'directional' else 'position'
        return a['kind'] == b['kind'] and np.allclose(a[key], b[key], rtol=0, atol=SAME_LIGHT * max(1, np.abs(a[key]).max()))
    groups = []
    while maps:
        groups.append([m for m in maps if is_same(maps[0].light, m.light)])
        maps = [m for m in maps if not is_same(maps[0].light, m.light)]
    return groups


def light_of(group):
    """The light of a group's maps as frame.json has it: a point light if maps of one place look in several directions."""
    light = group[0].light
    ways = [np.array(m.light['direction']) for m in group]
    if light['kind'] == 'spot' and any(way @ ways[0] < 0.5 * ways[0] @ ways[0] for way in ways):
        return {'kind': 'point', 'position': light['position']}
    return dict(light)
