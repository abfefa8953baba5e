"""The contact's surface in a mesh in space: its faces, its plane, its axes."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Optional, Union

import numpy as np
import numpy.typing as npt

from ..errors import InputError
from .field import Array, Indices
from .mesh import FACES, Blocks

Axis = Union[None, str, Sequence[float]]

_BOTTOM_4, _TOP_4 = [(0, 1), (1, 2), (2, 3), (3, 0)], [(4, 5), (5, 6), (6, 7), (7, 4)]
_TETRA = ([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)], [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)])
_HEXAHEDRON = ([(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
               [*_BOTTOM_4, *_TOP_4, (0, 4), (1, 5), (2, 6), (3, 7)])
_WEDGE = ([(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
          [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)])
_PYRAMID = ([(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)], [*_BOTTOM_4, (0, 4), (1, 4), (2, 4), (3, 4)])
_HEXAHEDRON_MIDDLES = [24, 25, 22, 21, 23, 20]  # the centres of the faces above in hexahedron27
# Corners of the faces, seen counter-clockwise from outside, and the edges in the order of their middle nodes.
_SOLIDS = {"tetra": (_TETRA, 4), "tetra10": (_TETRA, 4), "hexahedron": (_HEXAHEDRON, 8), "hexahedron20": (_HEXAHEDRON, 8),
           "hexahedron27": (_HEXAHEDRON, 8), "wedge": (_WEDGE, 6), "wedge15": (_WEDGE, 6), "pyramid": (_PYRAMID, 5),
           "pyramid13": (_PYRAMID, 5)}
_TURNED = {3: [0, 2, 1], 6: [0, 2, 1, 5, 4, 3], 4: [0, 3, 2, 1], 8: [0, 3, 2, 1, 7, 6, 5, 4], 9: [0, 3, 2, 1, 7, 6, 5, 4, 8]}
_PARTS = {3: [(0, 1, 2)], 6: [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)], 4: [(0, 1, 2, 3)],
          8: [(0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6, 7)],
          9: [(0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)]}


@dataclass(frozen=True)
class Faces:
    """Faces of one type: nodes (m, 3, 4, 6, 8 or 9); rows (m): their places among the file's faces, None for faces of solids."""

    nodes: Indices
    rows: Optional[Indices] = None

    def corners(self) -> Indices:
        return self.nodes[:, :3 if self.nodes.shape[1] in (3, 6) else 4]

    def chosen(self, which: npt.NDArray[np.bool_]) -> Faces:
        return replace(self, nodes=self.nodes[which], rows=None if self.rows is None else self.rows[which])

    def normals(self, points: Array) -> Array:
        """Unit normals of the corners' plane, (m, 3); zero for a face without area."""
        corners = points[self.corners()]
        normals = np.cross(corners[:, 1] - corners[:, -1], corners[:, 2] - corners[:, 0])  # of a triangle: twice from its sides
        return np.asarray(normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None])


def _of_solids(cells: Blocks) -> list[Faces]:
    """The faces that belong to one solid only, seen counter-clockwise from outside."""
    by_size: dict[int, list[Indices]] = {}
    for name, nodes in cells:
        (faces, edges), corners = _SOLIDS.get(name, (([], []), 0))
        middle = {frozenset(edge): corners + i for i, edge in enumerate(edges)} if nodes.shape[1] > corners else {}
        for i, face in enumerate(faces):
            places = [*face, *(middle[frozenset(edge)] for edge in zip(face, (*face[1:], face[0])) if middle)]
            if name == "hexahedron27":
                places.append(_HEXAHEDRON_MIDDLES[i])
            by_size.setdefault(len(places), []).append(nodes[:, places])
    found = []
    for size, arrays in by_size.items():
        faces_of_size = np.concatenate(arrays)
        key = np.sort(faces_of_size[:, :3 if size in (3, 6) else 4], axis=1)
        _, first, counts = np.unique(key, axis=0, return_index=True, return_counts=True)
        found.append(Faces(faces_of_size[np.sort(first[counts == 1])]))
    return found


def faces_of(cells: Blocks, source: str) -> tuple[list[Faces], bool]:
    """The faces of a mesh, and whether they are the outer faces of its solids, because it has no faces of its own."""
    own, total = [], 0
    for name, nodes in cells:
        if name in FACES:
            own.append(Faces(nodes, total + np.arange(len(nodes))))
            total += len(nodes)
    if own:
        return own, False
    outer = _of_solids(cells)
    if not outer:
        kinds = ", ".join(dict.fromkeys(name for name, _ in cells)) or "none"
        raise InputError(f"{source}: its mesh has no faces; it has cells of these types: {kinds}; allowed: {', '.join(FACES)}, "
                         "or solids with such faces")
    return outer, True


@dataclass(frozen=True)
class Frame:
    """Unit vectors in the file's axes; x3 points from the lower body into the upper one."""

    x1: Array
    x2: Array
    x3: Array

    def in_plane(self, vectors: Array) -> Array:
        """(n, 2): the components along x1 and x2."""
        return np.stack([vectors @ self.x1, vectors @ self.x2], axis=1)

    def tangents(self, of_upper: bool) -> Array:
        """(2, 2): the components along x1 and x2 of t1, the x axis projected on the surface, and of t2 = n x t1; n is the outward
        normal of the lower or of the upper body. Along x the z axis takes the place of the x axis."""
        first = _projected(self.x3)
        second = np.cross(-self.x3 if of_upper else self.x3, first)
        return self.in_plane(np.stack([first, second]))

    def said(self) -> str:
        return (f"Axes: the contact's normal is {_axis_text(self.x3)}, from the lower body to the upper one; x1 is "
                f"{_axis_text(self.x1)}, x2 is {_axis_text(self.x2)}.")


