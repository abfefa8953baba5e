#!/usr/bin/env python3
"""Audits what `slipstick hard --fields FOLDER --json hard.json` has written, with nothing of slipstick.

    audit.py hard.json [--every N]

Influence coefficients are integrated and summed here a second time (Cerruti's and Boussinesq's point loads; Johnson 1985,
sections 3.2 and 3.6), the scenes are read by Python's own TOML. From pressure and tractions follow displacements; from
those the slip, Coulomb's law as a duality gap, the loads, the bound, the normal contact and its edge. One line for each
case that is beyond what its tolerance promises; exit code 1 where there is one.
"""
import argparse
import json
import math
import pathlib
import sys
import tomllib

import numpy as np

# A discrete answer of tolerance 1e-8, in double precision and with 17 digits, keeps to these.
ALLOWED = {
    "slip": 1e-9,  # written slip against displacements less a rigid motion, over the largest displacement
    "gap": 2.0,  # over the tolerance, or over what rounding allows where that is more
    "bound": 1e-12,  # |q| - mu p over the largest mu p
    "load": 1e-9,
    "moment": 1e-8,  # over its limit
    "force": 1e-8,  # over mu W
    "pressure": 1e-12,  # the least pressure over the largest: none pulls
    "gap_in_contact": 1e-6,  # of the surfaces, over the approach
    "overlap": 1e-6,  # outside the contact
}


def value(text):
    return tomllib.loads("value = " + text)["value"]


def path_of(row, folder):
    path = pathlib.Path(row["scene"])
    return path if path.is_absolute() else folder / path


def scene_of(row, folder):
    """The scene's tables with the row's settings."""
    scene = tomllib.loads(path_of(row, folder).read_text())
    for assignment in row["set"]:
        key, _, text = assignment.partition("=")
        *tables, last = key.split(".")
        table = scene
        for name in tables:
            table = table.setdefault(name, {})
        table[last] = value(text)
    return scene


def compliances(scene):
    """Sums over both bodies: 1/G, nu/G, (1 - nu)/G; and (1 - 2 nu)/G of the lower less the upper."""
    sums = np.zeros(4)
    for name, sign in (("lower", 1.0), ("upper", -1.0)):
        body = scene[name]
        if body.get("rigid", False):
            continue
        nu = body["poisson_ratio"]
        shear = 2.0 * (1.0 + nu) / body["young_modulus"]
        sums += shear * np.array([1.0, nu, 1.0 - nu, sign * (1.0 - 2.0 * nu)])
    return sums


def corner_sum(antiderivative, x, y, h):
    result = 0.0
    for i, sign1 in ((-0.5, -1.0), (0.5, 1.0)):
        for j, sign2 in ((-0.5, -1.0), (0.5, 1.0)):
            result = result + sign1 * sign2 * antiderivative(x + i * h[0], y + j * h[1])
    return result


def layer_of(scene):
    """Normal and tangential compliance of a layer that gives way where it is loaded and nowhere else."""
    layer = scene.get("layer", {})
    return [layer.get(f"{side}_compliance", 0.0) for side in ("normal", "tangential")]


def friction_bound(contact, p, folder):
    """The friction bound of each cell under a scene's law; folder: of its file."""
    if "friction_map" in contact:
        factors = np.loadtxt(folder / contact["friction_map"], delimiter=",", ndmin=2)
        return factors * friction_bound({k: v for k, v in contact.items() if k != "friction_map"}, p, folder)
    law, pressed = contact.get("friction_law", "coulomb"), np.maximum(p, 0.0)
    if law == "tresca":
        return np.where(p > 0.0, contact["shear_strength"], 0.0)
    if law == "power":
        return contact["friction"] * pressed ** contact["friction_exponent"]
    return np.minimum(contact["friction"] * pressed, contact["shear_strength"] if law == "capped" else np.inf)


def kernels(n, h, compliance, layer=(0.0, 0.0)):
    """Displacements at all offsets by a unit traction on one cell, transformed for cyclic convolution."""
    length = [2 * m for m in n]
    offsets = [np.fft.fftfreq(m, 1.0 / m) * step for m, step in zip(length, h)]
    x, y = np.meshgrid(*offsets, indexing="ij")
    # No corner of a cell lies on an axis through a centre, so no term is singular.
    along_x = corner_sum(lambda a, b: b * np.arcsinh(a / np.abs(b)), x, y, h)  # of x^2/r^3
    along_y = corner_sum(lambda a, b: a * np.arcsinh(b / np.abs(a)), x, y, h)  # of y^2/r^3
    mixed = corner_sum(lambda a, b: -np.hypot(a, b), x, y, h)  # of x y/r^3
    pull_x = corner_sum(lambda a, b: a * np.arctan(b / a) + b * np.log(np.hypot(a, b)), x, y, h)  # of x/r^2
    pull_y = corner_sum(lambda a, b: b * np.arctan(a / b) + a * np.log(np.hypot(a, b)), x, y, h)  # of y/r^2
    shear, poisson, normal, mismatch = compliance / (2.0 * math.pi)
    tables = {
        "11": shear * along_x + (shear - poisson) * along_y,
        "22": shear * along_y + (shear - poisson) * along_x,
        "12": poisson * mixed,
        "33": normal * (along_x + along_y),
        "13": -0.5 * mismatch * pull_x,
        "23": -0.5 * mismatch * pull_y,
    }
    for name, given in (("33", layer[0]), ("11", layer[1]), ("22", layer[1])):
        tables[name][0, 0] += given
    return {name: np.fft.rfft2(table) for name, table in tables.items()}


