"""Reads the contact of another program: a file, an object of meshio or pyvista, or arrays, as a ContactField.

The reader takes the likely choice where the source leaves one open, and says so (ContactField.said). Options choose otherwise:

kind    key of field.KINDS. Meshes: cell data with a pressure are "faces", else point data are "nodes". Tables: rows with an area
        are "points", others "nodes".
names   the arrays' names, as {"pressure": NAME, ...} or "pressure=NAME,q1=NAME"; keys: names.SCALARS and names.VECTORS.
units   "mm,MPa" or the like. Without it: the header's units, else m and Pa (see units.in_units_of).
body    "lower" or "upper": the body on which the shear of the source acts.
axis    the contact's normal from the lower body to the upper one: x, y, z, -x, -y, -z or three components.
basis   "axes": the shear's components lie along x1 and x2. "lower", "upper": along t1, the x axis projected on the surface, and
        t2 = n x t1 with that body's outward normal n.
centre  (x1, x2) of the body's axis, in the source's unit of length.
"""
from __future__ import annotations

import contextlib
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Optional

import numpy as np

from ..errors import InputError
from . import mesh as meshes
from .exodus import read_exodus
from .field import Array, ContactField, Indices
from .frd import read_frd
from .mesh import Mesh
from .names import Arrays, Names, given_names
from .surface import Axis, Faces, Frame, check_flat, contact_faces, counter_clockwise, face_areas, faces_of, frame_of, nodal_areas
from .tables import FORMS, read_table, swept
from .units import Units
from .values import HOW_TO_NAME, Options, Values, loads, values_of
from .vtu import read_vtu

_TABLES = (".csv", ".txt", ".tsv", ".dat", ".tab", ".asc")
_XML = (".vtu", ".vtp", ".pvtu", ".pvtp", ".pvd")
_EXODUS = (".e", ".exo", ".ex2")
_MESHIO = (".vtk", ".xdmf", ".xmf", ".med", ".msh", ".inp")


def read(source: Any, *, kind: Optional[str] = None, names: Names = None, units: Optional[str] = None, body: Optional[str] = None,
         axis: Axis = None, basis: Optional[str] = None, centre: Optional[Sequence[float]] = None) -> ContactField:
    """The contact of a file, of a mesh of meshio or pyvista, or of a table of arrays; this module's text explains the options."""
    options = Options(kind, given_names(names), body, axis, basis)
    name = Path(source).name if isinstance(source, (str, Path)) else f"the {type(source).__name__}"
    mesh = _loaded(source, name)
    scale = Units(units, mesh.units, name)
    has_faces = any(cell not in ("vertex", "line") for cell, _ in mesh.cells)
    field = (_of_mesh if has_faces else _of_table)(mesh, options, scale, name)
    field.said[:0] = [*mesh.said, *scale.said()]
    if centre is not None:
        shift = np.asarray(centre, float) * scale.size("length")
        field.points = field.points - shift
        field.vertices = None if field.vertices is None else field.vertices - shift
    return field


def _loaded(source: Any, name: str) -> Mesh:
    """The arrays of a source, as they are."""
    if isinstance(source, (str, Path)):
        return _loaded_file(Path(source))
    if hasattr(source, "point_data") and hasattr(source, "points"):
        return meshes.of_pyvista(source) if hasattr(source, "celltypes") or hasattr(source, "faces") else meshes.of_meshio(source)
    if hasattr(source, "keys") or getattr(getattr(source, "dtype", None), "names", None):
        return meshes.of_columns(source, name)
    raise InputError(f"{name}: allowed: a path, a mesh of meshio or pyvista, a DataFrame or a dict of arrays")


