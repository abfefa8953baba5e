"""The tables of exact values: each value from slipstick (ball arithmetic where it proves one, else doubles with a stated error), and a
second path that recomputes it. `small`: a part of each table, for a test of seconds."""

import json
import subprocess
from dataclasses import dataclass, field
from functools import partial

import numpy as np
import second
from mpmath import mp, mpf
from second import BOUNDS, DIGITS, TRACTION_DIGITS

PROVEN = ("hertz", "cone", "flat_punch", "power:1.5", "power:3", "power:4", "constant")
CERTIFIED_DIGITS, WRITTEN = 25, 20
STATED = 1e-14  # relative error of a double: docs/guides/exact-answers.md states 10 units of rounding, and 1e-14 of an energy
SPREAD = [10.0**k for k in range(-9, -1)] + [0.02, 0.05, 0.075]
LOADS = ([("moment_ratio", x) for x in SPREAD + [0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5]]
         + [("moment_deficit", x) for x in [0.45, 0.4, 0.35, 0.3, 0.25, 0.2, 0.15, 0.125, 0.1] + SPREAD[::-1]])
RADII = [j / 64 for j in (1, 4, 7, 10, 14, 17, 20, 24, 27, 30, 34, 37, 40, 44, 47, 50, 54, 57, 60, 63)]
PATHS = {"five": [0.9, -0.5, 0.4, -0.2, 0.6], "nine": [0.95, -0.8, 0.6, -0.4, 0.3, 0.1, 0.5, -0.6, 0.0]}

# Steel on steel: E = 210 GPa, nu = 0.3, mu = 0.1, W = 1000 N.
YOUNG, POISSON, FRICTION, LOAD = mpf(210) * 10**9, mpf(3) / 10, mpf(1) / 10, mpf(1000)
SHEAR, MODULUS = YOUNG / (4 * (1 + POISSON)), YOUNG / (2 * (1 - POISSON**2))
SHAPES = {"hertz": (0.018,), "cone": (0.02,), "flat_punch": (0.0005,), "power:1.5": (0.5,), "power:3": (2e4,), "power:4": (4e7,)}

COLUMNS = {
    "case": "profile of the pressure or of the friction bound, or the scene that is described in the table's `about`",
    "given": "name of the load or parameter", "at": "its value, a double",
    "radius": "r/a, a double; empty where the value belongs to the whole contact",
    "quantity": "name of the value", "value": "normalised", "error": "largest absolute error of `value`",
    "unit": "unit of `value`", "si": "the value in SI units; empty where it has none", "si_error": "largest absolute error of `si`",
    "si_unit": "unit of `si`",
    "known": "proven: enclosed by ball arithmetic; stated: computed in doubles, with the error that the program states; closed: a closed "
    "form in 36 digits; estimated: an error estimate, of a quadrature or a mesh",
    "second": "the second path that recomputed the value", "difference": "of the second path from `value`, absolute",
    "second_error": "largest absolute error of the second path",
}


@dataclass
class Table:
    name: str
    title: str
    about: str
    source: str
    rows: list = field(default_factory=list)


def text(number, digits):
    return mp.nstr(mpf(number), digits, strip_zeros=True, min_fixed=-5, max_fixed=6)


def upward(number):
    """An error in two digits, rounded up."""
    return text(mpf(number) * (1 + mpf("0.06")), 2) if number else "0"


def row(case, given, at, quantity, value, error, unit, known, path, again, again_error, radius=None, si=None, si_unit=""):
    """si: the factor of the SI value."""
    value = mpf(value)
    digits = WRITTEN if known in ("proven", "closed") else 17
    written = mpf(text(value, digits))
    error = mpf(error) + abs(written - value)
    numbers = ["", ""]
    if si is not None:
        whole = mpf(text(written * si, digits))
        numbers = [text(whole, digits), upward(error * abs(si) + abs(whole - written * si))]
    return [case, given, repr(float(at)), "" if radius is None else repr(radius), quantity, text(value, digits), upward(error), unit,
            *numbers, si_unit if si is not None else "", known, path, upward(abs(mpf(again) - written)), upward(again_error)]


# ---------------------------------------------------------------- SI

