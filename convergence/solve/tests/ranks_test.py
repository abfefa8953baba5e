"""Solves scenes on several ranks: the answer has the same digits on any number of them."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

PROGRAM, SCENES, MPIRUN = sys.argv[1:4]
# What may differ from run to run, or tells of the ranks.
DIFFERS = ("seconds", "peak_bytes", "provenance", "ranks", "solver_bytes", "predicted_bytes")
CASES = {
    "paper": ("[33,31]", (2, 3, 4, 7)),
    "torsion_loop": ("[24,24]", (2,)),
    "rough_sphere": ("[37,29]", (3,)),
    "dissimilar": ("[23,26]", (2,)),
}


def run(ranks, arguments):
    # Open MPI asks twice whether root means it, and once whether ranks may share a processor.
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                       OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1")
    start = [MPIRUN, "-n", str(ranks)] if ranks else []
    return subprocess.run([*start, PROGRAM, *arguments], env=environment, capture_output=True, text=True, check=False)


def without(value):
    if isinstance(value, dict):
        return {key: without(inner) for key, inner in value.items() if key not in DIFFERS}
    return [without(inner) for inner in value] if isinstance(value, list) else value


def solved(ranks, scene, folder):
    result, fields = folder / f"{ranks}.json", folder / f"{ranks}.csv"
    done = run(ranks, ["solve", f"{SCENES}/{scene}.toml", "--set", f"grid.cells={CASES[scene][0]}", "--model", "full",
                       "--json", str(result), "--fields", str(fields)])
    assert done.returncode == 0, f"{scene} on {ranks} ranks: {done.stdout}{done.stderr}"
    return json.loads(result.read_text()), fields.read_bytes(), done.stdout


def agrees(scene, folder):
    alone, fields, _ = solved(0, scene, folder)
    assert "ranks" not in alone
    for ranks in CASES[scene][1]:
        answer, own_fields, text = solved(ranks, scene, folder)
        assert without(answer) == without(alone), f"{scene}: other numbers on {ranks} ranks"
        assert own_fields == fields, f"{scene}: other fields on {ranks} ranks"
        assert text.count("moment limit") <= 1 and text.count("twist angle") <= 1, "only one rank prints"
        assert answer["ranks"]["number"] == ranks == len(answer["ranks"]["sent_bytes"])


def is_refused(arguments, reason):
    done = run(2, arguments)
    assert done.returncode == 2, f"{arguments}: exit code {done.returncode}"
    assert done.stderr.count(reason) == 1, f"{arguments}: {done.stderr}"


def main():
    paper = f"{SCENES}/paper.toml"
    with tempfile.TemporaryDirectory() as folder:
        for scene in CASES:
            agrees(scene, pathlib.Path(folder))
        is_refused(["solve", paper], "allowed there: --model full")
        is_refused(["solve", paper, "--model", "full", "--accuracy", "1e-2"], "not on several ranks")
        is_refused(["solve", paper, "--model", "full", "--set", 'solver.operator="direct"'], "allowed there: \"dcfft\"")
        is_refused(["exact", "--moment-ratio", "0.5"], "allowed under mpirun: solve")
        is_refused(["solve", f"{folder}/nowhere.toml"], "nowhere.toml")


main()
