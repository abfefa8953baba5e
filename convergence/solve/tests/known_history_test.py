"""known_history_test.py PROGRAM: contacts whose tractions are known from pressures, or from other loads or another path."""

import itertools
import json
from pathlib import Path

import numpy as np

from program_run import SHORT_SCENE, ProgramTest
from same_answer_test import RADIUS, SAME, SPHERE, on_grid

FRICTION, NORMAL, ALONG = 0.1, 1000.0, (0.6, 0.8)
TIGHT = "solver.tolerance=1e-13"
# Two bodies with nu = 0 in an ellipse's contact at an angle to the grid, pushed along (0.6, 0.8) and not turned.
PUSHED = SHORT_SCENE.replace("poisson_ratio = 0.3", "poisson_ratio = 0.0").replace(
    SPHERE, 'shape = "ellipsoid"\nradius_1 = 0.0288\nradius_2 = 0.0126\nangle = 0.5\n')
ON_GRID = ("grid.cells=[24, 24]", "grid.extent=[1.8e-3, 1.8e-3]", TIGHT)
# Steps to parts of the load W and of the force mu W; after some of them the tractions as a sum of
# (factor, load, force): first loading by the force under the load (Cattaneo, Mindlin).
PATHS = {
    "Masing's rule: slip starts again at the edge, against twice the friction": (
        ((1, 0.8), (1, 0.3), (1, -0.5), (1, -0.8), (1, 0.1), (1, 0.8)),
        {1: ((1, 1, 0.8), (-2, 1, 0.25)), 2: ((1, 1, 0.8), (-2, 1, 0.65)), 3: ((-1, 1, 0.8),),
         4: ((-1, 1, 0.8), (2, 1, 0.45)), 5: ((1, 1, 0.8),)}),
    "a greater cycle erases smaller ones": (
        ((1, 0.7), (1, 0.2), (1, 0.5), (1, 0.3), (1, 0.7), (1, -0.1), (1, -0.7)),
        {2: ((1, 1, 0.7), (-2, 1, 0.25), (2, 1, 0.15)), 4: ((1, 1, 0.7),), 5: ((1, 1, 0.7), (-2, 1, 0.4)), 6: ((-1, 1, 0.7),)}),
    # Mindlin and Deresiewicz 1953
    "more pressure moves nothing; a later push slips at the new edge first, over what had stuck": (
        ((0.6, 0.4), (1, 0.4), (1, 0.55), (1, 0.9)),
        {1: ((1, 0.6, 0.4),), 2: ((1, 0.6, 0.4), (1, 1, 0.15)), 3: ((1, 1, 0.9),)}),
    "a smaller load slips forward: only where it ends counts": (
        ((1, 0.4), (0.7, 0.4), (0.45, 0.4)), {1: ((1, 0.7, 0.4),), 2: ((1, 0.45, 0.4),)}),
}
SHAKEN = [{"moment_ratio": ratio, "force": force} for ratio, force in
          zip((0.6, -0.2, 0.5, 0.0), ([20, 30], [60, -10], [-30, -30], [10, 0]))]

MODULUS = 0.5 * 210e9 / (1 - 0.3**2)  # E* of the pair
STEP = RADIUS / 10
TURNED = 'shape = "ellipsoid"\nradius_1 = 0.036\nradius_2 = 0.0108\nangle = 0.5\n'
ROUGH = (f'shape = [{{shape = "sphere", radius = 0.018}}, {{shape = "roughness", seed = 3, hurst = 0.8, rms_slope = 0.01, '
         f'longest = {16 * STEP}, shortest = {4 * STEP}, period = {32 * STEP}}}]\n')
PATCHES = ('combine = "nearest"\nshape = [{shape = "sphere", radius = 0.018, at = [-5e-4, %s]}, '
           '{shape = "sphere", radius = %s, at = [5e-4, %s]}]\n')
BODIES = {SPHERE: (), TURNED: (), 'shape = "flat_punch"\nradius = 5e-4\ninner_radius = 2e-4\n': (),
          'shape = "cone"\nslope = 0.02\n': (), PATCHES % (0, 0.018, 0): ("grid.extent=[2.2e-3, 1.6e-3]",),
          PATCHES % (-1e-4, 0.006, 2e-4): ("grid.extent=[2.2e-3, 1.6e-3]",)}
MAX_APPLICATIONS = 60  # on the finest grid, of any load's solve


