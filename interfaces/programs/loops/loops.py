#!/usr/bin/env python3
"""loops.py PROGRAM SCENE [--json FILE]: simulators twist the sphere of a scene there and back under its normal load, with their
own friction and with what `slipstick law` writes for them. `slipstick check` judges each loop; stiffness at the first step,
largest moment and energy lost stand beside the exact ones. LAMMPS is looked for as lmp, MuJoCo as a module of this Python; what
is missing is left out, and said."""

import argparse
import importlib.util
import json
import math
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

QUARTER = 4000  # steps from rest to the largest rotation


def triangle(k, quarter):
    """There and back in five quarters: 0, 1, 0, -1, 0, 1."""
    return k / quarter if k <= quarter else 2 - k / quarter if k <= 3 * quarter else k / quarter - 4


class Sphere:
    """A sphere on a half-space of its own material, and its law."""

    def __init__(self, slipstick, scene):
        read = tomllib.loads(Path(scene).read_text())
        body, lower = read["upper"], read["lower"]
        if body.get("shape") != "sphere" or any(body[key] != lower[key] for key in ("young_modulus", "poisson_ratio")):
            sys.exit(f"{scene}: not a sphere on its own material; allowed: one, as convergence/scenes/paper.toml")
        self.slipstick, self.scene = slipstick, scene
        self.radius, self.young, self.poisson = body["radius"], body["young_modulus"], body["poisson_ratio"]
        self.load, self.friction = read["load"]["normal"], read["contact"]["friction"]
        self.law = self.json("law", scene)
        self.limit = self.law["moment_limit"]
        exact = self.json("solve", scene, "--model", "exact", "--set", "load.moment_ratio=0.9")
        self.contact_radius, self.rotation = exact["contact_radius"], exact["twist_angle"]

    def json(self, *words):
        done = subprocess.run([self.slipstick, *map(str, words), "--json", "-", "--quiet"], capture_output=True, text=True)
        if done.returncode == 2:
            sys.exit(done.stderr)
        return json.loads(done.stdout)


def lammps(sphere, twisting, tangential, folder):
    """Two equal spheres of twice the radius are one of this radius on a half-space. The rotation is imposed."""
    overlap = sphere.contact_radius**2 / sphere.radius
    step = 1e-6
    values = {"distance": 4 * sphere.radius - overlap, "diameter": 4 * sphere.radius, "young": sphere.young,
              "poisson": sphere.poisson, "twisting": twisting, "tangential": tangential, "quarter": QUARTER,
              "period": 2 * math.pi * QUARTER * step / sphere.rotation}
    words = ["lmp", "-in", Path(__file__).with_name("twist.lmp").resolve(), "-log", "none"]
    for name, value in values.items():
        words += ["-var", name, value]
    subprocess.run([str(word) for word in words], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    rows = [tuple(map(float, line.split())) for line in (folder / "out.txt").read_text().splitlines()[1:]]
    sign = -1 if rows[QUARTER // 20][1] < 0 else 1
    return [(sign * moment, sphere.rotation * triangle(step, QUARTER)) for step, moment, _ in rows]


def mujoco(sphere, friction):
    """The moment is imposed, up to 0.9 of the exact limit, a quarter in four seconds: MuJoCo's friction follows from the rate."""
    import mujoco as engine
    import numpy as np
    size, worn = sphere.radius, f'condim="4" {friction}'
    model = engine.MjModel.from_xml_string(f"""<mujoco><option timestep="1e-3" gravity="0 0 0" cone="elliptic"/><worldbody>
      <geom type="plane" size="1 1 .1" {worn}/><body pos="0 0 {size}"><joint name="z" type="slide" axis="0 0 1"/>
      <joint name="turn" type="hinge" axis="0 0 1"/><geom type="sphere" size="{size}" mass="1" {worn}/></body></worldbody>
      <actuator><motor joint="z"/><motor joint="turn"/></actuator></mujoco>""")
    data, rows = engine.MjData(model), []
    data.ctrl[0] = -sphere.load
    for _ in range(3000):  # until it rests
        engine.mj_step(model, data)
    start, force = data.qpos[1], np.zeros(6)
    for k in range(5 * QUARTER):
        data.ctrl[1] = 0.9 * sphere.limit * triangle(k, QUARTER)
        engine.mj_step(model, data)
        engine.mj_contactForce(model, data, 0, force)
        if k % 10 == 0:
            rows.append((data.ctrl[1], data.qpos[1] - start))
    return rows


def wanted(sphere):
    """What can be run here: name, version, whose friction, and the function that makes the loop."""
    law = sphere.law["programs"]
    runs = []
    if shutil.which("lmp"):
        version = subprocess.run(["lmp", "-h"], capture_output=True, text=True).stdout.split("Simulator - ")[-1].split("\n")[0]
        springs = f"sds {law['lammps']['k_twist']} 0.0 {law['lammps']['mu_twist']}"
        runs += [("LAMMPS", version, "its own: twisting marshall", "marshall", f"mindlin NULL 0.0 {sphere.friction}"),
                 ("LAMMPS", version, f"slipstick law: twisting {springs}", springs, f"linear_nohistory 0.0 {sphere.friction}")]
    else:
        print("LEFT OUT: LAMMPS, since there is no lmp")
    if importlib.util.find_spec("mujoco"):
        from importlib.metadata import version
        words = " ".join(map(str, law["mujoco"]["friction"]))
        runs += [("MuJoCo", version("mujoco"), "its own: 1 0.005 0.0001", ""),
                 ("MuJoCo", version("mujoco"), f"slipstick law: {words}", f'friction="{words}"')]
    else:
        print("LEFT OUT: MuJoCo, since this Python has no module mujoco")
    return runs


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("scene")
    parser.add_argument("--json")
    arguments = parser.parse_args()
    sphere = Sphere(arguments.program, arguments.scene)
    found = []
    for name, version, friction, *words in wanted(sphere):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            loop = lammps(sphere, *words, folder) if name == "LAMMPS" else mujoco(sphere, *words)
            file = folder / "loop.csv"
            file.write_text("moment,rotation\n" + "".join(f"{moment:.10e},{rotation:.10e}\n" for moment, rotation in loop))
            judged = sphere.json("check", arguments.scene, file)
        loads = judged["loads"]
        row = {"program": name, "version": version, "friction": friction, "verdict": judged["verdict"], "why": judged["why"],
               "largest_moment_over_limit": max(abs(moment) for moment, _ in loop) / sphere.limit,
               "largest_rotation": max(abs(rotation) for _, rotation in loop), "loads": loads}
        found.append(row)
        print(f"{name} {version}, {friction}\n  largest moment {row['largest_moment_over_limit']:.5g} of the exact limit, largest "
              f"rotation {row['largest_rotation']:.4g} rad (exact at 0.9: {sphere.rotation:.4g})\n  {row['verdict']}: {row['why']}")
    if arguments.json:
        Path(arguments.json).write_text(json.dumps({"scene": arguments.scene, "limit": sphere.limit, "loops": found}, indent=1))


if __name__ == "__main__":
    main()
