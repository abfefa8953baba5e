"""Reference fields of 20 scenes without exact solution: on a grid, extrapolated, and audited by kernels that slipstick does not
share (convergence/hard/audit.py)."""

import json
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
from tables import Table, row

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "hard"))
import audit  # noqa: E402

FIELDS = {"pressure": "Pa", "q1": "Pa", "q2": "Pa", "slip1": "m", "slip2": "m", "stick": "1"}
SMOOTH = ("pressure", "q1", "q2")
ORDER = 2  # of the extrapolation: halving the cells leaves a quarter of the error where a field is smooth
STEEL = "young_modulus = 210e9\npoisson_ratio = 0.3"
ALUMINIUM = "young_modulus = 70e9\npoisson_ratio = 0.33"
SPHERE = 'shape = "sphere"\nradius = 0.018'
PARTS = 4  # steps between two corners of a load path


def ellipse(r1, r2, angle=0.0):
    return f'shape = "ellipsoid"\nradius_1 = {r1}\nradius_2 = {r2}\nangle = {angle}'


def bumps(*spheres):
    return f'combine = "nearest"\n{STEEL}\n' + "".join(
        f'[[upper.shape]]\nshape = "sphere"\nradius = {r}\nat = [{x}, {y}]\n' for r, x, y in spheres)


def rough(radius=None):
    """With a height map; without a radius a nominally flat body."""
    sphere = f"[[upper.shape]]\n{SPHERE}\n" if radius else ""
    return (f'{"" if radius else "ends_at_grid_edge = true"}\n{STEEL}\n{sphere}'
            '[[upper.shape]]\nshape = "height_map"\nfile = "MAP"\nspacing = [SPACING]\n')


def friction(coefficient, coupling="auto"):
    return f'friction = {coefficient}\ncoupling = "{coupling}"'


LONG, PAIR = ellipse(0.018, 0.0063), bumps((0.018, -0.0005, 0), (0.018, 0.0005, 0))
DRY, PULLED, FULL = friction(0.1), friction(0.3, "pressure"), friction(0.3, "full")
FLAT, ROUND, WIDE = ((1.25, 0.625), (48, 24)), ((1.1, 1.1), (48, 48)), ((1.35, 1.35), (48, 48))

