"""The law of a contact in torsion, moment against rotation, in the forms that other programs read, with their errors.

`slipstick law` of the program calls `answer`.
"""
from __future__ import annotations

import re
from dataclasses import asdict, dataclass
from math import inf, nan, pi
from pathlib import Path
from typing import Any, Optional

import jinja2
import numpy as np

from . import exact
from .errors import InputError
from .law_fits import (LAST_DEFICIT, STIFFNESS, Curve, LimitLoad, LimitSurface, ParallelElements, TwistLaw, best_spring,
                       spring_error, short, tabulate, tabulate_evenly)

@dataclass(frozen=True)
class Units:
    """The units in which the dimensionless law is a scene's, SI."""

    friction: float
    normal_load: float  #: N
    contact_radius: float  #: m
    shear_modulus: float  #: combined, Pa
    sphere_radius: Optional[float] = None  #: m, of a sphere on a half-space

    @property
    def moment(self) -> float:
        """mu W a, N m."""
        return self.friction * self.normal_load * self.contact_radius

    @property
    def rotation(self) -> float:
        """mu W/(G a^2), rad."""
        return self.friction * self.normal_load / (self.shear_modulus * self.contact_radius**2)


class Law:
    """The law of a contact in all its forms, and laws of other programs that fit it best, with the errors that remain.

    profile: as slipstick.exact names it. error: relative, of the polynomials. table_error, element_error: over the limit, of
    the table, and of the elements on first loading; or a number of elements instead of their error. prefix: begins names in
    files.

    >>> law = Law("cone", error=1e-9, limit_loads=3)
    >>> law.file("law.csv").splitlines()[0]
    'rotation,moment,stick_ratio,tangent_stiffness,energy_lost_per_cycle'
    """

    def __init__(self, profile: str = "hertz", *, error: float = 1e-6, table_error: float = 1e-4, element_error: float = 1e-2,
                 elements: Optional[int] = None, limit_loads: int = 65, units: Optional[Units] = None,
                 name: Optional[str] = None, profile_name: Optional[str] = None, prefix: str = "slipstick") -> None:
        self.name, self.profile, self.prefix, self.units = name or profile, profile_name or profile, prefix, units
        self.curve = curve = Curve(profile)
        self.fit, self.table = TwistLaw(curve, error), tabulate(curve, table_error)
        self.table_error = table_error
        self.elements, self.surface = ParallelElements(curve, element_error, elements), LimitSurface(curve, limit_loads)
        self.rotation_unit, self.moment_unit = (units.rotation, units.moment) if units else (1.0, 1.0)
        self.rate_unit = self.moment_unit / self.rotation_unit
        self.limit, self.stiffness = curve.limit * self.moment_unit, STIFFNESS * self.rate_unit
        #: stiffness and slip moment of each element
        self.jenkins = (self.elements.each * [[self.limit / self.rotation_unit, self.limit]]).tolist()
        self.programs = {"lammps": self._lammps(), "mujoco": self._mujoco(), "drake": self._drake()}

    def _lammps(self) -> dict[str, Any]:
        """pair_style granular: `twisting sds`, a spring with a cap, and the limit (2/3) mu W a, that of a uniform pressure,
        which `twisting marshall` has under any stiffness."""
        stiffness = best_spring(self.curve)
        return {"k_twist": stiffness * self.limit / self.rotation_unit,
                "mu_twist": self.limit / (self.units.normal_load if self.units else 1.0),
                "error": spring_error(self.curve, stiffness),
                "error_with_stiffness_at_rest": spring_error(self.curve, self.curve.rest),
                "marshall_limit_error": 2 / 3 / self.curve.limit - 1}

    def _mujoco(self) -> Optional[dict[str, Any]]:
        """condim 4, an elliptic cone: nothing rotates below the cap."""
        if not self.units:
            return None
        return {"friction": [self.units.friction, self.limit / self.units.normal_load, 0.0],
                "lost_presliding": self.rotation_unit * self.curve.state(moment_ratio=0.9).twist,
                "combined_error": self.surface.ellipsoid_error}

    def _drake(self) -> Optional[dict[str, Any]]:
        """A compliant hydroelastic sphere on a rigid half-space, whose pressure is E e, e the depth over the radius:
        p0 (1 - (r/a_h)^2), so that the limit moment is (8/15) mu W a_h. The modulus makes it exact at the contact's load; at
        half of that it is off, since it goes like W^(5/4), not W^(4/3)."""
        if not self.units or self.units.sphere_radius is None:
            return None
        radius = self.limit / (8 / 15 * self.units.friction * self.units.normal_load)
        modulus = 4 * self.units.sphere_radius**2 * self.units.normal_load / (pi * radius**4)
        return {"mu_dynamic": self.units.friction, "hydroelastic_modulus": modulus, "contact_radius": radius,
                "half_load_error": 2**(4 / 3 - 5 / 4) - 1, "lost_presliding": self._mujoco()["lost_presliding"]}

    def rows(self, table: Any) -> Any:
        """A table in the law's units: rotation, moment, stick ratio, tangent stiffness, energy that a cycle of this amplitude
        loses, and energy that went in on first loading (the loop of a cycle is that of Masing's rule)."""
        lost = np.append(0.0, exact.energy_lost(twist=table.twist[1:], profile=self.curve.profile, relative_error=1e-10))
        unit = self.moment_unit * self.rotation_unit
        return np.rec.fromarrays(
            [table.twist * self.rotation_unit, table.moment * self.moment_unit, table.stick_ratio,
             table.tangent_stiffness * self.rate_unit, lost * unit, (lost + 4 * table.moment * table.twist) / 8 * unit],
            names="rotation,moment,stick_ratio,tangent_stiffness,energy_lost,energy")

    def heading(self, before: str) -> str:
        """The first lines of a file, each with `before` in front. On one line: a scene's name may hold anything."""
        units = "rotations over mu W/(G a^2), moments over mu W a, energies over their product"
        if self.units:
            units = (f"rad, N m, J; normal load {short(self.units.normal_load)} N, friction {short(self.units.friction)}, "
                     f"contact radius {short(self.units.contact_radius)} m")
        contact = f"Torsion of {self.name}, profile {self.profile}"
        contact = "".join(letter if letter >= " " else " " for letter in contact)
        return f"{before}{contact}: first loading and its consequences, by slipstick law.\n{before}Units: {units}."

    def file(self, path: str | Path) -> str:
        """The text of a file by its ending: .csv table; .h C header; .py Python module; .table LAMMPS; .inp Abaqus; .xml
        MuJoCo; .sdf Drake. Numbers are the scene's, SI, or dimensionless."""
        ending = Path(path).suffix
        if ending not in (".csv", ".h", ".py", ".table", ".inp", ".xml", ".sdf"):
            raise InputError(f"--write {path}: its ending says no format; allowed: .csv, .h, .py, .table, .inp, .xml, .sdf")
        if ending == ".xml" and not self.programs["mujoco"]:
            raise InputError(f"--write {path}: MuJoCo's friction has a length; allowed: with a scene")
        if ending == ".sdf" and not self.programs["drake"]:
            raise InputError(f"--write {path}: Drake's modulus needs a sphere; allowed: with the scene of a sphere")
        forms = jinja2.Environment(loader=jinja2.FileSystemLoader(Path(__file__).parent / "law_forms"), trim_blocks=True,
                                   lstrip_blocks=True, keep_trailing_newline=True, undefined=jinja2.StrictUndefined)
        forms.filters.update(
            exactly="{:.17g}".format, short=short,
            numbers=lambda values: ",\n    ".join(
                ", ".join(map("{:.17g}".format, values[k:k + 4])) for k in range(0, len(values), 4)),
            harmless=lambda text: re.sub(r'[*"\\]', "_", text),  # closes no comment and no text
            comment=lambda text: re.sub("-(?=-)", "_", text))  # as XML allows
        return forms.get_template(f"{ending[1:]}.j2").render(
            law=self, fit=self.fit, units=self.units, **self.programs, deficit=LAST_DEFICIT, capitals=self.prefix.upper(),
            evenly=lambda: self.rows(tabulate_evenly(self.curve, self.table_error)))

    def result(self) -> dict[str, Any]:
        """All forms with their errors, as docs/schema/law.schema.json describes them."""
        units = {"rotation": "mu W/(G a^2)", "moment": "mu W a", "rotation_unit": 1.0, "moment_unit": 1.0}
        if self.units:
            units = {"rotation": "rad", "moment": "N m", "rotation_unit": self.rotation_unit, "moment_unit": self.moment_unit,
                     **asdict(self.units)}
            del units["sphere_radius"]
        force, length = (self.units.friction * self.units.normal_load, self.units.contact_radius) if self.units else (1.0, 1.0)

        def load_json(load: LimitLoad) -> dict[str, Any]:
            centre = {"centre": load.centre * length}
            if load.centre == inf:
                centre = {"centre": None, "centre_reason": "it slides without turning"}
            return {"force": load.force * force, "moment": load.moment * self.limit, **centre}

        stiffness, slip_moment = np.transpose(self.jenkins).tolist()
        reasons = {"mujoco": "its friction has a length: give a scene",
                   "drake": "its modulus needs a sphere: give the scene of a sphere"}
        programs: dict[str, Any] = {}
        for program, numbers in self.programs.items():
            programs.update({program: numbers} if numbers else {program: None, f"{program}_reason": reasons[program]})
        return {
            "name": self.name, "profile": self.profile, "units": units, "stiffness": self.stiffness, "moment_limit": self.limit,
            "full_stick": self.curve.full_stick,
            "fit": {"error": self.fit.error, "last_deficit": LAST_DEFICIT, "last_twist": self.fit.last_twist,
                    "logarithm_per_twist": self.fit.logarithm.json(), "twist_per_logarithm": self.fit.twist.json(),
                    "first_logarithm": self.fit.first_logarithm, "loss_power": self.fit.loss_power,
                    "loss_factor": self.fit.loss.json()},
            "table": {"error": self.table_error, "rotation": (self.table.twist * self.rotation_unit).tolist(),
                      "moment": (self.table.moment * self.moment_unit).tolist()},
            "elements": {"error": self.elements.error, "loop_error": 3 * self.elements.error,
                         "history_error": self.elements.history_error, "stiffness": stiffness, "slip_moment": slip_moment},
            "limit_surface": {"gap": self.surface.gap, "loads": [load_json(load) for load in self.surface.loads],
                              "ellipsoid": {"error": self.surface.ellipsoid_error,
                                            "at": load_json(self.surface.ellipsoid_farthest)}},
            "programs": programs}

    def text(self) -> str:
        """The result in a few lines."""
        fits, elements, lammps = (self.fit.logarithm, self.fit.twist, self.fit.loss), self.elements, self.programs["lammps"]
        lines = {
            "stiffness": f"{self.stiffness:.6g} {'N m/rad' if self.units else 'G a^3'}, at rest",
            "limit": f"{self.limit:.6g} {'N m' if self.units else 'mu W a'}",
            "fit": f"{' + '.join(str(len(fit.pieces)) for fit in fits)} pieces for moment, rotation, loss: within "
                   f"{self.fit.error:.0e}; found {', '.join(f'{fit.error:.1e}' for fit in fits)}",
            "table": f"{len(self.table)} rows, straight lines in between: within {self.table_error:.2g} of the limit",
            "elements": f"{len(elements.each)} in parallel: within {elements.error:.2g} of the limit on first loading, "
                        f"{3 * elements.error:.2g} on loops between t and -t, {elements.history_error:.2g} after any rotations",
            "limit surface": f"{len(self.surface.loads)} loads; the ellipsoid through its ends is "
                             f"{100 * self.surface.ellipsoid_error:+.2g} % off",
            "LAMMPS": f"twisting sds {lammps['k_twist']:.6g} 0 {lammps['mu_twist']:.6g}: up to {100 * lammps['error']:+.2g} % "
                      f"of the limit off; twisting marshall: the limit {100 * lammps['marshall_limit_error']:+.2g} %"}
        if mujoco := self.programs["mujoco"]:
            lines["MuJoCo"] = ("friction {:.6g} {:.6g} 0: the limit exact, no presliding ".format(*mujoco["friction"])
                               + f"({mujoco['lost_presliding']:.6g} rad at 0.9)")
        if drake := self.programs["drake"]:
            lines["Drake"] = (f"hydroelastic_modulus {drake['hydroelastic_modulus']:.6g}: the limit exact at this load, "
                              f"{100 * drake['half_load_error']:+.2g} % at half of it")
        return f"{self.name}: law of torsion, profile {self.profile}\n" + "".join(
            f"  {label:<16} {line}\n" for label, line in lines.items())


def answer(request: dict[str, Any]) -> dict[str, Any]:
    """For the program: a Law's arguments and the names of its files. A number that is null is no number."""
    files, units = request.pop("files"), request.pop("units", None)
    numbers = {name: nan if value is None else value for name, value in request.items()}
    law = Law(**numbers, units=Units(**units) if units else None)
    return {"exit_code": 0, "text": law.text(), "result": law.result(), "files": [law.file(file) for file in files]}
