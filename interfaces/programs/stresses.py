#!/usr/bin/env python3
"""stresses.py PROGRAM SCENE OUTPUT [--json FILE] [--only NAME]: the stresses below the surface of the scene's sphere, pressed and
twisted by 0.5 and 0.9 of the limit moment, by PROGRAM and by programs with a file NAME/stresses.py, on the same grids and at the same
points; `slipstick check` judges them by the exact ones. OUTPUT keeps the files. Reports programs that are missing."""

import json
import resource
import subprocess
import sys
from pathlib import Path

import numpy as np

import elements
from on_meshes import command_line

HERE = Path(__file__).resolve().parent
CELLS, RATIOS = (32, 64, 128), (0.5, 0.9)
DEPTHS = (0.05, 0.1, 0.25, 0.5, 1.0, 2.0)  # over the contact radius
EACH = 3  # the points are centres of cells in each third row and column, of 32 cells; of finer grids as many


def spent():
    return sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])


class Case:
    """A grid and a moment: the files of all programs, with stresses at the same points (m, Pa)."""

    def __init__(self, slipstick, scene, output, cells, ratio):
        self.slipstick, self.cells, self.ratio = slipstick, cells, ratio
        self.words = [scene, "--set", f"load.moment_ratio={ratio}", "--set", f"grid.cells=[{cells},{cells}]"]
        self.sphere, self.stem = elements.Sphere(scene), output / f"{cells}-{ratio}"
        depths = ",".join(f"{depth}a" for depth in DEPTHS)
        start = spent()
        self.call("solve", *self.words, "--stresses", f"{self.stem}-depth{{depth}}.csv", "--depths", depths)
        self.own_seconds = spent() - start
        layers = [np.loadtxt(f"{self.stem}-depth{k + 1}.csv", delimiter=",", skiprows=1)[:, :9] for k in range(len(DEPTHS))]
        self.centres = np.unique(layers[0][:, 0])
        self.points = self.centres[cells // 64::EACH * cells // 32]
        rows = np.concatenate([layer[np.isin(layer[:, 0], self.points) & np.isin(layer[:, 1], self.points)] for layer in layers])
        self.depths = [layer[0, 2] for layer in layers]
        np.savetxt(self.file("slipstick"), rows, "%.17g", ",", header="x1,x2,x3,s11,s22,s33,s12,s13,s23", comments="")

    def file(self, name):
        return f"{self.stem}-{name}.csv"

    def call(self, command, *words):
        done = subprocess.run([self.slipstick, command, *map(str, words), "--json", "-", "--quiet"], capture_output=True, text=True)
        if done.returncode not in ((0, 1) if command == "check" else (0,)):
            raise SystemExit(done.stderr)
        return json.loads(done.stdout)

    def solved_by(self, name):
        """CPU seconds of another program, which takes the exact twist."""
        twist = self.call("solve", self.words[0], "--model", "exact", "--set", f"load.moment_ratio={self.ratio}")["twist_angle"]
        body, scene = self.sphere, Path(f"{self.stem}.json")
        points = {"centres": self.centres, "x1": self.points, "x2": self.points, "x3": np.array(self.depths)}
        scene.write_text(json.dumps({"radius": body.radius, "load": body.load, "friction": body.friction, "young": body.young,
                                     "poisson": body.poisson, "twist": twist, **{key: (1e3 * each).tolist() for key, each in points.items()}}))
        start = spent()
        subprocess.run([sys.executable, "stresses.py", scene.resolve(), Path(self.file(name)).resolve()], cwd=HERE / name, check=True)
        return spent() - start

    def judged(self, name, version, seconds):
        """The verdict on a file. The board shows the error of the worst component, over the largest von Mises stress."""
        body = ["--read-as", "body=upper"] if name != "slipstick" else []
        check = self.call("check", *self.words[:3], self.file(name), *body)
        errors = {each["quantity"]: np.nan if each["value"] is None else each["value"] for each in check["judged"]}
        print(f"{name} {version}, {self.cells} cells, {self.ratio} of the limit moment, {seconds:.2g} CPU s: {check['verdict']}: "
              f"{check['why']}\n  " + ", ".join(f"{key} {value:.1e}" for key, value in errors.items()))
        return {"program": name, "version": version, "cells": self.cells, "moment_ratio": self.ratio, "points": check["rows"],
                "cpu_seconds": seconds, "errors": errors, "verdict": check["verdict"], "why": check["why"]}


def said_version(name):
    done = subprocess.run([sys.executable, "stresses.py", "--version"], cwd=HERE / name, capture_output=True, text=True)
    return done.stdout.strip().split(" ", 1)[-1] if done.returncode == 0 else None


def main():
    arguments = command_line(__doc__)
    arguments.output.mkdir(parents=True, exist_ok=True)
    versions = {}
    for name in sorted(file.parent.name for file in HERE.glob("*/stresses.py")):
        if arguments.only in (None, name):
            versions[name] = said_version(name)
            if versions[name] is None:
                print(f"LEFT OUT: the stresses of {name}, which is not installed")
    board = []
    for cells in CELLS:
        for ratio in RATIOS:
            case = Case(arguments.slipstick, arguments.scene, arguments.output, cells, ratio)
            board.append(case.judged("slipstick", "", case.own_seconds))
            board += [case.judged(name, version, case.solved_by(name)) for name, version in versions.items() if version]
    if arguments.json:
        arguments.json.write_text(json.dumps({"scene": arguments.scene, "depths": DEPTHS, "board": board}, indent=1))


if __name__ == "__main__":
    main()
