"""same_answer_test.py PROGRAM: a scene has the same answer by every way to solve it: on the part of the grid that its
symmetry leaves and on all of it, by each sum, on several threads, with a map of friction that is 1 everywhere."""

import itertools
import json
from pathlib import Path

import numpy as np

from program_run import SHORT_SCENE, ProgramTest

COUPLING, TRANSLATIONS = "K13, K23", "translations"
QUADRANT, DIAGONAL = "three quarters of the contact", "one traction field"
SPHERE = 'shape = "sphere"\nradius = 0.018\n'
ELLIPSOID = 'shape = "ellipsoid"\nradius_1 = 0.036\nradius_2 = 0.018\n'
PUNCH = 'shape = "flat_punch"\nradius = 1e-3\n'
ROUGH = ('shape = [{shape = "sphere", radius = 0.018}, {shape = "roughness", seed = 1, hurst = 0.8, longest = 4e-4, '
         'shortest = 1e-4, rms_slope = 1e-3, period = 2e-3}]\n')
MAP = 'shape = "height_map"\nfile = "heights.csv"\n'
TIGHT = "solver.tolerance=1e-12"
SAME = 1e-9  # two answers of one discrete problem, each with a gap below 1e-12
SOFT = "lower.young_modulus=70e9"
# A surface, settings, and the ways to use less of the grid: a quadrant, half of it, without the rim (two cells on each side).
PARTS = (
    (SPHERE, (), "qdr"), (SPHERE, ("grid.cells=[24, 24]", "load.moment_ratio=0.97"), "qdr"),
    (SPHERE, ("load.twist=1e-3",), "qdr"), (SPHERE, ("grid.cells=[32, 24]",), "qr"),
    (SPHERE, ("grid.extent=[2e-3, 2e-3]",), "qdr"), (SPHERE, ("grid.extent=[0.99e-3, 0.99e-3]",), "qd"),
    (SPHERE, ("grid.cells=[31, 31]",), "r"), (SPHERE, ("grid.cells=[32, 27]",), "r"), (SPHERE, (SOFT,), "r"),
    (SPHERE, (SOFT, "contact.coupling=none"), "qdr"), (ELLIPSOID, (), "qr"),
    (ELLIPSOID, ("grid.extent=[1.5e-3, 1.5e-3]",), "qr"), (ELLIPSOID, ("load.twist=1e-3",), "qr"),
    (SPHERE, ("contact.pressure=hertz_averaged",), "qdr"), (ELLIPSOID, ("contact.pressure=hertz_averaged",), "qr"),
    (SPHERE, ("contact.pressure=hertz",), "qdr"), (SPHERE, ("solver.cell_traction=smooth",), "qdr"),
    (PUNCH, ("load.moment_ratio=0.95",), "qdr"),  # slips from its rim above 0.85 of the limit
)
WIDE = "grid.extent=[1.956e-3, 1.956e-3]"  # of four contact radii
LAYER = (WIDE, "layer.kind=winkler", "layer.normal_compliance=1.2e-14", "layer.tangential_compliance=0.6e-14")
THICK, THIN = (("thickness=2e-4", "young_modulus=420e9", "poisson_ratio=0.2"),
               ("thickness=4.9e-5", "young_modulus=105e9", "poisson_ratio=0.3"))


def coated(lower, upper):
    return WIDE, *(f"lower.layer.{key}" for key in lower), *(f"upper.layer.{key}" for key in upper)


LAWS = (LAYER, *((*law, f"contact.coupling={coupling}") for coupling in ("none", "pressure", "full")
                 for law in ((*LAYER, "upper.young_modulus=630e9", "upper.poisson_ratio=0.1"), coated(THICK, THIN))),
        ("contact.friction_law=tresca", "contact.shear_strength=8e7"),
        ("contact.friction_law=power", "contact.friction_exponent=0.6"))
