#!/usr/bin/env python3
"""Draws loads and histories and asks how often a result is further off than it says.

    drawn.py PROGRAM [--seed N] [--count N]

Each answer is held to the exact one, or else to three times the cells along each axis and twelve parts of each step.
One line for each case that is further off than it says; then how many there are, and what is stated over the error in
the median. Exit code 1 where more than 1 in 100 is further off.
"""
import argparse
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

SHAPES = {
    "sphere": 'shape = "sphere"\nradius = 0.018',
    "nearly round": 'shape = "ellipsoid"\nradius_1 = 0.018\nradius_2 = 0.01801',
    "ellipsoid": 'shape = "ellipsoid"\nradius_1 = 0.018\nradius_2 = 0.04',
    "cone": 'shape = "cone"\nslope = 0.02',
    "flat punch": 'shape = "flat_punch"\nradius = 0.0005',
    "power": 'shape = "power"\nexponent = 4.0\ncoefficient = 9.6e7',
    "steep power": 'shape = "power"\nexponent = 10.0\ncoefficient = 6.144e27',
}
NORMAL = 1000.0


def force(size, angle):
    return f"force = [{size * math.cos(angle):.8g}, {size * math.sin(angle):.8g}]"


def history(draw, friction):
    """Two to six steps of torsion, forces, both, or under changing normal loads."""
    kind = draw.choice(["torsion", "force", "both", "normal"])
    normal = NORMAL
    steps = []
    for i in range(draw.randint(2, 6)):
        keys = []
        if kind == "normal" and i > 0 and draw.random() < 0.6:
            normal *= draw.uniform(0.6, 1.6)
            keys.append(f"normal = {normal:.6g}")
        held = bool(keys) and draw.random() < 0.5
        if not held and (kind == "force" or kind == "normal" or kind == "both" and draw.random() < 0.6):
            keys.append(force(draw.uniform(0.05, 0.7) * friction * normal, draw.choice([0.0, math.pi, draw.uniform(0, 6.28)])))
        if kind == "torsion" or kind == "both" and (not keys or draw.random() < 0.5):
            size = 0.95 if kind == "torsion" else 0.65
            keys.append(f"moment_ratio = {draw.uniform(-size, size):.8g}")
        steps.append("[[step]]\n" + "\n".join(keys) + "\n")
    return "".join(steps)


def ratio(draw):
    """From tiny loads to loads near the limit."""
    return draw.choice([10 ** draw.uniform(-6, -1), draw.uniform(0.1, 0.9), 1 - 10 ** draw.uniform(-6, -1)])


def scene(draw):
    shape = draw.choice(list(SHAPES))
    friction = draw.choice([0.1, 0.3])
    poisson = draw.choice([0.0, 0.3, 0.45])
    is_history = draw.random() < 0.6
    pressure = "solved"
    if shape == "sphere" and not is_history:
        pressure = draw.choice(["solved", "hertz", "hertz_averaged"])
    loads = history(draw, friction) if is_history else ""
    load = "" if is_history else f"moment_ratio = {ratio(draw)!r}"
    cells = draw.choice([16, 20, 24, 32, 40])
    return (
        f"[upper]\n{SHAPES[shape]}\nyoung_modulus = 210e9\npoisson_ratio = {poisson}\n"
        f"[lower]\nyoung_modulus = 210e9\npoisson_ratio = {poisson}\n"
        f'[contact]\nfriction = {friction}\npressure = "{pressure}"\n[load]\nnormal = {NORMAL}\n{load}\n{loads}'
        f"[grid]\ncells = [{cells}, {cells}]\n"
    )


def solve(program, file, *keys):
    command = [program, "solve", file, "--json", "-", "--quiet"]
    for key in keys:
        command += ["--set", key]
    output = subprocess.run(command, capture_output=True, text=True).stdout
    result = json.loads(output) if output.startswith("{") else {}
    return result if result.get("status") == "converged" else None


def as_list(value):
    return value if isinstance(value, list) else [value]


def case(program, file, draw):
    """The stated uncertainty and the error; None where one of them is not known."""
    file.write_text(scene(draw))
    result = solve(program, file)
    if result and "steps" not in result and result.get("exact") and draw.random() < 0.5:  # a moment that is no ratio
        text = file.read_text()
        exact = result["exact"]["moment_limit"]
        line = next(line for line in text.splitlines() if line.startswith("moment_ratio"))
        file.write_text(text.replace(line, f"moment = {float(line.split('=')[1]) * exact!r}"))
        result = solve(program, file)
    if not result or result["resolved"]["absolute"] is None:
        return None
    number = result["resolved"]["number"]
    reference = (result.get("exact") or {}).get(number)
    if reference is None:
        cells = result["cells"]
        extent = [n * h for n, h in zip(cells, result["cell_size"])]
        parts = "solver.substeps=12" if "steps" in result else "solver.substeps=1"
        finer = solve(program, file, f"grid.cells=[{3 * cells[0]},{3 * cells[1]}]", f"grid.extent={extent}", parts)
        if not finer:
            return None
        reference = finer[number]
    return result["resolved"]["absolute"], math.dist(as_list(result[number]), as_list(reference))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=100)
    options = parser.parse_args()
    draw = random.Random(options.seed)
    over_error = []
    beyond = 0
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "scene.toml"
        for _ in range(options.count):
            found = case(options.program, file, draw)
            if found is None:
                continue
            stated, error = found
            over_error.append(stated / max(error, 1e-300))
            if not error <= stated:
                beyond += 1
                print(f"{error:.3g} off, stated {stated:.3g}:\n{file.read_text()}")
    print(f"seed {options.seed}: {beyond} of {len(over_error)} further off than they say; stated over error "
          f"{statistics.median(over_error):.3g} in the median")
    return 1 if beyond > len(over_error) / 100 else 0


if __name__ == "__main__":
    sys.exit(main())
