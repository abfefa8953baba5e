"""slipstick.exact.stresses: equilibrium, compatibility, the surface, far fields, classical numbers, and quadrature over point loads."""
import os
import tempfile
import unittest

import numpy as np
from slipstick import InputError, exact

PROFILES = ("hertz", "cone", "flat_punch", "power:0.5", "power:1.5", "power:40", "rounded_punch:0.5", "constant", "capped:0.5",
            "pressure_power:0.5")
WITH_PRESSURE = tuple(name for name in PROFILES if name != "constant")
ROUNDING = 1e-12
COMPONENTS = ("rr", "tt", "zz", "rz", "rt", "tz")


def fractions():
    """Nodes of double exponential quadrature: distances from both ends, weights."""
    step = 1 / 24
    t = step * np.arange(-93, 94)
    low, high = 1 / (1 + np.exp(-np.pi * np.sinh(t))), 1 / (1 + np.exp(np.pi * np.sinh(t)))
    return low, high, step * np.pi * np.cosh(t) * low * high


LOW, HIGH, WEIGHT = fractions()


def point_load(x, y, z, poisson):
    """Boussinesq's stresses (Johnson 1985, 3.20) of a unit force into a half-space, at x, y from it and depth z: xx, yy, zz, xz, with
    x along r and z outwards."""
    square = x * x + y * y
    distance = np.sqrt(square + z * z)
    near = (1 - 2 * poisson) / (distance * (distance + z))
    along = near - 3 * z * square / distance**5
    around = -near + (1 - 2 * poisson) * z / distance**3
    cosine2 = np.divide(x * x, square, out=np.ones_like(square), where=square > 0)
    return [value / (2 * np.pi) for value in (
        along * cosine2 + around * (1 - cosine2), along * (1 - cosine2) + around * cosine2, -3 * z**3 / distance**5,
        3 * x * z * z / distance**5)]


def by_quadrature(r, z, pressure, traction, breaks, poisson):
    """The six components from point loads on rings of the contact: trapezoids around, which converge like exp(-n distance)."""
    total = np.zeros(6)
    ends = np.unique([0.0, *breaks, *([r] if r < 1 else []), 1.0])
    for low, high in zip(ends[:-1], ends[1:]):
        for part in range(0, len(LOW), 5):
            at = slice(part, part + 5)
            rho = np.where(LOW[at] < 0.5, low + (high - low) * LOW[at], high - (high - low) * HIGH[at])
            weight = (high - low) * WEIGHT[at] * rho
            distance = np.arccosh(1 + ((r - rho)**2 + z * z) / (2 * max(r, 1e-9) * np.maximum(rho, 1e-30))).min()
            count = int(44 / distance) + 24
            angle = (np.arange(count) + 0.5) * np.pi / count
            cosine, sine = np.cos(angle)[:, None], np.sin(angle)[:, None]
            x, y = r - rho * cosine, rho * sine
            load, shear = pressure(rho) * weight, traction(rho) * weight
            for i, stress in enumerate(point_load(x, y, z, poisson)):
                total[i] += 2 * np.pi * (stress.mean(axis=0) * load).sum()
            cube = (x * x + y * y + z * z)**1.5
            # u = integral of q cos/(2 pi G D); r d(u/r)/dr and du/dz of it.
            over_r = cosine * (r * r - r * rho * cosine) / cube + cosine / np.sqrt(x * x + y * y + z * z)
            total[4] -= (over_r.mean(axis=0) * shear).sum() / r if r > 0 else 0
            total[5] += (z * cosine / cube).mean(axis=0) @ shear
    return total


def differences(field, r, z, step):
    """Derivatives in r and z by the central rule of order 8."""
    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
    along = [np.add(*(sign * w / step * field(r + sign * k * step, z) for sign in (1, -1))) for k, w in weights.items()]
    down = [np.add(*(sign * w / step * field(r, z + sign * k * step) for sign in (1, -1))) for k, w in weights.items()]
    return sum(along), sum(down)


