"""stress_files_test.py PROGRAM: stresses below the surface of a solve on a grid, in files and in the result."""

import csv
import json
import math
import re
import sys
from pathlib import Path

import numpy as np

from program_run import SCENES, SHORT_SCENE, ProgramTest

NAMES = ("s11", "s22", "s33", "s12", "s13", "s23")
SPHERE = SHORT_SCENE.replace("moment_ratio = 0.5", "moment_ratio = 0.9")
RADIUS, PEAK, FRICTION = 0.48909732465087485e-3, 1995.9553043899548e6, 0.1  # Hertz


def table(file):
    with open(file) as stream:
        rows = list(csv.DictReader(stream))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def volume(file):
    """Coordinates, and each field by x3, x2 and x1."""
    data = Path(file).read_bytes()
    start = data.index(b"_", data.index(b"<AppendedData")) + 1
    header = data[:start].decode()
    axes = [np.array(re.search(f'Name="{name}"[^>]*>([^<]*)<', header)[1].split(), float) for name in ("x1", "x2", "x3")]
    fields = {}
    for name, offset in re.findall(r'Name="(\w+)" format="appended" offset="(\d+)"', header):
        at = start + int(offset)
        size = int.from_bytes(data[at:at + 8], sys.byteorder)
        fields[name] = np.frombuffer(data, np.float32, size // 4, at + 8).reshape([len(axis) for axis in reversed(axes)])
    return *axes, fields


def tensors(cells):
    s11, s22, s33, s12, s13, s23 = (cells[name] for name in NAMES)
    return np.moveaxis(np.array([[s11, s12, s13], [s12, s22, s23], [s13, s23, s33]]), 2, 0)


class StressFiles(ProgramTest):
    def solved(self, text, depths, *options, file="s{depth}.csv", **expected):
        self.write("scene.toml", text)
        said = self.run_program("solve", "scene.toml", "--quiet", "--json", "r.json", "--stresses", file, "--depths", depths,
                                *options, **expected)
        return said if expected else json.loads(Path("r.json").read_text())["stresses"]

    def exact(self, cells, depth, rows):
        """Of the rows' cells, by `exact` in polar components; its axis points out of the body."""
        radius = np.hypot(cells["x1"][rows], cells["x2"][rows])
        at = [word for r in radius for word in ("--at", f"{r / RADIUS:.17g},{depth / RADIUS:.17g}")]
        self.run_program("exact", "--moment-ratio", "0.9", "--friction", str(FRICTION), "--poisson", "0.3", *at, "--json", "e.json",
                         "--quiet")
        points = json.loads(Path("e.json").read_text())["stresses"]
        cosine, sine = cells["x1"][rows] / radius, cells["x2"][rows] / radius
        rr, tt, zz, rz, rt, tz = (np.array([point[f"sigma_{key}"] for point in points]) for key in ("rr", "tt", "zz", "rz", "rt", "tz"))
        rt, tz = FRICTION * rt, FRICTION * tz
        return PEAK * np.array([rr * cosine**2 + tt * sine**2 - 2 * rt * cosine * sine,
                                rr * sine**2 + tt * cosine**2 + 2 * rt * cosine * sine, zz,
                                (rr - tt) * cosine * sine + rt * (cosine**2 - sine**2),
                                -rz * cosine + tz * sine, -rz * sine - tz * cosine])

    def error(self, cells, depth, step):
        """Largest of all components over every step-th cell, over the peak pressure."""
        rows = np.arange(0, len(cells["x1"]), step)
        return np.abs(np.array([cells[name][rows] for name in NAMES]) - self.exact(cells, depth, rows)).max() / PEAK

    def test_the_yield_stress_is_compared_with_the_largest_stress(self):
        text = SPHERE.replace("[lower]", "[lower]\nyield_stress = 3e9", 1)
        self.write("scene.toml", text)
        self.run_program("solve", "scene.toml", "--stresses", "s.csv", "--depths", "0.2 mm", "--json", "r.json",
                         says="times the yield stress")
        found = json.loads(Path("r.json").read_text())["stresses"]
        self.assertAlmostEqual(found["yield_ratio"], found["von_mises"]["value"] / 3e9, 14)

    def test_a_sphere_has_its_exact_stresses_with_order_two_below_a_cell(self):
        """Over all doublings: how the grid cuts the contact's edge changes the error of a mesh, and the order of two meshes."""
        depth = 0.4 * RADIUS
        errors = []
        for n in (32, 64, 128, 256):
            self.solved(SPHERE, repr(depth), "--set", f"grid.cells=[{n},{n}]")
            errors.append(self.error(table("s1.csv"), depth, n * n // 300 | 1))
        self.assertLess(errors[0], 1e-3)
        self.assertGreater(math.log2(errors[0] / errors[-1]) / 3, 1.8, errors)

    def test_the_result_has_the_largest_stresses_of_all_files(self):
        """Of a contact under force and moment, with units and depths in no order."""
        text = SHORT_SCENE.replace("[grid]", "force = [30, 10]\n[grid]")
        result = self.solved(text, "0.2 mm,1e-4,40um,3e-4")
        self.assertEqual(result["body"], "lower")
        np.testing.assert_allclose(result["depths"], [2e-4, 1e-4, 4e-5, 3e-4], rtol=1e-15)
        found = {"von_mises": [], "tresca": [], "tension": []}
        for number, depth in enumerate(result["depths"], 1):
            cells = table(f"s{number}.csv")
            principal = np.linalg.eigvalsh(tensors(cells))
            low, middle, high = principal.T
            mises = np.sqrt(((high - middle)**2 + (middle - low)**2 + (high - low)**2) / 2)
            np.testing.assert_allclose(cells["von_mises"], mises, rtol=1e-9)
            for key, values in (("von_mises", mises), ("tresca", high - low), ("tension", high)):
                at = values.argmax()
                found[key].append((values[at], (cells["x1"][at], cells["x2"][at], depth)))
        for key, largest in found.items():
            value, place = max(largest)
            self.assertLess(abs(result[key]["value"] / value - 1), 1e-9, key)
            np.testing.assert_allclose(result[key]["at"], place, rtol=1e-12, err_msg=key)

    def test_shear_acts_with_the_opposite_sign_on_the_upper_body(self):
        """The elastic body is the lower one, then the upper one: the sum of both stresses is twice that of the pressure."""
        soft, rigid = "young_modulus = 210e9\npoisson_ratio = 0.3\n", "rigid = true\n"
        head, lower, tail = SHORT_SCENE.partition("[lower]\n" + soft)
        scenes = {"lower": head.replace(soft, rigid) + lower + tail, "upper": head + "[lower]\n" + rigid + tail}

        def stresses(body, moment_ratio):
            result = self.solved(scenes[body], "1e-4", "--set", "contact.coupling=none", "--set", "grid.extent=[1.1e-3, 1.1e-3]",
                                 "--set", f"load.moment_ratio={moment_ratio}", file="s.csv")
            self.assertEqual(result["body"], body)
            cells = table("s.csv")
            return np.array([cells[name] for name in NAMES])

        twisted = [stresses(body, 0.5) for body in scenes]
        pressed = stresses("lower", 0)
        np.testing.assert_allclose(sum(twisted), 2 * pressed, rtol=0, atol=1e-9 * np.abs(pressed).max())
        self.assertGreater(np.abs(twisted[0] - pressed).max(), 0.01 * np.abs(pressed).max())

    def test_a_volume_has_the_stresses_of_all_depths(self):
        """In any order of depths, which are equal in ratios and over the radius of Hertz."""
        result = self.solved(SPHERE, "2e-4,0.1a..0.4a:3", file="s.vtr")
        depths = np.array([2e-4, 0.1 * RADIUS, 0.2 * RADIUS, 0.4 * RADIUS])
        np.testing.assert_allclose(result["depths"], depths, rtol=1e-11)
        x1, x2, x3, fields = volume("s.vtr")
        np.testing.assert_array_equal(x3, np.sort(result["depths"]))
        self.solved(SPHERE, ",".join(map(repr, result["depths"])))
        for number, depth in enumerate(result["depths"], 1):
            cells = table(f"s{number}.csv")
            at = np.ix_([np.flatnonzero(x3 == depth)[0]], range(len(x2)), range(len(x1)))
            self.assertEqual(list(cells["x1"][:len(x2)]), [x1[0]] * len(x2))
            for name in (*NAMES, "von_mises"):
                np.testing.assert_allclose(fields[name][at][0].T.ravel(), cells[name], rtol=1e-6, atol=1e-7 * PEAK, err_msg=name)
            self.assertEqual(list(cells["x2"][:len(x2)]), list(x2))

    def test_the_figure_names_the_largest_stress(self):
        result = self.solved(SPHERE, "0.1a..1a:8", "--stress-figure", "s.svg", file="s.vtr")
        text = Path("s.svg").read_text()
        self.assertIn(f"{result['von_mises']['value'] / 1e6:.4g} MPa", text)
        self.assertIn(f"{result['von_mises']['at'][2] * 1e6:.3g} µm", text)
        self.assertIn("with a volume", self.solved(SPHERE, "1e-4", "--stress-figure", "s.svg", file="s.csv", code=2))

    def test_bad_input_is_refused(self):
        for depths in ("0", "-1e-4", "nan", "inf", "1e-4 Pa", "deep", "a", "0a", "1um..-1um:3"):
            self.assertIn("allowed: depths above zero", self.solved(SHORT_SCENE, depths, code=2))
        for number in ("", "1", "2.5", "x", "1e9"):
            self.assertIn("FROM..TO:N with", self.solved(SHORT_SCENE, "1um..2um:" + number, file="s.vtr", code=2))
        for depths, file, message in (("1e-4,2e-4", "s.csv", "{depth}"), ("1e-4,2e-4", "s{depth}.png", ".vti"),
                                      ("1e-4,1e-4", "s.vtr", "each depth once"), ("1e-4", "s{depth}.vtr", "without {depth}")):
            self.assertIn(message, self.solved(SHORT_SCENE, depths, file=file, code=2))
        self.assertIn("is the file of --fields", self.solved(SHORT_SCENE, "1e-4", "--fields", "./s.csv", file="s.csv", code=2))
        self.assertIn("not known before the solve", self.run_program("solve", SCENES / "cone.toml", "--stresses", "s.csv",
                                                                     "--depths", "0.4a", code=2))
        self.assertIn("slipstick exact --at", self.solved(SHORT_SCENE, "1e-4", "--model", "exact", code=2))
        self.assertIn("without a layer", self.run_program("solve", SCENES / "coated_sphere.toml", "--stresses", "s.csv",
                                                         "--depths", "1e-4", code=2))
