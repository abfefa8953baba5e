"""Cases that a simulator's friction must pass, with their exact answers: a sphere on a half-space of its own material.

    for case in cases():
        verdict = judge(case, {"moment": my_program(case.time, case.normal_load, case.twist)})
        assert verdict.passed, verdict.why

A program may impose the column that suits it: where it imposes the moment, its response is the twist. A verdict is green, amber or red,
with the number that decides it and the named cause.
"""
from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import exact
from ._conformance_causes import CAUSES, deviation_cause, kind_of, sliding_loads
from ._loop_laws import Contact
from .errors import InputError
from .law_fits import Curve, LimitLoad, LimitSurface
from .loops import contact_from

__all__ = ["Sphere", "Measure", "Case", "Verdict", "cases", "judge", "write", "board"]

Array = npt.NDArray[np.float64]
COLUMNS = ("run", "time", "normal_load", "moment", "twist", "force", "displacement")
_UNITS = {"time": "s", "normal_load": "N", "moment": "N m", "twist": "rad", "force": "N", "displacement": "m"}
_ORDER = ("green", "amber", "red")
_SMALL = (0.02, 0.04, 0.08)  # amplitudes over the limit moment, of loops that follow the cube law
_AMPLITUDES = (*_SMALL, 0.2, 0.4, 0.6, 0.8, 0.95)
_LOADS = (0.25, 0.5, 1.0, 2.0, 4.0)  # over the sphere's normal load
_HOLD = 10.0  # s
_SLOWER = 100.0


@dataclass(frozen=True)
class Sphere:
    """The contact of all cases. The default is steel on steel under 1000 N."""

    radius: float = 0.018  #: m
    normal_load: float = 1000.0  #: N
    friction: float = 0.1
    young_modulus: float = 210e9  #: Pa, of both bodies
    poisson_ratio: float = 0.3

    @property
    def shear_modulus(self) -> float:
        """Combined: 1/G = 1/G_1 + 1/G_2."""
        return self.young_modulus / (4 * (1 + self.poisson_ratio))

    def contact_radius(self, load: float) -> float:
        return exact.contact_of(load, self.young_modulus / (2 * (1 - self.poisson_ratio**2)), self.radius).radius

    def limit(self, load: float) -> float:
        """The limit moment."""
        return 3 * math.pi / 16 * self.friction * load * self.contact_radius(load)

    def rotation(self, load: float) -> float:
        """mu W/(G a^2), rad."""
        return self.friction * load / (self.shear_modulus * self.contact_radius(load)**2)

    def stiffness(self, load: float) -> float:
        """At rest, N m/rad."""
        return 16 / 3 * self.shear_modulus * self.contact_radius(load)**3

    def sliding_displacement(self, load: float) -> float:
        """The displacement at which a growing tangential force slides the contact (Cattaneo 1938, Mindlin 1949), m."""
        return 3 * self.friction * load * (2 - self.poisson_ratio) / (16 * self.shear_modulus * self.contact_radius(load))

    @property
    def loop_contact(self) -> Contact:
        """As slipstick.loops takes it."""
        return contact_from({"normal_load": self.normal_load, "limit": self.limit(self.normal_load), "profile": "hertz",
                             "motion_unit": self.rotation(self.normal_load), "one_body": [2.0, 2.0], "radius_exponent": 1 / 3})


@dataclass(frozen=True)
class Measure:
    """A number that a response must keep."""

    name: str
    unit: str  #: empty: a ratio
    green: float  #: the largest size that is right
    amber: float  #: the largest size that is tolerable
    reason: str  #: of both

    def verdict(self, number: float) -> str:
        return "green" if abs(number) <= self.green else "amber" if abs(number) <= self.amber else "red"


@dataclass(frozen=True)
class Case:
    """A path with its exact response. All columns have one row for each time; runs start at rest, each at time 0."""

    id: str
    about: str
    sphere: Sphere
    run: npt.NDArray[np.int64]
    time: Array
    normal_load: Array
    moment: Array
    twist: Array
    force: Array
    displacement: Array
    responses: tuple[str, ...]  #: columns; a program answers at least one and imposes the others
    measures: tuple[Measure, ...]
    causes: tuple[str, ...]  #: that a deviation may have
    marks: dict[str, Any] = field(default_factory=dict)  #: rows that the measures use


@dataclass(frozen=True)
class Verdict:
    """The judgement of one response. number: of the measure that decides."""

    case: str
    verdict: str
    measure: str
    number: float
    unit: str
    cause: Optional[str]  #: None: green
    why: str
    numbers: dict[str, float]

    @property
    def passed(self) -> bool:
        return self.verdict == "green"

    @property
    def text(self) -> str:
        """The number in its unit."""
        return _in_unit(self.number, self.unit)