class FieldTest(unittest.TestCase):
    """What every stress field in a body obeys: the numbers here are differences of order 8, good to 1e-10."""

    def fields(self, profile, poisson, **state):
        def component(name):
            return lambda r, z: exact.stresses(r, z, poisson=poisson, profile=profile, **state)[name]
        return {name: component(name) for name in COMPONENTS}

    def test_equilibrium(self):
        r, z = np.array([0.2, 0.5, 0.9, 1.1, 2.0, 6.0]), np.array([0.3, 0.25, 0.35, 0.4, 0.5, 3.0])
        for profile in PROFILES:
            fields = self.fields(profile, 0.3, moment_ratio=0.8)
            at = {name: field(r, z) for name, field in fields.items()}
            by_r, by_depth = {}, {}
            for name, field in fields.items():
                by_r[name], by_depth[name] = differences(field, r, z, 0.01)
            # The depth runs against the axis z.
            residuals = {"theta": by_r["rt"] - by_depth["tz"] + 2 * at["rt"] / r}
            if profile != "constant":
                residuals["r"] = by_r["rr"] - by_depth["rz"] + (at["rr"] - at["tt"]) / r
                residuals["z"] = by_r["rz"] - by_depth["zz"] + at["rz"] / r
            for axis, residual in residuals.items():
                self.assertLess(abs(residual).max(), 1e-9, f"{profile}, {axis}: {residual}")

    def test_compatibility(self):
        r, z, poisson = np.array([0.2, 0.5, 0.9, 1.1, 2.0]), np.array([0.3, 0.25, 0.35, 0.4, 0.5]), 0.2
        for profile in PROFILES:
            fields = self.fields(profile, poisson, moment_ratio=0.8)
            # u_theta: 2 epsilon_r_theta = r d(u/r)/dr and 2 epsilon_theta_z = -du/d(depth) have the same mixed derivative.
            rt_down = differences(fields["rt"], r, z, 0.01)[1]
            tz_r = differences(lambda x, y: fields["tz"](x, y) / x, r, z, 0.01)[0]
            self.assertLess(abs(rt_down + r * tz_r).max(), 1e-9, profile)
            if profile == "constant":
                continue

            def hoop(x, y):  # G times the displacement u_r, times 2/r
                return fields["tt"](x, y) - poisson / (1 + poisson) * sum(fields[name](x, y) for name in ("rr", "tt", "zz"))
            along = differences(lambda x, y: x * hoop(x, y), r, z, 0.01)[0]
            strain = fields["rr"](r, z) - poisson / (1 + poisson) * sum(fields[name](r, z) for name in ("rr", "tt", "zz"))
            self.assertLess(abs(along - strain).max(), 1e-9, profile)
            if profile not in ("hertz", "cone", "flat_punch"):  # the others take seconds
                continue
            # The sum of normal stresses is harmonic.

            def trace(x, y):
                return sum(fields[name](x, y) for name in ("rr", "tt", "zz"))
            laplacian = (differences(lambda x, y: x * differences(trace, x, y, 0.01)[0], r, z, 0.01)[0] / r +
                         differences(lambda x, y: differences(trace, x, y, 0.01)[1], r, z, 0.01)[1])
            self.assertLess(abs(laplacian).max(), 1e-6, profile)

    def test_the_surface_carries_pressure_and_traction(self):
        r = np.array([0.05, 0.3, 0.47, 0.62, 0.9, 0.999, 1.001, 1.7])
        inside = r < 1
        for profile in PROFILES:
            for moment_ratio in (1e-6, 0.1, 0.9, 0.999999):
                for depth in (0.0, 1e-16):
                    found = exact.stresses(r, depth, moment_ratio, profile=profile)
                    np.testing.assert_allclose(found.tz[inside], exact.traction(r[inside], moment_ratio, profile=profile),
                                               rtol=2e-11, atol=1e-13, err_msg=f"{profile} {moment_ratio}")
                    self.assertLess(abs(found.tz[~inside]).max(), 1e-11, profile)
                    if profile in WITH_PRESSURE:
                        known = np.zeros_like(r)
                        own = "hertz" if profile.startswith(("capped", "pressure_power")) else profile
                        known[inside] = exact.pressure(r[inside], own)
                        np.testing.assert_allclose(-found.zz, known, rtol=1e-12, atol=1e-12, err_msg=profile)
                        self.assertLess(abs(found.rz).max(), 1e-11, profile)

    def test_tables(self):
        angle = np.linspace(0, np.pi / 2, 40)
        for bottom in (0.0, 0.3):  # and a step at the edge
            radii, pressures = np.sin(angle), bottom + np.sqrt(np.maximum(0, 1 - np.sin(angle)**2))
            with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
                file.write("".join(f"{float(r)!r},{float(p)!r}\n" for r, p in zip(radii, pressures)))
                file.flush()
                profile, r = f"file:{file.name}", np.array([0.05, 0.3, 0.6, 0.9])
                found = exact.stresses(r, 0.0, 0.7, profile=profile)
                np.testing.assert_allclose(found.tz, exact.traction(r, 0.7, profile=profile), rtol=0, atol=1e-13)
                np.testing.assert_allclose(-found.zz, exact.pressure(r, profile), rtol=0, atol=1e-12)

    def test_far_away_a_force_and_a_moment(self):
        distance, angle = 1e5, np.array([0.1, 0.7, 1.3])
        r, z = distance * np.sin(angle), distance * np.cos(angle)
        for profile in PROFILES:
            constants = exact.profile_named(profile)
            found = exact.stresses(r, z, 0.6, poisson=0.3, profile=profile)
            moment = 0.6 * constants.moment_limit * constants.load
            # u_theta = M r/(4 pi G R^3).
            np.testing.assert_allclose(found.rt, -3 * moment * r * r / (4 * np.pi * distance**5), rtol=1e-9)
            np.testing.assert_allclose(found.tz, 3 * moment * r * z / (4 * np.pi * distance**5), rtol=1e-9)
            if profile in WITH_PRESSURE:
                load = 2 * np.pi / 3 if profile.startswith(("capped", "pressure_power")) else constants.load
                xx, yy, zz, xz = (load * value for value in point_load(r, np.zeros(3), z, 0.3))
                for name, known in (("rr", xx), ("tt", yy), ("zz", zz), ("rz", xz)):
                    np.testing.assert_allclose(found[name], known, rtol=1e-9, atol=1e-9 * abs(zz).max())

    def test_histories_are_sums_of_first_loadings(self):
        r, z = np.array([0.3, 0.9, 1.2]), np.array([0.1, 0.0, 0.4])
        for profile in ("hertz", "constant"):
            back = exact.stresses(r, z, history=[0.9, -0.3], profile=profile)
            for name in ("rt", "tz"):
                known = exact.stresses(r, z, 0.9, profile=profile)[name] - 2 * exact.stresses(r, z, 0.6, profile=profile)[name]
                np.testing.assert_allclose(back[name], known, rtol=1e-13, atol=1e-15)
            reversed_ = exact.stresses(r, z, history=[0.9, -0.9], profile=profile)
            np.testing.assert_allclose(reversed_.tz, -exact.stresses(r, z, 0.9, profile=profile).tz, rtol=0, atol=1e-13)


