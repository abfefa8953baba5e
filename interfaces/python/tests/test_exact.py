"""slipstick.exact: facts of the theory, shapes, refusals."""
import unittest

import numpy as np
from slipstick import InputError, exact

PROFILES = ("hertz", "cone", "flat_punch", "power:1.5", "rounded_punch:0.5")


class FactsTest(unittest.TestCase):
    def test_limits_with_a_closed_form(self):
        self.assertAlmostEqual(exact.profile_named().moment_limit, 3 * np.pi / 16, places=15)  # Lubkin
        self.assertAlmostEqual(exact.profile_named("flat_punch").full_stick, 8 / (3 * np.pi), places=15)
        for profile in PROFILES:  # Reissner and Sagoci: a bonded punch, while nearly nothing slips
            self.assertAlmostEqual(exact.moment(1e-9, profile=profile) / 1e-9, 16 / 3, places=6)
            self.assertEqual(exact.tangent_stiffness(0.0, profile=profile), 16 / 3)

    def test_hertz_contact(self):
        contact = exact.contact_of(1000.0, 115e9, 0.018)
        self.assertAlmostEqual(contact.radius**3, 3 * 1000 * 0.018 / (4 * 115e9), delta=1e-24)
        self.assertAlmostEqual(contact.approach, contact.radius**2 / 0.018, delta=1e-18)
        self.assertAlmostEqual(contact.reference_pressure * 2 / 3 * np.pi * contact.radius**2, 1000.0, places=9)

    def test_each_name_leads_to_the_same_state(self):
        for profile in PROFILES:
            states = exact.states(np.linspace(0.86, 0.99, 7), profile=profile)
            for name in ("moment_ratio", "moment_deficit", "stick_ratio", "stick_complement", "twist"):
                again = exact.states(**{name: states[name]}, profile=profile)
                for quantity in states.dtype.names:
                    np.testing.assert_allclose(again[quantity], states[quantity], rtol=1e-10, err_msg=f"{profile} {name}")
            np.testing.assert_array_equal(exact.twist(states.moment_ratio, profile=profile), states.twist)
            np.testing.assert_array_equal(exact.stick_ratio(states.moment_ratio, profile=profile), states.stick_ratio)
            np.testing.assert_allclose(exact.moment_ratio(states.twist, profile=profile), states.moment_ratio, rtol=1e-12)

    def test_tractions_carry_the_moment(self):
        angle = (np.arange(4000) + 0.5) * np.pi / 2 / 4000
        radius, weight = np.sin(angle), np.cos(angle) * np.pi / 2 / 4000
        for profile in PROFILES:
            constants = exact.profile_named(profile)
            load = (2 * np.pi * radius * exact.pressure(radius, profile) * weight).sum()
            traction = exact.traction(radius, 0.95, profile=profile)
            moment = (2 * np.pi * radius**2 * traction * weight).sum() / load
            self.assertAlmostEqual(load / constants.load, 1, delta=1e-3)
            self.assertAlmostEqual(moment / constants.moment_limit, 0.95, delta=1e-3)
            back = exact.traction(radius, history=[0.95, -0.95], profile=profile)
            np.testing.assert_allclose(back, -traction, rtol=0, atol=1e-12 * traction.max())

    def test_masing(self):
        loop = exact.history([0.9, -0.9, 0.9])
        np.testing.assert_allclose(loop.twist, exact.twist(0.9) * np.array([1, -1, 1]), rtol=1e-13)
        np.testing.assert_allclose(loop.dissipated[2] - loop.dissipated[0], exact.energy_lost(0.9), rtol=1e-12)
        curve = exact.curve([0.9, -0.9], points_per_branch=20)
        self.assertEqual(curve.shape, (41,))
        np.testing.assert_array_equal(curve.twist[[0, 20, 40]], [0, loop.twist[0], loop.twist[1]])


class ArraysTest(unittest.TestCase):
    def test_results_have_the_shape_of_values(self):
        values = np.linspace(0, 0.9, 12).reshape(3, 4)
        twists = exact.twist(values)
        self.assertEqual(twists.shape, (3, 4))
        self.assertEqual(exact.states(values).shape, (3, 4))
        np.testing.assert_array_equal(exact.twist(values.T), twists.T)  # arrays with another memory layout
        np.testing.assert_array_equal(exact.twist(values[::2, ::3]), twists[::2, ::3])
        np.testing.assert_array_equal(exact.twist(values.tolist()), twists)
        self.assertEqual(exact.twist(values.astype(np.float32)).dtype, np.float64)
        self.assertEqual(exact.twist([]).shape, (0,))
        self.assertIs(type(exact.twist(0.5)), float)
        self.assertEqual(exact.twist(0.5), exact.twist(np.array([0.5]))[0])

    def test_values_are_not_changed(self):
        values = np.linspace(0, 0.9, 5)
        before = values.copy()
        exact.twist(values)
        np.testing.assert_array_equal(values, before)


class RefusalsTest(unittest.TestCase):
    def assert_refused(self, words, function, *arguments, **names):
        with self.assertRaises(InputError) as caught:
            function(*arguments, **names)
        self.assertIn(words, str(caught.exception))

    def test_refusals(self):
        self.assert_refused("values[1]: M/M_lim = 1 is gross slip", exact.twist, [0.5, 1.0])
        self.assert_refused("values[0]: M/M_lim = nan", exact.twist, float("nan"))
        self.assert_refused('profile "sphere"; allowed: hertz, cone', exact.twist, 0.5, profile="sphere")
        self.assert_refused("0 of moment_ratio", exact.twist)
        self.assert_refused("2 of moment_ratio", exact.twist, 0.5, stick_ratio=0.5)
        self.assert_refused("2 of ", exact.traction, 0.5, 0.5, history=[0.1])
        self.assert_refused("radii[0]: r/a = 2", exact.traction, 2.0, 0.5)
        self.assert_refused("points_per_branch = 0", exact.curve, [0.5], 0)
        self.assert_refused("points_per_branch = -5", exact.curve, [0.5], -5)
        self.assert_refused("moment_ratios[1]", exact.history, [0.5, -2.0])
        self.assert_refused("zero byte", exact.twist, 0.5, profile="hertz\0cone")
        self.assertTrue(issubclass(InputError, ValueError))
