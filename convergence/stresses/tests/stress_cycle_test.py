"""stress_cycle_test.py PROGRAM: parameters of fatigue over the last cycle of a history, and stresses of both bodies."""

import csv
import itertools
import json
import math
from pathlib import Path

import numpy as np

from program_run import SCENES, SHORT_SCENE, ProgramTest

NAMES = ("s11", "s22", "s33", "s12", "s13", "s23")
RADIUS, PEAK, FRICTION = 0.48909732465087485e-3, 1995.9553043899548e6, 0.1  # Hertz
DEPTH = 0.6 * RADIUS


def loop(*moments):
    steps = "".join(f"[[step]]\nmoment_ratio = {moment}\n" for moment in moments)
    return "cycles = 2\n" + SHORT_SCENE.replace("moment_ratio = 0.5\n", "").replace("[grid]", steps + "[grid]")


def table(file):
    with open(file) as stream:
        rows = list(csv.DictReader(stream))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def smallest_ball(points):
    """Centres and radii, of several sets of points."""
    center, radius = points[:, 0].copy(), np.full(len(points), np.inf)
    for size in (1, 2, 3, 4):
        for chosen in itertools.combinations(range(points.shape[1]), size):
            first, side = points[:, chosen[0]], points[:, chosen[1:]] - points[:, chosen[:1]]
            squares = side @ side.swapaxes(1, 2)
            half = np.diagonal(squares, axis1=1, axis2=2)[..., None] / 2
            through = first + (side.swapaxes(1, 2) @ (np.linalg.pinv(squares) @ half))[..., 0]
            far = np.linalg.norm(points - through[:, None], axis=2).max(axis=1)
            center[far < radius], radius = through[far < radius], np.minimum(far, radius)
    return center, radius


