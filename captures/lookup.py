"""How the frame looks its map up: bias and filter, which its visibility shows over the depths of the map, and the matrix."""
import dataclasses

import numpy as np

from solve import aperture, centre_of

FILTERS = {'none': {}, 'hardware': {'filter.kind': 'hardware'}}  # settings of Noonmark
FILTERS |= {f'box{size}': {'filter.kind': 'box', 'filter.size': str(size)} for size in (3, 5, 7)}
ROUNDING = 1e-5  # of window depth: a smaller bias is what a shader's floats and the map's steps do by themselves
MOST_RECEIVERS = 40000  # for the fit; evenly over the picture
FEWEST_RECEIVERS = 100
AT_TEXEL = 4  # texels along the light: a place that lies nearer to what its texel holds is in the map; a slope does less within a texel
SLOPES = (0.25, 0.5, 1, 2)  # of the constant, for each tangent of the angle to the light
OFFSETS = np.arange(0.5, 4.1, 0.5)  # texels along the normal; around the best of them finer steps are tried
UNEXPLAINED = 0.01  # of the receivers: a tenth of that is left where the lookup is one of those that are known


def receivers(depth, camera):
    """Places and normals of the pixels in the camera's axes, from its depths; float64, height x width x 3."""
    y, x = ((np.mgrid[0:depth.shape[0], 0:depth.shape[1]][i] + 0.5) / depth.shape[i] for i in (0, 1))
    place = np.nan_to_num(camera.place(x.ravel(), y.ravel(), depth.ravel().astype('f8')), posinf=0, neginf=0).reshape(*depth.shape, 3)

    def along(axis):
        """Of the differences to both neighbours the smaller one, which does not cross an outline."""
        ahead, behind = (np.diff(place, axis=axis, **{end: np.inf}) for end in ('append', 'prepend'))
        return np.where((ahead * ahead).sum(-1, keepdims=True) < (behind * behind).sum(-1, keepdims=True), ahead, behind)
    normal = np.cross(along(1), along(0))
    normal = normal / np.maximum(1e-300, np.linalg.norm(normal, axis=-1, keepdims=True))
    return place, normal * -np.sign((normal * ([0, 0, -1.0] if camera.orthographic else place)).sum(-1, keepdims=True))


def to_light(m, place):
    towards = m.eye[:3] - m.eye[3] * place
    return towards / np.maximum(1e-30, np.linalg.norm(towards, axis=-1, keepdims=True))


@dataclasses.dataclass
class Lookup:
    filter: str
    constant: float  # window depth
    between: tuple  # constants that give the same visibility
    tan: float  # window depth per tangent of the angle to the light
    offset: float  # texels along the normal
    misses: float  # mean difference from the frame's visibility
    wrong: float  # share of the receivers where it differs by more than a half: an unknown filter differs by less

    def technique(self):
        return FILTERS[self.filter] | {'bias.constant': f'{self.constant:.4g}', 'bias.tan': f'{self.tan:.4g}',
                                       'bias.normal_offset': f'{self.offset:.4g}'}

    def __str__(self):
        low, high = self.between
        parts = {f'filter {self.filter}, bias {self.constant:.4g} of window depth (from {low:.3g} to {high:.3g} alike)': True,
                 f' and {self.tan:.3g} tan': self.tan,
                 f' and {self.offset:.3g} texels along the normal': self.offset,
                 f', which leaves {100 * self.misses:.2f}% unexplained': True,
                 f', AND {100 * self.wrong:.2f}% ARE WRONG: they do not follow from the map at their own places': self.wrong > UNEXPLAINED,
                 '; A BIAS BELOW 0: its sign is wrong, or another value is compared; judged by place': self.constant < 0}
        return ''.join(words for words, is_so in parts.items() if is_so)


class Taps:
    """How much farther than the map's texels places are, for each tap of a filter."""

    def __init__(self, m, place):
        self.map, self.place = m, place
        self.u, self.v, z = m.window(place)
        self.z, self.depths = (1 - z, 1 - m.depths) if m.reversed else (z, m.depths)  # near = 0
        self.inside = (self.u > 0) & (self.u < 1) & (self.v > 0) & (self.v < 1) & (self.z > 0) & (self.z < 1)

    def read(self, name):
        """(window depth beyond each tap's texel, its weight): taps x places."""
        blends, reach = name == 'hardware', int(FILTERS[name].get('filter.size', 1)) // 2
        rows, columns = self.depths.shape
        at = self.u * columns - blends / 2, self.v * rows - blends / 2
        x, y = (np.floor(a).astype(int) for a in at)
        i, j = np.mgrid[-reach:reach + 1 + blends, -reach:reach + 1 + blends].reshape(2, -1, 1)
        weights = np.abs(1 - i - (at[0] - x)) * np.abs(1 - j - (at[1] - y)) if blends else np.full((len(i), len(x)), 1 / len(i))
        return self.z - self.depths[np.clip(y + j, 0, rows - 1), np.clip(x + i, 0, columns - 1)], weights

    def farther(self, name='none'):
        """Of the places inside: by how many texels they lie behind the nearest that their taps hold, along the light's ray."""
        beyond, place = self.read(name)[0].max(0)[self.inside], self.place[self.inside]
        stored = self.z[self.inside] - beyond
        way = self.map.place(self.u[self.inside], self.v[self.inside], 1 - stored if self.map.reversed else stored) - place
        texels = np.linalg.norm(way, axis=1) / self.map.texel(place)
        return np.where(np.isfinite(texels), texels, np.inf) * np.sign(beyond)


