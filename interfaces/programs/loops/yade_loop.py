"""Yade, `yade`: two equal spheres of twice the radius are one of this radius on a half-space. Motions are imposed, and loads by a
servo. The law
of CohFrictMat has a twisting moment, a spring with a cap; Hertz-Mindlin's law has none."""

import json
import shutil
import subprocess
import tempfile
from pathlib import Path

from stepping import STEP, answered, at_rest


def runs(sphere):
    if not shutil.which("yade"):
        raise LookupError("there is no yade")
    version = subprocess.run(["yade", "--version"], capture_output=True, text=True).stdout.split(":")[-1].split(",")[0].strip()
    law, radius = sphere.law["programs"]["lammps"], 2 * sphere.radius
    shear = sphere.poisson * sphere.young * radius  # N/m, from Yade's `poisson`, a ratio of stiffnesses
    own = {"alphaKtw": 2.0, "etaTwist": -1.0}  # Yade's defaults: no cap
    ours = {"alphaKtw": law["k_twist"] / (shear * radius**2), "etaTwist": law["mu_twist"] / radius}
    words = "slipstick law, its spring and cap: " + ", ".join(f"{key} = {ours[key]:.5g}" for key in ours)
    return version, [("its own: alphaKtw = 2, etaTwist = -1", twisted(sphere, own)), (words, twisted(sphere, ours)),
                     (words + ", useIncrementalForm", twisted(sphere, ours, True))]


def twisted(sphere, twisting, incremental=False):
    def respond(path):
        rest, radius = at_rest(sphere, path), 2 * sphere.radius
        scene = {"twisting": twisting, "young": sphere.young, "poisson": sphere.poisson, "friction": sphere.friction, "radius": radius,
                 "distances": (2 * radius - rest.load / (sphere.young * radius)).tolist(), "given": rest.given.tolist(),
                 "holds": rest.holds, "steps": rest.steps, "step": STEP,
                 "incremental": incremental}
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "scene.json").write_text(json.dumps(scene))
            script = Path(__file__).with_name("twist_in_yade.py").resolve()
            subprocess.run(["yade", "-n", "-x", script], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            return answered(sphere, path, json.loads((Path(folder) / "out.json").read_text()))
    return respond
