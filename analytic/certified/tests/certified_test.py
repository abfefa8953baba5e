"""certified_test.py PROGRAM: the digits of `slipstick exact --certified` against those by other ways than its code's: integrals of
the pressure instead of superposed punches, mpmath's elliptic integrals instead of means."""

import csv
import json
from functools import cache
from itertools import product
from pathlib import Path

from mpmath import acosh, atan, atanh, cosh, ellipe, ellipk, hyp2f1, linspace, log, mp, mpf, pi, quad, sqrt

from program_run import ProgramTest

mp.dps = 50
NAMES = ("moment_ratio", "moment_deficit", "stick_ratio", "stick_complement", "twist")
LOADS = {"hertz": 2 * pi / 3, "cone": pi, "flat_punch": 2 * pi, "constant": pi}  # W/(p0 a^2)


def load(profile):
    return LOADS[profile] if profile in LOADS else 2 * pi / (mpf(profile[6:]) + 1)


def pressure(profile, v):
    """p/p0 times v at the radius sqrt(1 - v^2)."""
    known = {"hertz": lambda: v * v, "cone": lambda: v * atanh(v), "flat_punch": lambda: mpf(1), "constant": lambda: v}
    if profile in known:
        return known[profile]()
    return v * v * hyp2f1(1 - mpf(profile[6:]) / 2, 1, 1.5, v * v)


def from_pressure(profile, c):
    """H and M/(mu p0 a^3): with rho^2 = c^2 + k^2 sin^2 theta, integrals over theta of p k cos/rho, and of that times
    8 (c^3/3 + x rho^2/2 atan(x/c) + c x^2/2), x = k sin theta. The integrand's poles lie c off the real axis."""
    k = sqrt(1 - c * c)

    def both(theta):
        cosine, sine = mp.cos_sin(theta)
        x, rho = k * sine, sqrt(c * c + (k * sine)**2)
        weight = pressure(profile, k * cosine) / rho
        return mp.mpc(weight, 8 * weight * (c**3 / 3 + x * rho * rho / 2 * atan(x / c) + c * x * x / 2))
    sums = quad(both, [0] + [end for end in (c, 10 * c, 100 * c) if end < 1] + [pi / 2])
    return sums.real, sums.imag


