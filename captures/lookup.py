"""What the frame does with its map: the matrix that it looks up with, and the bias and filter that its visibility shows.

Both are read off numbers: matrices among the lit draw's constants, and the depths of the captured map under the receivers.
"""
import dataclasses

import numpy as np

from solve import fit

FILTERS = {  # settings of Noonmark: taps in texels and whether each blends four texels
    'none': ({}, [(0, 0)], False),
    'hardware': ({'filter.kind': 'hardware'}, [(0, 0)], True),
    'box3': ({'filter.kind': 'box', 'filter.size': '3'}, [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)], False),
    'box5': ({'filter.kind': 'box', 'filter.size': '5'}, [(i, j) for i in range(-2, 3) for j in range(-2, 3)], False),
    'box7': ({'filter.kind': 'box', 'filter.size': '7'}, [(i, j) for i in range(-3, 4) for j in range(-3, 4)], False),
}
ROUNDING = 1e-5  # of window depth: a smaller bias is what a shader's floats and the map's steps do by themselves
MOST_RECEIVERS = 40000  # for the fit; evenly over the picture


# ---- the receivers
def receivers(depth, camera, is_zero_to_one):
    """Places and normals of the pixels in the camera's axes, from its depths; float64, height x width x 3."""
    height, width = depth.shape
    y, x = np.mgrid[0:height, 0:width]
    z = depth.astype('f8') if is_zero_to_one else 2 * depth.astype('f8') - 1
    clip = np.stack([(x + 0.5) / width * 2 - 1, (y + 0.5) / height * 2 - 1, z, np.ones_like(z)], -1)
    place = clip @ np.linalg.inv(camera.clip).T
    with np.errstate(all='ignore'):
        place = place[..., :3] / place[..., 3:]
    place[~np.isfinite(place)] = 0

    def along(axis):  # of the two differences the smaller, which does not cross an outline
        ahead, behind = np.zeros_like(place), np.zeros_like(place)
        step = np.diff(place, axis=axis)
        ahead[:-1 if axis == 0 else None, :-1 if axis == 1 else None] = step
        behind[1 if axis == 0 else 0:, 1 if axis == 1 else 0:] = step
        a, b = (np.where((v * v).sum(-1) > 0, (v * v).sum(-1), np.inf) for v in (ahead, behind))
        return np.where((a < b)[..., None], ahead, behind)
    normal = np.cross(along(1), along(0))
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    normal = normal / np.where(length > 0, length, 1)
    eye = np.array([0, 0, -1.0]) if camera.orthographic else place
    return place, normal * -np.sign((normal * eye).sum(-1, keepdims=True))


def to_light(light, place):
    towards = -np.array(light['direction']) if light['kind'] == 'directional' else np.array(light['position']) - place
    return towards / np.maximum(1e-30, np.linalg.norm(towards, axis=-1, keepdims=True))


# ---- bias and filter
@dataclasses.dataclass
class Lookup:
    filter: str
    constant: float  # window depth
    tan: float  # window depth per tangent of the angle to the light
    misses: float  # mean difference from the frame's visibility
    decoded: bool  # the frame's values explain better after sRGB is decoded
    between: tuple = None  # constants that give the same visibility
    wrong: float = 0.0  # share of the receivers where it differs by more than a half: an unknown filter differs by less

    @property
    def technique(self):
        short = lambda x: f'{x:.4g}'
        bias = {'bias.constant': short(self.constant)} | ({'bias.tan': short(self.tan)} if self.tan else {})
        return FILTERS[self.filter][0] | bias