# Name: upper body, lower material, contact, load or the corners of its path, (extent in mm, cells of the coarse grid), seed and rms
# height of the roughness (m). An extent is left out of rough scenes, whose map has it.
SCENES = {
    "ellipse": (LONG, STEEL, DRY, "moment_ratio = 0.5", FLAT),
    "ellipse-near-limit": (LONG, STEEL, DRY, "moment_ratio = 0.9", FLAT),
    "ellipse-turned": (ellipse(0.018, 0.0063, 0.5235987755982988), STEEL, DRY, "moment_ratio = 0.5", ((1.15, 1.15), (48, 48))),
    "ellipse-slender": (ellipse(0.036, 0.002), STEEL, DRY, "moment_ratio = 0.7", ((1.8, 0.3), (72, 12))),
    "ellipse-pushed": (LONG, STEEL, DRY, "force = [30.0, 40.0]\nmoment_ratio = 0.4", FLAT),
    "two-bumps": (PAIR, STEEL, DRY, "moment_ratio = 0.5", ((2.16, 1.08), (64, 32))),
    "two-bumps-pushed": (PAIR, STEEL, DRY, "force = [0.0, 40.0]\nmoment_ratio = 0.3", ((2.16, 1.08), (64, 32))),
    "two-bumps-unequal": (bumps((0.018, -0.0004, 0), (0.006, 0.0004, 0.0002)), STEEL, DRY, "moment_ratio = 0.7", ((2.0, 1.2), (60, 36))),
    "dissimilar": (SPHERE, ALUMINIUM, PULLED, "moment_ratio = 0.5", WIDE),
    "dissimilar-full": (SPHERE, ALUMINIUM, FULL, [(1000, 0, 0.5)], WIDE),
    "dissimilar-full-near-limit": (SPHERE, ALUMINIUM, FULL, [(1000, 0, 0.9)], WIDE),
    "dissimilar-full-ellipse": (LONG, ALUMINIUM, FULL, [(1000, 0, 0.5)], ((1.6, 0.8), (48, 24))),
    "rough-sphere": (rough(0.018), STEEL, DRY, "moment_ratio = 0.5", ((1.4, 1.4), (48, 48)), 1, 2e-7),
    "rough-sphere-pushed": (rough(0.018), STEEL, DRY, "force = [40.0, 0.0]\nmoment_ratio = 0.4", ((1.4, 1.4), (48, 48)), 2, 4e-7),
    "self-affine": (rough(), STEEL, DRY, "moment_ratio = 0.5", ((1.4, 1.4), (48, 48)), 3, 4e-6),
    "self-affine-dissimilar": (rough(), ALUMINIUM, PULLED, "moment_ratio = 0.5", ((1.4, 1.4), (48, 48)), 4, 4e-6),
    "push-then-twist": (SPHERE, STEEL, DRY, [(1000, 50, 0), (1000, 50, 0.5)], ROUND),
    "push-twist-and-back": (SPHERE, STEEL, DRY, [(1000, 50, 0), (1000, 50, 0.5), (1000, 50, -0.4)], ROUND),
    "ellipse-loop": (LONG, STEEL, DRY, [(1000, 0, 0.8), (1000, 0, -0.8), (1000, 0, 0.4)], FLAT),
    "pressed-while-pushed": (SPHERE, STEEL, DRY, [(600, 40, 0), (1000, 40, 0), (600, 40, 0), (600, 40, 0.3)], ROUND),
}
# Scenes of fclib/ only.
OF_PROBLEMS = {
    "sphere": (SPHERE, STEEL, DRY, "moment_ratio = 0.5", ROUND),
    "sphere-pushed": (SPHERE, STEEL, DRY, "force = [40.0, 15.0]\nmoment_ratio = 0.6", ROUND),
    "dissimilar-step": (SPHERE, ALUMINIUM, FULL, "moment_ratio = 0.5", WIDE),
    "ellipse-square": (LONG, STEEL, DRY, "moment_ratio = 0.9", ((1.25, 1.25), (48, 48))),
}


def load_path(corners):
    """Steps of a path of (normal load, force along x1, moment ratio), the first from no shear at the first normal load."""
    steps, before = f"[load]\nnormal = {corners[0][0]}.0\n", (corners[0][0], 0, 0)
    for corner in corners:
        for part in range(1, PARTS + 1):
            normal, force, moment = (a + (b - a) * part / PARTS for a, b in zip(before, corner))
            steps += f"[[step]]\nnormal = {normal!r}\nforce = [{force!r}, 0.0]\nmoment_ratio = {moment!r}\n"
        before = corner
    return steps


def heights(x, y, seed, rms):
    """A self-affine surface (Hurst exponent 0.8, wavelengths 1.4 mm over 2 to 10): a sum of waves, so that every grid samples the same
    surface."""
    draw, total, variance = np.random.RandomState(seed), np.zeros_like(x), 0.0  # its stream is fixed for all versions of NumPy
    for k1, k2 in np.ndindex(21, 11):
        k1, phase = k1 - 10, 2 * np.pi * draw.random_sample()
        k = np.hypot(k1, k2)
        if 2 <= k <= 10 and (k2 > 0 or k1 > 0):
            total += k**-1.8 * np.cos(2 * np.pi / 1.4e-3 * (k1 * x + k2 * y) + phase)
            variance += k**-3.6 / 2
    return rms / np.sqrt(variance) * total


