"""Tables of contacts that no profile of torsion describes: coated, pushed along a line, dissimilar, elliptic, sliding about a point."""

from pathlib import Path

import numpy as np
import second
import second_coated
from mpmath import mp, mpf
from scipy import integrate
from second import BOUNDS
from tables import FRICTION, LOAD, MODULUS, STATED, Table, row, scales

SCENES = Path(__file__).resolve().parents[1] / "scenes"


def coated_rows(job):
    import slipstick
    young, thickness, ratios = job
    case = f"layer of {young / 1e9:g} GPa and {thickness * 1e6:g} um"
    body = [(e / (2 * (1 + nu)), nu) for e, nu in ((210e9, 0.3), (young, 0.25))]
    other, rows = second_coated.CoatedSphere(1000.0, 0.018, body[0], body[1], body[0], thickness), []
    for m in ratios:
        found = slipstick.solve(str(SCENES / "coated_sphere.toml"), solver__model="exact", lower__layer__thickness=thickness,
                                lower__layer__young_modulus=young, load__moment_ratio=m)
        c, twist = other.state(m)
        numbers = [("contact_radius", other.radius, "m"), ("approach", other.approach, "m"), ("peak_pressure", other.peak, "Pa"),
                   ("moment_limit", 0.1 * other.moment_limit, "N m")] if m == ratios[0] else []
        for name, again, unit in (*numbers, ("stick_radius", c, "m"), ("twist_angle", 0.1 * twist, "rad")):
            value = getattr(found, name)
            rows.append(row(case, "moment_ratio", m, name, value, 1e-11 * value, unit, "stated", "Fredholm equation in NumPy", again,
                            1e-11 * value, si=1, si_unit=unit))
    return rows


def coated(program, small, pool):
    jobs = [(young, thickness, (0.5, 0.9)) for young in (105e9, 420e9) for thickness in (1e-4, 1.5e-4, 2.5e-4, 5e-4, 1e-3, 2e-3)]
    rows = [row for rows in pool.map(coated_rows, jobs[::7] if small else jobs, chunksize=1) for row in rows]
    about = ("A steel sphere of 18 mm on coated steel (layer: nu = 0.25), 1000 N, mu = 0.1, torsion alone (the pressure moves no surface "
             "sideways). All values are in SI units; the scene is convergence/scenes/coated_sphere.toml.")
    return [Table("coated", "Torsion of a sphere on a coated body", about, "O'Sullivan and King 1988; docs/theory.md", rows)]


def tangential(program, small, pool):
    """Cattaneo's and Mindlin's contact at nu = 0."""
    import slipstick
    rows, shear, modulus, load = [], mpf(210) * 10**9 / 4, mpf(210) * 10**9 / 2, FRICTION * LOAD
    a = (3 * LOAD * mpf("0.018") / (4 * modulus))**(mpf(1) / 3)
    p0 = 3 * LOAD / (2 * mp.pi * a**2)
    for f in [k / 32 for k in range(2, 31, 14 if small else 1)]:
        found = slipstick.solve(str(SCENES / "mindlin.toml"), solver__model="exact", load__force=[100 * f, 0.0], grid__cells=[40, 40])
        c, most = (1 - mpf(f))**(mpf(1) / 3), mpf(3) / 8
        displacement, shift = most * (1 - c * c), load / (shear * a)
        lost = 2 * mp.quad(lambda x: x * most * mpf(2) / 3 * (1 - x)**(-mpf(1) / 3), [0, f]) - f * displacement
        for name, value, again, unit, factor, si_unit in (
                ("stick_ratio", found.stick_ratio, c, "a", a, "m"),
                ("displacement", found.displacement[0] / shift, displacement, "mu W/(G a)", shift, "m"),
                ("dissipated", found.dissipated / (load * shift), lost, "(mu W)^2/(G a)", load * shift, "J")):
            rows.append(row("sphere", "force_ratio", f, name, value, STATED * value, unit, "stated", "closed form", again,
                            again * mpf(10)**-24, si=factor, si_unit=si_unit))
        r = np.hypot(found.fields["x1"], found.fields["x2"])[20, 20:] / float(a)
        for radius, q in zip(r[r < 1], found.fields["q1"][20, 20:][r < 1] / float(FRICTION * p0)):
            inside = mp.sqrt(c**2 - mpf(radius)**2) if radius < c else 0
            rows.append(row("sphere", "force_ratio", f, "traction", q, STATED, "mu p0", "stated", "closed form",
                            mp.sqrt(1 - mpf(radius)**2) - inside, mpf(10)**-24, radius=float(radius), si=FRICTION * p0, si_unit="Pa"))
    about = ("A tangential force F on the sphere of convergence/scenes/mindlin.toml (nu = 0, 210 GPa, 18 mm, 1000 N, mu = 0.1); "
             "force_ratio is F/(mu W); traction is along F.")
    return [Table("tangential", "Cattaneo's and Mindlin's contact", about, "Cattaneo 1938; Mindlin 1949", rows)]


