"""`slipstick check` of a field on a mesh: the request of the program, and the answer with its text and result."""
from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from textwrap import fill
from typing import Any, Optional

import numpy as np

from ..errors import InputError
from .causes import Solve, causes_of
from .curvature import of_sphere
from .field import ContactField
from .measures import Bodies, Law
from .read import read
from .right import Right, exact_answer, solved_answer
from .units import in_units_of
from .verdict import Examined, examine, percent

#: Cells across the contact of the solve that a field is compared with, for each of its own faces; and their range.
_FINER, _LEAST, _MOST = 3.0, 96, 384
#: Cells across the contact of solves that repeat a mistake.
_TRIAL = 96
#: Other signs of both tractions are taken if they come closer to the right ones than this part of the field's own distance.
_CLEARLY = 0.5


def answer(request: dict[str, Any]) -> dict[str, Any]:
    """The verdict on the field of a request (convergence/check/mesh_request.cpp)."""
    examined, notes = _examined(request)
    causes = causes_of(examined, request, _repeat(request, examined)) if examined.wrong else []
    good = not examined.wrong and not (request["strict"] and notes)
    undecided = good and not examined.shows
    if undecided:
        raise InputError(f"{request['field']}: cannot be judged, though nothing is wrong that this mesh shows: {examined.advice}")
    why = _why(examined, causes, good)
    name = examined.field.name if request["field"].endswith(".contact") else request["field"]
    choices = examined.field.said + notes
    result = {"name": request["name"], "field": name, "verdict": "good" if good else "bad", "why": why,
              "causes": causes, "choices": choices, "kind": examined.field.kind, "rows": len(examined.field.points) - examined.field.added,
              "faces_across": examined.across, "right_answer": examined.right.source, **_numbers(examined),
              "judged": [{"quantity": item.quantity, **_or_reason("value", item.value, "not a number"), "allowed": item.allowed,
                          "mesh": item.right, "holds": bool(item.holds)} for item in examined.judged]}
    return {"exit_code": 0 if good else 1, "text": _text(result, examined), "result": result}


def _repeat(request: Mapping[str, Any], examined: Examined) -> Solve:
    def solve(keys: Mapping[str, Any]) -> Right:
        extent = {"grid.extent": _extent(examined.field, examined.right)} if "layer.kind" in keys else {}
        return _solved(request, {**keys, **extent}, _TRIAL)

    return solve


def _examined(request: Mapping[str, Any]) -> tuple[Examined, list[str]]:
    file = Path(request["field"])
    field = ContactField.load(file) if file.suffix == ".contact" else read(file, **_reading(request["read_as"]))
    right = _right(request, {}, None)
    field = in_units_of(field, right.contact_radius, right.normal_load)
    field, notes = _signed(field, right, any(word.startswith("body=") for word in request["read_as"]))
    springs = _springs(request, field, right)
    across = 2 * np.sqrt(max(1, np.count_nonzero(field.pressure)) / np.pi)  # rows across the contact
    if request["exact"] is None or springs:
        right = _right(request, {**springs, **_own_moment(request, springs)}, int(np.clip(_FINER * across, _LEAST, _MOST)))
    others = {"a solve on cells as large as the faces": _right({**request, "exact": None}, springs, int(np.clip(across, 12, _MOST)))}
    law = Law(request["friction"])
    single = request["steps"] == 1 and request["half_spaces"]
    bodies = Bodies.of(request["upper"], request["lower"], springs.get("layer.tangential_compliance", 0.0)) if single else None
    held, curved = _held(request, right), _curved(request, right)
    examined = examine(field, right, others, law, bodies, request["twist"], held, curved, request["tolerance"])
    if springs and request["exact"] is not None:
        bare = exact_answer(request["exact"])
        examined.notes.append(f"springs change the twist by {100 * (right.twist / bare.twist - 1):+.2g} % and the contact radius by "
                              f"{100 * (right.contact_radius / bare.contact_radius - 1):+.2g} %; the mesh explains "
                              f"{percent(examined.allowances['twist'])} of the twist")
    if held:
        examined.notes.append(f"bodies held at {request['held_at'][0]:g} m turn {percent(held / right.twist)} less")
    if examined.explained:
        off = examined.reported / examined.right_twist - 1
        examined.notes.append(f"a sphere turns {percent(curved)} further than the half-space in its place: this explains "
                              f"{percent(examined.explained)} of the twist, which is {percent(off)} too high for half-spaces")
    return examined, notes


