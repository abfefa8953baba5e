"""Tamaas (Frerot, Anciaux, Molinari): pressure by Polonsky and Keer's conjugate gradients, free boundary."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from exchange import Exchange  # noqa: E402


def main():
    exchange = Exchange("tamaas")
    exchange.require_normal_contact()
    import numpy as np
    import tamaas
    tamaas.set_log_level(tamaas.LogLevel.error)

    def solve():
        sides = [n * h for n, h in zip(exchange.cells, exchange.cell_size)]
        model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, sides, list(exchange.cells))
        model.E, model.nu = exchange.modulus, 0.0
        tamaas.ModelFactory.registerNonPeriodic(model, "free")
        tolerance = 1e-10
        solver = tamaas.PolonskyKeerRey(model, -exchange.gap, tolerance)
        solver.setIntegralOperator("free")
        solver.max_iter = 5000
        error = solver.solve(exchange.load / np.prod(sides))
        return [np.array(model.traction)], {"converged": bool(error <= tolerance)}

    exchange.answer(solve)


main()
