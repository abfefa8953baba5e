"""Judges stresses below the surface that any program computed: `slipstick check SCENE STRESSES.csv` reads scene and points, computes
the right stresses there, and hands them to answer(). Tensors are arrays of six components by points, in the order of COMPONENTS."""
from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import permutations
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._columns import STRESSES as COMPONENTS
from .errors import InputError

_NORMAL, _SHEAR = (0, 1, 2), (3, 4, 5)
_PLACE = {(0, 0): 0, (1, 1): 1, (2, 2): 2, (0, 1): 3, (0, 2): 4, (1, 2): 5}  # of the tensor's element
_UNITS = {"Pa": 1.0, "kPa": 1e-3, "MPa": 1e-6, "GPa": 1e-9}  # of one Pa
_ALIKE = 0.3  # cosine between given and right stresses, from which on their sizes show a unit
_EXPLAINED = 0.2  # part of an error that may remain where a mistake explains it
_AS_GOOD = 2.0  # errors of mistakes that explain the stresses equally well
_ROUNDING = 1e-9  # relative
_LARGEST = 1e100  # stress in any unit; errors are squared

Array = npt.NDArray[np.float64]


@dataclass
class Mistake:
    """A mistake, and the stresses of a program that makes it."""
    sentence: str
    stresses: Array


class Right:
    """The right stresses, in their parts by the pressure and by the shear tractions, for any Poisson's ratio."""

    def __init__(self, request: dict[str, Any], key: str) -> None:
        none, half = ({part: np.array(each[part], float).T for part in ("pressure", "shear")} for each in request[key])
        self._none, self._half, self._poisson = none, half, float(request["poisson"])
        self.pressure, self.shear = self.parts(self._poisson)
        self.all = self.pressure + self.shear

    def parts(self, poisson: float) -> tuple[Array, Array]:
        pressure, shear = ((1 - 2 * poisson) * self._none[part] + 2 * poisson * self._half[part] for part in ("pressure", "shear"))
        return pressure, shear

    def per_poisson(self) -> Array:
        """Change of the stresses with Poisson's ratio."""
        return sum(2 * (self._half[part] - self._none[part]) for part in ("pressure", "shear"))  # type: ignore[return-value]


def von_mises(stress: Array) -> Array:
    s11, s22, s33, s12, s13, s23 = stress
    return np.sqrt(0.5 * ((s11 - s22)**2 + (s22 - s33)**2 + (s33 - s11)**2) + 3 * (s12**2 + s13**2 + s23**2))


# ---------------------------------------------------------------- mistakes


def _shear_name(request: dict[str, Any]) -> str:
    return "shear tractions" if request["reason"] else "torsion"


def _times(stress: Array, factor: float, components: tuple[int, ...]) -> Array:
    changed = stress.copy()
    changed[list(components)] *= factor
    return changed


def _rearranged(stress: Array, components: tuple[int, ...]) -> Iterator[Mistake]:
    """Three components in other columns."""
    for order in list(permutations(components))[1:]:
        moved = stress.copy()
        moved[list(components)] = stress[list(order)]
        wrong = [(COMPONENTS[to], COMPONENTS[at]) for to, at in zip(components, order) if to != at]
        text = (f"{wrong[0][0]} and {wrong[0][1]} are exchanged" if len(wrong) == 2 else
                f"{', '.join(to for to, _ in wrong)} are {', '.join(at for _, at in wrong)}")
        yield Mistake(text, moved)


def _along_other_axes(stress: Array) -> Iterator[Mistake]:
    """The tensor in exchanged axes."""
    for order in list(permutations(range(3)))[1:]:
        moved = np.array([stress[_PLACE[min(order[i], order[j]), max(order[i], order[j])]] for i, j in _PLACE])
        yield Mistake(f"the components' axes are {', '.join(f'x{axis + 1}' for axis in order)} in place of x1, x2, x3", moved)


def _polar(stress: Array, points: Array) -> Array:
    """The tensor along the radius from the origin, around it, and along x3."""
    radius = np.hypot(points[:, 0], points[:, 1])
    cosine = np.divide(points[:, 0], radius, out=np.ones_like(radius), where=radius > 0)
    sine = np.divide(points[:, 1], radius, out=np.zeros_like(radius), where=radius > 0)
    s11, s22, s33, s12, s13, s23 = stress
    turn = 2 * s12 * cosine * sine
    return np.array([s11 * cosine**2 + s22 * sine**2 + turn, s11 * sine**2 + s22 * cosine**2 - turn, s33,
                     (s22 - s11) * cosine * sine + s12 * (cosine**2 - sine**2), s13 * cosine + s23 * sine, s23 * cosine - s13 * sine])


