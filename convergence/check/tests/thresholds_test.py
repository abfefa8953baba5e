"""thresholds_test.py PROGRAM: a right field with one thing wrong by a known amount, just below and just above the amount that
docs/guides/verify-your-solver.md allows."""

import math

import numpy as np
from checks import CheckTest, also, check, example, exactly, judged, means, ratio, sampled, scaled, sizes, solve, solved

BELOW, ABOVE = 0.9, 1.1
SPHERE = example("paper")


def turned(rows, degrees):
    """Tractions turned by an angle in each cell."""
    q = (rows[:, 3] + 1j * rows[:, 4]) * np.exp(1j * np.radians(degrees))
    return np.column_stack([rows[:, :3], q.real, q.imag])


class Thresholds(CheckTest):
    """The paper's sphere on a coarse grid, with one error at a time."""
    def setUp(self):
        self.rows, self.solution = solve(SPHERE)
        self.h = self.solution["cell_size"][0]
        self.part = sizes(self.rows) / (0.1 * self.rows[:, 2])  # |q|/(mu p)
        self.slips = self.part > 1 - 1e-9
        white = np.floor(self.rows[:, :2] / self.h).sum(axis=1) % 2 == 0
        self.chessboard = np.where(white, 1, -1)

    def of_cells(self, number):
        return number / self.solution["contact_cells"]

    def yardstick(self, rows):
        return check(SPHERE, rows)["yardstick"]

    def allowed(self, rows, quantity, scene=SPHERE):
        return judged(check(scene, rows), quantity)["allowed"]

    def assert_threshold(self, quantity, allowed, within, made):
        """A field with an error a little below the allowed one holds, with one a little above it does not. made: the field with an
        error, whose value is known to `within`."""
        for times in (BELOW, ABOVE):
            item = judged(check(SPHERE, made(times * allowed)), quantity)
            self.assertAlmostEqual(item["value"], times * allowed, delta=within)
            self.assertEqual(item["holds"], times < 1, item)

    def test_loads_and_twist_by_the_quadrature(self):
        """A field that solves its own grid's problem is allowed 2/n, with n contact cells. Forces are parts of mu W, 100 N."""
        twist = self.solution["twist_angle"]
        for sign in (1, -1):
            below, above = (1 + sign * times * self.of_cells(2) for times in (BELOW, ABOVE))
            self.good(SPHERE, self.rows * [1, 1, below, below, below])
            self.bad(SPHERE, self.rows * [1, 1, above, above, above], says="^the normal load")
            self.good(SPHERE, solved(also(SPHERE, ratio(0.9 * below))))
            self.bad(SPHERE, solved(also(SPHERE, ratio(0.9 * above))), says="^the moment")
            self.good(SPHERE, self.rows, twist=below * twist)
            self.bad(SPHERE, self.rows, twist=above * twist, breaks=["twist"])
        scenes = [also(SPHERE, ratio(0.5), f"load.force=[{30 + times * 200 / self.solution['contact_cells']},20]")
                  for times in (0, BELOW, ABOVE)]
        self.good(scenes[0], solved(scenes[1]))
        self.bad(scenes[0], solved(scenes[2]), breaks=["force"])

    def test_contact_radius_by_one_cell(self):
        """It is proportional to the modulus to the power -1/3."""
        cell = self.h / exactly(SPHERE)["contact_radius"]
        for times in (BELOW, ABOVE, -BELOW, -ABOVE):
            modulus = 210e9 * (1 + times * cell)**-3
            rows = solved(also(SPHERE, f"grid.extent=[{32 * self.h!r},{32 * self.h!r}]",
                               *(f"{body}.young_modulus={modulus!r}" for body in ("upper", "lower"))))
            item = judged(check(SPHERE, rows), "contact_radius_error")
            self.assert_near(item["allowed"], cell, 1e-9)
            self.assertEqual(item["holds"], abs(times) < 1, item)

    def test_friction_bound_by_a_thousandth(self):
        """It is allowed in any one cell."""
        largest = np.arange(len(self.rows)) == sizes(self.rows).argmax()
        self.assert_threshold("friction_bound", 1e-3, 1e-6, lambda error: scaled(
            self.rows, np.where(largest, (1 + error) / self.part, 1)))

    def test_friction_by_a_thousandth_and_the_mesh(self):
        """The median of the ring is judged; the mesh is allowed twice the error of right fields."""
        allowed = self.allowed(self.rows, "friction")
        self.assertGreaterEqual(allowed, 1e-3)
        finer = example("paper", 64)
        self.assertAlmostEqual(self.allowed(solved(finer), "friction", finer), 1.1e-3, delta=0.1e-3)  # as in the guide
        self.assert_threshold("friction", allowed, 1e-6, lambda error: scaled(self.rows, np.where(self.slips, 1 - error, 1)))

    def test_slip_directions_by_a_tenth_of_a_degree_and_the_mesh(self):
        """A chessboard of turned tractions hardly moves the surface: slip stays where it was."""
        allowed = 0.1 + 2 * self.yardstick(self.rows)["slip_direction"]
        self.assertAlmostEqual(self.allowed(self.rows, "slip_direction"), allowed, delta=1e-6)
        self.assert_threshold("slip_direction", allowed, math.inf, lambda degrees: turned(
            self.rows, degrees * self.chessboard * self.slips))

    def test_slip_directions_by_the_angle_of_the_digits(self):
        """Two digits leave each component open by a part of 0.05: in the mean over |q|, sqrt(pi/2) times that as an angle, and
        twice. The rounding also counts as noise, of 0.003 at most."""
        result = self.good(SPHERE, self.rows, digits=[17, 17, 17, 2, 2])
        of_digits = math.degrees(0.05 * math.sqrt(0.5 * math.pi))
        left = judged(result, "slip_direction")["allowed"] - 0.1 - 2 * result["yardstick"]["slip_direction"]
        self.assertAlmostEqual(left / (2 * of_digits), 1.05, delta=0.1)

    def test_tractions_by_twice_what_right_fields_show(self):
        """A chessboard in stick cells meets no bound: the tractions are as far from the right ones as the test makes them."""
        right = check(SPHERE, self.rows)
        mesh = right["yardstick"]["mesh_error"]
        self.assertAlmostEqual(judged(right, "tractions")["allowed"], 2 * mesh, delta=1e-9)
        self.assertEqual(right["yardstick"]["distance"], judged(right, "tractions")["value"])
        board = self.chessboard * (self.part <= 0.8)
        unit = sizes(self.rows).sum() / np.abs(board).sum() * board
        self.assert_threshold("tractions", 2 * mesh, 0.018 * mesh, lambda part: self.rows + np.outer(part * unit, [0, 0, 0, 1, 0]))

    def test_gap_by_the_iterations_and_the_meshs(self):
        """Any iteration is allowed 1e-5, and the mesh twice what right fields show, at most 1e-3 with constant cells."""
        for pressure, cells in (("solved", 48), ("solved", 16), ("hertz", 16)):
            scene = example("paper", cells, f"contact.pressure='{pressure}'")
            result = check(scene, solved(scene))
            mesh = 2 * result["yardstick"]["gap"]
            self.assertEqual(result["yardstick"]["constant_cells"], pressure == "solved")
            self.assertAlmostEqual(result["discrete"]["allowed"], 1e-5, delta=1e-8)
            if pressure == "solved":
                (self.assertLess if cells == 48 else self.assertGreater)(mesh, 0.5e-3 if cells == 48 else 2e-3)
                mesh = min(mesh, 1e-3)
            self.assertAlmostEqual(judged(result, "gap")["allowed"], 1e-5 + mesh, delta=1e-8)

    def test_mesh_by_what_exact_fields_show(self):
        """The mesh error is the larger one of two right fields', samples at the cells' centres and means over the cells, here by 9 x 9
        parts of them. check measures it by a solve on cells a third as large; here the exact fields show it."""
        rows = sampled(SPHERE)
        parts = sampled(also(SPHERE, "grid.cells=[288,288]", f"grid.extent=[{32 * self.h!r},{32 * self.h!r}]"))
        averages = means(parts, self.h, 81)
        averages = averages[np.isin(averages[:, 0] + 1j * averages[:, 1], rows[:, 0] + 1j * rows[:, 1])]
        shown = [check(SPHERE, field) for field in (rows, averages)]
        for key, quantity, low, high in (("mesh_error", "tractions", 0.8, 1.2), ("gap", "gap", 0.8, 1.2),
                                         ("slip_direction", "slip_direction", 1, 2.5)):
            over = shown[0]["yardstick"][key] / max(judged(each, quantity)["value"] for each in shown)
            self.assertTrue(low <= over <= high, (key, over))

    def test_loads_by_what_exact_fields_miss(self):
        """Samples of an exact field miss a part of the normal load, and a force in parts of mu W; twice that is allowed."""
        scene = example("mindlin", 17)
        result = check(scene, sampled(scene))
        normal, force = np.prod(result["cell_size"]) * sampled(scene)[:, 2:4].sum(axis=0)
        self.assert_near(judged(result, "normal_load_error")["allowed"], 2 * abs(normal / 1000 - 1), 0.1)
        self.assert_near(judged(result, "force")["allowed"], 2 * abs(force - 60) / 100, 0.1)

    def test_noise_by_three_thousandths(self):
        """The upper quartile of a normal distribution says how much noise |q| has, up to 0.3 %."""
        for noise in (1e-3, 2e-3, 1e-2):
            factors = np.random.default_rng(3).normal(1, noise, len(self.rows))
            found = self.yardstick(scaled(self.rows, factors))["noise"]
            self.assert_near(found, *((3e-3, 1e-6) if noise > 3e-3 else (noise, 0.25)))
