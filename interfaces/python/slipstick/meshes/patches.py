"""The mesh of a field as triangles on which its values are linear or constant, and right answers put on it."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Callable

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.linalg import spsolve
from scipy.spatial import Delaunay, KDTree

from .displacement import triangles_of
from .field import Array, ContactField, Indices

#: Pressure, q1 and q2 (n, 3), Pa, at points (n, 2), m.
Fields = Callable[[Array], Array]

#: A triangle of a triangulation crosses a gap between parts of the contact where its longest edge is longer than this many times the
#: shorter ones at its corners.
_GAP = 5.0
#: A triangle may bridge a hole where its longest edge is longer than this many times those of its neighbours.
_BRIDGE = 1.5
#: Four points are on a circle if the cotangents of two opposite angles add up to less than this: files may have six digits only.
_ON_CIRCLE = 1e-3
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


def patches_of(field: ContactField, right: Fields) -> Patches:
    """The triangles of the field's faces, or a triangulation of its points where it has none; those on which the field or the right
    answer carries at a corner. A triangulation does not bridge holes of the right contact."""
    if field.faces:
        assert field.vertices is not None
        triangles, face, shares, once = triangles_of(field.faces)
        corners = field.vertices[triangles]
        rows = np.repeat(face[:, None], 3, axis=1) if field.kind == "faces" else triangles
    else:
        rows, shares, once = _triangulated(field.points)
        corners = field.points[rows]
        lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        long = lengths > _BRIDGE * shortest_around(rows, lengths, len(field.points))[rows].min(axis=1)
        stay = ~(long & (right(corners.mean(axis=1))[:, 0] == 0))
        rows, shares, once, corners = rows[stay], shares[stay], once[stay], corners[stay]
    weights = field.area
    if weights is None:
        weights = _shared(len(field.points), rows, shares * _areas(corners))
    carries = ((field.pressure != 0) | (right(field.points)[:, 0] != 0))[rows].any(axis=1) & (_areas(corners) > 0)
    return Patches(field.kind, field.points, corners[carries], rows[carries], shares[carries], once[carries], weights)


def shortest_around(rows: Indices, lengths: Array, count: int) -> Array:
    """The shortest of the triangles' lengths (t) around each point (count); 0 where there are none. Triangles that bridge a hole are
    longer than the others at their corners."""
    shortest = np.full(count, np.inf)
    np.minimum.at(shortest, rows, lengths[:, None])
    return np.where(np.isfinite(shortest), shortest, 0.0)


def with_edge(field: ContactField) -> ContactField:
    """The field of a table without faces, with points of no load where its outermost rows carry: a table often leaves out the nodes
    that are out of contact, but the tractions between nodes end there. Each point mirrors a triangle at the edge."""
    rows, _, once = _triangulated(field.points)
    triangles = rows[once]
    edges = np.concatenate([np.roll(triangles, -k, axis=1) for k in range(3)])  # a corner, and the edge that faces it
    key = np.sort(edges[:, 1:], axis=1)
    _, first, count = np.unique(key, axis=0, return_index=True, return_counts=True)
    opposite, start, end = edges[first[count == 1]].T
    carries = (field.pressure[start] != 0) & (field.pressure[end] != 0)
    x, a, b = (field.points[row[carries]] for row in (opposite, start, end))
    if not len(x):
        return field
    along = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
    distance = np.sum((x - a) * np.stack([-along[:, 1], along[:, 0]], axis=1), axis=1)
    mirrored = (a + b) / 2 - distance[:, None] * np.stack([-along[:, 1], along[:, 0]], axis=1)
    added = _apart(mirrored, field.points, np.minimum(np.abs(distance), np.linalg.norm(b - a, axis=1)))
    rows = {name: np.concatenate([array, np.zeros((len(added), *array.shape[1:]))])
            for name in ("pressure", "traction", "slip", "gap") if (array := getattr(field, name)) is not None}
    return field.replaced(points=np.concatenate([field.points, added]), added=len(added), **rows,
                          said=[*field.said, f"Edge: {len(added)} points without load are added beyond the rows."])


def _apart(points: Array, others: Array, sizes: Array) -> Array:
    """The points (n, 2) that are at least 0.6 of their size (n) from other ones, and from earlier ones of their own."""
    free = KDTree(others).query(points)[0] > 0.6 * sizes
    points, sizes = points[free], sizes[free]
    kept = np.ones(len(points), bool)
    for one, other in sorted(KDTree(points).query_pairs(0.6 * sizes.max(initial=0))):
        if kept[one] and kept[other] and np.linalg.norm(points[one] - points[other]) < 0.6 * sizes[one]:
            kept[other] = False
    return np.asarray(points[kept])


def areas_around(points: Array) -> Array:
    """The area (n) of each point (n, 2): the third of each triangle around it."""
    rows, shares, _ = _triangulated(points)
    return _shared(len(points), rows, shares * _areas(points[rows]))


def _shared(count: int, rows: Indices, areas: Array) -> Array:
    """The areas (t) of triangles shared among their corners."""
    return np.bincount(rows.ravel(), np.repeat(areas / 3, 3), minlength=count)


def _quadrilaterals(points: Array, rows: Indices) -> Indices:
    """Pairs (k, 2) of triangles whose four corners lie on a circle, as corners counted over all triangles: they are the halves of a
    quadrilateral, of which Delaunay's triangulation picks a diagonal by chance."""
    corners = points[rows]
    edges = np.sort(np.stack([np.roll(rows, -1, axis=1), np.roll(rows, -2, axis=1)], axis=2), axis=2).reshape(-1, 2)
    opposite = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)  # of each corner the edge that faces it
    before, after = np.roll(opposite, 1, axis=1), np.roll(opposite, -1, axis=1)
    cotangent = (-np.sum(before * after, axis=2) / (2 * _areas(corners)[:, None])).ravel()
    order = np.lexsort(edges.T)
    first, second = order[:-1], order[1:]
    circular = (edges[first] == edges[second]).all(axis=1) & (np.abs(cotangent[first] + cotangent[second]) < _ON_CIRCLE)
    paired, found = np.zeros(len(rows), dtype=bool), []
    for one, other in zip(first[circular], second[circular]):
        t, u = one // 3, other // 3
        if not (paired[t] or paired[u]):
            paired[[t, u]] = True
            found.append((one, other))
    return np.array(found, np.int64).reshape(-1, 2)