def indentation(profile, load):
    """Contact radius, approach and p0 in closed form (Hertz, Love, Boussinesq, Sneddon)."""
    shape = mpf(SHAPES[profile][0])
    n = mpf(second.EXPONENTS.get(profile, 0))
    if profile == "flat_punch":
        return shape, load / (2 * MODULUS * shape), load / (2 * mp.pi * shape**2)
    coefficient = 1 / (2 * shape) if profile == "hertz" else shape
    form = coefficient * mp.sqrt(mp.pi) * mp.gamma(n / 2 + 1) / mp.gamma((n + 1) / 2)
    a = (load * (n + 1) / (2 * MODULUS * n * form))**(1 / (n + 1))
    return a, form * a**n, load * (n + 1) / (2 * mp.pi * a**2)


def scales(profile):
    """Contact radius (m) and reference bound mu p0 (Pa) of the table's SI values. Bounds that are not mu p: 100 MPa at the centre
    of the sphere's contact, the cap as mu p of the sphere; the rounded punch has a = 0.5 mm."""
    if profile in SHAPES:
        a, _, p0 = indentation(profile, LOAD)
        return a, FRICTION * p0
    if profile.startswith("rounded"):
        return mpf("0.0005"), FRICTION * LOAD / (mp.pi * mpf("0.0005")**2)
    a, _, p0 = indentation("hertz", LOAD)
    return a, FRICTION * p0 if profile.startswith("capped") else mpf(10)**8


def units(profile):
    """Unit, SI factor and SI unit of each quantity."""
    a, bound = scales(profile)
    force = BOUNDS[profile].load() * bound * a**2
    return {"stick_ratio": ("a", a, "m"), "stick_complement": ("a", a, "m"), "twist": ("mu W/(G a^2)", force / (SHEAR * a**2), "rad"),
            "moment": ("mu W a", force * a, "N m"), "tangent_stiffness": ("G a^3", SHEAR * a**3, "N m/rad"),
            "energy_lost_per_cycle": ("(mu W)^2/(G a)", force**2 / (SHEAR * a), "J"),
            "dissipated": ("(mu W)^2/(G a)", force**2 / (SHEAR * a), "J"), "traction": ("mu p0", bound, "Pa")}


# ---------------------------------------------------------------- first loading

def proven_state(program, profile, given, at, radii):
    words = [program, "exact", "--profile", profile, "--" + given.replace("_", "-"), at.hex(), "--certified", str(CERTIFIED_DIGITS),
             "--quiet", "--json", "-", "--radius", ",".join(r.hex() for r in radii)]
    found = json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)
    def ball(entry):
        return mpf(entry["value"]), mpf(entry["radius"])
    state = {name: ball(found[name]) for name in ("stick_ratio", "stick_complement", "twist", "moment", "tangent_stiffness")}
    return state, [ball(at_radius["value"]) for at_radius in found["traction"]]


def with_error(function, at):
    """Values of a function of the load in doubles, each with the error that the program states: STATED, and four times the effect of
    rounding in the load, by a difference over a millionth of it."""
    values, *ends = (np.array(function(x), dtype=float) for x in (at, at * (1 - 1e-6), at * (1 + 1e-6)))
    errors = STATED * np.abs(values) + 4 * 2.0**-52 * np.abs(ends[1] - ends[0]) / 2e-6
    return [(mpf(float(value)), mpf(float(error))) for value, error in zip(np.atleast_1d(values), np.atleast_1d(errors))]


def stated_state(profile, given, at, radii):
    from slipstick import exact
    names = ("stick_ratio", "stick_complement", "twist", "moment", "tangent_stiffness")
    def state(x):
        found = exact.states(profile=profile, **{given: x})
        return [found[name] for name in names]
    return (dict(zip(names, with_error(state, at))),
            with_error(lambda x: exact.traction(np.array(radii), profile=profile, **{given: x}), at))


def stick(profile, given, at, c, complement):
    """One Newton step from these on the second path's moment: stick ratio and complement that carry the load."""
    found = second.state(profile, c, complement)
    off = (at - found[given]) * (1 if given == "moment_ratio" else -1)  # of the moment's ratio, so c moves by -off/slope
    step = -off / second.ratio_slope(profile, c, complement)
    return c + step, complement - step


def first_state(profile, given, at, c, complement):
    """The second path's state and stick radius."""
    bound, at = BOUNDS[profile], mpf(at)
    ratio = at if given == "moment_ratio" else 1 - at
    moment = ratio * bound.limit() / bound.load()
    if complement == 0:
        assert ratio * bound.limit() <= bound.moment(mpf(1), mpf(0))
        return {"stick_ratio": mpf(1), "stick_complement": mpf(0), "twist": 3 * moment / 16, "moment": moment,
                "tangent_stiffness": mpf(16) / 3}
    c, complement = stick(profile, given, at, c, complement)
    return {"stick_ratio": c, "stick_complement": complement, "twist": bound.height(c, complement) / (2 * bound.load()),
            "moment": bound.moment(c, complement) / bound.load(), "tangent_stiffness": mpf(16) / 3 * c**3}


