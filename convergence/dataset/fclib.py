"""Discrete contact problems with certified solutions: compact files, and FCLIB files of the smaller ones."""

import subprocess
import sys
from fractions import Fraction
from functools import partial
from pathlib import Path

import fields
import h5py
import numpy as np
from fields import audit

sys.path.insert(0, str(Path(__file__).resolve().parent / "readers"))
import assemble_fclib  # noqa: E402

MOST_EXPANDED = 300  # cells; a matrix of 2,304 cells would take 200 MB
TOLERANCE = 1e-13
# Name: scene, part of its coarse grid's cells, all of the grid's cells or those within two of the contact.
PROBLEMS = {"sphere": ("sphere", Fraction(1, 3), False), "sphere-force": ("sphere-pushed", Fraction(1, 3), False),
            "ellipse": ("ellipse-near-limit", Fraction(1, 2), False), "ellipse-turned": ("ellipse-turned", Fraction(1, 3), False),
            "two-bumps": ("two-bumps-unequal", Fraction(1, 2), False), "dissimilar": ("dissimilar-step", Fraction(1, 4), False),
            "rough-sphere": ("rough-sphere", Fraction(1, 2), False), "sphere-1600": ("sphere", Fraction(5, 6), True),
            "rough-sphere-2304": ("rough-sphere", Fraction(1), True), "ellipse-2304": ("ellipse-square", Fraction(1), True)}


def around(contact):
    wide = np.pad(contact, 2)
    n1, n2 = contact.shape
    return np.nonzero(np.logical_or.reduce([wide[i:i + n1, j:j + n2] for i in range(5) for j in range(5)]))


def problem(program, folder, name):
    """Influence coefficients, cells, q, u, r, friction, gap of the certificate."""
    scene_name, part, whole = PROBLEMS[name]
    scene = fields.Scene(scene_name, part, folder, TOLERANCE)
    result, found, _ = scene.solve(program)
    tables = audit.scene_of({"scene": scene.file.name, "set": []}, folder)
    cells = np.indices(scene.n).reshape(2, -1) if whole else np.array(around(found["pressure"] > 0))
    kernels = audit.kernels(scene.n, scene.h, audit.compliances(tables))
    kernels = {key: np.fft.irfft2(table, [2 * n for n in scene.n]) for key, table in kernels.items()}
    if tables["contact"].get("coupling") != "full":
        del kernels["13"], kernels["23"]
    approach, stress = result["approach"], result["peak_pressure"]
    x, y = scene.x[tuple(cells)], scene.y[tuple(cells)]
    twist, (push1, push2) = result["twist_angle"], result["displacement"]
    q = np.column_stack([scene.undeformed[tuple(cells)] - approach, twist * y - push1, -twist * x - push2]).ravel() / approach
    r = np.column_stack([found[key][tuple(cells)] for key in ("pressure", "q1", "q2")]).ravel() / stress
    scaled = {key: table * (stress / approach) for key, table in kernels.items()}
    matrix = assemble_fclib.matrix_of(scaled, cells)
    attributes = {"title": f"slipstick: {name}, {cells.shape[1]} cells", "friction": tables["contact"]["friction"],
                  "certificate_gap": result["certificate"]["gap"], "stress": stress, "length": approach, "scene": scene.text}
    return attributes, scaled, cells, q, matrix @ r + q, r, matrix


def written_problem(program, folder, output, name):
    attributes, tables, cells, q, u, r, matrix = problem(program, folder, name)
    with h5py.File(output / "compact" / f"{name}.h5", "w", libver="earliest") as h5:
        h5.attrs.update(attributes)
        group = h5.create_group("tables")
        for key, table in tables.items():
            group.create_dataset(key, data=table, compression="gzip", shuffle=True)
        h5["cells"], h5["q"], h5["u"], h5["r"] = cells.astype("i4"), q, u, r
    if cells.shape[1] <= MOST_EXPANDED:
        assemble_fclib.write_fclib(output / f"{name}.h5", matrix, q, attributes["friction"], (u, r), attributes["title"])
    return cells.shape[1]


def make(program, output, work, small, pool):
    """Writes the problems; returns the number of cells of each."""
    (output / "compact").mkdir(parents=True)
    names = ["sphere"] if small else list(PROBLEMS)
    return dict(zip(names, pool.map(partial(written_problem, str(program), work, output), names, chunksize=1)))


def distance(solver, file, tolerance="1e-11"):
    """How far Siconos' solution (the program fclib_solve) is from the file's, over the largest reaction of each kind."""
    with h5py.File(file, "r+") as h5:
        ours, friction = h5["solution/r"][:].reshape(-1, 3), h5["fclib_local/vectors/mu"][0]
        del h5["solution"]
    subprocess.run([solver, file, tolerance], check=True, stdout=subprocess.DEVNULL)
    with h5py.File(file) as h5:
        theirs = h5["solution/r"][:].reshape(-1, 3)
    return (np.abs(theirs - ours).max(axis=0) / [1.0, friction, friction]).max()
