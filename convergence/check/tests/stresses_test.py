"""stresses_test.py PROGRAM: verdicts of `slipstick check` on stresses below the surface. The right fields come from formulas, or from
`slipstick exact --at`, which its own tests hold against quadrature."""
import json
import math
import subprocess

import numpy as np

from checks import FOLDER, PROGRAM, CheckTest, also, example, ratio, run

NAMES = ("s11", "s22", "s33", "s12", "s13", "s23")
LOAD, FRICTION, POISSON = 1000.0, 0.1, 0.3  # of the paper's sphere, 18 mm on a half-space
RADIUS = (0.75 * LOAD * 0.018 * (1 - POISSON**2) * 2 / 210e9)**(1 / 3)  # Hertz
PEAK = 1.5 * LOAD / (math.pi * RADIUS**2)
SPHERE = example("paper")
PER_STEP = 1e-11  # of the program's numbers in text, over the largest


def points(count=60, reach=1.5, seed=7):
    """x1, x2, x3 (m), with each depth from the surface to the contact's radius and more."""
    at = np.random.default_rng(seed).uniform(-reach, reach, (count, 3)) * RADIUS
    at[:, 2] = np.abs(at[:, 2])
    return at


def exact(at, moment_ratio=0.9, friction=FRICTION, shear=1.0, poisson=POISSON):
    """Components of the sphere's lower body, by `exact`, whose axis points out of the body, in its axes r, theta, z."""
    radius, angle = np.hypot(at[:, 0], at[:, 1]), np.arctan2(at[:, 1], at[:, 0])
    words = [word for r, z in zip(radius, at[:, 2]) for word in ("--at", f"{r / RADIUS:.17g},{z / RADIUS:.17g}")]
    subprocess.run([PROGRAM, "exact", "--moment-ratio", str(moment_ratio), "--poisson", str(poisson), *words, "--json", FOLDER / "e.json",
                    "--quiet"], check=True)
    found = json.loads((FOLDER / "e.json").read_text())["stresses"]
    rr, tt, zz, rz, rt, tz = (np.array([each[f"sigma_{key}"] for each in found]) for key in ("rr", "tt", "zz", "rz", "rt", "tz"))
    polar = np.moveaxis(np.array([[rr, shear * friction * rt, -rz], [shear * friction * rt, tt, -shear * friction * tz],
                                  [-rz, -shear * friction * tz, zz]]), 2, 0)
    cosine, sine, zero = np.cos(angle), np.sin(angle), np.zeros(len(at))
    turn = np.moveaxis(np.array([[cosine, -sine, zero], [sine, cosine, zero], [zero, zero, zero + 1]]), 2, 0)
    return PEAK * components(turn @ polar @ turn.swapaxes(1, 2))


def components(tensors):
    return np.array([tensors[:, i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))])


def von_mises(stress):
    tensors = np.array([[stress[0], stress[3], stress[4]], [stress[3], stress[1], stress[5]], [stress[4], stress[5], stress[2]]])
    low, middle, high = np.linalg.eigvalsh(np.moveaxis(tensors, 2, 0)).T
    return np.sqrt(((high - middle)**2 + (middle - low)**2 + (high - low)**2) / 2)


AT = points()
STRESS = exact(AT)


def check(scene, at, stress, *options, names=NAMES, header=None):
    file = FOLDER / "stresses.csv"
    np.savetxt(file, np.column_stack([at, *stress]), "%.17g", ",", header=header or ",".join(("x1", "x2", "x3", *names)), comments="")
    return run("check", *scene, file, *options)


def changed(*factors):
    """The right stresses with factors of s11 ... s23."""
    return STRESS * np.array(factors)[:, None]


