"""corpus_test.py PROGRAM SCENES [COUNT [SEED]]: right and wrong fields, made by a seed, and their verdicts by slipstick check.
COUNT: number of scenes (default 4; 30 make some 300 right and 1,000 wrong fields). Prints tables by mistake and amplitude.
Fails where a right field is bad or one that is wrong in full is good, where more than 1 bad field in 10 has no quantity, or more
than 1 in 50 a wrong cause."""

import json
import math
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from pathlib import Path

PROGRAM, SCENES = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
COUNT = int(sys.argv[3]) if len(sys.argv) > 3 else 4
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
TEMPORARY = tempfile.TemporaryDirectory()  # goes with the program
FOLDER = Path(TEMPORARY.name)
AMPLITUDES = (0.01, 0.03, 0.1, 0.3, 1.0)  # two of them for each scene; the last must be found
WITHIN_MESH = ("frozen directions",)  # has no amplitude: where little slips it matters to no result


def settings(keys):
    return [word for key, value in keys.items() for word in ("--set", f"{key}={value}")]


def run(*words):
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
    if done.returncode > 1:
        raise RuntimeError(done.stderr)
    return done.stdout


def solve(scene, keys, *words):
    """Rows x1, x2, pressure, q1, q2 of a scene's contact cells, and its result."""
    run("solve", SCENES / f"{scene}.toml", *settings(keys), *words, "--fields", FOLDER / "f.csv", "--json", FOLDER / "f.json",
        "--quiet")
    lines = (FOLDER / "f.csv").read_text().splitlines()
    return ([[float(x) for x in line.split(",")[:5]] for line in lines[1:]], json.loads((FOLDER / "f.json").read_text()))


def check(scene, keys, rows, words=(), digits=17):
    text = "x1,x2,pressure,q1,q2\n" + "".join(",".join(f"{x:.{digits - 1}e}" for x in row) + "\n" for row in rows)
    (FOLDER / "c.csv").write_text(text)
    return json.loads(run("check", SCENES / f"{scene}.toml", FOLDER / "c.csv", *settings(keys), *words, "--json", "-", "--quiet"))


def each(rows, change):
    return [[r[0], r[1], *change(*r)] for r in rows]


def averaged(rows, parts, size):
    """Means over squares of `parts` cells, of a grid about the origin with an even number of squares."""
    sums = defaultdict(lambda: [0.0] * 3)
    for x1, x2, *values in rows:
        cell = tuple(math.floor(x / (parts * h)) for x, h in zip((x1, x2), size))
        for k, value in enumerate(values):
            sums[cell][k] += value / parts**2
    return [[(i + 0.5) * parts * size[0], (j + 0.5) * parts * size[1], *s] for (i, j), s in sums.items()]


def turned(q1, q2, angle):
    c, s = math.cos(angle), math.sin(angle)
    return c * q1 - s * q2, s * q1 + c * q2


def draw(rng):
    """A scene, its keys, and whether its answer is exact."""
    n = 2 * rng.randint(12, 26)
    kind = rng.choice(["paper", "paper", "cone", "ellipse", "turned_ellipse", "patches", "unequal_patches", "dissimilar", "mindlin"])
    keys = {"grid.cells": f"[{n},{n}]", "contact.friction": round(rng.uniform(0.05, 0.6), 3)}
    if kind == "mindlin":
        return kind, keys
    keys["load.moment_ratio"] = round(rng.choice([rng.uniform(0.1, 0.95), rng.uniform(0.4, 0.9)]), 4)
    extents = {"ellipse": "[1.3e-3,0.9e-3]", "turned_ellipse": "[1.2e-3,1.2e-3]", "patches": "[2.1e-3,1.1e-3]",
               "unequal_patches": "[1.9e-3,1.2e-3]", "paper": "[1.1e-3,1.1e-3]", "dissimilar": "[1.3e-3,1.3e-3]"}
    if kind in extents:
        keys["grid.extent"] = extents[kind]
    if "patches" in kind:
        keys["grid.cells"] = f"[{n},{n // 2 + n // 2 % 2}]"
    if kind in ("paper", "ellipse", "turned_ellipse") and rng.random() < 0.25:
        size = 1000.0 * keys["contact.friction"]
        keys["load.force"] = f"[{0.2 * size:.4g},{0.1 * size:.4g}]"
        keys["load.moment_ratio"] = min(keys["load.moment_ratio"], 0.6)
    return kind, keys


