"""Exact states of an axisymmetric contact in torsion, over arrays and without a grid.

All numbers are dimensionless. Lengths are divided by the contact radius a, moments by mu W a (friction, normal load, radius),
tractions by mu p0, pressures by p0, energies by (mu W)^2/(G a). The twist is G a^2 phi/(mu W), with 1/G = 1/G_1 + 1/G_2 of the
two bodies. `contact_of` gives a and p0 in SI units.

A profile describes the contact's pressure: "hertz" (sphere), "cone", "flat_punch", "power:N" (gap like r^N), "rounded_punch:B"
(flat out to B = b/a), "file:P.csv" (columns radius, pressure).

A state is given by exactly one of
    moment_ratio      M/M_lim, in [0, 1)
    moment_deficit    1 - M/M_lim, in (0, 1]: accurate near the limit
    stick_ratio       a_s/a, in (0, 1]
    stick_complement  1 - a_s/a, in [0, 1): accurate for a narrow slip ring
    twist             G a^2 phi/(mu W), from 0
as a number or an array; the result has the argument's shape. A value that is NaN or out of range raises InputError.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _library
from .errors import InputError

__all__ = ["twist", "moment_ratio", "moment", "stick_ratio", "tangent_stiffness", "energy_lost", "states", "traction", "pressure",
           "history", "curve", "stresses", "largest_stress", "first_yield", "yield_load", "Profile", "profile_named", "Contact",
           "contact_of"]

Values = Optional[npt.ArrayLike]
_GIVEN = ("moment_ratio", "moment_deficit", "stick_ratio", "stick_complement", "twist")
_WANTED = (*_GIVEN, "moment", "tangent_stiffness")


def _named(arguments: dict[str, Any]) -> tuple[str, Any]:
    """The quantity that gives the state, among a function's arguments, and its values."""
    names = [name for name in arguments if name in (*_GIVEN, "history")]
    given = [(name, arguments[name]) for name in names if arguments[name] is not None]
    if len(given) != 1:
        raise InputError(f"{len(given)} of {', '.join(names)} are given; allowed: exactly one")
    return given[0]


def _called(name: str, profile: str, before: Sequence[Any], array: Any, after: Sequence[Any], results: Any) -> Any:
    """The results of slipstick_NAME for an array, between other arguments."""
    _library.checked(_library.function(name)(_library.encoded(profile), *before, array.size, _library.address(array), *after,
                                             _library.address(results)))
    return results


def _numbers(name: str, profile: str, before: Sequence[Any], values: npt.ArrayLike, *after: Any) -> Any:
    """A number for each value."""
    array = _library.doubles(values)
    results = _called(name, profile, before, array, after, np.empty_like(array))
    return results if results.ndim else float(results)


def _find(wanted: str, arguments: dict[str, Any]) -> Any:
    name, values = _named(arguments)
    return _numbers("exact", arguments["profile"], [_GIVEN.index(name)], values, _WANTED.index(wanted))


def twist(moment_ratio: Values = None, *, moment_deficit: Values = None, stick_ratio: Values = None,
          stick_complement: Values = None, profile: str = "hertz") -> Any:
    """The normalised twist G a^2 phi/(mu W) of first loading; phi is in rad, as load.twist and twist_angle are.

    >>> round(twist(0.5), 12)
    0.073705510231
    >>> twist([0.0, 0.9]).round(6)
    array([0.      , 0.228093])
    >>> twist(1.0)
    Traceback (most recent call last):
    slipstick.errors.InputError: values[0]: M/M_lim = 1 is gross slip; allowed: 0 <= M/M_lim < 1
    """
    return _find("twist", locals())


def moment_ratio(twist: Values = None, *, moment_deficit: Values = None, stick_ratio: Values = None,
                 stick_complement: Values = None, profile: str = "hertz") -> Any:
    """M/M_lim of first loading.

    >>> round(moment_ratio(twist=0.1), 12) < 1
    True
    """
    return _find("moment_ratio", locals())


