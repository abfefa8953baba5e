"""The contact's surface in a mesh: its faces and their areas."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Optional

import numpy as np
import numpy.typing as npt

from ..errors import InputError
from .displacement import triangles_of
from .field import Array, Indices
from .files.mesh import FACES, Blocks
from .plane import Frame

Mask = npt.NDArray[np.bool_]

# Shapes of solids: corners of the faces, and the edges in the order of their middle nodes.
_Shape = tuple[list[tuple[int, ...]], list[tuple[int, int]]]
_BOTTOM, _TOP = [(0, 1), (1, 2), (2, 3), (3, 0)], [(4, 5), (5, 6), (6, 7), (7, 4)]
_TETRA: _Shape = ([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)], [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)])
_HEXAHEDRON: _Shape = ([(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
                       [*_BOTTOM, *_TOP, (0, 4), (1, 5), (2, 6), (3, 7)])
_WEDGE: _Shape = ([(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
                  [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)])
_PYRAMID: _Shape = ([(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)], [*_BOTTOM, (0, 4), (1, 4), (2, 4), (3, 4)])
_HEXAHEDRON_MIDDLES = [24, 25, 22, 21, 23, 20]  # of hexahedron27: the centres of the faces above
_SOLIDS: dict[str, tuple[_Shape, int]] = {
    "tetra": (_TETRA, 4), "tetra10": (_TETRA, 4), "hexahedron": (_HEXAHEDRON, 8), "hexahedron20": (_HEXAHEDRON, 8),
    "hexahedron27": (_HEXAHEDRON, 8), "wedge": (_WEDGE, 6), "wedge15": (_WEDGE, 6), "pyramid": (_PYRAMID, 5),
    "pyramid13": (_PYRAMID, 5)}
KNOWN = {*FACES, *_SOLIDS, "vertex", "line", "line3"}
_TURNED = {3: [0, 2, 1], 6: [0, 2, 1, 5, 4, 3], 4: [0, 3, 2, 1], 8: [0, 3, 2, 1, 7, 6, 5, 4], 9: [0, 3, 2, 1, 7, 6, 5, 4, 8]}


@dataclass(frozen=True)
class Faces:
    """Faces of one type: nodes (m, 3, 4, 6, 8 or 9); rows (m): their places among the file's faces, None for faces of solids."""

    nodes: Indices
    rows: Optional[Indices] = None

    def corners(self) -> Indices:
        return self.nodes[:, :3 if self.nodes.shape[1] in (3, 6) else 4]

    def chosen(self, which: Mask) -> Faces:
        return Faces(self.nodes[which], None if self.rows is None else self.rows[which])

    def normals(self, points: Array) -> Array:
        """Unit normals of the corners' plane, (m, 3); zero for a face without area."""
        corners = points[self.corners()]
        normals = np.cross(corners[:, 1] - corners[:, -1], corners[:, 2] - corners[:, 0])  # of a triangle: twice from its sides
        return np.asarray(normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None])


def _of_solids(cells: Blocks, points: Array) -> list[Faces]:
    """The faces that belong to one solid only, seen counter-clockwise from outside."""
    by_size: dict[int, list[Indices]] = {}
    for name, nodes in cells:
        (faces, edges), corners = _SOLIDS.get(name, (([], []), 0))
        middle = {frozenset(edge): corners + i for i, edge in enumerate(edges)} if nodes.shape[1] > corners else {}
        centres = points[nodes].mean(axis=1)
        for i, face in enumerate(faces):
            places = [*face, *(middle[frozenset(edge)] for edge in zip(face, (*face[1:], face[0])) if middle)]
            if name == "hexahedron27":
                places.append(_HEXAHEDRON_MIDDLES[i])
            found = nodes[:, places]
            outwards = points[found].mean(axis=1) - centres
            inside_out = (Faces(found).normals(points) * outwards).sum(axis=1) < 0  # programs differ in the order of wedges
            by_size.setdefault(len(places), []).append(_turned(found, inside_out))
    outer = []
    for size, arrays in by_size.items():
        of_size = np.concatenate(arrays)
        key = np.sort(of_size[:, :3 if size in (3, 6) else 4], axis=1)
        _, first, counts = np.unique(key, axis=0, return_index=True, return_counts=True)
        outer.append(Faces(of_size[np.sort(first[counts == 1])]))
    return outer


def _turned(faces: Indices, which: Mask) -> Indices:
    """Faces (m, k), some of them with their nodes the other way round."""
    turned = faces.copy()
    turned[which] = faces[which][:, _TURNED[faces.shape[1]]]
    return turned


def faces_of(cells: Blocks, points: Array, source: str) -> tuple[list[Faces], bool]:
    """The faces of a mesh, and whether they are the outer faces of its solids, because it has no faces of its own."""
    own: dict[int, list[tuple[Indices, Indices]]] = {}
    total = 0
    for name, nodes in cells:
        if name in FACES:
            own.setdefault(FACES[name], []).append((nodes, total + np.arange(len(nodes))))
            total += len(nodes)
    if own:
        return [Faces(*map(np.concatenate, zip(*blocks))) for blocks in own.values()], False
    outer = _of_solids(cells, points)
    if not outer:
        kinds = ", ".join(dict.fromkeys(name for name, _ in cells)) or "none"
        raise InputError(f"{source}: its mesh has no faces; it has cells of these types: {kinds}; allowed: {', '.join(FACES)}, "
                         "or solids with such faces")
    return outer, True


