"""Tractions of a contact put on small meshes as other programs do it, for the tests of the mesh judge. A contact is a function of
points (n, 2), m: pressure and both tractions (n, 3), Pa, on the lower body."""
import numpy as np
import slipstick
from scipy.spatial import Delaunay
from slipstick import exact
from slipstick.meshes import ContactField


def circular(radius, peak, friction, moment_ratio, history=None):
    """The exact tractions of a sphere, of first loading or after a history of moments."""
    places = np.sin(np.pi / 2 * np.linspace(0, 1, 4000)) if history is None else np.linspace(0, 1, 20000)
    shear = exact.traction(places, moment_ratio) if history is None else exact.traction(places, history=history)

    def fields(x):
        r = np.hypot(*x.T) / radius
        pressure = peak * np.sqrt(np.maximum(0, 1 - r**2))
        around = friction * peak * np.where(r < 1, np.interp(r, places, shear), 0) / np.maximum(r * radius, 1e-300)
        return np.column_stack([pressure, -around * x[:, 1], around * x[:, 0]])
    return fields


def solved(scene, **overrides):
    """The tractions and the twist of a solve on its grid; between the cells' centres they are bilinear."""
    solution = slipstick.solve(scene, **overrides)
    x1, x2, *values = (np.asarray(solution.fields[name]) for name in ("x1", "x2", "pressure", "q1", "q2"))

    def fields(x):
        i, j = ((x[:, k] - start) / step for k, (start, step) in enumerate(((x1[0, 0], x1[1, 0] - x1[0, 0]),
                                                                           (x2[0, 0], x2[0, 1] - x2[0, 0]))))
        inside = (i >= 0) & (j >= 0) & (i < x1.shape[0] - 1) & (j < x1.shape[1] - 1)
        a, b = (np.clip(k.astype(int), 0, n - 2) for k, n in zip((i, j), x1.shape))
        s, t = i - a, j - b
        weights = {(0, 0): (1 - s) * (1 - t), (0, 1): (1 - s) * t, (1, 0): s * (1 - t), (1, 1): s * t}
        return np.column_stack([inside * sum(w * v[a + m, b + n] for (m, n), w in weights.items()) for v in values])
    return fields, solution.twist_angle


# Meshes: nodes (n, 2) and faces of 3 and 4 corners, in units of the half axes of the contact.

def polar(rings=14, angles=40, outer=1.15, power=1.0):
    angle = 2 * np.pi * (np.arange(angles) + 0.3) / angles
    radii = outer * np.linspace(0, 1, rings + 1)[1:]**power
    nodes = np.concatenate([[[0, 0]], (radii[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)).reshape(-1, 2)])
    place = 1 + np.arange(rings * angles).reshape(rings, angles)
    after = np.roll(place, -1, axis=1)
    return nodes, [np.column_stack([np.zeros(angles, int), place[0], after[0]]),
                   np.stack([place[:-1], place[1:], after[1:], after[:-1]], axis=-1).reshape(-1, 4)]


def squares(count=28, angle=0.4, shift=0.02):
    x = np.linspace(-1.2, 1.2, count)
    nodes = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2) + shift
    first = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    turned = nodes @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return turned, [np.column_stack([first, first + count, first + count + 1, first + 1])]


def jittered(count=30, seed=1):
    """Triangles of points that lie irregularly; the rim is a circle of nodes, the contact's edge."""
    draw, step = np.random.default_rng(seed), 2 / count
    x = np.arange(-count, count + 1) * step
    inner = np.stack(np.meshgrid(x, x), axis=-1).reshape(-1, 2) + draw.uniform(-0.25, 0.25, ((2 * count + 1)**2, 2)) * step
    angle = 2 * np.pi * np.arange(3 * count) / (3 * count)
    nodes = np.concatenate([inner[np.hypot(*inner.T) < 1 - 0.6 * step], np.column_stack([np.cos(angle), np.sin(angle)])])
    return nodes, [Delaunay(nodes).simplices.astype(np.int64)]


# Ways to put a contact on a mesh.

def quadrature(nodes, faces, order):
    """For one type of faces: points (m, g, 2), weights (m, g), shape functions (g, 4). A triangle is a quadrilateral two of whose
    corners are one point."""
    gauss, weights = np.polynomial.legendre.leggauss(order)
    s, t = (part.ravel() for part in np.meshgrid(gauss, gauss))
    signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    shape = np.stack([(1 + a * s) * (1 + b * t) / 4 for a, b in signs], axis=1)
    along = np.stack([np.stack([a * (1 + b * t), b * (1 + a * s)], axis=1) / 4 for a, b in signs], axis=1)
    corners = nodes[faces[:, [0, 1, 2, 2]] if faces.shape[1] == 3 else faces]
    tangents = np.einsum("gkd,mkc->mgdc", along, corners)
    return shape @ corners, np.abs(np.linalg.det(tangents)) * np.outer(weights, weights).ravel(), shape


def put(contact, mesh, kind, axes):
    """The field of a contact with these half axes on a mesh."""
    nodes, faces = mesh[0] * np.asarray(axes), mesh[1]
    parts = [quadrature(nodes, one, 2 if kind == "points" else 6) for one in faces]
    values = [contact(x.reshape(-1, 2)).reshape(*x.shape[:2], 3) * w[..., None] for x, w, _ in parts]
    if kind == "nodes":
        return _field(kind, nodes, contact(nodes), vertices=nodes, faces=faces)
    if kind == "faces":
        area = np.concatenate([w.sum(axis=1) for _, w, _ in parts])
        means = np.concatenate([v.sum(axis=1) for v in values]) / area[:, None]
        centres = np.concatenate([nodes[one].mean(axis=1) for one in faces])
        return _field(kind, centres, means, area=area, vertices=nodes, faces=faces)
    if kind == "points":
        x, w = (np.concatenate([part[k].reshape(-1, *part[k].shape[2:]) for part in parts]) for k in (0, 1))
        return _field(kind, x, contact(x), area=w)
    area, force = np.zeros(len(nodes)), np.zeros((len(nodes), 3))
    for one, (_, w, shape), v in zip(faces, parts, values):
        corners = one[:, [0, 1, 2, 2]] if one.shape[1] == 3 else one
        np.add.at(area, corners, w @ shape)
        np.add.at(force, corners, np.einsum("mgv,gk->mkv", v, shape))
    return _field(kind, nodes, force / area[:, None], area=area, vertices=nodes, faces=faces)


def _field(kind, points, values, **more):
    return ContactField(kind, points, values[:, 0], values[:, 1:], name=f"{len(points)} {kind}", **more)