def _in_unit(number: Optional[float], unit: str) -> str:
    if number is None or not math.isfinite(number):
        return "not finite"
    return f"{number:.2g}" + ("" if unit == "power" else f" {unit}") if unit else f"{100 * number:.2g} %"


# ---------------------------------------------------------------- the cases


def _case(name: str, about: str, sphere: Sphere, runs: list[dict[str, Any]], responses: tuple[str, ...],
          measures: tuple[Measure, ...], **marks: Any) -> Case:
    """runs: the columns of each, whose missing ones are zero; the normal load is the sphere's."""
    columns: dict[str, list[Array]] = {name: [] for name in COLUMNS}
    for number, run in enumerate(runs):
        for column in COLUMNS:
            given = run.get(column, {"run": number, "normal_load": sphere.normal_load}.get(column, 0.0))
            columns[column].append(np.broadcast_to(np.asarray(given), run["time"].shape))
    whole = {column: np.concatenate(parts) for column, parts in columns.items()}
    return Case(name, about, sphere, responses=responses, measures=measures, causes=CAUSES[kind_of(name)], marks=marks, **whole)


def _curve(sphere: Sphere, turns: Iterable[float], points: int, load: Optional[float] = None) -> dict[str, Array]:
    """Moment and twist along these moments over the limit, a second for each branch."""
    load = load or sphere.normal_load
    found = exact.curve(list(turns), points)
    return {"time": np.arange(len(found)) / points, "normal_load": np.full(len(found), load),
            "moment": found.moment_ratio * sphere.limit(load), "twist": found.twist * sphere.rotation(load)}


_DEVIATION = Measure("deviation", "", 0.01, 0.05, "largest distance from the exact response over its largest value: check calls 1 % good")


def _first_loading(sphere: Sphere) -> Case:
    stiffness = Measure("stiffness", "", 0.01, 0.05, "relative error at rest, where the exact stiffness 16/3 G a^3 needs no friction")
    return _case("first-loading", "the twist rises from rest to 0.95 of the limit moment", sphere, [_curve(sphere, [0.95], 300)],
                 ("moment", "twist"), (stiffness, _DEVIATION))


def _load_powers(sphere: Sphere) -> Case:
    runs = []
    for factor in _LOADS:
        load = factor * sphere.normal_load
        run = _curve(sphere, [0.05, 0.9, 0.99, 1 - 1e-9], 50, load)
        runs.append(run)
    about = "the twist rises from rest to the limit under five normal loads: the stiffness at rest goes like W, the limit like W^(4/3)"
    return _case("load-powers", about, sphere, runs, ("moment",), tuple(
        Measure(f"{name}_power", "power", 0.01, 0.05, f"d ln({name})/d ln(W) less the exact power; a contact radius that is constant makes "
                                                  "a difference of 1/3 or more") for name in ("stiffness", "limit")))


def _loops(sphere: Sphere) -> Case:
    points = 60
    turns = [turn for size in _AMPLITUDES for turn in (size, -size, size)]
    first = [1 + points * 3 * k + points - 1 for k in range(len(_AMPLITUDES))]
    return _case("loops", "loops between M and -M whose size grows from 0.02 to 0.95 of the limit", sphere, [_curve(sphere, turns, points)],
                 ("moment", "twist"), (
                     Measure("loss", "", 0.02, 0.1, "largest relative error of the energy that a loop loses: twice that of moments"),
                     Measure("loss_power", "power", 0.05, 0.2, "d ln(loss)/d ln(M) of small loops less the exact power, 3: without partial "
                                                           "slip small loops lose nothing, with viscous losses they go like M^2")),
                 loops=[(row, row + 2 * points + 1) for row in first])


def _hold(sphere: Sphere, of: str, part: float) -> Case:
    load, points = sphere.normal_load, 200
    time = np.concatenate([np.arange(points) / points, 1 + _HOLD * np.arange(points + 1) / points])
    size = np.minimum(time, 1.0) * part
    if of == "moment":
        motion, unit, rate = "twist", "rad/s", sphere.rotation(load)
        columns = {"moment": size * sphere.limit(load), "twist": exact.twist(size) * rate}
    else:
        motion, unit, rate = "displacement", "m/s", sphere.sliding_displacement(load)
        columns = {"force": size * sphere.friction * load, "displacement": (1 - (1 - size)**(2 / 3)) * rate}
    about = f"a {of} of {part} of its limit is held for {_HOLD:g} s; the exact contact does not move"
    creep = Measure("creep", unit, 1e-6 * rate, 1e-4 * rate, f"rate over the second half; 1e-6 and 1e-4 of {rate:.3g} {unit}: a contact "
                                                             "that slides fully while the load rises")
    return _case(f"hold-{of}-{part}", about, sphere, [{"time": time, **columns}], (motion,), (creep,), motion=motion, rate=rate,
                 held=(points, 2 * points + 1))


