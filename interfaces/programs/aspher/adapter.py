"""ASPHER (Yastrebov): pressure by conjugate gradients with a stencil as preconditioner, free boundary."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from exchange import Exchange  # noqa: E402


def main():
    exchange = Exchange("aspher")
    exchange.require_normal_contact(square=True)
    import numpy as np
    from aspher import ContactSolver

    def solve():
        n, side = exchange.cells[0], exchange.cells[0] * exchange.cell_size[0]
        solver = ContactSolver(n, side, exchange.modulus, backend="fft")
        found = solver.solve(exchange.gap, exchange.load / side**2, tol=1e-10, precond="fourier")
        return np.asarray(found.pressure).reshape(n, n), found.iterations, found.converged

    exchange.answer(solve)


main()
