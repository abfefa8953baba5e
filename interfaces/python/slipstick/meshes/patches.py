"""The mesh of a field as triangles on which its values are linear or constant, and right answers put on it."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Callable

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.linalg import spsolve
from scipy.spatial import Delaunay

from .displacement import triangles_of
from .field import Array, ContactField, Indices

#: A triangle of a triangulation crosses a gap between parts of the contact where its longest edge is longer than this many times the
#: shorter ones at its corners.
_GAP = 5.0
#: Four points are on a circle if the cotangents of two opposite angles add up to less than this.
_ON_CIRCLE = 1e-4
#: Each triangle is divided into the square of this number of equal ones, at whose centres integrals take their values.
_PARTS = 4


@dataclass(frozen=True)
class Patches:
    """corners (t, 3, 2), m: of the triangles. rows (t, 3): the row of the field at each corner; on faces three times the same.
    shares (t): the part of each triangle that counts, where several cover a face. once (t): a mask of triangles that cover each face
    once. weights (n), m^2: of each row in sums over the contact."""

    kind: str
    points: Array
    corners: Array
    rows: Indices
    shares: Array
    once: npt.NDArray[np.bool_]
    weights: Array

    @property
    def areas(self) -> Array:
        return self.shares * _areas(self.corners)


def patches_of(field: ContactField, right: Array) -> Patches:
    """The triangles of the field's faces, or a triangulation of its points where it has none; those on which the field or the right
    pressure (n) at its points carries."""
    if field.faces:
        assert field.vertices is not None
        triangles, face, shares, once = triangles_of(field.faces)
        corners = field.vertices[triangles]
        rows = np.repeat(face[:, None], 3, axis=1) if field.kind == "faces" else triangles
        at_corners = np.repeat((shares * _areas(corners) / 3)[:, None], 3, axis=1)
    else:
        rows = _triangulated(field.points)
        corners, shares, once = field.points[rows], np.ones(len(rows)), np.ones(len(rows), dtype=bool)
        at_corners = _corner_areas(corners, rows)
    weights = field.area
    if weights is None:
        weights = np.bincount(rows.ravel(), at_corners.ravel(), minlength=len(field.points))
    carries = ((field.pressure != 0) | (right != 0))[rows].any(axis=1) & (_areas(corners) > 0)
    # Without a mesh the shape functions behind nodal forces are unknown.
    kind = "nodes" if field.kind == "forces" and not field.faces else field.kind
    return Patches(kind, field.points, corners[carries], rows[carries], shares[carries], once[carries], weights)


def areas_around(points: Array) -> Array:
    """The area (n) of each point (n, 2): the third of each triangle around it. Two triangles whose four corners lie on a circle are
    the halves of a quadrilateral, and each corner has a fourth of it: Delaunay's triangulation picks a diagonal by chance."""
    rows = _triangulated(points)
    return np.bincount(rows.ravel(), _corner_areas(points[rows], rows).ravel(), minlength=len(points))


