"""law_files_test.py PROGRAM SCENES C_COMPILER: each file that slipstick law writes is compiled, run or parsed, and compared
with the exact law at 10,000 points. Without a C compiler (an empty name) the header is left out."""

import csv
import json
import random
import re
import subprocess
import sys
import tempfile
import types
import unittest
import xml.etree.ElementTree
from math import pi
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline
from slipstick import InputError, exact
from slipstick.law_fits import Curve, ParallelElements
from slipstick.laws import Law as PackageLaw
from slipstick.laws import Units

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


def module(text):
    law = types.ModuleType("law")
    exec(text, law.__dict__)
    return law


def carried_by(elements, path):
    """The moments of springs with sliders, (stiffness, slip moment), along a path from rest."""
    stiffness, slip = np.transpose(elements)
    carried, moments = np.zeros(len(slip)), []
    for step in np.diff(path, prepend=0.0):
        carried = np.clip(carried + stiffness * step, -slip, slip)
        moments.append(carried.sum())
    return np.array(moments)


def lammps_rows(text):
    """As its tabulated styles read a file: comments, keyword, N and FP, a blank line, index x energy force."""
    lines = text.splitlines()
    at = next(k for k, line in enumerate(lines) if line.endswith("_TWIST"))
    assert all(not line or line.startswith("#") for line in lines[:at]) and lines[at + 2] == ""
    count, first, last = re.fullmatch(r"N (\d+) FP (\S+) (\S+)", lines[at + 1]).groups()
    rows = [tuple(map(float, line.split())) for line in lines[at + 3:]]
    assert [row[0] for row in rows] == list(range(1, int(count) + 1))
    assert f"linear\n# {count}, or spline {count}" in text
    return rows, float(first), float(last)


class Law(unittest.TestCase):
    """The law of the paper's sphere, in SI units, against the program's exact history."""

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.files = {ending: cls.folder / f"law.{ending}" for ending in ("csv", "h", "py", "table", "inp", "xml", "sdf")}
        words = [word for file in cls.files.values() for word in ("--write", file)]
        cls.law = json.loads(program("law", SCENES / "paper.toml", "--json", "-", *words))
        cls.rotation_unit, cls.moment_unit = cls.law["units"]["rotation_unit"], cls.law["units"]["moment_unit"]
        cls.limit = cls.law["moment_limit"]
        # The far end of loading, and back: the two branches of a loop.
        exact = json.loads(program("exact", "--history", "0.9999,-0.9999", "--points", POINTS, "--json", "-"))
        curve = [(point["twist"] * cls.rotation_unit, point["moment"] * cls.moment_unit) for point in exact["curve"]]
        cls.loading, cls.unloading = curve[:POINTS + 1], curve[POINTS:]

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
            self.assertLessEqual(abs(energy_lost(ratio * self.limit) / lost - 1), 1e-6)
        for power in range(2, 80, 3):  # a sphere's smallest loops lose 3/16 M^3
            lost = 3 / 16 * (10.0**-power * self.limit / self.moment_unit)**3 * self.rotation_unit * self.moment_unit
            self.assertLessEqual(abs(energy_lost(10.0**-power * self.limit) / lost - 1), 1e-6 + 3 * 10.0**-power)

    def test_python(self):
        law = module(self.files["py"].read_text())
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
        points += [(-r, -m) for r, m in self.loading] + [
            (0.0, ratio * self.limit) for ratio in (0.1, 0.5, 0.9, 0.999, *(10.0**-power for power in range(2, 80, 3)))]
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
        at, exact = np.transpose(self.loading)
        self.assertLessEqual(abs(np.interp(at, rotations, moments) - exact).max(), 1.0001e-4 * self.limit)

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
        rows, *_ = lammps_rows(self.files["table"].read_text())
        rotations, moments = [row[1] for row in rows], [-row[3] for row in rows]
        self.assert_table(rotations, moments)
        _, r, energy, force = np.transpose(rows)
        summed = -np.cumsum(0.5 * np.diff(r) * (force[:-1] + force[1:]))  # trapezes: as exact as the table
        self.assertTrue((abs(summed - energy[1:]) <= 2e-4 * self.limit * r[1:]).all())
        spring = re.search(r"twisting sds (\S+) 0.0 (\S+)", self.files["table"].read_text())
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
        rotations, moments = np.transpose(self.loading + self.unloading)
        allowed = np.where(np.arange(len(moments)) < len(self.loading), 0.01001, 0.03) * self.limit
        self.assertTrue((abs(carried_by(elements, rotations) - moments) <= allowed).all())

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
        # By sums over rings: a pressure modulus (depth)/radius over the sphere's shallow cap.
        a, n = self.law["programs"]["drake"]["contact_radius"], 20000
        r = a * (np.arange(n) + 0.5) / n
        rings = modulus * (a * a - r * r) / (2 * radius) / radius * 2 * pi * r * a / n
        self.assertAlmostEqual(rings.sum() / 1000, 1, 7)
        self.assertAlmostEqual(0.1 * rings @ r / self.limit, 1, 7)


