"""CONTACT (Kalker, Vollebregt): pressure and tractions by conjugate gradients. CONTACT_EXE is the path of the program. It takes a
rotation; the rotation for the scene's moment is found by several runs."""

import os
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
    """CONTACT prints its version at the start of each run, also of an empty one."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "empty.inp").write_text(" 0  MODULE\n")
        line = next(each for each in run(folder, "2", "empty").splitlines() if "Version" in each)
    return line.split("Version:")[1].strip(" |")


def main():
    exchange = Exchange("CONTACT", version() if sys.argv[1:] == ["--version"] else None)
    exchange.require_half_spaces()
    exchange.require(exchange.pressure is None, "the pressure is given: CONTACT solves for it")
    (n1, n2), (h1, h2) = exchange.cells, (h / MILLI for h in exchange.cell_size)
    shear, poisson = 2 * exchange.shear_modulus / MEGA, exchange.poisson_ratio  # similar bodies: each has half of the compliance
    gap = "\n".join(f"{each:.16e}" for each in exchange.gap.T.ravel() / MILLI)

    def responded(motion, folder):
        """Pressure and tractions on the half-space, which is body 2; CONTACT writes the tractions on body 1."""
        (Path(folder) / "scene.inp").write_text(f""" 3  MODULE
 201100   P-B-T-N-F-S: a shift from rest, under a normal force, with a motion
 022020   L-D-C-M-Z-E: Coulomb's friction, tractions constant in each cell
 0002001  H-G-I-A-O-W-R: all cells into the .mat file
 9999 100 30 1 1e-10                             MAXGS, MAXIN, MAXNR, MAXOUT, EPS
 {exchange.load} {motion[0] / MILLI} {motion[1] / MILLI} {motion[2]}  FN, CKSI, CETA, CPHI
 {exchange.friction} {exchange.friction}         FSTAT, FKIN
 {poisson} {poisson} {shear} {shear}             POISS 1, 2, GG 1, 2
 3                                               IPOTCN
 {n1} {n2} {exchange.x1[0, 0] / MILLI} {exchange.x2[0, 0] / MILLI} {h1} {h2}  MX, MY, XC1, YC1, DX, DY
 9 1                                             IBASE, IPLAN
{gap}
 0  MODULE
""")
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


main()
