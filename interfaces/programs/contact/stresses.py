"""stresses.py SCENE OUTPUT: the stresses below the surface that CONTACT finds. SCENE (JSON, mm, N, MPa, rad) has a sphere on its own
material, its load and twist, the centres of the cells along each axis, and lists x1, x2, x3 of coordinates; x3 is the depth. OUTPUT
has the stresses in the upper body at each combination, as `slipstick check` reads them (m, Pa)."""

import json
import sys
import tempfile
from pathlib import Path

import numpy as np
from adapter import MEGA, MILLI, deck, run, version


def main():
    if sys.argv[1:] == ["--version"]:
        print("CONTACT", version())
        return
    scene = json.loads(Path(sys.argv[1]).read_text())
    centres = np.array(scene["centres"])
    size = (centres[-1] - centres[0]) / (len(centres) - 1)
    x1, x2 = np.meshgrid(centres, centres, indexing="ij")
    grid = (len(centres),) * 2, (centres[0],) * 2, (size, size)
    shear = scene["young"] / 2 / (1 + scene["poisson"])
    with tempfile.TemporaryDirectory() as folder:
        text = deck(grid, (x1**2 + x2**2) / 2 / scene["radius"], scene["load"], scene["friction"], scene["poisson"], shear,
                    (0.0, 0.0, scene["twist"]), [scene["x1"], scene["x2"], scene["x3"]])
        (Path(folder) / "scene.inp").write_text(text)
        run(folder, "2", "scene")
        rows = np.loadtxt(Path(folder) / "scene.0001.subs", comments="%")
    rows = rows[1:, [0, 1, 2, 8, 11, 13, 9, 10, 12]]  # after the size of the block; its order is XX, XY, XZ, YY, YZ, ZZ
    rows *= [*[MILLI] * 3, *[MEGA] * 6]
    np.savetxt(sys.argv[2], rows, "%.9g", ",", header="x1,x2,x3,s11,s22,s33,s12,s13,s23", comments="")


main()