class Profiles(unittest.TestCase):
    """Laws without a scene, against the exact one and polynomials that are far more exact."""

    def test_lammps_reads_its_table(self):
        """It draws a cubic through a table's points, takes a given number of its values, and then draws lines or cubics."""
        for profile in ("hertz", "cone", "flat_punch", "power:2", "rounded_punch:0.5"):
            law = PackageLaw(profile, error=0.01, limit_loads=3)
            rows, first, last = lammps_rows(law.file("law.table"))
            x, y = [row[1] for row in rows], [row[3] for row in rows]
            self.assertAlmostEqual(first, -law.stiffness, 12)
            spline, even = CubicSpline(x, y, bc_type=((1, first), (1, last))), np.linspace(0, x[-1], len(x))
            places = x[-1] * (np.arange(2000) + 0.5) / 2000
            for read in (spline(places), np.interp(places, even, spline(even))):
                errors = abs(-read - exact.moment(places, profile=profile))
                self.assertLessEqual(errors.max(), 1.0001e-4 * law.limit, profile)

    def test_losses_are_exact_where_little_is_lost(self):
        for profile in ("hertz", "cone", "flat_punch", "power:2"):
            law = PackageLaw(profile, error=1e-9, limit_loads=3)
            rough = module(PackageLaw(profile, error=0.01, limit_loads=3).file("law.py"))
            close, least = module(law.file("law.py")), law.curve.full_stick
            for k in range(120):
                m = close.LIMIT * (least + (1 - least) * 10**(-k / 10) * 0.99)
                self.assertGreater(rough.energy_lost(m), 0)
                self.assertLessEqual(abs(rough.energy_lost(m) / close.energy_lost(m) - 1), 0.0101, (profile, m))
            words = ("exact", "--profile", profile, "--history", "0.95,-0.95,0.95", "--points", 1, "--json", "-")
            first, _, last = json.loads(program(*words))["history"]
            self.assertAlmostEqual(close.energy_lost(0.95 * close.LIMIT) / (last["dissipated"] - first["dissipated"]), 1, 8)
            self.assertAlmostEqual(close.rotation(0.95 * close.LIMIT) / first["twist"], 1, 8)

    def test_gap_of_the_limit_surface_is_that_of_chords_and_tangents(self):
        """Along rays from the origin: where each leaves the polygon of the loads, and that of their tangents."""
        for profile in ("hertz", "cone", "flat_punch"):
            surface = PackageLaw(profile, limit_loads=9).result()["limit_surface"]
            loads = [(load["force"], load["moment"]) for load in surface["loads"]]
            normals = [(load["centre"], 1) if load["centre"] is not None else (1, 0) for load in surface["loads"]]
            (n, m), (f, t) = np.transpose(normals)[:, :, None], np.transpose(loads)[:, :, None]
            angle = pi / 2 * np.arange(1, 20000) / 20000
            u, v = np.sin(angle), np.cos(angle)
            tangents = ((n * f + m * t) / (n * u + m * v)).min(axis=0)
            k = (f[1:] * v >= t[1:] * u).argmax(axis=0)  # the chord that the ray crosses
            (f, t), (g, s) = (f[k, 0], t[k, 0]), (f[k + 1, 0], t[k + 1, 0])
            gap = (tangents * (v * (g - f) - u * (s - t)) / (t * g - f * s) - 1).max()
            self.assertAlmostEqual(surface["gap"] / gap, 1, 2)


