"""Reads the contact of another program: a file, an object of meshio or pyvista, or arrays, as a ContactField.

The reader takes the likely choice where the source leaves one open, and says so (ContactField.said). Options choose otherwise:

kind    key of field.KINDS. Meshes: cell data with pressure and shear are "faces", else point data are "nodes". Tables: rows with
        an area are "points", others "nodes".
names   the arrays' names, as {"pressure": NAME, "q1": NAME}; keys: names.SCALARS and names.VECTORS. NAME:2 is the column 2 of an
        array, counted from 0.
units   "mm,MPa", "mm,N" and so on. Without it: the header's units, else m and Pa (see units.in_units_of).
body    "lower" or "upper": the body on which the shear of the source acts.
axis    the contact's normal from the lower body to the upper one: x, y, z, -x, -y, -z or three components.
basis   "axes": the shear's components lie along x1 and x2. "lower", "upper": along t1, the x axis projected on the surface, and
        t2 = n x t1 with that body's outward normal n.
centre  (x1, x2) of the body's axis, in the source's unit of length.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Optional

import numpy as np

from ..errors import InputError
from .field import Array, ContactField, Indices
from .files import load
from .files.mesh import FACES, Mesh, in_space
from .files.tables import FORMS
from .names import Arrays, Names, checked_names
from .patches import areas_around, with_edge
from .plane import Axis, Frame, check_flat, frame_of, given_normal
from .radial import of_radial_table
from .surface import KNOWN, contact_faces, face_areas, faces_of, nodal_areas, vertices_in_plane
from .units import Units
from .values import HOW_TO_NAME, Options, Values, loaded, values_of


def read(source: Any, *, kind: Optional[str] = None, names: Names = None, units: Optional[str] = None, body: Optional[str] = None,
         axis: Axis = None, basis: Optional[str] = None, centre: Optional[Sequence[float]] = None) -> ContactField:
    """The contact of a file, of a mesh of meshio or pyvista, or of a table of arrays; this module's text explains the options."""
    options = Options(kind, checked_names(names), body, given_normal(axis), basis)
    name = Path(source).name if isinstance(source, (str, Path)) else f"the {type(source).__name__}"
    mesh = load(source, name)
    scale = Units(units, mesh.units, name)
    has_cells = any(cell != "vertex" for cell, _ in mesh.cells)
    field = (_of_mesh if has_cells else _of_table)(mesh, options, scale, name)
    field.said[:0] = [*mesh.said, *scale.said()]
    if centre is not None:
        shift = np.asarray(centre, float) * scale.size("length")
        field.points = field.points - shift
        field.vertices = None if field.vertices is None else field.vertices - shift
    return field


def _of_table(mesh: Mesh, options: Options, units: Units, name: str) -> ContactField:
    """A field of rows without faces: a table, or a file with points only."""
    columns = dict(mesh.point_data)
    if len(mesh.points):
        columns.update(zip(("x1", "x2", "x3"), mesh.points.T))
    arrays = Arrays(columns, options.names, name, "column")
    if arrays.name_of("r") and arrays.name_of("q_theta") and not arrays.name_of("x1"):
        return of_radial_table(arrays, options, units, name)
    if not (arrays.name_of("x1") and arrays.name_of("x2") and arrays.has_pressure()):
        raise InputError(f"{name}: it has the columns {arrays.listed()}; allowed: {FORMS}; or {HOW_TO_NAME}")
    units.learn(arrays)
    points, frame = _points_of(arrays, options, units, name)
    values = values_of(arrays, frame, options, units, name)
    if arrays.name_of("x3"):
        values.said.append(frame.said())
    area = units.scaled(arrays, "area")
    kind = "forces" if values.are_forces else options.kind or ("nodes" if area is None else "points")
    if options.kind is None:
        values.said.append({"forces": "Kind: rows are nodal forces.",
                            "nodes": "Kind: rows are values at nodes, as no area is given.",
                            "points": "Kind: rows are values at points with a weight, as an area is given."}[kind])
    field = _without_duplicates(_field(kind, points, values, area=area, name=name))
    if kind in ("nodes", "forces") and field.area is None:
        field = with_edge(field)
    if values.are_forces and field.area is None:
        field.area = areas_around(field.points)
        field.said.append("Area: the forces are divided by a third of the triangles around each point (Delaunay), or by a fourth "
                          "of rectangles.")
    return _over_areas(field) if values.are_forces else field