def moment(twist: Values = None, *, moment_ratio: Values = None, moment_deficit: Values = None,
           stick_ratio: Values = None, stick_complement: Values = None, profile: str = "hertz") -> Any:
    """The moment M/(mu W a) as a function of the twist, or of another quantity of the state.

    For small twists the contact is bonded, and the moment is 16/3 times the twist:

    >>> round(moment(1e-9) / 1e-9, 6)
    5.333333
    """
    return _find("moment", locals())


def stick_ratio(moment_ratio: Values = None, *, moment_deficit: Values = None, stick_complement: Values = None,
                twist: Values = None, profile: str = "hertz") -> Any:
    """The stick radius over the contact radius, a_s/a.

    >>> round(stick_ratio(0.9), 6)
    0.495895
    """
    return _find("stick_ratio", locals())


def tangent_stiffness(moment_ratio: Values = None, *, moment_deficit: Values = None, stick_ratio: Values = None,
                      stick_complement: Values = None, twist: Values = None, profile: str = "hertz") -> Any:
    """The tangent stiffness (dM/dphi)/(G a^3) of further loading: 16/3 (a_s/a)^3."""
    return _find("tangent_stiffness", locals())


def energy_lost(moment_ratio: Values = None, *, moment_deficit: Values = None, stick_ratio: Values = None,
                stick_complement: Values = None, twist: Values = None, profile: str = "hertz", relative_error: float = 1e-14) -> Any:
    """Energy lost in a cycle between M and -M, over (mu W)^2/(G a). A larger `relative_error` takes a tenth of the time for profiles
    without a closed form.

    For small moments it is (3/16) M^3 for a sphere:

    >>> m = 1e-4
    >>> round(energy_lost(m) / (3 / 16 * moment(moment_ratio=m)**3), 3)
    1.0
    """
    name, values = _named(locals())
    return _numbers("exact_energy_lost", profile, [_GIVEN.index(name)], values, relative_error)


def states(moment_ratio: Values = None, *, moment_deficit: Values = None, stick_ratio: Values = None,
           stick_complement: Values = None, twist: Values = None, profile: str = "hertz") -> np.recarray:
    """All numbers of first loading at once, as an array of records with moment_ratio, moment_deficit, stick_ratio,
    stick_complement, twist, moment and tangent_stiffness; pandas.DataFrame accepts it.

    >>> found = states([0.1, 0.9])
    >>> bool(found.moment_ratio[1] == 0.9 and found.twist[1] > found.twist[0])
    True
    """
    name, values = _named(locals())
    array = _library.doubles(values)
    return _called("exact_states", profile, [_GIVEN.index(name)], array, [], np.empty(array.shape, _library.STATE)).view(np.recarray)


def traction(radius: npt.ArrayLike, moment_ratio: float | None = None, *, moment_deficit: float | None = None,
             stick_ratio: float | None = None, stick_complement: float | None = None, twist: float | None = None,
             history: Sequence[float] | None = None, profile: str = "hertz") -> Any:
    """The traction q/(mu p0) around the axis at radii r/a in [0, 1]: for one state of first loading, or with a sign
    after a `history` of moments M/M_lim.

    Beyond the stick radius it equals the pressure, and a full reversal changes its sign:

    >>> bool(traction(0.8, 0.9) == pressure(0.8) and traction(0.8, history=[0.9, -0.9]) == -pressure(0.8))
    True
    """
    name, value = _named(locals())
    if name == "history":
        moments = _library.doubles(value).ravel()
        return _numbers("exact_history_traction", profile, [moments.size, _library.address(moments)], radius)
    return _numbers("exact_traction", profile, [_GIVEN.index(name), float(np.asarray(value))], radius)


def _state(arguments: dict[str, Any]) -> tuple[int, Any]:
    """The number of the quantity that gives the state and its value, or a history's moments."""
    name, values = _named(arguments)
    return 0 if name == "history" else _GIVEN.index(name), _library.doubles(values).ravel()


