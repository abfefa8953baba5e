"""slipstick.meshes.read: the exact solution, written in every kind of file, is read back."""
import importlib.util
import shutil
import subprocess
import tempfile
import types
import unittest
from pathlib import Path

import numpy as np
from mesh_files import (COMPRESSORS, FRD_TYPES, FRICTION, LOAD, MESHES, PEAK, RADIUS, VTK_TYPES, calculix_blocks, frd, solids,
                        solution, vtu, write_exodus)
from scipy.spatial import ConvexHull
from slipstick import InputError
from slipstick.meshes.read import read
from slipstick.meshes.surface import nodal_areas
from slipstick.meshes.units import in_units_of

POINTS, CELLS = MESHES["polar"]
PRESSURE, TRACTION = solution(POINTS)
CENTRES = np.concatenate([POINTS[nodes].mean(axis=1) for _, nodes in CELLS])


def columns_of(names):
    """The exact solution at the nodes of the polar mesh, as a dict of columns with these names."""
    return dict(zip(names.split(), [*POINTS.T, PRESSURE, *TRACTION.T]))


class ReadTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

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
        rows = np.column_stack([POINTS / length, PRESSURE / stress, TRACTION / stress, *more])
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
        for header in ("x1 [mm] x2 pressure (N/mm^2) q1 q2", "x1 x2 [mm] pressure q1 q2 [MPa]"):  # one unit for a quantity
            self.assert_exact(read(self.table(header=header, separator=" ", length=1e-3, stress=1e6)))
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
        areas = nodal_areas([nodes for _, nodes in CELLS], POINTS)
        path = self.table(header="x1 [mm],x2 [mm],pressure [Pa],q1,q2,area", more=[areas * 1e6], length=1e-3)
        field = read(path)
        self.assertEqual(field.kind, "points")
        np.testing.assert_allclose(field.area, areas, rtol=1e-9)
        self.assertEqual(read(path, kind="faces").kind, "faces")

    def test_forces(self):
        areas = nodal_areas([nodes for _, nodes in CELLS], POINTS)
        forces = {"x1": POINTS[:, 0], "x2": POINTS[:, 1], "f1": TRACTION[:, 0] * areas, "f2": TRACTION[:, 1] * areas,
                  "fn": PRESSURE * areas}
        for table in (forces, {**forces, "area": areas}):
            field = read(table)
            self.assertEqual(field.kind, "forces")
            self.assert_exact(field)
        scaled = {name: column * (1e3 if name[0] == "x" else 1) for name, column in forces.items()}
        self.assert_exact(read(scaled, units="mm,N"))
        self.assert_exact(read(scaled, units="mm,MPa"))
        self.assert_exact(in_units_of(read(scaled, units="N"), RADIUS, LOAD))

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
        self.assert_exact(read({name.replace("p", "lam"): column for name, column in columns.items()}, names={"pressure": "lam"}))
        vectors = np.column_stack([columns["qx"], columns["qy"]])
        self.assert_exact(read({**columns, "qx": -columns["qx"], "mine": vectors}, names={"shear": "mine"}))
        self.assert_exact(read({**columns, "qx": -columns["qx"], "mine": vectors}, names={"q1": "mine:0", "q2": "mine:1"}))
        self.assert_refused('it has no column "mine:2"', {**columns, "mine": vectors}, names={"q1": "mine:2"})

    def test_planes_of_points_in_space(self):
        zero = 0 * PRESSURE
        table = {"x": POINTS[:, 1], "y": zero + 3.0, "z": POINTS[:, 0], "p": PRESSURE, "tx": TRACTION[:, 1], "ty": zero,
                 "tz": TRACTION[:, 0]}
        field = read(table)  # normal y: x1 = z, x2 = x
        self.assert_exact(field)
        self.assertIn("the contact's normal is y", " ".join(field.said))

    def test_choices(self):
        columns = columns_of("x y p q1 q2")
        upper = {**columns, "q1": -columns["q1"], "q2": -columns["q2"]}
        self.assert_exact(read(upper, body="upper"))
        negative = read({**columns, "p": -columns["p"]})
        self.assert_exact(negative)
        self.assertIn("the pressures are negative", " ".join(negative.said))
        moved = {**columns, "x": columns["x"] + 3.0}
        self.assert_exact(read(moved, centre=(3.0, 0.0)), 1e-5)
        absent = read({**columns, "p": np.where(columns["p"] > 0, columns["p"], np.nan)})
        self.assert_exact(absent)
        self.assertIn("out of contact", " ".join(absent.said))
        twice = read({name: np.concatenate([column, column[:5]]) for name, column in columns.items()})
        self.assertEqual(len(twice.points), len(columns["x"]))
        self.assert_refused('kind = "cells"; allowed: nodes, faces, points, forces', columns, kind="cells")
        self.assert_refused('axis = "w"; allowed: x, y, z', columns, axis="w")

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
        expected = read(self.file("m.vtu", vtu(POINTS, CELLS, self.point_data(POINTS), {})))
        for form in ("binary", "raw", "base64"):
            for compressor in (None, *COMPRESSORS):
                for header, pieces in (("<u4", 1), ("<u8", 1), ("<u4", 3)):
                    with self.subTest(form=form, compressor=compressor, header=header, pieces=pieces):
                        content = vtu(POINTS, CELLS, self.point_data(POINTS), {}, form, compressor, header, pieces)
                        field = read(self.file("m.vtu", content))
                        self.assert_exact(field)
                        if pieces == 1:
                            np.testing.assert_array_equal(field.pressure, expected.pressure)
                        self.assertEqual(sum(map(len, field.faces)), sum(map(len, expected.faces)))

    def test_cell_data(self):
        pressure, traction = solution(CENTRES)
        data = {"pressure": pressure, "shear": np.pad(traction, ((0, 0), (0, 1)))}
        field = read(self.file("m.vtu", vtu(POINTS, CELLS, self.point_data(POINTS), data)))
        self.assertEqual(field.kind, "faces")
        self.assert_exact(field)
        self.assertAlmostEqual(field.area.sum() / ConvexHull(POINTS).volume, 1, places=9)
        self.assertEqual(read(self.folder / "m.vtu", kind="nodes").kind, "nodes")
        field = read(self.file("p.vtu", vtu(POINTS, CELLS, self.point_data(POINTS), {"pressure": pressure})))
        self.assertEqual(field.kind, "nodes")  # without the shear of cells

    @unittest.skipUnless(shutil.which("ccx"), "CalculiX is not installed")
    def test_tangents_and_master_of_calculix(self):
        for slave in ("lower", "upper"):
            moments = []
            for axes in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):  # the same blocks with other axes
                self.file("blocks.inp", calculix_blocks(axes, slave))
                subprocess.run(["ccx", "blocks"], cwd=self.folder, check=True, capture_output=True)
                field = read(self.folder / "blocks.frd")
                forces = nodal_areas(field.faces, field.vertices)[:, None] * field.traction
                moments.append(float(np.sum(field.points[:, 0] * forces[:, 1] - field.points[:, 1] * forces[:, 0])))
                self.assertLess(np.abs(forces.sum(axis=0)).max(), 0.02 * moments[0])  # a twist about the axis moves no force
                np.testing.assert_allclose(moments, moments[0], rtol=1e-6)
            self.assertGreater(moments[0], 0)

    def test_faces_of_other_surfaces_are_left_out(self):
        points, cells = solids("hexahedron")
        pressure, traction = solution(points[:, :2])
        data = {"p": pressure * (points[:, 2] == 0), "q": traction * (points[:, 2] == 0)[:, None]}
        bottom, top = (cells[0][1][:, face] for face in ([0, 3, 2, 1], [4, 5, 6, 7]))
        both_and_repeated = [("quad", np.concatenate([bottom, top, top]))]
        field = read(self.file("m.vtu", vtu(points, both_and_repeated, data, {})))
        self.assert_exact(field)
        self.assertEqual([faces.shape for faces in field.faces], [(36, 4)])
        self.assertIn("36 faces lie on others", " ".join(field.said))

    def test_data_on_both_bodies(self):
        lower, [(name, below)] = solids("hexahedron")
        upper, [(_, above)] = solids("hexahedron", number=5, above=True)
        points, above = np.concatenate([lower, upper]), above + len(lower)
        pressure, traction = solution(points[:, :2])
        own = (points[:, 2] == 0) * np.where(np.arange(len(points)) < len(lower), 1, -1)  # each body's own traction
        data = {"p": pressure * (points[:, 2] == 0), "q": own[:, None] * traction}
        surfaces = [("quad", np.concatenate([below[:, [4, 5, 6, 7]], above[:, [0, 3, 2, 1]]]))]  # seen from outside
        for cells in ([(name, np.concatenate([below, above]))], surfaces):
            path = self.file("m.vtu", vtu(points, cells, data, {}))
            for body, number in (("lower", 36), ("upper", 25)):
                field = read(path, body=body)
                self.assert_exact(field)
                self.assertEqual(sum(map(len, field.faces)), number)
        unordered = [("quad", np.concatenate([below[:, [4, 5, 6, 7]], above[:, [0, 1, 2, 3]]]))]
        self.assert_refused("the load counts twice", self.file("u.vtu", vtu(points, unordered, data, {})))

    def contact_of(self, points, above=False):
        """CalculiX's contact values at nodes of solids, (n, 3), of the slave: the body above or below the plane z = 0. CSHEAR
        acts on the master, along t1 = x and t2 = n x t1 with the master's outward normal n."""
        pressure, traction = solution(points[:, :2])
        pressure, traction = pressure * (points[:, 2] == 0), traction * (points[:, 2] == 0)[:, None]
        sign = 1 if above else -1
        return {"COPEN": 0 * pressure, "CSLIP1": 0 * pressure, "CSLIP2": 0 * pressure, "CPRESS": pressure,
                "CSHEAR1": sign * traction[:, 0], "CSHEAR2": traction[:, 1]}

    def test_solids(self):
        for name in ("hexahedron", "hexahedron20", "hexahedron27", "tetra", "tetra10", "wedge", "wedge15", "pyramid"):
            for above in (False, True):
                with self.subTest(solid=name, above=above):
                    points, cells = solids(name, above=above)
                    contact = self.contact_of(points, above)
                    for path, relative in ((self.file("s.vtu", vtu(points, cells, contact, {})), 1e-6),
                                           (self.file("s.frd", frd(points, cells, contact) if name in FRD_TYPES else ""), 2e-5)):
                        if path.stat().st_size:
                            field = read(path)
                            self.assert_exact(field, relative)
                            area = nodal_areas(field.faces, field.vertices).sum()
                            self.assertAlmostEqual(area / (1.6 * RADIUS)**2, 1, places=4)
                    for faces in field.faces:  # counter-clockwise
                        first, second = (field.vertices[faces[:, i]] - field.vertices[faces[:, 0]] for i in (1, 2))
                        self.assertGreater((first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).min(), 0)

    @unittest.skipUnless(importlib.util.find_spec("meshio"), "meshio is not installed")
    def test_files_of_meshio(self):
        import meshio
        for name, (points, cells) in MESHES.items():
            pressure, traction = solution(points)
            data = {"contact_pressure": pressure, "tangent_traction": np.pad(traction, ((0, 0), (0, 1)))}
            mesh = meshio.Mesh(np.pad(points, ((0, 0), (0, 1))), cells, point_data=data)
            self.assert_exact(read(mesh))
            written = {"vtk": "vtk", "vtu": "vtu"}
            if len(cells) == 1:  # meshio's writer needs more data for other meshes
                written["msh"] = "gmsh"
            if importlib.util.find_spec("h5py"):
                written["xdmf"] = "xdmf"
                if name != "quad9":  # which meshio's writer lacks
                    written["med"] = "med"
            for ending, form in written.items():
                with self.subTest(mesh=name, file=ending):
                    mesh.write(self.folder / f"m.{ending}", file_format=form)
                    self.assert_exact(read(self.folder / f"m.{ending}"))

    @unittest.skipUnless(importlib.util.find_spec("meshio") and importlib.util.find_spec("h5py"), "no meshio or h5py")
    def test_last_step_of_a_series(self):
        import meshio
        with meshio.xdmf.TimeSeriesWriter(self.folder / "s.xdmf", data_format="XML") as series:
            series.write_points_cells(POINTS, CELLS)
            for time in (0.0, 1.0):
                series.write_data(time, point_data={key: time * array for key, array in self.point_data(POINTS).items()})
        self.assert_exact(read(self.folder / "s.xdmf"))

    @unittest.skipUnless(importlib.util.find_spec("netCDF4"), "netCDF4 is not installed")
    def test_last_step_of_exodus(self):
        centres = [POINTS[nodes].mean(axis=1) for _, nodes in CELLS]
        values = [np.column_stack(solution(at)) for at in (POINTS, *centres)]
        for form in ("NETCDF3_64BIT_OFFSET", "NETCDF4"):
            write_exodus(self.folder / "r.e", form, POINTS, CELLS, ("contact_pressure", "t1", "t2"), values)
            for kind in ("nodes", "faces"):
                field = read(self.folder / "r.e", kind=kind)
                self.assertEqual(len(field.points), len(POINTS) if kind == "nodes" else sum(map(len, centres)))
                self.assert_exact(field)

    def test_objects_of_pyvista(self):
        flat = np.concatenate([np.insert(nodes, 0, nodes.shape[1], axis=1).ravel() for _, nodes in CELLS])
        kinds = np.concatenate([np.full(len(nodes), VTK_TYPES[name]) for name, nodes in CELLS])
        at_cells = dict(zip(("pressure", "q1", "q2"), np.column_stack(solution(CENTRES)).T))
        common = {"points": np.pad(POINTS, ((0, 0), (0, 1))), "point_data": self.point_data(POINTS), "cell_data": at_cells}
        grid = types.SimpleNamespace(**common, cells=flat, celltypes=kinds)
        surface = types.SimpleNamespace(**common, faces=flat, n_verts=0, n_lines=0)
        for source in (grid, surface):
            for kind in ("nodes", "faces"):
                field = read(source, kind=kind)
                self.assertEqual(field.kind, kind)
                self.assert_exact(field)

        grid.points = grid.points[:50]
        self.assert_refused("do not belong together", grid)

    def test_vtk_collections(self):
        self.file("late.vtu", vtu(POINTS, CELLS, self.point_data(POINTS), {}))
        self.file("early.vtu", vtu(POINTS, CELLS, {key: 0 * array for key, array in self.point_data(POINTS).items()}, {}))
        head = '<?xml version="1.0"?><VTKFile type="{0}"><{0}>{1}</{0}></VTKFile>'
        steps = '<DataSet timestep="10" file="late.vtu"/><DataSet timestep="9" file="early.vtu"/>'
        self.assert_exact(read(self.file("all.pvd", head.format("Collection", steps))))
        self.assert_exact(read(self.file("all.pvtu", head.format("PUnstructuredGrid", '<Piece Source="late.vtu"/>'))))

    def test_polygons_of_vtp(self):
        angle = np.pi / 3 * np.arange(6)
        points = 0.9 * RADIUS * np.concatenate([[[0, 0]], np.stack([np.cos(angle), np.sin(angle)], axis=1)])
        one_face = [("polygon", np.arange(1, 7)[None])]
        field = read(self.file("m.vtu", vtu(points, one_face, self.point_data(points), {"p": np.ones(1), "q": np.ones((1, 2))})))
        self.assertEqual([faces.shape for faces in field.faces], [(4, 3)])
        self.assertAlmostEqual(field.area.sum() / (1.5 * np.sqrt(3) * (0.9 * RADIUS)**2), 1, places=12)
        points, cells = MESHES["polar"]
        text = vtu(points, cells, self.point_data(points), {}).replace(b"UnstructuredGrid", b"PolyData")
        self.assert_exact(read(self.file("m.vtp", text.replace(b"Cells>", b"Polys>"))))

    def test_planes_in_space(self):
        slope = np.array([[0.8, 0.0, -0.6], [0.0, 1.0, 0.0], [0.6, 0.0, 0.8]])  # x1, x2, x3 as rows: normal between x and z
        for frame, options in ((np.eye(3), {}), (np.eye(3)[[1, 2, 0]], {}), (np.eye(3)[[2, 0, 1]], {}), (slope, {}),
                               (np.diag([1.0, -1.0, -1.0]), {"axis": "-z"}), (slope, {"axis": "0.6,0,0.8"})):
            with self.subTest(frame=frame):
                data = {"pressure": PRESSURE, "shear": TRACTION @ frame[:2]}
                self.assert_exact(read(self.file("m.vtu", vtu(POINTS @ frame[:2], CELLS, data, {})), **options))
                data = {"contact_traction": TRACTION @ frame[:2] - PRESSURE[:, None] * frame[2]}  # on the lower body
                for sign in (1, -1):  # and on the upper one
                    data = {key: sign * array for key, array in data.items()}
                    self.assert_exact(read(self.file("m.vtu", vtu(POINTS @ frame[:2], CELLS, data, {})), **options))

    def test_refusals_of_meshes(self):
        data = self.point_data(POINTS)

        def written(where=POINTS, **arrays):
            return self.file("m.vtu", vtu(where, CELLS, arrays, {}))
        self.assert_refused("no array is named like a pressure; it has the point arrays 'stress'", written(stress=data["CPRESS"]))
        self.assert_refused('it has no point array "p0"', written(**data), names={"pressure": "p0"})
        self.assert_refused('names: "pres"; allowed: x1', written(**data), names={"pres": "CPRESS"})
        bowl = np.column_stack([POINTS, 0.5 * (POINTS**2).sum(axis=1) / RADIUS])
        self.assert_refused("the contact's surface is curved", written(bowl, **data))
        raw = vtu(POINTS, CELLS, data, {}, "raw", "vtkZLibDataCompressor")
        start = raw.index(b'raw">_')
        self.assert_refused("it is damaged", self.file("d.vtu", raw[:start + 50] + raw[start + 90:]))
        self.assert_refused("it is no whole XML file", self.file("cut.vtu", written(**data).read_bytes()[:-50]))


if __name__ == "__main__":
    unittest.main()
