"""Likely causes of a bad field on a mesh. Each search undoes or repeats one mistake and names it if that explains the field."""
from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, Callable, Optional

import numpy as np

from ..errors import InputError
from ..exact import traction
from .displacement import KERNELS
from .field import Array
from .measures import Bodies, Kernels, Motion
from .right import Right, exact_answer
from .verdict import Examined, Judged, percent

#: A mistake explains an error that it lowers to this part, or to the mesh's own.
_EXPLAINS = 0.35
#: A mesh of bodies around a fine contact may turn this much further than half-spaces, and have this much shear along the radius.
_OF_BODIES = 0.02
#: The fewest rings of the contact over which values are averaged; and the part of a shear that friction while pressing has all around the axis:
#: other mistakes leave cosines of the angle.
_RINGS, _ALL_ROUND, _NO_SYMMETRY = 8, 0.7, 0.5
#: Ratios of moments and twists count as equal up to this difference.
_SAME_RATIO = 0.01
#: Rows with less than this part of the largest pressure show no law of friction; and the fewest rows that show one.
_AT_RIM, _FEWEST = 0.1, 8
#: Powers of the pressure count as 0 up to this, and as 1 up to half of it.
_SAME_POWER = 0.2
#: Parts of the way from this moment to the limit, from which a history may have returned.
_TOPS = np.array([0.1, 0.3, 0.5, 0.7, 0.9, 0.98])
#: Compliances of springs that are tried, over the compliance a/G* of the half-spaces.
_SPRINGS = np.logspace(-2.5, 1, 8)

_COUPLING = "the coupling K13 and K23 of normal and tangential tractions"
_SOFT = "the penalty lets the contact slip where it should stick"

Request = Mapping[str, Any]
Solve = Callable[[Mapping[str, Any]], Right]


def causes_of(examined: Examined, request: Request, solve: Solve) -> list[str]:
    """The causes that explain what is wrong. solve: the right answer with further keys of the scene."""
    wrong = {item.quantity for item in examined.wrong}

    def search(*searches: Callable[[Examined, Request, Solve, set[str]], Iterator[str]]) -> list[str]:
        return [cause for one in searches for cause in one(examined, request, solve, wrong)]

    if no_friction := search(_no_friction):
        return no_friction
    if given := search(_other_basis, _other_component, _shifted):  # each makes all other numbers wrong, too
        return given
    kernel = search(_other_twist) or search(_other_kernel)
    pressed = [] if kernel else search(_pressed_with_friction)  # a kernel makes a shear along the radius, too
    found = pressed + search(_missing_rows, _other_units, _other_contact, _extrapolated, _other_friction, _other_moment,
                             _lost_history) + kernel
    return found or search(_unfinished) or search(_directions)


def _distance(examined: Examined, fields: Array, shear: Optional[Array] = None) -> float:
    """The relative distance of the field's tractions, or of other ones (n, 2), from an answer (n, 3) on the same mesh."""
    judge = examined.judge
    own = examined.values[:, 1:] if shear is None else shear
    return float(judge.weights @ np.hypot(*(own - fields[:, 1:]).T) / (judge.weights @ judge.size))


def _number(examined: Examined, quantity: str) -> Judged:
    number = examined.number(quantity)
    assert number is not None  # it is measured in every field
    return number


def _explained(examined: Examined, distance: float) -> bool:
    """Whether a mistake explains the tractions: with it, they are much closer to the right ones, or as close as the mesh allows."""
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


