"""audit_test.py PROGRAM: the audit's own integrals, its verdict on a wrong field, and its verdicts on a tenth of all cases."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

HARD = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(HARD))
import audit  # noqa: E402

PROGRAM = Path(sys.argv.pop(1)).resolve()


def family(scene, *settings):
    """A file of one case: a scene of the repository on a small grid."""
    lines = ["[[family]]", 'name = "small"', 'why = "made for the test"', f'scene = "{HARD.parent}/scenes/{scene}.toml"',
             "[family.set]", "grid.cells = [14, 12]", *settings]
    return "\n".join(lines) + "\n"


def solve_hard(folder, files, *options):
    """The result of the hard cases of some files, with their fields."""
    command = [PROGRAM, "hard", *files, "--once", "--quiet", "--output", folder / "kept", "--fields", folder / "fields"]
    subprocess.run([*command, "--json", folder / "hard.json", *options], check=False, stderr=subprocess.DEVNULL)
    return json.loads((folder / "hard.json").read_text())


class Kernels(unittest.TestCase):
    def test_are_the_integrals_of_point_loads(self):
        n, h = [6, 5], [0.7, 1.9]
        compliance = np.array([2.0, 0.6, 1.4, 0.5])
        tables = {k: np.fft.irfft2(t, [12, 10]) for k, t in audit.kernels(n, h, compliance).items()}
        nodes, weights = np.polynomial.legendre.leggauss(40)
        shear, poisson, normal, mismatch = compliance / (2.0 * np.pi)
        for i, j in ((2, 0), (0, 2), (3, 1), (5, 4), (-4, 2), (1, -3)):
            x, y = np.meshgrid(i * h[0] + 0.5 * h[0] * nodes, j * h[1] + 0.5 * h[1] * nodes, indexing="ij")
            area = 0.25 * h[0] * h[1] * np.outer(weights, weights)
            r = np.hypot(x, y)
            loads = {
                "11": (shear - poisson) / r + poisson * x**2 / r**3,
                "22": (shear - poisson) / r + poisson * y**2 / r**3,
                "12": poisson * x * y / r**3,
                "33": normal / r,
                "13": -0.5 * mismatch * x / r**2,
                "23": -0.5 * mismatch * y / r**2,
            }
            for name, load in loads.items():
                self.assertAlmostEqual(tables[name][i, j], (load * area).sum(), delta=1e-12, msg=f"{name} {i} {j}")


class Audit(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.addCleanup(self.temporary.cleanup)

    def findings(self, row):
        return {key for key, found in audit.audit(row, self.folder).items() if not found <= audit.ALLOWED[key]}

    def test_sees_a_wrong_number_in_the_last_step_of_a_history(self):
        (self.folder / "loop.toml").write_text(family("growing_load"))
        row = solve_hard(self.folder, [self.folder / "loop.toml"])["rows"][0]
        self.assertEqual(row["verdict"], "certified")
        self.assertIn("slip", audit.audit(row, self.folder))
        self.assertEqual(self.findings(row), set())
        for file in (Path(row["written"]["fields"]), Path(row["written"]["before"])):
            good = file.read_text()
            names, *lines = good.strip().split("\n")
            words, at = lines[5].split(","), names.split(",").index("q1")
            words[at] = repr(1.001 * float(words[at]) + 1.0)
            file.write_text("\n".join([names, *lines[:5], ",".join(words), *lines[6:]]) + "\n")
            self.assertIn("slip", self.findings(row), file)
            file.write_text(good)

    def test_sees_a_field_in_which_one_number_is_wrong(self):
        (self.folder / "small.toml").write_text(
            family("dissimilar", "solver.tolerance = 1e-10", "load.force = [60.0, 20.0]"))
        row = solve_hard(self.folder, [self.folder / "small.toml"])["rows"][0]
        self.assertEqual(row["verdict"], "certified")
        self.assertEqual(self.findings(row), set())
        file = Path(row["written"]["fields"])
        good = file.read_text()
        names, *lines = good.strip().split("\n")
        middle = len(lines) // 2
        for column, seen in (("pressure", "load"), ("q1", "slip"), ("q2", "slip"), ("slip1", "slip"), ("slip2", "slip")):
            words = lines[middle].split(",")
            at = names.split(",").index(column)
            scale = max(abs(float(line.split(",")[at])) for line in lines)
            words[at] = repr(float(words[at]) + 1e-6 * scale)
            file.write_text("\n".join([names, *lines[:middle], ",".join(words), *lines[middle + 1:]]) + "\n")
            self.assertIn(seen, self.findings(row), column)
        file.write_text(good)
        for key in ("normal_load", "moment"):
            wrong = dict(row, written=dict(row["written"], **{key: 1.0001 * row["written"][key]}))
            self.assertTrue(self.findings(wrong), key)

    def test_finds_nothing_in_a_tenth_of_all_cases(self):
        result = solve_hard(self.folder, sorted(HARD.glob("*.toml")))
        self.assertGreaterEqual(len(result["rows"]), 600)
        self.assertEqual(result["counts"]["wrong"], 0, [row for row in result["rows"] if row["verdict"] == "wrong"])
        self.assertEqual(result["counts"]["not_converged"], 0)
        solved = [row for row in result["rows"] if "written" in row]
        self.assertGreaterEqual(len(solved), 500)
        for row in solved[::10]:
            row["scene"] = str((HARD / row["scene"]).resolve())
            self.assertEqual(self.findings(row), set(), f"{row['family']} {row['case']}")