class Taps:
    """How much farther than the map's texels the receivers are, for each tap of a filter."""

    def __init__(self, m, place):
        self.map, self.depths = m, 1 - m.depths if m.reversed else m.depths
        u, v, self.z = m.window(place)
        self.rows, self.columns = m.depths.shape
        self.x, self.y = u * self.columns, v * self.rows
        self.inside = (u > 0) & (u < 1) & (v > 0) & (v < 1) & (self.z < 1)

    def texel(self, x, y):
        return self.depths[np.clip(y, 0, self.rows - 1), np.clip(x, 0, self.columns - 1)]

    def farther(self):
        """How much farther along the light than the nearest texel's depth the inner receivers are, in texels of the map at them."""
        inside = self.inside
        far, clip = self.read('none')[0][0][inside], self.map.clip
        across, per_depth = aperture(clip)[0] * self.columns, 1 if self.map.zero_to_one else 2
        if np.linalg.norm(clip[3, :3]) < 1e-4 * np.linalg.norm(clip[0, :3]):
            return far * per_depth * across / 2 / np.linalg.norm(clip[2, :3])
        k = clip[2, :3] @ clip[3, :3] / (clip[3, :3] @ clip[3, :3])  # z = k + b / w
        b = clip[2, 3] - k * clip[3, 3]
        own = lambda z: b / ((1 - z if self.map.reversed else z) * per_depth - (per_depth - 1) - k)
        with np.errstate(all='ignore'):
            w, map_w = own(self.z[inside]), own(self.z[inside] - far)
            return (w - np.where(map_w > 0, map_w, np.inf)) * across / 2 / w

    def read(self, name):
        _, taps, blends = FILTERS[name]
        if not blends:
            x, y = np.floor(self.x).astype(int), np.floor(self.y).astype(int)
            beyond = np.stack([self.z - self.texel(x + i, y + j) for i, j in taps])
            return beyond, np.full(beyond.shape, 1 / len(taps))
        x, y = np.floor(self.x - 0.5).astype(int), np.floor(self.y - 0.5).astype(int)
        fx, fy = self.x - 0.5 - x, self.y - 0.5 - y
        beyond = np.stack([self.z - self.texel(x + i, y + j) for i in (0, 1) for j in (0, 1)])
        return beyond, np.stack([(fx if i else 1 - fx) * (fy if j else 1 - fy) for i in (0, 1) for j in (0, 1)])


def explain(m, place, normal, visibility, given_filter=None, given_bias=None):
    """The lookup that gives the frame's visibility best. Rows: receivers that look this map up. given_*: what is not searched."""
    pick = np.linspace(0, len(place) - 1, min(len(place), MOST_RECEIVERS)).astype(int)
    place, normal, v = place[pick], normal[pick], visibility[pick]
    taps = Taps(m, place)
    cosine = np.clip((normal * to_light(m.light, place)).sum(1), 1e-3, 1)
    use = taps.inside & (cosine > 0.05)
    if use.sum() < 100:
        return None
    tangent = (np.sqrt(1 - cosine ** 2) / cosine)[use]
    curve = np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)[use]
    v, best = v[use], None

    def misses(beyond, weights, bias, goal):
        return float(np.abs(((beyond <= bias) * weights).sum(0) - goal).mean())

    def best_constant(beyond, weights, slope, goal):
        """Tries the depths at which receivers turn, densest where they lie on their own surface, then finer."""
        if given_bias is not None:
            return misses(beyond, weights, slope + given_bias, goal), given_bias
        turns = np.sort((beyond[0] - slope)[np.abs(beyond[0] - slope) < 0.1])
        tries = np.unique(np.quantile(turns, np.linspace(0, 1, 49))) if len(turns) > 50 else np.linspace(-1e-3, 1e-3, 49)
        for _ in range(3):
            scores = np.array([misses(beyond, weights, slope + c, goal) for c in tries])
            k = int(np.argmin(scores))
            best = scores[k], float(tries[k])
            tries = np.linspace(tries[max(0, k - 1)], tries[min(len(tries) - 1, k + 1)], 17)
        return best

    def alike(beyond, weights, slope, goal, constant):
        """The least and the largest constant that give the same visibility, but for two receivers."""
        turns = np.sort((beyond - slope).ravel())
        most = misses(beyond, weights, slope + constant, goal) + 2 / len(goal)
        ends = []
        for good, bad in ((np.searchsorted(turns, constant), -1), (np.searchsorted(turns, constant), len(turns))):
            while abs(bad - good) > 1:
                middle = (good + bad) // 2
                if misses(beyond, weights, slope + turns[middle], goal) <= most:
                    good = middle
                else:
                    bad = middle
            ends.append(float(turns[min(good, len(turns) - 1)]))
        return min(ends[0], constant), max(ends[1], constant)

    partly = ((v > 0.02) & (v < 0.98)).mean() > 1e-3
    for name in [given_filter] if given_filter else FILTERS if partly else ['none']:
        beyond, weights = (a[:, use] for a in taps.read(name))
        score, constant = best_constant(beyond, weights, 0, v)
        if best is None or score < 0.8 * best.misses - 1e-5:
            best = Lookup(name, constant, 0.0, score, False)
    beyond, weights = (a[:, use] for a in taps.read(best.filter))
    for share in (0.25, 0.5, 1, 2) if given_bias is None else ():  # does the bias grow with the slope?
        tan = share * abs(best.constant)
        score, constant = best_constant(beyond, weights, tan * tangent, v)
        if tan and score < 0.7 * best.misses - 1e-4:
            best = dataclasses.replace(best, misses=score, constant=constant, tan=tan)
    if partly:
        score, constant = best_constant(beyond, weights, best.tan * tangent, curve)
        if score < 0.5 * best.misses - 1e-4:
            best = dataclasses.replace(best, misses=score, constant=constant, decoded=True)
    goal = curve if best.decoded else v
    if given_bias is None:
        low, high = alike(beyond, weights, best.tan * tangent, goal, best.constant)
        # Where several do, none if that is among them, otherwise one a little above the least.
        best = dataclasses.replace(best, between=(low, high), constant=0.0 if low <= ROUNDING and high >= -ROUNDING else (low + min(high, 1.5 * low)) / 2
                                   if low > 0 else best.constant)
    model = ((beyond <= best.tan * tangent + best.constant) * weights).sum(0)
    return dataclasses.replace(best, wrong=float((np.abs(model - goal) > 0.5).mean()), misses=float(np.abs(model - goal).mean()))


