#!/usr/bin/env python3
"""same_answers.py PROGRAM OTHER SCENE.toml...: do two builds leave the same out of a scene's model, and find the same
numbers? Exit code 0: all; 1: some do not; 2: a solve failed."""

import json
import subprocess
import sys

KEYS = ("contact_radius", "stick_radius", "twist_angle", "moment", "peak_pressure", "approach", "elastic_energy", "dissipated")
ALLOWED = 1e-9  # relative; a stick radius follows from where slip begins, which rounding moves by more
ALLOWED_OF = {"stick_radius": 1e-6}


def solved(program, scene):
    run = subprocess.run([program, "solve", scene, "--set", "solver.threads=1", "--quiet", "--json", "-"],
                         capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"{program}: {scene}: exit code {run.returncode}: {run.stderr.strip()}")
    return json.loads(run.stdout)


def numbers(result, key):
    value = result[key]
    return [x or 0.0 for x in (value if isinstance(value, list) else [value])]


def differences(one, other):
    if one["model"] != other["model"]:
        yield f"leaves out {other['model']}, not {one['model']}"
    for key in KEYS:
        size = max(map(abs, numbers(one, key)))
        apart = max(abs(a - b) for a, b in zip(numbers(one, key), numbers(other, key), strict=True))
        if not apart <= ALLOWED_OF.get(key, ALLOWED) * size:
            yield f"{key} is {other[key]}, not {one[key]}"


def main(words):
    if len(words) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    found = [f"{scene}: {text}" for scene in words[2:]
             for text in differences(solved(words[0], scene), solved(words[1], scene))]
    print("\n".join(found) or f"{len(words) - 2} scenes: the same models and numbers")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
