"""loops_test.py PROGRAM SCENES NAME PYTHON: compares loops of a simulator with the errors that `slipstick law` states for it. Skipped
(77) if it is not installed. PYTHON runs the simulator if possible: the Python of `make peers`, with MuJoCo and Drake."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

LOOPS = Path(__file__).resolve().parents[1] / "loops/loops.py"
LOAD = 1000.0  # N, the scene's


def is_spring_and_slider(loop, law):
    """It loses four times the limit times the rotation beyond the elastic range."""
    stiffness, limit = law["k_twist"], law["mu_twist"] * LOAD
    assert abs(loop["largest_moment_over_limit"] - 1) < 1e-6, loop
    measured = loop["loads"][0]
    assert abs(measured["stiffness"]["value"] / stiffness - 1) < 2e-3, measured
    lost = 4 * limit * (loop["largest_rotation"] - limit / stiffness)
    assert abs(measured["areas"][0]["value"] / lost - 1) < 1e-2, (measured["areas"], lost)


def is_a_cap_without_memory(loop):
    assert abs(loop["largest_moment_over_limit"] - 1) < 1e-6, loop
    measured = loop["loads"][0]
    assert abs(measured["areas"][0]["value"]) < 0.01 * measured["areas"][0]["exact"], measured


def creeps(loop, exact):
    """Creep below the limit, where the right rotation is constant."""
    assert loop["largest_moment_over_limit"] < 0.91, loop
    assert loop["largest_rotation"] > 3 * exact, loop


def main(program, scenes, name, python):
    scene = Path(scenes) / "paper.toml"
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "loops.json"
        words = [python if os.access(python, os.X_OK) else sys.executable, "-B", LOOPS, program, scene, "--json", file, "--only", name]
        subprocess.run(words, check=True)
        found = json.loads(file.read_text())
    loops, law = found["loops"], found["law"]
    if not loops:
        return 77  # and loops.py said so
    if name == "LAMMPS":
        is_spring_and_slider(loops[1], law["lammps"])
    elif name == "Yade":
        is_a_cap_without_memory(loops[1])
        is_spring_and_slider(loops[2], law["lammps"])
    else:
        for loop in loops:
            creeps(loop, law["mujoco"]["lost_presliding"])
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
