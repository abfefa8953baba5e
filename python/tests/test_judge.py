"""slipstick.check, gate and study: verdicts that theory gives, and what goes wrong."""
import os
import signal
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np
import scenes
import slipstick
from slipstick._scene import toml_text

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
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "scene.toml").write_text(toml_text(SPHERE))

    def test_gates(self):
        file = self.folder / "gates.toml"
        file.write_text(GATE.format(1e-2))
        gates = slipstick.gate(file, output=self.folder / "kept")
        self.assertTrue(gates.passed)
        self.assertLess(abs(gates.gates[0].value), 1e-2)
        self.assertTrue(any((self.folder / "kept").iterdir()))
        file.write_text(GATE.format(1e-7))
        self.assertFalse(slipstick.gate([file]).passed)
        file.write_text(GATE.format('"small"'))
        self.assertFalse(slipstick.gate(file).passed)
        with self.assertRaisesRegex(slipstick.InputError, "thrust"):
            slipstick.gate(file, only=["thrust"])
        file.write_text(GATE.format(1e-2) + GATE.format(1e-7).replace('"twist"', '"tight"'))
        self.assertEqual([gate.outcome for gate in slipstick.gate(file).gates], ["passed", "failed"])
        self.assertEqual([gate.id for gate in slipstick.gate(file, only=["tight"]).gates], ["tight"])

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
        cells = list(range(16, 272, 16))  # for minutes, were it not stopped
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
        with self.assertRaises(ChildProcessError):  # nothing is left running
            os.waitpid(-1, os.WNOHANG)
        file.write_text(f'name = "long"\nscene = "scene.toml"\ncells = {cells[:3]}\nshifts = 1\n')
        said = []
        self.assertEqual(slipstick.study(file, output=kept, progress=said.append).failed_runs.count, 0)
        self.assertIn("[", said[-1])


class MachineryTest(unittest.TestCase):
    def test_frames(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("pandas is not installed")
        result = slipstick.Result({"rows": [{"a": 1, "b": {"c": 2}}, {"a": 3, "b": {"c": 4}}]})
        self.assertEqual(list(result.to_frame()["b.c"]), [2, 4])


if __name__ == "__main__":
    unittest.main()
