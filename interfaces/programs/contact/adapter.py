"""CONTACT (Kalker, Vollebregt): pressure and tractions by conjugate gradients. CONTACT_EXE is the path of the program. It takes a
rotation; the rotation for the scene's moment is found by several runs."""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from exchange import Exchange  # noqa: E402

MILLI, MEGA = 1e-3, 1e6  # its lengths are in mm, its stresses in N/mm^2


def run(folder, *words):
    program = os.environ.get("CONTACT_EXE")
    if not program:
        sys.exit("CONTACT_EXE is not set: the path of CONTACT's program")
    done = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{program}: {done.stderr.strip()}")
    return done.stdout


def version():
    """CONTACT prints its version at the start of each run, also of an empty one; of its source, the revision."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "empty.inp").write_text(" 0  MODULE\n")
        line = next(each for each in run(folder, "2", "empty").splitlines() if "Version" in each)
    revision = re.search(r"Revision: (\d+)", line)
    return f"r{revision[1]}" if revision else line.split("Version:")[1].strip(" |")


def deck(grid, gap, load, friction, poisson, shear, motion, points=None):
    """The input of a contact on a grid (cells, first centre and cell size in mm along both axes) with this gap: pressed, then moved by
    motion (mm, mm, rad). With points, three lists of coordinates (mm), also the stresses in the upper body at each combination."""
    (n1, n2), (first1, first2), (h1, h2) = grid
    lines = [f""" 3  MODULE
 20110{3 if points else 0}   P-B-T-N-F-S: a shift from rest, under a normal force, with a motion
 022020   L-D-C-M-Z-E: Coulomb's friction, tractions constant in each cell
 0002001  H-G-I-A-O-W-R: all cells into the .mat file
 9999 100 30 1 1e-10                             MAXGS, MAXIN, MAXNR, MAXOUT, EPS
 {load} {motion[0]} {motion[1]} {motion[2]}  FN, CKSI, CETA, CPHI
 {friction} {friction}         FSTAT, FKIN
 {poisson} {poisson} {shear} {shear}             POISS 1, 2, GG 1, 2
 3                                               IPOTCN
 {n1} {n2} {first1} {first2} {h1} {h2}  MX, MY, XC1, YC1, DX, DY
 9 1                                             IBASE, IPLAN""", *(f"{each:.16e}" for each in gap.T.ravel())]
    if points:
        counts = " ".join(str(len(each)) for each in points)
        lines += [" 2 0  MATFIL, OUTPUT: all components", f" 9  ISUBS: points\n {counts}  NX, NY, NZ",
                  *(f" {each:.16e}" for axis in points for each in axis), " 0  ISUBS"]
    return "\n".join([*lines, " 0  MODULE\n"])


def main():
    exchange = Exchange("CONTACT", version() if sys.argv[1:] == ["--version"] else None)
    exchange.require_half_spaces()
    exchange.require(exchange.pressure is None, "the pressure is given: CONTACT solves for it")
    (n1, n2), (h1, h2) = exchange.cells, (h / MILLI for h in exchange.cell_size)
    shear, poisson = 2 * exchange.shear_modulus / MEGA, exchange.poisson_ratio  # similar bodies: each has half of the compliance

    def responded(motion, folder):
        """Pressure and tractions on the half-space, which is body 2; CONTACT writes the tractions on body 1."""
        shift = motion / np.array([MILLI, MILLI, 1])
        first = exchange.x1[0, 0] / MILLI, exchange.x2[0, 0] / MILLI
        text = deck(((n1, n2), first, (h1, h2)), exchange.gap / MILLI, exchange.load, exchange.friction, poisson, shear, shift)
        (Path(folder) / "scene.inp").write_text(text)
        run(folder, "2", "scene")
        rows = np.loadtxt(Path(folder) / "scene.0001.mat", comments="%", skiprows=11)[-n1 * n2:]
        pressure, *on_body_1 = MEGA * rows[:, 4:7].T.reshape(3, n2, n1).transpose(0, 2, 1)
        return [pressure, *(-each for each in on_body_1)]

    def solve():
        with tempfile.TemporaryDirectory() as folder:
            pressure = responded(np.zeros(3), folder)[0]
            motion = exchange.motion_under_loads(lambda tried: responded(tried, folder)[1:], pressure)
            return responded(motion, folder), {"twist_angle": motion[2]}

    exchange.answer(solve)


if __name__ == "__main__":
    main()