class ClassicTest(unittest.TestCase):
    def test_hertz_on_the_axis(self):
        z = np.array([0.0, 1e-9, 0.1, 0.48, 1.0, 3.0, 50.0])
        nu = 0.25
        found = exact.stresses(0.0, z, 0.5, poisson=nu)
        np.testing.assert_allclose(found.zz, -1 / (1 + z * z), rtol=3e-13)
        arc = np.arctan2(1, z)
        around = -(1 + nu) * (1 - z * arc) + 1 / (2 * (1 + z * z))  # Johnson (1985), 3.45
        np.testing.assert_allclose(found.rr, around, rtol=0, atol=1e-13)
        np.testing.assert_allclose(found.tt, found.rr, rtol=0, atol=1e-15)
        for name in ("rz", "rt", "tz"):
            np.testing.assert_array_equal(found[name], np.zeros(len(z)))

    def test_hertz_on_the_surface(self):
        nu, r = 0.25, np.array([0.2, 0.8, 1.0, 1.5])
        found = exact.stresses(r, 0.0, 0.0, poisson=nu)
        inner = (1 - np.maximum(0, 1 - r * r)**1.5) / (3 * r * r)  # Johnson (1985), 3.42
        pressure = np.sqrt(np.maximum(0, 1 - r * r))
        np.testing.assert_allclose(found.rr, (1 - 2 * nu) * inner - pressure, atol=1e-15)
        np.testing.assert_allclose(found.tt, -(1 - 2 * nu) * inner - 2 * nu * pressure, atol=1e-15)

    def test_the_largest_stresses_of_hertz(self):
        def stationary(nu):  # bisection of the derivative of sigma_rr - sigma_zz on the axis
            def slope(z):
                return (1 + nu) * (np.arctan2(1, z) - z / (1 + z * z)) - 3 * z / (1 + z * z)**2
            low, high = 0.1, 1.0
            for _ in range(80):
                middle = (low + high) / 2
                low, high = (middle, high) if slope(middle) > 0 else (low, middle)
            return low, 1.5 / (1 + low * low) - (1 + nu) * (1 - low * np.arctan2(1, low))
        for nu in (0.0, 0.3, 0.5):
            depth, value = stationary(nu)
            for measure in ("von_mises", "tresca"):
                found = exact.largest_stress(0.5, poisson=nu, measure=measure)
                self.assertAlmostEqual(found.value, value, delta=1e-14)
                self.assertAlmostEqual(found.depth, depth, delta=1e-6)
                self.assertLess(found.radius, 1e-6)
        self.assertAlmostEqual(stationary(0.3)[0], 0.481, delta=5e-4)
        self.assertAlmostEqual(stationary(0.3)[1] / 2, 0.310, delta=5e-4)
        # Tension around the edge, (1 - 2 nu)/3 p0.
        found = exact.largest_stress(0.0, poisson=0.25, measure="tension")
        self.assertAlmostEqual(found.value, 1 / 6, delta=1e-13)
        self.assertAlmostEqual(found.radius, 1, delta=1e-6)
        self.assertEqual(found.depth, 0)

    def test_the_gross_slip_of_a_sphere(self):
        # q = mu p everywhere: sigma_r_theta at the edge is -(2 mu/pi) integral_0^1 s^2 E(k_s)/sqrt(1 - s^2) ds, and
        # E(k_s) = integral_0^(pi/2) sqrt(s^2 + (1 - s^2) sin(t)^2) dt by its definition.
        s, t = np.sin(np.pi / 2 * LOW), np.pi / 2 * LOW
        e = (np.sqrt(s[:, None]**2 + (1 - s[:, None]**2) * np.cos(t)**2) * WEIGHT).sum(axis=1) * np.pi / 2
        known = -(2 / np.pi) * (np.pi / 2 * WEIGHT * s**2 * e).sum()
        found = exact.stresses(1.0, 0.0, moment_deficit=1e-40)
        self.assertAlmostEqual(float(found.rt), known, delta=1e-12)

    def test_friction_moves_first_yield_to_the_surface(self):
        found = exact.first_yield([[0.0], [0.9]], [0.0, 0.3, 1.0])
        self.assertEqual(found.shape, (2, 3))
        np.testing.assert_allclose(found.pressure[0], found.pressure[0, 0], rtol=1e-13)  # no moment, no friction
        self.assertEqual(found.depth[1, 2], 0)
        self.assertLess(found.pressure[1, 2], found.pressure[1, 0])

    def test_the_table_of_first_yield(self):
        """docs/theory.md: the critical frictions, and parts of the load without torsion."""
        for moment_ratio, poisson, critical, radius in ((0.1, 0.3, 1.37400, 1), (0.5, 0.3, 0.59233, 0.859), (0.9, 0.3, 0.38113, 0.598),
                                                        (0.99, 0.5, 0.29340, 0.380), (0.3, 0.0, 0.70727, 1)):
            below, above = exact.first_yield(moment_ratio, [critical - 1e-5, critical + 1e-5], poisson)
            self.assertGreater(below.depth, 0.3)
            self.assertEqual(above.depth, 0)
            self.assertAlmostEqual(above.radius, radius, delta=6e-4)
        first = exact.first_yield([0.0, 0.9, 0.5, 0.99], [0.0, 0.4, 0.6, 1.0])
        np.testing.assert_allclose((first.pressure / first.pressure[0])**3, [1, 0.8735, 0.9640, 0.0392], rtol=0, atol=5.1e-5)

    def test_gross_slip_next_to_the_axis(self):
        # sigma_r_theta = -(2 mu/pi r^2) integral_0^r s^2 E/sqrt(r^2 - s^2) ds, E -> 1; sigma_rr = sigma_tt = -(1 + 2 nu)/2.
        for poisson, friction in ((0.3, 0.3), (0.0, 1.0)):
            found = exact.stresses(1e-7, 0.0, moment_deficit=1e-60, friction=friction, poisson=poisson)
            self.assertAlmostEqual(float(found.rt), -0.5, delta=1e-9)
            self.assertAlmostEqual(float(found.von_mises), np.sqrt((0.5 - poisson)**2 + 15 / 4 * friction**2), delta=1e-9)
            largest = exact.largest_stress(0.0, poisson=poisson).value
            critical = np.sqrt(4 / 15 * (largest**2 - (0.5 - poisson)**2))
            self.assertAlmostEqual(critical, {0.3: 0.30307, 0.0: 0.30215}[poisson], delta=5.1e-6)

    def test_the_load_at_first_yield(self):
        for shape, moment_ratio, profile in ((0.018, 0.9, "hertz"), (20.0, 0.0, "power:3")):
            load = exact.yield_load(300e6, 115e9, shape, moment_ratio, 0.4, profile=profile)
            peak = exact.contact_of(load, 115e9, shape, profile).reference_pressure
            self.assertAlmostEqual(peak * exact.largest_stress(moment_ratio, friction=0.4, profile=profile).value / 300e6, 1,
                                   delta=1e-12)


