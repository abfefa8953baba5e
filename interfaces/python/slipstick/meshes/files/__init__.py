"""Readers: a file, or an object of another package, as a Mesh with its arrays, before anything is chosen."""
from __future__ import annotations

import contextlib
import io
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from . import mesh as meshes
from .exodus import read_exodus
from .frd import read_frd
from .mesh import Mesh
from .tables import read_table
from .vtu import read_vtu

_TABLES = (".csv", ".txt", ".tsv", ".dat", ".tab", ".asc")
_XML = (".vtu", ".vtp", ".pvtu", ".pvtp", ".pvd")
_EXODUS = (".e", ".exo", ".ex2")
_MESHIO = (".vtk", ".xdmf", ".xmf", ".med", ".msh", ".inp")


def load(source: Any, name: str) -> Mesh:
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
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed):
            if path.suffix.lower() in (".xdmf", ".xmf") and b"Temporal" in path.read_bytes():
                return _last_of_series(meshio, path)
            return meshes.of_meshio(meshio.read(path))
    except ModuleNotFoundError:
        raise
    except (Exception, SystemExit) as error:  # its readers raise errors of many types, or print and exit
        reason = printed.getvalue().strip() or f"{type(error).__name__}: {error}"
        raise InputError(f"{path.name}: meshio {meshio.__version__} cannot read it: {reason}; allowed: another file type, "
                         "such as .vtu") from error


def _last_of_series(meshio: Any, path: Path) -> Mesh:
    """The last time step of an XDMF file."""
    with meshio.xdmf.TimeSeriesReader(path) as series:
        points, cells = series.read_points_cells()
        time, point_data, cell_data = series.read_data(series.num_steps - 1)
    mesh = meshes.of_meshio(meshio.Mesh(points, cells, point_data, cell_data))
    mesh.said.append(f"Step: the last one of {series.num_steps}, at time {time:g}.")
    return mesh
