"""peers_test.py PROGRAM SCENES NAME: compares another program's answers with this one's; both solve the same discrete problem. A program
with a file stresses.py is also compared below the surface. Skipped (77) if the program is not installed."""

import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

PROGRAMS = Path(__file__).resolve().parents[1]
CELLS = ("--set", "grid.cells=[24,24]")
FORCE = ("mindlin", ("load.twist=0",), "displacement")  # without rotation, Poisson's ratios zero
# Scenes, their changed keys, and the compared numbers.
WHOLE = [("paper", (), "twist_angle"), ("mindlin", (), "displacement"), ("ellipse", (), "peak_pressure"),
         ("imposed_displacement", (), "moment"), ("off_centre", (), "twist_angle")]
COMPARED = {"siconos": WHOLE, "contact": WHOLE,
            "aspher": [("paper", (), "approach"), FORCE],
            "tamaas": [("paper", (), "approach"), ("ellipse", (), "peak_pressure")],
            "contactmechanics": [("paper", (), "approach"), ("ellipse", (), "peak_pressure")]}
WITHIN = 1e-5  # relative; CONTACT writes the fewest digits, six


def solved(program, scene, settings, *words):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "result.json"
        for setting in settings:
            words += ("--set", setting)
        done = subprocess.run([program, "solve", scene, *CELLS, "--json", file, *words], capture_output=True, text=True)
        return done, json.loads(file.read_text()) if file.exists() else None


def main(program, scenes, name):
    file = PROGRAMS / name / "program.toml"
    version = [sys.executable if word == "{python}" else word for word in tomllib.loads(file.read_text())["version"]]
    try:
        installed = subprocess.run(version, cwd=file.parent, capture_output=True).returncode == 0
    except OSError:
        installed = False
    if not installed:
        print(f"LEFT OUT: {name} is not installed; make peers installs it")
        return 77
    for scene, settings, number in COMPARED[name]:
        done, theirs = solved(program, Path(scenes) / f"{scene}.toml", settings, "--program", file)
        assert done.returncode == 0, done.stdout + done.stderr
        ours = solved(program, Path(scenes) / f"{scene}.toml", settings)[1]
        one, other = (each[number][0] if number == "displacement" else each[number] for each in (ours, theirs))
        assert abs(other / one - 1) <= WITHIN, (scene, number, one, other)
    done, _ = solved(program, Path(scenes) / "spence.toml", (), "--program", file)  # pressure and tractions in turns
    assert done.returncode == 2, done.stdout
    if (PROGRAMS / name / "stresses.py").exists():
        sys.path.insert(0, str(PROGRAMS))
        import stresses
        with tempfile.TemporaryDirectory() as folder:
            case = stresses.Case(program, Path(scenes) / "paper.toml", Path(folder), 64, 0.9)
            theirs, ours = (case.judged(each, "", case.solved_by(name) if each == name else 0.0) for each in (name, "slipstick"))
        assert theirs["verdict"] == "good", theirs["why"]
        for component, error in ours["errors"].items():  # the points are not symmetric in x1 and x2
            assert abs(theirs["errors"][component] - error) <= 2e-4, (component, theirs, ours)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