def right_fields(rng, scene, keys, own, result):
    yield "own solve", own, {}
    yield "own solve, its twist", own, {"twist": result["twist_angle"]}
    yield "own solve, whole grid", solve(scene, keys | {"solver.model": "full"})[0], {}
    yield "solve to 1e-3", solve(scene, keys | {"solver.tolerance": 1e-6})[0], {}
    yield "3 digits", own, {"digits": 3}
    yield "mm and MPa", [[x * 1e3 for x in r[:2]] + [s * 1e-6 for s in r[2:]] for r in own], {}
    yield "other body", each(own, lambda x1, x2, p, q1, q2: (p, -q1, -q2)), {}
    if "patches" not in scene and scene != "mindlin" and "load.force" not in keys:
        yield "moved by 0.3 cells", [[r[0] + 0.3 * result["cell_size"][0], *r[1:]] for r in own], {}
    noise = rng.choice([1e-4, 3e-4, 1e-3])
    yield f"noise {noise}", each(own, lambda x1, x2, p, q1, q2: (p * rng.gauss(1, noise), q1 * rng.gauss(1, noise),
                                                                 q2 * rng.gauss(1, noise))), {}
    for model in ("hertz", "hertz_averaged"):
        if scene in ("paper", "ellipse"):
            yield model, solve(scene, keys | {"contact.pressure": model})[0], {}
    n1, n2 = json.loads(keys["grid.cells"])
    fine, finer = solve(scene, keys | {"grid.cells": f"[{3 * n1},{3 * n2}]"})
    if n1 % 2 == 0 and n2 % 2 == 0:
        yield "averages of a finer solve", averaged(fine, 3, finer["cell_size"]), {}
    if scene in ("paper", "cone") and "load.force" not in keys or scene == "mindlin":
        yield "exact at centres", solve(scene, keys, "--model", "exact")[0], {}


