"""From vertices that two passes draw: the camera, the matrices of the maps, the lights. No name is read.

The world is the camera's own axes: right, up, backwards, in the program's unit; `up` of the scene is not known, nor needed.
A pass is all draws into one depth target, its colour targets and one viewport: a cascade, a cube's face or the picture.
"""
import dataclasses
import functools
import itertools

import numpy as np

from replay import Refusal

ON_MATRIX = 2e-3  # of the clip unit: vertices of the same draw lie within 1e-5, another draw's are off by far more
SAME_LIGHT = 1e-3
ON_LINE = 0.3  # of a pass's vertices, on the depths of one camera: the others are skies and quads
SQUARE = 0.05  # cosine between the axes of a map
MOVED = 1e-4  # clip units by which vertices of a map are off its own matrix, before a bias in its shader is said


@dataclasses.dataclass(eq=False)
class Pass:
    """Of a picture or of a map. As a map it is a copy, whose clip space is the light's."""
    draws: list
    depth: tuple
    outputs: tuple
    viewport: tuple
    clip: np.ndarray = None  # 4 x 4: clip space from the camera's axes; None where the pass tells no camera
    orthographic: bool = False
    depths: np.ndarray = None  # as captured; rows start at the bottom
    # Of a map:
    along: np.ndarray = None  # the way of the light in the middle of the map, of any length
    eye: np.ndarray = None  # 4, homogeneous: where the light is, or the way to it
    pairs: dict = None  # event of the map's draw -> draw of the camera's pass
    residual: float = None  # 99 in 100 vertices are nearer to the matrix, in clip units
    depth_off: tuple = (0, 0, 0)  # 1, 50, 99 in 100: how far the vertices' depths lie off the matrix, clip units
    is_clockwise: bool = False  # the front of the picture's triangles, on its screen

    def __post_init__(self):
        self.first, self.last = self.draws[0].event, self.draws[-1].event
        self.zero_to_one, self.reversed = self.draws[0].zero_to_one, self.draws[0].reversed
        self.target = self.depth or self.outputs[0]
        self.textures = {t[0] for t in (self.depth, *self.outputs) if t}
        self.name = f'pass {self.first}-{self.last}' if self.last > self.first else self.draws[0].name
        self.meshes = grouped(self.draws, lambda draw: draw.geometry)

    def window(self, place):
        """(u, v, depth) of places, 0 to 1."""
        q = with_one(place) @ self.clip.T
        q = q[:, :3] / np.where(np.abs(q[:, 3:]) > 1e-12, q[:, 3:], 1)
        return q[:, 0] / 2 + 0.5, q[:, 1] / 2 + 0.5, q[:, 2] if self.zero_to_one else q[:, 2] / 2 + 0.5

    def place(self, u, v, depth):
        """The reverse of window()."""
        q = with_one(np.c_[2 * u - 1, 2 * v - 1, depth if self.zero_to_one else 2 * depth - 1]) @ np.linalg.inv(self.clip).T
        return q[:, :3] / q[:, 3:]

    def texel(self, place):
        """The width of a map's texel at places, in units of length."""
        along = np.linalg.norm(self.clip[3, :3]) or abs(self.clip[3, 3])
        return 2 * (with_one(place) @ self.clip[3]) / along / aperture(self.clip)[0] / self.depths.shape[1]

    def off_depths(self, clip):
        """By how much vertices miss the depths that a perspective camera gives to their w, in clip units."""
        return np.abs(clip[:, 2] + self.clip[2, 2] * clip[:, 3] - self.clip[2, 3]) / np.abs(clip[:, 3])

    @property
    def is_moved(self):
        """Whether the map's shader moves the casters by a bias that grows with the slope."""
        return np.abs(self.depth_off).max() > MOVED

    @functools.cached_property
    def culls_ccw(self):
        """As most of the draws."""
        return max((None, False, True), key=lambda ccw: sum(d.count for d in self.draws if d.culls_ccw == ccw))

    @property
    def cull(self):
        """map.cull, of the triangles of scene.glb, whose front is counterclockwise."""
        is_mirrored = (np.linalg.det(self.clip[:3, :3]) > 0) != self.reversed
        is_front = (self.culls_ccw != self.is_clockwise) != is_mirrored
        return 'none' if self.culls_ccw is None else 'front' if is_front else 'back'


