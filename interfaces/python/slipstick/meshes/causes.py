"""Likely causes of a bad field on a mesh. Each search undoes or repeats one mistake and names it if that explains the field."""
from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, Callable, Optional

import numpy as np

from ..errors import InputError
from .displacement import KERNELS
from .field import Array
from .measures import Bodies
from .right import Right
from .verdict import Examined, Judged, percent

#: A mistake explains an error that it lowers to this part, or to the mesh's own.
_EXPLAINS = 0.35
#: A mesh of bodies around a fine contact may turn this much further than half-spaces, and have this much shear along the radius.
_OF_BODIES = 0.02
#: Ratios of moments and twists count as equal up to this difference.
_SAME_RATIO = 0.01
#: Compliances of springs that are tried, over the compliance a/G* of the half-spaces.
_SPRINGS = np.logspace(-2.5, 1, 8)

_NORMAL, _TANGENTIAL = "layer.normal_compliance", "layer.tangential_compliance"

Request = Mapping[str, Any]
Solve = Callable[[Mapping[str, Any]], Right]


def causes_of(examined: Examined, request: Mapping[str, Any], solve: Solve) -> list[str]:
    """The causes that explain what is wrong. solve: the right answer with further keys of the scene."""
    wrong = {item.quantity for item in examined.wrong}
    if no_friction := list(_no_friction(examined, request, solve, wrong)):
        return no_friction
    found = [cause for search in (_other_basis, _missing_rows, _other_units, _other_contact) for cause in
             search(examined, request, solve, wrong)]
    kernel = list(_kernels(examined, request, solve, wrong))
    if not kernel:
        found += _pressed_with_friction(examined, request, solve, wrong)
    for search in (_extrapolated, _other_friction, _other_moment, _lost_history):
        found += search(examined, request, solve, wrong)
    twist = list(_other_twist(examined, request, solve, wrong))
    found += kernel + (twist or ([] if kernel or found else list(_soft_penalty(examined, request, solve, wrong))))
    return found + ([] if found else list(_directions(examined, request, solve, wrong)))


def _distance(examined: Examined, fields: Array, shear: Optional[Array] = None) -> float:
    """The distance of the field's tractions (or other ones) from those of an answer on the same mesh, over the right ones."""
    judge = examined.judge
    own = examined.values[:, 1:] if shear is None else shear
    return float(judge.weights @ np.hypot(*(own - fields[:, 1:]).T) / (judge.weights @ judge.size))


def _number(examined: Examined, quantity: str) -> Judged:
    number = examined.number(quantity)
    assert number is not None  # it is measured in every field
    return number


def _explained(examined: Examined, distance: float) -> bool:
    """Whether a mistake explains the tractions: it lowers their distance from the right ones to a part, or to what the mesh allows."""
    own = _number(examined, "tractions")
    return distance < _EXPLAINS * abs(own.value) or (distance <= own.allowed < abs(own.value))