def turning(beyond, weights, goal):
    """(constants, misses): the biases at which a tap of a receiver turns lit, rising, and how far the picture is then from the goal."""
    order = beyond.argsort(0)
    turns = np.take_along_axis(beyond, order, 0)
    lit = np.take_along_axis(weights, order, 0).cumsum(0)
    misses = np.abs(np.vstack([np.zeros(len(goal)), lit]) - goal)
    order = turns.ravel().argsort()
    constants = turns.ravel()[order]
    total = misses[0].sum() + np.diff(misses, axis=0).ravel()[order].cumsum()
    last = np.append(np.diff(constants) > 0, True)  # of equal ones
    return constants[last], total[last] / len(goal)


def explain(m, place, normal, visibility, given_filter=None, given_bias=None):
    """The lookup that gives the frame's visibility best. Rows: receivers that look this map up. given_*: what is not searched."""
    pick = np.linspace(0, len(place) - 1, min(len(place), MOST_RECEIVERS)).astype(int)
    place, normal, visibility = place[pick], normal[pick], visibility[pick]
    cosine = np.clip((normal * to_light(m, place)).sum(1), 1e-3, 1)
    use = Taps(m, place).inside & (cosine > 0.05)
    if use.sum() < FEWEST_RECEIVERS:
        return None
    tangent, goal = (np.sqrt(1 - cosine ** 2) / cosine)[use], visibility[use]
    step = m.texel(place)[:, None] * normal

    def tried(name, tan=0.0, offset=0.0):
        """The best constant of a filter, with its interval."""
        beyond, weights = (a[:, use] for a in Taps(m, place + offset * step).read(name))
        beyond = beyond - tan * tangent
        constants, misses = turning(beyond, weights, goal)
        best = misses.argmin()
        worse = np.flatnonzero(misses > misses[best] + 2 / len(goal))
        low, high = constants[worse[worse < best].max(initial=-1) + 1], constants[worse[worse > best].min(initial=len(misses)) - 1]
        # Where several do, none if that is among them, otherwise one a little above the least.
        constant = 0.0 if low <= ROUNDING and high >= -ROUNDING else (low + min(high, 1.5 * low)) / 2 if low > 0 else constants[best]
        if given_bias is not None:
            constant = low = high = given_bias
        off = np.abs(((beyond <= constant) * weights).sum(0) - goal)
        return Lookup(name, float(constant), (float(low), float(high)), tan, float(offset), off.mean(), (off > 0.5).mean())

    better = lambda old, new, share: new if new.misses < share * old.misses - max(1e-4, 2 / len(goal)) else old
    is_filtered = ((goal > 0.02) & (goal < 0.98)).mean() > 1e-3
    found = tried(given_filter or 'none')
    for name in FILTERS if is_filtered and not given_filter else ():
        found = better(found, tried(name), 0.8)
    if given_bias is not None or not found.constant:
        return found
    # Does the bias grow with the slope, or is the place moved along the normal?
    tries = [tried(found.filter, tan=share * abs(found.constant)) for share in SLOPES]
    moved = [tried(found.filter, offset=offset) for offset in OFFSETS]
    for width in OFFSETS[0] / np.array([2, 4]):
        best = min(moved, key=lambda one: one.misses).offset
        moved += [tried(found.filter, offset=best + way) for way in (-width, width)]
    for one in sorted(tries + moved, key=lambda one: one.misses)[::-1]:
        found = better(found, one, 0.7) if one.constant >= 0 else found
    return found


# ---- the matrix of the lookup, by its numbers among the constants of the draw that is lit
def own_matrix(matrices, camera, m):
    """[(rest, name, rows, matrix)]: matrices among the constants that look the map up, from the camera's axes, the nearest one first.

    Row i of such a matrix is rows[i][0] times row i of the map's and rows[i][1] times its w; rest says how far it is from that.
    A constant can start from the camera's axes or from any others; the constants that lead from these to the camera are tried.
    """
    stack, w, near = np.array([k for _, k in matrices]), m.clip[3], lambda a, b, by: np.abs(a - b).max((-2, -1)) < by
    views = np.concatenate([stack, np.linalg.inv(camera.clip) @ stack])
    views = views[np.abs(views[:, 3, 3]) > 1e-9]
    views = views / views[:, 3:, 3:]
    turn = views[:, :3, :3]
    rigid = views[near(views[:, 3:], (0, 0, 0, 1), 1e-5) & near(turn @ turn.transpose(0, 2, 1), np.eye(3), 1e-4)]
    backs = np.linalg.inv([np.eye(4), *rigid])
    backs = backs[np.sort(np.unique(backs.round(5), axis=0, return_index=True)[1])]
    found, bases = [], m.clip[[[0, 3], [1, 3]]].transpose(0, 2, 1)  # of x and of y
    for back in backs[:200]:
        n = stack @ back
        n = n / (n[:, 3:] @ w / (w @ w))[:, :, None]
        rows = np.linalg.pinv(bases) @ n[:, :2, :, None]
        rest = (np.abs(bases @ rows - n[:, :2, :, None]).max((2, 3)) / np.linalg.norm(m.clip[:2], axis=1)).max(1)
        fits = near(n[:, 3:], w, 0.05 * np.abs(w).max()) & (rest < 0.2) & (np.abs(rows[:, :, 0, 0]).min(1) > 1e-3)
        found += [(rest[k], matrices[k][0], rows[k, :, :, 0], n[k]) for k in np.flatnonzero(fits)]
    return sorted(found, key=lambda f: f[0])