class Histories(unittest.TestCase):
    """Elements in parallel after any rotations, against Masing's rule."""

    @staticmethod
    def masing(profile, path):
        open_ends = []
        for t in path:
            if open_ends and abs(t) >= abs(open_ends[0]):
                open_ends = []
            while len(open_ends) > 1 and (t - open_ends[-2]) * (open_ends[-2] - open_ends[-1]) >= 0:
                del open_ends[-2:]
            open_ends.append(t)
        ranges = [0.5 * (to - at) for at, to in zip(open_ends, open_ends[1:])]
        moments = np.copysign(exact.moment(np.abs([open_ends[0], *ranges]), profile=profile), [open_ends[0], *ranges])
        return 2 * moments.sum() - moments[0]

    def test_stay_within_their_bound_and_reach_it(self):
        draw = random.Random(34)
        for _ in range(20):
            profile = draw.choice(("hertz", "cone", "flat_punch", "power:2", "power:7"))
            curve = Curve(profile)
            found = ParallelElements(curve, 0, draw.choice((1, 2, 4, 8, 16)))
            elements = curve.limit * found.each
            bound, last = found.history_error, 1.2 * exact.twist(moment_deficit=1e-4, profile=profile)

            def error(path):
                return abs(carried_by(elements, path)[-1] - self.masing(profile, path)) / curve.limit

            for _ in range(50):
                path = [draw.choice((-1, 1)) * last * draw.random()]
                for _ in range(draw.randrange(1, 12)):
                    towards = -1 if len(path) == 1 and path[0] > 0 or len(path) > 1 and path[-1] > path[-2] else 1
                    path.append(path[-1] + towards * 2 * last * draw.random()**draw.choice((1, 3)))
                self.assertLessEqual(error(path), bound * (1 + 1e-6), (profile, path))
            # Reversals at the extremes of the error on first loading.
            twists = [10 * last * k**2 / 2000**2 for k in range(2001)]
            e = carried_by(elements, twists) - exact.moment(twists, profile=profile)  # first loading
            turns = [t for t, a, b, c in zip(twists[1:], e, e[1:], e[2:]) if (b - a) * (c - b) < 0][::-1]
            path = [last * 10]
            for k, x in enumerate(turns):
                path.append(path[-1] + (2 * x if k % 2 else -2 * x))
            self.assertGreater(error(path), 0.9 * bound, profile)

    def test_of_an_audit(self):
        """Four turns that are farther off than loops between t and -t may be."""
        exact = json.loads(program("exact", "--history", "0.643287,-0.361987,0.286858,0.025628", "--points", 1, "--json", "-"))
        law = json.loads(program("law", "--json", "-"))
        elements = list(zip(law["elements"]["stiffness"], law["elements"]["slip_moment"]))
        found = carried_by(elements, [state["twist"] for state in exact["history"]])[-1] / law["moment_limit"]
        self.assertGreater(abs(found - 0.025628), law["elements"]["loop_error"])
        self.assertLessEqual(abs(found - 0.025628), law["elements"]["history_error"])


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
        self.assertRaisesRegex(InputError, "--table-error", PackageLaw, table_error=1e-9)
        self.assertRaisesRegex(InputError, "--elements", PackageLaw, elements=0)
        self.assertIn("--prefix", self.refused("--prefix", "a-b"))
        self.assertIn("--profile", self.refused("--profile", "disc"))
        self.assertIn("ellipsoid", self.refused(SCENES / "ellipse.toml"))
        self.refused(SCENES / "paper.toml", "--profile", "cone")

    @unittest.skipUnless(COMPILER, "no C compiler")
    def test_two_headers_in_one_program(self):
        with tempfile.TemporaryDirectory() as folder:
            for prefix, profile in (("left", "hertz"), ("right_2", "cone")):
                words = [word for ending in ("h", "inp", "table") for word in ("--write", f"{folder}/{prefix}.{ending}")]
                program("law", "--profile", profile, "--prefix", prefix, *words)
                self.assertIn(f"NAME={prefix.upper()}_ELEMENT_1", Path(f"{folder}/{prefix}.inp").read_text())
                self.assertIn(f"\n{prefix.upper()}_TWIST\n", Path(f"{folder}/{prefix}.table").read_text())
            Path(folder, "two.c").write_text(
                '#include <stdio.h>\n#include "left.h"\n#include "right_2.h"\n'
                'int main(void) { printf("%.17g %.17g\\n", left_law_moment(0.1), right_2_law_moment(0.1)); return RIGHT_2_LAW_LIMIT < 0; }\n')
            subprocess.run([COMPILER, "-std=c99", "-Wall", "-Werror", "-Wno-unused-function", "two.c", "-o", "two", "-lm"],
                           cwd=folder, check=True)
            moments = subprocess.run([f"{folder}/two"], capture_output=True, text=True, check=True).stdout.split()
            for moment, profile in zip(moments, ("hertz", "cone")):
                exact = json.loads(program("exact", "--profile", profile, "--twist", 0.1, "--json", "-"))
                self.assertAlmostEqual(float(moment) / exact["moment"], 1, 5)

    def test_any_name(self):
        """Characters that close a comment or a text of a language, or begin an escape."""
        law = PackageLaw("hertz", limit_loads=3, units=Units(0.1, 1000.0, 5e-4, 4e10, 0.018))
        for name in ("a--b\\Nc\"", "--", "*/ int x; /*", "\\\n\r\t--->", "]]>&<a>", '\\"\\"\\"', "@LIMIT@ {{ law }} {} \u00e9"):
            law.name = name
            self.read(name, {ending: law.file(f"law.{ending}") for ending in ("h", "py", "table", "inp", "xml", "sdf")})
        with tempfile.TemporaryDirectory() as folder:
            files = {ending: Path(folder, f"law.{ending}") for ending in ("h", "py", "table", "inp", "xml", "sdf")}
            program("law", SCENES / "paper.toml", "--set", f"name={json.dumps(name)}",
                    *(word for file in files.values() for word in ("--write", file)))
            self.read(name, {ending: file.read_text() for ending, file in files.items()})

    def read(self, name, texts):
        for ending in ("xml", "sdf"):
            xml.etree.ElementTree.fromstring(texts[ending])
        module(texts["py"])
        self.assertTrue(all(re.match(r"\*|[-\d]", line) for line in texts["inp"].splitlines()), name)
        lammps_rows(texts["table"])
        if COMPILER:
            words = [COMPILER, "-std=c99", "-Werror", "-fsyntax-only", "-xc", "-"]
            subprocess.run(words, input=texts["h"], text=True, check=True)

    def test_keeps_its_inputs(self):
        with tempfile.TemporaryDirectory() as folder:
            table = Path(folder) / "p.csv"
            text = "radius,pressure\n" + "".join(f"{i / 20},{1 - (i / 20)**2}\n" for i in range(21))
            table.write_text(text)
            self.assertIn("would overwrite", self.refused("--profile", f"file:{table}", "--write", table))
            self.assertEqual(table.read_text(), text)
