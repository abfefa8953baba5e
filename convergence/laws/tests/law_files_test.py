"""law_files_test.py PROGRAM SCENES C_COMPILER: each file that slipstick law writes is compiled, run or parsed, and compared
with the exact law at 10,000 points. Without a C compiler (an empty name) the header is left out."""

import csv
import importlib.util
import json
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from bisect import bisect_left
from pathlib import Path

PROGRAM, SCENES, COMPILER = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3]
POINTS = 5000  # on each of two branches

C_PROGRAM = """
#include <stdio.h>
#include "law.h"
int main(void) {
  double start_rotation, start_moment, rotation, moment;
  while (scanf("%lf %lf %lf %lf", &start_rotation, &start_moment, &rotation, &moment) == 4)
    printf("%.17g %.17g %.17g %.17g\\n", slipstick_law_moment(rotation), slipstick_law_rotation(moment),
           slipstick_law_branch(start_rotation, start_moment, rotation), slipstick_law_energy_lost(moment));
  return 0;
}
"""


def program(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=True).stdout


def interpolated(x, y, at):
    """Linear; constant beyond the ends."""
    k = min(max(bisect_left(x, at), 1), len(x) - 1)
    part = min(max((at - x[k - 1]) / (x[k] - x[k - 1]), 0), 1)
    return y[k - 1] + part * (y[k] - y[k - 1])


