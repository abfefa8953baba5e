"""exact_answers_test.py PROGRAM: exact answers of scenes by hand, and why other scenes have none."""

import math
from pathlib import Path

from program_run import SCENES, ProgramTest

# The paper's case with mu = 0.1, to 30 digits from Hertz's formulas and the elliptic integrals.
PAPER = {"contact_radius": 0.48909732465087485e-3, "peak_pressure": 1995.9553043899548e6, "moment_limit": 28.810210537755196e-3}
STATES = {0.1: (0.9693964204953627, 1.197249389022587e-4), 0.5: (0.8135681261276496, 7.629453516649457e-4),
          0.9: (0.4958950522157781, 2.361048651456917e-3), 0.99: (0.2369661925296642, 4.413921104595224e-3)}
TOLERANCE = 1e-14  # the published digits, and a few roundings on the way from a scene's moduli to the number
SPHERE = 'shape = "sphere"\nradius = 0.018'
TRESCA = ("contact.friction_law=tresca", "contact.shear_strength=1e8")
NO_CONTRACTION = ("upper.poisson_ratio=0", "lower.poisson_ratio=0")
PUSH = "{moment_ratio=0, normal=1000, force=[%s, %s]}"
# Scenes, settings, and words of the reason.
NONE = (
    ("ellipse", ("contact.friction=0",), "friction"), ("ellipse", ("lower.poisson_ratio=0.2",), "coupling"),
    ("ellipse", ("lower.poisson_ratio=0.2", "load.moment_ratio=0"), "coupling"),
    ("ellipse", TRESCA, 'friction_law = "tresca"'), ("dissimilar", (), "coupling"), ("annulus", (), "inner radius"),
    ("patches", (), "several shapes"), ("rough_sphere", (), "several shapes"),
    ("paper", ("load.moment=0.02882",), "load.moment = 0.02882 N m", "gross slip", "M_lim = 0.02881"),
    ("cone", ("load.moment=0.0035",), "gross slip"),
    ("cone", ("contact.friction_law=capped", "contact.shear_strength=1e8"), '"capped"'), ("paper", ("load.twist=1e3",), "range"),
    ("paper", ("contact.friction=0",), "friction"), ("paper", ("contact.friction_map=map.csv",), "contact.friction_map"),
    ("paper", ("load.moment_ratio=0", "load.force=[30,40]"), "Poisson's ratios are 0"),
    ("mindlin", ("load.moment_ratio=0.1",), "torsion together with a force"),
    ("mindlin", ("load.displacement=[1e-7,0]",), "displacement is imposed"), ("mindlin", TRESCA, "Coulomb's law"),
    ("rounded_punch", (*NO_CONTRACTION, "load.moment_ratio=0", "load.force=[1,0]"), "similar to itself"),
    ("paper", ("grid.extent=[2e-3,2e-3]", "layer.kind=winkler", "layer.normal_compliance=0", "layer.tangential_compliance=1e-15"),
     "layer.kind"),
    ("coated_sphere", ("contact.coupling=auto",), "contact.coupling"), ("coated_sphere", ("load.force=[1,0]",), "force"),
    ("coated_sphere", ("lower.layer.thickness=1e-6",), "thickness"),
    ("cone", ("lower.layer.thickness=1e-4", "lower.layer.young_modulus=420e9", "lower.layer.poisson_ratio=0.25",
              "contact.coupling=none"), '"cone" on a layer'),
    ("paper", (*NO_CONTRACTION, f"step=[{PUSH % (30, 40)}, {PUSH % (60, 0)}]"), "several lines"),
    ("paper", ("step=[{moment_ratio=0.5, normal=1000}, {moment_ratio=0.5, normal=1100}]",), "while the normal load changes"),
)


