"""third_opinion_test.py PROGRAM FCLIB_SOLVE: contacts as FCLIB problems, solved by Siconos' nonsmooth Gauss-Seidel method.

Pressure and tractions are found together there, from influence coefficients that audit.py integrates and from Coulomb's
law as a cone. slipstick's answer gives the approach, the rigid motion and the cells of the contact; cells around it have to
open by themselves.
"""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

HARD = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(HARD), str(HARD.parent / "dataset/readers")]
import audit  # noqa: E402
from assemble_fclib import matrix_of, write_fclib  # noqa: E402

PROGRAM, FCLIB_SOLVE = (Path(sys.argv.pop(1)).resolve() for _ in range(2))


def scene(name):
    return HARD.parent / "scenes" / f"{name}.toml"


def solved(folder, name, *settings):
    """The result and the fields, in metres and pascals, on all cells."""
    words = [PROGRAM, "solve", scene(name), "--quiet", "--json", folder / "result.json", "--fields", folder / "fields.csv"]
    for setting in ("solver.tolerance=1e-13", "solver.model=full", *settings):
        words += ["--set", setting]
    subprocess.run(words, check=True)
    return json.loads((folder / "result.json").read_text())


def around(contact):
    """Cells within two of the contact's, by their indices."""
    wide = np.pad(contact, 2)
    n1, n2 = contact.shape
    return np.nonzero(np.logical_or.reduce([wide[i : i + n1, j : j + n2] for i in range(5) for j in range(5)]))


class ThirdOpinion(unittest.TestCase):
    def expect_agreement(self, name, *settings):
        """On pressures and tractions, in parts of the largest pressure and of the largest friction bound."""
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            result = solved(folder, name, *settings)
            tables = audit.scene_of({"scene": str(scene(name)), "set": settings}, folder)
            n, h = result["cells"], result["cell_size"]
            fields = audit.fields_of(folder / "fields.csv", n, h)
            cells = around(fields["pressure"] > 0.0)
            x, y = (((index - 0.5 * (m - 1)) * step) for index, m, step in zip(cells, n, h))
            kernels = audit.kernels(n, h, audit.compliances(tables))
            kernels = {key: np.fft.irfft2(table, [2 * m for m in n]) for key, table in kernels.items()}
            if tables["contact"].get("coupling") != "full":
                del kernels["13"], kernels["23"]
            matrix = matrix_of(kernels, cells)
            approach, stress = result["approach"], result["peak_pressure"]
            twist, (push1, push2) = result["twist_angle"], result["displacement"]
            gap = audit.undeformed_gap(tables["upper"], x, y) - approach
            q = np.column_stack([gap, twist * y - push1, -twist * x - push2]).ravel()
            friction = tables["contact"]["friction"]
            write_fclib(folder / "problem.h5", matrix * (stress / approach), q / approach, friction)
            subprocess.run([FCLIB_SOLVE, folder / "problem.h5", "1e-11"], check=True, stdout=subprocess.DEVNULL)
            with h5py.File(folder / "problem.h5") as h5:
                theirs = h5["solution/r"][:].reshape(-1, 3) * stress
        ours = np.column_stack([fields[key][cells] for key in ("pressure", "q1", "q2")])
        off = np.abs(theirs - ours).max(axis=0) / [stress, friction * stress, friction * stress]
        self.assertLessEqual(off.max(), 1e-6, msg=f"{name}: pressure, q1, q2 off by {off}")

    def test_on_the_papers_sphere(self):
        self.expect_agreement("paper", "grid.cells=[20, 20]")

    def test_under_a_force_and_a_moment(self):
        self.expect_agreement("paper", "grid.cells=[18, 15]", "load.force=[40.0, 15.0]", "load.moment_ratio=0.6")

    def test_on_an_ellipse(self):
        self.expect_agreement("ellipse", "grid.cells=[24, 14]")

    def test_of_unlike_bodies_whose_shear_moves_the_pressure(self):
        self.expect_agreement("dissimilar", "grid.cells=[18, 18]", 'contact.coupling="full"')

    def test_of_patches(self):
        self.expect_agreement("unequal_patches", "grid.cells=[30, 16]")
