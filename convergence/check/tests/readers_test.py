"""readers_test.py PROGRAM: one field of the paper's sphere, written as programs of many kinds write it. The result
is the same field to the last digit, or a refusal that names the reason."""

import json
import subprocess
import sys
import tempfile
import unittest
from decimal import Decimal
from pathlib import Path

try:
    import h5py
    import numpy as np
except ImportError:
    h5py = None

PROGRAM, SCENE = Path(sys.argv[1]).resolve(), Path(__file__).resolve().parents[2] / "scenes/paper.toml"
NAMES = ("x1", "x2", "pressure", "q1", "q2")
HEADER = ",".join(NAMES)


class Readers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        for name in ("solved.csv", "solved.vti"):
            subprocess.run([PROGRAM, "solve", SCENE, "--quiet", "--set", "grid.cells=[24,24]", "--fields", cls.folder / name],
                           check=True)
        header, *lines = (cls.folder / "solved.csv").read_text().splitlines()
        places = [header.split(",").index(name) for name in NAMES]
        solved = [[float(line.split(",")[place]) for place in places] for line in lines]
        cls.rows = [[f"{value:.11e}" for value in row] for row in solved]
        cls.solved = cls.check("solved.csv")
        cls.right = cls.check(cls.write("right.csv", HEADER, cls.joined(",")))

    @classmethod
    def write(cls, name, *lines):
        (cls.folder / name).write_text("\n".join([line for part in lines for line in ([part] if isinstance(part, str) else part)])
                                       + "\n")
        return name

    @classmethod
    def joined(cls, separator, comma=False, end="", scale=(0, 0)):
        """The rows as text, of lengths and stresses in units of a power of ten."""
        def number(text, power):
            text = text if power == 0 else str(Decimal(text).scaleb(-power))
            return text.replace(".", ",") if comma else text
        return [separator.join(number(text, scale[column > 1]) for column, text in enumerate(row)) + end for row in cls.rows]

    @classmethod
    def check(cls, name, *options):
        """The result of a field without its name and the program's; or the refusal."""
        ran = subprocess.run([PROGRAM, "check", SCENE, cls.folder / name, "--strict", "--quiet", "--json", "-", *options],
                             capture_output=True, text=True)
        if ran.returncode == 2:
            return ran.stderr
        return {key: value for key, value in json.loads(ran.stdout).items() if key not in ("field", "provenance")}

    def assert_same(self, found, right):
        """Equal but for rounding: other orders of rows sum otherwise."""
        for key in ("verdict", "contact_cells", "stick_cells"):
            self.assertEqual(found[key], right[key])
        for key in ("twist_angle", "moment", "normal_load", "stick_radius"):
            self.assertAlmostEqual(found[key] / right[key], 1, delta=1e-9)

    def test_text(self):
        blanks = HEADER.replace(",", " ")
        units = "x1 [mm],x2 [mm],Pressure (MPa),q1 [N/mm^2],q2 [MPa]"
        for name, header, lines in (
                ("semicolons", HEADER.replace(",", ";"), self.joined(";")),
                ("semicolons_commas", HEADER.replace(",", ";"), self.joined(";", comma=True)),
                ("tabs", HEADER.replace(",", "\t"), self.joined("\t", comma=True)),
                ("blanks", blanks, self.joined("   ")),
                ("blanks_commas", blanks, self.joined(" ", comma=True)),
                ("comma_and_blank", HEADER, self.joined(", ")),
                ("capitals", HEADER.upper(), self.joined(",")),
                ("units", units, self.joined(",", scale=(-3, 6))),
                ("units_blanks", units.replace(",", "  "), self.joined(" ", scale=(-3, 6))),
                ("empty_last_column", HEADER + ",", self.joined(",", end=",")),
                ("empty_last_value", HEADER, self.joined(",", end=",")),
                ("numpy_savetxt", "##\n# by hand\n# " + blanks, self.joined(" ", end="  # a cell")),
                ("comments", "% MATLAB's\n" + HEADER, self.joined(",", end="\n%")),
                ("marks", "\ufeff" + HEADER.replace("x1,x2", '"x1", x2 ') + "\r", self.joined(" , ", end="\r\n\r")),
                ("fortran", blanks, [line.replace("e", "D") for line in self.joined(" ")]),
                ("words", "note;" + HEADER.replace(",", ";"), ["a b;" + line for line in self.joined(";")])):
            with self.subTest(name):
                self.assertEqual(self.check(self.write(name + ".txt", header, lines)), self.right)

    def test_columns_without_a_header(self):
        bare = self.write("bare.csv", self.joined(",", scale=(-3, 0)))
        named = "x1 [mm],x2 [mm],pressure,q1,q2"
        self.assertEqual(self.check(bare, "--columns", named), self.right)
        other = self.write("other.csv", "X,Y,P,TX,TY", self.joined(","))
        self.assertEqual(self.check(other, "--columns", HEADER), self.right)
        self.assertRegex(self.check(bare), "has no header; allowed: .*--columns")

    def test_what_is_not_a_number_is_no_contact(self):
        for none in ("nan,NaN,-nan", ",,", "0,,nan", "0,0,0"):
            with self.subTest(none):
                taken = {(row[0], row[1]) for row in self.rows}
                free = next(f"{a},{b}" for a, _, *_ in self.rows for _, b, *_ in self.rows if (a, b) not in taken)
                self.assertEqual(self.check(self.write("nan.csv", HEADER, self.joined(","), f"{free},{none}")), self.right)
        first = ",".join(self.rows[0][:3])
        self.assertRegex(self.check(self.write("nan.csv", HEADER, f"{first},nan,1", self.joined(",")[1:])),
                         "row 1: q1 is no number; allowed: NaN where there is no contact")
        self.assertRegex(self.check(self.write("nan.csv", HEADER, "nan,0,nan,nan,nan", self.joined(","))), "row 1: x1 is no number")

    def test_what_may_mean_two_things_is_refused(self):
        for header, lines, words in (
                (HEADER, self.joined(",", comma=True), "2: 10 values; .* no commas between them where they are decimal marks"),
                (HEADER.replace(",", ";"), ["1,5;1;1;1;1", "1.5;1;1;1;1"], '3: "1.5": decimal commas and points'),
                (HEADER.replace(",", ";"), ["1,234.5;1;1;1;1"], "no thousands separator"),
                (HEADER.replace("x1", "x1 [inch]"), self.joined(","), "column x1: unit inch; allowed: m, cm, mm"),
                ("X1," + HEADER.replace("x1", "X1"), self.joined(","), "two columns x1")):
            with self.subTest(words):
                self.assertRegex(self.check(self.write("refused.csv", header, lines)), words)
        for name in ("field.npz", "field.npy"):
            self.assertRegex(self.check(self.write(name, "PK")), "allowed: CSV, HDF5 or .vti; in Python np.savetxt")

    def test_vtk(self):
        self.assert_same(self.check("solved.vti"), self.solved)
        text = (self.folder / "solved.vti").read_text()
        self.assertRegex(self.check(self.write("binary.vti", text.replace("ascii", "binary"))), 'format="ascii"')
        self.assertRegex(self.check(self.write("other.vti", text.replace('"q2"', '"tau"'))), "has no array q2")

    @unittest.skipIf(h5py is None, "without h5py")
    def test_hdf5(self):
        columns = np.array(self.rows, float).T
        x = [np.unique(columns[0]), np.unique(columns[1])]
        place = np.searchsorted(x[0], columns[0]), np.searchsorted(x[1], columns[1])
        matrices = [*np.meshgrid(*x, indexing="ij")] + [np.full((x[0].size, x[1].size), np.nan) for _ in range(3)]
        for matrix, column in zip(matrices[2:], columns[2:]):
            matrix[place] = column

        def file(name, paths, matrices=matrices):
            with h5py.File(self.folder / name, "a") as opened:
                for path, matrix in zip(paths, matrices):
                    opened[path] = matrix
            return name

        self.assert_same(self.check(file("matrices.h5", NAMES)), self.right)
        grouped = file("group.h5", [f"steps/last/{name}" for name in NAMES])
        self.assert_same(self.check(grouped), self.right)
        file("group.h5", [f"steps/first/{name}" for name in NAMES])
        self.assertRegex(self.check(grouped), "several groups have one: steps/first/, steps/last/; .*--columns")
        other = [f"a/{name}" for name in ("X", "Y", "p", "s/tx", "s/ty")]
        self.assert_same(self.check(file("other.h5", other), "--columns", ",".join(other)), self.right)
        self.assertRegex(self.check("other.h5"), "no such dataset; the file has: a, a/X, .*--columns")
        self.assertRegex(self.check("other.h5", "--columns", "a/X"), "--columns: 1 names; allowed: 5")
        turned = file("turned.h5", NAMES, [*matrices[:4], matrices[4][1:].T])
        self.assertRegex(self.check(turned), "dataset q2 has ")
        with h5py.File(self.folder / "link.h5", "w") as opened:
            opened["a"] = h5py.ExternalLink("matrices.h5", "/")
        self.assertRegex(self.check("link.h5", "--columns", ",".join(f"a/{name}" for name in NAMES)), "is a link")
