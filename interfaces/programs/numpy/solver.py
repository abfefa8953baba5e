"""Pressure and tractions of a scene by accelerated projected gradients: a minimal solver."""
import json
import pathlib
import sys
import time

import numpy as np


def influence(scene, formula):
    """The transform of a kernel on twice the cells: displacement (m) by unit traction (Pa) on one cell."""
    (n1, n2), (h1, h2) = scene["cells"], scene["cell_size"]
    x = np.fft.fftfreq(2 * n1, 1 / (2 * n1))[:, None] * h1
    y = np.fft.fftfreq(2 * n2, 1 / (2 * n2))[None, :] * h2
    corners = ((1, 1), (1, -1), (-1, 1), (-1, -1))
    return np.fft.rfft2(sum(a * b * formula(x + a * h1 / 2, y + b * h2 / 2) for a, b in corners))


def convolved(kernel, field):
    n1, n2 = field.shape
    return np.fft.irfft2(kernel * np.fft.rfft2(field, (2 * n1, 2 * n2)), (2 * n1, 2 * n2))[:n1, :n2]


def minimise(apply, linear, project, q, tolerance, most=2000):
    """Minimises q.Kq/2 + linear.q over the set of project(), with momentum that restarts when the energy rises."""
    v = np.random.default_rng(0).standard_normal(q.shape)
    for _ in range(30):
        v = apply(v / np.linalg.norm(v))
    step = 0.9 / np.linalg.norm(v)  # over the largest eigenvalue
    ahead, t = q, 1.0
    for iteration in range(1, most + 1):
        new = project(ahead - step * (apply(ahead) + linear), step)
        if np.linalg.norm(new - ahead) <= tolerance * np.linalg.norm(new):
            break
        t = 1.0 if np.sum((ahead - new) * (new - q)) > 0 else (1 + np.sqrt(1 + 4 * t * t)) / 2
        ahead, q = new + max(0.0, 1 - 1.5 / t) * (new - q), new
    return new, iteration, iteration < most


def pressure_of(scene, shape):
    contact, load = scene["combined"]["contact_modulus"], scene["load"]["normal"] / np.prod(scene["cell_size"])
    k33 = influence(scene, lambda x, y: (y * np.arcsinh(x / abs(y)) + x * np.arcsinh(y / abs(x))) / (np.pi * contact))

    def project(p, _):  # on p >= 0 with the sum `load`
        ordered = np.sort(p, axis=None)[::-1]
        excess = (np.cumsum(ordered) - load) / np.arange(1, p.size + 1)
        return np.maximum(p - excess[np.flatnonzero(ordered > excess)[-1]], 0.0)

    return minimise(lambda p: convolved(k33, p), shape, project, np.zeros(shape.shape), 1e-9)[0]


def tractions_of(scene, pressure):
    g, nu = 2 * np.pi * scene["combined"]["shear_modulus"], scene["combined"]["poisson_ratio"]
    k11 = influence(scene, lambda x, y: (y * np.arcsinh(x / abs(y)) + (1 - nu) * x * np.arcsinh(y / abs(x))) / g)
    k22 = influence(scene, lambda x, y: ((1 - nu) * y * np.arcsinh(x / abs(y)) + x * np.arcsinh(y / abs(x))) / g)
    k12 = influence(scene, lambda x, y: -nu * np.hypot(x, y) / g)
    x1, x2 = np.meshgrid(scene["x1"], scene["x2"], indexing="ij")
    one, size, bound = np.ones(x1.shape), np.max(abs(x1)), scene["friction"] * pressure
    motions = [np.stack(m) for m in ((one, 0 * one), (0 * one, one), (-x2 / size, x1 / size))]
    loads = np.array([*scene["load"]["force"], scene["load"]["moment"] / size]) / np.prod(scene["cell_size"])
    motion = np.zeros(3)  # two displacements, and the twist times `size`

    def apply(q):
        return np.stack([convolved(k11, q[0]) + convolved(k12, q[1]), convolved(k12, q[0]) + convolved(k22, q[1])])

    def state(y, step, motion):
        moved = y + step * np.tensordot(motion, motions, 1)
        size = np.maximum(np.hypot(*moved), 1e-300)
        held = np.minimum(size, bound)
        return moved, held / size, np.sum(held * (size - held / 2)) - step * loads @ motion

    def project(y, step):  # on |q| <= bound under these loads: Newton's method on the motion, damped
        for _ in range(50):
            moved, shrink, energy = state(y, step, motion)
            missing = loads - np.array([np.sum(shrink * moved * m) for m in motions])
            if np.max(abs(missing)) <= 1e-13 * np.sum(bound):
                break
            slips = shrink * (shrink < 1) / np.maximum(np.sum(moved**2, axis=0), 1e-300)
            change = [shrink * m - slips * np.sum(moved * m, axis=0) * moved for m in motions]
            matrix = np.array([[np.sum(m * c) for c in change] for m in motions])
            along = np.linalg.solve(matrix + 1e-12 * np.trace(matrix) * np.eye(3), missing) / step
            while state(y, step, motion + along)[2] > energy + 1e-12 * abs(energy):
                along /= 2
            motion[:] += along
        return shrink * moved

    q, iterations, converged = minimise(apply, 0.0, project, np.zeros((2, *x1.shape)), 0.1 * scene["tolerance"])
    return q, {"twist_angle": motion[2] / size, "iterations": iterations, "converged": bool(converged)}


scene_file, field_file, numbers_file = map(pathlib.Path, sys.argv[1:])
scene = json.loads(scene_file.read_text())
if scene["combined"]["mismatch"] or scene["layer"] or not {"moment", "force"} <= set(scene["load"]):
    sys.exit(3)  # not a scene for this solver
start = time.perf_counter()
gap = np.minimum(np.load(scene_file.parent / scene["gap"]), 1.0)
pressure = np.load(scene_file.parent / scene["pressure"]) if scene["pressure"] else pressure_of(scene, gap)
q, numbers = tractions_of(scene, pressure)
numbers_file.write_text(json.dumps({"seconds": time.perf_counter() - start, **numbers}))
x1, x2 = np.meshgrid(scene["x1"], scene["x2"], indexing="ij")
rows = np.column_stack([f[pressure > 0] for f in (x1, x2, pressure, q[0], q[1])])
np.savetxt(field_file, rows, "%.17g", ",", header="x1,x2,pressure,q1,q2", comments="")