def _held(request: Mapping[str, Any], right: Right) -> float:
    """The twist by which bodies that are held turn less than half-spaces, M/(4 pi G R^3), rad; zero where they are not held."""
    if not request["held_at"]:
        return 0.0
    radius, factor = [*request["held_at"], 1.0][:2]
    if not (radius > right.contact_radius and np.isfinite(factor)):
        raise InputError(f"--held-at {radius:g},{factor:g}; allowed: a radius above the contact's, {right.contact_radius:.3g} m, and a "
                         "finite factor")
    compliance = request["upper"]["shear_compliance"] + request["lower"]["shear_compliance"]
    return float(factor * right.moment * compliance / (4 * np.pi * radius**3))


def _curved(request: Mapping[str, Any], right: Right) -> float:
    """How much further the sphere turns than the half-space in its place, over the twist of both bodies; zero for other bodies and
    for histories."""
    if not (request["sphere"] and request["exact"] and request["half_spaces"] and request["steps"] == 1):
        return 0.0
    share = request["upper"]["shear_compliance"] / (request["upper"]["shear_compliance"] + request["lower"]["shear_compliance"])
    return share * of_sphere(right.contact_radius / request["sphere"], request["exact"]["moment_ratio"])


def _reading(words: list[str]) -> dict[str, Any]:
    """The options of read() from words "key=value"; other keys name arrays."""
    options: dict[str, Any] = {}
    for word in words:
        key, equals, value = word.partition("=")
        if not equals:
            raise InputError(f"--read-as {word}; allowed: key=value, as kind=nodes or pressure=CPRESS")
        if key == "centre":
            options[key] = [_number(word, part) for part in value.split(",")]
        elif key in ("kind", "units", "body", "axis", "basis"):
            options[key] = value
        else:
            options.setdefault("names", {})[key] = value
    return options


def _number(word: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"--read-as {word}: {text} is no number; allowed: centre=X1,X2") from None


def _springs(request: Mapping[str, Any], field: ContactField, right: Right) -> dict[str, Any]:
    """The scene's keys of a layer that is as soft as the penalties, and of a grid on which the contact can grow."""
    slope, stiffness = request["stick_slope"], request["normal_stiffness"]
    for option, value in (("--stick-slope", slope), ("--normal-stiffness", stiffness)):
        if value is not None and not (value > 0 and np.isfinite(value)):
            raise InputError(f"{option} {value:g}; allowed: above zero, in Pa/m")
    if slope is None and stiffness is None:
        return {}
    return {"layer.kind": "winkler", "layer.normal_compliance": 1 / stiffness if stiffness else 0.0,
            "layer.tangential_compliance": 1 / slope if slope else 0.0, "grid.extent": _extent(field, right)}


def _own_moment(request: Mapping[str, Any], springs: Mapping[str, Any]) -> dict[str, Any]:
    """The key of the moment without springs, which change its limit; none where the scene gives no part of a limit."""
    part_of_limit = springs and request["exact"] is not None and "load.moment_ratio" in (request["torsion"] or {})
    return {"load.moment": request["exact"]["moment"]} if part_of_limit else {}


def _extent(field: ContactField, right: Right) -> list[float]:
    """Sides of a grid that leaves a third of the contact's size around it, m: with springs the solver does not know it in advance."""
    reach = np.abs(field.points[right.fields(field.points)[:, 0] > 0]).max(initial=right.contact_radius)
    return [float(8 / 3 * reach)] * 2


def _right(request: Mapping[str, Any], springs: Mapping[str, Any], cells: Optional[int]) -> Right:
    if request["exact"] is not None and not springs:
        return exact_answer(request["exact"])
    return _solved(request, springs, cells)


def _solved(request: Mapping[str, Any], keys: Mapping[str, Any], cells: Optional[int]) -> Right:
    words = [word for word in request["overrides"] if not ("load.moment" in keys and word.startswith("load.moment_ratio="))]
    return solved_answer(request["scene"], words, keys, cells)


def _signed(field: ContactField, right: Right, given: bool) -> tuple[ContactField, list[str]]:
    """The field with its tractions on the lower body: on the other one both have the other sign."""
    wanted = right.fields(field.points)[:, 1:]
    own, turned = (np.abs(sign * field.traction - wanted).sum() for sign in (1, -1))
    if given or not turned < _CLEARLY * own:
        return field, []
    return (field.replaced(traction=-field.traction, slip=None if field.slip is None else -field.slip),
            ["Body: the tractions are those on the upper body, since with the other sign they carry the scene's loads."])


