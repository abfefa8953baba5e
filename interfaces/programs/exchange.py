"""Shared code of the adapters: reads a scene, writes a field and the program's own numbers."""

import json
import sys
import time
from pathlib import Path

import numpy as np

NOT_FOR_IT = 3


class Exchange:
    """The scene of `python adapter.py SCENE FIELD NUMBERS`; with --version the package's version is printed instead.
    Arrays are cells of x1 by cells of x2, in SI units."""

    def __init__(self, package, version=None):
        if sys.argv[1:] == ["--version"]:
            from importlib.metadata import version as installed
            print(package, version or installed(package))
            sys.exit()
        scene, self.field, self.numbers = map(Path, sys.argv[1:])
        self.scene = json.loads(scene.read_text())
        self.gap, self.pressure = (np.load(scene.parent / name) if name else None
                                   for name in (self.scene["gap"], self.scene["pressure"]))
        self.cells, self.cell_size = tuple(self.scene["cells"]), tuple(self.scene["cell_size"])
        self.x1, self.x2 = np.meshgrid(self.scene["x1"], self.scene["x2"], indexing="ij")
        self.modulus, self.shear_modulus, self.poisson_ratio, _ = (self.scene["combined"][key] for key in (
            "contact_modulus", "shear_modulus", "poisson_ratio", "mismatch"))
        self.load, self.friction = self.scene["load"]["normal"], self.scene["friction"]

    def require(self, solves, why):
        if not solves:
            print(why)
            sys.exit(NOT_FOR_IT)

    def require_half_spaces(self):
        """For programs that model half-spaces of similar materials, which may touch anywhere on the grid."""
        self.require(self.scene["layer"] is None and self.scene["coupling"] == "none", "half-spaces without coupling alone")
        self.require(np.all(np.isfinite(self.gap)), "no bodies that end")

    def require_normal_contact(self, square=False):
        """For programs that find the pressure of half-spaces under a given load, which may touch anywhere."""
        self.require(self.pressure is None, "the pressure is given: nothing to solve")
        self.require(self.scene["layer"] is None and self.scene["coupling"] != "full", "half-spaces without coupling alone")
        self.require(np.all(np.isfinite(self.gap)), "no bodies that end")
        alike = abs(self.cell_size[0] / self.cell_size[1] - 1) < 1e-12
        self.require(not square or (alike and self.cells[0] == self.cells[1]), "square grids alone")

    def motion_under_loads(self, respond, pressure):
        """Displacements in m and rotation in rad, imposed or found by Powell's hybrid method (MINPACK), under which the tractions
        q1 and q2 that `respond(motion)` returns carry the scene's loads; for programs that take a motion instead of loads."""
        from scipy.optimize import root
        load, area = self.scene["load"], np.prod(self.cell_size)
        imposed = [*load.get("displacement", [None, None]), load.get("twist")]
        wanted = np.array([*load.get("force", [0, 0]), load.get("moment", 0)])
        radius = np.sqrt(area * np.count_nonzero(pressure) / np.pi)
        stiffness = self.shear_modulus * radius * np.array([8, 8, 16 / 3 * radius**2])  # of a bonded disc, at most
        unit = self.friction * self.load * np.array([1, 1, radius]) / stiffness
        if "force" in load and wanted[0] == wanted[1] == 0 and np.allclose(pressure, pressure[::-1, ::-1], atol=1e-9 * pressure.max()):
            imposed[:2] = [0.0, 0.0]  # it turns about the middle
        free = [k for k in range(3) if imposed[k] is None]

        def motion(found):
            return np.array([found[free.index(k)] * unit[k] if k in free else imposed[k] for k in range(3)])

        def missing(found):
            q1, q2 = respond(motion(found))
            carried = area * np.array([np.sum(q1), np.sum(q2), np.sum(self.x1 * q2 - self.x2 * q1)])
            return ((carried - wanted) / (stiffness * unit))[free]

        options = {"xtol": 1e-7, "eps": 1e-6}  # differences for programs that write six digits, a thousandth of the motion
        return motion(root(missing, (wanted / (stiffness * unit))[free], options=options).x) if free else motion([])

    def answer(self, solve):
        """Writes the result of solve(): a list with the pressure, or with pressure and both tractions, and the program's own numbers."""
        start = time.perf_counter()
        fields, numbers = solve()
        seconds = time.perf_counter() - start
        fields = [np.reshape(each, self.cells) for each in fields]
        columns = [each[fields[0] > 0] for each in (self.x1, self.x2, *fields)]
        names = ["x1", "x2", "pressure", "q1", "q2"][:len(columns)]
        np.savetxt(self.field, np.column_stack(columns), "%.17g", ",", header=",".join(names), comments="")
        self.numbers.write_text(json.dumps({"seconds": seconds, **numbers}))