def grouped(items, key):
    found = {}
    for item in items:
        found.setdefault(key(item), []).append(item)
    return found


# ---- numbers
def with_one(places):
    return np.c_[places, np.ones(len(places))]


def usable(clip):
    return np.isfinite(clip).all(1) & (np.abs(clip[:, 3]) > 1e-6)


def few(rows, most=3000):
    return rows if len(rows) <= most else rows[np.linspace(0, len(rows) - 1, most).astype(int)]


def fit(source, image):
    """Least squares for image = M source, columns scaled alike: (M, whether all of M is told)."""
    scale = np.abs(source).max(0)
    scale[scale == 0] = 1
    x, _, rank, singular = np.linalg.lstsq(source / scale, image, rcond=None)
    return (x / scale[:, None]).T, rank == 4 and singular[-1] >= 1e-7 * singular[0]


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


def aperture(clip):
    """The lengths of x and y of a clip matrix across its axis, for a w of length 1: neither a pose nor an added w changes them."""
    axis, size = clip[3, :3], np.linalg.norm(clip[3, :3])
    across = clip[:2, :3] - np.outer(clip[:2, :3] @ axis, axis) / (size ** 2 or 1)
    return np.linalg.norm(across, axis=1) / (size or abs(clip[3, 3]) or 1)


def skewed(axes):
    """The largest cosine between any two of three axes."""
    axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    return np.abs(axes @ axes.T - np.eye(3)).max()


