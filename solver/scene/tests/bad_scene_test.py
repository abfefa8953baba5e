"""bad_scene_test.py PROGRAM: refused scenes; the message names file, key, value and allowed values."""

import itertools
from pathlib import Path

from program_run import SHORT_SCENE, ProgramTest

SCENE = """name = "paper"
[upper]
shape = "sphere"
radius = 0.018
young_modulus = 210e9
poisson_ratio = 0.3
[lower]
young_modulus = 210e9
poisson_ratio = 0.3
[contact]
friction = 0.1
pressure = "solved"
coupling = "auto"
[load]
normal = 1000.0
moment_ratio = 0.9
force = [0.0, 0.0]
[grid]
cells = [128, 96]
extent = [0.0011, 0.0012]
[solver]
method = "paper"
operator = "dcfft"
tolerance = 1e-7
max_iterations = 70
threads = 2
model = "auto"
"""
SPHERE = 'shape = "sphere"\nradius = 0.018'
LONGEST = 'shape = "roughness"\nlongest = 1e-4\n'
ROUGH = LONGEST + "seed = 1\nhurst = 0.8\nrms_slope = 0.1\n"
# Text of the scene, what stands in its place, settings, and parts of the message: where, key, value, what is allowed.
BAD = [
    ("friction = 0.1", "friction = 0.1\nfricton = 0.2", [], "scene.toml:12", "contact.fricton = 0.2", "unknown key",
     "nearest known one is contact.friction"),
    ("[grid]", "[gird]\ncells = [1, 2]\n[grid]", [], "gird.cells", "nearest known one is grid.cells"),
    ("friction = 0.1", "frictoin = 0.1", [], "scene.toml:11", "contact.frictoin = 0.1",
     "nearest known one is contact.friction"),
    ("[contact]", '"contact.friction " = 1\n[contact]', [], "unknown key"),
    ("[contact]", '"frict[ion" = 1\n[contact]', [], "frict[ion", "unknown key"),
    ("friction = 0.1", "", [], "contact.friction", "(missing)", "a number"),
    ('shape = "sphere"', "", [], "upper.shape", "(missing)"),
    ("normal = 1000.0", 'normal = "1 stone"', [], "scene.toml:15", "load.normal", "1 stone", "a number", "N, mN, kN"),
    ('shape = "sphere"', "shape = 3", [], "scene.toml:3", "upper.shape = 3", "a string"),
    ("radius = 0.018", "radius = true", [], "scene.toml:4", "upper.radius = true", "a number"),
    ("normal = 1000.0", "normal = -1000.0", [], "scene.toml:15", "load.normal = -1000:", "positive and finite"),
    ("radius = 0.018", "radius = 0", [], "scene.toml:4", "upper.radius = 0", "positive and finite"),
    ("young_modulus = 210e9", "young_modulus = inf", [], "scene.toml:5", "upper.young_modulus = inf",
     "positive and finite"),
    ("poisson_ratio = 0.3", "poisson_ratio = 0.6", [], "scene.toml:6", "upper.poisson_ratio = 0.6",
     "above -1, at most 0.5"),
    ("poisson_ratio = 0.3", "poisson_ratio = -1.0", [], "upper.poisson_ratio = -1", "above -1, at most 0.5"),
    ("[contact]", "[lower.layer]\nthickness = 0\nyoung_modulus = 1e9\npoisson_ratio = 0.3\n[contact]", [],
     "scene.toml:11", "lower.layer.thickness = 0", "positive and finite"),
    ("[contact]", "[lower.layer]\nthickness = 1e-4\nyoung_modulus = 1e9\n[contact]", [], "lower.layer.poisson_ratio",
     "(missing)", "above -1, at most 0.5"),
    ("[contact]", "[lower.layer]\nthicknes = 1e-4\n[contact]", [], "lower.layer.thicknes",
     "nearest known one is lower.layer.thickness"),
    ("friction = 0.1", "friction = -0.1", [], "contact.friction = -0.1", "zero or positive"),
    ("friction = 0.1", 'friction = 0.1\nfriction_law = "tresca"\nshear_strength = 1e8', [], "contact.friction = 0.1: allowed: left out: "
     'friction_law = "tresca" takes contact.shear_strength and no contact.friction'),
    ("friction = 0.1", "friction = 0.1\nshear_strength = 1e8", [], "no contact.shear_strength"),
    ("friction = 0.1", 'friction = 0.1\nfriction_law = "capped"\nshear_strength = 1e8\nfriction_exponent = 2', [],
     "no contact.friction_exponent"),
    ("moment_ratio = 0.9", "moment_ratio = 1.0", [], "scene.toml:16", "load.moment_ratio = 1:",
     "above -1 and below 1", "gross slip"),
    ("moment_ratio = 0.9", "moment_ratio = nan", [], "load.moment_ratio = nan", "above -1 and below 1"),
    ("moment_ratio = 0.9", "moment = inf", [], "load.moment = inf:", "finite"),
    ("moment_ratio = 0.9", "twist = inf", [], "load.twist = inf", "finite"),
    ("tolerance = 1e-7", "tolerance = 0", [], "solver.tolerance = 0", "from 1e-15 to below 1"),
    ("tolerance = 1e-7", "tolerance = nan", [], "solver.tolerance = nan", "from 1e-15 to below 1"),
    ("moment_ratio = 0.9", "moment_ratio = 0.9\ntwist = 1e-3", [], "load.twist",
     "exactly one of load.moment_ratio, load.moment, load.twist"),
    ("moment_ratio = 0.9", "", [], "(missing)", "exactly one of load.moment_ratio, load.moment, load.twist"),
    ("force = [0.0, 0.0]", "force = [0.0, 1.0]\ndisplacement = [0.0, 1e-6]", [], "load.displacement",
     "one of force, displacement"),
    ("force = [0.0, 0.0]", "force = [0.0, 1.0]", [], 'solver.method = "paper"', "coulomb"),
    ("cells = [128, 96]", "cells = [128.5, 96]", [], "grid.cells", "128.5", "a whole number from 1 to 65536"),
    ("cells = [128, 96]", "cells = [128, 0]", [], "grid.cells", "a whole number from 1 to 65536"),
    ("cells = [128, 96]", "cells = [128]", [], "grid.cells", "[a, b], two numbers"),
    ("cells = [128, 96]", "cells = [128, 96, 3]", [], "grid.cells", "[a, b], two numbers"),
    ("cells = [128, 96]", "cells = [9223372036854775807, 96]", [], "grid.cells", "a whole number from 1 to 65536"),
    ("cells = [128, 96]", "cells = 128", [], "grid.cells = 128", "[a, b], two numbers"),
    ("cells = [128, 96]", 'cells = ["a", "b"]', [], "grid.cells", "[a, b], two numbers"),
    ("extent = [0.0011, 0.0012]", "extent = [-1.0, 1.0]", [], "grid.extent", "positive and finite"),
    ('shape = "sphere"', 'shape = "cube"', [], "scene.toml:3", 'upper.shape = "cube"',
     "sphere, ellipsoid, cone, flat_punch, rounded_punch, power, height_map, roughness"),
    ('pressure = "solved"', 'pressure = "Hertz"', [], 'contact.pressure = "Hertz"',
     "solved, hertz, hertz_averaged, file"),
    ('coupling = "auto"', 'coupling = "both"', [], 'contact.coupling = "both"', "auto, none, pressure, full"),
    ('operator = "dcfft"', 'operator = "fft"', [], 'solver.operator = "fft"', "dcfft, direct, dense"),
    ('method = "paper"', 'method = "magic"', [], 'solver.method = "magic"', "paper"),
    ('model = "auto"', 'model = "some"', [], 'solver.model = "some"', "auto"),
    ("threads = 2", "threads = -1", [], "solver.threads = -1", "a whole number from 0"),
    ("max_iterations = 70", "max_iterations = 0", [], "solver.max_iterations = 0", "a whole number from 1"),
    ("radius = 0.018", "radius = 0.018\nrigid = true", [], "upper.rigid = true", "no upper.young_modulus"),
    ("radius = 0.018", "radius = 0.018\nrigid = 1", [], "upper.rigid = 1", "true, false"),
    (SPHERE, 'shape = "cone"\nslope = 0.1', ["contact.pressure=hertz"], "contact.pressure", '"hertz"',
     "solved, file"),
    ('shape = "sphere"', 'shape = "cone"\nslope = 0.1', [], "upper.radius = 0.018", "unknown key"),
    ("extent = [0.0011, 0.0012]", "", ["contact.pressure=file", "contact.pressure_file=p.csv"], "grid.extent",
     "(missing)"),
    ("friction = 0.1", "friction = = 0.1", [], "scene.toml:11"),
    ("friction = 0.1", "friction = 0.1\nfriction = 0.2", [], "scene.toml:12"),
    ("", "", ["load=3"], "load = 3", "a table with the key load.normal"),
    ("", "", ["load.twist=1e-3", "load.moment=1e-3"], "exactly one of load.moment_ratio, load.moment, load.twist"),
    ("", "", ["load.normal"], "--set load.normal", "key=value"),
    ("", "", ["=3"], "--set =3", "key=value"),
    ("", "", ["load.nromal=3"], "load.nromal = 3", "unknown key", "load.normal"),
    ("", "", ["load.normal=-3"], "load.normal = -3", "positive and finite"),
    ("", "", ["load.normal.x=3"], "--set load.normal.x=3", "normal is not a table"),
    (SCENE, "", [], "upper.shape", "(missing)"),
    (SPHERE, 'shape = "flat_punch"\nradius = 1e-3\ninner_radius = 1e-3', [], "scene.toml:5",
     "upper.inner_radius = 0.001", "below the radius"),
    (SPHERE, 'shape = "power"\nexponent = 0.5\ncoefficient = 1', [], "upper.exponent = 0.5", "from 1 to 20"),
    (SPHERE, 'shape = "sphere"\nradius = 1\nat = [0, 0, 0]', [], "upper.at = [0, 0, 0]", "[a, b], two numbers"),
    (SPHERE, 'shape = "sphere"\nradius = 1\nat = [0, inf]', [], "upper.at", "finite"),
    (SPHERE, 'shape = "sphere"\nradius = 1\nangle = nan', [], "upper.angle = nan", "finite"),
    (SPHERE, 'shape = "height_map"\nfile = "h.csv"\nspacing = [1, 1]\nat = [0, 0]', [], "upper.at = [0, 0]",
     "unknown key"),
    (SPHERE, 'shape = "height_map"\nfile = "h.csv"\nspacing = [1, 1]\nunit = "cm"', [], 'upper.unit = "cm"',
     "m, mm, um, nm"),
    (SPHERE, 'shape = "sphere"\nradius = 1\ncombine = "sum"', [], "upper.combine = ", "unknown key"),
    (SPHERE, LONGEST + "hurst = 0\nseed = 1", [], "upper.hurst = 0", "above 0, at most 1"),
    (SPHERE, LONGEST + "hurst = 1.1\nseed = 1", [], "upper.hurst = 1.1", "above 0, at most 1"),
    (SPHERE, LONGEST + "seed = 1.5", [], "upper.seed = 1.5", "a whole number from 0"),
    (SPHERE, ROUGH + "shortest = 1e-5\nperiod = 9e-5", [], "upper.period = 9e-05", "at least longest = 0.0001"),
    (SPHERE, ROUGH + "shortest = 6e-5", [], "upper.shortest = 6e-05", "to half of longest, 5e-05"),
    (SPHERE, ROUGH + "shortest = 3e-7", [], "upper.shortest = 3e-07", "from a 1024th of the period, 3.90625e-07"),
    (SPHERE, "shape = []", [], "scene.toml:3", "upper.shape = []", "[[upper.shape]]"),
    (SPHERE, "shape = [1, 2]", [], "upper.shape = [1, 2]", "[[upper.shape]]"),
    (SPHERE, 'shape = [{shape = "sphere", radius = 1}, {shape = "sphere"}]', [], "upper.shape[1].radius",
     "(missing)"),
    (SPHERE, 'shape = [{shape = "sphere", radius = 1, angel = 2}]', [], "upper.shape[0].angel = 2",
     "nearest known one is upper.shape[0].angle"),
    (SPHERE, 'radius = 1\nshape = [{shape = "sphere", radius = 1}]', [], "upper.radius = 1", "unknown key"),
    (SPHERE, 'combine = "product"\nshape = [{shape = "sphere", radius = 1}, {shape = "sphere", radius = 1}]', [],
     'upper.combine = "product"', "sum, nearest"),
    *((SPHERE, shape, ["contact.pressure=hertz"], 'contact.pressure = "hertz"') for shape in (
        'shape = [{shape = "sphere", radius = 1}, {shape = "sphere", radius = 1}]', 'shape = "flat_punch"\nradius = 1e-3',
        'shape = "ellipsoid"\nradius_1 = 0.02\nradius_2 = 0.01\nangle = 0.4')),
    ("radius = 0.018", "radius = 0.018\nat = [1e-4, 0]", ["contact.pressure=hertz"], 'contact.pressure = "hertz"',
     "solved, file", "at the origin"),
]


