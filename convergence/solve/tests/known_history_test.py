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
PUNCH = SHORT_SCENE.replace(SPHERE, 'shape = "flat_punch"\nradius = 5e-4\n').replace("friction = 0.1", "friction = 0.3")
NOTHING = 1e-8  # the part of earlier tractions and motions that rounding leaves
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

    def test_parts_of_a_step_end_as_steps_that_are_written_out(self):
        def pushed(*forces, settings=()):
            return self.history(SHORT_SCENE, [{"moment_ratio": 0, "force": list(force)} for force in forces], "grid.cells=[24, 24]",
                                *settings)[1][-1]

        parts = pushed((50, 0), (30, 20), settings=("solver.substeps=2",))
        written = pushed((25, 0), (50, 0), (40, 10), (30, 20))
        self.assert_near(parts["displacement"], written["displacement"], 1e-12)
        self.assertGreater(parts["dissipated"], written["dissipated"])  # of both parts, not of the last one
        sets = ("--set", "solver.substeps=8", "--set", "solver.max_iterations=3", "--set", "load.force=[50, 0]")
        self.run_program("solve", self.write("scene.toml", SHORT_SCENE), *sets, "--json", "r.json", code=1, says="part 1 of 8")
        broken = json.loads(Path("r.json").read_text())
        for key in ("twist_angle", "moment", "displacement", "force", "work"):
            self.assertIsNone(broken[key], key)

    def test_nothing_is_left_where_all_stuck(self):
        """There the answer is linear in the load; a part leaves that part. A punch sticks up to 300 N."""
        def pushed(force, least, *settings):
            return self.history(PUNCH, [{"moment_ratio": 0, "force": [each, 0]} for each in (force, least)], *settings)[1:]

        for force, left in itertools.product((1, 30, 120), (0, 1e-5)):
            (first, last), fields = pushed(force, left * force)
            self.assertEqual(first["stick_cells"], first["contact_cells"])
            self.assert_near(fields[1]["q1"], left * fields[0]["q1"], NOTHING, fields[0]["q1"])
            self.assertAlmostEqual(last["displacement"][0] / first["displacement"][0], left, delta=NOTHING)
            self.assertAlmostEqual(last["certificate"]["energy"] / first["elastic_energy"], 1, delta=NOTHING)
        # What is left of the energy is hardly above the rounding of the energy before.
        for part in (1.255e-4, 1.842e-4, 2.012e-4, 3e-4, 4.319e-4, 5.439e-4):
            (_, last), _ = pushed(1, part, "grid.cells=[24, 24]", "solver.tolerance=1e-8")
            self.assertLessEqual(last["certificate"]["gap"], 1e-8)

    def test_nothing_is_left_of_the_normal_load(self):
        """Tractions that stay meet Coulomb's law under the load that stays, over an energy that this load can hold."""
        for load in (1, 1e-4):
            _, (first, last), _ = self.history(PUNCH, [{"moment_ratio": 0.4}, {"normal": load, "moment_ratio": 0}],
                                               "solver.tolerance=1e-8")
            self.assertLessEqual(last["certificate"]["friction_bound"], NOTHING)
            self.assertLessEqual(abs(last["moment"]), NOTHING * last["moment_limit"])
            most = max(last["elastic_energy"], 1e-3 * load * first["elastic_energy"])
            self.assertLessEqual(last["certificate"]["energy"], most)

    def test_one_cell_of_dissimilar_bodies_does_not_push_itself_aside(self):
        result, (step,), (fields,) = self.history(
            SHORT_SCENE, [{"moment_ratio": 0, "normal": 1}], "lower.young_modulus=70e9", "upper.at=[1e-4, 1e-4]",
            "grid.cells=[16, 16]", "grid.extent=[0.0032, 0.0032]")
        self.assertEqual((step["contact_cells"], np.abs(fields["q1"]).max(), step["certificate"]["gap"]), (1, 0, 0))
        self.assertEqual((result["slip_direction"]["mean"], result["slip_direction"]["max"]), (None, None))

    def test_loads_that_a_step_leaves_out_stay_in_the_second_cycle_too(self):
        """To the bits of the steps written out."""
        loop, load = [{"moment_ratio": 0.1}, {"normal": 700, "force": [0, 0]}], ("load.force=[30, 0]", "solver.tolerance=1e-8")
        cycles = self.history(SHORT_SCENE, loop, *load, "cycles=2")[1]
        fields = [np.genfromtxt(f"step{k}.csv", delimiter=",", names=True) for k in (1, 2, 3, 4)]
        written = self.history(SHORT_SCENE, 2 * loop, *load)[1]
        for k, (one, other) in enumerate(zip(cycles, written, strict=True)):
            self.assertEqual(one["twist_angle"], other["twist_angle"])
            again = np.genfromtxt(f"step{k + 1}.csv", delimiter=",", names=True)
            for name in ("q1", "q2"):
                np.testing.assert_array_equal(fields[k][name], again[name])
        self.assertAlmostEqual(cycles[2]["normal_load"], 700, delta=1e-6)
        third, second = (self.history(SHORT_SCENE, (2 * loop)[:n], *load)[0]["slip_direction"]["mean"] for n in (3, 2))
        self.assertIsNone(third)  # nothing changes, so nothing slips
        self.assertLessEqual(second, 1e-3)

    def test_a_last_digit_costs_nothing(self):
        """A scene with one leaves out as much of the grid as without it, and has the same twist."""
        def solved(*settings):
            return self.history(SHORT_SCENE, [{"moment_ratio": 0.5}], *settings)[0]

        plain = solved()
        parts = [part["what"] for part in plain["model"]["left_out"]]
        self.assertEqual(len(parts), 5)  # coupling, translations, the grid's rim, three quarters, one field
        for change in ("lower.poisson_ratio=0.30000000000000004", "upper.at=[1e-17, 0]", "load.force=[1e-300, 0]",
                       "upper.young_modulus=210000000000.0001"):
            changed = solved(change)
            self.assertAlmostEqual(changed["twist_angle"] / plain["twist_angle"], 1, delta=1e-10)
            self.assertLessEqual(set(parts), {part["what"] for part in changed["model"]["left_out"]}, change)
        self.assertNotEqual(solved("load.force=[1e-7, 0]")["force"][0], 0)
        self.assertEqual(solved("solver.model=full", "load.force=[1e-300, 0]")["model"]["left_out"], [])

    def test_loads_beyond_the_limit_are_refused_with_it(self):
        """The limit in numbers, where a factor of the loads would be 1. A moment ratio is that of the limit without a force."""
        moved = ("upper.at=[2.445e-4, -3.424e-4]", "grid.cells=[40, 40]", "grid.extent=[1.956e-3, 1.956e-3]", "load.moment=0.0317")
        for settings, *says in ((("load.moment_ratio=0", "load.force=[125, 0]"), "load.force = [125, 0] N", "0.8 times these: [",
                                 "along (1, "),
                                (("load.moment_ratio=0", "load.force=[100.0000001, 0]"), "[99.99999"),
                                (("load.moment_ratio=0.9", "load.force=[90, 0]"), "load.force", "turning about ("),
                                (moved, "load.moment = ", "turning about (0.0002445, -0.0003424) m")):
            sets = itertools.chain(*(("--set", setting) for setting in settings))
            said = self.run_program("solve", self.write("scene.toml", SHORT_SCENE), *sets, code=2, says=says)
            self.assertNotIn(" 1 times", said)
        # No force in one direction is too large where the other motion is imposed.
        (free,), (pushed,), (held,) = (self.history(SHORT_SCENE, [step])[1] for step in (
            {"moment_ratio": 0.5}, {"moment_ratio": 0.5, "force": [55, 23]}, {"twist": 1e-3, "force": [99, 0]}))
        self.assertAlmostEqual(held["force"][0], 99, delta=1e-9)
        self.assertAlmostEqual(pushed["moment_limit"] / free["moment_limit"], 1, delta=SAME)
        self.assertAlmostEqual(pushed["moment"] / (0.5 * pushed["moment_limit"]), 1, delta=1e-12)
        self.assertTrue(1 < pushed["limit"]["factor"] < free["limit"]["factor"])

    def test_masings_rule_under_a_constant_bound(self):
        """Back to the load's negative the tractions turn over."""
        _, (first, back), fields = self.history(SHORT_SCENE, [{"moment_ratio": 0.7}, {"moment_ratio": -0.7}],
                                                "contact.friction_law=tresca", "contact.shear_strength=8e7")
        self.assertTrue(0 < first["stick_cells"] < first["contact_cells"])
        for name in ("q1", "q2"):
            self.assert_near(fields[1][name], -fields[0][name], SAME)
        self.assertAlmostEqual(back["twist_angle"] / first["twist_angle"], -1, delta=SAME)

    def test_a_law_without_friction_carries_no_moment(self):
        """A moment that nothing carries is refused, and none is not."""
        np.savetxt("none.csv", np.zeros((32, 32)), delimiter=",")
        np.savetxt("one.csv", np.arange(1024).reshape(32, 32) == 500, delimiter=",")
        none = "contact.friction=0"
        for settings in ((none,), (none, "contact.friction_law=capped", "contact.shear_strength=8e7"),
                         (none, "contact.friction_law=power", "contact.friction_exponent=0.5"),
                         ("contact.friction_map=none.csv",), ("contact.friction_map=one.csv",)):
            sets = itertools.chain(*(("--set", each) for each in (*settings, "step=[{moment_ratio = 0}, {moment_ratio = 0.7}]")))
            self.run_program("solve", self.write("scene.toml", SHORT_SCENE), *sets, code=2,
                             says=("step[1].moment_ratio", "no moment"))
            self.history(SHORT_SCENE, [{"moment_ratio": 0}], *settings)
            _, (turned,), _ = self.history(SHORT_SCENE, [{"twist": 1e-3}], *settings)
            self.assertEqual(turned["twist_angle"], 1e-3)
            self.assertAlmostEqual(turned["moment"], 0, delta=1e-12)

    def test_a_compliant_layer_is_winklers_foundation(self):
        """p = (approach - gap)/c, and each cell turns by itself up to its friction; the bodies give way by 1e-4 of that. With
        a^2 = 2 R delta the load is pi R delta^2/c."""
        compliance, reach, part = 1e6 * RADIUS * 4 * 1.3 / 210e9, 0.1 * 0.018, 1e-4
        approach = reach**2 / (2 * 0.018)
        load = {"normal": np.pi * 0.018 * approach**2 / compliance, "twist": 0.5 * FRICTION * approach / reach}
        layer = [f"layer.{key}_compliance={compliance}" for key in ("normal", "tangential")]
        result, (step,), (fields,) = self.history(SHORT_SCENE, [load], "layer.kind=winkler", *layer, "solver.tolerance=1e-8",
                                                  f"grid.extent=[{2.4 * reach}, {2.4 * reach}]")
        along = ((np.arange(n) - (n - 1) / 2) * h for n, h in zip(result["cells"], result["cell_size"]))
        x1, x2 = np.meshgrid(*along, indexing="ij")
        r = np.hypot(x1, x2)
        pressure = np.maximum(step["approach"] - r**2 / 0.036, 0) / compliance
        expected = np.minimum(step["twist_angle"] * r / compliance, FRICTION * pressure)
        self.assertAlmostEqual(step["approach"] / approach, 1, delta=0.01)  # cells of the edge
        for name, right in (("pressure", pressure), ("q1", -expected * x2 / r), ("q2", expected * x1 / r)):
            self.assert_near(fields[name], right, part)
        self.assertTrue(0 < step["stick_cells"] < step["contact_cells"])
        sets = itertools.chain(*(("--set", each) for each in ("layer.kind=winkler", *layer)))
        self.run_program("solve", "scene.toml", *sets, code=2, says="grid.extent = (missing)")

    def test_a_bonded_layer_makes_a_contact_between_those_on_base_and_layer(self):
        """The grid fits the softer of both."""
        def radius(*settings):
            sets = ("grid.cells=[96, 96]", "contact.coupling=none", *settings)
            words = itertools.chain(*(("--set", setting) for setting in sets))
            return self.result("solve", self.write("scene.toml", SHORT_SCENE), *words)["contact_radius"]

        on_base = radius()
        for thickness, modulus, ratio in ((0.02, 0.2, 0.5), (0.5, 0.1, 0.4), (0.3, 20, 0), (1, 3, -0.5)):
            material = f"young_modulus={modulus * 210e9}, poisson_ratio={ratio}"
            on_layer = radius(f"lower={{{material}}}")
            found = radius(f"lower.layer={{thickness={thickness * RADIUS}, {material}}}")
            self.assertTrue(0.99 * min(on_base, on_layer) < found < 1.01 * max(on_base, on_layer), (on_base, found, on_layer))