def wrong_fields(rng, scene, keys, own, result, amplitude):
    """Mistake, field, options, a word that its cause has (or none is right), and whether a mesh may excuse it."""
    a = amplitude
    mu = keys["contact.friction"]
    top = mu * max(r[2] for r in own)
    size = [math.hypot(r[3], r[4]) for r in own]
    middle = [sum(r[k] * r[2] for r in own) / sum(r[2] for r in own) for k in (0, 1)]
    scaled = lambda part: lambda x1, x2, p, q1, q2: (p, q1 * part, q2 * part)

    def where(inside, change):
        return [[*r[:2], *(change(*r) if inside(*r[:2]) else r[2:])] for r in own]

    if scene in ("paper", "ellipse"):
        yield "another ellipse", solve("ellipse", {k: v for k, v in keys.items() if k != "grid.extent"} | {
            "upper.radius_1": 0.018 * (1 + a) ** 2, "upper.radius_2": 0.018 if scene == "paper" else 0.0063,
            "grid.cells": keys["grid.cells"]})[0], {}, None
    if scene == "turned_ellipse":
        yield "turned by up to 30 degrees", solve(scene, keys | {"upper.angle": 0.5235987755982988 * (1 + a)})[0], {}, None
    if scene == "patches":
        yield "weight on one bump", where(lambda x1, x2: x1 > 0, lambda x1, x2, p, q1, q2: [v * (1 - a) for v in (p, q1, q2)]), {}, None
    yield "another pressure", each(own, lambda x1, x2, p, q1, q2: (p ** (1 + a) * (max(r[2] for r in own)) ** -a, q1, q2)), {}, None
    yield "pressure tilted", each(own, lambda x1, x2, p, q1, q2: (p * (1 + a * (x1 - middle[0]) / 6e-4), q1, q2)), {}, None
    if "load.moment_ratio" in keys and "load.force" not in keys:
        ratio = keys["load.moment_ratio"]
        other = keys | {"contact.friction": mu * (1 - 0.2 * a)}
        other.pop("load.moment_ratio")
        if abs(result["moment"]) < 0.8 * (1 - 0.2 * a) * result["moment_limit"]:
            yield "friction coefficient", solve(scene, other | {"load.moment": result["moment"]})[0], {}, "friction"
        yield "moment", solve(scene, keys | {"load.moment_ratio": ratio * (1 - 0.5 * a)})[0], {}, None
        full = max(1e-3, 1 - a)
        yield "full stick", solve(scene, {k: v for k, v in keys.items() if k != "load.moment_ratio"} | {
            "contact.friction": mu / full, "load.moment": result["moment"]})[0], {}, "friction"
        half = solve(scene, keys | {"load.moment_ratio": ratio / 2})[0] if ratio > 0.1 else []
        if half and len(half) == len(own):
            yield "Masing's factor", [[*r[:3], *(r[k] - a * h[k] for k in (3, 4))] for r, h in zip(own, half)], {}, None
    yield "all tractions", each(own, scaled(1 - 0.3 * a)), {}, "friction"
    yield "twist", own, {"twist": result["twist_angle"] * (1 + 0.5 * a) + (1e-4 * a if scene == "mindlin" else 0)}, "twist"
    quadrant = lambda x1, x2: x1 > middle[0] and x2 > middle[1]
    yield "a quadrant", where(quadrant, scaled(1 - a)), {}, None
    yield "half", where(lambda x1, x2: x1 > middle[0], scaled(1 - a)), {}, None
    if scene != "mindlin":  # its q2 is zero
        yield "q2", each(own, lambda x1, x2, p, q1, q2: (p, q1, q2 * (1 - a))), {}, None
    yield "turned tractions", each(own, lambda x1, x2, p, q1, q2: (p, *turned(q1, q2, 0.5 * a))), {}, None
    cell = rng.choice([k for k, s in enumerate(size) if s > 0.5 * max(size)])
    yield "one cell", [r if k != cell else [*r[:3], r[3] * (1 - a), r[4] * (1 - a)] for k, r in enumerate(own)], {}, None
    column = sorted({r[0] for r in own})
    h = column[1] - column[0]
    at = {(round(r[0] / h * 2), round(r[1] / h * 4)): r for r in own}
    shifted = []
    for r in own:
        other = at.get((round(r[0] / h * 2) - 2, round(r[1] / h * 4)), [0.0] * 5)
        shifted.append([*r[:3], *((1 - a) * r[k] + a * other[k] for k in (3, 4))])
    yield "shift by a cell", shifted, {}, None
    yield "linear law", each(own, lambda x1, x2, p, q1, q2: (p, *(v * ((1 - a) + a * math.hypot(q1, q2) / top) for v in (q1, q2)))), {}, None
    noisy = lambda: rng.gauss(1, 0.1 * a)
    yield "noise", each(own, lambda x1, x2, p, q1, q2: (p * noisy(), q1 * noisy(), q2 * noisy())), {}, None
    if scene in ("ellipse", "turned_ellipse") and "load.force" not in keys:
        nu, young = 0.3 * (1 - a), 210e9 * (1 - (0.3 * (1 - a)) ** 2) / (1 - 0.09)
        yield "Poisson's ratio", solve(scene, keys | {f"{body}.{key}": value for body in ("upper", "lower") for key, value in
                                                      (("poisson_ratio", nu), ("young_modulus", young))})[0], {}, "Poisson"
    if scene == "dissimilar":
        yield "K13 missing", solve(scene, keys | {"contact.coupling": "none"})[0], {}, "K13"
    if "ellipse" in scene and "load.force" not in keys:
        yield "frozen directions", solve(scene, keys | {"solver.method": "paper", "solver.tolerance": 1e-5})[0], {}, "keep a direction"
    if scene not in ("paper", "cone", "ellipse", "turned_ellipse") or "load.force" in keys:
        return
    moment = lambda rows: sum(r[0] * r[4] - r[1] * r[3] for r in rows)
    least, most = 0.0, 1e6 * top  # of a first iterate: independent springs with the same moment
    for _ in range(100):
        stiffness = 0.5 * (least + most)
        part = lambda x1, x2, p: math.copysign(min(stiffness, mu * p / math.hypot(x1, x2)), moment(own))
        start = each(own, lambda x1, x2, p, q1, q2: (p, -x2 * part(x1, x2, p), x1 * part(x1, x2, p)))
        least, most = (stiffness, most) if abs(moment(start)) < abs(moment(own)) else (least, stiffness)
    yield "stopped early", [[*r[:3], *((1 - a) * r[k] + a * s[k] for k in (3, 4))] for r, s in zip(own, start)], {}, None


