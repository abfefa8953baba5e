"""ASPHER (Yastrebov): pressure by conjugate gradients with a stencil as preconditioner, free boundary; under a force without
rotation the tractions too, of partial slip."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from exchange import Exchange  # noqa: E402


def main():
    exchange = Exchange("aspher")
    exchange.require_normal_contact(square=True)
    import numpy as np
    from aspher import ContactSolver, CoulombFriction, FrictionSolver
    n, side = exchange.cells[0], exchange.cells[0] * exchange.cell_size[0]
    mean, load = exchange.load / side**2, exchange.scene["load"]

    def normal():
        solver = ContactSolver(n, side, exchange.modulus, backend="fft")
        found = solver.solve(exchange.gap, mean, tol=1e-10, precond="fourier")
        return [found.pressure], {"iterations": found.iterations, "converged": found.converged}

    def partial_slip():
        solver = FrictionSolver(n, side, exchange.modulus, exchange.poisson_ratio, CoulombFriction(exchange.friction))
        solver.set_gap(exchange.gap)
        found = solver.step(p_bar=mean, q_bar=np.array(load["force"]) / side**2, tol_normal=1e-10, tol_tangential=1e-8)
        numbers = {"iterations": found.tangential_iters, "converged": found.converged, "message": found.status_reason,
                   "twist_angle": 0.0}
        return [solver.pressure, found.qx, found.qy], numbers

    exchange.answer(partial_slip if any(load.get("force", [0])) and load.get("twist") == 0 else normal)


main()
