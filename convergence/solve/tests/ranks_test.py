"""Solves scenes on several ranks: the answer has the same bits on any number of ranks, and no finished step is lost
when a rank is killed."""
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests"))
from hold import Hold  # noqa: E402

PROGRAM, SCENES, MPIRUN = sys.argv[1:4]
# Keys that may differ from run to run, or depend on the ranks.
DIFFERS = ("seconds", "peak_bytes", "provenance", "ranks", "solver_bytes", "predicted_bytes")
FULL = ["--model", "full"]
# Odd and prime sizes, more ranks than bands of rows; a quadrant; a rough surface, dissimilar bodies, full coupling.
CASES = (
    ("paper", [33, 31], FULL, (2, 7)),
    ("paper", [64, 48], [], (4,)),
    ("rough_sphere", [37, 29], FULL, (3,)),
    ("dissimilar", [23, 26], [], (2,)),
    ("spence", [24, 20], [], (2,)),
)
# One rank exchanges rows and columns of a square quadrant; several do not.
ROUNDING = 1e-13
# Memory of one of four ranks, half of it for the program and MPI, and the largest error of its prediction.
LESS = 0.75
AS_PREDICTED = 0.2


def command(ranks, arguments):
    return [*([MPIRUN, "-n", str(ranks)] if ranks else []), PROGRAM, *arguments]


def run(ranks, arguments):
    return subprocess.run(command(ranks, arguments), capture_output=True, text=True, check=False)


def without(value):
    if isinstance(value, dict):
        return {key: without(inner) for key, inner in value.items() if key not in DIFFERS}
    return [without(inner) for inner in value] if isinstance(value, list) else value


def solved(ranks, scene, cells, options, folder):
    # All ranks write one HDF5 file, a CSV file only the first.
    result, fields = folder / f"{ranks}.json", folder / f"{ranks}.{'csv' if scene == 'spence' else 'h5'}"
    done = run(ranks, ["solve", f"{SCENES}/{scene}.toml", "--set", f"grid.cells={cells}", *options,
                       "--json", str(result), "--fields", str(fields)])
    assert done.returncode == 0, f"{scene} on {ranks} ranks: {done.stdout}{done.stderr}"
    return json.loads(result.read_text()), fields.read_bytes(), done.stdout


def agrees(scene, cells, options, numbers, folder):
    alone, fields, _ = solved(0, scene, cells, options, folder)
    assert "ranks" not in alone
    for ranks in numbers:
        answer, own_fields, text = solved(ranks, scene, cells, options, folder)
        assert without(answer) == without(alone), f"{scene}: other numbers on {ranks} ranks"
        assert own_fields == fields, f"{scene}: other fields on {ranks} ranks"
        assert text.count("moment limit") <= 1 and text.count("twist angle") <= 1, "only one rank prints"
        of_ranks = answer["ranks"]
        assert of_ranks["number"] == ranks == len(of_ranks["sent_bytes"]) == len(of_ranks["peak_bytes"])
        assert all(sent > 0 for sent in of_ranks["sent_bytes"])


def agrees_on_a_square_quadrant(folder):
    alone, _, _ = solved(0, "paper", [32, 32], [], folder)
    two, _, _ = solved(2, "paper", [32, 32], [], folder)
    three, _, _ = solved(3, "paper", [32, 32], [], folder)
    assert without(two) == without(three)
    for key in ("twist_angle", "moment", "stick_radius"):
        assert math.isclose(alone[key], two[key], rel_tol=ROUNDING), f"{key}: {alone[key]} and {two[key]}"


def holds_less(folder):
    """One of four ranks uses less memory than one process, and about as much as predicted."""
    scene = ["solve", f"{SCENES}/rough_sphere.toml", "--set", "grid.cells=[1024,1024]", *FULL]
    result = folder / "memory.json"
    assert run(0, [*scene, "--json", str(result)]).returncode == 0
    alone = json.loads(result.read_text())["peak_bytes"]
    assert run(4, [*scene, "--json", str(result)]).returncode == 0
    shared = json.loads(result.read_text())
    peak = max(shared["ranks"]["peak_bytes"])
    assert peak <= LESS * alone, f"{peak} bytes on a rank of four, {alone} on one"
    assert abs(shared["predicted_bytes"] / peak - 1.0) <= AS_PREDICTED, f"{peak}, said: {shared['predicted_bytes']}"


def is_refused(arguments, reason):
    done = run(2, arguments)
    assert done.returncode == 2, f"{arguments}: exit code {done.returncode}"
    assert done.stderr.count(reason) == 1, f"{arguments}: {done.stderr}"


def rank_to_kill(started):
    """The last process started by mpirun."""
    for _ in range(600):
        children = subprocess.run(["ps", "-o", "pid=", "--ppid", str(started.pid)], capture_output=True, text=True,
                                  check=False).stdout.split()
        if len(children) >= 3:
            return int(children[-1])
        time.sleep(0.05)
    raise AssertionError("mpirun has not started three ranks")


def survives_a_death(folder):
    scene = ["solve", f"{SCENES}/fretting_torsion.toml", "--set", "grid.cells=[40,32]", "--set", "cycles=8"]
    kept = folder / "kept.h5"
    going = ["--checkpoint", str(kept), "--resume", "--json", str(folder / "resumed.json")]
    hold = Hold(folder, "*kept.h5", 1, after=True)
    with subprocess.Popen(command(3, [*scene, *going]), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          env=hold.environment) as started:
        hold.process(started)
        os.kill(rank_to_kill(started), signal.SIGKILL)
        hold.release()
        said = started.communicate()[0]
    assert started.returncode != 0, "the run went on without one of its ranks"
    assert "signal 9" in said, said
    done = run(2, [*scene, *going])
    assert done.returncode == 0, done.stdout + done.stderr
    assert "after step" in done.stderr and "kept.h5" in done.stderr, done.stderr
    assert run(0, [*scene, "--json", str(folder / "whole.json")]).returncode == 0
    whole, resumed = (json.loads((folder / name).read_text()) for name in ("whole.json", "resumed.json"))
    assert without(whole) == without(resumed), "a history that lost a rank ends elsewhere"


def main():
    paper = f"{SCENES}/paper.toml"
    with tempfile.TemporaryDirectory() as folder:
        for case in CASES:
            agrees(*case, pathlib.Path(folder))
        agrees_on_a_square_quadrant(pathlib.Path(folder))
        holds_less(pathlib.Path(folder))
        survives_a_death(pathlib.Path(folder))
        is_refused(["solve", paper, "--accuracy", "1e-2"], "not on several ranks")
        is_refused(["solve", paper, "--set", 'solver.operator="direct"', *FULL], "allowed there: \"dcfft\"")
        is_refused(["solve", f"{folder}/nowhere.toml"], "nowhere.toml")
        no_file = pathlib.Path(folder) / "no_file.h5"
        no_file.symlink_to("/dev/null")
        is_refused(["solve", paper, "--set", "grid.cells=[16,16]", "--fields", str(no_file)], "no_file.h5: cannot be written")


main()