def _memory(sphere: Sphere) -> Case:
    turns = [0.9, -0.6, 0.5, -0.3, 0.1, -0.3, 0.5, -0.6, 0.95]
    about = "reversals inside of each other, which close again: a branch that closes continues the one before"
    return _case("memory", about, sphere, [_curve(sphere, turns, 60)], ("moment", "twist"), (_DEVIATION,))


def _limit_surface(sphere: Sphere) -> Case:
    load, rows = sphere.normal_load, 20
    radius, time = sphere.contact_radius(load), 0.2 * np.arange(1, rows + 1) / rows
    runs = []
    for one in LimitSurface(Curve("hertz"), 9).loads:
        turning = 1 / math.hypot(1, one.centre) if math.isfinite(one.centre) else 0.0
        speed = 2 * radius / 0.2  # far beyond the elastic displacement
        moves = math.sqrt(1 - turning**2)
        runs.append({"time": time, "twist": speed * turning / radius * time, "displacement": speed * moves * time,
                     "moment": one.moment * sphere.limit(load), "force": one.force * sphere.friction * load})
    about = "the contact slides and turns at nine ratios of both; force and moment together are on the limit surface"
    return _case("limit-surface", about, sphere, runs, ("force", "moment"), (
        Measure("surface", "", 0.02, 0.1, "largest relative distance from the surface, from the origin: the ellipsoid is 6.4 % off"),
        Measure("direction", "", 0.02, 0.10, "largest distance from the exact pair at the same motion, which is normal to the surface: the "
                                             "ellipsoid is 14 % off")))


def _normal_load(sphere: Sphere) -> Case:
    points, base, share = 100, sphere.normal_load, 0.5
    ramp = np.arange(points) / points
    factor = np.concatenate([np.ones(points), 1 + ramp, 2 - ramp, 1 - 0.35 * ramp, [0.65]])
    moment = np.concatenate([ramp, np.ones(3 * points + 1)]) * share * sphere.limit(base)
    # More load brings no slip; less load lets the contact slip on as if it had always been so small.
    least = np.minimum(factor, 1.0) * base
    twist = np.array([exact.twist(m / sphere.limit(w)) * sphere.rotation(w) for m, w in zip(moment, least)])
    about = "a moment of half of the limit is held while the normal load doubles, returns, and falls to 0.65: only the last makes it slip"
    return _case("normal-load", about, sphere, [{"time": np.arange(len(moment)) / points, "normal_load": factor * base, "moment": moment,
                                                 "twist": twist}], ("twist",), (
        Measure("slip", "", 0.02, 0.1, "relative error of the slip as the load falls below its first value, over the rotation before"),
        Measure("rise", "", 0.01, 0.05, "largest motion while the load is above its first value, over the rotation before; exact: none")),
        phases=[points, 3 * points, 4 * points])


def _rates(sphere: Sphere) -> Case:
    run = _curve(sphere, [0.9, -0.9, 0.9], 100)
    slow = {**run, "time": _SLOWER / 10 * run["time"]}
    fast = {**run, "time": run["time"] / 10}
    return _case("rates", "a loop at two rates, one 100 times the other: the exact response is the same", sphere, [slow, fast],
                 ("moment", "twist"), (
        Measure("rate_dependence", "", 0.01, 0.05, "largest difference of both runs over the largest value of exact and given responses"),))


def cases(sphere: Sphere = Sphere()) -> list[Case]:
    """All cases for a sphere.

    >>> [case.id for case in cases()][:3]
    ['first-loading', 'load-powers', 'loops']
    """
    held = [_hold(sphere, of, part) for of in ("moment", "force") for part in (0.5, 0.9)]
    return [_first_loading(sphere), _load_powers(sphere), _loops(sphere), *held, _memory(sphere), _limit_surface(sphere),
            _normal_load(sphere), _rates(sphere)]


# ---------------------------------------------------------------- the judgement


def _slope(x: Array, y: Array) -> float:
    x, y = x - x.mean(), y - y.mean()
    return float((x @ y) / (x @ x)) if x.any() else math.nan