class StressCycle(ProgramTest):
    def solved(self, text, *options, file="s.csv", depth=DEPTH, **expected):
        self.write("scene.toml", text)
        said = self.run_program("solve", "scene.toml", "--quiet", "--json", "r.json", "--stresses", file, "--depths", repr(depth), *options,
                                **expected)
        return said if expected else json.loads(Path("r.json").read_text())["stresses"]

    def exact(self, at):
        """Stresses by pressure and torsion over p0, at 0.8 of the limit moment."""
        radius = math.hypot(*at[:2])
        self.run_program("exact", "--moment-ratio", "0.8", "--friction", str(FRICTION), "--poisson", "0.3", "--at",
                         f"{radius / RADIUS:.17g},{at[2] / RADIUS:.17g}", "--json", "e.json", "--quiet")
        return json.loads(Path("e.json").read_text())["stresses"][0]

    def test_a_moment_that_alternates_has_the_shear_stress_of_its_torsion_as_amplitude(self):
        """By Masing's rule both states have the tractions of first loading, with opposite signs; torsion has no hydrostatic part."""
        found = self.solved(loop(0.8, -0.8), "--dang-van", "0.3", "--set", "grid.cells=[128,128]")["fatigue"]
        self.assertEqual(found["states"], 2)
        dang_van = found["dang_van"]
        exact = self.exact(dang_van["at"])
        shear = PEAK * FRICTION * math.hypot(exact["sigma_rt"], exact["sigma_tz"])
        hydrostatic = PEAK * (exact["sigma_rr"] + exact["sigma_tt"] + exact["sigma_zz"]) / 3
        self.assertLess(abs(dang_van["shear"] / shear - 1), 2e-3)
        for name in ("hydrostatic_mean", "hydrostatic_largest"):
            self.assertLess(abs(dang_van[name] - hydrostatic), 1e-3 * PEAK, name)
        self.assertAlmostEqual(dang_van["value"], dang_van["shear"] + 0.3 * dang_van["hydrostatic_largest"], delta=1e-6 * PEAK)

    def test_a_repeated_state_has_no_amplitude(self):
        found = self.solved(loop(0.5, 0.5), "--dang-van", "0")["fatigue"]
        self.assertLess(found["dang_van"]["value"], 1e-7 * PEAK)
        self.assertNotIn("findley", found)

    def test_both_parameters_are_the_largest_of_all_cells(self):
        """A moment and a force alternate out of phase. The smallest ball is sought among all spheres through some states; planes are
        sampled at random."""
        loads = ((0.3, 40), (-0.3, 40), (-0.3, -40), (0.3, -40))
        steps = [f"[[step]]\nmoment_ratio = {moment}\nforce = [{force}, 0]\n" for moment, force in loads]
        text = SHORT_SCENE.replace("moment_ratio = 0.5\n", "").replace("[32, 32]", "[16, 16]")
        planes = []
        for last in range(1, 5):
            options = ("--findley", "0.25", "--dang-van", "0.3") if last == len(loads) else ()
            found = self.solved(text.replace("[grid]", "".join(steps[:last]) + "[grid]"), *options)
            cells = table("s.csv")
            s11, s22, s33, s12, s13, s23 = (cells[name] for name in NAMES)
            planes.append(np.moveaxis(np.array([[s11, s12, s13], [s12, s22, s23], [s13, s23, s33]]), 2, 0))
        states, found = np.moveaxis(np.array(planes), 0, 1), found["fatigue"]  # cells, states, 3, 3
        hydrostatic = np.trace(states, axis1=2, axis2=3) / 3
        deviators = states - hydrostatic[..., None, None] * np.eye(3)
        center = smallest_ball(deviators.reshape(-1, 4, 9))[0].reshape(-1, 1, 3, 3)
        principal = np.linalg.eigvalsh(deviators - center)
        dang_van = ((principal[..., 2] - principal[..., 0]) / 2 + 0.3 * hydrostatic).max(axis=1)
        self.assertLess(abs(found["dang_van"]["value"] / dang_van.max() - 1), 1e-8)

        def findley(normal):
            traction = states @ normal
            across = traction @ normal
            shear = smallest_ball(traction - across[..., None] * normal)[1]
            return shear, across.max(axis=1)

        best = -math.inf
        for normal in np.random.default_rng(1).normal(size=(300, 3)):
            shear, across = findley(normal / np.linalg.norm(normal))
            best = max(best, (shear + 0.25 * across).max())
        value = found["findley"]["value"]
        self.assertLess(best, value * (1 + 1e-5))
        self.assertLess(value, best * 1.03)
        at = found["findley"]["at"]
        cell = np.hypot(cells["x1"] - at[0], cells["x2"] - at[1]).argmin()
        for name, numbers in zip(("shear", "normal_stress"), findley(np.array(found["findley"]["normal"]))):
            self.assertLess(abs(numbers[cell] / found["findley"][name] - 1), 1e-8, name)

    def test_turned_over_the_lower_body_is_the_upper_one(self):
        """About x1 by 180 degrees: x2 and x3 change their signs, and the force on the other body is the opposite one."""
        text = (SCENES / "dissimilar.toml").read_text().replace("moment_ratio = 0.5", "moment_ratio = 0.4\nforce = [60, 0]")
        lower = text.replace("cells = [128, 128]", "cells = [32, 32]\nextent = [1.3e-3, 1.3e-3]")
        upper = lower.replace("210e9", "E").replace("70e9", "210e9").replace("E ", "70e9 ").replace("[60,", "[-60,")
        upper = upper.replace("poisson_ratio = 0.33", "poisson_ratio = 0.30").replace("poisson_ratio = 0.3\n", "poisson_ratio = 0.33\n", 1)
        stresses = []
        for case in (lower, upper):
            result = self.solved(case, file="{body}.csv")
            self.assertEqual((result["body"], result["upper"]["body"]), ("lower", "upper"))
            self.assertNotEqual(result["von_mises"]["value"], result["upper"]["von_mises"]["value"])
            stresses.append({})
            for body in ("lower", "upper"):
                stresses[-1][body] = np.array([table(f"{body}.csv")[name] for name in NAMES]).reshape(6, 32, 32)
        for one, other in (("lower", "upper"), ("upper", "lower")):
            turned = stresses[1][other][:, :, ::-1] * np.array([1, 1, 1, -1, 1, -1])[:, None, None]
            np.testing.assert_allclose(stresses[0][one], turned, rtol=0, atol=1e-6 * np.abs(turned).max())

    def test_bad_input_is_refused(self):
        for option in ("--dang-van", "--findley"):
            self.assertIn(f"{option}: allowed: a scene with a history", self.solved(SHORT_SCENE, option, "0.3", code=2))
            self.assertIn("-1", self.solved(loop(0.5, -0.5), option, "-1", code=2))
            self.assertIn("--checkpoint", self.solved(loop(0.5, -0.5), option, "0.3", "--checkpoint", "c.h5", code=2))
