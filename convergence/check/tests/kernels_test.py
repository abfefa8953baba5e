"""kernels_test.py PROGRAM: fields made with a wrong kernel, from influence coefficients that hard/audit.py integrates, and the
mistakes that `slipstick check` traces them to."""

import functools
import sys

import numpy as np
from checks import CHECK, LAWS, CheckTest, also, check, example, ratio, scaled, sizes, solve, solved

sys.path.insert(0, str(CHECK.parent / "hard"))
import audit  # noqa: E402

ELLIPSE, FINE, SPHERE, UNLIKE = example("ellipse", 24), example("ellipse"), example("paper", 20), example("dissimilar", 20)
POISSON = "Poisson's ratio is "
MIRRORED = "the cross kernel K12, odd in x1 and in x2, is mirrored as an even function"


def carry(q, bound, motion, moment, twist):
    """The tractions within the bound that are nearest to q + twist*motion, and the twist for which they carry the moment."""
    for _ in range(50):
        moved = q + twist * motion
        size = np.maximum(np.hypot(*moved), bound)
        factor = bound / size
        off = (motion * factor * moved).sum() - moment
        if abs(off) <= 1e-13 * abs(moment):
            break
        along = (factor < 1) * (motion * moved).sum(axis=0) / size
        twist -= off / (factor * ((motion**2).sum(axis=0) - along**2)).sum()
    return factor * moved, twist


def least_energy(stiffness, free, bound, motion, moment):
    """Coulomb's law under a moment, by accelerated projected gradients. free: displacements by the pressure."""
    step, start, twist = 1 / np.linalg.norm(stiffness, 2), 1, 0
    q = ahead = np.zeros_like(motion)
    for _ in range(5000):
        before = q
        down = (stiffness @ ahead.ravel()).reshape(2, -1) + free
        q, twist = carry(ahead - step * down, bound, motion, moment, twist)
        if np.abs(q - before).max() <= 1e-13 * bound.max():
            break
        if ((ahead - q) * (q - before)).sum() > 0:
            start = 1
        end = 0.5 * (1 + np.sqrt(1 + 4 * start**2))
        ahead, start = q + (start - 1) / end * (q - before), end
    return q


@functools.lru_cache(maxsize=None)
def made(scene, cross=lambda k12: k12, exchanged=False, poisson=1):
    """Rows of the scene's pressure, with tractions by another cross kernel, by K11 and K22 exchanged, or by nu/G times a factor."""
    rows, result = solve(scene)
    h = result["cell_size"]
    tables = audit.scene_of({"scene": str(scene[0]), "set": scene[2::2]}, scene[0].parent)
    kernels = audit.kernels(result["cells"], h, audit.compliances(tables) * [1, poisson, 1, 1])
    offset = [np.rint(np.subtract.outer(x, x) / size).astype(int) for x, size in zip(rows.T, h)]
    k = {name: np.fft.irfft2(kernel, [2 * n for n in result["cells"]])[offset[0], offset[1]] for name, kernel in kernels.items()}
    k12 = cross(k["12"])
    k11, k22 = (k["22"], k["11"]) if exchanged else (k["11"], k["22"])
    q = least_energy(np.block([[k11, k12], [k12, k22]]), np.array([k["13"] @ rows[:, 2], k["23"] @ rows[:, 2]]),
                     audit.friction_bound(tables["contact"], rows[:, 2], None), np.array([-rows[:, 1], rows[:, 0]]),
                     result["moment"] / np.prod(h))
    return np.column_stack([rows[:, :3], q.T])


def with_poissons_ratio(number):
    """The field of bodies with another Poisson's ratio and the same contact modulus E/(1 - nu^2)."""
    modulus = 210e9 * (1 - number**2) / (1 - 0.3**2)
    return solved(also(FINE, *(f"{body}.{key}={value!r}" for body in ("upper", "lower") for key, value in (
        ("young_modulus", modulus), ("poisson_ratio", number)))))


