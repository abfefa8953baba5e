"""Judges a loop of moment against rotation, or of force against displacement, that any program computed: `slipstick check SCENE
LOOP.csv` reads scene and loop, and hands them to answer(). A good loop follows the exact law."""
from __future__ import annotations

import dataclasses
import itertools
import math
from dataclasses import dataclass, field
from typing import Any, Optional

import numpy as np

from ._loop_fit import Hypothesis
from ._loop_laws import Contact, fit_exact_law, fit_wrong_laws
from ._loop_path import Array, Law, Path, Start, TorsionCurve, correlation, follow, loop_areas, row_noise, trimmed_mean
from .errors import InputError

_MAX_ROWS = 2000  # of a path: a fit gains nothing by more
_LAW_ERROR = 1e-9  # relative, of the exact law
# Allowed error of the moment that slip takes off, over that of the moment: at half of the limit slip takes off about a tenth.
_SLIP_OVER_LOAD = 10.0
_SLIP_SIGMAS = 4.0  # standard deviations that noise may explain
# _SLIP_SIGMAS of noise over the moment that slip takes off: with more noise a loop without loss looks like the exact one.
_SLIP_SHOWN = 0.8
_SURE = 1e-4  # residual of a law, over the largest load, with which other starts need no trial
_UNTRIMMED = 1.15  # variance of normal noise over its variance without the largest 2 %
_UNITS = {  # of load and motion, in SI units
    False: ({1.0: "", 1e-3: "N mm", 1e-6: "mN mm, or uN m", 1e3: "kN m"},
            {1.0: "", math.pi / 180: "degrees", 1e-3: "mrad", 1e-6: "urad"}),
    True: ({1.0: "", 1e-3: "mN", 1e3: "kN"}, {1.0: "", 1e-3: "mm", 1e-6: "um", 1e-9: "nm"})}
_PROFILES = {"a sphere": "hertz", "a cone": "cone", "a flat punch": "flat_punch"}  # that a program may confuse
_GAPS = {"a sphere": 2.0, "a cone": 1.0}  # exponents of the gaps of such profiles

Number = tuple[float, float]  # the loop's, and the exact law's at the same rotations; NaN where the loop does not show it
_MISSING = (math.nan, math.nan)


def _largest(values: Array) -> float:
    return float(np.abs(values).max())


# ---------------------------------------------------------------- the contact


def _force_law(gap: float) -> Any:
    """Cattaneo's and Mindlin's law for a gap like r^gap: F/(mu W) at G_t a delta/(mu W)."""
    power = gap / (gap + 1.0) if math.isfinite(gap) else 1.0
    return lambda t: np.copysign(1.0 - np.maximum(0.0, 1.0 - 4.0 * power * np.abs(t))**(1.0 / power), t)


def contact_from(given: dict[str, Any]) -> Contact:
    exponent = given["radius_exponent"]

    def number(value: Optional[float]) -> float:  # JSON has no infinity
        return math.inf if value is None else value

    common: dict[str, Any] = {key: number(given[key]) for key in ("normal_load", "limit", "motion_unit")}
    common.update(law_error=_LAW_ERROR, one_body=[number(each) for each in given["one_body"]])
    if "profile" not in given:
        gap = number(given["gap"])
        others = {name: _force_law(other) for name, other in _GAPS.items() if other != gap}
        return Contact(loading=_force_law(gap), stiffness=4.0, limit_exponent=1.0, stiffness_exponent=exponent,
                       other_profiles=others, load_name="force", motion_name="displacement", rate_unit="mm/s", **common)
    own, curve = given["profile"], TorsionCurve(given["profile"])
    limit = curve.moment_limit

    def over_own_limit(profile: str) -> Any:
        law = TorsionCurve(profile)
        return lambda t: law(t) * law.moment_limit / limit

    return Contact(loading=curve, stiffness=curve.stiffness, limit_exponent=1.0 + exponent, stiffness_exponent=3.0 * exponent,
                   other_profiles={name: over_own_limit(other) for name, other in _PROFILES.items() if other != own},
                   load_name="moment", motion_name="rotation", rate_unit="mrad/s", uniform_pressure_limit=2.0 / 3.0 / limit,
                   sphere_limit=limit if own == "hertz" else None, **common)


# ---------------------------------------------------------------- the judgement