PUSH = "step=[{moment_ratio=0, force=[40, 10]}, {moment_ratio=0.6}]"
MAPPED = ((SPHERE, ()), (SPHERE, (SOFT,)), (SPHERE, (SOFT, "contact.coupling=full")), (SPHERE, ("solver.model=full",)),
          (SPHERE, (PUSH,)), (SPHERE, (PUSH, "solver.substeps=2")), (SPHERE, (PUSH, "grid.cells=[27, 16]")),
          (SPHERE, ("upper.at=[1.3e-4, -0.4e-4]", "grid.extent=[1.6e-3, 1.4e-3]")), (SPHERE, LAWS[-2]),
          (ROUGH, ("grid.extent=[1.4e-3, 1.4e-3]",)))


TRESCA = LAWS[-2]
# By (1 - 2 nu)/G, whatever else they are.
ALIKE = ("lower.young_modulus=208e9", "upper.young_modulus=250e9", "upper.poisson_ratio=0.25", "load.force=[40, 20]")
# Two scenes that are one, and how much they may differ.
EQUAL = (
    (("contact.friction_law=power", "contact.friction_exponent=1"), (), SAME),
    (("contact.friction_law=capped", "contact.shear_strength=2.2e8"), (), SAME),  # above mu times the peak pressure
    (("contact.friction_law=capped", "contact.friction=1e6", "contact.shear_strength=8e7"), TRESCA, SAME),
    # p^1e-6 of 1 Pa to 2e9 Pa
    (("contact.friction_law=power", "contact.friction_exponent=1e-6", "contact.friction=8e7"), TRESCA, 1e-4),
    (("contact.friction_map=twos.csv",), ("contact.friction=0.2",), SAME),
    ((*LAYER, "layer.normal_compliance=0", "layer.tangential_compliance=0"), (WIDE,), 0.0),
    (coated(("thickness=1.5e-4", "young_modulus=210e9", "poisson_ratio=0.3"), ()), (WIDE,), SAME),
    *(((*alike, f"contact.coupling={coupling}"), (*alike, "contact.coupling=none"), SAME)
      for alike in (("load.force=[40, 20]",), ALIKE) for coupling in ("auto", "pressure", "full")),
)
RADIUS = 0.48909732465087485e-3  # of the contact
STEP = RADIUS / 10  # cells of the scenes that are moved and turned
# Numbers of a scene in SI units, with their powers of metre and newton.
STEEL = {"upper.young_modulus": (210e9, -2, 1), "lower.young_modulus": (210e9, -2, 1), "load.normal": (1000.0, 0, 1)}
BALL = {"upper.radius": (0.018, 1, 0)}
BOX = {"grid.extent": ((1.6e-3, 1.2e-3), 1, 0)}
IN_UNITS = (
    (SPHERE, BALL, ()), (SPHERE, {**BALL, "load.moment": (0.025929189483979677, 1, 1)}, ()),
    (ELLIPSOID, {"upper.radius_1": (0.03, 1, 0), "upper.radius_2": (0.01, 1, 0), "upper.at": ((1e-4, -5e-5), 1, 0), **BOX},
     ("upper.angle=0.4",)),
    (SPHERE, {**BALL, "lower.layer.thickness": (2e-4, 1, 0), "lower.layer.young_modulus": (651e9, -2, 1)},
     ("lower.layer.poisson_ratio=0.21",)),
    (SPHERE, {**BALL, "contact.shear_strength": (7e7, -2, 1)}, ("contact.friction_law=capped",)),
    (SPHERE, {**BALL, "contact.friction": (500.0, -0.8, 0.4)}, LAWS[-1]),
    ('shape = "cone"\nslope = 0.02\n', BOX, ()),
    ('shape = "power"\nexponent = 3.5\ncoefficient = 1\n', {"upper.coefficient": (1e7, -2.5, 0)}, ()),
    ('shape = "rounded_punch"\nflat_radius = 1\ncorner_radius = 1\n',
     {"upper.flat_radius": (3e-4, 1, 0), "upper.corner_radius": (5e-3, 1, 0)}, ()),
    (PUNCH, {"upper.radius": (6e-4, 1, 0), "upper.inner_radius": (1e-4, 1, 0)}, ()),
    (ROUGH, {"upper.shape[0].radius": (0.018, 1, 0), "upper.shape[1].longest": (4e-4, 1, 0), "upper.shape[1].shortest":
             (1e-4, 1, 0), "upper.shape[1].period": (2e-3, 1, 0), "grid.extent": ((1.4e-3, 1.4e-3), 1, 0)}, ()),
)
POWERS = {"twist_angle": (0, 0), "moment": (1, 1), "moment_limit": (1, 1), "normal_load": (0, 1), "peak_pressure": (-2, 1),
          "contact_radius": (1, 0), "stick_radius_counted": (1, 0), "approach": (1, 0)}


