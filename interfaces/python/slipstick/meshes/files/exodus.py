"""Exodus files (.e, .exo, .ex2), of MOOSE and Sierra for example: the last time step."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from .mesh import Blocks, Mesh, in_space

_TYPES = {("TRI", 3): "triangle", ("TRI", 6): "triangle6", ("QUA", 4): "quad", ("QUA", 8): "quad8", ("QUA", 9): "quad9",
          ("SHE", 4): "quad", ("TET", 4): "tetra", ("TET", 10): "tetra10", ("HEX", 8): "hexahedron", ("WED", 6): "wedge",
          ("PYR", 5): "pyramid"}


def _names(variable: Any) -> list[tuple[int, str]]:
    """Numbers, from 1, and names of variables, which are rows of characters."""
    rows = [] if variable is None else np.ma.filled(variable[:], b"")
    return [(i, b"".join(np.asarray(row).tolist()).decode().strip("\0 ")) for i, row in enumerate(rows, 1)]


def read_exodus(path: Path) -> Mesh:
    """The mesh and its variables of the last time; elements of other types than _TYPES are left out."""
    import netCDF4  # type: ignore[import-not-found]
    with netCDF4.Dataset(path) as file:
        has = file.variables
        if "coord" in has:
            points = np.asarray(has["coord"][:]).T
        else:
            points = np.stack([np.asarray(has[key][:]) for key in ("coordx", "coordy", "coordz") if key in has], axis=1)
        blocks = {number: has[f"connect{number}"] for number in range(1, len(file.dimensions["num_el_blk"]) + 1)}
        types = {number: _TYPES.get((block.elem_type.upper()[:3], block.shape[1])) for number, block in blocks.items()}
        cells: Blocks = [(name, np.asarray(blocks[number][:], np.int64) - 1) for number, name in types.items() if name]

        def last(key: str, size: int) -> Any:
            return np.ma.filled(has[key][-1].astype(float), np.nan) if key in has and len(has[key]) else np.full(size, np.nan)
        point_data = {name: last(f"vals_nod_var{i}", len(points)) for i, name in _names(has.get("name_nod_var"))}
        cell_data = {name: [last(f"vals_elem_var{i}eb{number}", len(blocks[number])) for number in types if types[number]]
                     for i, name in _names(has.get("name_elem_var"))}
        times = np.asarray(has["time_whole"][:]) if "time_whole" in has else np.empty(0)
        said = [f"Step: the last one of {len(times)}, at time {times[-1]:g}."] if len(times) > 1 else []
    return Mesh(in_space(points), cells, point_data, cell_data, said=said)
