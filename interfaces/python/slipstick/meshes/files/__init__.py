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


def load(source: Any, name: str) -> Mesh:
    """The arrays of a source, as they are."""
    mesh = _loaded_file(Path(source)) if isinstance(source, (str, Path)) else _of_object(source, name)
    _check(mesh, name)
    return mesh


def _of_object(source: Any, name: str) -> Mesh:
    if hasattr(source, "point_data") and hasattr(source, "points"):
        return meshes.of_pyvista(source) if hasattr(source, "celltypes") or hasattr(source, "faces") else meshes.of_meshio(source)
    if hasattr(source, "keys") or getattr(getattr(source, "dtype", None), "names", None):
        return meshes.of_columns(source, name)
    raise InputError(f"{name}: allowed: a path, a mesh of meshio or pyvista, a DataFrame or a dict of arrays")


def _loaded_file(path: Path) -> Mesh:
    """The arrays of a file, by the reader of its extension."""
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(f"{path.name}: unknown extension; allowed: {', '.join(filter(None, _READERS))}; many programs can write "
                         ".vtu files or tables")
    try:
        return reader(path)
    except (InputError, ModuleNotFoundError):
        raise
    except Exception as error:  # a damaged file lets a reader fail in any way
        reason = str(error) or type(error).__name__
        raise InputError(f"{path.name}: it is damaged, or not of the type {path.suffix}: {reason}") from error


def _check(mesh: Mesh, name: str) -> None:
    """Refuses a mesh whose arrays do not belong together."""
    rows = len(mesh.points)
    nodes = [block for _, block in mesh.cells if block.size]
    whole = all(block.min() >= 0 and block.max() < rows for block in nodes) and np.isfinite(mesh.points).all()
    at_points = not rows or all(len(array) == rows for array in mesh.point_data.values())
    sizes = [len(block) for _, block in mesh.cells]
    at_cells = all([len(array) for array in arrays] == sizes for arrays in mesh.cell_data.values())
    if not (whole and at_points and at_cells):
        raise InputError(f"{name}: its points, cells and arrays do not belong together; allowed: finite points, cells of these "
                         "points, and one row for each of them in each array")


def _read_npz(path: Path) -> Mesh:
    with np.load(path) as arrays:
        return meshes.of_columns(dict(arrays), path.name)


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


_READERS = {**dict.fromkeys((".csv", ".txt", ".tsv", ".dat", ".tab", ".asc", ""), read_table), ".npz": _read_npz,
            **dict.fromkeys((".vtu", ".vtp", ".pvtu", ".pvtp", ".pvd"), read_vtu), ".frd": read_frd,
            **dict.fromkeys((".e", ".exo", ".ex2"), read_exodus),
            **dict.fromkeys((".vtk", ".xdmf", ".xmf", ".med", ".msh", ".inp"), _by_meshio)}