def without_model(capture, m, camera, draws):
    """[(draw, name)]: whose vertex shader hands over a constant with the map's aperture times the draw's own vertices, although these
    lie elsewhere in the map."""
    found = []
    for draw in draws:
        clip, written = capture.after_vertex_shader(draw)
        places = capture.vertex_inputs(draw)
        for name, constant in capture.matrices(draw) if places else []:
            factor = aperture(constant) / aperture(m.clip)
            scale = 1 if abs(factor[0] - 1) < 0.1 else 0.5  # 0.5 where clip space is brought to 0 ... 1
            right = clip @ (m.clip @ np.linalg.inv(camera.clip)).T
            right[:, :2] = right[:, :2] * scale + right[:, 3:] * (1 - scale)
            for local in (p @ constant.T for p in places if np.abs(factor - scale).max() <= 1e-4):
                size = np.abs(local).max()
                stands = np.abs((local * right[:, 3:] - right * local[:, 3:])[:, :2]).max() < 1e-3 * size * np.abs(right).max()
                handed_over = any(np.abs(written[:, k:k + 4] - local).max() < 1e-5 * size for k in range(written.shape[1] - 3))
                found += [(draw, name)] if handed_over and not stands else []
    return found


def by_matrix(capture, m, camera, light, lit, wrong):
    """(where the light is, if the map's vertices are moved and the lookup's own matrix says so; what there is to say of that matrix).

    lit: the draws that read the map. wrong: what the lookup of each map does not explain, None where that is not known.
    """
    found = own_matrix(capture.matrices(lit[-1]), camera, m) if lit else []
    if light['kind'] == 'spot' and found:
        _, name, _, matrix = found[0]
        centre, axis = centre_of(matrix), m.clip[3, :3]
        way = centre - light['position']
        moved = np.linalg.norm(way)
        is_along = abs(way @ axis) > 0.999 * moved * np.linalg.norm(axis)  # aside it would be another light, or another frame's
        if is_along and 1e-4 < moved / max(1, np.linalg.norm(centre)) < 0.1:
            return centre, (f"the map's vertices are moved by {moved:.4g} along the light (a bias in the map's shader); the truth is of "
                            f'the light that {name} looks up from')
    is_wrong, is_unknown, differ = any(x and x > UNEXPLAINED for x in wrong), None in wrong, 'MAP AND LOOKUP DIFFER: '
    t, (x, y, w, h) = capture.textures[m.target[0]], m.viewport
    reading = np.array([[1, 0, 1, 0], [0.5, 0.5, 0.5, 0.5],
                        [w / t.width / 2, (x + w / 2) / t.width, h / t.height / 2, (y + h / 2) / t.height]])
    exact = [(np.abs(reading - [*x, abs(y[0]), y[1]]), name, x, y) for rest, name, (x, y), _ in found if rest < 1e-3]
    exact.sort(key=lambda e: e[0].max(1).min())  # by how far the matrix is from one that reads the map
    # Of many constants some look alike by chance, moved by a draw's own place: that is a finding only where the lookup does not
    # follow from the map, and where that is not known, another scale is.
    if exact and (is_wrong and exact[0][0].max(1).min() > 1e-2 or is_unknown and min(e[0][:, ::2].max(1).min() for e in exact) > 1e-2):
        _, name, x, y = exact[0]
        return None, (f'{differ}the matrix {name} reads x = {x[0]:.4f} X + {x[1]:.4f}, y = {y[0]:.4f} Y + {y[1]:.4f}, where X and Y are '
                      'those of the map as it is drawn')
    if found and not exact and is_wrong and not camera.orthographic:  # its scale is not known, nor so what leads to the world
        return None, (f'{differ}the matrix {found[0][1]} is not that of the map, but off by {100 * found[0][0]:.2g}% (of another frame or '
                      'another light?), and no constant of the lit draw is nearer')
    lacking = without_model(capture, m, camera, lit) if is_wrong or is_unknown else []
    return None, lacking and (f'{differ}{", ".join(d.name for d, _ in lacking)}: {lacking[0][1]} times their own vertices is not where the '
                              'map has them: the lookup lacks their model matrix')