def frictional(program, small, pool):
    """Goodman's and Spence's stick ratios: a rigid flat punch on a body with nu = 0, beta = 1/2."""
    import slipstick
    rows = []
    for friction in [k / 16 for k in range(2, 14, 5 if small else 1)]:
        found = slipstick.solve(str(SCENES / "goodman.toml"), solver__model="exact", contact__friction=friction).stick_ratio
        def equation(u):  # c = tanh(u)
            return u / mp.tanh(u) - 2 * mpf(friction) * mp.ellipk(1 / mp.cosh(u)**2)
        c = mp.tanh(mp.findroot(equation, (mp.atanh(mpf(found)), mp.atanh(mpf(found)) * mpf("1.001"))))
        rows.append(row("goodman", "friction", friction, "stick_ratio", found, 1e-11, "a", "stated", "mpmath", c, mpf(10)**-24,
                        si=mpf("0.0005"), si_unit="m"))
    for friction in [0.25, 0.5] if small else [0.15, 0.2, 0.25, 0.2986, 0.35, 0.4, 0.5]:
        found = slipstick.solve(str(SCENES / "spence.toml"), solver__model="exact", contact__friction=friction).stick_ratio
        grid = slipstick.solve(str(SCENES / "spence.toml"), contact__friction=friction, grid__cells=[64, 64])
        rows.append(row("spence", "friction", friction, "stick_ratio", found, 1e-9, "a", "estimated", "a grid of 64 cells",
                        grid.stick_radius / 0.0005, 0.02, si=mpf("0.0005"), si_unit="m"))
    about = "A rigid flat punch of 0.5 mm pressed on a body with nu = 0 (Dundurs' beta = 1/2), with friction: the stick radius."
    return [Table("frictional", "Goodman's and Spence's contact", about, "Goodman 1962; Spence 1968, 1975", rows)]


def ellipses(program, small, pool):
    """Hertz's ellipses, by elliptic integrals and again by quadrature of the potential."""
    rows, unit_load = [], FRICTION * LOAD
    scale = (3 * LOAD * mpf("0.01") / (4 * MODULUS))**(mpf(1) / 3)  # both principal radii have the geometric mean 10 mm
    for k in [j / 16 for j in range(2, 16, 7 if small else 1)]:
        k, m = mpf(k), 1 - mpf(k)**2
        K, E = mp.ellipk(m), mp.ellipe(m)
        along, across = (K - E) / m, (E - k**2 * K) / (m * k**2)  # A = (3W/(2 pi E* a^3)) along, B by across
        a3 = 2 / mp.pi * mp.sqrt(along * across)  # a = a3^(1/3) * scale, from A B = 1/(4 R^2)
        a = a3**(mpf(1) / 3)
        values = {"curvature_ratio": (across / along, "1", 1, "1"), "longer_semi_axis": (a, "c0", scale, "m"),
                  "shorter_semi_axis": (k * a, "c0", scale, "m"),
                  "approach": (2 / mp.pi * K / a, "c0^2/R", scale**2 / mpf("0.01"), "m"),
                  "peak_pressure": (1 / (k * a * a), "3 W/(2 pi c0^2)", 3 * LOAD / (2 * mp.pi * scale**2), "Pa"),
                  "moment_limit": (mpf(3) / 8 * a * E, "mu W c0", unit_load * scale, "N m")}
        q = float(k)
        def angular(f):
            return integrate.quad(f, 0, np.pi / 2, epsabs=0, epsrel=1e-13, limit=200)[0]
        def chord(t):
            return np.hypot(np.sin(t), q * np.cos(t))
        whole, one, other = (angular(f) for f in (lambda t: 1 / chord(t), lambda t: np.sin(t)**2 / chord(t)**3,
                                                  lambda t: np.cos(t)**2 / chord(t)**3))
        size = (2 / np.pi * np.sqrt(one * other))**(1 / 3)
        edge = angular(lambda t: np.hypot(np.cos(t), q * np.sin(t)))
        again = {"curvature_ratio": other / one, "longer_semi_axis": size, "shorter_semi_axis": q * size,
                 "approach": 2 / np.pi * whole / size, "peak_pressure": 1 / (q * size * size), "moment_limit": 0.375 * size * edge}
        for name, (value, unit, factor, si_unit) in values.items():
            rows.append(row("ellipse", "axis_ratio", q, name, value, 0, unit, "closed", "scipy quadrature", again[name],
                            1e-12 * again[name], si=factor, si_unit=si_unit))
    about = ("Elliptic contacts of the axis ratio b/a, steel on steel, 1000 N, mu = 0.1, R = 1/(2 sqrt(A B)) = 10 mm with the gap A x1^2 + "
             "B x2^2; c0 = (3 W R/(4 E*))^(1/3); curvature_ratio is B/A; moment_limit is the moment at which all slides.")
    return [Table("ellipses", "Hertz's elliptic contacts", about, "Hertz 1882; Johnson 1985", rows)]