def _axis_text(vector: Array) -> str:
    if abs(vector).max() == 1.0:
        return ("-" if vector.sum() < 0 else "") + "xyz"[int(abs(vector).argmax())]
    return "(" + ", ".join(f"{component:.4g}" for component in vector) + ")"


def _projected(normal: Array) -> Array:
    """The x axis projected on a plane; the z axis if x is within 0.1 degrees of the normal, as in CalculiX and Abaqus."""
    axis = np.eye(3)[2 if 1 - abs(normal[0]) < 1.5231e-6 else 0]
    along = axis - (axis @ normal) * normal
    return np.asarray(along / np.linalg.norm(along))


def _given_normal(axis: Axis) -> Array:
    if isinstance(axis, str) and axis.lstrip("+-") in ("x", "y", "z"):
        return np.eye(3)["xyz".index(axis[-1])] * (-1 if axis.startswith("-") else 1)
    try:
        normal = np.array([float(part) for part in (axis.split(",") if isinstance(axis, str) else axis or ())])
    except ValueError:
        normal = np.empty(0)
    if normal.shape != (3,) or not np.linalg.norm(normal) > 0:
        raise InputError(f'axis = "{axis}"; allowed: x, y, z, -x, -y, -z, or three components "nx,ny,nz"')
    return np.asarray(normal / np.linalg.norm(normal))


def frame_of(contact: Array, axis: Axis, source: str) -> Frame:
    """The frame of points (n, 3) in contact: the plane nearest to them, or a given normal."""
    if axis is not None:
        normal = _given_normal(axis)
    elif len(contact) < 3:
        raise InputError(f"{source}: {len(contact)} points have a pressure; allowed: 3 or more, to find the contact's plane")
    else:
        normal = np.linalg.svd(contact - contact.mean(axis=0), full_matrices=False)[2][2]
        normal = normal * np.sign(normal[abs(normal).argmax()])
        if abs(normal).max() > 1 - 2e-4:  # 1 degree
            normal = np.round(normal)
    if abs(normal).max() == 1.0:
        k = int(abs(normal).argmax())
        return Frame(np.eye(3)[(k + 1) % 3], np.eye(3)[(k + 2) % 3] * normal[k], normal)
    first = _projected(normal)
    return Frame(first, np.cross(normal, first), normal)


def check_flat(contact: Array, frame: Frame, source: str) -> None:
    """Refuses a contact whose points (n, 3) leave their plane by more than a tenth of its size."""
    height, size = np.ptp(contact @ frame.x3), np.ptp(frame.in_plane(contact), axis=0).max()
    if not height <= 0.1 * size:
        raise InputError(f"{source}: the contact's surface is curved: its heights along {_axis_text(frame.x3)} differ by "
                         f"{height:.3g} over a size of {size:.3g}; allowed: at most a tenth of the size (another normal: axis)")


def contact_faces(faces: list[Faces], outer: bool, points: Array, loaded: Array, frame: Frame,
                  upper: bool) -> tuple[list[Faces], Optional[str]]:
    """The faces of the contact's surface. Of solids: faces with loaded nodes; if those of both bodies are loaded, the lower
    body's or the upper one's. Of a file's own faces: those near the contact's plane. loaded (n): nodes with a pressure. Also the
    body whose faces they are, "lower" or "upper", if solids show it."""
    contact = points[loaded]
    middle, size = (contact @ frame.x3).mean(), np.ptp(frame.in_plane(contact), axis=0).max()
    towards = [face.normals(points) @ frame.x3 for face in faces]
    near = [abs((points[face.corners()] @ frame.x3).mean(axis=1) - middle) < size for face in faces]
    flat = [(abs(cosine) > 0.8) & close for cosine, close in zip(towards, near)]
    owner = None
    if outer:
        flat = [one & loaded[face.corners()].any(axis=1) for one, face in zip(flat, faces)]
        signs = np.concatenate([np.sign(cosine[one]) for cosine, one in zip(towards, flat)])
        if (signs > 0).any() and (signs < 0).any():
            flat = [one & (cosine * (-1 if upper else 1) > 0) for one, cosine in zip(flat, towards)]
        else:
            owner = "lower" if (signs > 0).any() else "upper"
    return [face.chosen(one) for face, one in zip(faces, flat) if one.any()], owner


def counter_clockwise(faces: Indices, vertices: Array) -> Indices:
    """The same faces (m, k), each seen counter-clockwise in the plane."""
    corners = vertices[faces[:, :3 if faces.shape[1] in (3, 6) else 4]]
    clockwise = _areas(corners) < 0
    turned = faces.copy()
    turned[clockwise] = faces[clockwise][:, _TURNED[faces.shape[1]]]
    return turned


def _areas(corners: Array) -> Array:
    """Signed areas of polygons (m, k, 2)."""
    x, y = corners[..., 0], corners[..., 1]
    return np.asarray(0.5 * (x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1))


def face_areas(faces: Indices, vertices: Array) -> Array:
    """(m): areas of faces; quadratic ones as the polygons through their middle nodes."""
    return np.asarray(sum(abs(_areas(vertices[faces[:, list(part)]])) for part in _PARTS[faces.shape[1]]))


def nodal_areas(faces: list[Indices], vertices: Array) -> Array:
    """(n): the area of each node: of each face's linear parts an equal share."""
    areas = np.zeros(len(vertices))
    for of_type in faces:
        for part in _PARTS[of_type.shape[1]]:
            nodes = of_type[:, list(part)]
            np.add.at(areas, nodes, (abs(_areas(vertices[nodes])) / len(part))[:, None])
    return areas