class BadScene(ProgramTest):
    def refused(self, text, *says, settings=()):
        """By the reader, or before the solve."""
        sets = itertools.chain(*(("--set", setting) for setting in settings))
        self.run_program("solve", self.write("scene.toml", text), *sets, code=2, says=says)

    def test_is_refused_with_file_key_value_and_what_is_allowed(self):
        for old, new, settings, *says in BAD:
            self.assertIn(old, SCENE)
            where = "scene.toml" if not settings else "" if old else "--set"
            self.refused(SCENE.replace(old, new, 1), where, *says, settings=settings)

    def test_all_unknown_keys_are_named_before_anything_is_missing(self):
        """The words that newcomers tried, each with the key that it stands for."""
        text = """friction = 0.2
[upper]
shape = "sphere"
diameter = 0.036
E = 210e9
nu = 0.3
[upper.coating]
thickness = 1e-4
[contact]
mu = 0.1
[load]
normal_load = 1000
twist_deg = 1
cycles = 3
"""
        pairs = {1: ("friction", "contact.friction"), 4: ("upper.diameter", "upper.radius (half of it)"),
                 5: ("upper.E", "upper.young_modulus"), 6: ("upper.nu", "upper.poisson_ratio"),
                 8: ("upper.coating.thickness", "upper.layer.thickness"), 10: ("contact.mu", "contact.friction"),
                 12: ("load.normal_load", "load.normal"), 13: ("load.twist_deg", "load.twist (in rad"),
                 14: ("load.cycles", "cycles (above all tables)")}
        self.run_program("solve", self.write("scene.toml", text), code=2)
        lines = self.run_program("solve", "scene.toml", code=2).splitlines()
        self.assertEqual(len(lines), len(pairs), lines)
        for (line, (unknown, known)), said in zip(pairs.items(), lines):
            self.assertRegex(said, rf"scene\.toml:{line}: {unknown} = .*: unknown key; the nearest known one is ")
            self.assertIn("known one is " + known, said)

    def test_keys_after_the_tables_of_shapes_are_named_with_their_table(self):
        """A shape in a table of its own ends [upper]: its modulus then stands in the table of the shape."""
        shapes = SHORT_SCENE.replace("[upper]\n", "[[upper.shape]]\n")
        self.refused(shapes, "upper.shape[0].young_modulus", "known one is upper.young_modulus",
                     "upper.shape[0].poisson_ratio", "known one is upper.poisson_ratio")

    def test_two_rigid_bodies(self):
        rigid = SHORT_SCENE.replace("young_modulus = 210e9\npoisson_ratio = 0.3\n", "rigid = true\n")
        self.refused(rigid, "scene.toml", "lower.rigid = true", "false")

    def test_a_scene_that_is_none(self):
        self.run_program("solve", "none.toml", code=2, says=["none.toml", "cannot be read"])
        self.run_program("solve", str(self.folder), code=2, says=[str(self.folder), "is a folder"])
        Path("binary.toml").write_bytes(b"\x89HDF\r\n\x1a\n\0\0\0\0")
        self.run_program("solve", "binary.toml", code=2, says=["binary.toml", "binary file"])

    def test_pressure_files_that_do_not_fit(self):
        """On 4 x 4 cells of 0.25 mm."""
        settings = ("contact.pressure=file", "contact.pressure_file=p.csv", "grid.cells=[4, 4]", "grid.extent=[0.001, 0.001]")
        scene = SHORT_SCENE.replace("normal = 1000\n", "")
        good = "0.000125,0.000125,1e9\n"
        for rows, setting, *says in (
                ("", "contact.pressure_file=no.csv", "no.csv", "cannot be read"),
                (good, "load.normal=1000", "load.normal = 1000 N", "62.5", "p.csv"),
                (good + "0.000125,-0.000125,-1\n", "name=a", "p.csv", "row 2", "-1", "zero or positive"),
                ("0.0002,0.000125,1e9\n", "name=a", "p.csv", "row 1", "0.0002", "not a cell's centre"),
                ("0.000625,0.000125,1e9\n", "name=off the grid", "not a cell's centre"),
                ("0.125,0.125,1e9\n", "name=mm for m", "not a cell's centre"),
                ("0.000125,0.000125,0\n", "name=a", "zero everywhere"),
                (good + good, "name=a", "p.csv", "row 2")):
            self.write("p.csv", "x1,x2,pressure\n" + rows)
            self.refused(scene, *says, settings=(*settings, setting))
        self.write("p.csv", "x1,x2,pressure\n" + good)
        for more in ("name=any load", "load.normal=62.5"):  # 1e9 Pa on (0.25 mm)^2
            sets = (("--set", each) for each in (*settings, "load.moment_ratio=0", more))
            self.run_program("solve", "scene.toml", *itertools.chain(*sets))

    def test_frictions_that_do_not_fit(self):
        rows = [32 * ["1"] for _ in range(32)]
        rows[3][5] = "-1"
        for table, *says in ((rows[:31], "map.csv", "31 x 32", "allowed: 32 x 32"), (rows, "map.csv", "row 4, column 6: -1", "zero")):
            self.write("map.csv", "".join(",".join(row) + "\n" for row in table))
            self.refused(SHORT_SCENE, *says, settings=["contact.friction_map=map.csv"])
        infinite = ["contact.friction_law=power", "contact.friction_exponent=3", "contact.friction=1e300"]
        self.refused(SHORT_SCENE, "contact.friction", settings=infinite)

    def test_height_maps_that_do_not_fit(self):
        def mapped(*maps):
            maps = ", ".join(f'{{shape = "height_map", file = "{file}", spacing = {spacing}}}' for file, spacing in maps)
            return SHORT_SCENE[:SHORT_SCENE.index("[grid]")].replace(SPHERE, f"shape = [{maps}]")

        self.write("square.csv", "1,2\n3,4\n")
        self.write("wide.csv", "3e-6,2e-6,3e-6\n2e-6,1e-6,2e-6\n")
        square, wide = ("square.csv", "[1e-5, 2e-5]"), ("wide.csv", "[1e-5, 2e-5]")
        for text, settings, *says in (
                (mapped(square), ["grid.cells=[3, 2]"], "grid.cells = [3, 2]", "[2, 2]", "square.csv"),
                (mapped(square), ["grid.extent=[1, 1]"], "grid.extent", "spacing"),
                (mapped(wide, square), [], "square.csv", "2 x 2 heights", "allowed: 2 x 3", "wide.csv"),
                (mapped(wide, ("wide.csv", "[1e-5, 1e-5]")), [], "allowed: 2 x 3, 1e-05 x 2e-05 apart")):
            self.refused(text, *says, settings=settings)
        for hole in ("", " ", "nan", "NaN"):
            self.write("hole.csv", f"1,2,3\n4,{hole},6\n")
            self.refused(mapped(("hole.csv", wide[1])), "hole.csv", "row 2, column 2", "no height", "a finite number at every point")
        self.write("hole.csv", "1,2,3\n4,5,6\n,8,9\n10,11,12\n")  # 4 x 3 points about the origin
        self.refused(mapped(("hole.csv", wide[1])), "row 3, column 1 (x1 = 5e-06, x2 = -2e-05): no height")

    def test_grids_that_do_not_fit(self):
        pair = '[{shape = "sphere", radius = 1}, {shape = "sphere", radius = 1}]'
        summed = SHORT_SCENE.replace(SPHERE, f"shape = {pair}")
        for text, settings, *says in (
                (SHORT_SCENE, ["grid.cells=[4096, 4096]", "solver.operator=dense"], "scene.toml",
                 "grid.cells = [4096, 4096]", "fits in memory", 'operator = "dense"'),
                (summed, [], "scene.toml", "grid.extent = (missing)", "[L1, L2]"),
                # The contact's diameter is 0.978 mm.
                (SHORT_SCENE, ["grid.extent=[0.0009, 0.0011]"], 'grid.extent = ["0.0009 m", "0.0011 m"]',
                 "larger than the contact"),
                (SHORT_SCENE, ["grid.extent=[1, 1]"], 'grid.extent = ["1 m", "1 m"]', "at most 16 times the contact"),
                (SHORT_SCENE, ["grid.extent=[0.0011, 0.0011]", "grid.cells=[8, 16384]"], "grid.cells = [8, 16384]",
                 "1000 times as long as wide")):
            self.refused(text, *says, settings=settings)