class Law(unittest.TestCase):
    """Of the paper's sphere, in SI units, against the program's exact history."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        cls.files = {ending: cls.folder / f"law.{ending}" for ending in ("csv", "h", "py", "table", "inp", "xml", "sdf")}
        words = [word for file in cls.files.values() for word in ("--write", file)]
        cls.law = json.loads(program("law", SCENES / "paper.toml", "--json", "-", *words))
        cls.rotation_unit, cls.moment_unit = cls.law["units"]["rotation_unit"], cls.law["units"]["moment_unit"]
        cls.limit = cls.law["moment_limit"]
        # The far end of loading, and back: the two branches of a loop.
        exact = json.loads(program("exact", "--history", "0.9999,-0.9999", "--points", POINTS, "--json", "-"))
        curve = [(point["twist"] * cls.rotation_unit, point["moment"] * cls.moment_unit) for point in exact["curve"]]
        cls.loading, cls.unloading = curve[:POINTS + 1], curve[POINTS:]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def assert_law(self, moment, rotation, branch, energy_lost):
        """Functions against first loading, unloading and the losses."""
        for r, m in self.loading[1:]:
            self.assertLessEqual(abs(moment(r) / m - 1), 1e-6)
            self.assertLessEqual(abs(rotation(m) / r - 1), 1e-6)
            self.assertEqual(moment(-r), -moment(r))
        start = self.loading[-1]
        for r, m in self.unloading:
            self.assertLessEqual(abs(branch(*start, r) - m), 3e-6 * start[1])
        for ratio in (0.1, 0.5, 0.9, 0.999):
            state = json.loads(program("exact", "--history", f"{ratio},{-ratio},{ratio}", "--points", 1, "--json", "-"))
            first, _, last = state["history"]
            lost = (last["dissipated"] - first["dissipated"]) * self.rotation_unit * self.moment_unit
            box = 4 * first["moment"] * first["twist"] * self.rotation_unit * self.moment_unit
            self.assertLessEqual(abs(energy_lost(ratio * self.limit) - lost), 1e-6 * box)

    def test_python(self):
        spec = importlib.util.spec_from_file_location("law", self.files["py"])
        law = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(law)
        self.assert_law(law.moment, law.rotation, law.branch, law.energy_lost)
        self.assertEqual(law.moment(1.0), law.LIMIT)
        self.assertAlmostEqual(law.LIMIT / self.limit, 1, 14)
        self.assertAlmostEqual(law.moment(1e-9) / 1e-9 / law.STIFFNESS, 1, 5)

    def test_c(self):
        if not COMPILER:
            self.skipTest("no C compiler")
        (self.folder / "law.c").write_text(C_PROGRAM)
        words = [COMPILER, "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O1", "law.c", "-o", "law", "-lm"]
        subprocess.run(words, cwd=self.folder, check=True)
        (_, (start_r, start_m)), points = (self.loading[0], self.loading[-1]), self.loading + self.unloading
        points += [(-r, -m) for r, m in self.loading] + [(0.0, ratio * self.limit) for ratio in (0.1, 0.5, 0.9, 0.999)]
        asked = "".join(f"{start_r!r} {start_m!r} {r!r} {m!r}\n" for r, m in points)
        out = subprocess.run([self.folder / "law"], input=asked, capture_output=True, text=True, check=True).stdout
        rows = [tuple(map(float, line.split())) for line in out.splitlines()]
        self.assertEqual(len(rows), len(points))
        answers = [{point[0]: row[0] for point, row in zip(points, rows)},
                   {point[1]: row[1] for point, row in zip(points, rows)},
                   {point[0]: row[2] for point, row in zip(points, rows)},
                   {point[1]: row[3] for point, row in zip(points, rows)}]
        self.assert_law(answers[0].__getitem__, answers[1].__getitem__, lambda _r, _m, r: answers[2][r],
                        answers[3].__getitem__)

    def assert_table(self, rotations, moments):
        self.assertEqual(rotations, sorted(rotations))
        for r, m in self.loading:
            self.assertLessEqual(abs(interpolated(rotations, moments, r) - m), 1.0001e-4 * self.limit)

    def test_csv(self):
        rows = list(csv.DictReader(self.files["csv"].read_text().splitlines()))
        self.assert_table([float(row["rotation"]) for row in rows], [float(row["moment"]) for row in rows])
        self.assertEqual(float(rows[0]["stick_ratio"]), 1)
        slope = float(rows[1]["moment"]) / float(rows[1]["rotation"])
        self.assertLess(slope, float(rows[0]["tangent_stiffness"]))
        self.assertGreater(slope, float(rows[1]["tangent_stiffness"]))

    def test_json(self):
        self.assert_table(self.law["table"]["rotation"], self.law["table"]["moment"])

    def test_lammps(self):
        """As its tabulated styles read a file: comments, keyword, N, a blank line, index x energy force."""
        lines = self.files["table"].read_text().splitlines()
        at = lines.index("SLIPSTICK_TWIST")
        self.assertTrue(all(not line or line.startswith("#") for line in lines[:at]))
        count = int(re.fullmatch(r"N (\d+)", lines[at + 1])[1])
        self.assertEqual(lines[at + 2], "")
        rows = [tuple(map(float, line.split())) for line in lines[at + 3:]]
        self.assertEqual([row[0] for row in rows], list(range(1, count + 1)))
        rotations, moments = [row[1] for row in rows], [-row[3] for row in rows]
        self.assert_table(rotations, moments)
        energy = 0.0
        for one, other in zip(rows, rows[1:]):  # trapezes: as exact as the table
            energy -= 0.5 * (other[1] - one[1]) * (one[3] + other[3])
            self.assertLessEqual(abs(energy - other[2]), 2e-4 * self.limit * other[1])
        spring = re.search(r"twisting sds (\S+) 0.0 (\S+)", "\n".join(lines))
        stiffness, arm = float(spring[1]), float(spring[2])
        self.assertAlmostEqual(arm * self.law["units"]["normal_load"] / self.limit, 1, 8)
        worst = max(abs(min(stiffness * r, self.limit) - m) for r, m in self.loading) / self.limit
        self.assertAlmostEqual(worst, self.law["programs"]["lammps"]["error"], 3)

    def behaviours(self):
        """Abaqus' keywords with their parameters and data, by the behaviour's name."""
        found, current = {}, None
        for line in self.files["inp"].read_text().splitlines():
            if line.startswith("**"):
                continue
            if line.startswith("*"):
                keyword, *words = [word.strip() for word in line[1:].split(",")]
                parameters = dict(word.partition("=")[::2] for word in words)
                if keyword == "CONNECTOR BEHAVIOR":
                    current = found.setdefault(parameters["NAME"], {})
                else:
                    current[keyword] = (parameters, [])
                    data = current[keyword][1]
            else:
                data.append([float(word) for word in line.split(",") if word.strip()])
        return found

    def test_abaqus(self):
        behaviours = self.behaviours()
        parameters, data = behaviours.pop("SLIPSTICK_LOADING")["CONNECTOR ELASTICITY"]
        self.assertEqual((parameters["COMPONENT"], "NONLINEAR" in parameters), ("4", True))
        self.assert_table([row[1] for row in data], [row[0] for row in data])
        elements = []
        for behaviour in behaviours.values():
            self.assertEqual(behaviour["CONNECTOR PLASTICITY"][0]["COMPONENT"], "4")
            ((stiffness,),), ((slip, motion),) = behaviour["CONNECTOR ELASTICITY"][1], behaviour["CONNECTOR HARDENING"][1]
            self.assertEqual(motion, 0)
            elements.append((stiffness, slip))
        carried, at = [0.0] * len(elements), 0.0
        for number, (r, m) in enumerate(self.loading + self.unloading):
            carried = [min(max(was + k * (r - at), -slip), slip) for was, (k, slip) in zip(carried, elements)]
            at = r
            allowed = 0.01001 if number < len(self.loading) else 0.03
            self.assertLessEqual(abs(sum(carried) - m), allowed * self.limit)

    def test_mujoco(self):
        root = xml.etree.ElementTree.parse(self.files["xml"]).getroot()
        self.assertEqual(root.find("option").get("cone"), "elliptic")
        geom = root.find("default/geom")
        slide, torsion, _ = map(float, geom.get("friction").split())
        self.assertEqual((geom.get("condim"), slide), ("4", 0.1))
        self.assertAlmostEqual(torsion * 1000 / self.limit, 1, 12)

    def test_drake(self):
        root = xml.etree.ElementTree.parse(self.files["sdf"]).getroot()
        namespace = {"drake": "http://drake.mit.edu"}
        properties = root.find(".//drake:proximity_properties", namespace)
        self.assertIsNotNone(properties.find("drake:compliant_hydroelastic", namespace))
        modulus = float(properties.find("drake:hydroelastic_modulus", namespace).text)
        radius = float(root.find(".//radius").text)
        a = (4 * radius**2 * 1000 / (3.141592653589793 * modulus))**0.25  # of a pressure modulus (depth)/radius
        self.assertAlmostEqual(0.1 * 1000 * 8 / 15 * a / self.limit, 1, 12)


class Options(unittest.TestCase):
    def refused(self, *words):
        run = subprocess.run([PROGRAM, "law", *map(str, words)], capture_output=True, text=True)
        self.assertEqual(run.returncode, 2, words)
        return run.stderr

    def test_refuses(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertIn(".csv", self.refused("--write", f"{folder}/law.docx"))
            self.assertIn("scene", self.refused("--write", f"{folder}/law.xml"))
            self.assertIn("sphere", self.refused(SCENES / "cone.toml", "--write", f"{folder}/law.sdf"))
            self.assertEqual(list(Path(folder).iterdir()), [])
        self.assertIn("--error", self.refused("--error", 0))
        self.assertIn("--table-error", self.refused("--table-error", "1e-9"))
        self.assertIn("--elements", self.refused("--elements", 0))
        self.assertIn("--profile", self.refused("--profile", "disc"))
        self.assertIn("ellipsoid", self.refused(SCENES / "ellipse.toml"))
        self.refused(SCENES / "paper.toml", "--profile", "cone")

    def test_keeps_its_inputs(self):
        with tempfile.TemporaryDirectory() as folder:
            table = Path(folder) / "p.csv"
            text = "radius,pressure\n" + "".join(f"{i / 20},{1 - (i / 20)**2}\n" for i in range(21))
            table.write_text(text)
            self.assertIn("would overwrite", self.refused("--profile", f"file:{table}", "--write", table))
            self.assertEqual(table.read_text(), text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
