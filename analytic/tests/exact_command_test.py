"""exact_command_test.py PROGRAM: `slipstick exact` as users run it."""

import json
import math
from decimal import Decimal
from math import pi
from pathlib import Path

from program_run import ProgramTest

STICK = 0.8135681261276496  # at half the limit moment


class Exact(ProgramTest):
    def text(self, words, **expected):
        return self.run_program("exact", *words.split(), **expected)

    def json(self, words):
        return json.loads(self.text(words + " --json -"))

    def refused(self, words, *says):
        self.text(words, code=2, says=says)

    def near(self, one, other, within):
        self.assertAlmostEqual(one, other, delta=within)

    def test_gives_the_state_and_the_tractions(self):
        state = "--moment-ratio 0.5 --radius 0,0.5,0.9"
        found = self.json(state)
        self.assertEqual((found["moment_ratio"], found["moment_deficit"]), (0.5, 0.5))
        self.near(found["stick_ratio"], STICK, 1e-15)
        self.near(found["stick_complement"], 1 - STICK, 1e-15)
        self.near(found["moment"], 3 * pi / 32, 1e-15)
        for key in ("twist", "tangent_stiffness"):
            self.assertIsInstance(found[key], float)
        traction = found["traction"]
        self.assertEqual((len(traction), traction[0]["value"], traction[2]["radius"]), (3, 0, 0.9))
        self.near(traction[2]["value"], math.sqrt(0.19), 1e-15)
        self.text(state, says=["M/M_lim", "0.81356812612", "Eq. (7)"])

    def test_sets_the_printed_equations_beside(self):
        found = self.json("--moment-ratio 0.5 --radius 0.5,0.9")
        printed = found["printed"]
        self.near(printed["equation_1"][0]["value"] / found["traction"][0]["value"], pi / 2, 1e-12)
        self.assertEqual(printed["equation_1"][1]["radius"], 0.9)
        self.near(printed["equation_5"], 3 * pi / 32, 1e-13)
        self.assertLess(printed["equation_7"], found["twist"])

    def test_gives_a_reason_for_each_missing_number(self):
        printed = self.json("--stick-ratio 1 --radius 0.5")["printed"]
        self.assertIsNone(printed["equation_5"])
        self.assertIn("a_s/a = 1", printed["equation_5_reason"])
        self.assertIsNone(printed["equation_1"][0]["value"])
        self.assertIn("value_reason", printed["equation_1"][0])
        self.assertEqual(printed["equation_7"], 0)

    def test_takes_every_argument_throughout_the_range(self):
        for words in ("--moment-deficit 1e-9", "--stick-ratio 0.3", "--stick-complement 1e-9", "--twist 0.4",
                      "--moment-ratio 0"):
            self.assertTrue(self.text(words), words)
        for value in "1e-300 1e-20 1e-12 1e-8 1e-6 1e-4 1e-2 0.5 0.999999".split():
            for key in ("deficit", "ratio"):
                self.text(f"--moment-{key} {value} --radius 0,1e-9,0.3,1")

    def test_follows_a_power_to_the_smallest_deficit(self):
        # A power is similar to itself: 1 - M/M_lim ~ c^(N + 2) and the twist ~ c^(N - 1) near the limit.
        for n in (0.01, 0.1, 0.5):
            one, other = (self.json(f"--profile power:{n} --moment-deficit 1e{power}") for power in (-100, -307))
            for key, exponent in (("stick_ratio", 1), ("twist", Decimal(n) - 1)):
                scale = (Decimal(10).ln() * -207 / (Decimal(n) + 2) * exponent).exp()
                self.near(float(Decimal(other[key]) / Decimal(one[key]) / scale), 1, 5e-15)

    def test_names_option_value_and_range(self):
        for words, *says in (
                ("--radius 0.5", ), ("--twist 0.1 --moment-ratio 0.1", ), ("--history 0.5 --moment-ratio 0.1", ),
                ("--moment-ratio 0.1 --points 4", ), ("--twist 0.1 --normal-load 1", ),
                ("--twist 0.1 --normal-load 1 --effective-modulus 1 --shape 1 --shear-modulus 1", ),
                ("--moment-ratio 1.2", "--moment-ratio", "1.2", "gross slip", "0 <= M/M_lim < 1"),
                ("--twist 0.1 --radius 0.5,1.5", "--radius", "1.5", "0 <= r/a <= 1"),
                ("--twist 0.1 --profile disc", "--profile", "disc", "hertz, cone, flat_punch"),
                ("--twist 0.1x", "--twist", "0.1x"), ("--history 0.5,-1.5", "--history", "-1.5"),
                ("--twist 0.1 --profile file:", "file:P.csv"),
                ("--twist 0.1 --profile file:nowhere.csv", "--profile", "nowhere.csv"),
                ("--twist 0.1 --profile power:x", "--profile", '"x"'),
                ("--twist 0.1 --normal-load 1 --effective-modulus 1 --shape 1,2", "--shape", "sphere radius"),
                # Certified are 15 to 100 digits, of no histories.
                *((f"{words}", ) for words in ("--moment-ratio 0.5 --certified 14", "--moment-ratio 0.5 --certified 101",
                                               "--history 0.5 --certified 20",
                                               "--moment-ratio 0.5 --unload-to 0.1 --certified 20"))):
            self.refused(words, *says)

    def test_a_flat_punch_sticks_fully(self):
        state = "--moment-ratio 0.8 --profile flat_punch --radius 0.6,1"
        found = self.json(state)
        self.assertEqual(found["stick_ratio"], 1)
        self.near(found["twist"], 3 / 16 * 0.8 * pi / 4, 1e-15)
        self.near(found["profile"]["full_stick"], 8 / (3 * pi), 1e-15)
        # A bonded punch: q = 3 M r/(4 pi a^2 sqrt(a^2 - r^2)), with W = 2 pi p0 a^2.
        inside, edge = found["traction"]
        self.near(inside["value"], 3 / 2 * 0.8 * pi / 4 * 0.6 / 0.8, 1e-15)
        self.assertIsNone(edge["value"])
        self.assertIn("infinite", edge["value_reason"])
        self.assertNotIn("printed", found)
        self.text(state, says="Everything sticks up to")

    def test_profiles_agree_where_one_is_another(self):
        state = "--moment-ratio 0.6 --radius 0.3"
        for one, other in (("hertz", "power:2"), ("cone", "power:1")):
            one, other = (self.json(f"{state} --profile {name}") for name in (one, other))
            for key in ("stick_ratio", "twist", "moment", "energy_lost_per_cycle"):
                self.near(one[key] / other[key], 1, 1e-14)
            self.near(one["traction"][0]["value"] / other["traction"][0]["value"], 1, 1e-14)
        sphere = self.json(state)
        self.assertEqual(sphere["twist"], self.json(f"{state} --profile hertz")["twist"])

    def hertz_table(self, points):
        """Hertz's pressure in a file, closer and closer towards the edge."""
        rows = [(3e-3 * math.sin(angle), 5e8 * math.cos(angle))
                for angle in (pi / 2 * i / (points - 1) for i in range(points - 1))] + [(3e-3, 0.0)]
        return self.write("hertz.csv", "radius,pressure\n" + "".join(f"{r!r},{p!r}\n" for r, p in rows))

    def test_a_table_has_an_error_estimate(self):
        state = "--moment-ratio 0.6 --radius 0.3"
        exact = self.json(state)
        state += f" --profile file:{self.hertz_table(201)}"
        table = self.json(state)
        estimate = table["error_estimate"]
        for key in ("stick_ratio", "twist", "moment"):
            self.near(table[key], exact[key], estimate[key])
            self.assertLessEqual(estimate[key], 1e-4, key)
        self.near(table["profile"]["moment_limit"], 3 * pi / 16, estimate["moment_limit"])
        self.near(table["table"]["mean_pressure"], 5e8 * 2 / 3, estimate["mean_pressure"])
        self.assertEqual(estimate["traction"][0]["radius"], 0.3)
        self.near(table["pressure"][0]["value"], 1.5 * math.sqrt(1 - 0.09), estimate["pressure"][0]["value"])
        self.assertEqual(table["table"]["contact_radius"], 3e-3)
        self.text(state, says=["+/-", "estimates, without proof"])

    def test_a_table_may_have_comments_blanks_and_other_line_ends(self):
        state = f"--moment-ratio 0.6 --profile file:{self.hertz_table(33)}"
        plain = self.json(state)
        _, first, *others = Path("hertz.csv").read_text().splitlines()
        self.write("hertz.csv", "\n".join(["\ufeff# measured", "", " radius , pressure\r", f" {first}\r", "# here", *others]))
        full = self.json(state)
        self.assertEqual((full["twist"], full["table"]), (plain["twist"], plain["table"]))

    def test_a_table_of_few_points_is_refused_or_has_no_estimate(self):
        self.refused(f"--moment-ratio 0.1 --profile file:{self.hertz_table(9)}", "--profile", "hertz.csv",
                     "9 points; allowed: at least 16")
        state = f"--history 0.6,-0.6 --profile file:{self.hertz_table(17)}"
        self.assertNotIn("error_estimate", self.json(state))
        self.assertNotIn("+/-", self.text(state, says="No number has an estimate of its error"))

    def test_cycles_unload_by_masing(self):
        state = "--moment-ratio 0.7 --radius 0.2,0.9"
        up, back = self.json(state), self.json(state + " --unload-to=-0.7")["unloaded"]
        self.near(back["twist"] / up["twist"], -1, 1e-14)
        for one, other in zip(back["traction"], up["traction"], strict=True):
            self.near(one["value"] / other["value"], -1, 1e-14)
        # Half a loop and the quarter of the first loading.
        self.near(back["dissipated"] / up["energy_lost_per_cycle"], 0.75, 1e-13)
        none = self.json("--moment-ratio 0.7 --unload-to 0.7")
        self.near(none["unloaded"]["twist"] / none["twist"], 1, 1e-15)

    def test_cycles_give_the_curve_of_a_history(self):
        found = self.json("--history 0.8,-0.8,0.2,-0.1,0.2,0.8 --points 7 --radius 0.5")
        history = found["history"]
        self.assertEqual((len(history), len(found["curve"]), found["curve"][0]["twist"]), (6, 1 + 6 * 7, 0))
        for key in ("moment_ratio", "twist", "stick_ratio", "traction"):
            self.assertEqual(history[5][key], history[0][key], f"the loop closes: {key}")

    def test_the_load_at_first_yield_makes_the_largest_stress_the_yield_stress(self):
        """Hertz: p0^3 = 6 W E*^2/(pi^3 R^2). The other shape is pressed again, by the load that was found."""
        for profile, shape in (("hertz", "0.018"), ("power:4", "2e4")):
            state = f"--moment-ratio 0.8 --friction 0.4 --profile {profile} --at 0,0.3 --at largest --effective-modulus 115e9 --shape {shape}"
            other, most = self.json(f"{state} --normal-load 1000 --yield-stress 300e6")["stresses"]
            self.assertNotIn("yield_load", other)
            self.assertLess(abs(most["yield_pressure"] * most["von_mises"] / 300e6 - 1), 1e-14)
            again = self.json(f"{state} --normal-load {most['yield_load']!r}")
            self.assertLess(abs(again["units"]["reference_pressure"] / most["yield_pressure"] - 1), 1e-13, profile)
            if profile == "hertz":
                closed = math.pi**3 * 0.018**2 * most["yield_pressure"]**3 / (6 * 115e9**2)
                self.assertLess(abs(most["yield_load"] / closed - 1), 1e-13)

    def test_stresses_below_the_surface(self):
        state = "--moment-ratio 0.9 --at 0.5,0 --at 0,0.5 --radius 0.5"
        found = self.json(state)
        surface, axis = found["stresses"]
        self.near(surface["sigma_tz"], found["traction"][0]["value"], 1e-13)
        self.near(surface["sigma_zz"], -math.sqrt(0.75), 1e-15)
        self.near(axis["sigma_zz"], -0.8, 1e-15)  # -1/(1 + z^2), Hertz
        self.assertEqual((axis["radius"], axis["depth"], axis["sigma_rt"], axis["sigma_tz"]), (0, 0.5, 0, 0))
        self.assertNotIn("von_mises", axis)
        both = self.json(f"{state} --friction 0.3 --poisson 0.5")["stresses"][1]
        self.near(both["von_mises"], 1.2 - 1.5 * (1 - 0.5 * math.atan(2)), 1e-15)
        self.near(both["tresca"], both["von_mises"], 1e-15)
        self.text(f"{state} --friction 0.3", says=["at r/a = 0, depth z/a = 0.5", "von Mises"])
        self.assertNotIn("sigma_zz", self.json(f"{state} --profile constant")["stresses"][0])
        # Back at minus the moment everything of the torsion has changed its sign.
        back = self.json(f"{state} --unload-to=-0.9")["unloaded"]["stresses"]
        loop = self.json("--history 0.9,-0.9 --at 0.5,0 --at 0,0.5")["history"][1]["stresses"]
        self.assertEqual(back, loop)
        self.near(back[0]["sigma_tz"], -surface["sigma_tz"], 1e-13)
        for words, *says in (("--at 0.5", "--at"), ("--at 0.5,-1", "--at", "z/a = -1"), ("--at 0.5,1,2", "1,2"), ("--at 1,nan", "z/a = nan"),
                             ("--at 1,0 --profile flat_punch", "infinite there"), ("--at 0,1 --certified 20", ),
                             ("--friction 0.3", "--at"), ("--at 0,0.5 --friction 0.3 --yield-stress 3e8", "--at largest"),
                             ("--at largest --friction 0.3 --yield-stress 3e8 --profile rounded_punch --normal-load 1000 "
                              "--effective-modulus 1e11 --shape 1e-3,1e-2", "hertz, power:N")):
            self.refused(f"--moment-ratio 0.5 {words}", *says)

    def test_units_are_hertzs(self):
        found = self.json("--moment-ratio 0.5 --normal-load 1000 --effective-modulus 1.154e11 --shape 0.018 "
                          "--friction 0.1 --shear-modulus 4.04e10")
        a = (3 * 1000 * 0.018 / (4 * 1.154e11))**(1 / 3)
        for key, value in (("contact_radius", a), ("approach", a * a / 0.018),
                           ("reference_pressure", 1500 / (pi * a * a)), ("moment", 0.5 * 3 * pi / 16 * 0.1 * 1000 * a),
                           ("twist_angle", found["twist"] * 100 / (4.04e10 * a * a))):
            self.near(found["units"][key] / value, 1, 1e-14)

    def test_units_find_the_contact_of_a_rounded_punch(self):
        load, modulus, flat, corner = 1000, 1.154e11, 4e-4, 0.018
        units = self.json("--moment-ratio 0.5 --profile rounded_punch "
                          f"--normal-load {load} --effective-modulus {modulus} --shape {flat},{corner}")["units"]
        # Sneddon: W = 2 E* integral of f'(r) r^2/sqrt(a^2 - r^2), with f' = (r - b)/R beyond r = b, in r = a sin t.
        a = units["contact_radius"]
        t = math.asin(flat / a)
        cubes = math.cos(t) - math.cos(t)**3 / 3
        squares = (pi / 2 - t) / 2 + math.sin(2 * t) / 4
        self.near(2 * modulus / corner * (a**3 * cubes - flat * a**2 * squares) / load, 1, 1e-13)
        self.assertNotIn("moment", units)  # needs the friction coefficient

    def test_certified_gives_decimals_or_says_what_to_install(self):
        state = "--moment-ratio 0.5 --radius 0.3 --certified 30"
        if "libflint-dev" in self.text(state, code=(0, 1, 2)):
            return
        found = self.json(state)
        number = found["stick_ratio"]
        self.assertEqual((number["value"][:16], len(number["value"])), ("0.81356812612764", 32))
        self.assertLessEqual(float(number["radius"]), 0.51e-30)
        self.assertEqual(found["traction"][0]["radius"], "0.3")
        self.assertIn("radius", found["traction"][0]["value"])
        self.text(state, says="+/-")
        self.refused("--twist 0.1 --certified 20 --profile rounded_punch:0.5", "rounded_punch:0.5", "allowed")