def on_grid(result, fields, name):
    """A field over all cells."""
    whole = np.zeros(result["cells"])
    along = zip(("x1", "x2"), result["cell_size"], result["cells"])
    whole[tuple(np.rint(fields[x] / h + (n - 1) / 2).astype(int) for x, h, n in along)] = fields[name]
    return whole


class SameAnswer(ProgramTest):
    def solved(self, surface, *settings):
        """The result of a scene that converges, and its fields."""
        text = SHORT_SCENE.replace(SPHERE, surface)
        text = text.replace("cells = [32, 32]\n", "") if surface.startswith(MAP) else text
        sets = itertools.chain(*(("--set", setting) for setting in settings))
        self.run_program("solve", self.write("scene.toml", text), *sets, "--quiet", "--json", "r.json", "--fields", "f.csv")
        return json.loads(Path("r.json").read_text()), np.genfromtxt("f.csv", delimiter=",", names=True)

    def assert_same(self, one, reference, tolerance, message=None):
        (numbers, fields), (other_numbers, other_fields) = one, reference
        for names in (("pressure",), ("q1", "q2"), ("slip1", "slip2")):
            apart = max(np.abs(fields[name] - other_fields[name]).max() for name in names)
            self.assertLessEqual(apart, tolerance * max(np.abs(other_fields[name]).max() for name in names), (names, message))
        for key in ("twist_angle", "moment", "moment_limit", "normal_load", "approach"):
            number, other = (result[key] or 0.0 for result in (numbers, other_numbers))  # Hertz's approach is not known
            self.assertLessEqual(abs(number - other), tolerance * abs(other), (key, message))
        for key in ("stick_cells", "contact_cells"):
            self.assertEqual(numbers[key], other_numbers[key], message)

    def left_out(self, result):
        self.assertTrue(all(part["why"] for part in result["model"]["left_out"]))
        return [part["what"] for part in result["model"]["left_out"]]

    def sides_of(self, result, fields):
        """Cells along the sides of the smallest rectangle about the origin that holds the contact."""
        return [round(2 * np.abs(fields[x]).max() / h) + 1 for x, h in zip(("x1", "x2"), result["cell_size"])]

    def rim_of(self, result, fields):
        return "all but {} x {} of {} x {} cells".format(*self.sides_of(result, fields), *result["cells"])

    def test_on_a_part_of_the_grid_and_on_all_of_it(self):
        for surface, settings, parts in PARTS:
            with self.subTest(surface=surface, settings=settings):
                result, fields = self.solved(surface, TIGHT, *settings)
                full = self.solved(surface, TIGHT, *settings, "solver.model=full")
                self.assert_same((result, fields), full, 1e-10)
                self.assertTrue((fields["stick"] == full[1]["stick"]).all())
                self.assertTrue(0 < result["stick_cells"] < result["contact_cells"])
                for answer in (result, full[0]):
                    self.assertLess(answer["certificate"]["gap"], 1.02e-12)
                    self.assertLessEqual(max(answer["certificate"][key] for key in ("moment", "friction_bound")), 1e-12)
                coupling = "K31, K32" if settings == (SOFT,) else COUPLING
                expected = [coupling, TRANSLATIONS] + [self.rim_of(result, fields)] * ("r" in parts)
                self.assertEqual(self.left_out(result), expected + [QUADRANT] * ("q" in parts) + [DIAGONAL] * ("d" in parts))
                # The solve took the part that is named; the full model leaves out nothing that the scene allows.
                images = 2 if "q" in parts else 1
                self.assertEqual(result["grids"][-1]["cells"], [n // images for n in self.sides_of(result, fields)])
                self.assertEqual(self.left_out(full[0]), [coupling] if SOFT in settings else [])
                self.assertEqual(full[0]["grids"][-1]["cells"], full[0]["cells"])

    def test_by_each_sum_and_on_threads(self):
        for settings in LAWS:
            settings = (TIGHT, "grid.cells=[24, 24]", *settings)
            reference = self.solved(SPHERE, *settings)
            self.assertTrue(0 < reference[0]["stick_cells"] < reference[0]["contact_cells"])
            for way, tolerance in (("model=full", SAME), ("operator=direct", SAME), ("operator=dense", SAME),
                                   ("threads=3", 0.0)):
                answer = self.solved(SPHERE, *settings, f"solver.{way}")
                self.assert_same(answer, reference, tolerance, (settings, way))
                self.assertLessEqual(answer[0]["certificate"]["gap"], 1.02e-12)
                self.assertGreaterEqual(answer[0]["predicted_bytes"], answer[0]["solver_bytes"])
        result, _ = self.solved(SPHERE, "grid.cells=[12, 12]", "solver.operator=direct")
        self.assertEqual((self.left_out(result), result["grids"][-1]["cells"]), ([COUPLING, TRANSLATIONS], [12, 12]))

    def test_of_scenes_that_are_one(self):
        np.savetxt("twos.csv", np.full((32, 32), 2.0), delimiter=",")
        for one, other, tolerance in EQUAL:
            self.assert_same(self.solved(SPHERE, TIGHT, *one), self.solved(SPHERE, TIGHT, *other), tolerance, one)

    def test_in_other_units(self):
        for (surface, numbers, settings), (metre, newton) in itertools.product(
                IN_UNITS, ((1e3, 1.0), (1e9, 1e9), (1e6, 1e3), (1e-3, 1e-6))):
            def solved(metre, newton):
                scaled = (f"{key}={np.multiply(value, metre**m * newton**n).tolist()!r}"
                          for key, (value, m, n) in (STEEL | numbers).items())
                return self.solved(surface, *settings, *scaled)
            (si, si_fields), (other, other_fields) = solved(1.0, 1.0), solved(metre, newton)
            for key in ("stick_cells", "contact_cells", "iterations"):
                self.assertEqual(other[key], si[key])
            for key, (m, n) in POWERS.items():
                self.assertAlmostEqual(other[key] / (si[key] * metre**m * newton**n), 1.0, delta=1e-12, msg=key)
            pascal = newton / metre**2
            for names, unit in ((("pressure",), pascal), (("q1", "q2"), pascal), (("slip1", "slip2"), metre)):
                size = max(np.abs(si_fields[name]).max() for name in names)
                for name in names:
                    self.assertLessEqual(np.abs(other_fields[name] / unit - si_fields[name]).max(), 1e-12 * size, name)

    def test_off_the_origin(self):
        """A body free to move turns about the point where it touches."""
        settings = (TIGHT, "load.moment_ratio=0.6", "grid.cells=[40, 40]", f"grid.extent=[{40 * STEP}, {40 * STEP}]")
        centred = self.solved(SPHERE, *settings)
        for cells in ((5, -7), (-8, 0), (1, 9)):
            at = np.multiply(cells, STEP)
            off = self.solved(SPHERE, *settings, f"upper.at={at.tolist()}")
            twist = off[0]["twist_angle"]
            for name in ("pressure", "q1", "q2"):
                expected = np.roll(on_grid(*centred, name), cells, (0, 1))
                self.assertLessEqual(np.abs(on_grid(*off, name) - expected).max(), SAME * np.abs(expected).max())
            for key in ("twist_angle", "moment_limit"):
                self.assertAlmostEqual(off[0][key] / centred[0][key], 1.0, delta=SAME)
            for moved, expected in zip(off[0]["displacement"], (twist * at[1], -twist * at[0])):
                self.assertAlmostEqual(moved, expected, delta=SAME * twist * RADIUS)
            self.assertLessEqual(np.abs(np.subtract(off[0]["limit"]["centre"], at)).max(), 1e-6 * RADIUS)

    def test_turned_with_the_grid_and_by_motions_in_place_of_loads(self):
        settings = (TIGHT, "grid.cells=[28, 28]", f"grid.extent=[{28 * STEP}, {28 * STEP}]")

        def pushed(angle, ratio, *more):
            force = [50.0 * np.cos(angle), 50.0 * np.sin(angle)]
            return self.solved(SPHERE, *settings, f"load.moment_ratio={ratio}", f"load.force={np.array(force).tolist()}", *more)

        for angle, ratio in ((0.4, 0.5), (0.0, 0.0)):
            one, turned = pushed(angle, ratio), pushed(angle + np.pi / 2, ratio)
            q1, q2 = (on_grid(*one, name) for name in ("q1", "q2"))
            for name, expected in (("q1", -q2.T[::-1]), ("q2", q1.T[::-1])):
                self.assertLessEqual(np.abs(on_grid(*turned, name) - expected).max(), SAME * np.abs(q1).max())
            (delta1, delta2), twist = one[0]["displacement"], one[0]["twist_angle"]
            size = np.hypot(delta1, delta2)
            self.assertLessEqual(np.abs(np.subtract(turned[0]["displacement"], (-delta2, delta1))).max(), SAME * size)
            self.assertAlmostEqual(turned[0]["twist_angle"] * RADIUS, twist * RADIUS, delta=SAME * size)
            if ratio == 0.0:
                self.assertLessEqual(max(abs(delta2), abs(twist * RADIUS)), SAME * size)
                continue
            for motions in (["displacement"], ["twist"], ["displacement", "twist"]):  # in place of the force, of the moment
                loads = {"displacement": [delta1, delta2], "twist": twist}
                imposed = [f"load.{key}={loads[key]!r}" for key in motions]
                imposed += [] if "displacement" in motions else [f"load.force={one[0]['force']}"]
                imposed += [] if "twist" in motions else [f"load.moment_ratio={ratio}"]
                moved = self.solved(SPHERE, *settings, *imposed)
                self.assert_same(moved, one, SAME, motions)
                for key in ("force", "displacement"):
                    self.assertLessEqual(np.abs(np.divide(moved[0][key], one[0][key]) - 1.0).max(), SAME)

    def test_with_a_map_that_is_no_mirror(self):
        """The pressure gets its asymmetry under full coupling. After a load that has been larger, tractions have the map's
        symmetry, not that of the cells that are left. A map turns with the scene. Cells without friction carry nothing."""
        i, j = np.indices((24, 24))

        def mapped(factors, *settings):
            np.savetxt("map.csv", factors, delimiter=",")
            return self.solved(SPHERE, TIGHT, "grid.cells=[24, 24]", "contact.friction_map=map.csv", *settings)

        falling = "step=[{normal=1000}, {normal=400}, {normal=300}]"
        for factors, settings in ((0.25 * ((3 * i + j) % 5), (SOFT, "contact.coupling=full")),
                                  (np.where(i < 21, 1, 0.2), (falling,))):
            one = mapped(factors, *settings)
            self.assert_same(mapped(factors, *settings, "solver.model=full"), one, SAME)
            pressure = on_grid(*one, "pressure")
            if "contact.coupling=full" in settings:
                self.assertGreater(np.abs(pressure - pressure[::-1, ::-1]).max(), 1e-4 * pressure.max())
        factors = 1 + 0.02 * i + 0.01 * j
        (one, _), (turned, _) = mapped(factors), mapped(factors.T[::-1])
        for key in ("twist_angle", "moment_limit"):
            self.assertAlmostEqual(turned[key] / one[key], 1.0, delta=SAME)
        half = mapped(np.where(i < 12, 0, 1))
        self.assertEqual(max(np.abs(on_grid(*half, name)[:12]).max() for name in ("q1", "q2")), 0.0)
        self.assertLessEqual(np.hypot(*half[0]["force"]), 1e-9 * half[0]["friction_force"])
        self.assertGreater(half[0]["limit"]["centre"][0], 0.1 * half[0]["contact_radius"])

    def test_with_the_bodies_exchanged(self):
        """That reverses all loads, and nothing else."""
        bodies = ((coated(THICK, THIN), coated(THIN, THICK)),
                  ((SOFT, "lower.poisson_ratio=0.1"), ("upper.young_modulus=70e9", "upper.poisson_ratio=0.1")))
        for coupling, (below, above) in itertools.product(("none", "pressure", "full"), bodies):
            settings = (SPHERE, TIGHT, "contact.friction=0.3", f"contact.coupling={coupling}")
            one, other = self.solved(*settings, *below), self.solved(*settings, *above, "load.moment_ratio=-0.5")
            for part, names in zip(other, (("twist_angle", "moment"), ("q1", "q2", "slip1", "slip2"))):
                for name in names:
                    part[name] = -part[name]
            self.assert_same(other, one, SAME, (coupling, below))

    def test_by_the_papers_method(self):
        """It stops on change, and a cell keeps the direction in which it began to slip: against the reference 9e-4, which
        fades with the mesh. Both parts of the grid break Coulomb's law alike."""
        reference = self.solved(SPHERE, TIGHT, *LAYER)
        self.assert_same(self.solved(SPHERE, TIGHT, *LAYER, "contact.coupling=full"), reference, SAME)
        papers = self.solved(SPHERE, TIGHT, *LAYER, "solver.method=paper")
        apart = np.abs(papers[1]["q1"] - reference[1]["q1"]).max()
        self.assertLessEqual(apart, 3e-3 * np.abs(reference[1]["q1"]).max())
        self.assertLessEqual(papers[0]["certificate"]["gap"], 1e-3)
        for surface, *settings in ((SPHERE,), (ELLIPSOID,), (SPHERE, "grid.cells=[27, 27]", "load.moment_ratio=0.7")):
            settings += ["solver.method=paper", "solver.tolerance=1e-10"]
            part, full = self.solved(surface, *settings), self.solved(surface, *settings, "solver.model=full")
            self.assert_same(part, full, 1e-8)
            self.assertAlmostEqual(part[0]["certificate"]["gap"] / full[0]["certificate"]["gap"], 1.0, delta=1e-3)
            self.assertEqual(self.left_out(full[0]), [TRANSLATIONS])
            self.assertIn(self.rim_of(*part), self.left_out(part[0]))

    def test_with_a_map_of_ones(self):
        for surface, settings in MAPPED:
            settings = ("grid.cells=[24, 24]", "load.moment_ratio=0.6", *settings)
            plain = self.solved(surface, *settings)
            np.savetxt("ones.csv", np.ones(plain[0]["cells"]), delimiter=",")
            mapped = self.solved(surface, *settings, "contact.friction_map=ones.csv")
            self.assert_same(mapped, plain, 0.0, settings)
            self.assertEqual(mapped[0]["resolved"], plain[0]["resolved"])

    def test_symmetry_of_a_height_map_is_found_and_not_made_up(self):
        """A bowl with ripples; a nanometre in one cell is no mirror image. A ring on an odd number of cells has no quadrant:
        no force acts on it, and rounding leaves none."""
        x1, x2 = np.meshgrid(np.arange(-19, 20, 2), np.arange(-23, 24, 2), indexing="ij")
        heights = 3e-8 * (x1**2 + x2**2) + 1e-7 * np.cos(0.9 * x1) * np.cos(1.1 * x2)
        for bump in (0.0, 1e-9):
            heights[11, 13] += bump
            np.savetxt("heights.csv", heights, delimiter=",", fmt="%.17g")
            surface = MAP + "spacing = [5e-5, 5e-5]\n"
            result, fields = self.solved(surface, TIGHT)
            self.assert_same((result, fields), self.solved(surface, TIGHT, "solver.model=full"), 1e-10)
            self.assertEqual(QUADRANT in self.left_out(result), bump == 0.0)
            self.assertFalse(bump and DIAGONAL in self.left_out(result))
        x1, x2 = np.meshgrid(np.arange(-51, 52, 2), np.arange(-52, 53, 2), indexing="ij")
        for ring in (0.45, 0.75, 0.9):
            np.savetxt("heights.csv", 1.5e-5 * (0.5 * np.hypot(x1, x2) / 52 - 0.5 * ring)**2, delimiter=",", fmt="%.17g")
            for ratio, parts in itertools.product((-0.5, 0.7, 0.9), (1, 8)):
                result, _ = self.solved(MAP + "spacing = [1e-5, 1e-5]\n", "lower.young_modulus=6.8e9", "load.normal=0.1",
                                        f"load.moment_ratio={ratio}", f"solver.substeps={parts}")
                self.assertTrue(TRANSLATIONS in self.left_out(result) and QUADRANT not in self.left_out(result))
                self.assertLessEqual(result["certificate"]["force"], 1e-15)

    def test_of_a_height_map_is_that_of_its_body(self):
        """A line of a map is a row of cells along x2; its deepest point is a cell's centre."""
        spacing = np.array([5e-5, 4e-5])
        x1, x2 = (step * (np.arange(n) - (n - 1) / 2) for step, n in zip(spacing, (33, 25)))
        heights = x1[:, None]**2 / 0.072 + x2**2 / 0.036
        body = self.solved(ELLIPSOID, TIGHT, "grid.cells=[33, 25]", f"grid.extent={(spacing * (33, 25)).tolist()}")
        for unit, words in ((1.0, ""), (1e-6, 'unit = "um"\n')):
            np.savetxt("heights.csv", heights / unit + 1.0, delimiter=",", fmt="%.17g")
            self.assert_same(self.solved(f"{MAP}spacing = {spacing.tolist()}\n{words}", TIGHT), body, SAME)

    def test_pressure_of_a_file_needs_the_whole_grid(self):
        """It need not have the mirrors of the surface that is said to cause it."""
        rows = [f"{(i - 7.5) * 62.5e-6},{(j - 7.5) * 62.5e-6},{1e9 + 1e7 * i}" for i in range(16) for j in range(16)]
        self.write("p.csv", "\n".join(["x1,x2,pressure", *rows, ""]))
        settings = ("contact.pressure=file", "contact.pressure_file=p.csv", "grid.cells=[16, 16]", "grid.extent=[1e-3, 1e-3]",
                    "upper.ends_at_grid_edge=true", "load.normal=1075")
        result, fields = self.solved(SPHERE, *settings)
        self.assertAlmostEqual(np.abs(fields["pressure"] / (1e9 + 1e7 * (fields["x1"] / 62.5e-6 + 7.5)) - 1).max(), 0, delta=1e-11)
        self.assertEqual(self.left_out(result), [COUPLING])  # it turns about a centre of its own
        self.assertEqual(self.solved(SPHERE, *settings, "solver.model=full")[0]["solver_bytes"], result["solver_bytes"])