def contact_faces(faces: list[Faces], outer: bool, points: Array, loaded: Mask, frame: Frame, upper: bool,
                  source: str) -> tuple[list[Faces], Optional[str], list[str]]:
    """The faces of the contact; the body whose faces they are, "lower" or "upper", if solids show it; and the choices made.

    Faces near the contact's plane are taken; of solids, only those with loaded nodes. If both bodies have loaded faces, those of
    the lower or the upper one are taken. loaded (n): nodes with a pressure."""

    def of_all(function: Callable[[Faces], Array]) -> Array:
        return np.concatenate([function(face) for face in faces])

    def split(which: Mask) -> list[Mask]:
        return np.split(which, np.cumsum([len(face.nodes) for face in faces])[:-1])

    vertices = frame.in_plane(points)
    middle, size = (points[loaded] @ frame.x3).mean(), np.ptp(vertices[loaded], axis=0).max()
    towards = of_all(lambda face: face.normals(points) @ frame.x3)
    height = of_all(lambda face: (points[face.corners()] @ frame.x3).mean(axis=1))
    flat = (abs(towards) > 0.8) & (abs(height - middle) < 0.1 * size)
    single = flat & _is_first(of_all(lambda face: vertices[face.nodes].mean(axis=1)), flat)
    touching = single & of_all(lambda face: loaded[face.corners()].any(axis=1))
    if not touching.any():
        raise InputError(f"{source}: no face with a pressure lies in the contact's plane; allowed: faces that follow it, or its "
                         "normal as --read-as axis=NX,NY,NZ")
    said = [f"Mesh: {flat.sum() - single.sum()} faces lie on others and are left out."] if single.sum() < flat.sum() else []
    both = bool((towards[touching] > 0).any() and (towards[touching] < 0).any())
    if not outer:  # the order of nodes shows the body only where two surfaces lie on each other
        layered = _layers([face.chosen(part) for face, part in zip(faces, split(touching))], vertices) > 1.5
        if layered and not both:
            raise InputError(f"{source}: faces with a pressure lie on each other, so that the load counts twice; allowed: one "
                             "body's surface")
        both = both and layered
    chosen = touching if outer else single
    if both:
        chosen = chosen & (towards * (-1 if upper else 1) > 0)
        said.append(f"Mesh: both bodies' faces have a pressure; those of the {'upper' if upper else 'lower'} one are taken.")
    owner = None if both or not outer else "lower" if (towards[touching] > 0).any() else "upper"
    return [face.chosen(part) for face, part in zip(faces, split(chosen)) if part.any()], owner, said


def _is_first(centres: Array, which: Mask) -> Mask:
    """Some of the faces, without those whose centre (m, 2) is another one's, as a second body's or another piece's may be."""
    chosen = np.flatnonzero(which)
    _, first = np.unique(np.round(centres[chosen] / (1e-7 * np.ptp(centres, axis=0).max())), axis=0, return_index=True)
    return np.isin(np.arange(len(centres)), chosen[first])


def _layers(faces: list[Faces], vertices: Array) -> float:
    """The area of faces over the area of the convex figure around them: about 1, and 2 where two surfaces lie on each other."""
    from scipy.spatial import ConvexHull  # type: ignore[import-untyped]
    around = ConvexHull(vertices[np.unique(np.concatenate([face.nodes.ravel() for face in faces]))])
    return float(sum(face_areas(face.nodes, vertices).sum() for face in faces) / around.volume)


def _areas(corners: Array) -> Array:
    """Signed areas of polygons (m, k, 2)."""
    x, y = corners[..., 0], corners[..., 1]
    return np.asarray(0.5 * (x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1))


def face_areas(faces: Indices, vertices: Array) -> Array:
    """(m): areas of faces; quadratic ones as the polygons through their middle nodes."""
    triangles, face, shares, _ = triangles_of([faces])
    return np.bincount(face, shares * abs(_areas(vertices[triangles])), minlength=len(faces))


def nodal_areas(faces: list[Indices], vertices: Array) -> Array:
    """(n): the area of each node, a third of each triangle around it."""
    triangles, _, shares, _ = triangles_of(faces)
    return np.bincount(triangles.ravel(), np.repeat(shares * abs(_areas(vertices[triangles])) / 3, 3), minlength=len(vertices))


def vertices_in_plane(chosen: list[Faces], points: Array, frame: Frame) -> tuple[Array, list[Indices], Indices]:
    """The vertices (m, 2) of faces, the faces of each type as indices into these, counter-clockwise, and the vertices' places in
    the file."""
    nodes = np.unique(np.concatenate([one.nodes.ravel() for one in chosen]))
    vertices = frame.in_plane(points[nodes])
    renumbered = [Faces(np.searchsorted(nodes, one.nodes)) for one in chosen]
    return vertices, [_turned(one.nodes, _areas(vertices[one.corners()]) < 0) for one in renumbered], nodes
