"""The bias and filter that the frame's visibility shows: read off the depths of the captured map under the receivers."""
import dataclasses

import numpy as np

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
        step = np.diff(place, axis=axis)
        ahead, behind = (np.insert(step, at, 0, axis) for at in (step.shape[axis], 0))
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
        return (f'filter {self.filter}, bias {self.constant:.4g} of window depth (from {low:.3g} to {high:.3g} alike)'
                + (f' and {self.tan:.3g} tan' if self.tan else '')
                + (f' and {self.offset:.3g} texels along the normal' if self.offset else '')
                + f', which leaves {100 * self.misses:.2f}% unexplained'
                + (f', AND {100 * self.wrong:.2f}% ARE WRONG: they do not follow from the map at their own places'
                   if self.wrong > UNEXPLAINED else '')
                + ('; A BIAS BELOW 0: its sign is wrong, or another value is compared; judged by place' if self.constant < 0 else ''))


class Taps:
    """How much farther than the map's texels places are, for each tap of a filter."""

    def __init__(self, m, place):
        self.map, self.place = m, place
        self.u, self.v, z = m.window(place)
        self.z, self.depths = (1 - z, 1 - m.depths) if m.reversed else (z, m.depths)  # near = 0
        self.rows, self.columns = m.depths.shape
        self.inside = (self.u > 0) & (self.u < 1) & (self.v > 0) & (self.v < 1) & (self.z < 1)

    def read(self, name):
        """(window depth beyond each tap's texel, its weight): taps x places."""
        blends = name == 'hardware'
        reach = int(FILTERS[name].get('filter.size', 1)) // 2
        taps = [(i, j) for i in range(-reach, reach + 1 + blends) for j in range(-reach, reach + 1 + blends)]
        at = self.u * self.columns - blends / 2, self.v * self.rows - blends / 2
        x, y = (np.floor(a).astype(int) for a in at)
        fx, fy = at[0] - x, at[1] - y
        beyond = [self.z - self.depths[np.clip(y + j, 0, self.rows - 1), np.clip(x + i, 0, self.columns - 1)] for i, j in taps]
        weights = [(fx if i else 1 - fx) * (fy if j else 1 - fy) if blends else np.full(len(x), 1 / len(taps)) for i, j in taps]
        return np.stack(beyond), np.stack(weights)

    def farther(self):
        """Of the places inside: by how many texels they lie behind what their texel holds, along the light's ray."""
        beyond, place = self.read('none')[0][0][self.inside], self.place[self.inside]
        stored = self.z[self.inside] - beyond
        way = self.map.place(self.u[self.inside], self.v[self.inside], 1 - stored if self.map.reversed else stored) - place
        with np.errstate(all='ignore'):
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
    cosine = np.clip((normal * to_light(m.light, place)).sum(1), 1e-3, 1)
    use = Taps(m, place).inside & (cosine > 0.05)
    if use.sum() < FEWEST_RECEIVERS:
        return None
    tangent, goal = (np.sqrt(1 - cosine ** 2) / cosine)[use], visibility[use]
    step = m.texel(place)[:, None] * normal

    def tried(name, tan=0.0, offset=0.0):
        """The best constant of a filter, with its interval."""
        beyond, weights = (a[:, use] for a in Taps(m, place + offset * step).read(name))
        beyond = beyond - tan * tangent
        constant, between = given_bias, (given_bias, given_bias)
        if given_bias is None:
            constants, misses = turning(beyond, weights, goal)
            best = misses.argmin()
            worse = np.flatnonzero(misses > misses[best] + 2 / len(goal))
            low, high = constants[worse[worse < best].max(initial=-1) + 1], constants[worse[worse > best].min(initial=len(misses)) - 1]
            # Where several do, none if that is among them, otherwise one a little above the least.
            constant = 0.0 if low <= ROUNDING and high >= -ROUNDING else (low + min(high, 1.5 * low)) / 2 if low > 0 else constants[best]
            between = float(low), float(high)
        off = np.abs(((beyond <= constant) * weights).sum(0) - goal)
        return Lookup(name, float(constant), between, tan, float(offset), off.mean(), (off > 0.5).mean())

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