class CriteriaTest(unittest.TestCase):
    def test_invariants_of_the_tensor(self):
        random = np.random.default_rng(7)
        r, z, friction = 1.5 * random.random(200), random.random(200), 0.8
        found = exact.stresses(r, z, 0.9, friction=friction, poisson=0.3)
        rt, tz = friction * found.rt, friction * found.tz
        tensor = np.array([[found.rr, rt, found.rz], [rt, found.tt, tz], [found.rz, tz, found.zz]]).transpose(2, 0, 1)
        principal = np.linalg.eigvalsh(tensor)
        np.testing.assert_allclose(found.tension, principal[:, 2], atol=1e-14)
        np.testing.assert_allclose(found.tresca, principal[:, 2] - principal[:, 0], atol=1e-14)
        deviator = tensor - np.trace(tensor, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
        np.testing.assert_allclose(found.von_mises, np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2))), atol=1e-14)

    def test_the_largest_is_the_largest_of_many(self):
        r, z = np.meshgrid(np.linspace(0, 1.3, 131), np.concatenate([[0], np.geomspace(1e-3, 1.2, 60)]))
        for friction, moment_ratio in ((0.2, 0.99), (0.5, 0.5), (1.0, 0.9)):
            field = exact.stresses(r, z, moment_ratio, friction=friction)
            for measure in ("von_mises", "tresca", "tension"):
                found = exact.largest_stress(moment_ratio, friction=friction, measure=measure)
                self.assertGreaterEqual(found.value, field[measure].max() - 1e-14)
                here = exact.stresses(found.radius, found.depth, moment_ratio, friction=friction)
                self.assertEqual(float(here[measure]), found.value)

    def test_refusals_name_the_number(self):
        for words, function in (
                ("r/a = -1", lambda: exact.stresses(-1, 0, 0.5)), ("z/a = nan", lambda: exact.stresses(0, np.nan, 0.5)),
                ("nu = 0.6", lambda: exact.stresses(0, 0, 0.5, poisson=0.6)),
                ("friction = -1", lambda: exact.stresses(0, 0, 0.5, friction=-1)),
                ("infinite there", lambda: exact.stresses(1, 0, 0.5, profile="flat_punch")),
                ("infinite there", lambda: exact.stresses(0, 0, 0.5, profile="cone")),
                ("2 values", lambda: exact.stresses(0, 0, stick_ratio=[0.1, 0.2])),
                ("measure", lambda: exact.largest_stress(0.5, measure="strain")),
                *((profile, lambda profile=profile: exact.largest_stress(0.5, profile=profile))
                  for profile in ("cone", "flat_punch", "constant")),
                ("rounded_punch", lambda: exact.yield_load(1.0, 1.0, [1.0, 1.0], profile="rounded_punch:0.5"))):
            with self.assertRaises(InputError, msg=words) as caught:
                function()
            self.assertIn(words, str(caught.exception))


