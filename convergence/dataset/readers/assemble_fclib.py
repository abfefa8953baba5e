"""assemble_fclib.py COMPACT.h5 OUTPUT.h5: writes a discrete problem in FCLIB's format, with the whole matrix W, from its influence
coefficients. NumPy and h5py are needed. Reactions r are tractions over the largest pressure, velocities u = W r + q displacements over
the approach; normal, x1, x2 of each cell in turn."""
import sys

import h5py
import numpy as np


def matrix_of(tables, cells):
    """Displacements by tractions on the cells given by their two indices. Reactions press the bodies apart: where `13` and `23` exist, a
    pressure couples with the other sign."""
    matrix = np.zeros((3 * len(cells[0]),) * 2)
    offset = [np.subtract.outer(index, index) for index in cells]
    for row, column, name in ((0, 0, "33"), (1, 1, "11"), (2, 2, "22"), (1, 2, "12"), (2, 1, "12"), (1, 0, "13"), (2, 0, "23")):
        if name in tables:
            matrix[row::3, column::3] = tables[name][offset[0], offset[1]]
            if column == 0 and row > 0:
                matrix[0::3, row::3] = matrix[row::3, 0::3].T
    return matrix


def write_fclib(file, matrix, q, friction, solution=(), title=""):
    """A local problem, W by compressed rows without zeros, and a solution u, r."""
    rows, columns = np.nonzero(matrix)
    with h5py.File(file, "w", libver="earliest") as h5:
        problem = h5.create_group("fclib_local")
        problem["spacedim"] = np.array([3], dtype="i4")
        w = problem.create_group("W")
        for name, number in (("nzmax", len(rows)), ("n", len(q)), ("m", len(q)), ("nz", -2)):
            w[name] = np.array([number], dtype="i4")
        for name, data in (("p", np.searchsorted(rows, np.arange(len(q) + 1)).astype("i4")), ("i", columns.astype("i4")),
                           ("x", matrix[rows, columns])):
            w.create_dataset(name, data=data, compression="gzip", shuffle=True)
        vectors = problem.create_group("vectors")
        vectors["q"], vectors["mu"] = q, np.full(len(q) // 3, friction)
        info = problem.create_group("info")
        for name, text in (("title", title), ("description", "elastic contact with Coulomb friction on half-spaces"),
                           ("math_info", "W is full, symmetric positive definite; the solution is certified")):
            info[name] = np.array(text.encode() or b" ", dtype=f"S{len(text.encode()) + 1}")
        for name, values in zip(("u", "r"), solution):
            h5.require_group("solution")[name] = values


def main(compact, output):
    with h5py.File(compact) as h5:
        tables = {name: h5["tables"][name][:] for name in h5["tables"]}
        matrix = matrix_of(tables, h5["cells"][:])
        write_fclib(output, matrix, h5["q"][:], h5.attrs["friction"], (h5["u"][:], h5["r"][:]), h5.attrs["title"])


if __name__ == "__main__":
    main(*sys.argv[1:])