class ExactAnswers(ProgramTest):
    def words(self, scene, *settings):
        file = scene if scene.endswith(".toml") else str(SCENES / f"{scene}.toml")
        return "solve", file, *(word for each in settings for word in ("--set", each))

    def exact(self, scene, *settings, words=()):
        return self.result(*self.words(scene, *settings), "--model", "exact", *words)

    def near(self, value, expected, within=TOLERANCE):
        self.assertAlmostEqual(value / expected, 1, delta=within)

    def test_the_papers_case(self):
        for ratio, (stick_ratio, twist) in STATES.items():
            found = self.exact("paper", f"load.moment_ratio={ratio}")
            for key, value in {**PAPER, "stick_ratio": stick_ratio, "twist_angle": twist}.items():
                self.near(found[key], value)

    def test_last_digits_cost_no_answer(self):
        plain = self.exact("paper")
        for change in ("lower.poisson_ratio=0.30000000000000004", "upper.at=[1e-18, 0]", "load.force=[1e-300, 0]"):
            self.near(self.exact("paper", change)["twist_angle"], plain["twist_angle"])

    def test_a_cone_and_a_flat_punch_have_no_peak(self):
        for scene in ("cone", "flat_punch"):
            found = self.exact(scene)
            self.assertEqual((found["peak_pressure"], found["peak_pressure_reason"]), (None, "infinite"))

    def test_a_flat_punch_sticks_everywhere_at_first(self):
        """Reissner and Sagoci: phi = 3 M/(16 G a^3)."""
        shear_modulus = 210e9 / 2.6 / 2
        for load in ("moment_ratio=0.5", "moment_ratio=0", "moment=0.033"):
            punch = self.exact("flat_punch", f"load.{load}")
            self.assertEqual(punch["stick_radius"], punch["contact_radius"])
            twist = 3 * punch["moment"] / (16 * shear_modulus * 5e-4**3)
            self.assertAlmostEqual(punch["twist_angle"], twist, delta=TOLERANCE * twist)

    def test_an_ellipsoid_of_equal_radii_is_a_sphere(self):
        sphere = self.exact("paper", "load.moment_ratio=0.7")
        ball = self.exact("ellipse", "upper.radius_1=0.018", "upper.radius_2=0.018", "load.moment_ratio=0.7")
        for key in ("profile", "contact_radius", "twist_angle"):
            self.assertEqual(ball[key], sphere[key])

    def test_the_peak_may_be_off_the_axis(self):
        """A body like r^4: p = P sqrt(1 - r^2) (1 + 2 r^2), whose load is (6 pi/5) a^2 P and whose peak at r^2 = 1/2 sqrt(2) P."""
        text = (SCENES / "paper.toml").read_text()
        self.write("power.toml", text.replace(SPHERE, 'shape = "power"\nexponent = 4\ncoefficient = 1e8'))
        power = self.exact("power.toml")
        self.near(power["peak_pressure"], math.sqrt(2) * 5 * 1000 / (6 * math.pi * power["contact_radius"]**2))
        peak = self.exact("rounded_punch", "grid.cells=[129,129]", words=("--fields", "f.csv"))["peak_pressure"]
        rows = [list(map(float, line.split(","))) for line in Path("f.csv").read_text().splitlines()[1:]]
        highest = max(row[2] for row in rows)
        self.assertLessEqual(highest, peak)
        self.assertGreaterEqual(highest, (1 - 1e-3) * peak)
        self.assertGreater(highest, 1.01 * min(rows, key=lambda row: math.hypot(*row[:2]))[2])

    def test_say_why_there_is_none(self):
        self.write("map.csv", 128 * (",".join(128 * ["1"]) + "\n"))
        self.run_program(*self.words("paper"), "--model", "best", code=2, says=("solver.model", "auto, full, exact"))
        self.run_program(*self.words("ellipse"), "--model", "exact", code=2,
                         says=("ellipse.toml", 'solver.model = "exact"', "auto, full", "ellipsoid"))
        for scene, settings, *says in NONE:
            settings = [each.replace("map.csv", str(self.folder / "map.csv")) for each in settings]
            self.run_program(*self.words(scene, *settings), "--model", "exact", code=2, says=says)
        result = self.result(*self.words("ellipse", "lower.poisson_ratio=0.2", "contact.coupling=none", "grid.cells=[16,16]"))
        self.assertIsNotNone(result["contact_radius_error"])