def _points_of(arrays: Arrays, options: Options, units: Units, name: str) -> tuple[Array, Frame]:
    """Points (n, 2) in m and the frame of a table; with a third coordinate the contact's plane is found."""
    columns = [column for column in (units.scaled(arrays, role) for role in ("x1", "x2", "x3")) if column is not None]
    points = in_space(np.stack(columns, axis=1))
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise InputError(f"{name}: row {bad[0] + 1}: its coordinates are {points[bad[0]]}; allowed: finite numbers")
    if len(columns) < 3:
        return points[:, :2], Frame(*np.eye(3))
    contact = points[loaded(arrays)]
    frame = frame_of(contact, options.normal, name)
    check_flat(contact, frame, name)
    return frame.in_plane(points), frame


def _field(kind: str, points: Array, values: Values, **more: Any) -> ContactField:
    return ContactField(kind, points, values.pressure, values.traction, slip=values.slip, gap=values.gap, said=values.said,
                        **more)


def _over_areas(field: ContactField) -> ContactField:
    """Forces divided by the areas of their nodes."""
    area = np.asarray(field.area)
    bad = np.flatnonzero(~(area > 0) & (field.pressure != 0))
    if len(bad):
        raise InputError(f"{field.name}: row {bad[0] + 1}: a force of {field.pressure[bad[0]]:.6g} N has the area "
                         f"{area[bad[0]]:.6g} m^2; allowed: more than 0")
    safe = np.where(area > 0, area, 1)
    return field.replaced(pressure=field.pressure / safe, traction=field.traction / safe[:, None])


def _without_duplicates(field: ContactField) -> ContactField:
    """Drops rows that repeat another; refuses points that have two values."""
    size = np.ptp(field.points, axis=0).max(initial=0)
    if not size > 0:
        raise InputError(f"{field.name}: all of its {len(field.points)} points are at one place; allowed: points over a contact")
    _, first, inverse = np.unique(np.round(field.points / (1e-9 * size)), axis=0, return_index=True, return_inverse=True)
    same = first[inverse.reshape(-1)]
    if len(first) == len(same):
        return field
    differ = np.flatnonzero(abs(field.pressure - field.pressure[same]) > 1e-6 * abs(field.pressure).max())
    if len(differ):
        raise InputError(f"{field.name}: rows {same[differ[0]] + 1} and {differ[0] + 1} are at one place, with different "
                         "pressures; allowed: one row for each place (one side of the contact, one step)")
    kept = np.sort(first)
    field.said.append(f"Rows: {len(same) - len(kept)} rows repeat others and are left out.")
    return field.replaced(**{key: value[kept] for key, value in field.__dict__.items()
                             if key in ("points", "pressure", "traction", "area", "slip", "gap") and value is not None})


