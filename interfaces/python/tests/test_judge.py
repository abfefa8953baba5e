"""slipstick.check, gate and study: verdicts that follow from theory, and errors."""
import importlib.util
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
import scenes
import slipstick
from slipstick._scene import toml_text

signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it
SPHERE = scenes.SPHERE | {"grid": {"cells": [32, 32]}}
GATE = """
[[gate]]
id = "twist"
scene = "scene.toml"
quantity = "twist_error"
below = {}
basis = "made up"
"""


def exact_field():
    """The exact tractions of the scene at the cell centres of its grid."""
    return dict(slipstick.solve(SPHERE, solver__model="exact").fields)


class CheckTest(unittest.TestCase):
    def test_good(self):
        solution = slipstick.solve(SPHERE)
        for field in (solution.fields, exact_field()):
            verdict = slipstick.check(SPHERE, field)
            self.assertTrue(verdict.good, verdict.why)
        self.assertTrue(slipstick.check(SPHERE, solution, twist=solution.twist_angle, discrete=True).good)

    def test_bad(self):
        field = exact_field()
        field["q1"], field["q2"] = 0.8 * field["q1"], 0.8 * field["q2"]  # carries 0.72 of the limit, not 0.9
        verdict = slipstick.check(SPHERE, field)
        self.assertEqual((verdict.good, verdict.verdict), (False, "bad"))
        self.assertIn("moment", verdict.why)
        self.assertAlmostEqual(verdict.moment_error, -0.2, delta=0.01)
        self.assertIn("<th>verdict</th><td>bad</td>", verdict._repr_html_())

    def test_options_and_overrides_arrive(self):
        field = exact_field()
        self.assertFalse(slipstick.check(SPHERE, field, tolerance=1e-9).good)
        self.assertFalse(slipstick.check(SPHERE, field, load__moment_ratio=0.5).good)
        self.assertFalse(slipstick.check(SPHERE, field, twist=1.0).good)
        in_mpa = {name: values * (1e-6 if name in ("pressure", "q1", "q2") else 1) for name, values in field.items()}
        self.assertTrue(slipstick.check(SPHERE, in_mpa).good)
        self.assertFalse(slipstick.check(SPHERE, in_mpa, strict=True).good)
        rounded = field | {"q1": field["q1"] * 1.0001, "q2": field["q2"] * 1.0001}  # within the mesh, but no solution on it
        self.assertTrue(slipstick.check(SPHERE, rounded).good)
        self.assertFalse(slipstick.check(SPHERE, rounded, discrete=True).good)

    def test_cells_that_carry_a_traction_without_pressure_are_seen(self):
        field = exact_field()
        field["q1"] = field["q1"] + 1e8 * (field["pressure"] == 0)
        self.assertFalse(slipstick.check(SPHERE, field).good)

    def test_hdf5_files_of_h5py_and_of_the_library_are_the_same(self):
        solution = slipstick.solve(SPHERE)
        with tempfile.TemporaryDirectory() as folder:
            ours, theirs = Path(folder) / "library.h5", Path(folder) / "h5py.h5"
            solution.write(ours)
            with mock.patch.object(slipstick._library, "has_hdf5", lambda: False):
                solution.write(theirs)
                by_h5py = slipstick.check(SPHERE, ours, twist=1.0)
            self.assertEqual(os.listdir(folder).count("h5py.h5"), len(os.listdir(folder)) - 1)  # no draft is left
            for name, values in slipstick._hdf5.read(theirs).items():
                np.testing.assert_array_equal(values, solution.fields[name][solution.fields["pressure"] != 0])
            self.assertEqual(by_h5py.why, slipstick.check(SPHERE, theirs, twist=1.0).why)
            self.assertFalse(by_h5py.good)

    def test_columns_of_other_objects(self):
        """The same numbers are the same verdict, whatever holds them and by which common names."""
        field = {name: values for name, values in exact_field().items() if name in ("x1", "x2", "pressure", "q1", "q2")}
        others = dict(zip(field, ("X [mm]", "Y [mm]", "p", "tau_x", "tau_y")))
        renamed = {others[name]: values * (1e3 if name in ("x1", "x2") else 1) for name, values in field.items()}
        flat = {name: values.ravel() for name, values in field.items()}
        axes = field | {"x1": field["x1"][:, 0], "x2": field["x2"][0]}
        objects = [renamed, flat, axes, np.rec.fromarrays(list(flat.values()), names=list(flat))]
        if importlib.util.find_spec("pandas"):
            import pandas
            objects += [pandas.DataFrame(flat), pandas.DataFrame({name: values.ravel() for name, values in renamed.items()})]
        if importlib.util.find_spec("xarray"):
            import xarray
            data = xarray.Dataset({name: (("x1", "x2"), axes[name]) for name in ("pressure", "q1", "q2")},
                                  {name: axes[name] for name in ("x1", "x2")})
            objects += [data, data.transpose("x2", "x1").rename(x1="x", x2="y")]
        right = slipstick.check(SPHERE, field)
        for same in objects:
            found = slipstick.check(SPHERE, same)
            self.assertEqual(found.keys(), right.keys())  # judged on the scene's grid, not as points of a mesh
            self.assertAlmostEqual(found.moment_error, right.moment_error, places=12)

    def test_a_vector_and_a_mesh_are_read_as_one(self):
        field = {name: values.ravel() for name, values in exact_field().items()}
        vector = {"x": field["x1"], "y": field["x2"], "p": field["pressure"], "traction": np.stack([field["q1"], field["q2"]], axis=1)}
        vector["traction"] = np.column_stack([vector["traction"], -field["pressure"]])
        found = slipstick.check(SPHERE, vector)
        self.assertEqual((found.verdict, found.kind), ("good", "nodes"))

    def test_unknown_columns_are_answered_with_the_known_ones(self):
        for field in ({"a": np.zeros(3)}, np.zeros((3, 5)), None):
            with self.assertRaisesRegex(slipstick.InputError, "no x1, x2, pressure, q1, q2; .* allowed: columns x1, x2"):
                slipstick.check(SPHERE, field)

    def test_stresses(self):
        """Under the centre of Hertz's pressure s33 = -p0/(1 + z^2/a^2), with or without torsion."""
        exact = slipstick.solve(SPHERE, solver__model="exact")
        a, peak = exact["contact_radius"], exact["peak_pressure"]
        depth = np.linspace(0.0, 3.0, 7)
        columns = {"x1": 0 * depth, "x2": 0 * depth, "x3 [mm]": 1e3 * a * depth, "s33": -peak / (1 + depth**2), "s13": 0 * depth}
        verdict = slipstick.check(SPHERE, columns, strict=True)
        self.assertEqual((verdict.verdict, verdict["rows"]), ("good", 7), verdict.why)
        self.assertLess(max(item["value"] for item in verdict["judged"]), 1e-12)
        self.assertFalse(slipstick.check(SPHERE, columns | {"s33": -columns["s33"]}).good)

    def test_loops(self):
        """The exact loop in the scene's units is good; a loop with another stiffness is not."""
        exact = slipstick.solve(SPHERE, solver__model="exact", load__moment_ratio=0.5)
        curve = slipstick.exact.curve([0.5, -0.5, 0.5], 40)
        loop = {"moment": curve.moment * exact.moment / slipstick.exact.moment(moment_ratio=0.5),
                "rotation": curve.twist * exact.twist_angle / slipstick.exact.twist(0.5)}
        self.assertTrue(slipstick.check(SPHERE, loop).good)
        self.assertFalse(slipstick.check(SPHERE, loop | {"rotation": 1.3 * loop["rotation"]}).good)
        with self.assertRaisesRegex(slipstick.InputError, "has no rotation"):
            slipstick.check(SPHERE, {"moment": loop["moment"]})

    def test_without_h5py_an_hdf5_file_is_refused_with_what_to_do(self):
        with mock.patch.object(slipstick._library, "has_hdf5", lambda: False), mock.patch.dict(sys.modules, {"h5py": None}):
            with self.assertRaisesRegex(slipstick.InputError, "field.h5: .*pip install h5py"):
                slipstick.check(SPHERE, "field.h5")

    def test_refusals(self):
        field = exact_field()
        with self.assertRaisesRegex(slipstick.InputError, "the field has no q2"):
            slipstick.check(SPHERE, {name: field[name] for name in ("x1", "x2", "pressure", "q1")})
        with self.assertRaisesRegex(slipstick.InputError, "allowed: one a cell in each"):
            slipstick.check(SPHERE, field | {"q2": np.zeros(3)})
        with self.assertRaisesRegex(slipstick.InputError, "^nowhere.csv: cannot be read"):
            slipstick.check(SPHERE, "nowhere.csv")
        with self.assertRaisesRegex(slipstick.InputError, "contact.friction = -1"):
            slipstick.check(SPHERE, field, contact__friction=-1.0)


class FilesTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "scene.toml").write_text(toml_text(SPHERE))

    def test_gates(self):
        file = self.folder / "gates.toml"
        file.write_text(GATE.format(1e-2))
        gates = slipstick.gate(file, output=self.folder / "kept")
        self.assertTrue(gates.passed)
        self.assertLess(abs(gates.gates[0].value), 1e-2)
        self.assertTrue(any((self.folder / "kept").iterdir()))
        self.assertEqual(gates.why, "")
        file.write_text(GATE.format(1e-7))
        self.assertFalse(slipstick.gate([file]).passed)
        self.assertRegex(slipstick.gate([file]).why, "^twist: .*1e-07")
        for unread in ("missing.toml", self.folder, [file, "missing.toml"]):
            with self.assertRaisesRegex(slipstick.InputError, "cannot be read"):
                slipstick.gate(unread)
        file.write_text(GATE.format('"small"'))
        self.assertFalse(slipstick.gate(file).passed)
        with self.assertRaisesRegex(slipstick.InputError, "thrust"):
            slipstick.gate(file, only=["thrust"])
        file.write_text(GATE.format(1e-2) + GATE.format(1e-7).replace('"twist"', '"tight"'))
        self.assertEqual([gate.outcome for gate in slipstick.gate(file).gates], ["passed", "failed"])
        self.assertEqual([gate.id for gate in slipstick.gate(file, only=["tight"]).gates], ["tight"])
        self.assertTrue(slipstick.assert_gates(file, only=["twist"]).passed)
        with self.assertRaisesRegex(AssertionError, "^tight: "):
            slipstick.assert_gates(file)

    def test_study(self):
        file = self.folder / "study.toml"
        file.write_text('name = "small"\nscene = "scene.toml"\ncells = [16, 24, 32]\nshifts = 1\n')
        study = slipstick.study(file, load__moment_ratio=0.5)
        rows = [row for series in study.series.values() for row in series.rows]
        self.assertEqual(sorted(row.cells[0] for row in rows), [16, 24, 32])
        errors = [abs(row["twist_error"]) for row in rows]
        self.assertLess(max(errors), 0.05)

    def test_a_study_goes_on_after_ctrl_c(self):
        file, kept = self.folder / "study.toml", self.folder / "kept"
        cells = list(range(16, 272, 16))  # runs for minutes unless it is stopped
        file.write_text(f'name = "long"\nscene = "scene.toml"\ncells = {cells}\nshifts = 4\n')

        ended = threading.Event()

        def strike():
            while not ended.wait(0.01):
                if any(kept.glob("**/*.json")):
                    return os.kill(os.getpid(), signal.SIGINT)

        striker = threading.Thread(target=strike)
        striker.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                slipstick.study(file, output=kept, jobs=1)
        finally:
            ended.set()
            striker.join()
        with self.assertRaises(ChildProcessError):  # no process is left
            os.waitpid(-1, os.WNOHANG)
        file.write_text(f'name = "long"\nscene = "scene.toml"\ncells = {cells[:3]}\nshifts = 1\n')
        said = []
        self.assertEqual(slipstick.study(file, output=kept, progress=said.append).failed_runs.count, 0)
        self.assertIn("[", said[-1])


    @unittest.skipUnless(sys.platform == "linux", "only Linux ends a process with its parent")
    def test_a_killed_python_leaves_no_study(self):
        (self.folder / "study.toml").write_text('name = "long"\nscene = "scene.toml"\ncells = [256, 288]\n'
                                                'set = { "solver.operator" = "direct" }\n')  # minutes each
        mark = f"SLIPSTICK_TEST_MARKER={self.folder}".encode()

        def processes():
            found = []
            for process in Path("/proc").glob("[0-9]*"):
                try:
                    found += [int(process.name)] * (mark in (process / "environ").read_bytes().split(b"\0"))
                except OSError:
                    pass
            return found

        parent = subprocess.Popen(
            [sys.executable, "-B", "-c", f"import slipstick; slipstick.study({str(self.folder / 'study.toml')!r}, jobs=2)"],
            env=os.environ | {"SLIPSTICK_TEST_MARKER": str(self.folder), "TMPDIR": str(self.folder)})
        self.addCleanup(lambda: [os.kill(process, signal.SIGKILL) for process in processes()])
        while len(processes()) < 4:  # Python, the study, two that solve
            self.assertIsNone(parent.poll())
            time.sleep(0.01)
        parent.kill()
        parent.wait()
        end = time.monotonic() + 120  # longer than on any machine
        while processes() and time.monotonic() < end:
            time.sleep(0.01)
        self.assertEqual(processes(), [])


class MachineryTest(unittest.TestCase):
    @unittest.skipUnless(importlib.util.find_spec("pandas"), "pandas is not installed")
    def test_frames(self):
        result = slipstick.Result({"rows": [{"a": 1, "b": {"c": 2}}, {"a": 3, "b": {"c": 4}}]})
        self.assertEqual(list(result.to_frame()["b.c"]), [2, 4])
