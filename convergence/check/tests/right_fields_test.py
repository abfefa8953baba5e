"""right_fields_test.py PROGRAM: right fields are good, in any program's conventions, with the numbers of `slipstick solve`."""

import itertools

import numpy as np
from checks import (CHECK, FOLDER, LAWS, LAYERS, MPA, CheckTest, also, check, example, exactly, judged, means, ratio, sampled, scaled,
                    solve, solved)


class Right(CheckTest):
    def test_field_of_another_program(self):
        """Its makers would find the moment 2.3e-5 low, 7.7e-3 in L2, and the counted stick radius within a cell, 1/32."""
        right = 2.361048651456917e-3
        for twist in (right, None):
            result = self.good(example("paper"), CHECK / "fields/contact-64-0.9.csv", twist=twist)
            self.assertEqual(result["conventions"], [])
            self.assert_near(result["twist_angle"], right, 1e-6)
            self.assertAlmostEqual(result["moment_error"], -2.3e-5, delta=1e-6)
            self.assertAlmostEqual(result["traction_error"]["l2"], 7.7e-3, delta=1e-4)
            self.assertLessEqual(abs(result["stick_radius_counted_error"]), 1 / 32)
            self.assertLessEqual(result["certificate"]["gap"], 1e-6)

    def test_solutions_under_any_load(self):
        """Loads that do not say the moment, too: a twist, a force, displacements, friction in pressing only; and loads from full
        stick (a flat punch up to 0.849 of its limit) to nearly gross slip, and imposed motions beyond it."""
        for name, *load in (("paper", "load.twist=0.001"), ("paper", "load.twist=7e-3"), ("paper", "load.twist=2e-2"),
                            ("paper", "load.twist=3e-3", "load.displacement=[3e-6,0]"), ("paper", ratio(0.5), "load.force=[30,20]"),
                            ("off_centre", "load.twist=-0.001", "load.force=[0,20]"), ("ellipse", "load.twist=1e-3"),
                            ("ellipse", "load.twist=-1e-3", "load.force=[0,20]"),
                            ("ellipse", ratio(0.5), "load.displacement=[1e-7,0]"), ("imposed_displacement",), ("goodman",),
                            ("paper",), ("ellipse",), ("off_centre",), ("turned_ellipse",), ("flat_punch",), ("cone",),
                            ("rounded_punch",), ("annulus",), ("patches",), ("dissimilar",), ("mindlin",),
                            *((name, ratio(part)) for name in ("flat_punch", "paper") for part in (0.01, 0.5, 0.99, 0.999))):
            with self.subTest(name=name, load=load):
                scene = example(name, 32, *load)
                rows, solution = solve(scene)
                result = self.good(scene, rows)
                moved = np.hypot(*solution["displacement"])
                np.testing.assert_allclose(result["displacement"], solution["displacement"], atol=1e-4 * moved + 1e-12)
                self.assertAlmostEqual(result["moment"], solution["moment"], delta=1e-9 * solution["moment_limit"])
                self.assertEqual(result["contact_cells"], solution["contact_cells"])
                self.assertAlmostEqual(result["stick_cells"], solution["stick_cells"], delta=2 + 1e-2 * solution["stick_cells"])
                self.assertLessEqual(result["certificate"]["gap"], 1e-6)
                self.assertLessEqual(result["yardstick"]["distance"], 1e-3)
                self.assertFalse(result["yardstick"]["loads_scaled_down"])
                self.assertTrue(result["discrete"]["holds"], result["why"])
                self.assertEqual(result["conventions"], [])

    def test_has_the_errors_of_solve(self):
        """The exact solution stands where the body stands, not where the field's grid does: it may be off the origin."""
        for name, cells in (("paper", 24), ("paper", 33), ("paper", 64), ("off_centre", 48)):
            rows, solution = solve(example(name, cells))
            result = self.good(example(name, cells), rows, twist=solution["twist_angle"])
            within = 1e-9 if name == "paper" else 1e-6
            for keys, within in ((("traction_error", "l1"), within), (("pressure_error", "l1"), within), *(() if name != "paper" else (
                    (("twist_error",), 1e-12), (("moment_error",), 1e-12), (("contact_radius_error",), 1e-12),
                    (("stick_radius_error",), 1e-6), (("traction_error", "averaged", "l2"), 1e-9), (("pressure_error", "max"), 1e-9),
                    (("certificate", "gap"), 1e-10)))):
                found, right = result, solution
                for key in keys:
                    found, right = found[key], right[key]
                self.assertAlmostEqual(found, right, delta=within, msg=keys)

    def test_exact_fields(self):
        """Grids are fine enough for a pressure that changes within a cell or two, or too coarse for the slip ring, or pressure and
        gap are nearly as for constant cells: near no slip and near the limit, on fine grids."""
        for name, cells in (("paper", 32), ("paper", 64), ("cone", 32), ("mindlin", 32), ("rounded_punch", 64)):
            result = self.good(example(name, cells), sampled(example(name, cells)))
            self.assertLessEqual(result["traction_error"]["l2"], 1e-12)
        for name, cells, part in (("paper", 112, 0.99), ("paper", 128, 0.05), ("paper", 136, 0.05), ("paper", 136, 0.2),
                                  ("paper", 32, 0.1), ("paper", 64, 0.99), ("cone", 32, 0.6), ("cone", 64, 0.9)):
            scene = example(name, cells, ratio(part))
            self.good(scene, sampled(scene), twist=exactly(scene)["twist_angle"])

    def test_errors_of_tractions(self):
        """Exact samples differ from averages over cells only where the traction has an edge, and there less and less: by h^(1/2) in
        bands of width h. The errors of the regions add up."""
        l1, l2 = [], []
        for cells, factor in ((32, 1), (128, 1), (48, 1.01)):
            scene = example("paper", cells)
            error = check(scene, scaled(sampled(scene), factor))["traction_error"]
            for key in ("l1", "l2", "max"):
                self.assertAlmostEqual(error[key], factor - 1, delta=1e-12)
            parts = [error[part] for part in ("stick_edge", "contact_edge", "inside", "outside")]
            for part, has_edge in zip(parts, (True, True, False, False)):
                self.assertEqual(part["max"] > 1e-12, has_edge or factor > 1)
            whole = error["averaged"]
            self.assertAlmostEqual(sum(part["l1"] for part in parts), whole["l1"], delta=1e-12)
            self.assertAlmostEqual(np.hypot.reduce([part["l2"] for part in parts]), whole["l2"], delta=1e-12)
            self.assertEqual(max(part["max"] for part in parts), whole["max"])
            l1.append(whole["l1"])
            l2.append(whole["l2"])
        self.assertAlmostEqual(np.log(l1[0] / l1[1]) / np.log(4), 1.5, delta=0.25)
        self.assertAlmostEqual(np.log(l2[0] / l2[1]) / np.log(4), 1, delta=0.25)

    def test_two_questions(self):
        """Samples of the exact answer do not solve the grid's problem of constant cells: they are right within the mesh."""
        scene = example("paper", 48)
        for rows, discrete in ((solved(scene), True), (sampled(scene), False)):
            self.assertEqual(self.good(scene, rows)["discrete"]["holds"], discrete)
            self.assertEqual(check(scene, rows, "--discrete")["verdict"], "good" if discrete else "bad")

    def test_layers_on_cells_of_the_fields_own(self):
        """A layer's thickness and compliance are lengths."""
        for layer in LAYERS:
            rows = solved(example("paper", 32, *layer, ratio(0.5)))
            same, other = (self.good(example("paper", cells, *layer, ratio(0.5)), rows) for cells in (32, 48))
            self.assertTrue(other["discrete"]["holds"])
            self.assert_near(other["twist_angle"], same["twist_angle"], 1e-9)
            for item in same["judged"]:
                if not item["quantity"].endswith("_cell"):  # which one is worst is a matter of rounding
                    found = judged(other, item["quantity"])
                    self.assert_near(found["allowed"], item["allowed"], 1e-3)
                    self.assertAlmostEqual(found["value"], item["value"], delta=1e-6)
        coated = self.good(example("coated_sphere", 128), solved(example("coated_sphere", 64)))
        self.assertLessEqual(abs(coated["twist_error"]), 1e-2)

    def test_normal_contact_of_an_ellipse_is_judged_exactly(self):
        """Its tractions have no exact answer. With half the moduli the contact is larger by 2^(1/3)."""
        for scene in (example("ellipse"), example("turned_ellipse")):
            result = self.good(scene, solved(scene))
            self.assertLessEqual(abs(result["contact_radius_error"]), 1e-2)
            self.assertLessEqual(result["pressure_error"]["l1"], 3e-2)
            self.assertEqual([result["twist_error"], result["stick_radius_error"], result["traction_error"]["l1"]], [None] * 3)
            for text in (result["twist_error_reason"], result["stick_radius_error_reason"], result["text"]):
                self.assertIn("normal contact only", text)
            bad = self.bad(scene, solved(also(scene, "upper.young_modulus=105e9", "lower.young_modulus=105e9")))
            self.assert_off(bad, "contact_radius_error", 0.26)
            self.assertAlmostEqual(bad["contact_radius_error"], np.cbrt(2) - 1, delta=1e-2)

    def test_laws_of_friction(self):
        coulomb = solved(example("paper", 64, ratio(0.8)))
        for (law, settings), part in itertools.product(LAWS.items(), (0.3, 0.8, 0.9)):
            scene = example("paper", 64, *settings, ratio(part))
            result = self.good(scene, solved(scene))
            self.assertTrue(result["discrete"]["holds"])
            self.assertRegex(result["text"], f"(?s)^(?!.*(above mu p by|Coulomb: 0)).*{law}")
            self.assertNotIn("Coulomb", check(scene, coulomb)["text"].partition("likely")[0])

    def test_cells_that_the_edge_cuts_may_carry_a_part_of_the_strength(self):
        """The field has the means of a finer solve."""
        settings = (*LAWS["Tresca's law"], ratio(0.7), "grid.extent=[1.9564e-3,1.9564e-3]", "upper.at=[5.223e-5,-2.555e-5]")
        self.good(example("paper", 32, *settings), means(solved(example("paper", 96, *settings)), 1.9564e-3 / 32, 9))

    def test_empty_cells_do_not_matter(self):
        """A file may have any number of them, on any side."""
        scene = example("paper", 24, "load.twist=2e-3", "load.displacement=[0,0]")
        rows = solved(scene)
        right = check(scene, rows)["yardstick"]
        h = rows[1, 1] - rows[0, 1]
        for shift in ((7, 0), (-7, 0), (0, 7), (0, -7)):
            empty = (rows + [*np.multiply(shift, h), 0, 0, 0]) * [1, 1, 0, 0, 0]
            both = np.vstack([rows, empty])
            first = np.unique(np.rint(2 * both[:, :2] / h), axis=0, return_index=True)[1]
            found = self.good(scene, both[first][::-1])["yardstick"]
            for key in ("mesh_error", "gap", "slip_direction"):
                self.assert_near(found[key], right[key], 1e-3)

    def test_mesh_error_falls_like_h(self):
        """The answers on a field's mesh and on the finer one solve one problem."""
        for name in ("paper", "ellipse", "dissimilar"):
            coarse, fine = (self.good(example(name, cells), solved(example(name, cells)))["yardstick"]["mesh_error"]
                            for cells in (24, 72))
            self.assertLessEqual(coarse, 0.05)
            self.assertLessEqual(fine, coarse / 3)

    def test_digits(self):
        """Two digits cause a gap, of all columns or of some. It is within the part of the allowed gap that is due to digits; four
        times the mesh's gap is more than the rest. One digit of the pressure is a tenth up to a half of it."""
        fine = example("paper", 64)
        result = self.good(fine, solved(fine), digits=[17, 17, 2, 2, 2])
        gap = judged(result, "gap")
        self.assertLessEqual(abs(gap["value"]), gap["allowed"] - 4 * result["yardstick"]["gap"])
        rows = solved(example("paper"))
        for digits in ([17, 17, 2, 17, 17], [17, 17, 17, 2, 2]):
            own = self.good(example("paper"), rows, digits=digits)["discrete"]
            self.assertLessEqual(abs(own["gap"]), own["allowed"])
        self.good(example("paper"), rows, digits=[17, 17, 1, 17, 17])

    def test_noise(self):
        """Pressure and tractions have noise of 0.03 to 0.2 %."""
        for scene in (example("paper", 64, ratio(0.3)), example("paper", 32, ratio(0.6)), example("ellipse", 64, ratio(0.9))):
            for size in (3e-4, 1e-3, 2e-3):
                noise = np.random.default_rng(1).normal(1, size, solved(scene).shape)
                noise[:, :2] = 1
                self.assertFalse(self.good(scene, solved(scene) * noise)["discrete"]["holds"])

    def test_at_limits(self):
        """Next to the limit moment all samples slip up to rounding. A cell may carry next to nothing: the tolerance of the normal
        contact decides whether it touches. By the paper's method frozen directions fade with the mesh on a circle."""
        for part in ("0.9999", "0.99999", "0.999999"):
            rows, solution = solve(example("paper", 48, ratio(part)))
            self.good(example("paper", 48, ratio(part)), rows, twist=solution["twist_angle"])
        rows = solved(example("paper", 48))
        tiny = 1e-9 * rows[len(rows) // 2 + 15, 2]
        self.good(example("paper", 48), np.vstack([rows, [rows[0, 0], rows[1, 1] - 2 * rows[0, 1], tiny, 0, 0.5 * tiny]]))
        scene = example("paper", 48, "solver.method=paper")
        self.good(scene, solved(scene))

    def test_twist_against_the_moment(self):
        """A force has turned it. Without a moment its sign is that of rounding."""
        scene = example("unequal_patches", 64, "grid.cells=[64,40]", "load.force=[30,10]", ratio(-0.05))
        twist = solve(scene)[1]["twist_angle"]
        self.assertGreater(twist, 0)
        alone = example("paper", 32, ratio(0), "load.force=[30,10]")
        for scene, twist in ((scene, twist), (alone, 1e-19), (alone, -1e-19), (alone, 0)):
            self.assertEqual(self.good(scene, solved(scene), twist=twist)["conventions"], [])

    def test_friction_map(self):
        file = FOLDER / "map.csv"
        np.savetxt(file, np.repeat([[0.5], [1]], 16, axis=0) * np.ones(32), delimiter=",")
        plain = example("paper", 32, ratio(0.8))
        scene = also(plain, f'contact.friction_map="{file}"')
        self.good(scene, solved(scene))
        result = self.bad(scene, solved(plain))
        self.assertFalse(judged(result, "friction")["holds"] and judged(result, "friction_bound")["holds"])


class Conventions(CheckTest):
    def setUp(self):
        self.scene = example("ellipse")
        self.rows, solution = solve(self.scene)
        self.h = solution["cell_size"][0]

    def assert_notes(self, scene, rows, *notes):
        """A good field, and its conventions."""
        result = self.good(scene, rows)
        self.assertRegex("\n".join(result["conventions"]), "^" + "\n".join(f".*{note}.*" for note in notes) + "$")
        return result

    def test_same_numbers_in_any(self):
        base = check(self.scene, self.rows)
        far = self.rows + [40 * self.h, -20 * self.h, 0, 0, 0]
        place = rf"\({40 * self.h:.4g}, {-20 * self.h:.4g}\) m"
        turned = self.rows[:, [1, 0, 2, 4, 3]]
        for rows, *notes in (
                (np.random.default_rng(1).permutation(self.rows),), (scaled(self.rows, -1), "reversed"),
                (self.rows[:, [0, 1, 2, 4, 3]], "q1 and q2"), (turned, "axes"),
                # Turned by 90 degrees: read with axes exchanged, which is a mirror, the moment turns the other way.
                (turned * [-1, 1, 1, -1, 1], "axes", "reversed"), (self.rows * [1e3, 1e3, 1, 1, 1], "mm"), (self.rows * MPA, "MPa"),
                (self.rows * MPA * [1e3, 1e3, 1, 1, 1], "mm", "MPa"),
                (self.rows * [1e6, 1e6, 1e-9, 1e-9, 1e-9], "micrometres", "GPa"),
                (self.rows + [0.3 * self.h, -0.15 * self.h, 0, 0, 0],), (far, place), (far * [1e3, 1e3, 1, 1, 1], "mm", place)):
            with self.subTest(notes):
                result = self.assert_notes(self.scene, rows, *notes)
                for key in ("twist_angle", "moment", "normal_load", "stick_radius", "contact_radius"):
                    self.assert_near(result[key], base[key], 1e-8)
        self.assertIn("allowed", check(self.scene, self.rows * [1e3, 1e3, 3e-7, 3e-7, 3e-7]))

    def test_one_reversed_component_is_a_mistake(self):
        """No frame and no body explains it; all the rest is right. Under an imposed twist, too."""
        twisted = example("ellipse", 32, "load.twist=1e-3")
        for scene, signs, name in ((self.scene, [-1, 1], "q1"), (self.scene, [1, -1], "q2"), (twisted, [1, -1], "q2")):
            result = self.bad(scene, solved(scene) * [1, 1, 1, *signs])
            self.assertTrue(result["within_mesh"], result["why"])
            self.assertEqual((result["conventions"], len(result["mistakes"])), ([], 1))
            self.assertIn(name, result["mistakes"][0])
        self.assert_notes(twisted, scaled(solved(twisted), -1), "reversed")

    def test_stand_in_the_first_line_and_strict_takes_none(self):
        rows = self.rows * [1e3, 1e3, 1, -1, -1]
        self.assertRegex(self.good(self.scene, rows)["text"], "^good.*mm.*reversed")
        self.bad(self.scene, rows, "--strict", says="mm.*reversed")
        self.good(self.scene, self.rows, "--strict")

    def test_under_forces_and_off_the_origin(self):
        """Under a force a left-handed frame differs from the other body: it reverses only the moment; a body off the axis then stands
        on the other side of it, and is moved first. There may be only a force, along either axis. The contact's middle goes with
        the axes. Positions may be from the grid's corner."""
        for name, *moved in (("paper",), ("off_centre", "")):
            scene = example(name, 32, ratio(0.5), "load.force=[30,20]")
            self.assert_notes(scene, solved(scene) * [1, -1, 1, 1, -1], *moved, "left-handed")
        for force in ("load.force=[60,0]", "load.force=[0,60]"):
            scene = example("paper", 32, ratio(0), force)
            self.assert_notes(scene, solved(scene))
            self.assert_notes(scene, scaled(solved(scene), -1), "reversed")
        scene = example("ellipse", 32, "upper.at=[0,2e-4]")
        self.assert_notes(scene, solved(scene))
        self.assert_notes(scene, solved(scene)[:, [1, 0, 2, 4, 3]], "axes")
        rows, solution = solve(example("patches", 48))
        self.assert_notes(example("patches", 48), rows + [*(24 * h for h in solution["cell_size"]), 0, 0, 0], "corner")

    def test_few_digits(self):
        """Rounding is in the unit of the file."""
        base = check(self.scene, self.rows)
        for digits in (10, 6):
            result = self.good(self.scene, self.rows, digits=digits)
            self.assertAlmostEqual(result["stick_cells"], base["stick_cells"], delta=2)
            self.assertLessEqual(result["certificate"]["friction_bound"], 2e-5)
        pa, mpa = (self.good(self.scene, self.rows * unit, digits=3)["discrete"] for unit in (1, MPA))
        for key in ("gap", "allowed"):
            self.assert_near(mpa[key], pa[key], 1e-6)
        self.assertEqual(mpa["holds"], pa["holds"])


class Grid(CheckTest):
    """Where the cells of a file lie."""
    SIZE = np.array([5e-5, 7e-5])

    def setUp(self):
        self.scene = example("ellipse", 26, "grid.extent=[1.3e-3,0.91e-3]")
        self.rows = solved(self.scene)
        self.index = np.rint((self.rows[:, :2] - self.rows[:, :2].min(axis=0)) / self.SIZE).astype(int).T
        self.cells = [each.max() + 1 for each in self.index]

    def assert_grid(self, result, within):
        self.assertEqual(result["cells"], self.cells)
        np.testing.assert_allclose(result["cell_size"], self.SIZE, within)

    def test_is_found_from_positions_alone(self):
        """Their order, offset and count of digits do not matter: pressure and tractions are judged in each cell. Round numbers have no
        rounding. Cells and whole rows of cells may be missing. Patches may be far apart."""
        for digits in (17, 10, 4):
            moved = np.random.default_rng(3).permutation(self.rows) + [-7.1e-6, 3.3e-6, 0, 0, 0]
            self.assert_grid(self.good(self.scene, moved, digits=[digits, digits, 17, 17, 17]), 1e-3)
        for first in (0, 5e-6, -6e-5):
            self.assert_grid(check(self.scene, self.rows + [first, first, 0, 0, 0], digits=[7, 7, 17, 17, 17]), 1e-12)
        i, j = self.index
        end_i, end_j = (index.max() for index in (i, j))
        missing = (i % end_i > 0) & (j % end_j > 0) & ((i == 4) | ((i + 2 * j) % 5 == 0))
        self.assert_grid(self.bad(self.scene, self.rows[~missing], cause="the file lacks rows"), 1e-9)
        low, high = (i < 7) | (j < 2), (i > end_i - 7) | (j > end_j - 2)
        apart = self.rows + np.outer(high, [*(60 * self.SIZE), 0, 0, 0])
        self.assertEqual(check(self.scene, apart[low ^ high])["cells"], [cells + 60 for cells in self.cells])

    def test_the_row_that_does_not_fit_is_named(self):
        """One digit too many makes a grid of any size: the row is named before memory is taken for each cell. Columns in different
        units make long and thin cells."""
        few = self.rows[self.index[0] < 3]
        for rows, changes, words in (
                (self.rows, {(16, 0): self.rows[16, 0] + 1.5e-5}, "row 17.*x1 = "),
                (self.rows, {(30, 0): self.rows[3, 0], (30, 1): self.rows[3, 1]}, "row 31.*row 4"),
                (self.rows, {(5, 1): 3}, "row 6: x2 = 3"), (few, {}, "x1.*3.*4"),
                *((self.rows, {(33, 0): self.rows[33, 0] * factor}, "row 34.*x1.*allowed")
                  for factor in (-1e3, 1e3, 1e4, 1e5, 1e6, 1e9, 1e300)),
                *((self.rows * [factor, 1, 1, 1, 1], {}, r"row 1: \(.*allowed") for factor in (1e4, 1e9, 1e-4, 1e-9))):
            rows = rows.copy()
            for place, value in changes.items():
                rows[place] = value
            self.assertRegex(check(self.scene, rows), "field.csv.*" + words)
