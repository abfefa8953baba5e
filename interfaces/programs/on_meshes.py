#!/usr/bin/env python3
"""on_meshes.py PROGRAM SCENE OUTPUT [--json FILE] [--only NAME]: finite-element programs twist the sphere of the scene by 0.5 and
0.9 of the limit moment, each on its own meshes, and `slipstick check` judges every field. OUTPUT keeps decks and fields. Reports
programs that are missing."""

import argparse
import json
import subprocess
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
LONGEST = 900  # s, of one program on one mesh
RATIOS = (0.5, 0.9)  # of the limit moment, as in elements.py


def found(only=None):
    """The files of programs with meshes of their own: folders, keys."""
    for file in sorted(HERE.glob("*/program.toml")):
        program = tomllib.loads(file.read_text())
        if "faces" in program and only in (None, program["name"]):
            yield file.parent, program


def said_version(folder, program):
    """The version, or None if the program is missing."""
    done = subprocess.run(program["version"], cwd=folder, capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else None


def solved(folder, program, scene, faces, output):
    """The numbers of the program on a mesh with this number of faces across the contact radius, and why some are missing."""
    values, numbers = {"scene": Path(scene).resolve(), "folder": output.resolve(), "faces": faces}, output / "numbers.json"
    numbers.unlink(missing_ok=True)
    try:
        subprocess.run([word.format(**values) for word in program["command"]], cwd=folder, check=True, timeout=LONGEST)
        return json.loads(numbers.read_text()), None
    except (subprocess.CalledProcessError, subprocess.TimeoutExpired) as failed:
        found = json.loads(numbers.read_text()) if numbers.exists() else {"twist_angle": {}, "cpu_seconds": None, "check": []}
        why = f"no answer within {LONGEST} s" if isinstance(failed, subprocess.TimeoutExpired) else "its command fails"
        return found, why


def judged(slipstick, scene, field, ratio, twist, words):
    """The result of `slipstick check`, or the reason why the field could not be judged."""
    done = subprocess.run([slipstick, "check", scene, field, "--set", f"load.moment_ratio={ratio}", "--twist", str(twist),
                           *map(str, words), "--json", "-", "--quiet"], capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode in (0, 1) else {"verdict": "not judged", "why": done.stderr.strip(), "judged": []}


def command_line(description):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("slipstick")
    parser.add_argument("scene")
    parser.add_argument("output", type=Path)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--only")
    return parser.parse_args()


def main():
    arguments = command_line(__doc__)
    board = []
    for folder, program in found(arguments.only):
        version = said_version(folder, program)
        if version is None:
            print(f"LEFT OUT: {program['name']} is not installed")
            continue
        for faces in program["faces"]:
            output = arguments.output / f"{program['name']}-{faces}"
            numbers, why = solved(folder, program, arguments.scene, faces, output)
            for ratio, twist in numbers["twist_angle"].items():
                result = judged(arguments.slipstick, arguments.scene, output / f"{ratio}.vtu", ratio, twist, numbers["check"])
                board.append({"program": version, "faces": faces, "moment_ratio": float(ratio), "twist": twist,
                              "cpu_seconds": numbers["cpu_seconds"], "check": result})
                errors = ", ".join(f"{each['quantity']} {each['value']:.1e}" for each in result["judged"] if each["value"] is not None)
                print(f"{version}, {faces} faces across the contact radius, {numbers['cpu_seconds']:.0f} CPU s: rotation {twist:.5e} rad "
                      f"at {ratio} of the limit moment\n  {errors}\n  {result['verdict']}: {result['why']}")
            for ratio in [each for each in RATIOS if f"{each:g}" not in numbers["twist_angle"]]:
                print(f"{version}, {faces} faces across the contact radius: no answer at {ratio} of the limit moment: {why}")
                board.append({"program": version, "faces": faces, "moment_ratio": ratio, "twist": None, "cpu_seconds": None, "check": {
                    "verdict": "not judged", "why": why, "judged": []}})
    if arguments.json:
        arguments.json.write_text(json.dumps({"scene": arguments.scene, "board": board}, indent=1))


if __name__ == "__main__":
    main()
