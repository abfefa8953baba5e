"""LAMMPS, `lmp`: two equal spheres of twice the radius are one of this radius on a half-space. The rotation is imposed."""

import math
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from stepping import STEP, turned


def runs(sphere):
    if not shutil.which("lmp"):
        raise LookupError("there is no lmp")
    version = subprocess.run(["lmp", "-h"], capture_output=True, text=True).stdout.split("Simulator - ")[-1].split("\n")[0]
    law = sphere.law["programs"]["lammps"]
    springs = f"sds {law['k_twist']} 0.0 {law['mu_twist']}"
    own = twisted(sphere, "marshall", f"mindlin NULL 0.0 {sphere.friction}")
    ours = twisted(sphere, springs, f"linear_nohistory 0.0 {sphere.friction}")
    return version, [("its own: twisting marshall", own), (f"slipstick law: twisting {springs}", ours)]


def twisted(sphere, twisting, tangential):
    def respond(path, _):
        radius, turns, steps = turned(sphere, path)
        values = {"distance": 4 * sphere.radius - radius**2 / sphere.radius, "diameter": 4 * sphere.radius, "young": sphere.young,
                  "poisson": sphere.poisson, "twisting": twisting, "tangential": tangential, "every": steps, "step": STEP}
        words = ["lmp", "-in", Path(__file__).with_name("twist.lmp").resolve(), "-log", "none"]
        for name, value in values.items():
            words += ["-var", name, value]
        moves = [f"rotate 0 0 0 0 0 {math.copysign(1, turn)} {2 * math.pi * steps * STEP / abs(turn)}" if turn else "linear 0 0 0"
                 for turn in turns]
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "turns.lmp").write_text("".join(f"fix high high move {move}\nrun {steps}\nunfix high\n" for move in moves))
            subprocess.run([str(word) for word in words], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            found = dict(line.split() for line in (Path(folder) / "out.txt").read_text().splitlines()[1:])
        moment = np.array([0.0, *(float(found[str(steps * (row + 1))]) for row in range(len(turns)))])
        return {"moment": math.copysign(1, moment[1] * turns[0]) * moment}
    return respond