@dataclass
class Judgement:
    """The judgement of a loop under one normal load, in the contact's units."""
    exact: Hypothesis  # the exact law from the record's start
    stiffness: Number  # dm/dt over the first third of the largest moment
    largest_load: Number  # m
    areas: list[Number]  # of closed loops
    noise: float  # of the moments from row to row, over the largest
    slip_error: float = math.nan  # relative error of the moment that slip takes off
    slip_noise: float = math.nan  # standard deviation of that error, from the noise
    good: bool = False
    why: str = ""  # one sentence
    law: Optional[str] = None  # that explains the loop
    fitted: list[Hypothesis] = field(default_factory=list)  # wrong laws, if the loop is bad

    @property
    def shows_slip(self) -> bool:
        """Whether slip shows above the noise, and with it the energy that is lost."""
        return self.slip_noise * _SLIP_SIGMAS <= _SLIP_SHOWN


def _percent(part: float) -> str:
    return "under 0.01 %" if part < 1e-4 else f"{100.0 * part:.2g} %"


def _without_noise(residual: float, noise: float) -> float:
    return math.sqrt(max(0.0, residual**2 - noise**2))


def _slope_at_rest(path: Path, moment: Array) -> float:
    """Slope of a line through the origin, over the first rows up to a part of the loop's largest moment."""
    beyond = np.abs(path.moment[:path.turns[1] + 1]) > _largest(path.moment) / 3.0
    rows = slice(0, int(beyond.argmax()) if beyond.any() else len(beyond))
    below = float(path.twist[rows] @ path.twist[rows])
    return float(path.twist[rows] @ moment[rows]) / below if below else math.nan


def _without_line(path: Path, values: Array) -> Array:
    """Values less their straight line over the rotation."""
    twist, left = path.twist - path.twist.mean(), values - values.mean()
    return left - twist * ((twist @ left) / (twist @ twist))


def _judge_slip(judgement: Judgement, path: Path, contact: Contact) -> None:
    """Slip makes the moment smaller than the stiffness at rest would. Finds by least squares, up to any straight line, how much
    of that difference the record shows and how far its shape differs."""
    slip = _without_line(path, contact.stiffness * path.twist - judgement.exact.moment)
    error = _without_line(path, judgement.exact.moment - path.moment)
    noise, count = judgement.noise * judgement.largest_load[0], len(slip)
    with np.errstate(divide="ignore", invalid="ignore"):
        part = (slip @ error) / (slip @ slip)
        by_noise = noise**2 * (_UNTRIMMED * count + _SLIP_SIGMAS * math.sqrt(4.0 * count))
        left = np.sqrt(np.maximum(0.0, np.sum((error - part * slip)**2) - by_noise))
        judgement.slip_error = float(np.hypot(part, left / np.linalg.norm(slip)))
        judgement.slip_noise = float(noise / np.linalg.norm(slip))


def _slip_text(judgement: Judgement) -> str:
    if not judgement.shows_slip:
        return f"; the record cannot show the energy lost: its noise is {100.0 * judgement.noise:.2g} % of the largest load"
    loops = len(judgement.areas)
    return f", the energy lost in {loops} {'loop' if loops == 1 else 'loops'} is right" if loops else ""


def _judge_from(path: Path, contact: Contact, tolerance: float, starts: list[Start]) -> Judgement:
    exact = fit_exact_law(path, contact, starts)
    own = dataclasses.replace(path, moment=path.moment - exact.offset, twist=path.twist + exact.start.shift)
    held = exact.moment - exact.offset
    largest = _largest(own.moment)
    judgement = Judgement(
        exact, (_slope_at_rest(own, own.moment), _slope_at_rest(own, held)) if exact.start.turned == 0.0 else _MISSING,
        (largest, _largest(held)), list(zip(loop_areas(own, own.moment), loop_areas(own, held))),
        max(row_noise(path, path.moment - exact.moment) / largest, contact.law_error))
    _judge_slip(judgement, path, contact)
    off = _without_noise(exact.residual, judgement.noise)
    judgement.good = (off <= math.hypot(tolerance, 0.5 * judgement.noise)
                      and judgement.slip_error <= _SLIP_OVER_LOAD * tolerance + _SLIP_SIGMAS * judgement.slip_noise)
    if judgement.good:
        judgement.law = "exact"
        judgement.why = (f"follows the exact law: the {contact.load_name} is {_percent(exact.residual)} off in the mean"
                         + _slip_text(judgement))
    return judgement