def _largest(values: Array) -> float:
    return float(np.abs(values).max())


def _power(values: Iterable[float], loads: Iterable[float]) -> float:
    sizes = np.array(list(values))
    return _slope(np.log(np.array(list(loads))), np.log(sizes)) if (sizes > 0).all() else math.nan


def _areas(case: Case, data: Mapping[str, Array]) -> Array:
    rows = [(data["moment"][slice(*loop)], data["twist"][slice(*loop)]) for loop in case.marks["loops"]]
    return np.array([0.5 * np.diff(twist) @ (moment[1:] + moment[:-1]) for moment, twist in rows])


def _at_rest(case: Case, data: Mapping[str, Array], run: int = 0) -> float:
    """The stiffness of a run up to a twentieth of its limit."""
    rows = (case.run == run) & (case.moment <= 0.0501 * case.sphere.limit(case.normal_load[case.run == run][0]))
    moment, twist = data["moment"][rows], data["twist"][rows]
    return float(twist @ moment / (twist @ twist)) if twist.any() else math.inf


def _off(case: Case, data: Mapping[str, Array]) -> float:
    return max(_largest(data[name] - getattr(case, name)) / _largest(getattr(case, name)) for name in case.responses)


def _numbers(case: Case, data: dict[str, Array]) -> list[float]:
    """The values of a case's measures. A response that shows none has NaN."""
    kind = case.id
    exactly = {name: getattr(case, name) for name in COLUMNS}
    if kind == "first-loading":
        return [_at_rest(case, data) / _at_rest(case, exactly) - 1, _off(case, data)]
    if kind == "load-powers":
        runs = range(len(_LOADS))
        rest = [[_at_rest(case, rows, run) for run in runs] for rows in (data, exactly)]
        last = [[float(rows["moment"][case.run == run][-1]) for run in runs] for rows in (data, exactly)]
        return [_power(values, _LOADS) - _power(right, _LOADS) for values, right in (rest, last)]
    if kind == "loops":
        lost, right = _areas(case, data), _areas(case, exactly)
        small = len(_SMALL)
        return [_largest(lost / right - 1), _power(lost[:small], _SMALL) - _power(right[:small], _SMALL)]
    if kind.startswith("hold"):
        first, last = case.marks["held"]
        rows = slice((first + last) // 2, last)
        return [_slope(case.time[rows], data[case.marks["motion"]][rows])]
    if kind == "memory":
        return [_off(case, data)]
    if kind == "limit-surface":
        return _surface_numbers(case, data)
    if kind == "normal-load":
        loaded, back, fallen = case.marks["phases"]
        twist, before = data["twist"], data["twist"][loaded]
        slip, right = ((rows[fallen] - rows[back]) / rows[loaded] for rows in (twist, case.twist))
        return [float(slip / right - 1), _largest(twist[loaded:back + 1] - before) / before if before else math.nan]
    slow = case.run == 0
    if any(_largest(data[name]) < 0.01 * _largest(getattr(case, name)) for name in case.responses):
        return [math.nan]  # shows nothing
    return [max(_largest(data[name][slow] - data[name][~slow]) / max(_largest(getattr(case, name)), _largest(data[name]))
                for name in case.responses)]


def _surface_numbers(case: Case, data: Mapping[str, Array]) -> list[float]:
    loads, right = sliding_loads(case, data), sliding_loads(case, {"force": case.force, "moment": case.moment})
    surface: list[LimitLoad] = LimitSurface(Curve("hertz"), 257).loads
    angles = np.arctan2([one.moment for one in surface], [one.force for one in surface])[::-1]
    radii = np.hypot([one.moment for one in surface], [one.force for one in surface])[::-1]
    given = np.arctan2(np.abs(loads[:, 1]), np.abs(loads[:, 0]))
    return [_largest(np.hypot(*loads.T) / np.interp(given, angles, radii) - 1), _largest(np.hypot(*(loads - right).T))]


def judge(case: Case, response: Mapping[str, npt.ArrayLike] | npt.ArrayLike) -> Verdict:
    """The verdict on a response: columns by name, or one array, the first of case.responses. Columns that are missing are imposed.

    >>> first = cases()[0]
    >>> judge(first, {"moment": 1.2 * first.moment}).cause
    'factor'
    """
    given = response if isinstance(response, Mapping) else {case.responses[0]: response}
    if not set(given) <= set(COLUMNS[3:]) or not set(given) & set(case.responses):
        raise InputError(f"{case.id}: the response has {', '.join(map(repr, given)) or 'nothing'}; allowed: {', '.join(case.responses)}")
    data = {name: getattr(case, name) for name in COLUMNS}
    for name, values in given.items():
        data[name] = np.asarray(values, dtype=np.float64)
        if data[name].shape != case.time.shape:
            raise InputError(f"{case.id}: {name} has the shape {data[name].shape}; allowed: {case.time.shape}")
    is_number = all(np.isfinite(data[name]).all() for name in given)
    with np.errstate(all="ignore"):
        numbers = _numbers(case, data) if is_number else [math.nan] * len(case.measures)
    verdicts = [measure.verdict(number) for measure, number in zip(case.measures, numbers)]
    worst = max(range(len(numbers)), key=lambda k: (_ORDER.index(verdicts[k]), math.isnan(numbers[k]),
                                                    abs(numbers[k]) / case.measures[k].green))
    measure, number = case.measures[worst], float(numbers[worst])
    found = Verdict(case.id, verdicts[worst], measure.name, number, measure.unit, None, "",
                    {each.name: float(value) for each, value in zip(case.measures, numbers)})
    why = f"{case.id}: {measure.name} {found.text}, allowed {_in_unit(measure.green, measure.unit)}"
    if found.passed:
        return dataclasses.replace(found, why=why)
    cause, words = ("not_a_number", "the response is not a number") if not is_number else deviation_cause(case, data, numbers)
    return dataclasses.replace(found, cause=cause, why=f"{why}: {words}")


# ---------------------------------------------------------------- files


def write(folder: str | Path, sphere: Sphere = Sphere()) -> list[Path]:
    """Writes path and exact response of each case as ID.csv, and cases.json: what is judged, by which numbers and why."""
    folder, listed, files = Path(folder), [], []
    folder.mkdir(parents=True, exist_ok=True)
    for case in cases(sphere):
        rows = zip(*(getattr(case, column).tolist() for column in COLUMNS))
        files.append(folder / f"{case.id}.csv")
        files[-1].write_text("".join(",".join(row) + "\n" for row in [COLUMNS, *(map(repr, row) for row in rows)]), encoding="ascii")
        listed.append({"id": case.id, "about": case.about, "file": files[-1].name, "responses": case.responses, "rows": len(case.time),
                       "measures": [dataclasses.asdict(measure) for measure in case.measures], "causes": case.causes})
    head = {"sphere": dataclasses.asdict(sphere), "units": {"run": "runs start at rest", **_UNITS}, "cases": listed}
    files.append(folder / "cases.json")
    files[-1].write_text(json.dumps(head, indent=1) + "\n", encoding="ascii")
    return files


Row = Mapping[str, Any]


def _cell(found: Verdict | str) -> dict[str, Any]:
    if isinstance(found, str):
        return {"verdict": "none", "why": found}
    number = {"number": found.number} if math.isfinite(found.number) else {"number": None, "number_reason": "not a finite number"}
    return {"verdict": found.verdict, "measure": found.measure, **number, "unit": found.unit, "cause": found.cause, "why": found.why}


def board(programs: Iterable[Row], before: Optional[Mapping[str, Any]] = None) -> tuple[str, dict[str, Any]]:
    """A table of programs and cases, as Markdown and as JSON.

    programs: for each its program, version, friction, seconds, and cases: by id a Verdict, or the reason why the program has none.
    before: the JSON of an earlier run, whose other verdicts are named.
    """
    ids, old = [case.id for case in cases()], {}
    for row in (before or {"programs": []})["programs"]:
        old.update({(row["program"], row["friction"], name): cell["verdict"] for name, cell in row["cases"].items()})
    rows, lines = [], ["| case | program | friction | verdict | number | cause |", "|---|---|---|---|---|---|"]
    for row in programs:
        rows.append({**{key: row[key] for key in ("program", "version", "friction", "seconds")},
                     "cases": {name: _cell(row["cases"].get(name, "not run")) for name in ids}})
    for name in ids:
        for row in rows:
            cell = row["cases"][name]
            was = old.get((row["program"], row["friction"], name), cell["verdict"])
            changed = f" (before: {was})" if was != cell["verdict"] else ""
            shown = ""
            if cell["verdict"] != "none":
                shown = f"{cell['measure']} {_in_unit(cell['number'], cell['unit'])}"
            cause = cell["why"] if cell["verdict"] == "none" else cell["cause"] or ""
            lines.append(f"| {name} | {row['program']} {row['version']} | {row['friction']} | {cell['verdict']}{changed} | {shown} | "
                         f"{cause} |")
    return "\n".join(lines) + "\n", {"cases": ids, "programs": rows}