def stresses(radius: npt.ArrayLike, depth: npt.ArrayLike, moment_ratio: float | None = None, *,
             moment_deficit: float | None = None, stick_ratio: float | None = None, stick_complement: float | None = None,
             twist: float | None = None, history: Sequence[float] | None = None, friction: float = 0.0, poisson: float = 0.3,
             profile: str = "hertz") -> np.recarray:
    """The stresses in the body at radii r/a and depths z/a, for one state of first loading or after a `history`.

    Components along r, theta and the outward normal z: rr, tt, zz, rz by the pressure, over p0; rt, tz by the torsion, over
    mu p0 (tz is the traction q at the surface). Of both together, with friction mu and Poisson's ratio: von_mises, tresca
    (largest less smallest principal stress) and tension (largest principal stress), over p0. NaN where the profile is only a
    bound of the traction. An infinite stress raises InputError.

    Hertz's pressure yields first below the surface:

    >>> axis = stresses(0.0, [0.0, 0.48], 0.0)
    >>> axis.tresca.round(2)
    array([0.2 , 0.62])
    """
    given, values = _state(locals())
    radii, depths = (_library.doubles(array) for array in np.broadcast_arrays(radius, depth))
    before = [given, values.size, _library.address(values), friction, poisson]
    found = np.empty(radii.shape, _library.STRESS)
    return _called("exact_stresses", profile, before, radii, [_library.address(depths)], found).view(np.recarray)


_MEASURES = ("von_mises", "tresca", "tension")


def largest_stress(moment_ratio: float | None = None, *, moment_deficit: float | None = None, stick_ratio: float | None = None,
                   stick_complement: float | None = None, twist: float | None = None, history: Sequence[float] | None = None,
                   friction: float = 0.0, poisson: float = 0.3, measure: str = "von_mises", profile: str = "hertz") -> np.record:
    """The largest von_mises, tresca or tension in the body, over p0, as a record of value, radius and depth. The value is good to
    1e-12, the place to 1e-6. InputError where a stress is infinite (a pressure that is infinite or ends in a step).

    >>> found = largest_stress(0.0, measure="tresca")
    >>> round(found.value / 2, 4), round(found.depth, 3)
    (0.31, 0.481)
    """
    if measure not in _MEASURES:
        raise InputError(f"measure = {measure!r}; allowed: {', '.join(_MEASURES)}")
    given, values = _state(locals())
    found = np.empty(1, _library.LARGEST_STRESS)
    _library.checked(_library.function("exact_largest_stress")(
        _library.encoded(profile), given, values.size, _library.address(values), friction, poisson, _MEASURES.index(measure),
        _library.address(found)))
    return found.view(np.recarray)[0]


def first_yield(moment_ratio: npt.ArrayLike, friction: npt.ArrayLike, poisson: float = 0.3, measure: str = "von_mises",
                profile: str = "hertz") -> np.recarray:
    """Where the body yields first, and at which pressure: records of pressure (p0 over the tensile yield stress), radius and
    depth, for moments M/M_lim and frictions, which are broadcast.

    Friction moves it to the surface:

    >>> first_yield([0.0, 0.9], 0.5).depth.round(3)
    array([0.481, 0.   ])
    """
    moments, frictions = np.broadcast_arrays(_library.doubles(moment_ratio), _library.doubles(friction))
    found = np.empty((3, *moments.shape))
    for index in np.ndindex(moments.shape):
        largest = largest_stress(float(moments[index]), friction=float(frictions[index]), poisson=poisson, measure=measure,
                                 profile=profile)
        found[(slice(None), *index)] = 1 / largest.value, largest.radius, largest.depth
    return np.rec.fromarrays(list(found), names="pressure,radius,depth")


def yield_load(yield_stress: float, effective_modulus: float, shape: npt.ArrayLike, moment_ratio: float = 0.0, friction: float = 0.0,
               poisson: float = 0.3, measure: str = "von_mises", profile: str = "hertz") -> float:
    """The normal load at which the body first yields, N, at this friction and share M/M_lim of the limit moment; yield stress (in
    tension) and modulus in Pa, shape as in `contact_of`.

    >>> round(yield_load(300e6, 115.4e9, 0.018), 3)  # a steel ball of 18 mm: p0 = 1.613 Y
    14.241
    """
    if profile.startswith(("cone", "rounded_punch", "flat_punch")):
        raise InputError(f"profile = {profile!r}; allowed: hertz, power:N, whose pressure is finite and keeps its form under every load")
    pressure = yield_stress * float(first_yield(moment_ratio, friction, poisson, measure, profile).pressure)
    # p0 goes like a power of the load.
    one, two = (contact_of(load, effective_modulus, shape, profile).reference_pressure for load in (1.0, 2.0))
    return float((pressure / one)**(np.log(2) / np.log(two / one)))


