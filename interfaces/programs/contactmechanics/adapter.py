"""ContactMechanics (Pastewka group): pressure by constrained conjugate gradients, free boundary."""

import logging
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from exchange import Exchange  # noqa: E402


def main():
    exchange = Exchange("ContactMechanics")
    exchange.require_normal_contact()
    logging.disable()
    import numpy as np
    from ContactMechanics import FreeFFTElasticHalfSpace, make_system
    from SurfaceTopography import Topography

    def solve():
        sides = tuple(n * h for n, h in zip(exchange.cells, exchange.cell_size))
        substrate = FreeFFTElasticHalfSpace(exchange.cells, exchange.modulus, sides)
        system = make_system(substrate=substrate, surface=Topography(-exchange.gap, sides))
        depth = 1e-9 * (np.max(exchange.gap) - np.min(exchange.gap))
        found = system.minimize_proxy(external_force=exchange.load, pentol=depth, forcetol=1e-9, maxiter=5000)
        n1, n2 = exchange.cells
        pressure = np.maximum(np.asarray(found.jac)[:n1, :n2], 0.0) / np.prod(exchange.cell_size)
        return [pressure], {"iterations": int(found.nit), "converged": bool(found.success)}

    exchange.answer(solve)


main()