def _loaded_file(path: Path) -> Mesh:
    ending = path.suffix.lower()
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    if ending in (*_TABLES, ""):
        return read_table(path)
    if ending in _XML:
        return read_vtu(path)
    if ending == ".frd":
        return read_frd(path)
    if ending in _EXODUS:
        return read_exodus(path)
    if ending == ".npz":
        with np.load(path) as arrays:
            return meshes.of_columns(dict(arrays), path.name)
    if ending in _MESHIO:
        return _by_meshio(path)
    allowed = ", ".join((*_TABLES, ".npz", ".frd", *_XML, *_EXODUS, *_MESHIO))
    raise InputError(f"{path.name}: unknown extension; allowed: {allowed}; many programs can write .vtu files or tables")


def _by_meshio(path: Path) -> Mesh:
    import meshio  # type: ignore[import-not-found]
    try:
        with contextlib.redirect_stdout(sys.stderr):
            if path.suffix.lower() in (".xdmf", ".xmf") and b"Temporal" in path.read_bytes():
                return _last_of_series(meshio, path)
            return meshes.of_meshio(meshio.read(path))
    except ModuleNotFoundError:
        raise
    except (Exception, SystemExit) as error:  # its readers raise errors of many types, or exit
        raise InputError(f"{path.name}: meshio {meshio.__version__} cannot read it ({type(error).__name__}: {error}); allowed: "
                         "another file type, such as .vtu") from error


def _last_of_series(meshio: Any, path: Path) -> Mesh:
    """The last time step of an XDMF file."""
    with meshio.xdmf.TimeSeriesReader(path) as series:
        points, cells = series.read_points_cells()
        time, point_data, cell_data = series.read_data(series.num_steps - 1)
    mesh = meshes.of_meshio(meshio.Mesh(points, cells, point_data, cell_data))
    mesh.said.append(f"Step: the last one of {series.num_steps}, at time {time:g}.")
    return mesh


def _of_table(mesh: Mesh, options: Options, units: Units, name: str) -> ContactField:
    """A field of rows without faces: a table, or a file with points only."""
    columns = dict(mesh.point_data)
    if len(mesh.points):
        columns.update(zip(("x1", "x2", "x3"), mesh.points.T))
    arrays = Arrays(columns, options.names, name, "column")
    if arrays.name_of("r") and arrays.name_of("q_theta") and not arrays.name_of("x1"):
        return _of_radial_table(arrays, options, units, name)
    if not (arrays.name_of("x1") and arrays.name_of("x2") and arrays.has_pressure()):
        raise InputError(f"{name}: it has the columns {arrays.listed()}; allowed: {FORMS}; or {HOW_TO_NAME}")
    points, frame = _points_of(arrays, options, units, name)
    values = values_of(arrays, frame, options, units, name)
    if arrays.name_of("x3"):
        values.said.append(frame.said())
    area = _scaled(arrays, "area", "area", units)
    kind = options.kind or ("forces" if values.are_forces else "nodes" if area is None else "points")
    if options.kind is None:
        values.said.append({"forces": "Kind: rows are nodal forces.",
                            "nodes": "Kind: rows are values at nodes, as no area is given.",
                            "points": "Kind: rows are values at points with a weight, as an area is given."}[kind])
    field = _without_duplicates(_field(kind, points, values, area=area, name=name))
    if values.are_forces and field.area is None:
        from scipy.spatial import Delaunay  # type: ignore[import-untyped]
        field.area = nodal_areas([np.asarray(Delaunay(field.points).simplices, np.int64)], field.points)
        field.said.append("Area: the forces are divided by a third of the triangles around each point (Delaunay).")
    return _over_areas(field) if values.are_forces else field


def _points_of(arrays: Arrays, options: Options, units: Units, name: str) -> tuple[Array, Frame]:
    """Points (n, 2) in m and the frame of a table; with a third coordinate the contact's plane is found."""
    roles = [role for role in ("x1", "x2", "x3") if arrays.name_of(role)]
    units.note("length", [arrays.name_of(role) or "" for role in roles])
    points = meshes.in_space(np.stack([_scaled(arrays, role, "length", units) for role in roles], axis=1))
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise InputError(f"{name}: row {bad[0] + 1}: its coordinates are {points[bad[0]]}; allowed: finite numbers")
    if len(roles) < 3:
        return points[:, :2], Frame(*np.eye(3))
    contact = points[loads(arrays) != 0]
    frame = frame_of(contact, options.axis, name)
    check_flat(contact, frame, name)
    return frame.in_plane(points), frame


