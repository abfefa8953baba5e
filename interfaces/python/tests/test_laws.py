"""slipstick.laws: each form against the exact law, at points that no fit has seen."""
import unittest

import numpy as np
from slipstick import InputError, exact
from slipstick.law_fits import (Curve, LimitSurface, ParallelElements, TwistLaw, best_spring, fit_chebyshev, spring_error,
                                tabulate)

PROFILES = ("hertz", "cone", "flat_punch")


def twists_to(last, count):
    """From rest to a little short of the last one, spread evenly and, near either end, by powers."""
    part = (np.arange(count // 2) + 0.5) / (count // 2)
    return np.concatenate([last * part, last * 10.0**(-9 * part)])


def moment_ratio(law, twist):
    """m by the polynomials: l/t over t."""
    piece = np.clip(np.searchsorted(law.logarithm.ends, twist) - 1, 0, len(law.logarithm.pieces) - 1)
    found = np.empty_like(twist)
    for k, (low, high, coefficients) in enumerate(law.logarithm.pieces):
        at = twist[piece == k]
        found[piece == k] = np.polynomial.chebyshev.chebval((2 * at - low - high) / (high - low), coefficients)
    return -np.expm1(-twist * found)


class LawsTest(unittest.TestCase):
    def assert_largest(self, errors, stated, profile):
        """Whether a stated error is the largest that there is."""
        self.assertLessEqual(abs(errors).max(), stated * (1 + 1e-6), profile)
        self.assertGreaterEqual(abs(errors).max(), 0.9 * stated, profile)

    def test_polynomials_are_within_their_stated_error(self):
        cases = [(profile, *more) for profile in PROFILES for more in ((1e-6, 10000), (1e-2, 1000), (1e-10, 1000))]
        for profile, error, count in [*cases, ("rounded_punch:0.5", 1e-3, 50)]:
            law = TwistLaw(Curve(profile), error)
            twists = twists_to(law.last_twist, count)
            found = moment_ratio(law, twists) / exact.moment_ratio(twist=twists, profile=profile)
            self.assertLessEqual(abs(found - 1).max(), error, profile)

    def test_refuses_what_is_no_number(self):
        with np.errstate(invalid="ignore"):
            for f in (lambda x: np.where(abs(x - 0.3) < 0.02, np.nan, 1 + x), lambda x: np.nan * x):
                self.assertRaises(InputError, fit_chebyshev, f, [0.0, 1.0], 1e-3)
        for error in (0.0, 1e-12, 0.1, np.nan):
            self.assertRaises(InputError, TwistLaw, Curve("hertz"), error)

    def test_table_is_within_its_error_and_no_finer_than_that(self):
        for profile in PROFILES:
            for error in (1e-2, 1e-5):
                table = tabulate(Curve(profile), error)
                twists = twists_to(2 * table.twist[-1], 2000)
                m = np.interp(twists, table.twist, table.moment_ratio)
                self.assert_largest(m - exact.moment_ratio(twist=twists, profile=profile), error, profile)

    def test_elements_are_within_their_error_on_first_loading(self):
        twists = twists_to(1.0, 4000)
        for profile in PROFILES:
            for error in (0.1, 1e-2, 1e-4):
                stiffness, slip = ParallelElements(Curve(profile), error).each.T
                self.assertGreater(stiffness.min(), 0)
                self.assertAlmostEqual(slip.sum(), 1, 12)
                m = np.minimum(np.outer(twists, stiffness), slip).sum(axis=1)
                self.assert_largest(m - exact.moment_ratio(twist=twists, profile=profile), error, profile)

    def test_more_elements_give_more(self):
        before = 1.0
        for count in (1, 2, 4, 8, 16, 200):
            found = ParallelElements(Curve("hertz"), 0, count)
            self.assertEqual(len(found.each), count)
            self.assertLess(found.error, 0.5 * before)
            before = found.error
        for profile, count in (("hertz", 13), ("hertz", 152), ("hertz", 153), ("hertz", 199), ("flat_punch", 3), ("flat_punch", 200),
                               ("power:3", 7)):
            self.assertEqual(len(ParallelElements(Curve(profile), 0, count).each), count, profile)
        self.assertRaises(InputError, ParallelElements, Curve("hertz"), 0, 0)
        self.assertRaises(InputError, ParallelElements, Curve("hertz"), 1e-6)

    def test_limit_surface_is_the_sum_of_friction_about_a_point(self):
        surface = LimitSurface(Curve("hertz"), 9)
        np.testing.assert_allclose(surface.loads[0][1:], (0, 1), atol=1e-12)
        np.testing.assert_allclose(surface.loads[-1][1:], (1, 0), atol=1e-12)
        x, angle = (np.arange(1000)[:, None] + 0.5) / 1000, 2 * np.pi * (np.arange(240) + 0.5) / 240  # x: r^2
        weight = np.sqrt(1 - x) + 0 * angle
        for load in surface.loads[1:-1]:
            along = load.centre - np.sqrt(x) * np.cos(angle)
            over_speed = weight / np.hypot(along, np.sqrt(x) * np.sin(angle))
            force, moment = (over_speed * along).sum(), (over_speed * (x - load.centre * np.sqrt(x) * np.cos(angle))).sum()
            self.assertAlmostEqual(load.force, force / weight.sum(), delta=1e-4)
            self.assertAlmostEqual(load.moment, moment / weight.sum() / (3 * np.pi / 16), delta=1e-4)

    def test_limit_surface_is_convex_with_its_motions_as_normals(self):
        for profile in PROFILES:
            centre, force, moment = np.array(LimitSurface(Curve(profile), 17).loads).T
            arm = exact.profile_named(profile).moment_limit
            support = np.outer(centre[:-1], force) + arm * moment  # of each load, by each motion
            self.assertLessEqual((support.max(axis=1) / np.diag(support)).max(), 1 + 1e-9, profile)

    def test_no_spring_with_a_cap_is_better(self):
        twists = twists_to(1.5, 1000)
        for profile in PROFILES:
            curve = Curve(profile)
            best, m = best_spring(curve), exact.moment_ratio(twist=twists, profile=profile)

            def error_of(stiffness):
                at_cap = 1 - exact.moment_ratio(twist=1 / stiffness, profile=profile)
                return max(at_cap, abs(np.minimum(1, stiffness * twists) - m).max())

            self.assertAlmostEqual(error_of(best), spring_error(curve, best), delta=1e-4)
            self.assertGreaterEqual(error_of(0.95 * best), spring_error(curve, best))
            self.assertGreaterEqual(error_of(1.05 * best), spring_error(curve, best))
            self.assertAlmostEqual(error_of(curve.rest), spring_error(curve, curve.rest), delta=1e-4)
