"""The right answer of a scene at any point of the surface: the exact one, or a solve on a finer grid."""
from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Callable, Optional

import numpy as np

from ..errors import InputError, NotConvergedWarning
from .._scene import assignments
from ..solution import solve_assigned
from .field import Array


@dataclass(frozen=True)
class Right:
    """fields(points (n, 2) m): pressure, q1, q2 (n, 3), Pa, on the lower body. normal_load N, moment N m, force N, twist rad,
    displacement m, contact_radius m: of the circle of equal area. centre m: of the axis. radial: whether a shear along the radius is
    wrong everywhere."""

    source: str
    fields: Callable[[Array], Array]
    normal_load: float
    moment: float
    force: Array
    twist: float
    displacement: Array
    contact_radius: float
    centre: Array
    radial: bool


def exact_answer(numbers: Mapping[str, Any]) -> Right:
    """The exact answer from its fields over the radius."""
    edge = numbers["contact_radius"]
    radii, pressure, shear = (np.array(numbers[name]) for name in ("radii", "pressure", "shear"))
    centre, direction = np.array(numbers["centre"]), np.array(numbers["direction"])
    angles = np.arcsin(radii / edge)  # in which a square root at the edge is linear

    def fields(points: Array) -> Array:
        x = points - centre
        r = np.hypot(x[:, 0], x[:, 1])
        angle = np.arcsin(np.minimum(r / edge, 1))
        p, q = (np.where(r < edge, np.interp(angle, angles, values), 0.0) for values in (pressure, shear))
        with np.errstate(invalid="ignore", divide="ignore"):
            around = np.nan_to_num(np.stack([-x[:, 1], x[:, 0]], axis=1) / r[:, None])
        return np.column_stack([p, q[:, None] * (direction if direction.any() else around)])

    return Right("the exact answer", fields, numbers["normal_load"], numbers["moment"], np.array(numbers["force"]), numbers["twist"],
                 np.array(numbers["displacement"]), edge, centre, not direction.any())


def solved_answer(scene: str, words: Sequence[str], keys: Mapping[str, Any], cells: Optional[int]) -> Right:
    """The answer of a solve on cells x cells; on the scene's own grid where its surface is known on that only. words:
    "key=value"; keys: further ones."""
    grid = {} if cells is None else {"grid.cells": [cells, cells]}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", NotConvergedWarning)
        try:
            solution = solve_assigned(scene, [*words, *assignments({**keys, **grid})])
        except InputError:
            if not grid:
                raise
            return solved_answer(scene, words, keys, None)
    if not solution.converged:
        raise InputError(f"{scene}: the solve that a field on a mesh is compared with did not converge: {solution.message}")
    data = solution.fields
    x1, x2 = data["x1"][:, 0], data["x2"][0]
    values = np.stack([data["pressure"], data["q1"], data["q2"]])

    def fields(points: Array) -> Array:
        return _bilinear(x1, x2, values, points)

    shape = f"{data['x1'].shape[0]} x {data['x1'].shape[1]}"
    return Right(f"a solve on {shape} cells", fields, solution["normal_load"], solution["moment"], np.array(solution["force"]),
                 solution["twist_angle"], np.array(solution["displacement"]), solution["contact_radius"],
                 np.zeros(2), False)


def _bilinear(x1: Array, x2: Array, values: Array, points: Array) -> Array:
    """Interpolates values (k, n1, n2) at the centres of cells; they are zero beyond the grid. Returns (n, k)."""
    padded = np.pad(values, ((0, 0), (1, 1), (1, 1)))
    sizes = padded.shape[1:]
    flat = np.ascontiguousarray(padded.reshape(len(padded), -1).T)
    place = [np.clip((points[:, d] - x[0]) / (x[1] - x[0]) + 1, 0, sizes[d] - 1 - 1e-9) for d, x in enumerate((x1, x2))]
    i, j = (along.astype(np.int64) for along in place)
    s, t = (place[0] - i)[:, None], (place[1] - j)[:, None]
    cell, row = i * sizes[1] + j, sizes[1]
    return np.asarray((1 - s) * ((1 - t) * flat[cell] + t * flat[cell + 1]) + s * ((1 - t) * flat[cell + row] + t * flat[cell + row + 1]))
