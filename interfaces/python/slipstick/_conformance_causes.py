"""The cause of a deviation in a case of slipstick.conformance."""
from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Optional

import numpy as np

from ._loop_path import Array, Path
from .loops import explain
from .loops import judge as judge_loop

_NEAR = 0.03  # distance within which a number or a shape is a named one
_LOOP_TOLERANCE = 0.01
_LAWS = ("factor", "stiffness", "limit", "limit_and_stiffness", "elastic", "rigid", "spring_and_cap", "bilinear", "not_enlarged",
         "unloads_without_slip", "equation_7", "other_profile", "exponential", "hyperbola", "dahl", "bouc_wen", "viscous", "regularised",
         "stribeck", "delayed", "normal_load_drifts")
_POWERS = {  # of the limit and of the stiffness over the normal load
    "limit": {0.0: ("normal_load_ignored", "the limit does not depend on the normal load"),
              1.0: ("constant_radius", "the limit goes like W: a contact radius that does not grow"),
              5 / 4: ("hydroelastic_radius", "the limit goes like W^(5/4): the radius of an elastic foundation")},
    "stiffness": {0.0: ("constant_stiffness", "the stiffness at rest does not depend on the normal load"),
                  1 / 3: ("tangential_stiffness", "the stiffness at rest goes like W^(1/3), as the tangential one"),
                  2 / 3: ("stiffness_like_a2", "the stiffness at rest goes like W^(2/3), the contact's area")}}
_COMMON = ("free", "moment_off", "unknown", "not_a_number")
_WEAK = 0.1  # a load this small over the exact one has no shape or power that is worth a name
CAUSES = {
    **{kind: (*_LAWS, "turns_too_far", *_COMMON) for kind in ("first-loading", "loops", "memory")},
    "load-powers": (*dict.fromkeys(name for powers in _POWERS.values() for name, _ in powers.values()), "wrong_power", *_COMMON),
    "hold": ("creeps", "settles", "slides", *_COMMON),
    "limit-surface": ("box", "ellipsoid", "diamond", "limits", "force_off", *_COMMON),
    "normal-load": ("normal_load_ignored", "no_memory_of_load", "creeps", "rigid", *_COMMON),
    "rates": ("grows_with_rate", "falls_with_rate", "creeps", "rigid", *_COMMON)}

Cause = tuple[str, str]  # a name, and a sentence


def kind_of(name: str) -> str:
    return "hold" if name.startswith("hold") else name