def mistakes(right: Right, request: dict[str, Any], points: Array) -> Iterator[Mistake]:
    """The stresses of programs that make one mistake without a size."""
    stress, shear = right.all, _shear_name(request)
    for place, name in enumerate(COMPONENTS):
        yield Mistake(f"{name} has the wrong sign", _times(stress, -1, (place,)))
    yield Mistake("s13 and s23 have the wrong sign: x3 points out of the body", _times(stress, -1, (4, 5)))
    yield Mistake("all signs are reversed: compression is positive", -stress)
    for factor, text in ((2.0, "doubled, as engineering shear strains are"), (0.5, "halved")):
        yield Mistake(f"the shear components are {text}", _times(stress, factor, _SHEAR))
    yield Mistake("the part by the pressure is missing", right.shear)
    yield Mistake(f"the part by the {shear} is missing", right.pressure)
    text = f"the part by the {shear} has the wrong sign"
    if request["poisson"] == request["other_poisson"]:
        text += ", as in the other body"
    else:
        pressure, other = right.parts(float(request["other_poisson"]))
        yield Mistake("the stresses are those of the other body", pressure - other)
    yield Mistake(text, right.pressure - right.shear)
    yield from _rearranged(stress, _SHEAR)
    yield from _rearranged(stress, _NORMAL)
    yield from _along_other_axes(stress)
    yield Mistake("the components are polar: along the radius, around it, and along x3", _polar(stress, points))


def _fitted(given: Array, rows: list[int], constant: Array, *parts: Array) -> tuple[list[float], Array]:
    """Factors of parts by least squares, and their sum with a constant part."""
    matrix = np.array([part[rows].ravel() for part in parts]).T
    factors = np.linalg.lstsq(matrix, (given - constant[rows]).ravel(), rcond=None)[0]
    return factors.tolist(), constant + sum(factor * part for factor, part in zip(factors, parts))


def sized_mistakes(right: Right, given: Array, rows: list[int], request: dict[str, Any]) -> Iterator[Mistake]:
    """Mistakes with one size, which fits the given stresses best."""
    stress = right.all
    (factor,), scaled = _fitted(given, rows, np.zeros_like(stress), stress)
    yield Mistake(f"all stresses are {factor:.4g} times the right ones", scaled)
    change = right.per_poisson()
    if np.any(change[rows]):
        (more,), other = _fitted(given, rows, stress, change)
        yield Mistake(f"Poisson's ratio is {request['poisson'] + more:.3g} in place of {request['poisson']:.3g}", other)
    for place in rows:
        only = _times(stress, 0, tuple(each for each in range(6) if each != place))
        (more,), other = _fitted(given, rows, stress, only)
        yield Mistake(f"{COMPONENTS[place]} is {1 + more:.4g} times the right one", other)
    for name, part in (("pressure", right.pressure), (_shear_name(request), right.shear)):
        (more,), other = _fitted(given, rows, stress, part)
        yield Mistake(f"the part by the {name} is {1 + more:.4g} times the right one", other)


def two_sizes(right: Right, given: Array, rows: list[int], request: dict[str, Any]) -> Iterator[Mistake]:
    """Other sizes of both parts."""
    (pressure, shear), both = _fitted(given, rows, np.zeros_like(right.all), right.pressure, right.shear)
    yield Mistake(f"the parts by the pressure and by the {_shear_name(request)} are {pressure:.4g} and {shear:.4g} times the right ones",
                  both)


# ---------------------------------------------------------------- the verdict


def _off(given: Array, stress: Array, rows: list[int], scale: float) -> float:
    """The largest error of the given components."""
    return float(np.abs(given - stress[rows]).max() / scale)


def explain(right: Right, given: Array, rows: list[int], points: Array, request: dict[str, Any], scale: float,
            allowed: float) -> list[str]:
    """The mistakes that explain the stresses, all equally well: within the allowed error, or else but for a fifth of the error."""
    error = _off(given, right.all, rows, scale)
    for bound in (allowed, _EXPLAINED * error):
        for tried in (mistakes(right, request, points), sized_mistakes(right, given, rows, request),
                      two_sizes(right, given, rows, request)):
            off = [(_off(given, each.stresses, rows, scale), each.sentence) for each in tried]
            least = min(off)[0]
            if least <= min(bound, error):
                left = f" (then {_percent(least)} off)" if least > allowed else ""
                return [sentence + left for each, sentence in off if each <= _AS_GOOD * least + _ROUNDING]
    return []


def _find_unit(right: Array, given: Array) -> Optional[str]:
    """The unit in which stresses are given, where that is not Pa."""
    size, own = np.linalg.norm(right), np.linalg.norm(given)
    if not abs(np.vdot(right, given)) > _ALIKE * size * own:
        return None
    unit = min(_UNITS, key=lambda unit: abs(math.log(own / (_UNITS[unit] * size))))
    return unit if unit != "Pa" else None


def _percent(part: float) -> str:
    return "less than 0.001 %" if part < 1e-5 else f"{100.0 * part:.2g} %"


def _place_text(at: list[float]) -> str:
    return ", ".join(f"x{axis + 1} = {x:.3g}" for axis, x in enumerate(at)) + " m"


def _judged(name: str, given: Array, right: Array, points: Array, scale: float, allowed: float) -> dict[str, Any]:
    error = np.abs(given - right) / scale
    worst = int(error.argmax())
    value = float(error[worst])
    return {"quantity": name, "value": value, "allowed": allowed, "holds": value <= allowed, "at": points[worst].tolist(),
            "given": float(given[worst]), "right": float(right[worst])}