class Scene:
    """A scene on a grid with `finer` times the cells, in a folder."""

    def __init__(self, name, finer, folder, tolerance=1e-11):
        upper, lower, contact, load, (extent, cells), *self.roughness = {**SCENES, **OF_PROBLEMS}[name]
        self.name, self.n = name, [int(finer * n) for n in cells]
        self.h = [1e-3 * length / n for length, n in zip(extent, self.n)]
        self.x, self.y = np.meshgrid(*[(np.arange(n) - 0.5 * (n - 1)) * h for n, h in zip(self.n, self.h)], indexing="ij")
        upper = upper.replace("MAP", f"{name}-{self.n[0]}.csv").replace("SPACING", f"{self.h[0]!r}, {self.h[1]!r}")
        if STEEL not in upper:
            upper += "\n" + STEEL
        size = "" if self.roughness else f"extent = [{1e-3 * extent[0]!r}, {1e-3 * extent[1]!r}]\n"
        steps = load_path(load) if isinstance(load, list) else f"[load]\nnormal = 1000.0\n{load}\n"
        self.text = (f'name = "{name}"\n[upper]\n{upper}\n[lower]\n{lower}\n[contact]\n{contact}\n{steps}'
                     f"[grid]\ncells = [{self.n[0]}, {self.n[1]}]\n{size}[solver]\ntolerance = {tolerance!r}\n")
        self.file = folder / f"{name}-{self.n[0]}.toml"
        self.file.write_text(self.text)
        if self.roughness:
            self.map = heights(self.x, self.y, *self.roughness)
            np.savetxt(folder / f"{name}-{self.n[0]}.csv", self.map, fmt="%.17g", delimiter=",")

    def gap(self, tables):
        shapes = tables["upper"]["shape"]
        if not self.roughness:
            return audit.undeformed_gap(tables["upper"], self.x, self.y)
        total = self.map + sum(audit.shape_gap(shape, self.x, self.y) for shape in shapes if shape["shape"] != "height_map")
        return total - total.min()

    def solve(self, program):
        """Result, fields of the last step, and the audit's numbers; asserts that the audit finds nothing."""
        folder, stem = self.file.parent, self.file.stem
        run = subprocess.run([program, "solve", self.file, "--fields", folder / f"{stem}-{{step}}.csv", "--quiet", "--json", "-"],
                             capture_output=True, text=True)
        if run.returncode != 0:
            raise RuntimeError(f"{self.name}: exit code {run.returncode}: {run.stderr}")
        result = json.loads(run.stdout)
        files = sorted(folder.glob(f"{stem}-*.csv"), key=lambda file: int(file.stem.rpartition("-")[2]))
        written = {"fields": files[-1].name, "cells": result["cells"], "cell_size": result["cell_size"],
                   "certificate.rounding": result["certificate"]["rounding"],
                   **{key: result[key] for key in ("normal_load", "moment", "moment_limit", "force", "tolerance")}}
        if len(files) > 1:
            written["before"] = files[-2].name
        case = {"scene": self.file.name, "set": [], "written": written}
        for key, measured in audit.audit(case, folder).items():
            if not measured <= audit.ALLOWED[key]:
                raise RuntimeError(f"{self.name}: the audit finds {key} = {measured:g}, allowed {audit.ALLOWED[key]:g}")
        fields = audit.fields_of(folder / files[-1].name, self.n, self.h)
        before = audit.fields_of(folder / files[-2].name, self.n, self.h) if len(files) > 1 else None
        return result, fields, self.recompute(audit.scene_of(case, folder), result, fields, before)

    def recompute(self, tables, result, fields, before):
        """Numbers of the result, from the fields and the audit's kernels."""
        elastic = audit.Elasticity(self.n, self.h, audit.compliances(tables), (0.0, 0.0))
        coupling, area = tables["contact"].get("coupling", "auto"), self.h[0] * self.h[1]
        moved = audit.moved(elastic, coupling, fields)
        start = [0.0, 0.0, 0.0]
        if before is not None:
            moved = [now - then for now, then in zip(moved, audit.moved(elastic, coupling, before))]
            start = [*result["steps"][-2]["displacement"], result["steps"][-2]["twist_angle"]]
        contact = fields["pressure"] > 0.0
        motion, _ = audit.rigid_motion((moved[0] - fields["slip1"], moved[1] - fields["slip2"]), self.x, self.y, contact)
        motion = [a + b for a, b in zip(start, motion)]
        u3 = elastic.displacement("33", fields["pressure"])
        if coupling == "full":
            u3 = u3 - elastic.displacement("13", fields["q1"]) - elastic.displacement("23", fields["q2"])
        bound = audit.friction_bound(tables["contact"], fields["pressure"], self.file.parent)
        self.undeformed = self.gap(tables)
        return {"twist_angle": motion[2], "displacement_1": motion[0], "displacement_2": motion[1],
                "moment": (self.x * fields["q2"] - self.y * fields["q1"]).sum() * area, "normal_load": fields["pressure"].sum() * area,
                "approach": (self.undeformed + u3)[contact].mean(),
                "dissipated": (bound * np.hypot(fields["slip1"], fields["slip2"])).sum() * area}


