"""The table of stresses below a contact in torsion: the package's, and again as a superposition of bonded discs (mpmath)."""

from functools import partial

from mpmath import mp, mpf
from second import DIGITS, punches
from tables import RADII, Table, bonded_part, ends_of, first_state, row, units, with_error

STATES = [("moment_ratio", 0.4), ("moment_deficit", 0.1)]
PATHS = ([0.9, -0.6], [0.9, -0.6, 0.3])  # moments over the limit, each reversal inside of the one before
DEPTHS = (1 / 16, 1 / 4, 1 / 2, 1.0)
POINTS = [(r, z) for r in (*RADII[1::5], 1.25) for z in DEPTHS]


def disc(s, r, z):
    """sigma_theta_z and sigma_r_theta over G phi of a bonded disc of radius s that turns by phi, outward normal: with Z = z + i s and
    R = sqrt(r^2 + Z^2), a potential in complex form (docs/theory.md)."""
    Z = mp.mpc(z, s)
    R = mp.sqrt(r * r + Z * Z)
    w = (R - Z) / r
    return (4 / mp.pi * (-mp.im(w) - s * mp.re(1 - Z / R) / r), -4 / mp.pi * (-mp.im(w * w) / 2 - s * mp.re(w * w / R)))


def weight(profile, s):
    """-H'(s) of sphere, cone and flat punch."""
    if profile == "flat_punch":
        return punches.B(s) / s
    return (mp.ellipe if profile == "hertz" else mp.ellipk)(1 - s * s) / s


def superposed(profile, c, r, z):
    """Over mu p0: discs of radii c to a, and the edge's of the flat punch."""
    cuts = sorted({c, mpf(1), *(x for x in (r - z, mpf(r), r + z) if c < x < 1)})
    found = [mp.quad(lambda s: weight(profile, s) * disc(s, r, z)[i], cuts) / 2 for i in (0, 1)]
    edge = mp.pi / 4 if profile == "flat_punch" else 0
    return [value + edge * part for value, part in zip(found, disc(mpf(1), r, z))]


def loadings(path):
    """Moments of first loading whose tractions sum up to that after reversals inside of each other, each with its factor (Masing)."""
    return [(1, path[0])] + [(2 if after > before else -2, abs(after - before) / 2) for before, after in zip(path, path[1:])]


def first_loading(profile, given, at):
    """The bonded part and the stick ratio of the second path."""
    from slipstick import exact
    state = exact.states(profile=profile, **{given: float(at)})
    again = first_state(profile, given, at, *ends_of({name: (mpf(float(state[name])),) for name in ("stick_ratio", "stick_complement")}))
    return bonded_part(profile, again), again["stick_ratio"]


def profile_rows(points, job):
    """given: a name, at: a load; or given: None, at: the moments of a history."""
    from slipstick import exact
    profile, (given, at) = job
    mp.dps = DIGITS
    path = [mpf(m) for m in at] if given is None else None
    parts = ([(1, *first_loading(profile, given, at))] if path is None else
             [(factor, *first_loading(profile, "moment_ratio", m)) for factor, m in loadings(path)])
    last = at if path is None else at[-1]
    name = profile if path is None else f"{profile}; after {' and '.join(map(repr, at))}"
    unit, scale, si_unit = units(profile)["traction"]
    rows = []
    with mp.workdps(26):
        for r, z in points:
            def stress(x, r=r, z=z):  # of a history: all moments in proportion
                load = {given: x} if path is None else {"history": [m * (x / last) for m in at]}
                found = exact.stresses(r, z, profile=profile, **load)
                return [float(found.tz), float(found.rt)]
            sums = [(factor * part, superposed(profile, +c, mpf(r), mpf(z))) for factor, part, c in parts]
            for component, (quantity, value) in enumerate(zip(("stress_theta_z", "stress_r_theta"), with_error(stress, last))):
                other = mp.fsum(factor * found[component] for factor, found in sums)
                size = mp.fsum(abs(factor * found[component]) for factor, found in sums)
                error = value[1] + mpf("4e-15") * sum(abs(factor) for factor, *_ in parts)  # absolute: near a zero terms cancel
                rows.append(row(f"{name}; depth {z!r}", given or "moment_ratio", last, quantity, value[0], error, unit, "stated", "mpmath",
                                other, size * mpf(10)**-18 + mpf(10)**-20, radius=r, si=scale, si_unit=si_unit))
    return rows


def stresses(program, small, pool):
    profiles = ("hertz",) if small else ("hertz", "cone", "flat_punch")
    states = [*(STATES[1:] if small else STATES), *((None, path) for path in PATHS)]
    jobs = [(profile, state) for profile in profiles for state in states]
    points = POINTS[::7] if small else POINTS
    rows = [row for rows in pool.map(partial(profile_rows, points), jobs, chunksize=1) for row in rows]
    about = ("Stresses by torsion in a body at r/a and the depth z/a of `case`: first loading, or the last moment `at` after reversals. "
             "Components theta z and r theta, z the outward normal, so that theta z is the traction at the surface.")
    return [Table("stresses", "Torsion: stresses below the surface", about, "Reissner and Sagoci 1944; docs/theory.md", rows)]
