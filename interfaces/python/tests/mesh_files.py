"""Meshes with the exact solution of a Hertz contact in torsion, and writers of files for them, for the tests of readers."""
import base64
import functools
import importlib.util
import lzma
import zlib

import numpy as np
from scipy.spatial import Delaunay
from slipstick import exact

RADIUS, PEAK, FRICTION = 0.489e-3, 1.996e9, 0.1  # m, Pa
LOAD = 2 / 3 * np.pi * RADIUS**2 * PEAK


def solution(points):
    """Pressure (n) and traction (n, 2) on the lower body at points (n, 2) in m, for a moment of 0.9 times its limit."""
    radius = np.linalg.norm(points, axis=1)
    inside = np.minimum(radius / RADIUS, 1.0)
    around = FRICTION * PEAK * exact.traction(inside, 0.9) * (radius < RADIUS)
    turned = np.stack([-points[:, 1], points[:, 0]], axis=1) / np.maximum(radius, 1e-300)[:, None]
    return PEAK * exact.pressure(inside) * (radius < RADIUS), around[:, None] * turned


def polar(rings=8, angles=24, growth=1.0):
    """Nodes (n, 2), triangles and quadrilaterals out to 1.2 contact radii."""
    radii = 1.2 * RADIUS * np.linspace(0, 1, rings + 1)[1:]**growth
    angle = 2 * np.pi * np.arange(angles) / angles
    rings_of_points = radii[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.concatenate([np.zeros((1, 2)), rings_of_points.reshape(-1, 2)])
    place = 1 + np.arange(rings * angles).reshape(rings, angles)
    after = np.roll(place, -1, axis=1)
    triangles = np.stack([np.zeros(angles, int), place[0], after[0]], axis=1)
    quads = np.stack([place[:-1], place[1:], after[1:], after[:-1]], axis=-1).reshape(-1, 4)
    return points, [("triangle", triangles), ("quad", quads)]


def unstructured():
    """Nodes at random places and their triangulation."""
    points = 1.1 * RADIUS * np.random.default_rng(5).uniform(-1, 1, (200, 2))
    return points, [("triangle", Delaunay(points).simplices)]


def quadratic(name, number=6):
    """A square of quad8, quad9 or triangle6 elements."""
    grid = np.stack(np.meshgrid(*[RADIUS * np.linspace(-1.1, 1.1, 2 * number + 1)] * 2, indexing="ij"), axis=-1)
    place = np.arange((2 * number + 1)**2).reshape(2 * number + 1, -1)
    i, j = (2 * k.ravel() for k in np.meshgrid(np.arange(number), np.arange(number), indexing="ij"))

    def nodes(*offsets):
        return np.stack([place[i + a, j + b] for a, b in offsets], axis=1)
    corners, middles = [(0, 0), (2, 0), (2, 2), (0, 2)], [(1, 0), (2, 1), (1, 2), (0, 1)]
    if name == "triangle6":
        cells = np.concatenate([nodes((0, 0), (2, 0), (2, 2), (1, 0), (2, 1), (1, 1)),
                                nodes((0, 0), (2, 2), (0, 2), (1, 1), (1, 2), (0, 1))])
    else:
        cells = nodes(*corners, *middles, *([(1, 1)] if name == "quad9" else []))
    return grid.reshape(-1, 2), [(name, cells)]


MESHES = {"polar": polar(), "graded": polar(growth=0.6), "unstructured": unstructured(),
          **{name: quadratic(name) for name in ("triangle6", "quad8", "quad9")}}


COMPRESSORS = {"vtkZLibDataCompressor": zlib.compress, "vtkLZMADataCompressor": lzma.compress}
if importlib.util.find_spec("lz4"):
    import lz4.block
    COMPRESSORS["vtkLZ4DataCompressor"] = functools.partial(lz4.block.compress, store_size=False)

VTK_TYPES = {"triangle": 5, "quad": 9, "triangle6": 22, "quad8": 23, "quad9": 28, "tetra": 10, "tetra10": 24, "hexahedron": 12,
             "hexahedron20": 25, "hexahedron27": 29, "wedge": 13, "wedge15": 26, "pyramid": 14, "polygon": 7}
FRD_TYPES = {"hexahedron": 1, "wedge": 2, "tetra": 3, "hexahedron20": 4, "wedge15": 5, "tetra10": 6}
_EDGES = {4: [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
          6: [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
          8: [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]}


def solids(name, number=6, above=False):
    """A layer of solids below (or above) the plane z = 0, of one type, with the contact on that plane: nodes (n, 3) and cells."""
    size, height = RADIUS * 0.8, RADIUS * (0.4 if above else -0.4)
    place = np.arange((2 * number + 1)**2 * 3).reshape(2 * number + 1, 2 * number + 1, 3)
    axes = [np.linspace(-size, size, 2 * number + 1)] * 2 + [np.sort([height, height / 2, 0])]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    i, j = (2 * k.ravel() for k in np.meshgrid(np.arange(number), np.arange(number), indexing="ij"))
    corners = np.array([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)])
    split = {"hexahedron": [range(8)], "wedge": [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)],
             "tetra": [(0, 1, 2, 6), (0, 5, 1, 6), (0, 4, 5, 6), (0, 7, 4, 6), (0, 3, 7, 6), (0, 2, 3, 6)],
             "pyramid": [(0, 1, 2, 3, 4), (1, 5, 6, 2, 4), (2, 6, 7, 3, 4)]}[name.rstrip("01257")]
    cells = []
    for part in split:
        offsets = [corners[c] for c in part]
        if name[-1].isdigit():
            offsets += [(offsets[a] + offsets[b]) // 2 for a, b in _EDGES[len(part)]]
        if name == "hexahedron27":  # the faces' centres and the solid's
            offsets += [np.array(at) for at in ((0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1), (1, 1, 0), (1, 1, 2), (1, 1, 1))]
        cells.append(np.stack([place[i + a, j + b, c] for a, b, c in offsets], axis=1))
    return points, [(name, np.concatenate(cells))]


def frd(points, cells, contact):
    """The text of a .frd file with two steps: no contact in the first, `contact` (arrays by component) in the second."""
    order = {"hexahedron20": [*range(12), *range(16, 20), *range(12, 16)], "wedge15": [*range(9), *range(12, 15), *range(9, 12)]}
    lines = ["    1C", f"    2C{len(points):30d}{1:38d}"]
    lines += [f" -1{i + 5:10d}" + "".join(f"{x:12.5E}" for x in point) for i, point in enumerate(points)]
    lines += [" -3", f"    3C{sum(len(nodes) for _, nodes in cells):30d}{1:38d}"]
    for name, rows in cells:
        for number, row in enumerate(rows, 1):
            lines.append(f" -1{number:10d}{FRD_TYPES[name]:5d}{0:5d}{1:5d}")
            written = row[order.get(name, slice(None))] + 5
            lines += [" -2" + "".join(f"{node:10d}" for node in written[k:k + 10]) for k in range(0, len(written), 10)]
    lines.append(" -3")
    for step in (1, 2):
        lines += [f"    1PSTEP{step:26d}", f"  100CL  10{step}{step:12.9f}{len(points):12d}{0:21d}{step:5d}{1:12d}"]
        lines += [" -4  CONTACT     6    1", *(f" -5  {name:8s}    1    4    1    1" for name in contact)]
        for number, row in enumerate(zip(*contact.values()), 5):
            lines.append(f" -1{number:10d}" + "".join(f"{x * (step - 1):12.5E}" for x in row))
        lines.append(" -3")
    return "\n".join([*lines, " 9999", ""])


def vtu(points, cells, point_data, cell_data, form="ascii", compressor=None, header="<u4", pieces=1):
    """The text of a .vtu file. form: ascii, binary (inline), raw or base64 (appended)."""
    blob, squeeze = bytearray(), COMPRESSORS.get(compressor)

    def packed(data):
        if squeeze is None:
            return [np.array(len(data), header).tobytes() + data]
        parts = [data[i:i + 1000] for i in range(0, len(data), 1000)]
        small = [squeeze(part) for part in parts]
        last = len(parts[-1]) if parts and len(parts[-1]) < 1000 else 0
        return [np.array([len(parts), 1000, last, *map(len, small)], header).tobytes(), b"".join(small)]

    def array(name, values, columns=1):
        values = np.asarray(values)
        kind = {"f": "Float64", "i": "Int64"}[values.dtype.kind]
        tag = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{columns}"'
        if form == "ascii":
            return f'{tag} format="ascii">{" ".join(map(repr, values.ravel().tolist()))}</DataArray>'
        chunks = packed(values.tobytes())
        if form == "binary":
            return f'{tag} format="binary">\n{"".join(base64.b64encode(chunk).decode() for chunk in chunks)}\n</DataArray>'
        start = len(blob)
        blob.extend(b"".join(chunks) if form == "raw" else b"".join(map(base64.b64encode, chunks)))
        return f'{tag} format="appended" offset="{start}"/>'

    text = ['<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
            f'header_type="{"UInt64" if header == "<u8" else "UInt32"}"', f'compressor="{compressor}">' if compressor else ">",
            "<UnstructuredGrid>"]
    all_cells = [(VTK_TYPES[name], row) for name, rows in cells for row in rows]
    for part in np.array_split(np.arange(len(all_cells)), pieces):
        rows = [all_cells[i] for i in part]
        nodes, local = np.unique(np.concatenate([row for _, row in rows]), return_inverse=True)
        text += [f'<Piece NumberOfPoints="{len(nodes)}" NumberOfCells="{len(rows)}"><Points>',
                 array("Points", np.pad(points[nodes], ((0, 0), (0, 3 - points.shape[1]))), 3), "</Points><Cells>",
                 array("connectivity", local.reshape(-1)), array("offsets", np.cumsum([len(row) for _, row in rows])),
                 array("types", np.array([number for number, _ in rows])), "</Cells><PointData>",
                 *(array(name, values[nodes], values[0].size) for name, values in point_data.items()), "</PointData><CellData>",
                 *(array(name, values[part], values[0].size) for name, values in cell_data.items()), "</CellData></Piece>"]
    text.append("</UnstructuredGrid>")
    end = [f'<AppendedData encoding="{form}">_'.encode(), bytes(blob), b"</AppendedData>"] if form in ("raw", "base64") else []
    return b"\n".join([*(line.encode() for line in text)]) + b"".join(end) + b"</VTKFile>"


def write_exodus(path, form, points, cells, names, values):
    """An Exodus file of triangles and quadrilaterals with two steps: zeros, then values of nodes and of each block's cells."""
    import netCDF4
    with netCDF4.Dataset(path, "w", format=form) as file:
        sizes = {"time_step": None, "len_name": 33, "num_nodes": len(points), "num_el_blk": len(cells), "names": len(names)}
        for name, size in sizes.items():
            file.createDimension(name, size)
        for axis, column in zip("xy", points.T):
            file.createVariable(f"coord{axis}", "f8", ("num_nodes",))[:] = column
        file.createVariable("time_whole", "f8", ("time_step",))[:] = [0.0, 1.0]
        for role in ("nod", "elem"):
            words = np.array([list(name.ljust(33, "\0")) for name in names], "S1")
            file.createVariable(f"name_{role}_var", "S1", ("names", "len_name"))[:] = words
        for block, (kind, nodes) in enumerate(cells, 1):
            file.createDimension(f"el{block}", len(nodes))
            file.createDimension(f"nod{block}", nodes.shape[1])
            connect = file.createVariable(f"connect{block}", "i4", (f"el{block}", f"nod{block}"))
            connect.elem_type, connect[:] = {"triangle": "TRI3", "quad": "QUAD4"}[kind], nodes + 1
        for i in range(len(names)):
            at = [("nod_var", "", "num_nodes"), *(("elem_var", f"eb{block}", f"el{block}") for block in range(1, len(cells) + 1))]
            for (role, suffix, dimension), array in zip(at, values):
                variable = file.createVariable(f"vals_{role}{i + 1}{suffix}", "f8", ("time_step", dimension))
                variable[:] = [0 * array[:, i], array[:, i]]


def calculix_blocks(axes, slave, number=4):
    """The input of CalculiX for a block pressed on a larger one, and then twisted by a positive moment. axes: the file's axes of
    x1, x2 and x3; slave: the body, "lower" or "upper"."""
    lines = ["*MATERIAL, NAME=STEEL", "*ELASTIC", "210000, 0.3"]
    held = {}
    for body, size, heights, first in (("lower", 1.5, (-1, 0), 1), ("upper", 1.0, (0, 1), 1001)):
        line = np.linspace(-size, size, number + 1)
        place = first + np.arange(2 * (number + 1)**2).reshape(2, number + 1, number + 1)
        lines.append("*NODE, NSET=ALL")
        for (k, j, i), node in np.ndenumerate(place):
            at = np.empty(3)
            at[list(axes)] = line[i], line[j], heights[k]
            lines.append(f"{node}, {at[0]:.9g}, {at[1]:.9g}, {at[2]:.9g}")
        held[body] = [(place[k, j, i], line[i], line[j]) for (k, j, i), _ in np.ndenumerate(place) if k == (body == "upper")]
        lines.append(f"*ELEMENT, TYPE=C3D8, ELSET={body}")
        for j, i in np.ndindex(number, number):
            corners = [place[k, j + b, i + a] for k in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            lines.append(", ".join(map(str, [first + i + number * j, *corners])))
        lines += [f"*SURFACE, NAME=S{body}", f"{body}, {'S2' if body == 'lower' else 'S1'}",
                  f"*SOLID SECTION, ELSET={body}, MATERIAL=STEEL"]
    lines += ["*SURFACE INTERACTION, NAME=I", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "1e7", "*FRICTION", "0.5, 1e7",
              "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE", f"S{slave}, S{'upper' if slave == 'lower' else 'lower'}",
              "*BOUNDARY", *(f"{node}, 1, 3" for node, _, _ in held["lower"])]
    for twist in (0, 2e-4):
        lines += ["*STEP", "*STATIC", "1, 1", "*BOUNDARY"]
        for node, x1, x2 in held["upper"]:
            for axis, motion in zip(axes, (-twist * x2, twist * x1, -1e-3)):
                lines.append(f"{node}, {axis + 1}, {axis + 1}, {motion:.6g}")
        lines += ["*CONTACT FILE", "CDIS, CSTR", "*END STEP"]
    return "\n".join([*lines, ""])