class Stresses(CheckTest):
    def good(self, *arguments, within=None, **keys):
        result = check(*arguments, **keys)
        self.assertEqual(result["verdict"], "good", result)
        if within is not None:
            self.assertLess(max(item["value"] for item in result["judged"]), within)
        return result

    def bad(self, *arguments, cause=None, **keys):
        result = check(*arguments, **keys)
        self.assertEqual(result["verdict"], "bad", result)
        if cause is not None:
            self.assertEqual(len(result["causes"]), 1, result["causes"])
            self.assertRegex(result["causes"][0], cause)
        return result

    # ------------------------------------------------------------ right stresses

    def test_exact_stresses_have_no_error(self):
        result = self.good(SPHERE, AT, STRESS, within=PER_STEP)
        self.assertEqual((result["right_answer"], result["right_answer_error"]), ("exact", 0.0))
        mises = von_mises(STRESS)
        at = AT[mises.argmax()].tolist()
        for key in ("von_mises", "right_von_mises"):
            self.assert_near(result[key]["value"], mises.max(), PER_STEP)
            self.assertEqual(result[key]["at"], at)

    def test_some_components_in_any_order_are_judged(self):
        rows = (5, 2, 0)
        result = self.good(SPHERE, AT, STRESS[list(rows)], names=[NAMES[row] for row in rows], within=PER_STEP)
        self.assertEqual({item["quantity"] for item in result["judged"]}, {NAMES[row] for row in rows})
        self.assertIsNone(result["von_mises"])
        self.bad(SPHERE, AT, 1.1 * STRESS[[2]], names=["s33"])

    def test_hertz_on_the_axis_is_right(self):
        """Huber's closed form; torsion adds nothing there."""
        depth = np.geomspace(0.01, 30, 40)
        zz = -1 / (1 + depth**2)
        rr = -(1 + POISSON) * (1 - depth * np.arctan(1 / depth)) - zz / 2
        zero = np.zeros_like(depth)
        at = np.column_stack([zero, zero, depth * RADIUS])
        self.good(SPHERE, at, PEAK * np.array([rr, rr, zz, zero, zero, zero]), within=1e-12)

    def test_far_away_the_stresses_are_those_of_a_point_force_and_a_point_moment(self):
        """Boussinesq's stresses, and the stresses of u_theta = M r/(4 pi G R^3), to the square of the contact's radius over the distance."""
        moment = run("solve", *also(SPHERE, "solver.model=exact"))["moment"]
        for distance in (20.0, 80.0):
            at = AT + [0, 0, 0.2 * RADIUS]
            at *= distance * RADIUS / np.linalg.norm(at, axis=1)[:, None]
            x, y, z = at.T
            R, r2 = np.linalg.norm(at, axis=1), x * x + y * y
            s, c = (1 - 2 * POISSON) / r2, (1 - z / R) / r2
            force = LOAD / (2 * math.pi) * np.array([
                s * (c * (x * x - y * y) + z * y * y / R**3) - 3 * z * x * x / R**5,
                s * (c * (y * y - x * x) + z * x * x / R**3) - 3 * z * y * y / R**5, -3 * z**3 / R**5,
                s * (2 * c - z / R**3) * x * y - 3 * z * x * y / R**5, -3 * x * z * z / R**5, -3 * y * z * z / R**5])
            turned = 3 * moment / (4 * math.pi * R**5) * np.array([2 * x * y, -2 * x * y, 0 * x, y * y - x * x, y * z, -x * z])
            self.good(SPHERE, at, force + turned, within=2 / distance**2)
            # Next to the right stresses of the pressure the stresses of the moment show: its share falls like 1/distance.
            pressed = exact(at, friction=0)
            share = max(item["value"] for item in check(SPHERE, at, pressed)["judged"])
            self.good(SPHERE, at, pressed + turned, within=2 / distance**2 * share)

    def test_the_surface_carries_pressure_and_traction(self):
        at = AT * [1, 1, 0]
        radius = np.hypot(*at.T[:2]) / RADIUS
        at, radius = at[radius < 0.99], radius[radius < 0.99]
        pressure = PEAK * np.sqrt(1 - radius**2)
        self.good(SPHERE, at, [-pressure], names=["s33"], within=1e-12)
        # All slips: q = mu p around the axis, and the traction on the surface is (-s13, -s23).
        slipping = also(SPHERE, ratio("0.99999999999"))
        unit = FRICTION * pressure / radius / RADIUS
        self.good(slipping, at[radius > 0.2], [(unit * at[:, 1])[radius > 0.2], (-unit * at[:, 0])[radius > 0.2]], names=["s13", "s23"],
                  within=1e-3)

    def test_histories_follow_masings_rule(self):
        """Unloading from M to -M: twice the first loading to M is taken off; here M = 0 by half of that branch."""
        steps = "step=[{normal=1000,moment_ratio=0.8},{normal=1000,moment_ratio=0.0}]"
        stress = exact(AT, 0.8) - 2 * (exact(AT, 0.4) - exact(AT, 0.4, friction=0))
        self.good(also(SPHERE, steps), AT, stress, within=PER_STEP)

    def test_the_upper_body_has_the_opposite_shear(self):
        stress = exact(AT, shear=-1.0)
        self.good(SPHERE, AT, stress, "--read-as", "body=upper", within=PER_STEP)
        self.bad(SPHERE, AT, stress, cause="torsion has the wrong sign, as in the other body")

    # ------------------------------------------------------------ conventions

    def test_other_units_and_an_axis_out_of_the_body_are_noted(self):
        out = [1, 1, 1, 1, -1, -1]
        for at, stress, note in ((AT * 1e3, STRESS, "positions in mm"), (AT, 1e-6 * STRESS, "stresses in MPa"),
                                 (AT * [1, 1, -1], changed(*out), "x3 points out of the body")):
            result = self.good(SPHERE, at, stress, within=PER_STEP)
            self.assertEqual(result["conventions"], [note])
            self.assertIn(note, self.bad(SPHERE, at, stress, "--strict")["why"])
        header = ",".join(["x1 [mm]", "x2 [mm]", "x3 [mm]", *(f"{name} [MPa]" for name in NAMES)])
        result = self.good(SPHERE, AT * 1e3, 1e-6 * STRESS, "--strict", header=header, within=PER_STEP)
        self.assertEqual(result["conventions"], [])

    # ------------------------------------------------------------ wrong stresses

    def test_each_mistake_is_named(self):
        pressure = exact(AT, friction=0)
        for row, name in enumerate(NAMES):
            flipped = np.ones(6)
            flipped[row] = -1
            self.bad(SPHERE, AT, changed(*flipped), cause=f"^{name} has the wrong sign$")
        for stress, cause in (
                (changed(1, 1, 1, 1, -1, -1), "x3 points out of the body"), (-STRESS, "compression is positive"),
                (changed(1, 1, 1, 2, 2, 2), "engineering shear"), (changed(1, 1, 1, 0.5, 0.5, 0.5), "halved"),
                (STRESS - pressure, "by the pressure is missing"), (pressure, "by the torsion is missing"),
                (STRESS[[0, 1, 2, 4, 3, 5]], "^s12 and s13 are exchanged"), (STRESS[[0, 1, 2, 3, 5, 4]], "^s13 and s23 are exchanged"),
                (STRESS[[0, 1, 2, 5, 4, 3]], "^s12 and s23 are exchanged"), (STRESS[[0, 1, 2, 4, 5, 3]], "^s12, s13, s23 are s13, s23, s12"),
                (STRESS[[1, 0, 2, 3, 4, 5]], "^s11 and s22 are exchanged"), (STRESS[[1, 0, 2, 3, 5, 4]], "axes are x2, x1, x3"),
                (2e-6 * STRESS, "^all stresses are 2 times"), (STRESS[[2, 1, 0, 5, 4, 3]], "axes are x3, x2, x1"), (1.3 * STRESS, "^all stresses are 1.3 times"),
                (changed(1, 1, 1.2, 1, 1, 1), "^s33 is 1.2 times"), (pressure + 0.7 * (STRESS - pressure), "by the torsion is 0.7 times"),
                (1.1 * pressure + 0.7 * (STRESS - pressure), "1.1 and 0.7 times")):
            self.bad(SPHERE, AT, stress, cause=cause)

    def test_another_poissons_ratio_and_polar_components_are_named(self):
        depth = np.geomspace(0.05, 3, 30)
        zz, zero = -1 / (1 + depth**2), np.zeros(30)
        rr = -(1 + 0.22) * (1 - depth * np.arctan(1 / depth)) - zz / 2
        axis = np.column_stack([zero, zero, depth * RADIUS])
        self.bad(SPHERE, axis, PEAK * np.array([rr, rr, zz, zero, zero, zero]), cause="Poisson's ratio is 0.22 in place of 0.3")
        on_x1 = np.column_stack([np.hypot(AT[:, 0], AT[:, 1]), 0 * AT[:, 1], AT[:, 2]])
        self.bad(SPHERE, AT, exact(on_x1), cause="components are polar")

    def test_the_stresses_of_the_other_body_are_named(self):
        scene = also(SPHERE, "upper.poisson_ratio=0.1", "contact.coupling=none")
        radius = RADIUS * (0.5 + 0.5 * (1 - 0.1**2) / (1 - POISSON**2))**(1 / 3)
        at = AT * radius / RADIUS  # the same places in the contact
        lower, upper = ((RADIUS / radius)**2 * exact(AT, poisson=poisson, shear=shear) for poisson, shear in ((POISSON, 1), (0.1, -1)))
        self.good(scene, at, lower, within=PER_STEP)
        self.good(scene, at, upper, "--read-as", "body=upper", within=PER_STEP)
        for stress, body in ((upper, "lower"), (lower, "upper")):
            self.bad(scene, at, stress, "--read-as", f"body={body}", cause="^the stresses are those of the other body$")

    def test_a_mistake_is_named_through_a_coarse_mesh(self):
        """Errors of 3 %, more than is allowed, hide no mistake; and no mistake is named where nothing explains the error."""
        scale = von_mises(STRESS).max()
        noise = 0.03 * scale * np.random.default_rng(2).uniform(-1, 1, STRESS.shape)
        self.bad(SPHERE, AT, changed(1, 1, 1, 2, 2, 2) + noise, cause=r"engineering.*\(then 3(\.\d)? % off\)")
        result = self.bad(SPHERE, AT, STRESS + noise)
        self.assertEqual(result["causes"], [])
        worst = max(result["judged"], key=lambda item: item["value"])
        row = NAMES.index(worst["quantity"])
        self.assert_near(worst["value"], np.abs(noise).max() / scale, 1e-9)
        self.assertEqual(worst["at"], AT[np.abs(noise[row]).argmax()].tolist())
        self.good(SPHERE, AT, STRESS + noise, "--tolerance", 0.031)

    # ------------------------------------------------------------ scenes without exact stresses

    def test_a_scene_without_exact_stresses_is_solved_and_its_error_stated(self):
        """A force too small to change anything takes the exact theory away, since Poisson's ratios are not 0."""
        deep = AT[AT[:, 2] > 0.15 * RADIUS]
        stress, errors = exact(deep), []
        for cells in (32, 64):
            result = self.good(also(example("paper", cells), "load.force=[1e-9,0]"), deep, stress, "--tolerance", 0.05)
            self.assertEqual(result["right_answer"], "solve")
            errors.append(result["right_answer_error"])
            self.assertLess(max(item["value"] for item in result["judged"]), errors[-1])
        self.assertLess(errors[1], errors[0] / 2)
        coarse = also(example("paper", 32), "load.force=[1e-9,0]")
        self.assertIn("nothing is wrong, but the right stresses", check(coarse, deep, stress, "--tolerance", errors[0] / 2))
        self.bad(coarse, deep, exact(deep, friction=0), cause="shear tractions is missing")

    def test_stresses_of_a_solve_are_read_back(self):
        """The path of this contact does not matter: its right stresses are the same sum."""
        scene = also(example("paper", 32), "upper.ends_at_grid_edge=true")
        file = FOLDER / "own.csv"
        run("solve", *scene, "--stresses", file, "--depths", "1.5e-4")
        result = run("check", *scene, file, "--tolerance", 0.05)
        self.assertEqual((result["verdict"], result["right_answer"], result["rows"]), ("good", "solve", 32**2), result)
        self.assertLess(max(item["value"] for item in result["judged"]), 1e-10)

    def test_the_error_of_a_history_has_that_of_its_parts(self):
        """At the same cells the stated error falls as the steps are parted; one part is off by no more than it."""
        file, errors = FOLDER / "own.csv", []
        for parts in (1, 16):
            scene = also(example("torsion_and_force", 48), f"solver.substeps={parts}")
            if parts == 1:
                run("solve", *scene, "--stresses", file, "--depths", "1.5e-4")
            result = run("check", *scene, file, "--tolerance", 0.05)
            errors.append(result["right_answer_error"])
            off = max(item["value"] for item in result["judged"])
            self.assertLess(off, errors[0])
        self.assertLess(errors[1], errors[0])
        self.assertGreater(off, 1e-4)

    # ------------------------------------------------------------ refusals

    def test_bad_input_is_refused(self):
        at = AT.copy()
        at[3, 2] = -at[3, 2]
        self.assertIn("row 4: x3 = ", check(SPHERE, at, STRESS))
        self.assertIn("allowed: depths, all of one sign", check(SPHERE, at, STRESS))
        broken = STRESS.copy()
        broken[2, 5] = np.nan
        self.assertIn(':7: "nan"; allowed: a finite number', check(SPHERE, AT, broken))
        self.assertIn("without a layer", check(example("coated_sphere"), AT, STRESS))
        self.assertIn("allowed of stresses: body=lower", check(SPHERE, AT, STRESS, "--read-as", "units=mm"))
        self.assertIn("has stresses below the surface", check(SPHERE, AT, STRESS, "--discrete"))
        self.assertIn("rigid", check(also(SPHERE, "lower.rigid=true"), AT, STRESS, "--read-as", "body=lower"))
        self.assertIn("a stress of 1e+200", check(SPHERE, AT, 1e200 * STRESS / np.abs(STRESS).max()))
        force = also(example("paper", 64), "load.force=[1e-9,0]")
        self.assertIn("a point has no stresses to compare with", check(SPHERE, 1e200 * AT, STRESS))
        self.assertIn("points are too far away", check(force, 1e200 * AT, STRESS))
        self.assertIn("above zero", check(force, AT * [1, 1, 0], STRESS))
        many = [np.tile(AT, (500, 1)), np.tile(STRESS[:1], 500)]
        self.assertIn("30000 rows, each a sum over", check(also(force, "grid.cells=[128,128]"), *many, names=["s11"]))
        self.assertIn("110000 rows; allowed: at most 100000", check(SPHERE, np.zeros((110000, 3)), np.zeros((1, 110000)), names=["s11"]))