def sliding_loads(case: Any, data: Mapping[str, Array]) -> Array:
    """Force and moment over their limits, a row for each run: the mean over its second half, since some programs hop."""
    halves = [rows[len(rows) // 2:] for rows in np.split(np.arange(len(case.run)), np.flatnonzero(np.diff(case.run)) + 1)]
    load = case.sphere.normal_load
    units = case.sphere.friction * load, case.sphere.limit(load)
    return np.array([[data["force"][rows].mean() / units[0], data["moment"][rows].mean() / units[1]] for rows in halves])


def deviation_cause(case: Any, data: Mapping[str, Array], numbers: list[float]) -> Cause:
    """The cause of a response that is not green; numbers: of the case's measures."""
    kind = kind_of(case.id)
    with np.errstate(all="ignore"):
        if (column := _free(case, data)):
            return "free", f"the contact {'turns' if column == 'twist' else 'moves'} as a free body does under the {_LOAD_OF[column]}"
        if kind == "load-powers":
            last = np.flatnonzero(np.append(np.diff(case.run), 1))  # the limits
            factor = np.exp(np.log(np.abs(data["moment"][last] / case.moment[last])).mean())
            return _size_cause(factor, "moment") if factor < _WEAK else _power_cause(numbers)
        if kind == "hold":
            return _hold_cause(case, data)
        if kind == "limit-surface":
            return _surface_cause(case, data)
        if kind == "normal-load":
            return _normal_load_cause(case, data)
        if kind == "rates":
            return _rate_cause(case, data)
        return _law_cause(case, data)


_FIRST = 32  # rows; before them the steps of a simulator show
_LOAD_OF = {"twist": "moment", "displacement": "force"}


def _free(case: Any, data: Mapping[str, Array]) -> Optional[str]:
    """The motion that follows from inertia and loads without a contact, and goes far beyond the exact one."""
    for motion, load in _LOAD_OF.items():
        if motion in case.responses and np.abs(data[motion]).max() > 2 * np.abs(getattr(case, motion)).max():
            runs = [np.flatnonzero(case.run == run) for run in np.unique(case.run)]
            if all(_falls_freely(case.time[rows], data[load][rows], data[motion][rows]) for rows in runs):
                return motion
    return None


def _falls_freely(time: Array, load: Array, motion: Array) -> bool:
    """Whether the motion is the load over one inertia, integrated twice, up to the largest rate: some programs bound it."""
    step = np.diff(time)
    rate = np.abs(np.diff(motion) / step)
    rows = int(np.argmax(rate > 0.98 * rate.max()))
    speed = np.append(0.0, np.cumsum(0.5 * step * (load[1:] + load[:-1])))
    alone = np.append(0.0, np.cumsum(step * speed[:-1] + step**2 * (2 * load[:-1] + load[1:]) / 6))
    known, alone = motion[:rows], alone[:rows]
    if rows < _FIRST + 2:
        return False
    alone = alone * (alone @ known) / (alone @ alone)
    off = np.abs(known - alone)
    return bool(off.max() <= _NEAR * np.abs(known).max() and (off[_FIRST:] <= 0.1 * np.abs(alone[_FIRST:])).all())


def _size_cause(factor: float, name: str) -> Cause:
    return f"{name}_off", f"the {name} is {factor:.2g} times the exact one"


def _law_cause(case: Any, data: Mapping[str, Array]) -> Cause:
    """The wrong law that moments over twists follow."""
    load = case.sphere.normal_load
    twist, moment = data["twist"] / case.sphere.rotation(load), data["moment"] / case.sphere.limit(load)
    if not 1e-9 < np.abs(moment).max() < 1e9:
        return _size_cause(np.abs(data["moment"]).max() / np.abs(case.moment).max(), "moment")
    if not 1e-9 < np.abs(twist).max() < 1e9:
        return "rigid", "nothing turns below the limit"
    path, contact = Path(case.time / case.time[-1], float(case.time[-1]), twist, moment), case.sphere.loop_contact
    judgement = judge_loop(path, contact, _LOOP_TOLERANCE)
    explain(judgement, path, contact, _LOOP_TOLERANCE)
    factor = np.abs(data["twist"]).max() / np.abs(case.twist).max()
    if not judgement.law and factor > 10:
        return "turns_too_far", f"the contact turns {factor:.2g} times as far as the exact one"
    return judgement.law or "unknown", judgement.why


def _power_cause(numbers: list[float]) -> Cause:
    stiffness, limit = numbers
    off = {"limit": (limit, limit + 4 / 3), "stiffness": (stiffness, stiffness + 1)}
    for name, (error, power) in off.items():  # a wrong limit first: it needs no presliding
        if math.isnan(error):
            return "unknown", f"the {name} is not a positive number under each load"
        if abs(error) > 0.01:
            near = min(_POWERS[name], key=lambda known: abs(known - power))
            if abs(near - power) <= _NEAR:
                return _POWERS[name][near]
            return "wrong_power", f"the {name} goes like W^{power:.3f}"
    return "unknown", "no power is off"


def _hold_cause(case: Any, data: Mapping[str, Array]) -> Cause:
    """By the motion in two halves of the hold."""
    first, last = case.marks["held"]
    motion = data[case.marks["motion"]]
    halves = motion[(first + last) // 2] - motion[first], motion[last - 1] - motion[(first + last) // 2]
    if abs(halves[1]) > 1.5 * abs(halves[0]) and abs(halves[1]) > case.marks["rate"]:
        return "slides", "the contact slides faster and faster: its limit is below the load"
    if abs(halves[1]) < 0.5 * abs(halves[0]):
        return "settles", "the contact still moves, ever slower: a viscous part, or a load that came too fast"
    return "creeps", "the contact creeps under a load below its limit: regularised friction"


def _surface_cause(case: Any, data: Mapping[str, Array]) -> Cause:
    loads, right = sliding_loads(case, data), sliding_loads(case, {"force": case.force, "moment": case.moment})
    for column, name in enumerate(("force", "moment")):
        if (factor := np.abs(loads[:, column]).max() / np.abs(right[:, column]).max()) < _WEAK:
            return _size_cause(factor, name)
    own = np.array([loads[-1, 0], loads[0, 1]])  # pure force, pure moment
    sphere, last = case.sphere, np.flatnonzero(np.append(np.diff(case.run), 1))
    load = sphere.normal_load
    # The motion is normal to the surface in the plane of both ratios.
    normal = np.column_stack([data["displacement"][last] * sphere.friction * load, data["twist"][last] * sphere.limit(load)])
    shapes = {"box": ("the limits of force and moment do not know of each other", np.sign(normal)),
              "ellipsoid": ("an ellipsoid through both limits", normal / np.hypot(*normal.T)[:, None]),
              "diamond": ("the parts of both limits sum up to 1", np.eye(2)[normal.argmax(axis=1)]), "": ("", right)}
    distance = {name: np.abs(loads / own - shape).max() for name, (_, shape) in shapes.items()}
    name = min(distance, key=lambda each: distance[each])
    if name and distance[name] <= _NEAR:
        return name, shapes[name][0]
    if (np.abs(own - 1) > 0.02).any():
        return "limits", f"force and moment reach {own[0]:.3g} and {own[1]:.3g} of their limits"
    return "unknown", "force and moment follow no known surface"


def _normal_load_cause(case: Any, data: Mapping[str, Array]) -> Cause:
    loaded, back, fallen = case.marks["phases"]
    twist, top = data["twist"], (loaded + back) // 2
    before, exact_slip = twist[loaded], (case.twist[fallen] - case.twist[back]) * twist[loaded] / case.twist[loaded]
    if abs(before) < _NEAR * case.twist[loaded]:
        return "rigid", "nothing turns below the limit"
    rise, fall, slip = twist[top] - twist[loaded], twist[back] - twist[top], twist[fallen] - twist[back]
    size = _NEAR * abs(before)
    if rise < -size and fall > size:
        return "no_memory_of_load", "the twist follows the normal load: it turns back as the load rises"
    if rise > size and fall > size:
        return "creeps", "the contact turns on while the normal load is above its first value"
    if abs(slip) < _NEAR * exact_slip and abs(rise) <= size:
        return "normal_load_ignored", "a smaller normal load brings no slip"
    return "unknown", f"the slip is {slip / exact_slip:.3g} of the exact one"


def _rate_cause(case: Any, data: Mapping[str, Array]) -> Cause:
    slow = case.run == 0
    if np.abs(data["twist"]).max() < 0.01 * np.abs(case.twist).max():
        return "rigid", "nothing turns below the limit"
    if (factor := np.abs(data["moment"]).max() / np.abs(case.moment).max()) < 0.01:
        return _size_cause(factor, "moment")
    size = {name: np.abs(data[name][~slow]).sum() / max(np.abs(data[name][slow]).sum(), 1e-300) for name in ("moment", "twist")}
    if size["twist"] < 0.99:
        return "creeps", "the slow loop turns farther: the contact creeps"
    if size["moment"] > 1:
        return "grows_with_rate", "the moment grows with the rate: a viscous part, or regularised friction"
    return "falls_with_rate", "the moment falls with the rate, or comes late"
