"""The matrix that the frame looks its map up with, found by its numbers among the constants of the draw that is lit."""
import numpy as np

from lookup import UNEXPLAINED
from solve import centre_of, with_one

DIFFER = 'MAP AND LOOKUP DIFFER: '


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
        with np.errstate(all='ignore'):
            n = stack @ back
            n = n / (n[:, 3:] @ w / (w @ w))[:, :, None]
            rows = np.linalg.pinv(bases) @ n[:, :2, :, None]
            rest = (np.abs(bases @ rows - n[:, :2, :, None]).max((2, 3)) / np.linalg.norm(m.clip[:2], axis=1)).max(1)
            fits = near(n[:, 3:], w, 0.05 * np.abs(w).max()) & (rest < 0.2) & (np.abs(rows[:, :, 0, 0]).min(1) > 1e-3)
        found += [(rest[k], matrices[k][0], rows[k, :, :, 0], n[k]) for k in np.flatnonzero(fits)]
    return sorted(found, key=lambda f: f[0])


def aperture(matrix):
    """Of a light's clip matrix: the lengths of x and y across its axis, which neither a pose nor an added w changes."""
    across, w = matrix[:2, :3], matrix[3, :3]
    size = np.linalg.norm(w)
    if size < 1e-4 * np.linalg.norm(across):
        return np.linalg.norm(across, axis=1) / max(1e-30, abs(matrix[3, 3]))
    return np.linalg.norm(across - np.outer(across @ w, w) / size ** 2, axis=1) / size


def without_model(capture, m, camera, draws):
    """[(draw, name)]: whose vertex shader hands over a constant with the map's aperture times the draw's own vertices, although these
    lie elsewhere in the map."""
    found = []
    for draw in draws:
        clip, written = capture.after_vertex_shader(draw)
        places = [with_one(p) for p in capture.vertex_inputs(draw) if len(p) == len(clip) > 0]
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


def of_lookup(capture, m, camera, light, lit, wrong):
    """(what the lookup's own matrix says of the light, where the map's vertices are moved and the constants hold it; notes about this
    and about a lookup with another matrix). lit: the draws that read the map. wrong: what the lookup of each map does not explain, None
    where that is not known."""
    found = own_matrix(capture.matrices(lit[-1]), camera, m) if lit else []
    if light['kind'] == 'spot' and found:
        _, name, _, matrix = found[0]
        centre, axis = centre_of(matrix), m.clip[3, :3]
        way = centre - light['position']
        moved = np.linalg.norm(way)
        is_along = abs(way @ axis) > 0.999 * moved * np.linalg.norm(axis)  # aside it would be another light, or another frame's
        if is_along and 1e-4 < moved / max(1, np.linalg.norm(centre)) < 0.1:
            return {'position': centre.tolist()}, [f"the map's vertices are moved by {moved:.4g} along the light (a bias in the map's "
                                                   f'shader); the truth is of the light that {name} looks up from']
    is_wrong, is_unknown = any(x and x > UNEXPLAINED for x in wrong), None in wrong
    t, (x, y, w, h) = capture.textures[m.target[0]], m.viewport
    reading = np.array([[1, 0, 1, 0], [0.5, 0.5, 0.5, 0.5],
                        [w / t.width / 2, (x + w / 2) / t.width, h / t.height / 2, (y + h / 2) / t.height]])
    exact = [(np.abs(reading - [*x, abs(y[0]), y[1]]), name, x, y) for rest, name, (x, y), _ in found if rest < 1e-3]
    exact.sort(key=lambda e: e[0].max(1).min())  # by how far the matrix is from one that reads the map
    # Of many constants some look alike by chance, moved by a draw's own place: that is a finding only where the lookup does not
    # follow from the map, and where that is not known, another scale is.
    if exact and (is_wrong and exact[0][0].max(1).min() > 1e-2 or is_unknown and min(e[0][:, ::2].max(1).min() for e in exact) > 1e-2):
        _, name, x, y = exact[0]
        return {}, [f'{DIFFER}the matrix {name} reads x = {x[0]:.4f} X + {x[1]:.4f}, y = {y[0]:.4f} Y + {y[1]:.4f}, where X and Y are '
                    'those of the map as it is drawn']
    if found and not exact and is_wrong and not camera.orthographic:  # its scale is not known, nor so what leads to the world
        return {}, [f'{DIFFER}the matrix {found[0][1]} is not that of the map, but off by {100 * found[0][0]:.2g}% (of another frame or '
                    'another light?), and no constant of the lit draw is nearer']
    astray = without_model(capture, m, camera, lit) if is_wrong or is_unknown else []
    return {}, [f'{DIFFER}{", ".join(f"draw {d.event}" for d, _ in astray)}: {astray[0][1]} times their own vertices is not where the '
                'map has them: the lookup lacks their model matrix'] if astray else []