# ---- the camera of a pass
def find_camera(drawn, capture):
    """Depth row from all vertices; field of view from rigid draws, whose three axes are of one length."""
    clip = np.concatenate([few(c[usable(c)]) for c in map(capture.clip, drawn.draws)])
    if not len(clip):
        return
    drawn.orthographic = np.ptp(clip[:, 3]) < 1e-5 * np.abs(clip[:, 3]).max()
    a, b = (0, 0) if drawn.orthographic else robust_line(clip[:, 3], clip[:, 2])
    if not drawn.orthographic and (np.abs(clip[:, 2] - a * clip[:, 3] - b) < 1e-4 * np.abs(clip[:, 3])).mean() < ON_LINE:
        return
    found = []
    for draw in sorted(drawn.draws, key=lambda d: -d.count)[:60]:
        c = capture.clip(draw)
        for place in capture.vertex_inputs(draw):
            g, is_told = fit(place, c)
            along = g[2 if drawn.orthographic else 3, :3]
            centre = g[:2, :3] @ along / (along @ along) * (not drawn.orthographic)
            axes = np.vstack([g[:2, :3] - np.outer(centre, along), along])
            if is_told and skewed(axes) < 1e-3 and np.abs(place @ g.T - c).max() <= 1e-4 * np.abs(c).max():
                length = np.linalg.norm(axes, axis=1)
                found.append([*length[:2] / length[2], *centre])
    found = np.reshape(found, (-1, 4))  # fx, fy, cx, cy
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
def matrix_between(light, camera, capture):
    """(M, pairs, clip of the camera, clip of the light) with light = M camera over draws of both; None if none fits."""
    both = [(mine, camera.meshes[mesh]) for mesh, mine in light.meshes.items() if mesh in camera.meshes]
    pairs = [(a, b, len(mine) == 1 == len(theirs)) for mine, theirs in both for a in mine[:6] for b in theirs[:6]]
    data = []
    for a, b, is_sure in sorted(pairs, key=lambda pair: (not pair[2], -pair[0].count))[:400]:
        l, c = capture.clip(a), capture.clip(b)
        keep = usable(l) & usable(c) if len(l) == len(c) else np.zeros(0)
        if keep.sum() >= 3 and len(data) <= 120:
            l, c = l[keep], c[keep].copy()
            # z from w, in double: their difference carries the matrix's constant, and rounds away in float where near is small.
            near = (not camera.orthographic) & (camera.off_depths(c) < 1e-6)
            c[near, 2] = camera.clip[2, 3] - camera.clip[2, 2] * c[near, 3]
            data.append((few(c), few(l), a.event, b, is_sure))
    joined = lambda some: [np.concatenate(clips) for clips in list(zip(*some))[:2]]
    best = []
    for seed in filter(None, [[d for d in data if d[4]], *([d] for d in data[:12]), *itertools.permutations(data[:6], 2)]):
        m, is_told = fit(*joined(seed))
        if is_told:  # flat geometry alone tells no matrix
            agree = [d for d in data if np.percentile(off(m, *d[:2]), 90) < ON_MATRIX]
            best = max(best, agree, key=lambda some: len({event for *_, event, _, _ in some}))
    if not best:
        return None
    c, l = joined(best)
    keep = np.ones(len(c), bool)
    for _ in range(4):  # what moves by itself between the passes is left out
        m, _ = fit(c[keep], l[keep])
        e = off(m, c, l)
        keep = e < max(1e-5, 4 * np.median(e[keep]))
    return m, {event: b for *_, event, b, _ in best}, c[keep], l[keep]


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
    row, t, z, unit = clip[3], l[:, 3], l[:, 2], l[:, 3]
    if parallel:
        clip /= clip[3, 3]
        clip[3] = (0, 0, 0, 1)
        axis = np.cross(clip[0, :3], clip[1, :3])
        row, world = np.r_[axis / np.linalg.norm(axis), 0], c @ np.linalg.inv(camera.clip).T
        t, z, unit = world @ row / world[:, 3], z / unit, 1
    k, b = robust_line(t, z)
    clip[2] = k * row + (0, 0, 0, b)
    along = (row if not parallel or (k > 0) != light.reversed else -row)[:3]
    if skewed(np.array([clip[0, :3], clip[1, :3], along])) > SQUARE:
        print(f'{light.name} draws with axes that are not at right angles (a warped map?): its light cannot be told')
        return None
    eye = np.append(-along, 0) if parallel else np.append(centre_of(clip), 1)
    return dataclasses.replace(light, is_clockwise=camera.culls_ccw is True, clip=clip, along=along, eye=eye, pairs=pairs,
                               residual=float(np.percentile(off(m, c, l), 99)),
                               depth_off=np.percentile((z - k * t - b) / unit, [1, 50, 99]))


def camera_and_maps(capture):
    """(all passes, the one of the picture, those that draw its meshes from other eyes)."""
    shown = [d for d in capture.draws if d.count >= 3 and (d.depth or d.outputs)]
    passes = [Pass(some, *key) for key, some in grouped(shown, lambda d: (d.depth, d.outputs, d.viewport)).items()]
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
            return passes, camera, list(filter(None, maps))
    raise Refusal('no pass draws the meshes of the picture from another eye: this frame draws no shadow map. Where a map is '
                  'kept over frames, move the light a little while the frame is captured')


# ---- the lights
def lights_of(maps):
    """Maps of one direction or of one place are those of one light."""
    is_one = lambda a, b: np.abs(a.eye - b.eye).max() <= SAME_LIGHT * max(1, np.abs(a.eye).max())
    return list(grouped(maps, lambda m: next(first for first in maps if is_one(first, m))).values())


def light_of(group):
    """The light of a group's maps as frame.json has it: a point light if maps of one place look in several directions."""
    m, place = group[0], {'position': group[0].eye[:3].tolist()}
    if m.eye[3] == 0:
        return {'kind': 'directional', 'direction': m.along.tolist()}
    if any(other.along @ m.along < 0.5 * m.along @ m.along for other in group):
        return {'kind': 'point'} | place
    return {'kind': 'spot'} | place | {'direction': m.along.tolist(), 'cone_deg': 170.0}
