"""slipstick.meshes.read: the exact solution, written in every kind of file, is read back."""
import base64
import importlib.util
import lzma
import tempfile
import types
import unittest
import zlib
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull, Delaunay
from slipstick import InputError, exact
from slipstick.meshes.read import read
from slipstick.meshes.surface import nodal_areas
from slipstick.meshes.units import in_units_of

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


def columns_of(names):
    """The exact solution at the nodes of the polar mesh, as a dict of columns with these names."""
    points, _ = polar()
    pressure, traction = solution(points)
    return dict(zip(names.split(), [*points.T, pressure, *traction.T]))


class ReadTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def file(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def assert_exact(self, field, relative=1e-6):
        """The field's rows have the exact solution at their points."""
        pressure, traction = solution(field.points)
        self.assertGreater((field.pressure > 0).sum(), 10)
        np.testing.assert_allclose(field.pressure, pressure, rtol=0, atol=relative * PEAK)
        np.testing.assert_allclose(field.traction, traction, rtol=0, atol=relative * PEAK * FRICTION)

    def assert_refused(self, words, source, **options):
        with self.assertRaises(InputError) as caught:
            read(source, **options)
        self.assertIn(words, str(caught.exception))


class TableTest(ReadTest):
    def table(self, name="nodes.csv", header="x1,x2,pressure,q1,q2", separator=",", more=(), length=1.0, stress=1.0):
        points, _ = polar()
        pressure, traction = solution(points)
        rows = np.column_stack([points / length, pressure / stress, traction / stress, *more])
        lines = [separator.join(f"{value:.12e}" for value in row) for row in rows]
        return self.file(name, "\n".join([header, *lines]) + "\n")

    def test_separators_and_headers(self):
        for separator, header in ((",", "x1,x2,pressure,q1,q2"), (";", '"X";"Y";"CPRESS";"CSHEAR1";"CSHEAR2"'),
                                  ("\t", "x\ty\tp\tqx\tqy"), ("  ", "# written today\n# x y contact_pressure t1 t2"),
                                  (",", "% x, y, Contact Pressure, tau_1, tau_2")):
            with self.subTest(header=header):
                field = read(self.table(header=header, separator=separator))
                self.assertEqual(field.kind, "nodes")
                self.assert_exact(field)

    def test_decimal_commas(self):
        text = self.table(separator=";", header="x1;x2;pressure;q1;q2").read_text()
        self.assert_exact(read(self.file("comma.csv", text.replace(".", ","))))

    def test_units(self):
        self.assert_exact(read(self.table(header="x1 [mm],x2 [mm],pressure [MPa],q1 [MPa],q2 [MPa]", length=1e-3, stress=1e6)))
        self.assert_exact(read(self.table(header="x1 [mm] x2 pressure (N/mm^2) q1 q2", separator=" ", length=1e-3, stress=1e6)))
        bare = self.table(length=1e-3, stress=1e6)
        self.assert_exact(read(bare, units="mm,MPa"))
        fitted = in_units_of(read(bare), RADIUS, LOAD)
        self.assert_exact(fitted)
        self.assertIn("length in mm", " ".join(fitted.said))
        self.assert_exact(in_units_of(read(self.table(length=1e-6, stress=1e9)), RADIUS, LOAD))
        self.assertEqual(in_units_of(fitted, 1.0, 1.0).said, fitted.said)
        self.assert_refused('units: "furlong"; allowed', bare, units="furlong")
        self.assert_refused('column x1: unit "acre"; allowed', self.table(header="x1 [acre],x2,pressure,q1,q2"))

    def test_rows_with_areas_are_points(self):
        points, cells = polar()
        areas = nodal_areas([nodes for _, nodes in cells], points)
        path = self.table(header="x1 [mm],x2 [mm],pressure [Pa],q1,q2,area", more=[areas * 1e6], length=1e-3)
        field = read(path)
        self.assertEqual(field.kind, "points")
        np.testing.assert_allclose(field.area, areas, rtol=1e-9)
        self.assertEqual(read(path, kind="faces").kind, "faces")

    def test_forces(self):
        points, cells = unstructured()
        pressure, traction = solution(points)
        areas = nodal_areas([nodes for _, nodes in cells], points)
        forces = {"x1": points[:, 0], "x2": points[:, 1], "f1": traction[:, 0] * areas, "f2": traction[:, 1] * areas,
                  "fn": pressure * areas}
        for table in (forces, {**forces, "area": areas}):
            field = read(table)
            self.assertEqual(field.kind, "forces")
            self.assert_exact(field)
        scaled = {name: column * (1e3 if name[0] == "x" else 1) for name, column in forces.items()}
        self.assert_exact(read(scaled, units="mm,N"))
        self.assert_exact(read(scaled, units="mm,MPa"))

    def test_radial_tables(self):
        radii = np.linspace(0, 1.2 * RADIUS, 25)
        pressure, traction = solution(np.stack([radii, 0 * radii], axis=1))
        field = read({"r": radii, "pressure": pressure, "q_theta": traction[:, 1], "q_r": traction[:, 0]})
        self.assertEqual((field.kind, [faces.shape[1] for faces in field.faces]), ("nodes", [3, 4]))
        self.assert_exact(field)
        rows = radii > 0  # a table of means over rings has no row at the axis
        field = read({"r": radii[rows], "pressure": pressure[rows], "q_theta": traction[rows, 1]})
        self.assert_exact(field, 1e-4)

    def test_other_objects(self):
        columns = columns_of("x y p qx qy")
        self.assert_exact(read(columns))
        np.savez(self.folder / "arrays.npz", **columns)
        self.assert_exact(read(self.folder / "arrays.npz"))
        self.assert_exact(read(np.rec.fromarrays(list(columns.values()), names=list(columns))))
        self.assert_exact(read({name.replace("p", "lam"): column for name, column in columns.items()}, names="pressure=lam"))

    def test_planes_of_points_in_space(self):
        points, _ = polar()
        pressure, traction = solution(points)
        zero = 0 * pressure
        table = {"x": points[:, 1], "y": zero + 3.0, "z": points[:, 0], "p": pressure, "tx": traction[:, 1], "ty": zero,
                 "tz": traction[:, 0]}
        field = read(table)  # normal y: x1 = z, x2 = x
        self.assert_exact(field)
        self.assertIn("the contact's normal is y", " ".join(field.said))

    def test_choices(self):
        columns = columns_of("x y p q1 q2")
        upper = {**columns, "q1": -columns["q1"], "q2": -columns["q2"]}
        self.assert_exact(read(upper, body="upper"))
        negative = read({**columns, "p": -columns["p"]})
        self.assert_exact(negative)
        self.assertIn("all pressures are negative", " ".join(negative.said))
        moved = {**columns, "x": columns["x"] + 3.0}
        self.assert_exact(read(moved, centre=(3.0, 0.0)), 1e-5)
        absent = read({**columns, "p": np.where(columns["p"] > 0, columns["p"], np.nan)})
        self.assert_exact(absent)
        self.assertIn("out of contact", " ".join(absent.said))
        twice = read({name: np.concatenate([column, column[:5]]) for name, column in columns.items()})
        self.assertEqual(len(twice.points), len(columns["x"]))
        self.assert_refused('kind = "cells"; allowed: nodes, faces, points, forces', columns, kind="cells")

    def test_refusals(self):
        self.assert_refused("there is no such file", self.folder / "none.csv")
        self.assert_refused("unknown extension; allowed: .csv", self.file("result.odb", "x"))
        self.assert_refused("it has the columns 'x1', 'x2', 'depth'; allowed: x1,x2,pressure",
                            self.file("a.csv", "x1,x2,depth\n1,2,3\n"))
        header = "x1,x2,pressure,q1,q2\n0,0,1,0,0\n"
        self.assert_refused("the first row has numbers", self.file("b.csv", "1,2,3\n4,5,6\n"))
        self.assert_refused("c.csv:3: it has 4 fields; allowed: 5", self.file("c.csv", header + "1,0,1,0\n"))
        self.assert_refused('row 2, column pressure: "slip"', self.file("d.csv", header + "1,0,slip,0,0\n"))
        self.assert_refused("row 2: the shear is", self.file("e.csv", header + "1,0,1,nan,0\n"))
        self.assert_refused("rows 1 and 3 are at one place", self.file("f.csv", header + "1,0,1,0,0\n0,0,2,0,0\n"))
        self.assert_refused("it has no shear", self.file("g.csv", "x1,x2,pressure\n0,0,1\n1,0,1\n"))
        self.assert_refused("the pressure is zero everywhere", self.file("h.csv", "x1,x2,pressure,q1,q2\n0,0,0,0,0\n1,0,0,0,0\n"))
        self.assert_refused("it has no rows", self.file("i.csv", "# nothing\n"))
        self.assert_refused("it is no text", self.file("j.csv", b"\0\1\2"))


def vtu(points, cells, point_data, cell_data, form="ascii", compressor=None, header="<u4", pieces=1):
    """The text of a .vtu file. form: ascii, binary (inline), raw or base64 (appended)."""
    numbers = {"triangle": 5, "quad": 9, "triangle6": 22, "quad8": 23, "quad9": 28}
    blob, squeeze = bytearray(), {"vtkZLibDataCompressor": zlib.compress, "vtkLZMADataCompressor": lzma.compress}.get(compressor)

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
    all_cells = [(numbers[name], row) for name, rows in cells for row in rows]
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


class MeshTest(ReadTest):
    def point_data(self, points):
        pressure, traction = solution(points)
        return {"CPRESS": pressure, "CSHEAR1": traction[:, 0], "CSHEAR2": traction[:, 1]}

    def test_vtu_of_every_mesh(self):
        for name, (points, cells) in MESHES.items():
            with self.subTest(mesh=name):
                field = read(self.file("m.vtu", vtu(points, cells, self.point_data(points), {})))
                self.assertEqual(field.kind, "nodes")
                self.assert_exact(field)
                self.assertAlmostEqual(nodal_areas(field.faces, field.vertices).sum() / ConvexHull(points).volume, 1, places=9)

    def test_vtu_encodings(self):
        points, cells = MESHES["polar"]
        expected = read(self.file("m.vtu", vtu(points, cells, self.point_data(points), {})))
        for form in ("binary", "raw", "base64"):
            for compressor in (None, "vtkZLibDataCompressor", "vtkLZMADataCompressor"):
                for header, pieces in (("<u4", 1), ("<u8", 1), ("<u4", 3)):
                    with self.subTest(form=form, compressor=compressor, header=header, pieces=pieces):
                        content = vtu(points, cells, self.point_data(points), {}, form, compressor, header, pieces)
                        field = read(self.file("m.vtu", content))
                        self.assert_exact(field)
                        if pieces == 1:
                            np.testing.assert_array_equal(field.pressure, expected.pressure)
                        self.assertEqual(sum(map(len, field.faces)), sum(map(len, expected.faces)))

    def test_cell_data(self):
        points, cells = MESHES["polar"]
        centres = np.concatenate([points[nodes].mean(axis=1) for _, nodes in cells])
        pressure, traction = solution(centres)
        data = {"pressure": pressure, "shear": np.pad(traction, ((0, 0), (0, 1)))}
        field = read(self.file("m.vtu", vtu(points, cells, self.point_data(points), data)))
        self.assertEqual(field.kind, "faces")
        self.assert_exact(field)
        self.assertAlmostEqual(field.area.sum() / ConvexHull(points).volume, 1, places=9)
        self.assertEqual(read(self.folder / "m.vtu", kind="nodes").kind, "nodes")


if __name__ == "__main__":
    unittest.main()
