"""Points, cells and arrays as a file or another program's object holds them, before anything is chosen."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...errors import InputError
from ..field import Array, Indices

Blocks = list[tuple[str, Indices]]

FACES = {"triangle": 3, "triangle6": 6, "quad": 4, "quad8": 8, "quad9": 9}
_VTK = {5: "triangle", 22: "triangle6", 9: "quad", 23: "quad8", 28: "quad9", 10: "tetra", 24: "tetra10", 12: "hexahedron",
        25: "hexahedron20", 29: "hexahedron27", 13: "wedge", 26: "wedge15", 14: "pyramid", 27: "pyramid13", 1: "vertex",
        2: "vertex", 3: "line", 4: "line", 21: "line"}
# Types whose number of nodes varies: polygon, Lagrange triangle, quadrilateral, tetrahedron, hexahedron.
_VTK_SIZED = {(7, 3): "triangle", (7, 4): "quad", (69, 3): "triangle", (69, 6): "triangle6", (70, 4): "quad", (70, 9): "quad9",
              (71, 4): "tetra", (71, 10): "tetra10", (72, 8): "hexahedron"}
_VTK_IN_RASTER_ORDER = {8: ("quad", [0, 1, 3, 2]), 11: ("hexahedron", [0, 1, 3, 2, 4, 5, 7, 6])}  # pixel, voxel
_CCX_CONTACT = ("COPEN", "CSLIP1", "CSLIP2", "CPRESS", "CSHEAR1", "CSHEAR2")


@dataclass
class Mesh:
    """points (n, 3), or none for a table. cells: blocks of one type, named and ordered as in meshio. point_data: arrays of n
    rows, by name; the columns of a table. cell_data: for each name one array a block. units: of arrays, where a file has them."""

    points: Array = field(default_factory=lambda: np.empty((0, 3)))
    cells: Blocks = field(default_factory=list)
    point_data: dict[str, Array] = field(default_factory=dict)
    cell_data: dict[str, list[Array]] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    said: list[str] = field(default_factory=list)


def in_space(points: Any) -> Array:
    """Points (n, 2) or (n, 3) as (n, 3)."""
    array = np.atleast_2d(np.asarray(points, float))
    return np.pad(array, ((0, 0), (0, 3 - array.shape[1])))


def split_contact(data: Mapping[str, Any]) -> dict[str, Array]:
    """Arrays by name, the six columns of CalculiX's CONTACT as arrays of their own."""
    split: dict[str, Array] = {}
    for name, values in data.items():
        array = np.asarray(values)
        if array.ndim == 2 and name.lower() == "contact" and array.shape[1] == 6:
            split.update(zip(_CCX_CONTACT, array.T))
        else:
            split[name] = array
    return split


def _of_vtk_cells(types: Indices, sizes: Indices, connectivity: Indices) -> tuple[Blocks, list[Indices]]:
    """Blocks of cells in VTK's numbers of types, and for each block the cells' places in the list. Polygons become triangles."""
    starts = np.cumsum(sizes) - sizes
    blocks: Blocks = []
    places = []
    for number, size in dict.fromkeys(zip(types.tolist(), sizes.tolist())):
        name = _VTK.get(number) or _VTK_SIZED.get((number, size)) or f"VTK type {number} of {size} nodes"
        name, order = _VTK_IN_RASTER_ORDER.get(number, (name, list(range(size))))
        of_type = np.flatnonzero((types == number) & (sizes == size))
        polygons = number == 7 and size > 4
        for part in [[0, i, i + 1] for i in range(1, size - 1)] if polygons else [order]:
            blocks.append(("triangle" if polygons else name, connectivity[starts[of_type, None] + np.asarray(part)]))
            places.append(of_type)
    return blocks, places


def of_vtk(points: Any, types: Any, sizes: Any, connectivity: Any, point_data: Mapping[str, Any],
           cell_data: Mapping[str, Any]) -> Mesh:
    """A mesh from VTK's arrays; each array of cell_data has one row a cell."""
    blocks, places = _of_vtk_cells(*(np.asarray(array, np.int64) for array in (types, sizes, connectivity)))
    return Mesh(in_space(points), blocks, split_contact(point_data),
                {name: [array[place] for place in places] for name, array in split_contact(cell_data).items()})


def of_meshio(mesh: Any) -> Mesh:
    """A meshio.Mesh."""
    blocks = [(str(block.type), np.asarray(block.data, np.int64)) for block in mesh.cells]
    per_block = [split_contact({name: arrays[i] for name, arrays in mesh.cell_data.items()}) for i in range(len(blocks))]
    return Mesh(in_space(mesh.points), blocks, split_contact(mesh.point_data),
                {name: [data[name] for data in per_block] for name in (per_block[0] if per_block else {})})


def of_pyvista(grid: Any) -> Mesh:
    """A pyvista.UnstructuredGrid or .PolyData; of the latter, its polygons, whose data follow those of points and lines."""
    is_grid = hasattr(grid, "celltypes")
    flat = np.asarray(grid.cells if is_grid else grid.faces, np.int64)  # each cell's number of nodes before the nodes
    starts = []
    place = 0
    while place < len(flat):
        starts.append(place)
        place += int(flat[place]) + 1
    sizes = flat[starts]
    types = grid.celltypes if is_grid else np.full(len(sizes), 7)
    first = 0 if is_grid else grid.n_verts + grid.n_lines
    return of_vtk(grid.points, types, sizes, np.delete(flat, starts), dict(grid.point_data),
                  {name: np.asarray(array)[first:first + len(sizes)] for name, array in dict(grid.cell_data).items()})


def of_columns(source: Any, name: str) -> Mesh:
    """A table: a dict of arrays, a pandas.DataFrame or another object with named columns."""
    keys = source.keys() if hasattr(source, "keys") else source.dtype.names
    columns = {str(key): np.atleast_1d(source[key]) for key in keys}
    if len({len(column) for column in columns.values()}) > 1:
        rows = ", ".join(f"{key} {len(column)}" for key, column in columns.items())
        raise InputError(f"{name}: its arrays have different numbers of rows: {rows}; allowed: the same number in each")
    return Mesh(point_data=columns)
