"""Loops judged in this process, by the requests that the program makes: an interpreter that only keeps its input takes them."""
import functools
import itertools
import json
import os
import subprocess
import tempfile
from pathlib import Path

from slipstick import loops
from slipstick._library import PROGRAM

SCENES = Path(__file__).resolve().parents[3] / "convergence/scenes"


def write_table(file, columns, rows):
    file.write_text(",".join(columns) + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows))


def request_of(scene, file, *options):
    """The program's request for a scene (a file's stem) and a loop or another field; none: the program refuses it."""
    with tempfile.TemporaryDirectory() as folder:
        keeper, request = Path(folder) / "python", Path(folder) / "request.json"
        keeper.write_text(f"#!/bin/sh\ncat > {request}\necho '{{\"error\": \"kept\"}}'\n")
        keeper.chmod(0o755)
        subprocess.run([PROGRAM, "check", SCENES / f"{scene}.toml", file, *options], capture_output=True,
                       env={**os.environ, "SLIPSTICK_PYTHON": str(keeper)})
        return json.loads(request.read_text()) if request.exists() else None


@functools.lru_cache(maxsize=None)
def contacts(scene, motion, loads):
    """The contacts of a scene's loops under these normal loads, or under its own (none)."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "loop.csv"
        columns = ["force" if motion == "displacement" else "moment", motion] + ["normal_load"] * bool(loads)
        write_table(file, columns, [[row, row, load][:len(columns)] for load in loads or [0] for row in range(20)])
        return request_of(scene, file)["groups"]


def judged(columns, scene="paper", strict=False, tolerance=0.01):
    """The verdict on columns by name, as `slipstick check` gives it."""
    of_force = "force" in columns
    load, motion = ("force", "displacement") if of_force else ("moment", "rotation")
    loads = [(key, len(list(rows))) for key, rows in itertools.groupby(columns.get("normal_load", []))]
    ends = [0, *itertools.accumulate([count for _, count in loads] or [len(columns[load])])]
    groups = contacts(scene, motion, tuple(key for key, _ in loads))
    answer = loops.answer({
        "name": scene, "loop": "loop.csv", "of_force": of_force, "tolerance": tolerance, "strict": strict,
        "time": columns.get("time", []), "load": columns[load], "motion": columns[motion],
        "groups": [{**group, "rows": rows} for group, rows in zip(groups, zip(ends, ends[1:]))]})
    assert (answer["result"]["verdict"], answer["exit_code"]) in (("good", 0), ("bad", 1)), answer
    return answer["result"]