class QuadratureTest(unittest.TestCase):
    def compare(self, profile, moment_ratio, points, breaks=()):
        poisson = 0.3
        front = exact.stick_ratio(moment_ratio, profile=profile)
        worst = np.zeros(6)
        size = np.zeros(6)
        for r, z in points:
            known = by_quadrature(r, z, lambda rho: exact.pressure(rho, profile), lambda rho: exact.traction(rho, moment_ratio,
                                  profile=profile), [front, *breaks], poisson)
            found = exact.stresses(r, z, moment_ratio, poisson=poisson, profile=profile)
            values = np.array([float(found[name]) for name in COMPONENTS])
            worst = np.maximum(worst, abs(values - known))
            size = np.maximum(size, abs(known))
        return worst, size

    def random_points(self, count, seed):
        random = np.random.default_rng(seed)
        return zip(1.6 * random.random(count), 10**random.uniform(-2, 0.5, count))

    def test_point_loads_on_the_contact(self):
        count = 1000 if os.environ.get("SLIPSTICK_TEST_ALL") else 20
        for profile, breaks in (("hertz", ()), ("cone", ()), ("power:1.5", ()), ("rounded_punch:0.5", (0.5, )),
                                ("capped:0.5", (np.sqrt(0.75), ))):
            worst, size = self.compare(profile, 0.7, self.random_points(count if profile == "hertz" else count // 10, 59), breaks)
            if os.environ.get("SLIPSTICK_TEST_ALL"):
                print(profile, worst, size)
            if profile == "capped:0.5":  # its pressure() is the bound
                worst[:4] = 0
            self.assertLess(worst.max(), ROUNDING * size.max(), f"{profile}: {worst}")