def bonded_part(profile, state):
    """The part of the traction at which slip begins, while nothing slips; 1 after that."""
    bound = BOUNDS[profile]
    return state["moment"] * bound.load() / bound.moment(mpf(1), mpf(0)) if state["stick_complement"] == 0 else mpf(1)


def ends_of(state):
    """The stick ratio and its complement, each from the smaller of both."""
    c, complement = state["stick_ratio"][0], state["stick_complement"][0]
    return (1 - complement, complement) if complement < 0.5 else (c, 1 - c)


def load_rows(program, radii, job):
    """States and tractions of a profile at a load."""
    from slipstick import exact
    profile, (given, at) = job
    mp.dps = DIGITS
    proven, factors, bound = profile in PROVEN, units(profile), BOUNDS[profile]
    state, tractions = proven_state(program, profile, given, at, radii) if proven else stated_state(profile, given, at, radii)
    c, complement = ends_of(state)
    again = first_state(profile, given, at, c, complement)
    known, states = "proven" if proven else "stated", []
    for name, value in again.items():
        unit, factor, si_unit = factors[name]
        states.append(row(profile, given, at, name, *state[name], unit, known, "mpmath", value, abs(value) * mpf(10)**-22,
                          si=factor, si_unit=si_unit))
    energy = with_error(lambda x: exact.energy_lost(profile=profile, **{given: x}), at)[0]
    unit, factor, si_unit = factors["energy_lost_per_cycle"]
    states.append(row(profile, given, at, "energy_lost_per_cycle", *energy, unit, "stated", "scipy",
                      second.energy_lost(profile, c, complement), 2e-14 * energy[0], si=factor, si_unit=si_unit))
    c, complement = again["stick_ratio"], again["stick_complement"]
    part = bonded_part(profile, again)
    unit, factor, si_unit = factors["traction"]
    with mp.workdps(TRACTION_DIGITS):
        found = [part * bound.traction(mpf(r), +c, +complement) for r in radii]  # + rounds to these digits
    return states, [row(profile, given, at, "traction", *q, unit, known, "mpmath", other, abs(other) * mpf(10)**-21, radius=r, si=factor,
                        si_unit=si_unit) for r, q, other in zip(radii, tractions, found)]


def first_loading(program, small, pool):
    loads, radii = (LOADS[2::13], RADII[1::6]) if small else (LOADS, RADII)
    profiles = [name for name in BOUNDS if not small or name in ("hertz", "flat_punch", "constant", "capped:0.5")]
    found = list(pool.map(partial(load_rows, program, radii), [(profile, load) for profile in profiles for load in loads], chunksize=1))
    source = "Lubkin 1951; Jaeger 1995; docs/theory.md"
    about = "First loading by a moment under constant normal load. The loads are M/M_lim (moment_ratio) or 1 - M/M_lim (moment_deficit)."
    return [Table("torsion", "Torsion: states of first loading", about, source, [row for states, _ in found for row in states]),
            Table("tractions", "Torsion: tractions of first loading", about, source, [row for _, at in found for row in at])]


# ---------------------------------------------------------------- loops

def virgin(profile, m):
    """Stick ratio, twist and lost energy of first loading to m."""
    from slipstick import exact
    found = exact.states(m, profile=profile)
    c, complement = ends_of({name: (mpf(float(found[name])),) for name in ("stick_ratio", "stick_complement")})
    state = first_state(profile, "moment_ratio", m, c, complement)
    return state["stick_ratio"], state["twist"], mpf(second.energy_lost(profile, state["stick_ratio"], state["stick_complement"])) / 4


def masing(profile, path):
    """Front of the newest slip, twist and total loss at each turning point, by Masing's rule: a branch is first loading, twice as
    large; a closed loop leaves no trace."""
    amplitude = {}
    def branch(low, high):
        half = abs(mpf(low) - mpf(high)) / 2
        if half not in amplitude:
            amplitude[half] = virgin(profile, half)
        return amplitude[half]
    first = virgin(profile, path[0])
    reversals, lost = [path[0]], first[2]
    yield first
    for m in path[1:]:
        while len(reversals) > 2 and abs(m - reversals[-1]) >= abs(reversals[-2] - reversals[-1]):
            lost += 2 * branch(*reversals[-2:])[2]  # this leg closes a loop, and then the branch before the loop continues
            lost -= 2 * branch(reversals[-3], reversals[-2])[2]
            del reversals[-2:]
        lost += 2 * branch(reversals[-1], m)[2]
        reversals.append(m)
        twist = first[1] + sum(2 * branch(*ends)[1] * (1 if ends[1] > ends[0] else -1) for ends in zip(reversals, reversals[1:]))
        yield branch(*reversals[-2:])[0], twist, lost


