"""Siconos (Acary and others): pressure by Lemke's pivots, tractions in Coulomb's cones by nonsmooth Gauss-Seidel sweeps, both
from dense matrices of influence."""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from exchange import Exchange  # noqa: E402

MOST_CELLS = 2304  # of the grid; pivots and sweeps on dense matrices take minutes beyond


def influence(exchange, cells):
    """Displacements (m) in the directions 33, 11, 22, 12 by unit tractions (Pa) on the cells with these two indices."""
    x, y = (h * np.arange(1 - n, n) for n, h in zip(exchange.cells, exchange.cell_size))
    g, nu = 2 * np.pi * exchange.shear_modulus, exchange.poisson_ratio
    tables = np.zeros((4, len(x), len(y)))
    for s1, s2 in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        x1, x2 = np.meshgrid(x + s1 * exchange.cell_size[0] / 2, y + s2 * exchange.cell_size[1] / 2, indexing="ij")
        f1, f2 = x2 * np.arcsinh(x1 / abs(x2)), x1 * np.arcsinh(x2 / abs(x1))
        tables += s1 * s2 * np.stack([(f1 + f2) / (np.pi * exchange.modulus), (f1 + (1 - nu) * f2) / g,
                                      ((1 - nu) * f1 + f2) / g, -nu * np.hypot(x1, x2) / g])
    apart = [np.subtract.outer(index, index) + n - 1 for index, n in zip(cells, exchange.cells)]
    return tables[:, apart[0], apart[1]]


def main():
    import siconos
    import siconos.numerics as sn
    exchange = Exchange("siconos", siconos.__version__)
    exchange.require_half_spaces()
    exchange.require(np.prod(exchange.cells) <= MOST_CELLS, f"dense matrices: at most {MOST_CELLS} cells")

    def pressure():
        """A linear complementarity problem: p and the gap on all cells, the approach and the load."""
        n, k33 = exchange.gap.size, influence(exchange, np.indices(exchange.cells).reshape(2, -1))[0]
        depth, stress = k33[0, 0], exchange.load / np.prod(exchange.cell_size)
        matrix = np.block([[k33 / depth, -np.ones((n, 1))], [np.ones((1, n)), np.zeros((1, 1))]])
        found, gap = np.zeros(n + 1), np.zeros(n + 1)
        options = sn.SolverOptions(sn.SICONOS_LCP_LEMKE)
        options.iparam[sn.SICONOS_IPARAM_MAX_ITER] = 10 * n
        problem = sn.LCP(matrix, np.append(exchange.gap.ravel() / (depth * stress), -1.0))
        failed = sn.linearComplementarity_driver(problem, found, gap, options)
        return stress * found[:n].reshape(exchange.cells), failed

    def solve():
        p, failed = pressure() if exchange.pressure is None else (exchange.pressure, 0)
        cells = np.nonzero(p > 0)
        x1, x2 = exchange.x1[cells], exchange.x2[cells]
        k33, k11, k22, k12 = influence(exchange, cells)
        n, depth, stress = len(x1), k33[0, 0], np.max(p)
        matrix = np.zeros((3 * n, 3 * n))
        for row, column, block in ((0, 0, k33), (1, 1, k11), (2, 2, k22), (1, 2, k12), (2, 1, k12)):
            matrix[row::3, column::3] = block / depth
        normal = -matrix[::3, ::3] @ p[cells] / stress
        options = sn.SolverOptions(sn.SICONOS_FRICTION_3D_NSGS)
        options.dparam[sn.SICONOS_DPARAM_TOL] = 1e-10
        options.iparam[sn.SICONOS_IPARAM_MAX_ITER] = 20000
        reaction, velocity, sweeps = np.zeros(3 * n), np.zeros(3 * n), 0
        reaction[::3] = p[cells] / stress

        def tractions(motion):
            nonlocal failed, sweeps
            push = np.column_stack([normal, *([motion[2] * x2 - motion[0], -motion[2] * x1 - motion[1]] / (depth * stress))])
            problem = sn.FrictionContactProblem(3, n, matrix, push.ravel(), np.full(n, exchange.friction))
            failed |= sn.fc3d_driver(problem, reaction, velocity, options)
            sweeps += int(options.iparam[sn.SICONOS_IPARAM_ITER_DONE])
            q = np.zeros((2, *exchange.cells))
            q[:, cells[0], cells[1]] = stress * reaction.reshape(n, 3).T[1:]
            return q

        motion = exchange.motion_under_loads(tractions, p)
        return [p, *tractions(motion)], {"twist_angle": motion[2], "iterations": sweeps, "converged": not failed}

    exchange.answer(solve)


main()