def _scaled(arrays: Arrays, role: str, quantity: str, units: Units) -> Any:
    """A column in SI units; None if the table has none."""
    column = arrays.scalar(role)
    return None if column is None else column * units.size(quantity, arrays.name_of(role) or "")


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
    repeated = np.flatnonzero(same != np.arange(len(same)))
    if not len(repeated):
        return field
    differ = abs(field.pressure - field.pressure[same]) > 1e-6 * abs(field.pressure).max()
    if differ.any():
        row = int(np.flatnonzero(differ)[0])
        raise InputError(f"{field.name}: rows {same[row] + 1} and {row + 1} are at one place, with different pressures; allowed: "
                         "one row for each place (one side of the contact, one step)")
    kept = np.sort(first)
    field.said.append(f"Rows: {len(repeated)} rows repeat others and are left out.")
    return field.replaced(**{key: value[kept] for key, value in field.__dict__.items()
                             if key in ("points", "pressure", "traction", "area", "slip", "gap") and value is not None})


def _of_radial_table(arrays: Arrays, options: Options, units: Units, name: str) -> ContactField:
    """Values on a radius of an axisymmetric contact, put on circles of nodes."""
    if not arrays.name_of("pressure"):
        raise InputError(f"{name}: it has the columns {arrays.listed()} and no pressure; allowed: {FORMS}; or {HOW_TO_NAME}")
    units.note("length", [arrays.name_of("r") or ""])
    units.note("stress", [arrays.name_of(role) or "" for role in ("pressure", "q_theta")])
    radii, pressure, around, outward = (_scaled(arrays, role, "length" if role == "r" else "stress", units)
                                        for role in ("r", "pressure", "q_theta", "q_r"))
    order = np.argsort(radii)
    rows = [np.zeros_like(radii) if column is None else np.nan_to_num(column[order])
            for column in (radii, pressure, around, outward)]
    if not (rows[0][0] >= 0 and np.all(np.diff(rows[0]) > 0) and rows[1].max() > 0):
        raise InputError(f"{name}: allowed: radii that differ, from 0, and a positive pressure at one or more of them")
    vertices, faces, on_nodes, traction = swept(*rows)
    said = [f"Kind: {len(radii)} radii are turned about the axis, to {len(vertices)} nodes with {len(faces[0])} angles."]
    if options.body == "upper":
        traction = -traction
        said.append("Body: the shear acts on the upper body, and is turned.")
    if rows[0][0] > 0:
        said.append("Axis: the pressure at the axis is extrapolated from the first two radii.")
    return ContactField("nodes", vertices, on_nodes, traction, vertices=vertices, faces=faces, name=name, said=said)


