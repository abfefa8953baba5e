"""loops_test.py PROGRAM SCENES: what `slipstick law` says of LAMMPS, held to a loop that LAMMPS ran. Left out where it is not
installed (77)."""

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

LOOPS = Path(__file__).resolve().parents[1] / "loops/loops.py"


def main(program, scenes):
    if not shutil.which("lmp"):
        print("LEFT OUT: LAMMPS is not installed")
        return 77
    scene = Path(scenes) / "paper.toml"
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "loops.json"
        subprocess.run([sys.executable, LOOPS, program, scene, "--json", file], check=True)
        loop = next(each for each in json.loads(file.read_text())["loops"] if "law: twisting" in each["friction"])
    stiffness, limit = (float(word) for word in (loop["friction"].split()[4], loop["friction"].split()[6]))
    limit *= 1000.0  # N, the scene's normal load
    assert abs(loop["largest_moment_over_limit"] - 1) < 1e-6, loop
    measured = loop["loads"][0]
    assert abs(measured["stiffness"]["value"] / stiffness - 1) < 1e-6, measured
    # A spring with a slider loses four times the limit for what it turns beyond the spring's reach.
    lost = 4 * limit * (loop["largest_rotation"] - limit / stiffness)
    assert abs(measured["areas"][0]["value"] / lost - 1) < 1e-2, (measured["areas"], lost)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