def _other_component(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    """One component of the shear that is missing or in another unit."""
    if "tractions" not in wrong:
        return
    shear, wanted = examined.values[:, 1:], examined.judge.reference[:, 1:]
    for k in range(2):
        weights = examined.judge.weights * np.abs(wanted[:, k])
        if not weights.any() or not np.abs(wanted[:, 1 - k]).any():
            return
        if not shear[:, k].any():
            yield f"q{k + 1} is missing"
            continue
        ratio = (weights @ (shear[:, k] * np.sign(wanted[:, k]))) / (weights @ np.abs(wanted[:, k]))
        unit = round(np.log10(max(abs(ratio), 1e-30)) / 3)
        in_one_unit = shear * np.where(np.arange(2) == k, 10.0**(-3 * unit), 1)
        if unit and _explained(examined, _distance(examined, examined.judge.reference, in_one_unit)):
            yield f"q{k + 1} is in another unit than q{2 - k}: it is {10.0**(3 * unit):g} times as large"


def _shifted(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    """A field whose origin is not the body's axis."""
    judge = examined.judge
    load = judge.weights * examined.values[:, 0]
    shift = load @ judge.x / load.sum() - (judge.weights * judge.reference[:, 0]) @ judge.x / (judge.weights @ judge.reference[:, 0])
    pressure = _number(examined, "pressure")
    if pressure.holds or "normal_load" in wrong:
        return
    moved = examined.right.fields(examined.patches.points - shift)
    off = judge.weights @ np.abs(examined.values[:, 0] - moved[:, 0]) / (judge.weights @ judge.reference[:, 0])
    if off < _EXPLAINS * pressure.value:
        yield (f"the field's contact is centred at x1 = {examined.right.centre[0] + shift[0]:.3g}, x2 = "
               f"{examined.right.centre[1] + shift[1]:.3g} m: name the body's axis, as --read-as centre=X1,X2")


def _pressed_with_friction(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    radial = examined.number("radial_shear")
    if radial is None or radial.holds or radial.value < _OF_BODIES:
        return
    radius = np.hypot(*examined.judge.x.T)
    outward = examined.judge.x / np.maximum(radius, 1e-300)[:, None]
    shear = examined.values[:, 1:]
    rings = max(_RINGS, int(2 * examined.across))  # friction may change its sign from ring to ring of the mesh
    if _part_all_round(examined, radius, np.sum(shear * outward, axis=1), rings) < _ALL_ROUND:
        return
    without = shear - np.sum(shear * outward, axis=1)[:, None] * outward
    tractions = _number(examined, "tractions")
    left = _distance(examined, examined.judge.reference, without)
    if radial.value > 2 * radial.allowed or left < max(2 * _EXPLAINS * tractions.value, tractions.allowed):
        yield "friction was on while pressing: half-spaces of one material then have no shear along the radius"


def _part_all_round(examined: Examined, radius: Array, values: Array, rings: int = _RINGS) -> float:
    """The part of values (n) that is the same all around the axis: the sum of the means of rings over the sum of all sizes."""
    weights, edge = examined.judge.weights, examined.right.contact_radius
    ring = np.minimum((rings * radius / edge).astype(int), rings)
    means = np.bincount(ring, weights * values, minlength=rings + 1)
    total = weights @ np.abs(values)
    return float(np.abs(means).sum() / total) if total > 0 else 0.0


def _extrapolated(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    judge = examined.judge
    beyond = (examined.values[:, 0] > 0) & (judge.reference[:, 0] == 0) & (judge.weights > 0)
    too_much = any(item.value > 0 for item in examined.wrong if item.quantity in ("normal_load", "moment", "friction_bound"))
    pressure, load = _number(examined, "pressure"), _number(examined, "normal_load")
    same_shape = pressure.value < _EXPLAINS * abs(load.value)
    if examined.field.kind != "faces" and "friction" not in wrong and too_much and beyond.any() and not same_shape:
        yield ("the values are extrapolated to nodes, where they do not carry the loads and exceed the friction bound: use values of "
               "faces or of quadrature points")


def _missing_rows(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    load, pressure, judge = _number(examined, "normal_load"), _number(examined, "pressure"), examined.judge
    if "coverage" in wrong:
        yield f"rows are missing: {percent(_number(examined, 'coverage').value)} of the contact has none"
        return
    given = (examined.values[:, 0] > 0) & (judge.reference[:, 0] > 0)
    usual = np.median(examined.values[given, 0] / judge.reference[given, 0]) - 1
    if load.value < 0 and not load.holds and abs(usual) < _EXPLAINS**2 * abs(load.value) and "coverage" not in wrong:
        yield f"rows are missing: most rows have the right pressure, but {percent(load.value)} of the load is not given"
        return
    given = examined.values[:, 0] > 0
    off = judge.weights[given] @ np.abs(examined.values[given, 0] - judge.reference[given, 0])
    if load.value < 0 and not load.holds and off < max(pressure.allowed, _EXPLAINS * abs(load.value)) * examined.right.normal_load:
        yield f"rows are missing: the pressure is right where it is given, but {percent(load.value)} of the load is not"


def _other_units(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    load, pressure = _number(examined, "normal_load"), _number(examined, "pressure")
    if not load.holds and not wrong & {"pressure", "contact_radius"} and pressure.value < _EXPLAINS * abs(load.value):
        yield f"the pressure has the right shape, but is in another unit or carries another load: {1 + load.value:.4g} of the scene's"


def _other_contact(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    """Another size of the contact; a soft normal penalty enlarges it, too."""
    radius = _number(examined, "contact_radius")
    if radius.holds or "normal_load" in wrong:
        return
    soft = ""
    if radius.value > 0 and _may_have_springs(request):
        compliances, answers = _with_soft_penalty(examined, request, solve)
        radii = [answer.contact_radius / examined.right.contact_radius - 1 for answer in answers]
        if radii and radius.value < max(radii):
            soft = f", a soft normal penalty (about {1 / np.interp(radius.value, [0, *radii], [1e-99, *compliances]):.1g} Pa/m)"
    yield (f"another modulus or radius of the body{soft}, or a coarse mesh around the contact: its contact is {percent(radius.value)} too "
           f"{'large' if radius.value > 0 else 'small'} under the same load")


def _other_friction(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    friction, judge = examined.number("friction"), examined.judge
    if "friction" not in wrong or friction is None or request["friction"]["kind"] != "coulomb":
        return
    ratio = judge.friction_ratio(examined.values)
    low, high = np.quantile(ratio, [0.25, 0.75])
    coefficient = request["friction"]["coefficient"]
    if "normal_load" in wrong:  # the pressure is wrong
        return
    unit = np.log10(max(1 + friction.value, 1e-30)) / 3
    if abs(unit - round(unit)) < 1e-2 and round(unit):
        yield f"pressure and shear are in different units: |q|/(mu p) is {1 + friction.value:.4g}"
    elif high - low < _EXPLAINS * abs(friction.value) + friction.right:
        yield f"the friction coefficient is {coefficient * (1 + friction.value):.4g} in place of {coefficient:g}"
    else:
        rows = np.flatnonzero(judge.slips & (examined.values[:, 0] > _AT_RIM * examined.values[:, 0].max()))
        rows = rows[np.argsort(examined.values[rows, 0])[:max(_FEWEST, len(rows) // 2)]]  # near the rim, where any law slips
        pressure, shear = np.log(examined.values[rows, 0]), np.log(np.maximum(np.hypot(*examined.values[rows, 1:].T), 1e-300))
        power, at_one = np.polyfit(pressure, shear, 1)
        if abs(power - 1) < _SAME_POWER / 2 or np.std(shear - power * pressure - at_one) > _EXPLAINS * np.std(shear - pressure):
            return
        if abs(power) < _SAME_POWER:
            yield f"friction is the same everywhere, |q| = {np.exp(np.mean(shear)):.3g} Pa: that of a mean pressure, or Tresca's law"
        else:
            yield f"the shear follows the pressure to the power {power:.2g}: another friction law"


def _other_moment(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    if "moment" not in wrong or request["torsion"] is None:
        return
    ratio = examined.judge.loads(examined.values)[1] / examined.judge.loads(examined.judge.reference)[1]  # both on this mesh
    if not 0.01 < ratio < 2.2:
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
        if _explained(examined, _distance(examined, exact_answer(first).fields(examined.patches.points))):
            yield "the history is lost: the tractions are those of a first loading by the last step"
    elif request["steps"] == 1 and examined.right.radial and request["exact"]["profile"]:
        numbers, judge = request["exact"], examined.judge
        now, radius = numbers["moment_ratio"], np.hypot(*judge.x.T)
        around = np.column_stack([-judge.x[:, 1], judge.x[:, 0]]) / np.maximum(radius, 1e-300)[:, None]
        inside = np.minimum(radius / numbers["contact_radius"], 1 - 1e-9)
        for top in [*(now + (1 - now) * _TOPS), *(-_TOPS), *(now - (1 + now) * _TOPS)]:
            shear = numbers["shear_unit"] * traction(inside, history=[top, now], profile=numbers["profile"])
            shear[radius >= numbers["contact_radius"]] = 0
            off = _distance(examined, np.column_stack([radius, shear[:, None] * around]))
            if off < _EXPLAINS * _number(examined, "tractions").value:
                yield f"another history: the tractions are those after a moment of {top:.2g} of the limit, unloaded to this one"
                return


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


def _with_soft_penalty(examined: Examined, request: Request, solve: Solve) -> tuple[Array, list[Right]]:
    """Compliances, m/Pa, of normal springs between the bodies, and the right answers with them."""
    unit = examined.right.contact_radius * (request["upper"]["shear_compliance"] + request["lower"]["shear_compliance"])
    answers = []
    for compliance in _SPRINGS:
        try:
            answers.append(solve({"layer.kind": "winkler", "layer.normal_compliance": compliance * unit,
                                  "layer.tangential_compliance": 0.0}))
        except InputError:  # the contact is larger than the grid
            break
    return unit * _SPRINGS[:len(answers)], answers


def _other_kernel(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    """Tries wrong kernels, and springs: with the kernel that a solver has its stick area moves rigidly, by the twist that it reports."""
    motion, scatter, twist = examined.motion, examined.number("stick_motion"), examined.number("twist")
    if motion is None or scatter is None or not wrong & {"stick_motion", "twist", "slip_direction"}:
        return
    judge = examined.judge
    kernels = judge.kernels([examined.values], KERNELS)[0]
    displacements = {name: kernels.displacement(other, **mistake)
                     for name, (other, mistake) in _hypotheses(examined, request, kernels).items()}
    motions = {name: judge.rigid(kernels, displacement) for name, displacement in displacements.items()}
    angle = examined.number("slip_direction")
    reported = None if twist is None else examined.reported_of_half_spaces

    def off(other: Motion) -> float:
        return 0.0 if reported is None else abs(reported / other.twist - 1)

    def turned(name: str) -> float:
        found = judge.slip_angle(kernels, motions[name], displacements[name])
        return 0.0 if found is None else found[0]

    allowed = 0.0 if twist is None else twist.allowed
    limit = _EXPLAINS * abs(scatter.value) if reported is None else max(_EXPLAINS * abs(scatter.value), scatter.allowed)
    if angle is not None and not angle.holds and scatter.holds:  # the stick area hardly shows the kernel, but slip does
        limit = scatter.allowed
        motions = {name: other for name, other in motions.items() if turned(name) < _EXPLAINS * angle.value}
    fitting = {name: other for name, other in motions.items() if other.scatter <= limit and off(other) <= allowed}
    if not fitting or (scatter.holds and off(motion) <= allowed and not (angle and not angle.holds)):
        return
    if reported is None:
        measure = {name: turned(name) if scatter.holds else other.scatter for name, other in fitting.items()}
        yield " or ".join(name for name in fitting if measure[name] <= 1.5 * min(measure.values()))
    else:  # several kernels may leave the stick area rigid, at different twists; springs are fitted to the reported one
        yield min(fitting, key=lambda name: (name.startswith(_SOFT), not name.startswith(_COUPLING), off(fitting[name])))


def _hypotheses(examined: Examined, request: Request, kernels: Kernels) -> dict[str, tuple[Bodies, dict[str, Any]]]:
    """Bodies and mistakes of kernels, by name."""
    bodies = examined.judge.bodies
    assert bodies is not None

    def with_poisson(ratio: float) -> Bodies:
        return Bodies.of(*({**request[name], "poisson_ratio": ratio} for name in ("upper", "lower")), bodies.spring)

    tried: dict[str, tuple[Bodies, dict[str, Any]]] = {}
    if abs(bodies.coupled) > 1e-3 * bodies.normal:
        for name, factor in (("is missing", 0.0), ("has the wrong sign", -1.0)):
            tried[f"{_COUPLING} {name}"] = replace(bodies, coupled=factor * bodies.coupled), {}
    tried["the cross kernel K12, odd in x1 and in x2, is mirrored as an even function"] = bodies, {"even": True}
    tried["the cross kernel K12 is missing"] = bodies, {"cross": 0.0}
    tried["the cross kernel K12 has the wrong sign"] = bodies, {"cross": -1.0}
    tried["K11 and K22 are exchanged"] = bodies, {"swapped": True}
    tried.update((f"Poisson's ratio is {ratio:g}", (with_poisson(ratio), {})) for ratio in (0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.5))
    if _may_have_springs(request) and (spring := _fitted_spring(examined, kernels)) > 0:
        tried[f"{_SOFT}: its stick slope is about {1 / spring:.1g} Pa/m"] = replace(bodies, spring=spring), {}
    return tried


def _fitted_spring(examined: Examined, kernels: Kernels) -> float:
    """The compliance of tangential springs, m/Pa, with which the stick area moves rigidly, by the reported twist if there is one; zero
    if they hardly turn the bodies."""
    judge = examined.judge
    assert judge.bodies is not None and examined.motion is not None
    at = kernels.sticks
    x, own, u = kernels.places[at], kernels.own[at], kernels.displacement(judge.bodies)[at]
    zero, one = np.zeros(len(x)), np.ones(len(x))
    turn = np.concatenate([-x[:, 1], x[:, 0]])
    columns = [np.concatenate([one, zero]), np.concatenate([zero, one]), -own.T.ravel()]
    wanted = u.T.ravel()
    twist = examined.reported_of_half_spaces
    if twist is None:
        columns.append(turn)
    else:
        if twist / examined.motion.twist - 1 < _OF_BODIES:
            return 0.0
        wanted = wanted - twist * turn
    scale = [np.abs(column).max() for column in columns]
    solution = np.linalg.lstsq(np.column_stack([column / size for column, size in zip(columns, scale)]), wanted, rcond=None)[0]
    return float(solution[2] / scale[2])


def _unfinished(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    """Errors that carry no load and have no symmetry."""
    loads = {"normal_load", "pressure", "contact_radius", "moment", "force"}
    if not examined.right.radial or not wrong & {"tractions", "stick_motion"} or wrong & loads:
        return
    radius = np.hypot(*examined.judge.x.T)
    outward = examined.judge.x / np.maximum(radius, 1e-300)[:, None]
    error = examined.values[:, 1:] - examined.judge.reference[:, 1:]
    around = error[:, 1] * outward[:, 0] - error[:, 0] * outward[:, 1]
    if max(_part_all_round(examined, radius, each) for each in (around, np.sum(error * outward, axis=1))) < _NO_SYMMETRY:
        yield "an iteration that ended early: the loads hold, and the errors of the tractions have no symmetry about the axis"


def _directions(examined: Examined, request: Request, solve: Solve, wrong: set[str]) -> Iterator[str]:
    if "slip_direction" in wrong and "friction" not in wrong:
        yield "slipping points keep a direction that does not oppose their slip"