def _no_friction(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    judge = examined.judge
    if judge.weights @ np.hypot(*examined.values[:, 1:].T) < 1e-3 * (judge.weights @ judge.size):
        yield "friction was zero: the field has no shear"


def _other_basis(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    if "tractions" not in wrong:
        return
    signs = {"q1 has the wrong sign": [[-1, 0], [0, 1]], "q2 has the wrong sign": [[1, 0], [0, -1]],
             "q1 and q2 are exchanged": [[0, 1], [1, 0]], "q1 and q2 are exchanged, with the wrong sign": [[0, -1], [-1, 0]],
             "both are turned by 90 degrees": [[0, -1], [1, 0]], "both are turned by -90 degrees": [[0, 1], [-1, 0]]}
    shear = examined.values[:, 1:]
    distances = {name: _distance(examined, examined.judge.reference, shear @ np.array(turn)) for name, turn in signs.items()}
    best = min(distances, key=lambda name: distances[name])
    if _explained(examined, distances[best]):
        yield f"the shear is given in another tangential basis: {best}"


def _pressed_with_friction(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    if "radial_shear" in wrong and _number(examined, "radial_shear").value > _OF_BODIES:
        yield "friction was on while pressing: half-spaces of one material then have no shear along the radius"


def _extrapolated(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    judge = examined.judge
    beyond = (examined.values[:, 0] > 0) & (judge.reference[:, 0] == 0) & (judge.weights > 0)
    too_much = any(item.value > 0 for item in examined.wrong if item.quantity in ("normal_load", "moment", "friction_bound"))
    if examined.field.kind != "faces" and "friction" not in wrong and too_much and beyond.any():
        yield ("the values are extrapolated to nodes, where they do not carry the loads and exceed the friction bound: use values of "
               "faces or of quadrature points")


def _missing_rows(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    load, pressure, judge = _number(examined, "normal_load"), _number(examined, "pressure"), examined.judge
    if "coverage" in wrong:
        yield f"rows are missing: {percent(_number(examined, 'coverage').value)} of the contact has none"
        return
    given = examined.values[:, 0] > 0
    off = judge.weights[given] @ np.abs(examined.values[given, 0] - judge.reference[given, 0])
    if load.value < 0 and not load.holds and off < max(pressure.allowed, _EXPLAINS * abs(load.value)) * examined.right.normal_load:
        yield f"rows are missing: the pressure is right where it is given, but {percent(load.value)} of the load is not"


def _other_units(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    if "normal_load" in wrong and "pressure" not in wrong and "contact_radius" not in wrong:
        load = 1 + _number(examined, "normal_load").value
        if abs(load - 1) < 3 * _OF_BODIES:
            return
        yield f"the pressure has the right shape, but is in another unit or carries another load: {load:.4g} of the scene's"


def _other_contact(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    """Another size of the contact; a soft normal penalty enlarges it, too."""
    radius = _number(examined, "contact_radius")
    if radius.holds or "normal_load" in wrong:
        return
    soft = ""
    if radius.value > 0 and _may_have_springs(request):
        compliances, answers = _with_springs(examined, request, solve, _NORMAL)
        radii = [answer.contact_radius / examined.right.contact_radius - 1 for answer in answers]
        if radii and radius.value < max(radii):
            soft = f", a soft normal penalty (about {1 / np.interp(radius.value, [0, *radii], [1e-99, *compliances]):.1g} Pa/m)"
    yield (f"another modulus or radius of the body{soft}, or a coarse mesh around the contact: its contact is {percent(radius.value)} too "
           f"{'large' if radius.value > 0 else 'small'} under the same load")


def _other_friction(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    ratio = examined.judge.friction_ratio(examined.values)
    friction = examined.number("friction")
    if "friction" not in wrong or friction is None or request["friction"]["kind"] != "coulomb":
        return
    low, high = np.quantile(ratio, [0.25, 0.75])
    if high - low < _EXPLAINS * abs(friction.value) + friction.right and 1 + friction.value > 1e-3:
        coefficient = request["friction"]["coefficient"]
        yield f"the friction coefficient is {coefficient * (1 + friction.value):.4g} in place of {coefficient:g}"


def _other_moment(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    moment = examined.number("moment")
    if moment is None or "moment" not in wrong or not 0 < (ratio := 1 + moment.value) < 2.2 or request["torsion"] is None:
        return
    (key, value), = request["torsion"].items()
    if key == "load.twist":
        return
    if ratio < 1:
        other = solve({key: ratio * value})
        if not _explained(examined, _distance(examined, other.fields(examined.patches.points))):
            return
        steps = 1 / (1 - ratio)
        early = abs(steps - round(steps)) < _SAME_RATIO * steps**2 and 1.5 < steps < 50
        name = "half the moment: that of one body" if abs(ratio - 0.5) < _SAME_RATIO else (
            f"a smaller moment: those of step {round(steps) - 1} of {round(steps)}" if early else "a smaller moment")
        yield f"the tractions are right under {name} ({ratio:.4g} of the scene's)"
    elif abs(ratio - 2) < 2 * _SAME_RATIO:
        yield "the moment is twice the scene's: it was applied to both bodies, or counted twice"


def _lost_history(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    if "tractions" not in wrong:
        return
    if (first := request.get("first_loading")) is not None:
        from .right import exact_answer
        if _explained(examined, _distance(examined, exact_answer(first).fields(examined.patches.points))):
            yield "the history is lost: the tractions are those of a first loading by the last step"
    elif request["steps"] == 1 and not wrong & {"moment", "friction"} and examined.judge.slips.sum() > 8:
        judge = examined.judge
        along = np.sum(examined.values[judge.slips, 1:] * judge.reference[judge.slips, 1:], axis=1)
        if np.mean(along < 0) > 0.2:
            yield "the tractions are those after a reversal: at the contact's edge they oppose this load"


def _other_twist(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    if examined.reported is None or "twist" not in wrong:
        return
    ratio = examined.reported / examined.right_twist
    upper, lower = (request[body]["shear_compliance"] for body in ("upper", "lower"))
    names = {"the twist of the upper body only": upper / (upper + lower), "the twist of the lower body only": lower / (upper + lower),
             "twice the twist of both bodies": 2.0, "a twist in degrees": 180 / np.pi, "a twist in mrad": 1000.0,
             "a twist of the other sign": -1.0}
    twist = examined.number("twist")
    assert twist is not None
    for name, value in names.items():
        if abs(ratio / value - 1) <= twist.allowed:
            yield f"it reports {name}"
            return


def _may_have_springs(request: Request) -> bool:
    return bool(not (request["stick_slope"] or request["normal_stiffness"] or request["layer"]) and request["half_spaces"])


def _with_springs(examined: Examined, request: Request, solve: Solve, key: str) -> tuple[Array, list[Right]]:
    """Compliances, m/Pa, of springs between the bodies, and the right answers with them."""
    unit = examined.right.contact_radius * (request["upper"]["shear_compliance"] + request["lower"]["shear_compliance"])
    answers, other = [], _TANGENTIAL if key == _NORMAL else _NORMAL
    for compliance in _SPRINGS:
        try:
            answers.append(solve({"layer.kind": "winkler", key: compliance * unit, other: 0.0}))
        except InputError:  # the contact is larger than the grid
            break
    return unit * _SPRINGS[:len(answers)], answers


def _soft_penalty(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    """Soft tangential springs turn the bodies further than the tractions do."""
    twist, motion = examined.number("twist"), examined.motion
    if twist is None or motion is None or examined.reported is None or "twist" not in wrong or not _may_have_springs(request):
        return
    further = examined.reported / motion.twist - 1
    if further > max(twist.allowed, _OF_BODIES):
        compliances, answers = _with_springs(examined, request, solve, _TANGENTIAL)
        twists = [answer.twist / examined.right.twist - 1 for answer in answers]
        if twists and further < max(twists):
            slope = 1 / np.interp(further, [0, *twists], [1e-99, *compliances])
            yield (f"the penalty lets the contact slip where it should stick: a stick slope of about {slope:.1g} Pa/m turns the bodies "
                   f"{percent(further)} further than the tractions do")


def _kernels(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    """Tries wrong kernels: the stick area of a solver moves rigidly under the kernel that it has."""
    motion, scatter = examined.motion, examined.number("stick_motion")
    if motion is None or scatter is None or "stick_motion" not in wrong:
        return
    judge = examined.judge
    kernels = judge.kernels([examined.values], KERNELS)[0]
    assert judge.bodies is not None

    def scatter_with(bodies: Bodies, **mistake: Any) -> float:
        u = kernels.displacement(bodies, **mistake)
        return judge.rigid(kernels, u).scatter

    def with_poisson(ratio: float) -> Bodies:
        return Bodies.of(*({**request[name], "poisson_ratio": ratio} for name in ("upper", "lower")), bodies.spring)

    bodies = judge.bodies
    tried = {"the cross kernel K12, odd in x1 and in x2, is mirrored as an even function": (bodies, {"even": True}),
             "the cross kernel K12 is missing": (bodies, {"cross": 0.0}),
             "the cross kernel K12 has the wrong sign": (bodies, {"cross": -1.0}),
             "K11 and K22 are exchanged": (bodies, {"swapped": True}),
             **{f"Poisson's ratio is {ratio:g}": (with_poisson(ratio), {}) for ratio in (0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.5)}}
    if abs(bodies.coupled) > 1e-3 * bodies.normal:
        tried["the coupling K13 and K23 of normal and tangential tractions is missing"] = replace(bodies, coupled=0.0), {}
        tried["the coupling K13 and K23 of normal and tangential tractions has the wrong sign"] = (
            replace(bodies, coupled=-bodies.coupled), {})
    scatters = {name: scatter_with(kind, **mistake) for name, (kind, mistake) in tried.items()}
    best = min(scatters, key=lambda name: scatters[name])
    if scatters[best] < _EXPLAINS * scatter.value:
        yield best


def _directions(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    if "slip_direction" in wrong and "friction" not in wrong:
        yield "slipping points keep a direction that does not oppose their slip"