def sliding(profile, centre):
    """Force over mu W and moment over M_lim when all slides about a point at this distance, by polar coordinates about the point."""
    bound = {"hertz": lambda y2: np.sqrt(y2), "flat_punch": lambda y2: 1 / np.sqrt(y2), "constant": np.ones_like,
             "power:4": lambda y2: (3 - 2 * y2) * np.sqrt(y2) / 3}[profile]
    x, rest, weight = second.tanh_sinh(80)
    if centre < 1:
        angles, angle_weights = np.pi * (np.arange(400) + 0.5) / 400, np.full(400, np.pi / 400)
    else:
        top = np.arcsin(1 / centre)
        angles, angle_weights = np.pi - top * rest, top * weight  # the rays towards the disc
    force = moment = 0.0
    for t, w in zip(angles, angle_weights):
        middle, half = -centre * np.cos(t), np.sqrt(max(1 - (centre * np.sin(t))**2, 0.0))
        if half == 0:
            continue
        low = max(middle - half, 0.0) if centre < 1 else middle - half
        length = middle + half - low
        rho, from_low, to_high = low + length * x, length * x, length * rest
        y2 = to_high * (from_low + (low - (middle - half)))  # 1 - r^2 = (high - rho)(rho - lower root)
        q = bound(y2) * rho * weight * length * w
        # The sliding direction is across the ray; force perpendicular to the arm, moment about the contact's axis.
        force += 2 * (q * -np.cos(t)).sum()
        moment += 2 * (q * (rho + centre * np.cos(t))).sum()
    load, limit = float(BOUNDS[profile].load()), float(BOUNDS[profile].limit())
    return force / load, moment / limit


def limit_surfaces(program, small, pool):
    from slipstick.law_fits import Curve, LimitSurface
    rows = []
    for profile in ("hertz",) if small else ("hertz", "flat_punch", "constant", "power:4"):
        a, bound = scales(profile)
        load, limit = BOUNDS[profile].load(), BOUNDS[profile].limit()
        error = 2e-9 if profile == "flat_punch" else 1e-12  # doubles close to the edge do not hold an infinite pressure's digits
        for found in LimitSurface(Curve(profile), 5 if small else 33).loads[1:-1]:
            again = sliding(profile, found.centre)
            for name, value, other, unit, factor, si_unit in (
                    ("force", found.force, again[0], "mu W", load * bound * a**2, "N"),
                    ("moment", found.moment, again[1], "M_lim", limit * bound * a**3, "N m")):
                rows.append(row(profile, "centre", found.centre, name, value, error, unit, "estimated", "polar quadrature", other, 1e-11,
                                si=factor, si_unit=si_unit))
    about = "Force and moment together under which all of the contact slides, turning about a point at the distance `centre` (over a)."
    return [Table("limit_surfaces", "Limit surfaces", about, "Goyal, Ruina and Papadopoulos 1991", rows)]