def pressure(radius: npt.ArrayLike, profile: str = "hertz") -> Any:
    """The pressure p/p0 at radii r/a in [0, 1]; infinite at radii where the profile is infinite.

    >>> pressure([0.0, 0.6, 1.0])
    array([1. , 0.8, 0. ])
    """
    return _numbers("exact_pressure", profile, [], radius)


def history(moment_ratios: npt.ArrayLike, profile: str = "hertz") -> np.recarray:
    """The states of a contact under constant normal load at given moments M/M_lim in (-1, 1), starting from zero: moment_ratio,
    moment, twist, stick_ratio (front of the newest slip), tangent_stiffness, dissipated (total since the first loading, like
    dissipated_total of a solve; dissipated of a solve belongs to one step).

    >>> loop = history([0.5, -0.5, 0.5])
    >>> bool(abs(loop.twist[1] + loop.twist[0]) < 1e-15 and loop.dissipated[2] > loop.dissipated[1])
    True
    """
    moments = _library.doubles(moment_ratios).ravel()
    return _called("exact_history", profile, [], moments, [], np.empty(moments.shape, _library.CYCLE_STATE)).view(np.recarray)


def curve(turning_points: npt.ArrayLike, points_per_branch: int = 50, profile: str = "hertz") -> np.recarray:
    """The curve through these turning points M/M_lim, for drawing: the unloaded state and points_per_branch points a branch.

    >>> len(curve([0.9, -0.9], points_per_branch=10))
    21
    """
    turning = _library.doubles(turning_points).ravel()
    points = int(points_per_branch)
    if points < 1:
        raise InputError(f"points_per_branch = {points}; allowed: 1 or more")
    found = np.empty(turning.size * points + 1, _library.CYCLE_STATE)
    return _called("exact_curve", profile, [], turning, [points], found).view(np.recarray)


@dataclass(frozen=True)
class Profile:
    """Dimensionless constants of a profile."""

    load: float  #: W/(p0 a^2)
    moment_limit: float  #: M_lim/(mu W a)
    full_stick: float  #: M/M_lim below which nothing slips


def profile_named(profile: str = "hertz") -> Profile:
    """A profile's constants.

    >>> round(profile_named("hertz").moment_limit / np.pi, 6)  # 3/16
    0.1875
    """
    found = _library.Profile()
    _library.checked(_library.function("exact_profile")(_library.encoded(profile), _library.byref(found)))
    return Profile(found.load, found.moment_limit, found.full_stick)


@dataclass(frozen=True)
class Contact:
    """The contact under a normal load, in SI units."""

    radius: float  #: a, m
    approach: float  #: m
    reference_pressure: float  #: p0, Pa


def contact_of(load: float, effective_modulus: float, shape: npt.ArrayLike, profile: str = "hertz") -> Contact:
    """The frictionless contact under a load in N of bodies with 1/E* = sum (1 - nu_i^2)/E_i, in Pa.

    shape: "hertz": the sphere's radius, m; "cone": slope; "flat_punch": radius, m; "power:N": the gap's coefficient,
    m^(1-N); "rounded_punch": flat radius and corner radius, m.

    >>> round(contact_of(1000.0, 115.4e9, 0.018).radius * 1e3, 4)  # mm
    0.4891
    """
    lengths = _library.doubles(shape).ravel()
    found = _library.Indentation()
    _library.checked(_library.function("exact_indentation")(
        _library.encoded(profile), load, effective_modulus, lengths.size, _library.address(lengths),
        _library.byref(found)))
    return Contact(found.contact_radius, found.approach, found.reference_pressure)
