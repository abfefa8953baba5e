"""Shared code of the adapters for finite-element programs: meshes of two bodies in contact, files of contact fields, the command.
Units: mm, N, MPa, rad, the usual ones of such programs. The axis is z, the lower body lies below z = 0, the upper one touches it
at the origin and carries load and moment."""

import argparse
import json
import resource
import sys
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Optional

import numpy as np


class Sphere:
    """The scene: a sphere on a flat body of its own material (mm, N, MPa)."""

    def __init__(self, file):
        scene = tomllib.loads(Path(file).read_text())
        body, lower = scene["upper"], scene["lower"]
        if body.get("shape") != "sphere" or any(body[key] != lower[key] for key in ("young_modulus", "poisson_ratio")):
            raise SystemExit(f"{file}: not a sphere on its own material; allowed: one, as convergence/scenes/paper.toml")
        self.radius, self.young, self.poisson = 1e3 * body["radius"], 1e-6 * body["young_modulus"], body["poisson_ratio"]
        self.load, self.friction = scene["load"]["normal"], scene["contact"]["friction"]
        stiffness = self.young / (1 - self.poisson**2) / 2
        self.contact_radius = (0.75 * self.load * self.radius / stiffness) ** (1 / 3)
        self.approach = self.contact_radius**2 / self.radius
        self.limit = 3 * np.pi / 16 * self.friction * self.load * self.contact_radius


def spacing(size, fine, length, growth):
    """Coordinates from 0 to length: steps of this size up to `fine`, then each step is `growth` times its neighbour, nearly."""
    steps = [size] * int(np.ceil(fine / size - 1e-9))
    while sum(steps) < length:
        steps.append(steps[-1] * growth)
    steps = np.array(steps)
    coarse = np.arange(len(steps)) >= int(np.ceil(fine / size - 1e-9))
    steps[coarse] *= (length - steps[~coarse].sum()) / steps[coarse].sum()
    return np.concatenate([[0], np.cumsum(steps)])


@dataclass
class Plan:
    """The mesh seen along the axis: points (n, 2) mm, arrays of faces of 3 or 4 nodes, counter-clockwise; `rim`: the points at the
    bodies' end. `pairs` (m, 2) of a sector: a point of the first cut face, and the point of the other one that it becomes when it
    is turned by the sector's angle; point 0 is the axis."""

    points: np.ndarray
    faces: list
    rim: np.ndarray
    pairs: np.ndarray
    sectors: int = 1

    @property
    def angle(self):
        return 2 * np.pi / self.sectors

    def centres(self):
        return np.vstack([self.points[faces].mean(axis=1) for faces in self.faces])

    def areas(self):
        """The areas (mm^2) of the faces."""
        corners = [self.points[faces] for faces in self.faces]
        following = [np.roll(each, -1, axis=1) for each in corners]
        doubled = [a[..., 0] * b[..., 1] - b[..., 0] * a[..., 1] for a, b in zip(corners, following)]
        return np.concatenate([each.sum(axis=1) / 2 for each in doubled])

    def within(self, radius):
        """The part with centres of faces in this radius."""
        faces = [each[np.hypot(*self.points[each].mean(axis=1).T) < radius] for each in self.faces]
        return replace(self, faces=faces)


def sector(radii, sectors=36, facets=2):
    """The part of the circle between the angles 0 and 2 pi/sectors."""
    angles = np.arange(facets + 1) * 2 * np.pi / (sectors * facets)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = np.vstack([[[0, 0]], (radii[1:, None, None] * circle).reshape(-1, 2)])
    place = 1 + np.arange(len(points) - 1).reshape(-1, facets + 1)
    triangles = np.column_stack([np.zeros(facets, int), place[0, :-1], place[0, 1:]])
    quads = np.stack([place[:-1, :-1], place[1:, :-1], place[1:, 1:], place[:-1, 1:]], -1).reshape(-1, 4)
    return Plan(points, [triangles, quads], place[-1], place[:, [0, -1]], sectors)