class Elasticity:
    def __init__(self, n, h, compliance, layer):
        self.n = n
        self.length = [2 * m for m in n]
        self.kernels = kernels(n, h, compliance, layer)

    def displacement(self, name, traction):
        spectrum = self.kernels[name] * np.fft.rfft2(traction, self.length)
        return np.fft.irfft2(spectrum, self.length)[: self.n[0], : self.n[1]]


def shape_gap(shape, x, y):
    """The gap of one shape at zero load, up to a constant; None: not known here."""
    at = shape.get("at", [0.0, 0.0])
    angle = shape.get("angle", 0.0)
    c, s = math.cos(angle), math.sin(angle)
    u, v = c * (x - at[0]) + s * (y - at[1]), c * (y - at[1]) - s * (x - at[0])
    r = np.hypot(u, v)
    kind = shape.get("shape")
    if kind == "sphere":
        return r**2 / (2.0 * shape["radius"])
    if kind == "ellipsoid":
        return u**2 / (2.0 * shape["radius_1"]) + v**2 / (2.0 * shape["radius_2"])
    if kind == "cone":
        return shape["slope"] * r
    if kind == "power":
        return shape["coefficient"] * r ** shape["exponent"]
    if kind == "rounded_punch":
        return np.maximum(r - shape["flat_radius"], 0.0) ** 2 / (2.0 * shape["corner_radius"])
    return None  # a punch's edge, a rough surface: heights are the program's own


def undeformed_gap(upper, x, y):
    shapes = upper["shape"] if isinstance(upper["shape"], list) else [upper]
    gaps = [shape_gap(shape, x, y) for shape in shapes]
    if any(gap is None for gap in gaps):
        return None
    return np.minimum.reduce(gaps) if upper.get("combine", "sum") == "nearest" else sum(gaps)


def fields_of(file, n, h):
    """Columns on the whole grid; the file holds the cells of the contact."""
    with open(file) as lines:
        names = lines.readline().strip().split(",")
        rows = np.array([[float(word) for word in line.split(",")] for line in lines])
    index = [np.rint(rows[:, k] / h[k] + 0.5 * (n[k] - 1)).astype(int) for k in (0, 1)]
    columns = {}
    for k, name in enumerate(names):
        columns[name] = np.zeros(n)
        columns[name][index[0], index[1]] = rows[:, k]
    return columns


def rigid_motion(residual, x, y, within):
    """The rigid motion closest to a field, and the residual."""
    scale = np.hypot(x, y)[within].max() or 1.0
    one, zero = np.ones(within.sum()), np.zeros(within.sum())
    matrix = np.column_stack(
        [np.concatenate(c) for c in ((one, zero), (zero, one), (-y[within] / scale, x[within] / scale))]
    )
    right = np.concatenate([field[within] for field in residual])
    motion = np.linalg.lstsq(matrix, right, rcond=None)[0]
    motion[2] /= scale
    left = [residual[0] - (motion[0] - motion[2] * y), residual[1] - (motion[1] + motion[2] * x)]
    return motion, left


def moved(elastic, coupling, fields):
    """Tangential displacements by tractions, and by the pressure where that counts."""
    u1 = elastic.displacement("11", fields["q1"]) + elastic.displacement("12", fields["q2"])
    u2 = elastic.displacement("12", fields["q1"]) + elastic.displacement("22", fields["q2"])
    if coupling != "none":
        u1 = u1 + elastic.displacement("13", fields["pressure"])
        u2 = u2 + elastic.displacement("23", fields["pressure"])
    return u1, u2


