"""The paper's sphere on a small grid, for the tests of the package."""
SPHERE = {
    "upper": {"shape": "sphere", "radius": 0.018, "young_modulus": 210e9, "poisson_ratio": 0.3},
    "lower": {"young_modulus": 210e9, "poisson_ratio": 0.3},
    "contact": {"friction": 0.1},
    "load": {"normal": 1000.0, "moment_ratio": 0.9},
    "grid": {"cells": [48, 48]},
}