def o_grid(radii, core):
    """The whole circle: a block of 2 core x 2 core faces about the axis, and rings of faces round it. Between the axis and twice the
    block's size squares become circles."""
    around = np.arange(-core, core)
    border = np.array([turned for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1)) for turned in
                       zip(core * x - around * y, core * y + around * x)])
    inside = np.stack(np.meshgrid(*2 * [np.arange(1 - core, core)], indexing="ij"), -1).reshape(-1, 2)
    level = abs(inside).max(axis=1)
    level = np.concatenate([level, np.repeat(np.arange(core, len(radii)), len(border))])
    corner = np.vstack([inside / np.maximum(level[:len(inside), None], 1), *(len(radii) - core) * [border / core]])
    circle = np.tan(np.pi / 4 * corner) / np.maximum(np.hypot(*np.tan(np.pi / 4 * corner).T), 1)[:, None]
    part = np.minimum(radii[level] / radii[core] / 2, 1)[:, None]
    points = radii[level][:, None] * ((1 - part) * 0.9 * corner + part * circle)
    block = np.zeros((2 * core + 1, 2 * core + 1), int)
    block[1:-1, 1:-1] = np.arange(len(inside)).reshape(2 * core - 1, -1)
    rings = len(inside) + np.arange(len(points) - len(inside)).reshape(-1, len(border))
    block[tuple(border.T + core)] = rings[0]
    cells = [np.stack([block[:-1, :-1], block[1:, :-1], block[1:, 1:], block[:-1, 1:]], -1).reshape(-1, 4)]
    following = np.roll(rings, -1, axis=1)
    cells.append(np.stack([rings[:-1], rings[1:], following[1:], following[:-1]], -1).reshape(-1, 4))
    return Plan(points, [np.vstack(cells)], rings[-1], np.zeros((0, 2), int))


@dataclass
class Body:
    """Layers of elements between a contact face and the far end. nodes (layers + 1, points, 3) mm; elements: arrays of indices,
    wedges and hexahedra, those at the contact face first; `driven`: indices of the nodes at the end and at the rim."""

    nodes: np.ndarray
    elements: list
    driven: np.ndarray


def extruded(plan, depth, surface, upper):
    """The plan's body from `surface` (z of each point of the plan, mm) to the depths (mm from the surface's plane), up or down."""
    share = depth[:, None] / depth[-1]
    z = surface + share * (depth[-1] - surface) if upper else surface - depth[:, None]
    nodes = np.concatenate([np.broadcast_to(plan.points, (*z.shape, 2)), z[..., None]], axis=2)
    count = len(plan.points)
    layers = count * np.arange(len(depth) - 1)[:, None, None]
    elements = []
    for faces in plan.faces:
        near, far = faces + layers, faces + layers + count
        elements.append(np.concatenate([near, far] if upper else [far, near], axis=2).reshape(-1, 2 * faces.shape[1]))
    driven = np.union1d(np.arange(count) + count * (len(depth) - 1), (plan.rim + layers[:, 0]).ravel())
    return Body(nodes, elements, driven)