def _or_reason(key: str, value: Optional[float], reason: str) -> dict[str, Any]:
    """A number of the result, or why it is missing."""
    return {key: float(value)} if value is not None and np.isfinite(value) else {key: None, f"{key}_reason": reason}


def _numbers(examined: Examined) -> dict[str, Any]:
    load, moment, force = examined.judge.loads(examined.values)
    twist = None if examined.motion is None else examined.motion.twist
    missing = "too little sticks" if examined.judge.bodies else "it is known for a first loading of half-spaces only"
    return {"normal_load": load, "moment": moment, "force": force.tolist(), "contact_radius": examined.judge.radius(examined.values),
            "stick_radius": examined.judge.stick_radius(examined.values),
            "right_stick_radius": examined.judge.stick_radius(examined.judge.reference), "right_twist": examined.right_twist,
            **_or_reason("gap", examined.gap, missing), "right_gap": examined.right_gap,
            **_or_reason("given_slip_direction", _given_slip_direction(examined), "the field has no slip where it should slip"),
            **_or_reason("twist", examined.reported, "not given"), **_or_reason("twist_of_tractions", twist, missing)}


def _given_slip_direction(examined: Examined) -> Optional[float]:
    field = examined.field
    return None if field.slip is None else examined.judge.angle_of_given_slip(field.traction, field.slip)


def _why(examined: Examined, causes: list[str], good: bool) -> str:
    """The verdict's reason: a headline, and sentences that follow after semicolons."""
    if good:
        tractions = examined.number("tractions")
        assert tractions is not None
        return (f"right within its mesh: the tractions are {percent(tractions.value)} off in the mean (allowed on this mesh: "
                f"{percent(tractions.allowed)})")
    if not examined.wrong:
        return "it is right, but not in the scene's own signs"
    first, *rest = [item.words for item in examined.wrong]
    return "; ".join([first, *([f"likely cause: {', and '.join(causes)}"] if causes else []),
                      *([f"also wrong: {', '.join(rest)}"] if rest else []), *([] if examined.shows else [examined.advice])])


def _text(result: Mapping[str, Any], examined: Examined) -> str:
    def line(name: str, value: str) -> str:
        return f"  {name:<16} {value}\n"

    turned = [choice.split(", since")[0] for choice in result["choices"] if choice.startswith("Body: the tractions")]
    headline, *rest = result["why"].split("; ")
    text = f"{result['verdict']}{''.join(f' ({note[6:]})' for note in turned)}: {headline}\n"
    text += "".join(fill(part, 118, initial_indent="    ", subsequent_indent="      ") + "\n" for part in rest)
    text += line("field", f"{result['field']}: {result['rows']} {result['kind']}, {result['faces_across']:.3g} across the radius")
    text += "".join(line("" if k else "read as", choice) for k, choice in enumerate(result["choices"]))
    text += "".join(line("" if k else "compared with", note) for k, note in enumerate([result["right_answer"], *examined.notes]))
    for name, value, unit, right in (("normal load", result["normal_load"], "N", examined.right.normal_load),
                                     ("contact radius", result["contact_radius"], "m", examined.right.contact_radius),
                                     ("moment", result["moment"], "N m", examined.right.moment),
                                     ("twist", result["twist"], "rad", result["right_twist"]),
                                     ("twist caused", result["twist_of_tractions"], "rad", examined.right.twist),
                                     ("stick radius", result["stick_radius"], "m", result["right_stick_radius"])):
        if value is not None:
            text += line(name, f"{value:.6g} {unit} (right: {right:.6g})")
    if result["gap"] is not None:
        text += line("gap", f"{result['gap']:.2g} (right answers on this mesh: up to {result['right_gap']:.2g}); it is not judged")
    if result["given_slip_direction"] is not None:
        text += line("slip given", f"{result['given_slip_direction']:.2g} degrees from the traction in the mean; it is not judged, since "
                                   "programs count the slip of pressing, too")
    for item in examined.judged:
        text += line("holds" if item.holds else "FAILS", f"{item.quantity:<26} {item.value:>9.1e}   allowed on this mesh "
                                                        f"{item.allowed:.1e}")
    return text