def _corner_areas(corners: Array, rows: Indices) -> Array:
    """The area (t, 3) at each corner of triangles (t, 3, 2)."""
    edges = np.sort(np.stack([np.roll(rows, -1, axis=1), np.roll(rows, -2, axis=1)], axis=2), axis=2).reshape(-1, 2)
    opposite = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)  # of each corner the edge that faces it
    areas = _areas(corners)
    before, after = np.roll(opposite, 1, axis=1), np.roll(opposite, -1, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        cotangent = (-np.sum(before * after, axis=2) / (2 * areas[:, None])).ravel()
    order = np.lexsort(edges.T)
    first, second = order[:-1], order[1:]
    circular = (edges[first] == edges[second]).all(axis=1) & (np.abs(cotangent[first] + cotangent[second]) < _ON_CIRCLE)
    parts = np.repeat(areas[:, None] / 3, 3, axis=1)
    paired = np.zeros(len(rows), dtype=bool)
    for one, other in zip(first[circular], second[circular]):
        (t, corner), (u, facing) = divmod(one, 3), divmod(other, 3)
        if not (paired[t] or paired[u]):
            paired[[t, u]] = True
            whole = areas[t] + areas[u]
            parts[t], parts[u] = whole / 8, whole / 8
            parts[t, corner], parts[u, facing] = whole / 4, whole / 4
    return parts


def _areas(corners: Array) -> Array:
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2


def _triangulated(points: Array) -> Indices:
    """Delaunay's triangles, without slivers along the hull and triangles that cross a gap."""
    simplices = Delaunay(points - points.mean(axis=0)).simplices
    corners = points[simplices]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    # The usual length of each point's edges: two fifths of them are shorter.
    vertex, length = np.concatenate([simplices.ravel(), np.roll(simplices, 1, axis=1).ravel()]), np.tile(edges.ravel(), 2)
    order, count = np.lexsort((length, vertex)), np.bincount(vertex, minlength=len(points))
    local = length[order][np.minimum(np.cumsum(count) - count + (2 * count) // 5, len(order) - 1)][simplices].max(axis=1)
    flat = 2 * _areas(corners) < 1e-3 * edges.max(axis=1)**2
    return np.asarray(simplices[(edges.max(axis=1) < _GAP * local) & ~flat], dtype=np.int64)


# ---------------------------------------------------------------- right answers on the mesh

Fields = Callable[[Array], Array]


def put_on(patches: Patches, fields: Fields) -> dict[str, Array]:
    """The values (n, 3) of a right answer on the mesh, in its kind first, then as another program could have them."""
    at_points = fields(patches.points)
    means = _means(patches, fields)
    if patches.kind == "faces":
        return {"means over faces": means, "values at the faces' centres": at_points}
    if patches.kind == "forces":
        return {"nodal forces": means, "values at nodes": at_points}
    if patches.kind == "points":
        return {"values at points": at_points, "means around points": means}
    return {"values at nodes": at_points, "means around nodes": means, "least squares": _least_squares(patches, fields, at_points)}


def _parts() -> Array:
    """Barycentric coordinates of the centres of the equal parts of a triangle."""
    n = _PARTS
    up = [(3 * i + 1, 3 * j + 1) for i in range(n) for j in range(n - i)]
    down = [(3 * i + 2, 3 * j + 2) for i in range(n) for j in range(n - 1 - i)]
    first, second = np.array(up + down).T / (3 * n)
    return np.column_stack([1 - first - second, first, second])


def _integrals(patches: Patches, fields: Fields) -> Array:
    """The integrals of the fields times each row's shape function (n, 3)."""
    shape = _parts()
    values = fields(np.einsum("gc,tcd->tgd", shape, patches.corners).reshape(-1, 2)).reshape(len(patches.corners), len(shape), -1)
    at_corners = np.einsum("gc,tgk->tck", shape, values) * (patches.areas / len(shape))[:, None, None]
    return _summed(patches, at_corners)


def _summed(patches: Patches, at_corners: Array) -> Array:
    return np.column_stack([np.bincount(patches.rows.ravel(), at_corners[:, :, k].ravel(), minlength=len(patches.points))
                            for k in range(at_corners.shape[2])])


def _means(patches: Patches, fields: Fields) -> Array:
    area = patches.weights
    if patches.kind != "forces":
        area = _summed(patches, np.repeat(patches.areas[:, None, None] / 3, 3, axis=1))[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.nan_to_num(_integrals(patches, fields) / area[:, None], posinf=0, neginf=0))


def _least_squares(patches: Patches, fields: Fields, outside: Array) -> Array:
    """The projection on fields that are linear between the nodes of the triangles."""
    used, place = np.unique(patches.rows, return_inverse=True)
    place = place.reshape(-1, 3)
    shape = _parts()  # the same sums as of the integrals, so that linear fields are kept
    local = shape.T @ shape / len(shape)
    entries = patches.areas[:, None, None] * local
    matrix = sparse.csc_matrix((entries.ravel(), (np.repeat(place, 3, axis=1).ravel(), np.tile(place, (1, 3)).ravel())))
    result = outside.copy()
    result[used] = spsolve(matrix, _integrals(patches, fields)[used])
    return result