class Certified(ProgramTest):
    @cache
    def state(self, profile, given, value, radii=(), digits=40):
        words = ["exact", "--profile", profile, f"--{given.replace('_', '-')}={value}", "--certified", str(digits), "--json", "-"]
        return json.loads(self.run_program(*words, *(["--radius", ",".join(radii)] if radii else [])))

    def agree(self, number, known, within="1e-38"):
        """Whether the decimals with their radius enclose a known value, up to that part of it."""
        self.assertLessEqual(abs(mpf(number["value"]) - known), mpf(number["radius"]) + mpf(within) * abs(known), (number, known))

    def tractions(self, *words, **options):
        return [at["value"] for at in self.state(*words, **options)["traction"]]

    def refused(self, *words, says):
        profile, given, value, *rest = words
        self.run_program("exact", "--profile", profile, f"--{given.replace('_', '-')}={value}", "--certified", "20", *rest, code=2,
                         says=says)

    def test_has_the_twist_and_the_moment_of_its_pressure(self):
        for profile, c in product((*LOADS, "power:4", "power:1.5", "power:0.5", "power:8"), ("1e-3", "0.3", "0.49", "0.51", "0.9")):
            with self.subTest(profile=profile, c=c):
                twist, moment = from_pressure(profile, mpf(c))
                found = self.state(profile, "stick_ratio", c)
                self.agree(found["twist"], twist / (2 * load(profile)))
                self.agree(found["moment"], moment / load(profile))
                self.agree(found["tangent_stiffness"], 16 * mpf(c)**3 / 3)

    def test_has_the_limit_moments(self):
        for profile, limit in (("hertz", 3 * pi / 16), ("cone", pi / 6), ("flat_punch", pi / 4), ("constant", mpf(2) / 3),
                               ("power:1.5", pi * 25 / 140)):  # pi (n + 1)/(4 (n + 2))
            found = self.state(profile, "stick_ratio", "0.3")
            self.agree(found["moment"], limit * mpf(found["moment_ratio"]["value"]))

    @mp.workdps(120)
    def test_follows_the_asymptotes_at_both_ends(self):
        for w in ("1e-10", "1e-30", "1e-90"):
            found = self.state("hertz", "stick_complement", w, digits=100)
            self.agree(found["moment_ratio"], 32 * mpf(w) / (3 * pi), 2 * mpf(w))
            self.agree(found["twist"], 3 * mpf(w) / 8, 2 * mpf(w))
        for c in ("1e-6", "1e-12", "1e-30"):
            found = self.state("hertz", "stick_ratio", c, digits=100)
            logarithm = log(4 / mpf(c))
            self.agree(found["moment_deficit"], 64 * mpf(c)**3 / (9 * pi * pi), mpf(c)**2 * logarithm)
            self.agree(found["twist"], 3 / (4 * pi) * (logarithm - 1), mpf(c)**2 * logarithm)

    def test_goes_round_between_all_quantities(self):
        for profile, c in product((*LOADS, "power:1.5"), ("1e-12", "0.3", "0.8", "0.99999999")):
            start = self.state(profile, "stick_ratio", c, digits=60)
            for given in NAMES:
                back = self.state(profile, given, start[given]["value"], digits=15)
                self.agree(back["stick_ratio"], mpf(c), "1e-14")
                self.agree(back["stick_complement"], 1 - mpf(c), "1e-14")

    def test_sticks_everywhere_at_no_load(self):
        for profile, (given, value) in product(("hertz", "cone", "power:3"), zip(NAMES, ("0", "1", "1", "0e5", "0.0"))):
            found = self.state(profile, given, value, ("0", "0.5", "1"), digits=20)
            for zero in ("moment_ratio", "stick_complement", "twist", "moment"):
                self.assertEqual(found[zero]["value"], "0")
            self.assertEqual((found["moment_deficit"]["value"], found["stick_ratio"]), ("1", {"value": "1", "radius": "0"}))
            self.assertEqual(found["tangent_stiffness"]["value"], "5.3333333333333333333")
            self.assertEqual([at["value"]["value"] for at in found["traction"]], ["0"] * 3)

    def test_a_flat_punch_sticks_everywhere_up_to_its_onset(self):
        onset = 8 / (3 * pi)
        for given, value in (("stick_ratio", "1"), ("stick_complement", "0"), ("twist", "0.125")):
            found = self.state("flat_punch", given, value, ("0.6",))
            self.assertEqual((found["stick_ratio"]["value"], found["stick_complement"]["value"]), ("1", "0"))
            for number, known in ((found["moment_ratio"], onset), (found["twist"], mpf(1) / 8),
                                  (found["traction"][0]["value"], mpf(3) / 4)):
                self.agree(number, known)
        half = self.state("flat_punch", "moment_ratio", "0.4", ("0", "0.8"))
        self.agree(half["twist"], mpf("0.4") * 3 * pi / 64)  # 3/16 M/(mu W a)
        self.assertEqual((half["stick_ratio"]["value"], half["traction"][0]["value"]["value"]), ("1", "0"))
        self.agree(half["traction"][1]["value"], mpf("0.4") / onset * 4 / 3)

    @mp.workdps(80)
    def test_a_flat_punch_tells_both_sides_of_its_onset(self):
        onset = 8 / (3 * pi)
        cut_off = int(onset * mpf(10)**60)
        below, above = f"0.{cut_off}", f"0.{cut_off + 1}"
        self.assertEqual(self.state("flat_punch", "moment_ratio", below)["stick_complement"]["value"], "0")
        slipped = self.state("flat_punch", "moment_ratio", above, digits=20)["stick_complement"]
        # M/M_lim grows from there by 4/(3 pi) a complement.
        self.agree(slipped, (mpf(above) - onset) * 3 * pi / 4, "1e-15")
        for twist, full in (("0.1249999999999999999999999999", True), ("0.1250000000000000000000000001", False)):
            self.assertEqual(self.state("flat_punch", "twist", twist)["stick_ratio"]["value"] == "1", full)

    def test_tractions_are_those_of_the_superposed_twists(self):
        for c, r in (("0.5", "0.3"), ("0.5", "0.499"), ("0.01", "0.005"), ("0.9", "1e-6"), ("0.9", "0.89")):
            # 2/pi r integral_c^1 e/(s sqrt(s^2 - r^2)) ds with e = -s H'(s); s = r cosh(u).
            ends = linspace(acosh(mpf(c) / mpf(r)), acosh(1 / mpf(r)), 9)
            for profile, e in (("hertz", ellipe), ("cone", ellipk)):
                def rest(u, r=mpf(r), e=e):
                    s = min(mpf(1), r * cosh(u))
                    return e(1 - s * s) / s
                self.agree(self.tractions(profile, "stick_ratio", c, (r,))[0], 2 / pi * mpf(r) * quad(rest, ends))

    def test_the_table_has_the_closed_costs_of_the_sphere(self):
        """By slopes that the table's maker does not use: d(M/M_lim)/dc = -64/(3 pi^2) c^2 E, d(twist)/dc = -3/(4 pi) E/c."""
        table = Path(__file__).resolve().parents[2] / "references/certified_references.csv"
        for row in csv.DictReader(table.read_text().splitlines()[1:]):
            if row["profile"] != "hertz" or row["quantity"] == "traction" or float(row["value"]) < 1e-3:
                continue
            found = self.state("hertz", row["given"], row["value"], digits=30)
            c = mpf(found["stick_ratio"]["value"])

            def slope(name):  # |d ln y/dc|
                by_c = {"twist": 3 / (4 * pi) * ellipe(1 - c * c) / c, "moment": 64 / (3 * pi * pi) * c * c * ellipe(1 - c * c)}
                return by_c.get(name.partition("_")[0], 1) / mpf(found[name]["value"])
            self.assertAlmostEqual(mpf(row["cost"]) / (slope(row["quantity"]) / slope(row["given"])), 1, delta=0.0051, msg=row)

    def test_tractions_are_coulombs_beyond_the_front_and_continuous(self):
        r, v = mpf("0.6"), mpf("0.8")
        for c, (profile, known) in product(("0.6", "0.2"), (
                ("hertz", v), ("cone", log(mpf(3))), ("flat_punch", 1 / v), ("constant", 1), ("power:4", v * (v * v / 3 + r * r)))):
            self.agree(self.tractions(profile, "stick_ratio", c, ("0.6",))[0], known)
        for profile in ("hertz", "cone", "power:0.5"):
            self.assertEqual(self.tractions(profile, "stick_ratio", "0.6", ("1",))[0]["value"], "0")
        for profile in (*LOADS, "power:1.5"):
            inside, front = self.tractions(profile, "stick_ratio", "0.5", ("0." + "4" + 39 * "9", "0.5"))
            # It falls off inside like the root of the distance, 1e-40.
            self.assertTrue(0 < mpf(front["value"]) - mpf(inside["value"]) < mpf("1e-19"), profile)
        self.assertEqual(self.tractions("cone", "stick_ratio", "0.5", ("0",))[0]["value"], "0")

    def test_narrows_inside(self):
        for profile, (given, value) in product(("hertz", "cone", "flat_punch", "power:0.5"), (
                ("moment_ratio", "0.9"), ("moment_deficit", "1e-9"), ("twist", "0.3"), ("stick_complement", "0.001"))):
            wide, narrow = (self.state(profile, given, value, ("0.3", "0.9"), digits) for digits in (20, 60))
            pairs = [(wide[name], narrow[name]) for name in (*NAMES, "moment", "tangent_stiffness")]
            pairs += [(one["value"], other["value"]) for one, other in zip(wide["traction"], narrow["traction"])]
            for one, other in pairs:
                apart = abs(mpf(one["value"]) - mpf(other["value"])) + mpf(other["radius"])
                self.assertLessEqual(apart, mpf(one["radius"]) * (1 + mpf("1e-30")))

    def test_is_proven_to_its_last_digit(self):
        for digits, m in product((15, 30, 77, 100), ("1e-8", "0.3", "0.97", "0.999999999")):
            found = self.state("cone", "moment_ratio", m, ("0.1",), digits)
            for number in [found[name] for name in (*NAMES, "moment", "tangent_stiffness")] + [found["traction"][0]["value"]]:
                mantissa, _, exponent = number["value"].partition("e")
                places = len(mantissa.partition(".")[2])
                self.assertEqual(len(mantissa.replace(".", "").lstrip("0")), digits, number)
                unit = mpf(10)**(int(exponent or 0) - places)
                self.assertLessEqual(mpf(number["radius"]), unit * mpf("0.51000000001"), number)

    def test_numbers_are_read_exactly_and_printed_as_one_reads_them(self):
        for text, printed in (("0.5", "0.500000000000000"), ("+.5", "0.500000000000000"), ("123.25", "123.250000000000"),
                              ("0.99999999999999999", "1.00000000000000"), ("9.9999999999999949", "9.99999999999999"),
                              ("0.00001", "0.0000100000000000000"), ("0.000001", "1.00000000000000e-6"),
                              ("2e-300", "2.00000000000000e-300"), ("0x1.8p-3", "0.187500000000000"), ("0XAp0", "10.0000000000000"),
                              ("5.", "5.00000000000000"), ("1.25e1", "12.5000000000000"), ("0e99", "0"),
                              ("0x1.999999999999ap-4", "0.100000000000000")):
            self.assertEqual(self.state("constant", "twist", text, digits=15)["twist"]["value"], printed, text)
        nearest = self.state("hertz", "twist", "0x1.999999999999ap-4", digits=30)["twist"]["value"]
        self.assertEqual(nearest, "0.100000000000000005551115123126")  # the double nearest to 0.1
        for text, digits, radius in (("0.5", 20, "0"), ("0.6666666666666666666666666", 15, "3.4e-16"), ("0.1", 20, "1e-22")):
            self.assertEqual(self.state("hertz", "twist", text, digits=digits)["twist"]["radius"], radius, text)

    def test_refuses_what_is_no_number(self):
        for bad in (".", "nan", "inf", "1e", "0x", "1 ", " 1", "1,5", "0.5.1", "--1", "1e999999"):
            self.refused("hertz", "twist", bad, says=["G a^2 phi/(mu W)", f"'{bad}'"])
        for given, value in (("twist", "1e1001"), ("stick_ratio", "1e-1001"), ("twist", "1e9")):
            self.refused("hertz", given, value, says="1e")
        self.refused("hertz", "stick_ratio", "0.5", "--radius", "x", says="'x'")

    def test_names_value_and_range(self):
        for given, value, says in (
                ("moment_ratio", "1.2", "M/M_lim = 1.2 is gross slip; allowed: 0 <= M/M_lim < 1"),
                ("moment_ratio", "1", "M/M_lim = 1 is gross slip; allowed: 0 <= M/M_lim < 1"),
                ("moment_ratio", "-0.1", "M/M_lim = -0.1; allowed: 0 <= M/M_lim < 1"),
                ("moment_deficit", "0", "1 - M/M_lim = 0 is gross slip; allowed: 0 < 1 - M/M_lim <= 1"),
                ("moment_deficit", "1.5", "1 - M/M_lim = 1.5; allowed: 0 < 1 - M/M_lim <= 1"),
                ("stick_ratio", "0", "a_s/a = 0; allowed: 0 < a_s/a <= 1"),
                ("stick_ratio", "1.1", "a_s/a = 1.1; allowed: 0 < a_s/a <= 1"),
                ("stick_complement", "1", "1 - a_s/a = 1; allowed: 0 <= 1 - a_s/a < 1"),
                ("twist", "-1", "G a^2 phi/(mu W) = -1; allowed: 0 <= G a^2 phi/(mu W)")):
            self.refused("hertz", given, value, says=says)
        for radius in ("1.1", "-0.1"):
            self.refused("hertz", "stick_ratio", "0.5", f"--radius={radius}", says="0 <= r/a <= 1")
        self.refused("flat_punch", "stick_ratio", "0.5", "--radius", "1.0", says=["infinite", "0 <= r/a < 1"])
        for n in ("0", "-1", "", "x"):
            self.refused(f"power:{n}", "stick_ratio", "0.5", says="--")