UNITS = {"twist_angle": "rad", "displacement_1": "m", "displacement_2": "m", "moment": "N m", "normal_load": "N", "approach": "m",
         "dissipated": "J"}


def number(result, name):
    if name.startswith("displacement"):
        return result["displacement"][int(name[-1]) - 1]
    return result[name]


def mesh_uncertainty(resolved):
    """Absolute; without the part that the length of the steps costs, which belong to the scene."""
    return resolved.get("mesh", resolved["absolute"]) or 0.0


def scene_rows(name, grids):
    """grids: of each factor, scene, result, fields, recomputed."""
    rows, size = [], {}
    for scene, result, _, again in grids.values():
        for key, unit in UNITS.items():
            value = number(result, key)
            size[key] = max(abs(number(grids[2][1], key)), 1e-9 * abs(result["approach"]) if unit == "m" else 0.0)
            floor = {"m": result["approach"], "J": 1e-6 * result["friction_force"] * result["approach"]}.get(unit, 0.0)
            tolerance = 1e-6 * max(size[key], floor)
            rows.append(row(name, "cells along x1", scene.n[0], key, value, 1e-8 * abs(value), unit, "estimated", "NumPy audit", again[key],
                            tolerance, si=1, si_unit=unit))
    for key, unit in UNITS.items():
        coarse, fine, finest = (number(grids[factor][1], key) for factor in (1, 2, 3))
        value = fine + (fine - coarse) / (2**ORDER - 1)  # as extrapolate()
        resolved = grids[2][1]["resolved"]
        stated = mesh_uncertainty(resolved) if resolved["number"] == key else 0.0
        least = 1e-8 * size[key]
        rows.append(row(name, "extrapolated to cells along x1", 0.0, key, value, max(abs(value - coarse), stated) + least, unit,
                        "estimated", "a finer grid", finest, abs(finest - fine) + least, si=1, si_unit=unit))
    return rows


def extrapolate(coarse, fine):
    """Cell means of a field, from grids with n and 2 n cells a side."""
    average = fine.reshape(len(coarse), 2, -1, 2).mean(axis=(1, 3))
    return average + (average - coarse) / (2**ORDER - 1)


def solved_scene(program, folder, name):
    grids = {}
    for factor in (1, 2, 3):
        scene = Scene(name, factor, folder)
        grids[factor] = (scene, *scene.solve(program))
    extrapolated = {}
    for key in SMOOTH:
        extrapolated[key] = extrapolate(grids[1][2][key], grids[2][2][key])
        extrapolated[key + "_uncertainty"] = np.abs(extrapolated[key] - grids[1][2][key])
    return scene_rows(name, grids), *grids[2][:3], extrapolated