def judge(path: Path, contact: Contact, tolerance: float) -> Judgement:
    """Compares a loop with the exact law."""
    if not path.begins_at_zero:
        return _judge_from(path, contact, tolerance, path.starts())
    from_rest = _judge_from(path, contact, tolerance, [Start()])
    elsewhere = from_rest if from_rest.good else _judge_from(path, contact, tolerance, path.starts())
    return elsewhere if elsewhere.good else from_rest


# ---------------------------------------------------------------- the cause


def _find_rival(path: Path, laws: list[Hypothesis], likely: Hypothesis, noise: float) -> Optional[Hypothesis]:
    """A law of another family that explains the loop about as well, with no more unknowns. noise: of the rows, by which both
    are off; 0 where the likeliest law is off by no more."""
    less_likely, further_off = 30.0, 2.0  # chi squared; misfits, where it is not noise that makes them

    def family(law: Hypothesis) -> str:  # laws that scale the exact curve are one family
        return "limit_and_stiffness" if law.name in ("limit", "stiffness", "factor") else law.name

    def misfit(law: Hypothesis) -> float:
        return _without_noise(float(trimmed_mean(law.moment - path.moment)), noise)

    for law in laws:
        if family(law) != family(likely) and law.unknowns <= likely.unknowns and math.isfinite(law.cost):
            if law.cost < likely.cost + less_likely or (noise > 0.0 and misfit(law) < further_off * misfit(likely)):
                return law
    return None


def explain(judgement: Judgement, path: Path, contact: Contact, tolerance: float) -> None:
    """Finds the wrong law that a bad loop follows; from rest if one does so, where the record may start there."""
    starts = path.starts()
    sure = path.begins_at_zero and _explain_from(judgement, path, contact, tolerance, starts[:1])
    if not sure and (len(starts) > 1 or not path.begins_at_zero):
        _explain_from(judgement, path, contact, tolerance, starts)


def _explain_from(judgement: Judgement, path: Path, contact: Contact, tolerance: float, starts: list[Start]) -> bool:
    """Whether a law that starts so differs from the loop by no more than noise."""
    judgement.law, judgement.fitted = None, fit_wrong_laws(path, contact, starts)
    likely = min(judgement.fitted, key=lambda law: law.cost)
    noise = row_noise(path, path.moment - likely.moment) / judgement.largest_load[0]
    at_noise = likely.residual <= 1.1 * noise and likely.cost < judgement.exact.cost
    by_rate = likely.name in ("regularised", "stribeck", "viscous")  # rates of noisy rotations are off by percent
    explains = at_noise or _without_noise(likely.residual, noise) <= (2.0 if by_rate else 1.0) * tolerance
    off_by = 0.0 if at_noise else noise * judgement.largest_load[0]
    rival = _find_rival(path, judgement.fitted, likely, off_by) if explains else None
    found = f"the {contact.load_name} is {_percent(judgement.exact.residual)} off the exact law in the mean"
    left = _percent(likely.residual)
    if rival:
        judgement.why = (f"{found}; two of the known laws explain it: {likely.sentence} ({left} off), or {rival.sentence} "
                         f"({_percent(rival.residual)} off)")
    elif explains:
        judgement.law, judgement.why = likely.name, f"{likely.sentence} ({found}, {left} off this one)"
    else:
        judgement.why = f"{found} and follows none of the known laws; the nearest: {likely.sentence} ({left} off)"
    return judgement.law is not None and (at_noise or likely.residual < _SURE)


# ---------------------------------------------------------------- units and signs


@dataclass
class Conventions:
    """The units and signs of a record."""
    load: float = 1.0  # N m, or N, of one unit; negative: the other sign
    motion: float = 1.0  # rad, or m, of one unit
    notes: list[str] = field(default_factory=list)  # how they differ from the scene's


def _notes(load: str, motion: str, other_way: bool, contact: Contact) -> list[str]:
    found = [f"the {name} is in {unit}" for name, unit in ((contact.load_name, load), (contact.motion_name, motion)) if unit]
    other = f"the {contact.load_name} acts on the other body, or the {contact.motion_name} is the other way round"
    return found + [other] * other_way


def _exact_from(path: Path, start: Start, contact: Contact) -> Array:
    return follow(path.turns, path.twist[None] + start.shift, path.turn_twist[None] + start.shift, np.array([start.turned]),
                  Law(contact.loading))[0]


def _roughly_off(path: Path, exact: list[Array]) -> float:
    """Distance of a loop's load from the exact law's from several starts, over the larger of both."""
    error = np.array(exact) - path.moment
    size = np.maximum(np.abs(exact).max(axis=1), _largest(path.moment))
    return float((trimmed_mean(error - error.mean(axis=1, keepdims=True)) / size).min())


