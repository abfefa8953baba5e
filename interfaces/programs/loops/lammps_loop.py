"""LAMMPS, `lmp`: two equal spheres of twice the radius are one of this radius on a half-space. The rotation is imposed."""

import math
import shutil
import subprocess
from pathlib import Path

STEP = 1e-6  # s, as in twist.lmp


def runs(sphere):
    if not shutil.which("lmp"):
        raise LookupError("there is no lmp")
    version = subprocess.run(["lmp", "-h"], capture_output=True, text=True).stdout.split("Simulator - ")[-1].split("\n")[0]
    law = sphere.law["programs"]["lammps"]
    springs = f"sds {law['k_twist']} 0.0 {law['mu_twist']}"
    own = loop(sphere, "marshall", f"mindlin NULL 0.0 {sphere.friction}")
    ours = loop(sphere, springs, f"linear_nohistory 0.0 {sphere.friction}")
    return version, [("its own: twisting marshall", own), (f"slipstick law: twisting {springs}", ours)]


def loop(sphere, twisting, tangential):
    def run(folder):
        values = {"distance": 4 * sphere.radius - sphere.contact_radius**2 / sphere.radius, "diameter": 4 * sphere.radius,
                  "young": sphere.young, "poisson": sphere.poisson, "twisting": twisting, "tangential": tangential,
                  "quarter": sphere.quarter, "period": 2 * math.pi * sphere.quarter * STEP / sphere.rotation}
        words = ["lmp", "-in", Path(__file__).with_name("twist.lmp").resolve(), "-log", "none"]
        for name, value in values.items():
            words += ["-var", name, value]
        subprocess.run([str(word) for word in words], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        rows = [tuple(map(float, line.split())) for line in (folder / "out.txt").read_text().splitlines()[1:]]
        sign = -1 if rows[sphere.quarter // 20][1] < 0 else 1
        return [(sign * moment, sphere.rotation * sphere.path(step)) for step, moment, _ in rows]
    return run