def answer(request: dict[str, Any]) -> dict[str, Any]:
    """The verdict on stresses, as JSON and as text.

    request: name (of the scene), field (the file), tolerance, strict, body, poisson and other_poisson, conventions, points (x1, x2,
    depth), given (components by name), right: the parts pressure and shear of all components for Poisson's ratios 0 and 1/2; and where
    they are not exact the reason, cells, and coarse: the same on cells twice as large, and in half the parts of the steps.
    """
    points = np.array(request["points"], float)
    rows = [COMPONENTS.index(name) for name in request["given"]]
    given = np.array(list(request["given"].values()), float)
    right, conventions = Right(request, "right"), list(request["conventions"])
    scale = float(von_mises(right.all).max())
    if not scale > 0.0:  # NaN too
        raise InputError(f"{request['field']}: points are too far away to have stresses; allowed: at most 1e6 contact radii")
    if not np.abs(given).max() < _LARGEST:
        raise InputError(f"{request['field']}: a stress of {np.abs(given).max():g}; allowed: sizes below {_LARGEST:g}")
    own_error = _off(Right(request, "coarse").all, right.all, list(range(6)), scale) if "coarse" in request else 0.0
    if (unit := _find_unit(right.all[rows], given)) is not None:
        given = given / _UNITS[unit]
        conventions.append(f"stresses in {unit}")
    allowed = request["tolerance"] + own_error
    judged = [_judged(COMPONENTS[row], each, right.all[row], points, scale, allowed) for row, each in zip(rows, given)]
    worst = max(judged, key=lambda each: each["value"])
    good = all(each["holds"] for each in judged)
    if good and own_error > request["tolerance"]:
        raise InputError(f"{request['field']}: nothing is wrong, but the right stresses, of the scene's own solve, change by "
                         f"{_percent(own_error)} of the largest von Mises stress from a coarser one; allowed: at most the tolerance, "
                         f"{_percent(request['tolerance'])}, by more grid.cells, solver.substeps, deeper points or another --tolerance")
    causes = [] if good else explain(right, given, rows, points, request, scale, allowed)
    why = "the largest error of a stress" if good else f"{worst['quantity']}, at {_place_text(worst['at'])}, has an error that"
    why += f" is {_percent(worst['value'])} of the largest von Mises stress (allowed: {_percent(allowed)})"
    if causes:
        why += f"; likely cause: {', or '.join(causes)}"
    if good and request["strict"] and conventions:
        good, why = False, f"{', and '.join(conventions)}; otherwise {why}"
    result = {key: request[key] for key in ("name", "field")}
    result.update(verdict="good" if good else "bad", why=why, causes=causes, conventions=conventions, body=request["body"],
                  rows=len(points), tolerance=request["tolerance"], right_answer="exact" if request["reason"] == "" else "solve",
                  right_answer_error=own_error, **_von_mises(given, right.all, points, rows), judged=judged)
    if request["reason"]:
        result.update(why_not_exact=request["reason"], cells=request["cells"])
    return {"exit_code": 0 if good else 1, "text": _text(result), "result": result}


def _von_mises(given: Array, right: Array, points: Array, rows: list[int]) -> dict[str, Any]:
    """The largest right von Mises stress at the points, and the largest of the given ones with the right one there."""
    exact = von_mises(right)
    most = int(exact.argmax())
    found: dict[str, Any] = {"right_von_mises": {"value": float(exact[most]), "at": points[most].tolist()}}
    if len(rows) < len(COMPONENTS):
        return {**found, "von_mises": None, "von_mises_reason": "needs all six components"}
    own = von_mises(given[np.argsort(rows)])
    most = int(own.argmax())
    return {**found, "von_mises": {"value": float(own[most]), "at": points[most].tolist(), "right": float(exact[most])}}


def _text(result: dict[str, Any]) -> str:
    """The result in a few lines."""
    right, own = result["right_von_mises"], result["von_mises"]
    answer = "exact" if result["right_answer"] == "exact" else (
        f"a solve on {result['cells'][0]} x {result['cells'][1]} cells, whose stresses change by {_percent(result['right_answer_error'])} "
        f"from a coarser one ({result['why_not_exact']})")
    lines = [("stresses", result["field"]), ("points", f"{result['rows']} in the {result['body']} body")]
    lines += [("note", note) for note in result["conventions"]] + [("right answer", answer)]
    if own is not None:
        lines.append(("von Mises", f"{own['value']:.6g} Pa at most, at {_place_text(own['at'])}; right there: {own['right']:.6g} Pa"))
    lines.append(("", f"right ones: {right['value']:.6g} Pa at most, at {_place_text(right['at'])}"))
    lines += [("holds" if each["holds"] else "FAILS",
               f"{each['quantity']:<20} {each['value']:>8.1e}   allowed {each['allowed']:.1e}   most at {_place_text(each['at'])}")
              for each in result["judged"]]
    return f"{result['verdict']}: {result['why']}\n" + "".join(f"  {label:<16} {value}\n" for label, value in lines)
