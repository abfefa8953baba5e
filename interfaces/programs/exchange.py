"""What the adapters share: a scene is read, a field and the program's own numbers are written."""

import json
import sys
import time
from pathlib import Path

import numpy as np

NOT_FOR_IT = 3


class Exchange:
    """The scene of `python adapter.py SCENE FIELD NUMBERS`; with --version the package's version is printed instead."""

    def __init__(self, package):
        if sys.argv[1:] == ["--version"]:
            from importlib.metadata import version
            print(package, version(package))
            sys.exit()
        scene, self.field, self.numbers = map(Path, sys.argv[1:])
        self.scene = json.loads(scene.read_text())
        self.gap = np.load(scene.parent / self.scene["gap"])
        self.cells, self.cell_size = tuple(self.scene["cells"]), tuple(self.scene["cell_size"])
        self.modulus = self.scene["combined"]["contact_modulus"]
        self.load = self.scene["load"]["normal"]

    def require(self, solves, why):
        if not solves:
            print(why)
            sys.exit(NOT_FOR_IT)

    def require_normal_contact(self, square=False):
        """For programs that find the pressure under a given load, of half-spaces that touch anywhere."""
        self.require(self.scene["pressure"] is None, "the pressure is given: nothing to solve")
        self.require(self.scene["layer"] is None and self.scene["coupling"] != "full", "half-spaces without coupling alone")
        self.require(np.all(np.isfinite(self.gap)), "no bodies that end")
        alike = abs(self.cell_size[0] / self.cell_size[1] - 1) < 1e-12
        self.require(not square or (alike and self.cells[0] == self.cells[1]), "square grids alone")

    def answer(self, solve):
        """Writes what solve() returns: the pressure, iterations, whether it converged."""
        start = time.perf_counter()
        pressure, iterations, converged = solve()
        seconds = time.perf_counter() - start
        x1, x2 = np.meshgrid(self.scene["x1"], self.scene["x2"], indexing="ij")
        touching = pressure > 0
        np.savetxt(self.field, np.column_stack([x1[touching], x2[touching], pressure[touching]]), "%.17g", ",",
                   header="x1,x2,pressure", comments="")
        self.numbers.write_text(json.dumps(
            {"seconds": seconds, "iterations": int(iterations), "converged": bool(converged)}))
