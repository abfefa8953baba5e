"""dataset_test.py PROGRAM [FCLIB_SOLVE]: makes a part of the reference data set twice, and reads it as its users do."""

import csv
import hashlib
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

SOURCE = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(SOURCE), str(SOURCE / "readers")]
import assemble_fclib  # noqa: E402
import dataset  # noqa: E402
import fclib  # noqa: E402
import fields  # noqa: E402
import second  # noqa: E402
import stresses  # noqa: E402
import tables  # noqa: E402
from slipstick import conformance, exact  # noqa: E402

PROGRAM, *SOLVER = [str(Path(word).resolve()) for word in sys.argv[1:]]
READERS = {"Python": [["python3", "read.py"]], "C++": [["c++", "-std=c++17", "read.cpp", "-o", "reader"], ["./reader"]],
           "Octave": [["octave", "-qf", "read.m"]], "Fortran": [["gfortran", "read.f90", "-o", "reader"], ["./reader"]],
           "Julia": [["julia", "read.jl"]]}


class Small(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="slipstick-dataset-test-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        builds = [subprocess.Popen([sys.executable, "-B", SOURCE / "dataset.py", PROGRAM, cls.folder / name, "--small", "--workers", "1"],
                                   env={**os.environ, "TMPDIR": str(cls.folder)}) for name in ("one", "other")]
        assert [build.wait() for build in builds] == [0, 0]
        cls.root = cls.folder / "one" / dataset.NAME

    def table(self, name):
        with open(self.root / f"tables/{name}.csv", newline="") as file:
            return list(csv.DictReader(file))

    def values(self, name, case, quantity):
        return [float(row["value"]) for row in self.table(name) if (row["case"], row["quantity"]) == (case, quantity)]

    def test_two_builds_have_equal_bytes(self):
        one, other = ((self.folder / name / f"{dataset.NAME}.zip").read_bytes() for name in ("one", "other"))
        self.assertEqual(hashlib.sha256(one).hexdigest(), hashlib.sha256(other).hexdigest())

    def test_checksums_and_crate_name_every_file(self):
        sums = dict(line.split()[::-1] for line in (self.root / "SHA256SUMS").read_text().splitlines())
        files = {file.relative_to(self.root).as_posix() for file in self.root.rglob("*") if file.is_file()}
        self.assertEqual(set(sums), files - {"SHA256SUMS"})
        for name, digest in sums.items():
            self.assertEqual(hashlib.sha256((self.root / name).read_bytes()).hexdigest(), digest, name)
        crate = json.loads((self.root / "ro-crate-metadata.json").read_text())
        self.assertEqual({part["@id"] for part in crate["@graph"][1]["hasPart"]}, files - {"SHA256SUMS", "ro-crate-metadata.json"})

    def test_json_follows_the_schema_and_equals_the_csv(self):
        try:
            from jsonschema import Draft202012Validator
        except ImportError:
            self.skipTest("python3-jsonschema is not installed")
        schema = Draft202012Validator(json.loads((self.root / "table.schema.json").read_text()))
        for file in sorted((self.root / "tables").glob("*.json")):
            found = json.loads(file.read_text())
            schema.validate(found)
            with open(file.with_suffix(".csv"), newline="") as text:
                for row, other in zip(found["rows"], csv.reader(text.read().splitlines()[1:]), strict=True):
                    numbers = [i for i, name in enumerate(tables.COLUMNS) if name in dataset.NUMBERS and other[i]]
                    self.assertEqual([row[i] for i in numbers], [float(other[i]) for i in numbers], file.name)

    def test_readme_names_every_table_and_no_mark_is_left(self):
        text = (self.root / "README.md").read_text()
        for file in (self.root / "tables").glob("*.csv"):
            self.assertIn(f"`{file.stem}`", text)
        for file in self.root.glob("*.*"):
            self.assertNotRegex(file.read_text(), "@[A-Z]+@")

    def test_values_known_in_closed_form(self):
        for case, limit in (("hertz", 3 * math.pi / 16), ("cone", math.pi / 6), ("flat_punch", math.pi / 4), ("constant", 2 / 3)):
            self.assertAlmostEqual(self.values("constants", case, "moment_limit")[0], limit, delta=1e-15)
        self.assertAlmostEqual(self.values("constants", "flat_punch", "full_stick")[0], 8 / (3 * math.pi), delta=1e-15)
        hertz = [row for row in self.table("torsion") if (row["case"], row["quantity"]) == ("hertz", "stick_complement")]
        at = float(hertz[0]["at"])  # M/M_lim -> 32 (1 - c)/(3 pi)
        self.assertEqual((hertz[0]["given"], at), ("moment_ratio", 1e-7))
        self.assertAlmostEqual(float(hertz[0]["value"]) * 32 / (3 * math.pi) / at, 1, delta=1e-6)

    def test_cases_for_simulators_pass_with_their_own_responses(self):
        listed = json.loads((self.root / "cases/cases.json").read_text())["cases"]
        for entry, case in zip(listed, conformance.cases(), strict=True):
            with open(self.root / "cases" / entry["file"], newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertTrue(conformance.judge(case, {name: [float(row[name]) for row in rows] for name in entry["responses"]}).passed)

    def test_a_wrong_value_is_found(self):
        for wrong in (1 + 1e-12, math.nan):
            table = tables.Table("torsion", "", "", "", [tables.row(
                "hertz", "moment_ratio", 0.5, "twist", 0.5, 1e-15, "1", "stated", "mpmath", 0.5 * wrong, 1e-20)])
            self.assertEqual(len(dataset.disagreements(table)), 1)
        table.rows = [tables.row("hertz", "moment_ratio", 0.5, "twist", 0.5, 1e-15, "1", "stated", "mpmath", 0.5, 1e-20)]
        self.assertEqual(dataset.disagreements(table), [])

    def test_stresses_below_the_sphere(self):
        """Values at M/M_lim = 0.9 that were computed apart from this code."""
        c = second.mpf("0.49589505221577806827")
        for place, shear in ((("0.8", "0.1"), (0.427151030273768, -0.418178612053512)),
                             (("1.2", "0.2"), (0.0565132462292529, -0.175180470713968))):
            found = stresses.superposed("hertz", c, *map(second.mpf, place))
            np.testing.assert_allclose(np.array(found, dtype=float), shear, rtol=1e-13)

    def test_superpositions_of_discs_and_of_punches_agree(self):
        c, lacks = second.mpf("0.375"), second.mpf("0.625")
        for profile in ("cone", "power:1.5", "power:3", "power:4"):
            punches = second.height_of(profile, np.array([0.375]), np.array([0.625]))[0]
            self.assertAlmostEqual(float(second.BOUNDS[profile].height(c, lacks)), punches, delta=1e-13)
        sphere = second.mp.ellipk(1 - c * c) - second.mp.ellipe(1 - c * c)
        self.assertAlmostEqual(float(second.BOUNDS["hertz"].height(c, lacks)), float(sphere), delta=1e-15)

    def test_readers(self):
        for language, commands in READERS.items():
            with self.subTest(language=language):
                if not shutil.which(commands[0][0]):
                    self.skipTest(f"{commands[0][0]} is not installed")
                for command in commands:
                    run = subprocess.run(command, cwd=self.root / "readers", capture_output=True, text=True)
                    self.assertEqual(run.returncode, 0, (language, run.stdout, run.stderr))
                self.assertRegex(run.stdout, "3 twists")

    def test_readers_refuse_a_wrong_table(self):
        wrong = self.folder / "wrong"
        shutil.copytree(self.root / "readers", wrong / "readers")
        (wrong / "tables").mkdir()
        lines = (self.root / "tables/torsion.csv").read_text().splitlines()
        for i, line in enumerate(lines):
            words = line.split(",")
            if (words[0], words[4]) == ("constant", "twist"):
                words[5] = repr(float(words[5]) * (1 + 1e-9))
            lines[i] = ",".join(words)
        (wrong / "tables/torsion.csv").write_text("\n".join(lines) + "\n")
        for language, commands in READERS.items():
            if shutil.which(commands[0][0]):
                codes = [subprocess.run(command, cwd=wrong / "readers", capture_output=True).returncode for command in commands]
                self.assertEqual((codes[:-1], codes[-1]), ([0] * (len(codes) - 1), 1), language)

    def test_readers_are_short(self):
        for file in (self.root / "readers").glob("read.*"):
            self.assertLessEqual(len(file.read_text().splitlines()), 30, file.name)

    def test_fields_obey_friction_and_carry_the_load(self):
        with h5py.File(self.root / "fields/ellipse.h5") as h5:
            grid = {name: h5["grid"][name][:] for name in h5["grid"]}
            self.assertLessEqual(h5.attrs["certificate_gap"], 1e-11)
            self.assertIn("friction = 0.1", h5.attrs["scene"])
            coarse = h5["extrapolated/pressure"][:]
        size = np.hypot(grid["q1"], grid["q2"])
        self.assertLessEqual((size - 0.1 * grid["pressure"]).max(), 1e-12 * size.max())
        work = grid["q1"] * grid["slip1"] + grid["q2"] * grid["slip2"]
        self.assertLess(work.max(), 1e-9 * -work.min())
        area = (grid["x1"][1] - grid["x1"][0]) * (grid["x2"][1] - grid["x2"][0])
        self.assertAlmostEqual(grid["pressure"].sum() * area, 1000, delta=1e-5)
        self.assertAlmostEqual(coarse.sum() * 4 * area, 1000, delta=1e-5)

    def test_vtu_opens(self):
        try:
            import meshio
        except ImportError:
            self.skipTest("meshio is not installed")
        mesh = meshio.read(self.root / "fields/ellipse.vtu")
        with h5py.File(self.root / "fields/ellipse.h5") as h5:
            for name in fields.FIELDS:
                np.testing.assert_allclose(mesh.cell_data[name][0], h5["grid"][name][:].ravel(), rtol=1e-6, atol=1e-30)
            centre = mesh.points[mesh.cells[0].data].mean(axis=1)
            np.testing.assert_allclose(centre[:, 1].reshape(h5["grid/gap"].shape)[0], h5["grid/x2"][:], rtol=1e-5)

    def test_extrapolation_is_closer_to_the_exact_tractions(self):
        """On the sphere, whose exact cell means are known by sampling 12 x 12 points of each cell."""
        with tempfile.TemporaryDirectory() as work:
            grids = [fields.Scene("sphere", factor, Path(work)) for factor in (1, 2)]
            coarse, fine = (scene.solve(PROGRAM)[1]["q1"] for scene in grids)
        n, h, parts = grids[0].n[0], grids[0].h[0], 12
        at = (np.arange(n * parts) - 0.5 * (n * parts - 1)) * h / parts
        x, y = np.meshgrid(at, at, indexing="ij")
        contact = exact.contact_of(1000.0, float(tables.MODULUS), [0.018])
        r = np.hypot(x, y) / contact.radius
        q = np.where(r < 1, exact.traction(np.minimum(r, 1), 0.5), 0.0) * 0.1 * contact.reference_pressure
        mean = (-y / np.maximum(np.hypot(x, y), 1e-300) * q).reshape(n, parts, n, parts).mean(axis=(1, 3))
        found = fields.extrapolate(coarse, fine)
        off = [np.abs(field - mean).sum() / np.abs(mean).sum() for field in (coarse, found)]
        self.assertLess(off[1], 0.5 * off[0])
        self.assertLess(np.abs(found - mean).sum(), np.abs(found - coarse).sum())  # the stated uncertainty holds in the mean

    def problem(self):
        with h5py.File(self.root / "fclib/sphere.h5") as h5:
            w = h5["fclib_local/W"]
            n, p, i, x = (w[name][:] for name in ("n", "p", "i", "x"))
            matrix = np.zeros((n[0], n[0]))
            matrix[np.repeat(np.arange(n[0]), np.diff(p)), i] = x
            return matrix, *(h5[name][:] for name in ("fclib_local/vectors/q", "fclib_local/vectors/mu", "solution/u", "solution/r"))

    def test_discrete_problem_is_solved(self):
        matrix, q, mu, u, r = self.problem()
        np.testing.assert_allclose(u, matrix @ r + q, atol=1e-13)
        u, r = u.reshape(-1, 3), r.reshape(-1, 3)
        self.assertLess(np.abs(np.minimum(u[:, 0], r[:, 0])).max(), 1e-9)  # no gap where it presses, no pressure where it gaps
        slip, friction = np.hypot(u[:, 1], u[:, 2]), np.hypot(r[:, 1], r[:, 2])
        self.assertLess((friction - mu * r[:, 0]).max(), 1e-12)
        self.assertLess(np.abs(u[:, 1] * r[:, 1] + u[:, 2] * r[:, 2] + mu * r[:, 0] * slip).max(), 1e-10)

    def test_compact_file_gives_the_same_problem(self):
        assemble_fclib.main(self.root / "fclib/compact/sphere.h5", self.folder / "again.h5")
        self.assertEqual((self.folder / "again.h5").read_bytes(), (self.root / "fclib/sphere.h5").read_bytes())

    @unittest.skipUnless(SOLVER, "libsiconos-numerics-dev and libfclib-dev are not installed")
    def test_siconos_reaches_the_solution(self):
        shutil.copy(self.root / "fclib/sphere.h5", self.folder / "theirs.h5")
        self.assertLess(fclib.distance(SOLVER[0], self.folder / "theirs.h5"), 1e-8)
