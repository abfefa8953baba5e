"""loops_test.py PROGRAM SCENES NAME PYTHON: compares loops of a simulator with the errors that `slipstick law` states for it, and verdicts
of slipstick.conformance with what is known of the simulator. Skipped (77) if it is not installed. PYTHON runs the simulator if possible:
the Python of `make peers`, with MuJoCo, Drake and PyBullet."""

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


def has_verdicts(rows, friction, **wanted):
    """friction: which of the simulator's."""
    variant = list(dict.fromkeys(row["variant"] for row in rows))[friction]
    names = [key.replace("_0_", "_0.").replace("_", "-") for key in wanted]
    found = {row["on"]: (row["verdict"], row["cause"]) for row in rows if row["variant"] == variant}
    assert [found[name] for name in names] == list(wanted.values()), found


def imposes_loads(rows):
    """Springs with caps do not creep below the limit, and the servo's loads are right to 1e-9 of the limit."""
    assert {row["verdict"] for row in rows if row["on"].startswith("hold")} == {"green"}, rows
    assert max(row["missed"] for row in rows) < 1e-9, rows


def main(program, scenes, name, python):
    scene = Path(scenes) / "paper.toml"
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "loops.json"
        words = [python if os.access(python, os.X_OK) else sys.executable, "-B", LOOPS, program, scene, "--json", file, "--only", name]
        subprocess.run([*words, *(["--cases"] if name in ("LAMMPS", "MuJoCo", "PyBullet") else [])], check=True)
        found = json.loads(file.read_text())
    loops, law, rows = found["loops"], found["law"], found["rows"]
    if not loops:
        return 77  # and loops.py said so
    if name == "LAMMPS":
        is_spring_and_slider(loops[1], law["lammps"])
        imposes_loads(rows)
        has_verdicts(rows, 0, load_powers=("green", None), rates=("green", None))  # Marshall's spring and cap grow with the contact
        has_verdicts(rows, 1, limit_surface=("red", "box"), normal_load=("red", "normal_load_ignored"))
        has_verdicts(rows, 1, first_loading=("red", "spring_and_cap"), load_powers=("red", "constant_radius"), rates=("green", None))
    elif name == "PyBullet":  # rigid and without creep about the normal; force and moment know nothing of each other
        has_verdicts(rows, 0, hold_moment_0_9=("red", "free"), limit_surface=("red", "moment_off"))
        has_verdicts(rows, 1, first_loading=("red", "rigid"), hold_moment_0_9=("green", None), limit_surface=("red", "box"),
                     load_powers=("red", "constant_radius"))
    elif name == "Yade":
        is_a_cap_without_memory(loops[1])
        is_spring_and_slider(loops[2], law["lammps"])
    else:
        for loop in loops:
            creeps(loop, law["mujoco"]["lost_presliding"])
        if rows:
            has_verdicts(rows, 1, hold_moment_0_5=("red", "creeps"), hold_force_0_5=("red", "creeps"), rates=("red", "creeps"))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