def ask(scene, keys, rows, options):
    words = ["--twist", repr(options["twist"])] if "twist" in options else []
    return check(scene, keys, rows, words, options.get("digits", 17))


def cause_in(details):
    found = re.search(r"likely cause: (.*?)(; also wrong|; the |; it |; Coulomb|$)", details)
    return found.group(1) if found else None


def main():
    rng = random.Random(SEED)
    right, wrong, causes = Counter(), defaultdict(Counter), defaultdict(Counter)
    numbers = Counter()
    for _ in range(COUNT):
        scene, keys = draw(rng)
        try:
            own, result = solve(scene, keys)
        except RuntimeError as error:
            print("not solved:", scene, keys, str(error)[:200])
            continue
        for name, rows, options in right_fields(rng, scene, keys, own, result):
            verdict = ask(scene, keys, rows, options)
            right[name, verdict["verdict"]] += 1
            if verdict["verdict"] == "bad":
                print(f"right but bad: {name}: {scene} {keys}: {verdict['why']}", flush=True)
        for amplitude in rng.sample(AMPLITUDES, 2):
            try:
                for name, rows, options, cause in wrong_fields(rng, scene, keys, own, result, amplitude):
                    try:
                        verdict = ask(scene, keys, rows, options)
                    except RuntimeError:
                        wrong[name][amplitude, "refused"] += 1
                        continue
                    wrong[name][amplitude, verdict["verdict"]] += 1
                    if verdict["verdict"] == "good":
                        if amplitude == AMPLITUDES[-1] and name not in WITHIN_MESH:
                            numbers["in full but good"] += 1
                            print(f"wrong but good: {name}: {scene} {keys}: {verdict['why']}", flush=True)
                        continue
                    found = cause_in(verdict["details"])
                    quantity = any(not item["holds"] for item in verdict["judged"]) or verdict["mistakes"]
                    numbers["bad"] += 1
                    numbers["without a quantity"] += not quantity
                    kind = "none" if not found else "right" if cause and cause in found else "wrong"
                    numbers[f"cause {kind}"] += 1
                    causes[name][kind] += 1
                    if kind == "wrong":
                        print(f"cause: {name} {amplitude}: {scene} {keys}: {found}", flush=True)
            except RuntimeError as error:
                print("not made:", scene, amplitude, str(error)[:160])
    print("| right field | good | bad |\n|---|---|---|")
    for name in sorted({name for name, _ in right}):
        print(f"| {name} | {right[name, 'good']} | {right[name, 'bad']} |")
    print("| mistake | good/bad at 0.01 | 0.03 | 0.1 | 0.3 | 1 | cause right | none | wrong |\n|---|---|---|---|---|---|---|---|---|")
    for name, found in sorted(wrong.items()):
        cells = " | ".join(f"{found[a, 'good']}/{found[a, 'bad']}" for a in AMPLITUDES)
        print(f"| {name} | {cells} | {causes[name]['right']} | {causes[name]['none']} | {causes[name]['wrong']} |")
    print(sum(right.values()), "right,", sum(sum(v for (_, k), v in f.items() if k != "refused") for f in wrong.values()), "wrong:",
          dict(numbers))
    bad_right = sum(count for (_, verdict), count in right.items() if verdict == "bad")
    return int(bad_right > 0 or numbers["in full but good"] > 0 or numbers["cause wrong"] * 50 > numbers["bad"]
               or numbers["without a quantity"] * 10 > numbers["bad"])


if __name__ == "__main__":
    sys.exit(main())
