"""Drives a simulator along a path, by steps of equal time.

An engine is one sphere at rest on the ground, of a given mass in kg, that can move along the first axis of the plane and turn about the
normal. It has `step_size`, and step(normal_load, moment, force), which takes one step under these loads and returns twist and displacement
so far."""

from importlib.metadata import version
from importlib.util import find_spec
from types import SimpleNamespace

import numpy as np

STEP = 1e-6  # s, of granular programs
SERVO_STEPS = 40
SETTLED = 3000  # steps until it rests
LIGHT, HEAVY = 1.0, 1000.0  # kg; a heavy one keeps its rate against friction


def of_module(module, package, engine, sphere, *frictions):
    """The version of a simulator that is a Python module, and its runs: frictions have a name each, and an argument of the engine."""
    if not find_spec(module):
        raise LookupError(f"this Python has no module {module}")
    return version(package), [(name, stepped(engine, sphere, own)) for name, own in frictions]


def stepped(engine, sphere, *arguments):
    """The responses of a simulator, with a new engine for each run: motions under loads. Where the path asks for loads, the motions are
    imposed."""
    def respond(path):
        moves = not {"twist", "displacement"} & set(path.responses)
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


def at_rest(sphere, path):
    """For granular programs, which move two spheres step by step without inertia. Loads are imposed by a servo: each step moves the spheres
    by the missing loads over stiffnesses. holds: loads are imposed. given: moment and force, or increments of twist and
    displacement, a row for each row of the path but the first. steps: for each row."""
    holds = not {"moment", "force"} & set(path.responses)
    given = np.column_stack([path.moment, path.force])[1:] if holds else np.diff(np.column_stack([path.twist, path.displacement]), axis=0)
    steps = SERVO_STEPS if holds else max(1, round(10 * float(path.time[1] - path.time[0]) / path.shortest))
    return SimpleNamespace(holds=holds, given=given, steps=steps, load=path.normal_load[1:], radius=sphere.contact_radius * np.cbrt(
        path.normal_load[1:] / sphere.load))


def answered(sphere, path, found):
    """The response from rows of moment, force, twist and displacement. missed: the largest error of imposed loads over their limits."""
    names = "moment", "force", "twist", "displacement"
    whole = dict(zip(names, np.vstack([np.zeros(4), found]).T))
    if {"moment", "force"} & set(path.responses):
        return {name: whole[name] for name in names[:2]}
    missed = [np.abs(whole[name] - getattr(path, name)).max() / limit
              for name, limit in zip(names, (sphere.limit, sphere.friction * sphere.load))]
    return {**{name: whole[name] for name in names[2:]}, "missed": float(max(missed))}