def audit(row, folder):
    """The measured numbers of one case, by name."""
    scene, beside = scene_of(row, folder), path_of(row, folder).parent
    found = {}
    row = row["written"]
    n, h = row["cells"], row["cell_size"]
    fields = fields_of(folder / row["fields"], n, h)
    x, y = np.meshgrid(*[(np.arange(m) - 0.5 * (m - 1)) * step for m, step in zip(n, h)], indexing="ij")
    p, q1, q2 = fields["pressure"], fields["q1"], fields["q2"]
    contact = p > 0.0
    area = h[0] * h[1]
    elastic = Elasticity(n, h, compliances(scene), layer_of(scene))
    bound = friction_bound(scene["contact"], p, beside)
    carried = bound.sum() * area
    load = row["normal_load"]
    steps = scene.get("step", [])
    history = bool(steps) or scene.get("cycles", 1) > 1
    coupling = scene["contact"].get("coupling", "auto")

    found["pressure"] = max(0.0, -p.min() / p.max())
    found["load"] = abs(p.sum() * area / load - 1.0)
    # On a mesh Hertz's pressure does not carry exactly the load.
    if not history and not scene["contact"].get("pressure", "solved").startswith("hertz"):
        found["load"] = max(found["load"], abs(p.sum() * area / scene["load"]["normal"] - 1.0))
    found["bound"] = max(0.0, (np.hypot(q1, q2) - bound).max() / bound.max())
    moment = ((x * q2 - y * q1).sum()) * area
    limit = row["moment_limit"] or math.inf  # a single cell carries no moment, and need not
    found["moment"] = abs(moment - row["moment"]) / limit
    found["force"] = math.hypot(q1.sum() * area - row["force"][0], q2.sum() * area - row["force"][1]) / carried
    if not history:
        asked = scene["load"]
        if "force" in asked and "displacement" not in asked:
            missed = math.hypot(row["force"][0] - asked["force"][0], row["force"][1] - asked["force"][1])
            found["force"] = max(found["force"], missed / carried)
        by_ratio = "moment_ratio" in asked and "twist" not in asked and "moment" not in asked
        if by_ratio and row["moment_limit"]:
            found["moment"] = max(found["moment"], abs(row["moment"] / limit - asked["moment_ratio"]))

    if any("layer" in scene[body] for body in ("upper", "lower")):
        return found  # no kernel of a coated body stands here: its exact answers judge it, convergence/oracle/

    # Tractions to displacements; the slip is the residual of the closest rigid motion.
    u1 = elastic.displacement("11", q1) + elastic.displacement("12", q2)
    u2 = elastic.displacement("12", q1) + elastic.displacement("22", q2)
    size = max(np.abs(u1[contact]).max(), np.abs(u2[contact]).max())
    if size == 0.0:  # one cell that carries nothing: there is no slip
        found["slip"] = max(np.abs(fields["slip1"]).max(), np.abs(fields["slip2"]).max()) / h[0]
    else:
        moved1, moved2 = moved(elastic, coupling, fields)
        if "before" in row:  # a step's slip is measured from the state before
            before = fields_of(folder / row["before"], n, h)
            moved1, moved2 = (now - then for now, then in zip((moved1, moved2), moved(elastic, coupling, before)))
        size = max(size, np.abs(moved1[contact]).max())
        motion, left = rigid_motion((moved1 - fields["slip1"], moved2 - fields["slip2"]), x, y, contact)
        found["slip"] = max(np.abs(left[0][contact]).max(), np.abs(left[1][contact]).max()) / size
        slip1 = np.where(contact, fields["slip1"] + left[0], 0.0)
        slip2 = np.where(contact, fields["slip2"] + left[1], 0.0)
        gap = slip1 * q1 + slip2 * q2 + bound * np.hypot(slip1, slip2)
        energy = 0.5 * (q1 * u1 + q2 * u2).sum()
        # A displacement is known to some units of rounding of the largest: a far cell's coefficient is a difference of
        # corner values that are larger by the square of its distance in cells.
        noise = max(16.0, max(contact.shape) ** 2 / 4) * np.finfo(float).eps * size * bound.sum() / energy
        allowed = max(row["tolerance"], row["certificate.rounding"] or 0.0, noise)
        found["gap"] = abs(gap.sum()) / energy / allowed

    g0 = undeformed_gap(scene["upper"], x, y)
    if scene["contact"].get("pressure", "solved") == "solved" and g0 is not None:
        u3 = elastic.displacement("33", p)
        if coupling == "full":
            u3 = u3 - elastic.displacement("13", q1) - elastic.displacement("23", q2)
        surfaces = g0 + u3
        approach = surfaces[contact].mean()
        scale = abs(approach - g0.min()) or 1.0
        found["gap_in_contact"] = np.abs(surfaces[contact] - approach).max() / scale
        if not contact.all():
            found["overlap"] = max(0.0, (approach - surfaces[~contact]).max() / scale)
    return found


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    arguments.add_argument("result", type=pathlib.Path, help="what slipstick hard --json has written")
    arguments.add_argument("--every", type=int, default=1, help="audit each N-th case")
    arguments.add_argument("--folder", type=pathlib.Path, default=pathlib.Path.cwd(), help="that its paths start from")
    options = arguments.parse_args()
    rows = [row for row in json.loads(options.result.read_text())["rows"] if "written" in row]
    worst = dict.fromkeys(ALLOWED, (0.0, "-"))
    wrong = 0
    for row in rows[:: options.every]:
        name = f"{row['family']} {row['case']}"
        for key, measured in audit(row, options.folder).items():
            if not measured <= worst[key][0]:
                worst[key] = (measured, name)
            if not measured <= ALLOWED[key]:
                wrong += 1
                print(f"wrong: {name}: {key} is {measured:.3g}, allowed {ALLOWED[key]:g}")
    print(f"{len(rows[:: options.every])} cases audited, {wrong} findings; the worst of each:")
    for key, (measured, name) in worst.items():
        print(f"  {key:15} {measured:9.2e}  allowed {ALLOWED[key]:7.0e}  {name}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