def find_conventions(given: Path, contact: Contact, tolerance: float, of_force: bool) -> Conventions:
    """The units and the sign in which a loop is near the exact law, if it is far from it in the scene's. Another unit is taken
    only where slip shows: loops without slip fit in any unit."""
    near, far = 0.35, 0.7  # _roughly_off() at most in the right units, and at least in wrong ones, where slip shows
    without_slip = 0.05  # load over the limit
    falls = -0.9  # the load as the motion grows, whatever their units
    as_given, least, found = math.inf, math.inf, Conventions()
    if correlation(given.twist, given.moment) < falls:
        found = Conventions(-1.0, 1.0, _notes("", "", True, contact))
    by_sign = found
    loads, motions = _UNITS[of_force]
    for motion, motion_name in motions.items():
        moved = given.in_units(1.0, motion)
        exact = [_exact_from(moved, start, contact) for start in moved.starts()[:3]]  # from rest or over whole cycles
        if motion == 1.0:
            as_given = _roughly_off(given, exact)
            least = min(near, 0.5 * as_given)
        for (load, load_name), sign in itertools.product(loads.items(), (1.0, -1.0)):
            off = _roughly_off(given.in_units(sign * load, motion), exact)
            if off < least:
                least, found = off, Conventions(sign * load, motion, _notes(load_name, motion_name, sign < 0.0, contact))
    if found.notes == by_sign.notes:
        return found
    path = given.in_units(found.load, found.motion)
    slips = _largest(path.moment) >= without_slip
    if as_given > far and slips:
        return found
    judgement = judge(path, contact, tolerance)
    has_unit = found.motion != 1.0 or abs(found.load) != 1.0
    # The record itself shows slip, not a start far outside of it.
    shows = judgement.shows_slip and abs(judgement.exact.offset) <= np.ptp(path.moment)
    return found if judgement.good and (slips or not has_unit or shows) else by_sign


# ---------------------------------------------------------------- the whole check