def write_hdf5(file, scene, result, fields, extrapolated):
    import h5py
    def put(group, name, values, unit, dtype="f8"):
        data = group.create_dataset(name, data=values.astype(dtype), compression="gzip", shuffle=True, track_times=False)
        data.attrs["unit"] = unit
    with h5py.File(file, "w", libver="earliest", track_order=False) as h5:
        h5.attrs["scene"], h5.attrs["certificate_gap"] = scene.text, result["certificate"]["gap"]
        h5.attrs["mesh_uncertainty_of"] = result["resolved"]["number"]
        h5.attrs["mesh_uncertainty"] = mesh_uncertainty(result["resolved"])
        h5.attrs["axes"] = "x1 along the first index, x2 along the second; x3 into the lower body; q on the lower body"
        grid, coarse = h5.create_group("grid"), h5.create_group("extrapolated")
        for group, m, h in ((grid, scene.n, scene.h), (coarse, [n // 2 for n in scene.n], [2 * h for h in scene.h])):
            for name, count, step in zip(("x1", "x2"), m, h):
                put(group, name, (np.arange(count) - 0.5 * (count - 1)) * step, "m")
        put(grid, "gap", scene.undeformed, "m")
        for name, unit in FIELDS.items():
            put(grid, name, fields[name], unit, "i1" if name == "stick" else "f8")
        for name, values in extrapolated.items():
            put(coarse, name, values, "Pa", "f4" if name.endswith("uncertainty") else "f8")


def write_vtu(file, scene, fields):
    """Quadrilaterals of the fine grid in the plane x3 = 0, cell data in single precision."""
    import base64
    n1, n2 = scene.n
    corners = [(np.arange(n + 1) - 0.5 * n) * h for n, h in zip(scene.n, scene.h)]
    points = np.stack([*np.meshgrid(*corners, indexing="ij"), np.zeros((n1 + 1, n2 + 1))], axis=-1).reshape(-1, 3)
    first = (np.arange(n1)[:, None] * (n2 + 1) + np.arange(n2)).ravel()
    cells = np.column_stack([first, first + n2 + 1, first + n2 + 2, first + 1])
    def array(name, values, kind, dtype, parts=1):
        data = np.ascontiguousarray(values, dtype).tobytes()
        coded = base64.b64encode(np.uint32(len(data)).tobytes()).decode() + base64.b64encode(data).decode()
        many = f' NumberOfComponents="{parts}"' if parts > 1 else ""
        return f'<DataArray type="{kind}" Name="{name}"{many} format="binary">{coded}</DataArray>\n'
    arrays = [("Points", array("points", points, "Float32", "<f4", 3)),
              ("Cells", array("connectivity", cells, "Int32", "<i4") + array("offsets", 4 * np.arange(1, len(cells) + 1), "Int32", "<i4")
               + array("types", np.full(len(cells), 9), "UInt8", "u1")),
              ("CellData", "".join(array(name, fields[name], "Float32", "<f4") for name in FIELDS))]
    parts = "".join(f"<{name}>\n{data}</{name}>\n" for name, data in arrays)
    piece = f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">\n{parts}</Piece>'
    file.write_text('<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">\n<UnstructuredGrid>\n'
                    f"{piece}\n</UnstructuredGrid>\n</VTKFile>\n", encoding="ascii")


def make(program, output, work, small, pool):
    """Writes the fields; returns the table of the scenes' numbers and the number of cells that were audited."""
    names, rows, cells = (["ellipse"] if small else list(SCENES)), [], 0
    output.mkdir(parents=True)
    for found, scene, result, fields, extrapolated in pool.map(partial(solved_scene, str(program), work), names, chunksize=1):
        rows += found
        cells += int((fields["pressure"] > 0).sum())
        (output / f"{scene.name}.toml").write_text(scene.text)
        write_hdf5(output / f"{scene.name}.h5", scene, result, fields, extrapolated)
        write_vtu(output / f"{scene.name}.vtu", scene, fields)
        if scene.roughness:
            np.savetxt(output / scene.file.with_suffix(".csv").name, scene.map, fmt="%.17g", delimiter=",")
    about = ("Numbers of the scenes in fields/, each on three grids and extrapolated from the first two (order 2); 0 cells: the limit. "
             "dissipated is of the last step. Load steps and their parts (solver.substeps) belong to the scene.")
    return Table("scenes", "Scenes without exact solution", about, "slipstick's solver, certificate below 1e-11", rows), cells