def _of_mesh(mesh: Mesh, options: Options, units: Units, name: str) -> ContactField:
    """The contact's surface of a mesh, with values at its nodes or on its faces."""
    faces, outer = faces_of(mesh.cells, mesh.points, name)
    at_faces = None if outer and options.kind != "faces" else _cell_arrays(mesh, options, name)
    arrays = at_faces or Arrays(mesh.point_data, options.names, name, "point array")
    if not arrays.has_pressure():
        raise InputError(f"{name}: no array is named like a pressure; it has {_everything(mesh)}; allowed: pressure, CPRESS, "
                         f"contact_pressure, a vector like contact_traction, or {HOW_TO_NAME}")
    in_contact = loaded(arrays)
    if at_faces:
        on_faces, in_contact = in_contact, np.zeros(len(mesh.points), bool)
        for one in faces:
            in_contact[one.nodes[on_faces[one.rows]]] = True
    frame = frame_of(mesh.points[in_contact], options.normal, name)
    check_flat(mesh.points[in_contact], frame, name)
    chosen, owner, said = contact_faces(faces, outer, mesh.points, in_contact, frame, options.body == "upper", name)
    vertices, of_types, nodes = vertices_in_plane(chosen, mesh.points, frame)
    vertices = vertices * units.size("length")
    rows = np.concatenate([one.rows for one in chosen]) if at_faces else nodes
    values = values_of(arrays.rows(rows), frame, options, units, name, owner)
    values.said += [frame.said(), *said,
                    f"Mesh: {sum(map(len, of_types))} faces{' of solids' if outer else ''} with {len(vertices)} nodes.",
                    *(f"Mesh: {len(cells)} cells of {cell} are not read." for cell, cells in mesh.cells if cell not in KNOWN)]
    if at_faces:
        points = np.concatenate([vertices[one].mean(axis=1) for one in of_types])
        areas = np.concatenate([face_areas(one, vertices) for one in of_types])
        return _field("faces", points, values, area=areas, vertices=vertices, faces=of_types, name=name)
    kind = "forces" if values.are_forces else options.kind or "nodes"
    if kind == "forces" and any(faces.shape[1] > 4 for faces in of_types):
        raise InputError(f"{name}: nodal forces on quadratic faces, whose corners carry nothing or less under a uniform "
                         "pressure; allowed: values at nodes or faces, or forces on linear faces")
    if kind == "forces":
        vertices, of_types, values = _one_of_each_node(vertices, of_types, values)
    area = nodal_areas(of_types, vertices) if kind == "forces" else None
    field = _field(kind, vertices, values, area=area, vertices=vertices, faces=of_types, name=name)
    return _over_areas(field) if values.are_forces else field


def _one_of_each_node(vertices: Array, faces: list[Indices], values: Values) -> tuple[Array, list[Indices], Values]:
    """Nodal forces with each node once: files of several pieces repeat the nodes between them, with the whole force."""
    size = np.ptp(vertices, axis=0).max(initial=0)
    _, first, same = np.unique(np.round(vertices / (1e-9 * size)), axis=0, return_index=True, return_inverse=True)
    if len(first) == len(vertices):
        return vertices, faces, values
    values.said.append(f"Rows: {len(vertices) - len(first)} nodes repeat others and are left out.")
    kept = {key: value[first] for key, value in values.__dict__.items() if isinstance(value, np.ndarray)}
    return vertices[first], [same.reshape(-1)[one] for one in faces], replace(values, **kept)


def _cell_arrays(mesh: Mesh, options: Options, name: str) -> Optional[Arrays]:
    """The cell data of the mesh's faces if these are to be read; None: the point data are."""
    if options.kind == "points":
        raise InputError(f'{name}: kind = "points"; allowed for a mesh: nodes, faces, forces')
    blocks = [i for i, (cell, _) in enumerate(mesh.cells) if cell in FACES]
    data = {key: np.concatenate([arrays[i] for i in blocks]) for key, arrays in mesh.cell_data.items() if blocks}
    named = all(array in data for array in options.names.values())
    arrays = Arrays(data, options.names if named else {}, name, "cell array")
    complete = named and arrays.has_pressure() and arrays.has_shear()
    if options.kind == "faces" and not complete:
        raise InputError(f'{name}: kind = "faces" needs cell arrays with pressure and shear; it has {_everything(mesh)}')
    if options.kind not in (None, "faces") or not complete:
        return None
    if options.kind is None and Arrays(mesh.point_data, {}, name, "point array").has_pressure():
        mesh.said.append("Kind: point data and cell data have a pressure; the cell data are taken, because many programs "
                         "extrapolate to the nodes.")
    return arrays


def _everything(mesh: Mesh) -> str:
    point, cell = (", ".join(f"'{key}'" for key in data) or "none" for data in (mesh.point_data, mesh.cell_data))
    return f"the point arrays {point} and the cell arrays {cell}"