class KnownHistory(ProgramTest):
    def history(self, text, steps, *settings):
        """The result, and of each step its numbers and its fields over the grid."""
        rows = ("{" + ", ".join(f"{key} = {value}" for key, value in step.items()) + "}" for step in steps)
        sets = itertools.chain(*(("--set", setting) for setting in (TIGHT, *settings, f"step=[{', '.join(rows)}]")))
        self.run_program("solve", self.write("scene.toml", text), *sets, "--quiet", "--json", "r.json",
                         "--fields", "step{step}.csv")
        result = json.loads(Path("r.json").read_text())
        columns = (np.genfromtxt(f"step{k + 1}.csv", delimiter=",", names=True) for k in range(len(steps)))
        fields = [{name: on_grid(result, step, name) for name in ("pressure", "q1", "q2", "slip1")} for step in columns]
        return result, result.get("steps", [result]), fields

    def assert_near(self, one, other, tolerance, scale=None):
        self.assertLessEqual(np.abs(np.subtract(one, other)).max(), tolerance * np.abs(other if scale is None else scale).max())

    def carried(self, load):
        """mu p under a part of W."""
        if load not in self.pressures:
            _, _, fields = self.history(PUSHED, [{"normal": load * NORMAL, "moment_ratio": 0}], *ON_GRID)
            self.pressures[load] = FRICTION * fields[0]["pressure"]
        return self.pressures[load]

    def pushes(self, parts):
        return [{"normal": load * NORMAL, "twist": 0.0, "force": [part * force * FRICTION * NORMAL for part in ALONG]}
                for load, force in parts]

    def test_along_a_line(self):
        """K11 = K22 = K33 and K12 = 0, so a history is a sum of pressures p(W): where p(W) > 0, K p(W) + h is the approach;
        elsewhere it exceeds it, the less so the larger W is."""
        self.pressures = {0.0: 0.0}
        found = {}
        for why, (parts, known) in PATHS.items():
            _, found[why], fields = self.history(PUSHED, self.pushes(parts), *ON_GRID)
            for step, terms in known.items():
                size = sum(factor * (self.carried(load) - self.carried(round(load - force, 9)))
                           for factor, load, force in terms)
                for name, part in zip(("q1", "q2"), ALONG):
                    self.assert_near(fields[step][name], part * size, SAME, self.carried(1))
        masing, _, rises, falls = found.values()
        for steps, step, factor in ((masing, 5, 1.0), (masing, 3, -1.0), (rises, 1, 1.0)):
            self.assert_near(steps[step]["displacement"], factor * np.array(steps[0]["displacement"]), SAME)
        self.assertLessEqual(abs(rises[1]["dissipated"]), SAME * rises[0]["dissipated"])
        self.assertLess(falls[2]["contact_cells"], falls[0]["contact_cells"] - 20)
        steps = ", ".join(f"{{normal = {s['normal']}, twist = 0, force = {s['force']}}}"
                          for s in self.pushes(((1, 0.5), (0.6, 0.5), (0.45, 0.5))))
        sets = itertools.chain(*(("--set", setting) for setting in (*ON_GRID, f"step=[{steps}]")))
        self.run_program("solve", self.write("scene.toml", PUSHED), *sets, code=2,
                         says=("step[2].force", "0.9 times these", "along (0.6, 0.8)"))

    def test_first_loading_of_any_body(self):
        """q = mu (p(W) - p((1 - f) W)) along the force, and a motion of mu times the difference of the approaches (Ciavarella
        1998, Jaeger 1998)."""
        for surface in (SPHERE, TURNED, ROUGH):
            text = SHORT_SCENE.replace(SPHERE, surface).replace("poisson_ratio = 0.3", "poisson_ratio = 0.0")
            extent = f"grid.extent=[{32 * STEP}, {32 * STEP}]"
            _, (whole,), (pressed,) = self.history(text, [{"normal": NORMAL, "moment_ratio": 0}], extent)
            _, (less,), (least,) = self.history(text, [{"normal": 0.4 * NORMAL, "moment_ratio": 0}], extent)
            _, (step,), (fields,) = self.history(text, self.pushes([(1, 0.6)]), extent)
            expected = FRICTION * (pressed["pressure"] - least["pressure"])
            self.assertGreaterEqual(expected.min(), 0.0)  # pressure grows with the load everywhere
            moved = FRICTION * (whole["approach"] - less["approach"])
            for k, part in enumerate(ALONG):
                self.assert_near(fields[("q1", "q2")[k]], part * expected, SAME, expected)
                self.assert_near(step["displacement"][k], part * moved, SAME)
            self.assertEqual(step["stick_cells"], less["contact_cells"])

    def pressed(self, surface, *settings):
        """The numbers, the pressure and the cells' positions of a contact that nothing turns."""
        result, (step,), (fields,) = self.history(SHORT_SCENE.replace(SPHERE, surface), [{"moment_ratio": 0}], *settings)
        along = ((np.arange(n) - (n - 1) / 2) * h for n, h in zip(result["cells"], result["cell_size"]))
        return step, fields["pressure"], *np.meshgrid(*along, indexing="ij")

    def test_contacts_of_several_bodies(self):
        """Curvatures add up. Each of two equal spheres has half the load and its contact radius a; the pressure of the other
        lowers the surface by W/(2 pi E* D) and tilts it by W/(2 pi E* D^2), next terms (a/D)^2."""
        extent = "grid.extent=[1e-3, 1e-3]"
        spheres = 'shape = [{shape = "sphere", radius = 0.018%s}, {shape = "sphere", radius = 0.018%s}]\n'
        _, expected, *_ = self.pressed('shape = "sphere"\nradius = 0.009\n', extent)
        self.assert_near(self.pressed(spheres % ("", ""), extent)[1], expected, SAME)
        a = np.cbrt(0.75 * 0.5 * NORMAL * 0.018 / MODULUS)
        distance, mesh = 8 * a, 1 / 12**2
        apart = spheres % (f", at = [{-distance / 2}, 0]", f", at = [{distance / 2}, 0]")
        step, pressure, x1, x2 = self.pressed('combine = "nearest"\n' + apart, "grid.cells=[128, 30]",
                                              f"grid.extent=[{128 * a / 12}, {30 * a / 12}]")
        right = np.where(x1 > 0, pressure, 0) / pressure.sum()
        self.assertAlmostEqual(right.sum(), 0.5, delta=1e-14)
        centre = (right * x1).sum() / right.sum()
        square_1, square_2 = ((right * square).sum() / right.sum() for square in ((x1 - centre)**2, x2**2))
        self.assertAlmostEqual(np.sqrt(5) * (square_1 * square_2)**0.25 / a, 1.0, delta=mesh)
        sunk = 0.5 * NORMAL / (np.pi * MODULUS * distance)
        self.assertGreater(sunk, 5 * mesh * a**2 / 0.018)
        self.assertAlmostEqual(step["approach"] / (a**2 / 0.018 + sunk), 1.0, delta=mesh)
        shift = 0.018 * sunk / distance
        self.assertAlmostEqual((centre - distance / 2) / shift, 1.0, delta=0.1)  # to (a/D)^2 and the mesh

    def test_an_annulus_sinks_in_as_its_capacity_says(self):
        """Smythe (1951), within 0.1 %; circles made of squares are off by a part of a cell."""
        outer, ratio = 5e-4, 0.6
        step, pressure, x1, x2 = self.pressed(f'shape = "flat_punch"\nradius = {outer}\ninner_radius = {ratio * outer}\n',
                                              "grid.cells=[96, 96]")
        r = np.hypot(x1, x2)
        self.assertTrue(((pressure > 0) == ((r >= ratio * outer) & (r <= outer))).all())
        self.assert_near(step["normal_load"], NORMAL, 1e-12)
        stiffness = 2 / np.pi * (np.arccos(ratio) + np.sqrt(1 - ratio**2) * np.arctanh(ratio)) * (
            1 + 0.0143 / ratio * np.tan(1.28 * ratio)**3)
        self.assertLess(stiffness, 1 / 1.03)
        self.assertAlmostEqual(step["approach"] * 2 * MODULUS * outer * stiffness / NORMAL, 1.0, delta=1 / 96)

    def test_next_to_gross_slip_and_next_to_none(self):
        """Both are as easy as any other load. Next to none everything sticks but cells with a tiny bound, and a bonded contact
        is linear: half the load, half of everything."""
        for (surface, settings), (force, moment) in itertools.product(BODIES.items(), ((1, 0), (0, 1), (1, 1))):
            def solved(part):
                loads = {"moment": part * moment * 0.7 * RADIUS, "force": [part * force, 0.3 * part * force]}
                step, fields = (found[-1] for found in self.history(
                    SHORT_SCENE.replace(SPHERE, surface).replace("moment_ratio = 0.5\n", ""), [loads], *settings,
                    "solver.tolerance=1e-8")[1:])
                self.assertLessEqual(step["operator_applications"], MAX_APPLICATIONS)
                self.assertLessEqual(min(step["certificate"]["gap"], step["certificate"]["energy_error"]), 1.1e-8)
                for key in ("moment", "force", "friction_bound"):
                    self.assertLessEqual(step["certificate"][key], 1e-12, (surface, key))
                return step, np.array([fields["q1"], fields["q2"]])

            limit = solved(1)[0]["limit"]["factor"]
            for missing in (2e-4, 1e-4, 1e-5, 1e-6):
                self.assertLessEqual(solved(limit * (1 - missing))[0]["certificate"]["gap"], 1.1e-8)
            _, larger = solved(1e-8 * limit)
            for part in (1e-10, 1e-12):
                step, least = solved(part * limit)
                self.assertLessEqual(np.linalg.norm(1e-8 / part * least - larger), 1e-8 * np.linalg.norm(larger))
                self.assertLessEqual(step["certificate"]["energy_error"], 1e-16)

    def test_little_friction_between_dissimilar_bodies_ends_as_it_says(self):
        """They slip nearly everywhere under their pressure: doubles cannot represent tractions to a smaller gap."""
        for friction in (1e-12, 1e-9, 1e-6):
            sets = ("--set", f"contact.friction={friction}", "--set", "lower={young_modulus=70e9,poisson_ratio=0.33}")
            self.run_program("solve", self.write("scene.toml", SHORT_SCENE), *sets, "--json", "r.json",
                             code=0 if friction > 1e-10 else 1, says="" if friction > 1e-10 else "rounding")
            certificate = json.loads(Path("r.json").read_text())["certificate"]
            self.assertEqual(min(certificate["gap"], certificate["energy_error"]) <= 1e-8, friction > 1e-10)
            self.assertLessEqual(certificate["moment"], 1e-12)
            self.assertLessEqual(certificate["gap"], max(1e-8, certificate["rounding"]))

    def test_a_step_that_changes_nothing(self):
        for force in ([0, 0], [30, -20]):
            _, steps, fields = self.history(SHORT_SCENE, 2 * [{"moment_ratio": 0.6, "force": force}], "grid.cells=[24, 24]")
            for name in ("q1", "q2"):
                self.assert_near(fields[1][name], fields[0][name], SAME)
            self.assert_near(fields[1]["slip1"], 0.0, SAME, fields[0]["slip1"])
            self.assert_near(steps[1]["twist_angle"], steps[0]["twist_angle"], SAME)
            self.assertLessEqual(abs(steps[1]["dissipated"]), SAME * steps[0]["dissipated"])

    def test_by_another_way_to_the_same_loads(self):
        """Steps on the part of the grid that each needs equal steps on the whole grid, and imposed motions, which count from
        the first step, equal the loads that they cause."""
        loads = [{"moment_ratio": ratio, "normal": NORMAL * load}
                 for ratio, load in zip((0.5, 0.3, -0.6, 0.2), (0.5, 1, 0.4, 0.8))]
        part = self.history(SHORT_SCENE, loads, "grid.cells=[28, 28]")
        full = self.history(SHORT_SCENE, loads, "grid.cells=[28, 28]", "solver.model=full")
        loaded = self.history(SHORT_SCENE, SHAKEN, "grid.cells=[20, 20]")
        motions = [{"twist": step["twist_angle"], "displacement": step["displacement"]} for step in loaded[1]]
        moved = self.history(SHORT_SCENE, motions, "grid.cells=[20, 20]")
        for (_, steps, fields), (_, other_steps, other_fields), same in ((full, part, 1e-7), (moved, loaded, SAME)):
            for step, other, at, other_at in zip(steps, other_steps, fields, other_fields):
                self.assert_near([at["q1"], at["q2"]], [other_at["q1"], other_at["q2"]], same)
                for key in ("twist_angle", "dissipated"):
                    self.assert_near(step[key], other[key], same)
        for step, other in zip(moved[1], loaded[1]):
            self.assert_near(step["displacement"], other["displacement"], 1e-12)

    def test_the_stick_radius_is_that_of_the_path(self):
        def ends_at(count, reverses):
            ratios = [0.8 * i / count for i in range(1, count + 1)]
            ratios += [0.8 - 1.6 * i / count for i in range(1, count + 1)] if reverses else []
            return self.history(SHORT_SCENE, [{"moment_ratio": ratio} for ratio in ratios], "grid.cells=[64, 64]")[0]

        once = ends_at(1, False)["stick_radius"]
        for count, reverses in itertools.product((2, 4, 16), (False, True)):
            self.assertLessEqual(abs(ends_at(count, reverses)["stick_radius"] - once), 0.05 * 2 * RADIUS / 60)

    def test_the_same_loop_a_thousand_times(self):
        loop = "step=[{moment_ratio = 0.8}, {moment_ratio = -0.8}]"
        self.run_program("solve", self.write("scene.toml", SHORT_SCENE), "--set", "grid.cells=[14, 14]", "--set", loop,
                         "--set", "cycles=500", "--set", "solver.tolerance=1e-10", "--quiet", "--json", "r.json")
        steps = json.loads(Path("r.json").read_text())["steps"]
        self.assertEqual((len(steps), steps[-1]["cycle"]), (1000, 500))
        twists, dissipated = (np.array([step[key] for step in steps]).reshape(500, 2) for key in ("twist_angle", "dissipated"))
        self.assertAlmostEqual(twists[-1, 0] / twists[-1, 1], -1.0, delta=1e-3)
        self.assert_near(twists[2:] / twists[1], 1.0, SAME)
        self.assert_near(dissipated[2:].sum(1) / dissipated[1].sum(), 1.0, SAME)
