#!/usr/bin/env python3
"""loops.py PROGRAM SCENE [--json FILE] [--only NAME]: simulators twist the sphere of a scene there and back under its normal load,
with their own friction and with the law that `slipstick law` writes for them. `slipstick check` judges each loop; the result has
stiffness at the first step, largest moment and energy lost, relative to the exact values. Reports simulators that are missing."""

import argparse
import importlib
import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

SIMULATORS = {"LAMMPS": "lammps_loop", "Yade": "yade_loop", "MuJoCo": "mujoco_loop", "Drake": "drake_loop"}


class Sphere:
    """A sphere on a half-space of its own material, its law, and the path that its loops follow."""

    quarter = 4000  # steps from rest to the largest rotation or moment

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

    def path(self, step):
        """There and back in five quarters: 0, 1, 0, -1, 0, 1."""
        part = step / self.quarter
        return part if part <= 1 else 2 - part if part <= 3 else part - 4

    def json(self, *words):
        done = subprocess.run([self.slipstick, *map(str, words), "--json", "-", "--quiet"], capture_output=True, text=True)
        if done.returncode == 2:
            sys.exit(done.stderr)
        return json.loads(done.stdout)


def judged(sphere, name, version, friction, loop):
    """Writes the loop for `check`, and returns its verdict."""
    with tempfile.TemporaryDirectory() as folder:
        rows = loop(Path(folder))
        file = Path(folder) / "loop.csv"
        file.write_text("moment,rotation\n" + "".join(f"{moment:.10e},{rotation:.10e}\n" for moment, rotation in rows))
        verdict = sphere.json("check", sphere.scene, file)
    return {"program": name, "version": version, "friction": friction, "verdict": verdict["verdict"], "why": verdict["why"],
            "largest_moment_over_limit": max(abs(moment) for moment, _ in rows) / sphere.limit,
            "largest_rotation": max(abs(rotation) for _, rotation in rows), "loads": verdict["loads"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("scene")
    parser.add_argument("--json")
    parser.add_argument("--only", choices=SIMULATORS)
    arguments = parser.parse_args()
    sphere, found = Sphere(arguments.program, arguments.scene), []
    for name in [arguments.only] if arguments.only else SIMULATORS:
        try:
            version, loops = importlib.import_module(SIMULATORS[name]).runs(sphere)
        except LookupError as missing:
            print(f"LEFT OUT: {name}, since {missing}")
            continue
        for friction, loop in loops:
            row = judged(sphere, name, version, friction, loop)
            found.append(row)
            print(f"{name} {version}, {friction}\n  largest moment {row['largest_moment_over_limit']:.5g} of the exact limit, largest "
                  f"rotation {row['largest_rotation']:.4g} rad (exact at 0.9: {sphere.rotation:.4g})\n  {row['verdict']}: {row['why']}")
    if arguments.json:
        text = {"scene": arguments.scene, "limit": sphere.limit, "law": sphere.law["programs"], "loops": found}
        Path(arguments.json).write_text(json.dumps(text, indent=1))


if __name__ == "__main__":
    main()