def _areas(corners: Array) -> Array:
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2


def _triangulated(points: Array) -> tuple[Indices, Array, npt.NDArray[np.bool_]]:
    """Delaunay's triangles, without slivers along the hull and triangles that cross a gap; quadrilaterals along both diagonals, with
    half a share each. Returns rows, shares and a mask of triangles that cover everything once, as triangles_of()."""
    simplices = np.asarray(Delaunay(points - points.mean(axis=0)).simplices, dtype=np.int64)
    corners = points[simplices]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    # The usual length of each point's edges: two fifths of them are shorter.
    vertex, length = np.concatenate([simplices.ravel(), np.roll(simplices, 1, axis=1).ravel()]), np.tile(edges.ravel(), 2)
    order, count = np.lexsort((length, vertex)), np.bincount(vertex, minlength=len(points))
    local = length[order][np.minimum(np.cumsum(count) - count + (2 * count) // 5, len(order) - 1)][simplices].max(axis=1)
    flat = 2 * _areas(corners) < 1e-3 * edges.max(axis=1)**2
    rows = simplices[(edges.max(axis=1) < _GAP * local) & ~flat]
    (t, corner), (u, facing) = (divmod(each, 3) for each in _quadrilaterals(points, rows).T)
    a, b, c, d = rows[t, corner], rows[t, (corner + 1) % 3], rows[t, (corner + 2) % 3], rows[u, facing]
    shares = np.ones(len(rows))
    shares[np.concatenate([t, u])] = 0.5
    others = np.concatenate([np.column_stack([a, b, d]), np.column_stack([a, d, c])])
    return (np.concatenate([rows, others]), np.concatenate([shares, np.full(len(others), 0.5)]),
            np.concatenate([np.ones(len(rows), bool), np.zeros(len(others), bool)]))


# ---------------------------------------------------------------- right answers on the mesh


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