class Kernels(CheckTest):
    def diagnosis(self, scene, rows, cause="", found=None, within=5e-3, **keys):
        """cause: the kernel that is named, with its number."""
        diagnosis = check(scene, rows, **keys)["diagnosis"]
        self.assertIn(cause, diagnosis["kernel"] or "none")
        if found is not None:
            self.assert_near(float(diagnosis["kernel"].partition(cause)[2].split()[0]), found, within)
        return diagnosis

    def test_the_one_that_was_used_is_named(self):
        """Poisson's ratio of zero makes K11 and K22 wrong, too, but does not exchange them; that of unequal bodies is their mean."""
        for scene, field, cause, found, gap in (
                (ELLIPSE, {"cross": lambda k: 0 * k}, "the cross kernel K12 is missing", None, 1e-6),
                (ELLIPSE, {"cross": lambda k: -k}, "K12 has the wrong sign", None, 1e-6),
                (SPHERE, {"cross": lambda k: 0 * k}, "the cross kernel K12 is missing", None, 1),
                (SPHERE, {"cross": lambda k: -k}, "K12 has the wrong sign", None, 1),
                (ELLIPSE, {"cross": lambda k: -np.abs(k)}, MIRRORED, None, 1e-6), (ELLIPSE, {"cross": np.abs}, MIRRORED, None, 1e-6),
                (ELLIPSE, {"exchanged": True}, "the kernels K11 and K22 are exchanged", None, 1e-6),
                (UNLIKE, {"poisson": 0.5}, POISSON, 0.16, 1e-5), (UNLIKE, {"poisson": 1.4}, POISSON, 0.45, 1e-5)):
            with self.subTest(cause):
                diagnosis = self.diagnosis(scene, made(scene, **field), cause, found, 0.03)
                self.assertLessEqual(min(each["gap"] for each in diagnosis["tried"] if each["name"] == diagnosis["kernel"]), gap)
                self.assertGreater(diagnosis["as_it_should_be"]["gap"], 1e-3 if scene == ELLIPSE else 1e-4)
                self.assertIsNone(diagnosis["friction"])

    def test_poissons_ratio(self):
        """No body has one above 0.5."""
        for number in (0.1, 0.45):
            self.assertIn("instead of 0.3", self.diagnosis(FINE, with_poissons_ratio(number), POISSON, number)["kernel"])
        for scene in (UNLIKE, ELLIPSE):
            tried = self.diagnosis(scene, made(scene, poisson=1.8))["tried"]
            self.assertFalse(any(each["name"].startswith(POISSON) and "instead" in each["name"] for each in tried))

    def test_none_is_wrong_in_the_right_field(self):
        """A wrong twist makes the field bad."""
        for scene in (ELLIPSE, SPHERE, UNLIKE):
            result = self.good(scene, made(scene))
            self.assertTrue(result["discrete"]["holds"])
            diagnosis = self.diagnosis(scene, made(scene), twist=1.5 * result["twist_angle"])
            self.assertLessEqual(diagnosis["as_it_should_be"]["gap"], 1e-6)
            self.assertEqual((diagnosis["kernel"], diagnosis["friction"]), (None, None))

    def test_part_of_the_cross_kernel_where_the_mesh_leaves_tractions_open(self):
        """Under Tresca's law coarse meshes leave most of them open, though not to a program with this mesh's cells: its tractions are
        near the right ones, and a kernel other than the right one explains them."""
        scene = example("paper", 24, *LAWS["Tresca's law"], "grid.extent=[1.125e-3,1.125e-3]", ratio(0.7))
        self.good(scene, made(scene))
        for part in (0.7, 1.3):
            self.bad(scene, made(scene, lambda k: part * k), cause="the cross kernel K12 is multiplied by {}", found=part)

    def test_a_kernel_that_lowers_the_gap_to_a_tenth_is_named(self):
        """A missing cross kernel explains a field whose own was nearly missing. No other that is tried has an effect on a sphere in
        torsion, or is as near."""
        for left, is_named, lowered in ((0.065, True, 0.093), (0.074, False, 0.107)):
            diagnosis = self.diagnosis(SPHERE, made(SPHERE, lambda k: left * k))
            lowest = min(each["stick_gap"] for each in diagnosis["tried"])
            self.assertAlmostEqual(lowest / diagnosis["as_it_should_be"]["stick_gap"], lowered, delta=0.006)
            self.assertEqual(diagnosis["kernel"] is not None, is_named)

    def test_no_kernel_is_named_for_a_gap_that_an_iteration_leaves(self):
        """Any may leave a gap of the stick area of 1e-4 or less. The gap is proportional to the error of Poisson's ratio. A wrong
        twist makes the field bad."""
        start = self.diagnosis(FINE, with_poissons_ratio(0.3 + 5e-4), twist=1)["as_it_should_be"]["stick_gap"]
        for part, cause in ((0.93, "none"), (1.07, POISSON)):
            diagnosis = self.diagnosis(FINE, with_poissons_ratio(0.3 + 5e-4 * part * 1e-4 / start), cause, twist=1)
            self.assertAlmostEqual(diagnosis["as_it_should_be"]["stick_gap"], part * 1e-4, delta=0.03e-4)

    def test_cells_that_slip_up_to_the_tolerance_of_their_bound(self):
        """A cell has to stay below it by more than 1e-4 of it, to stick."""
        rows = made(ELLIPSE)
        slips = sizes(rows) >= (1 - 1e-6) * 0.1 * rows[:, 2]
        slipping = []
        for factor in (1, 1 - 0.9e-4, 1 - 1.1e-4):
            result = check(ELLIPSE, scaled(rows, np.where(slips, factor, 1)))
            slipping.append(result["contact_cells"] - result["stick_cells"])
        self.assertEqual(slipping[0], slipping[1])
        self.assertLess(slipping[2], 0.8 * slipping[0])