def loop_rows(job):
    from slipstick import exact
    profile, (name, path) = job
    mp.dps = DIGITS
    found, factors, rows = exact.history(path, profile=profile), units(profile), []
    largest = {"twist": np.max(np.abs(found.twist)), "dissipated": np.max(found.dissipated)}
    for i, (m, (front, twist, lost)) in enumerate(zip(path, masing(profile, path))):
        for quantity, again in (("stick_ratio", front), ("tangent_stiffness", mpf(16) / 3 * front**3), ("twist", twist),
                                ("dissipated", lost)):
            value = float(found[quantity][i])
            unit, factor, si_unit = factors[quantity]
            rows.append(row(f"{profile}; {name} turning points", f"moment_ratio after turning point {i}", m, quantity, value,
                            STATED * (abs(value) + largest.get(quantity, 0)), unit, "stated", "Masing's rule on mpmath", again,
                            (5e-14 if quantity == "dissipated" else 1e-20) * float(abs(again)), si=factor, si_unit=si_unit))
    return rows


def loops(program, small, pool):
    profiles = [name for name in BOUNDS if not small or name == "hertz"]
    rows = [row for rows in pool.map(loop_rows, [(p, path) for p in profiles for path in PATHS.items()], chunksize=1) for row in rows]
    about = ("Moments through turning points: " + "; ".join(f"{name}: {path}" for name, path in PATHS.items())
             + ". Each row is the state at a turning point; stick_ratio is the front of the newest slip, dissipated the total.")
    return [Table("loops", "Torsion: loops of five and nine turning points", about, "Masing 1926; Deresiewicz 1954", rows)]


# ---------------------------------------------------------------- constants, indentation

def constants(program, small, pool):
    from slipstick import exact
    rows = []
    for profile, bound in BOUNDS.items():
        found = exact.profile_named(profile)
        full = bound.moment(mpf(1), mpf(0)) / bound.limit() if profile == "flat_punch" else mpf(0)
        a, reference = scales(profile)
        for name, value, again, unit, factor, si_unit in (
                ("normal_load", found.load, bound.load(), "p0 a^2", None, ""),
                ("moment_limit", found.moment_limit, bound.limit() / bound.load(), "mu W a", bound.load() * reference * a**3, "N m"),
                ("full_stick", found.full_stick, full, "M_lim", bound.limit() * reference * a**3, "N m"),
                ("torsional_stiffness", exact.tangent_stiffness(0.0, profile=profile), mpf(16) / 3, "G a^3", SHEAR * a**3, "N m/rad")):
            rows.append(row(profile, "none", 0.0, name, value, STATED * value, unit, "stated", "mpmath", again, again * mpf(10)**-24,
                            si=factor, si_unit=si_unit))
    for profile, shape in SHAPES.items():
        for load in (1.0, 10.0, 100.0, 1000.0, 10000.0):
            found = exact.contact_of(load, float(MODULUS), shape, profile=profile)
            for name, value, again, unit in zip(("contact_radius", "approach", "reference_pressure"),
                                                (found.radius, found.approach, found.reference_pressure),
                                                indentation(profile, mpf(load)), ("m", "m", "Pa")):
                rows.append(row(profile, "normal load in N", load, name, value, STATED * value, unit, "stated", "mpmath", again,
                                again * mpf(10)**-24, si=1, si_unit=unit))
    about = ("Constants of each profile: normal_load is the integral of the pressure (or of the friction bound), full_stick the moment "
             "up to which nothing slips, torsional_stiffness that of the unslipped contact. Then the indentation of steel on steel: "
             + ", ".join(f"{name} {shape[0]:g}" for name, shape in SHAPES.items())
             + " (radius in m, slope, radius in m, coefficients of r^N in m^(1-N)).")
    return [Table("constants", "Constants and indentation", about, "Hertz 1882; Love 1939; Sneddon 1965; Reissner and Sagoci 1944", rows)]