def _path(request: dict[str, Any], group: dict[str, Any], contact: Contact) -> Path:
    """The rows under one normal load. Raises InputError for sizes whose squares no number holds."""
    first, last = group["rows"]
    time = np.array(request["time"] or range(len(request["load"])))[first:last]
    rows = slice(None, None, -(-(last - first) // _MAX_ROWS))
    twist = np.array(request["motion"])[first:last][rows] / contact.motion_unit
    moment = np.array(request["load"])[first:last][rows] / contact.limit
    for size in (_largest(twist), _largest(moment)):
        if not 1e-100 < size < 1e100:
            raise InputError(f"{request['loop']}: in the contact's units a column reaches {size:g}; allowed: sizes within "
                             "1e-100..1e100")
    duration = float(time[-1] - time[0])
    return Path(((time - time[0]) / duration)[rows], duration if request["time"] else 0.0, twist, moment)


def _load_exponent(paths: list[Path], contacts: list[Contact]) -> Optional[Number]:
    """d ln(largest moment)/d ln(normal load) of the loops by least squares, and of the limit, if there are several and all
    reach gross slip, so that their largest moments are limits."""
    if len(paths) < 2 or any(_largest(_exact_from(path, Start(), contact)) <= 0.95 for path, contact in zip(paths, contacts)):
        return None
    loads = np.log([contact.normal_load for contact in contacts])
    limits = np.log([contact.limit * _largest(path.moment) for path, contact in zip(paths, contacts)])
    slope = float((loads - loads.mean()) @ (limits - limits.mean()) / np.sum((loads - loads.mean())**2))
    return slope, contacts[0].limit_exponent


def _exponent_fault(exponent: Number) -> str:
    """The fault of an exponent in words, empty where there is none."""
    value, exact = exponent
    if abs(value - exact) <= 0.05:
        return ""
    text = f"the limit goes like the normal load to the power {value:.2f}, not {exact:.2f}"
    return text + (": a contact radius that does not grow" if abs(value - 1.0) < 0.03 else "")


def answer(request: dict[str, Any]) -> dict[str, Any]:
    """The verdict on a loop, as JSON and as text.

    request: name (of the scene), loop (the file), of_force, tolerance, strict; the columns load, motion and time (or an empty
    list); and groups: for each normal load its rows (first, one after the last) and its contact.
    """
    contacts = [contact_from(group) for group in request["groups"]]
    paths = [_path(request, group, contact) for group, contact in zip(request["groups"], contacts)]
    tolerance, good, why, notes = request["tolerance"], True, "", []
    judgements = [judge(path, contact, tolerance) for path, contact in zip(paths, contacts)]
    if not all(judgement.good for judgement in judgements):
        conventions = find_conventions(paths[0], contacts[0], tolerance, request["of_force"])
        notes = conventions.notes
        if notes and request["strict"]:
            good, why = False, notes[0]
        elif notes:
            paths = [path.in_units(conventions.load, conventions.motion) for path in paths]
            judgements = [judge(path, contact, tolerance) for path, contact in zip(paths, contacts)]
    for judgement, path, contact in zip(judgements, paths, contacts):
        if not judgement.good:
            explain(judgement, path, contact, tolerance)
        if not why or (good and not judgement.good):
            why = judgement.why
        good = good and judgement.good
    exponent = _load_exponent(paths, contacts)
    if exponent and (fault := _exponent_fault(exponent)):
        good, why = False, f"{fault}; {why}"
    loads = [_load_result(*each) for each in zip(judgements, paths, contacts)]
    result = {"name": request["name"], "loop": request["loop"], "of": "force" if request["of_force"] else "torsion",
              "verdict": "good" if good else "bad", "why": why, "conventions": notes, "tolerance": tolerance}
    if exponent:
        result["load_exponent"] = dict(zip(("value", "exact"), exponent))
    result["loads"] = loads
    return {"exit_code": 0 if good else 1, "text": _text(result), "result": result}


# ---------------------------------------------------------------- the result


def _number(key: str, value: float, reason: str = "the loop does not show it") -> dict[str, Any]:
    return {key: float(value)} if math.isfinite(value) else {key: None, f"{key}_reason": reason}


def _numbers(number: Number, unit: float) -> dict[str, Any]:
    return {**_number("value", number[0] * unit), **_number("exact", number[1] * unit)}


def _load_result(judgement: Judgement, path: Path, contact: Contact) -> dict[str, Any]:
    """The result under one normal load, in SI units."""
    motion, limit, exact = contact.motion_unit, contact.limit, judgement.exact
    missing = {"law_reason": "none of the known laws explains it, or more than one"} if judgement.law is None else {}
    return {
        "normal_load": contact.normal_load, "verdict": "good" if judgement.good else "bad", "why": judgement.why,
        "law": judgement.law, **missing, "rows": len(path.twist), "reversals": len(path.turns) - 2, "limit": limit,
        **_number("residual", exact.residual, "not a number"), **_number("noise", judgement.noise, "not a number"),
        **_number("slip_error", judgement.slip_error), **_number("slip_noise", judgement.slip_noise),
        "start": {"turned": exact.start.turned * motion, "motion_offset": 0.0 - exact.start.shift * motion,
                  "load_offset": exact.offset * limit},
        "stiffness": _numbers(judgement.stiffness, limit / motion), "largest_load": _numbers(judgement.largest_load, limit),
        "areas": [_numbers(area, limit * motion) for area in judgement.areas],
        "tried": [{"law": law.name, "parameters": law.parameters, **_number("residual", law.residual, "not a number")}
                  for law in judgement.fitted]}


def _text(result: dict[str, Any]) -> str:
    """The result in a few lines."""
    of_force = result["of"] == "force"
    load_unit = "N" if of_force else "N m"

    def with_exact(number: dict[str, Any], unit: str) -> str:
        value, exact = ("-" if number[key] is None else f"{number[key]:.6g}" for key in ("value", "exact"))
        return f"{value} {unit} (exact {exact})"

    stiffness_unit = "N/m" if of_force else "N m/rad"
    lines = [("loop", result["loop"])] + [("note", note) for note in result["conventions"]]
    if "load_exponent" in result:
        lines.append(("load exponent", with_exact(result["load_exponent"], "")))
    for load in result["loads"]:
        lines += [("normal load", f"{load['normal_load']:.6g} N, {load['rows']} rows, {load['reversals']} reversals"),
                  ("stiffness", with_exact(load["stiffness"], stiffness_unit) + ", up to a third of the largest load"),
                  ("force" if of_force else "moment",
                   f"{with_exact(load['largest_load'], load_unit)}, of the limit {load['limit']:.6g} {load_unit}")]
        lines += [("energy lost", with_exact(area, "J in a loop")) for area in load["areas"]]
    return f"{result['verdict']}: {result['why']}\n" + "".join(f"  {label:<16} {value}\n" for label, value in lines)