@dataclass
class ContactFaces:
    """The answer of a program on the contact faces of a plan, on the lower body (MPa). `means` (faces, 3): pressure, q1, q2, means
    over faces, or None. `nodal`: names with arrays (points,) or, of vectors, (points, 2)."""

    plan: Plan
    means: Optional[np.ndarray]
    nodal: dict

    def all_round(self):
        """The field of a sector, turned into the whole circle."""
        plan, count = self.plan, self.plan.sectors
        used = np.unique(np.concatenate([faces.ravel() for faces in plan.faces]))
        kept = np.setdiff1d(used, [0, *plan.pairs[:, 1]])
        number = np.zeros((len(plan.points), count), int)  # of each point in each sector
        number[kept] = 1 + np.arange(len(kept) * count).reshape(-1, count)
        number[plan.pairs[:, 1]] = np.roll(number[plan.pairs[:, 0]], -1, axis=1)
        turns = turning(plan.angle * np.arange(count))

        def of_points(values):
            if values.ndim == 1:
                return np.concatenate([values[:1], np.repeat(values[kept], count)])
            return np.vstack([values[:1] @ turns.mean(axis=0).T, np.einsum("sij,nj->nsi", turns, values[kept]).reshape(-1, 2)])

        faces = [number[each].transpose(0, 2, 1).reshape(-1, each.shape[1]) for each in plan.faces]
        whole = Plan(of_points(plan.points), faces, plan.rim, plan.pairs[:0])
        means = self.means
        if means is not None:
            shear = np.einsum("sij,nj->nsi", turns, means[:, 1:]).reshape(-1, 2)
            means = np.column_stack([np.repeat(means[:, 0], count), shear])
        return ContactFaces(whole, means, {name: of_points(values) for name, values in self.nodal.items()})

    def over_nodal_areas(self):
        """Forces at nodes over the areas of the nodes, which share each face equally."""
        corners = [faces.ravel() for faces in self.plan.faces]
        parts = np.split(self.plan.areas(), np.cumsum([len(faces) for faces in self.plan.faces])[:-1])
        shares = [np.repeat(part / faces.shape[1], faces.shape[1]) for part, faces in zip(parts, self.plan.faces)]
        areas = np.bincount(np.concatenate(corners), np.concatenate(shares), len(self.plan.points))
        return replace(self, nodal={name: (values.T / np.where(areas > 0, areas, 1)).T for name, values in self.nodal.items()})

    def write(self, file):
        """VTK's XML of an unstructured grid (.vtu) with all arrays; vectors as two arrays, NAME1 and NAME2."""
        faces = [each for each in self.plan.faces if len(each)]
        used, cells = np.unique(np.concatenate([each.ravel() for each in faces]), return_inverse=True)
        sizes = np.concatenate([np.full(len(each), each.shape[1]) for each in faces])
        columns = {}
        for name, values in self.nodal.items():
            columns |= {name: values[used]} if values.ndim == 1 else {f"{name}{k + 1}": values[used, k] for k in (0, 1)}
        means = {} if self.means is None else dict(zip(("pressure", "q1", "q2"), self.means.T))
        points = np.column_stack([self.plan.points[used], np.zeros(len(used))])

        def section(tag, arrays, kind="Float64"):
            text = f"<{tag}>\n"
            for name, values in arrays.items():
                parts = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
                rows = " ".join(("%d" if kind == "Int64" else "%.10g") % each for each in values.ravel())
                text += f'<DataArray type="{kind}" Name="{name}"{parts} format="ascii">{rows}</DataArray>\n'
            return text + f"</{tag}>\n"

        topology = {"connectivity": cells.ravel(), "offsets": np.cumsum(sizes), "types": np.where(sizes == 3, 5, 9)}
        Path(file).write_text(
            '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">\n<UnstructuredGrid>\n'
            f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(sizes)}">\n' + section("Points", {"Points": points})
            + section("Cells", topology, "Int64") + section("PointData", columns) + section("CellData", means)
            + "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")


def turning(angles):
    """Matrices (n, 2, 2) that turn vectors by these angles."""
    cos, sin = np.cos(angles), np.sin(angles)
    return np.stack([np.stack([cos, -sin], axis=-1), np.stack([sin, cos], axis=-1)], axis=-2)


def main(version, solve, options=None):
    """The command of an adapter: SCENE FOLDER FACES [RATIO ...] solves on a mesh with this number of faces across the contact radius
    for these parts of the limit moment. It writes FOLDER/RATIO.vtu (mm, MPa) and FOLDER/numbers.json: rotations (rad), CPU seconds
    and the words that `slipstick check` needs. solve(sphere, arguments) returns these words, and rotation and faces of each part."""
    if sys.argv[1:] == ["--version"]:
        print(version())
        return
    parser = options or argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("folder", type=Path)
    parser.add_argument("faces", type=int)
    parser.add_argument("ratios", type=float, nargs="*", default=[0.5, 0.9])
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    sphere, twists = Sphere(arguments.scene), {}
    check, answers = solve(sphere, arguments)
    for ratio, (twist, faces) in zip(arguments.ratios, answers):
        faces.write(arguments.folder / f"{ratio:g}.vtu")
        twists[f"{ratio:g}"] = twist
        used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        numbers = {"twist_angle": twists, "cpu_seconds": sum(each.ru_utime + each.ru_stime for each in used), "check": check}
        (arguments.folder / "numbers.json").write_text(json.dumps(numbers, indent=1))
        print(f"{ratio:g} of the limit moment: rotation {twist:.6e} rad, {numbers['cpu_seconds']:.0f} CPU seconds so far")