def _of_mesh(mesh: Mesh, options: Options, units: Units, name: str) -> ContactField:
    """The contact's surface of a mesh, with values at its nodes or on its faces."""
    faces, outer = faces_of(mesh.cells, name)
    at_faces = _at_faces(mesh, options, outer, name)
    if not at_faces:
        arrays = Arrays(mesh.point_data, options.names, name, "point array")
        if not arrays.has_pressure():
            raise InputError(f"{name}: no array is named like a pressure; it has {_everything(mesh)}; allowed: pressure, CPRESS, "
                             f"contact_pressure, a vector like contact_traction, or {HOW_TO_NAME}")
        loaded = loads(arrays) != 0
    else:
        arrays = at_faces
        on_faces, loaded = loads(arrays) != 0, np.zeros(len(mesh.points), bool)
        for one in faces:
            loaded[one.nodes[on_faces[one.rows]]] = True
    frame = frame_of(mesh.points[loaded], options.axis, name)
    check_flat(mesh.points[loaded], frame, name)
    chosen, owner = contact_faces(faces, outer, mesh.points, loaded, frame, options.body == "upper")
    vertices, of_types, nodes, rows = _in_plane(chosen, mesh.points, frame)
    vertices = vertices * units.size("length")
    values = values_of(arrays.rows(rows if at_faces else nodes), frame, options, units, name, owner)
    values.said += [frame.said(),
                    f"Mesh: {sum(map(len, of_types))} faces{' of solids' if outer else ''} with {len(vertices)} nodes."]
    if at_faces:
        points = np.concatenate([vertices[one].mean(axis=1) for one in of_types])
        areas = np.concatenate([face_areas(one, vertices) for one in of_types])
        field = _field("faces", points, values, area=areas, vertices=vertices, faces=of_types, name=name)
    else:
        kind = "forces" if values.are_forces else options.kind or "nodes"
        areas = nodal_areas(of_types, vertices) if kind == "forces" else None
        field = _field(kind, vertices, values, area=areas, vertices=vertices, faces=of_types, name=name)
    return _over_areas(field) if values.are_forces else field


def _at_faces(mesh: Mesh, options: Options, outer: bool, name: str) -> Optional[Arrays]:
    """The cell data of the mesh's faces if these are to be read; None: the point data are."""
    if options.kind == "points":
        raise InputError(f'{name}: kind = "points"; allowed for a mesh: nodes, faces, forces')
    blocks = [i for i, (cell, _) in enumerate(mesh.cells) if cell in meshes.FACES]
    data = {key: np.concatenate([arrays[i] for i in blocks]) for key, arrays in mesh.cell_data.items() if blocks}
    fits = all(array in data for array in options.names.values())
    arrays = Arrays(data, options.names if fits else {}, name, "cell array")
    if options.kind == "faces" and not (fits and arrays.has_pressure()):
        raise InputError(f'{name}: kind = "faces" needs a cell array named like a pressure; it has {_everything(mesh)}')
    if options.kind not in (None, "faces") or outer or not (fits and arrays.has_pressure()):
        return None
    if options.kind is None and Arrays(mesh.point_data, {}, name, "point array").has_pressure():
        mesh.said.append("Kind: point data and cell data have a pressure; the cell data are taken, because many programs "
                         "extrapolate to the nodes.")
    return arrays


def _everything(mesh: Mesh) -> str:
    point, cell = (", ".join(f"'{key}'" for key in data) or "none" for data in (mesh.point_data, mesh.cell_data))
    return f"the point arrays {point} and the cell arrays {cell}"


def _in_plane(chosen: list[Faces], points: Array, frame: Frame) -> tuple[Array, list[Indices], Indices, Indices]:
    """The chosen faces in the plane: their vertices (m, 2), the faces by type as indices into these, the vertices' places in the
    file and the faces' places in its cell data."""
    sizes = list(dict.fromkeys(one.nodes.shape[1] for one in chosen))
    nodes, renumbered = np.unique(np.concatenate([one.nodes.ravel() for one in chosen]), return_inverse=True)
    vertices = frame.in_plane(points[nodes])
    parts = np.split(renumbered.reshape(-1), np.cumsum([one.nodes.size for one in chosen])[:-1])
    by_size: dict[int, list[Indices]] = {size: [] for size in sizes}
    for one, part in zip(chosen, parts):
        by_size[one.nodes.shape[1]].append(part.reshape(one.nodes.shape))
    of_types = [counter_clockwise(np.concatenate(arrays), vertices) for arrays in by_size.values()]
    rows = [one.rows for size in sizes for one in chosen if one.nodes.shape[1] == size and one.rows is not None]
    return vertices, of_types, nodes, np.concatenate(rows) if rows else np.empty(0, np.int64)