# ---- the matrix of the lookup
def own_matrix(matrices, camera, m):
    """[(rest, name, rows, matrix)]: matrices among the constants that look the map up, from the camera's axes.

    Row i of such a matrix is rows[i][0] times row i of the map's and rows[i][1] times its w; rest says how far it is from that.
    A constant can start from the camera's axes or from any others; the constants that lead from these to the camera are tried.
    """
    rigid = lambda k: np.abs(k[3] - (0, 0, 0, 1)).max() < 1e-5 and np.abs(k[:3, :3] @ k[:3, :3].T - np.eye(3)).max() < 1e-4
    to_camera, backs = np.linalg.inv(camera.clip), [np.eye(4)]
    for name, k in matrices:
        for view in (k, to_camera @ k):
            if abs(view[3, 3]) > 1e-9 and rigid(view / view[3, 3]):
                back = np.linalg.inv(view / view[3, 3])
                if not any(np.abs(back - b).max() < 1e-5 for b in backs):
                    backs.append(back)
    names, all_matrices = [n for n, _ in matrices], np.array([k for _, k in matrices])
    found, w = [], m.clip[3]
    for back in backs[:200]:
        n = all_matrices @ back
        scale = n[:, 3] @ w / (w @ w)
        near = np.abs(n[:, 3] - scale[:, None] * w).max(1) < 0.05 * np.abs(scale) * np.abs(w).max()
        for k in np.flatnonzero(near & (np.abs(scale) > 1e-9)):
            one, rows, rest = n[k] / scale[k], [], 0.0
            for i in range(3):
                base = np.c_[m.clip[i], w]
                factors = fit(base, one[i][:, None])[0][0]
                rows.append(factors)
                if i < 2:
                    rest = max(rest, np.abs(base @ factors - one[i]).max() / np.linalg.norm(m.clip[i]))
            if rest < 0.2 and min(abs(r[0]) for r in rows[:2]) > 1e-3:
                found.append((rest, names[k], np.array(rows), one))
    return found


def aperture(matrix):
    """Of a light's clip matrix: the lengths of x and y across its axis, which neither a pose nor an added w changes."""
    across, w = matrix[:2, :3], matrix[3, :3]
    size = np.linalg.norm(w)
    if size < 1e-4 * np.linalg.norm(across):
        return np.linalg.norm(across, axis=1) / max(1e-30, abs(matrix[3, 3]))
    return np.linalg.norm(across - np.outer(across @ w, w) / size ** 2, axis=1) / size


def without_model(capture, camera, m, draws):
    """[(draw, name)]: whose vertex shader hands over a constant with the map's aperture times the draw's own vertices, although these
    lie elsewhere in the map."""
    matrix, found = m.clip @ np.linalg.inv(camera.clip), []
    for draw in draws:
        clip, outputs = capture.after_vertex_shader(draw, whole=True) or (np.zeros((0, 4)), None)
        places = [np.c_[p, np.ones(len(p))] for p in capture.vertex_inputs(draw) if len(p) == len(clip)]
        for name, constant in capture.matrices(draw) if len(clip) else []:
            factor = aperture(constant) / aperture(m.clip)
            scale = 1 if abs(factor[0] - 1) < 0.1 else 0.5  # 0.5 where clip space is brought to 0 ... 1
            if np.abs(factor - scale).max() > 1e-4:
                continue
            right = clip @ matrix.T
            right[:, :2] = right[:, :2] * scale + right[:, 3:] * (1 - scale)
            for local in (p @ constant.T for p in places):
                size = np.abs(local).max()
                stands = np.abs((local * right[:, 3:] - right * local[:, 3:])[:, :2]).max() < 1e-3 * size * np.abs(right).max()
                if not stands and any(np.abs(outputs[:, k:k + 4] - local).max() < 1e-5 * size for k in range(outputs.shape[1] - 3)):
                    found.append((draw, name))
    return found
