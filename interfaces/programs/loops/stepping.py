"""Drives a simulator along a path, by steps of equal time.

An engine is one sphere at rest on the ground, of a given mass in kg, that can move along the first axis of the plane and turn about the
normal. It has `step_size`, and step(normal_load, moment, force), which takes one step under these loads and returns twist and displacement
so far."""

import numpy as np

STEP = 1e-6  # s, of granular programs
SETTLED = 3000  # steps until it rests
LIGHT, HEAVY = 1.0, 1000.0  # kg; a heavy one keeps its rate against friction


def stepped(engine, sphere, *arguments):
    """The responses of a simulator, with a new engine for each run: of motions to loads; if `moves`, of loads to motions."""
    def respond(path, moves):
        mass = HEAVY if moves else LIGHT
        return _respond(engine(sphere, mass, *arguments), path, np.array([0.4 * mass * sphere.radius**2, mass]) if moves else None)
    return respond


def _respond(engine, path, inertias):
    size = engine.step_size
    for _ in range(SETTLED):
        start = np.array(engine.step(float(path.normal_load[0]), 0.0, 0.0))
    ends = np.rint(path.time / size).astype(int)
    times = size * np.arange(1, ends[-1] + 1)

    def columns(names, at):
        return np.column_stack([np.interp(at, path.time, getattr(path, name)) for name in names])
    loads = columns(["normal_load"], times)[:, 0].tolist()
    if inertias is None:
        given = columns(("moment", "force"), times)
        found = [np.array(engine.step(load, *one)) - start for load, one in zip(loads, given.tolist())]
    else:
        given = np.diff(columns(("twist", "displacement"), np.append(0.0, times)), axis=0) / size
        found = [*_moved(engine, loads, given, start, inertias)]
    rows = np.array([np.zeros(2), *found])[ends].T
    return dict(zip(("twist", "displacement") if inertias is None else ("moment", "force"), rows))


def _moved(engine, loads, rates, at, inertias):
    """The loads that the contact takes: loads that keep the rates, less inertia."""
    now = np.zeros(2)
    for load, rate in zip(loads, rates):
        pushed = 0.5 * inertias / engine.step_size * (rate - now)
        reached = np.array(engine.step(load, *pushed.tolist()))
        before, now, at = now, (reached - at) / engine.step_size, reached
        yield pushed - inertias * (now - before) / engine.step_size


def turned(sphere, path):
    """For programs that impose the twist and hold two spheres at a distance: contact radius, rotation of each row in rad, and steps a row.
    Raises LookupError where the path needs more."""
    if np.ptp(path.normal_load) or path.displacement.any() or path.force.any():
        raise LookupError("its adapter imposes the twist only, at one distance")
    steps = max(1, round(10 * float(path.time[1] - path.time[0]) / path.shortest))
    radius = sphere.contact_radius * (float(path.normal_load[0]) / sphere.load)**(1 / 3)
    return radius, np.diff(path.twist).tolist(), steps
