#!/usr/bin/env python3
"""loops.py PROGRAM SCENE [--json FILE] [--only NAME] [--cases]: simulators twist the sphere of a scene there and back under its
normal load, with their own friction and with the law that `slipstick law` writes for them. `slipstick check` judges each loop; the result
has stiffness at the first step, largest moment and energy lost, relative to the exact values. With --cases they also run the cases of
slipstick.conformance, with a row for each. Reports simulators that are missing."""

import argparse
import importlib
import json
import os
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from types import SimpleNamespace

import numpy as np

SIMULATORS = {name: f"{name.lower()}_loop" for name in ("LAMMPS", "Yade", "MuJoCo", "Drake", "PyBullet", "Newton")}


class Sphere:
    """A sphere on a half-space of its own material, its law, and the path that its loops follow."""

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


def loop_path(sphere, rows, seconds):
    """A loop in five quarters, as a path of slipstick.conformance: the moment up to 0.9 of the limit, the exact twist in proportion."""
    part = np.interp(np.arange(5 * rows + 1), rows * np.array([0, 1, 3, 5]), [0, 1, -1, 1])
    return SimpleNamespace(time=seconds * np.arange(len(part)) / rows, normal_load=np.full(len(part), sphere.load), force=0 * part,
                           moment=0.9 * sphere.limit * part, twist=sphere.rotation * part, displacement=0 * part, shortest=seconds / rows,
                           responses=("moment", "twist"))


def judged(sphere, name, version, friction, respond):
    """Writes the loop for `check`, and returns its verdict."""
    path = loop_path(sphere, 400, 4.0)
    rows = np.column_stack([{**vars(path), **respond(path)}[column] for column in ("moment", "twist")])
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "loop.csv"
        file.write_text("moment,rotation\n" + "".join(f"{moment:.10e},{rotation:.10e}\n" for moment, rotation in rows))
        verdict = sphere.json("check", sphere.scene, file)
    largest = np.abs(rows).max(axis=0).tolist()
    return {"program": name, "version": version, "friction": friction, "verdict": verdict["verdict"], "why": verdict["why"],
            "largest_moment_over_limit": largest[0] / sphere.limit, "largest_rotation": largest[1], "loads": verdict["loads"]}


def response(case, respond):
    """The columns with which a simulator answers a case, and the largest error of loads that a servo imposes, over their limits."""
    from slipstick import conformance
    parts = []
    for run in np.unique(case.run):
        rows = {column: getattr(case, column)[case.run == run] for column in conformance.COLUMNS}
        shortest = np.diff(case.time)[np.diff(case.run) == 0].min()
        parts.append(respond(SimpleNamespace(**rows, shortest=shortest, responses=case.responses)))
    missed = max((part.pop("missed", 0.0) for part in parts))
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0] if name in case.responses}, missed


def cpu_seconds():
    return sum(os.times()[:4])


def on_cases(sphere, name, version, friction, respond):
    """Rows of the board: a verdict on each case."""
    from slipstick import conformance
    contact = conformance.Sphere(sphere.radius, sphere.load, sphere.friction, sphere.young, sphere.poisson)
    for case in conformance.cases(contact):
        started = cpu_seconds()
        given, missed = response(case, respond)
        verdict = conformance.judge(case, given)
        print(f"  {case.id:<16} {verdict.verdict}: {verdict.why}")
        yield {"kind": "case", "on": case.id, "program": name, "version": version, "variant": friction, "verdict": verdict.verdict,
               "measure": verdict.measure, "number": verdict.number if np.isfinite(verdict.number) else None, "shown": verdict.text,
               "cause": verdict.cause, "why": verdict.why, "missed": missed, "cpu_seconds": cpu_seconds() - started}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("scene")
    parser.add_argument("--json")
    parser.add_argument("--only", choices=SIMULATORS)
    parser.add_argument("--cases", action="store_true", help="run the cases of slipstick.conformance too")
    arguments = parser.parse_args()
    sys.path.insert(0, str(Path(arguments.program).resolve().parent / "python"))
    sphere, found, rows = Sphere(arguments.program, arguments.scene), [], []
    for name in [arguments.only] if arguments.only else SIMULATORS:
        try:
            version, variants = importlib.import_module(SIMULATORS[name]).runs(sphere)
        except LookupError as missing:
            print(f"LEFT OUT: {name}, since {missing}")
            continue
        for friction, respond in variants:
            row = judged(sphere, name, version, friction, respond)
            found.append(row)
            print(f"{name} {version}, {friction}\n  largest moment {row['largest_moment_over_limit']:.5g} of the exact limit, largest "
                  f"rotation {row['largest_rotation']:.4g} rad (exact at 0.9: {sphere.rotation:.4g})\n  {row['verdict']}: {row['why']}")
            if arguments.cases:
                rows += on_cases(sphere, name, version, friction, respond)
    if arguments.json:
        text = {"scene": arguments.scene, "limit": sphere.limit, "law": sphere.law["programs"], "loops": found, "rows": rows}
        Path(arguments.json).write_text(json.dumps(text, indent=1))


if __name__ == "__main__":
    main()
