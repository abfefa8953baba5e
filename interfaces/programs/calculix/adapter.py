"""CalculiX (Dhondt, Wittig): press without friction, switch friction on, twist. C3D8 and C3D6, face-to-face contact with a linear
penalty, Coulomb's law with a stick slope; a sector of 10 degrees with cyclic conditions, or the whole circle (an O-grid)."""

import argparse
import re
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import elements  # noqa: E402

MODEL = """*MATERIAL, NAME=STEEL
*ELASTIC
{young},{poisson}
*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL
*SURFACE, NAME=SLAVE
UPPER_CONTACT, S1
*SURFACE, NAME=MASTER
LOWER_CONTACT, S2
*SURFACE INTERACTION, NAME=CONTACT
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
{penalty}
*FRICTION
{friction_while_pressing},{stick_slope}
*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE
SLAVE,MASTER
"""
STEP = """*STEP, INC=1000
{friction}*STATIC
0.25,1.,1e-5,0.25
*CONTROLS, PARAMETERS=FIELD
1e-4,1e-4
*BOUNDARY, OP=NEW
HELD,1,3
{axis}{imposed}{loads}*CONTACT FILE, FREQUENCY=1000
CDIS,CSTR
*CONTACT PRINT, FREQUENCY=1000
CSTR,CELS
*NODE PRINT, NSET=MOTION, FREQUENCY=1000
U
*END STEP
"""


class Deck:
    """The input of ccx. Nodes are numbered from 1, layer by layer, the upper body first. The last node, MOTION, has the rotation of
    the upper body's far end as its first degree of freedom and its approach as the third one; moment and load act there."""

    def __init__(self, sphere, plan, depth, penalty=1e8, stick_slope=1e8, friction_while_pressing=1e-8):
        self.sphere, self.plan = sphere, plan
        self.values = {"young": sphere.young, "poisson": sphere.poisson, "penalty": penalty, "stick_slope": stick_slope,
                       "friction_while_pressing": friction_while_pressing}
        gap = sphere.radius - np.sqrt(sphere.radius**2 - np.sum(plan.points**2, axis=1))
        self.bodies = {"UPPER": elements.extruded(plan, depth, gap, True), "LOWER": elements.extruded(plan, depth, 0 * gap, False)}
        self.per_body = len(depth) * len(plan.points)
        self.first = {"UPPER": 1, "LOWER": 1 + self.per_body}  # node
        self.motion = 1 + 2 * self.per_body
        self.reach = 1.5 * sphere.contact_radius
        self.contact = plan.within(self.reach)

    def mesh(self):
        lines, element = ["*NODE"], 1
        for name, body in self.bodies.items():
            nodes = enumerate(body.nodes.reshape(-1, 3), self.first[name])
            lines += [f"{number},{x:.12g},{y:.12g},{z:.12g}" for number, (x, y, z) in nodes]
        lines += ["*NODE, NSET=MOTION", f"{self.motion},0,0,0"]
        for name, body in self.bodies.items():
            for cells in body.elements:
                lines.append(f"*ELEMENT, TYPE=C3D{cells.shape[1]}, ELSET=ALL")
                lines += [",".join(map(str, [number, *nodes])) for number, nodes in enumerate(cells + self.first[name], element)]
                element += len(cells)
            lines += [f"*ELSET, ELSET={name}_CONTACT", *map(str, self.touching(name))]
        return [*lines, "*NSET, NSET=HELD", *map(str, self.bodies["LOWER"].driven + self.first["LOWER"])]

    def touching(self, name):
        """The elements of a body at the faces of `contact`, in their order."""
        counts = [len(cells) for cells in self.bodies[name].elements]
        starts = (1 if name == "UPPER" else 1 + sum(counts)) + np.cumsum([0, *counts])
        near = [np.hypot(*self.plan.points[faces].mean(axis=1).T) < self.reach for faces in self.plan.faces]
        return np.concatenate([start + np.flatnonzero(each) for start, each in zip(starts, near)])

    def equations(self):
        """Terms (node, degree of freedom, factor) whose sum is zero: the far end of the upper body moves as a rigid body; one cut face
        moves as the other one, turned by the sector's angle (*CYCLIC SYMMETRY MODEL is for frequencies and linear statics)."""
        count, cos, sin = len(self.plan.points), np.cos(self.plan.angle), np.sin(self.plan.angle)
        for k in self.bodies["UPPER"].driven:
            (x, y), node = self.plan.points[k % count], k + 1
            yield from ([(node, 1, 1), (self.motion, 1, y)], [(node, 2, 1), (self.motion, 1, -x)],
                        [(node, 3, 1), (self.motion, 3, -1)])
        for name, body in self.bodies.items():
            for layer in range(len(body.nodes)):
                for one, other in self.plan.pairs + layer * count:
                    if other not in body.driven:
                        one, other = one + self.first[name], other + self.first[name]
                        yield from ([(other, 1, 1), (one, 1, -cos), (one, 2, sin)],
                                    [(other, 2, 1), (one, 1, -sin), (one, 2, -cos)], [(other, 3, 1), (one, 3, -1)])

    def axis(self):
        """The nodes on the axis of a sector, which move along it."""
        nodes = np.arange(0, self.per_body, len(self.plan.points)) if self.plan.sectors > 1 else []
        return [k + self.first[name] for name, body in self.bodies.items() for k in np.setdiff1d(nodes, body.driven)]

    def text(self, moments):
        """The whole deck: two steps of pressing, then a step of twisting up to each moment (N mm)."""
        lines = self.mesh()
        for terms in self.equations():
            terms = [term for term in terms if abs(term[2]) > 1e-12]
            lines += ["*EQUATION", str(len(terms)), ",".join(f"{node},{freedom},{factor:.15g}" for node, freedom, factor in terms)]
        axis = self.axis()
        lines += ["*NSET, NSET=AXIS", *map(str, axis)] if axis else []
        steady = self.values | {"axis": "AXIS,1,2\n" if axis else "", "friction": "", "imposed": ""}
        no_turn, approach = f"{self.motion},1,1\n", f"{self.motion},3,3,{-0.9 * self.sphere.approach:.9g}\n"
        press = f"*CLOAD\n{self.motion},3,{-self.sphere.load / self.plan.sectors:.12g}\n"
        text = "\n".join(lines) + "\n" + MODEL.format(**self.values)
        text += STEP.format(**steady | {"imposed": no_turn + approach, "loads": ""})
        text += STEP.format(**steady | {"imposed": no_turn, "loads": press})
        for k, moment in enumerate(moments):
            switch = f"*CHANGE FRICTION, INTERACTION=CONTACT\n*FRICTION\n{self.sphere.friction},{self.values['stick_slope']}\n"
            twist = f"{press}{self.motion},1,{moment / self.plan.sectors:.12g}\n"
            text += STEP.format(**steady | {"friction": "" if k else switch, "loads": twist})
        return text


def tables(dat, title):
    """The tables of ccx's .dat file with this title, in their order."""
    parts = re.split(rf"^ *{re.escape(title)}.*\n\n", dat, flags=re.M)[1:]
    return [np.array([line.split() for line in part.split("\n\n")[0].splitlines()], float) for part in parts]


def face_means(deck, stress, energy):
    """Means (faces, 3) of pressure, q1, q2 (MPa): the forces of the integration points over the face's area. ccx prints no areas of
    points, but the energies of their springs; CalculiX 2.20 counts friction's spring twice, so the load is right with that."""
    element, p, q = stress[:, 0].astype(int), stress[:, 2], stress[:, 3:]
    per_area = p**2 / deck.values["penalty"] / 2 + np.sum(q**2, axis=1) / deck.values["stick_slope"]
    area = energy[:, 2] / np.where(per_area > 0, per_area, 1)
    slaves = deck.touching("UPPER")
    forces = [np.bincount(element, area * each, slaves.max() + 1)[slaves] for each in (p, *q.T)]
    return np.stack(forces, axis=1) / deck.contact.areas()[:, None]


def nodal_values(frd, points):
    """The contact values of each step at the first nodes (.frd file), which it extrapolates from the integration points."""
    for block in frd.split(" -4  CONTACT")[1:]:
        rows = re.findall(r"^ -1 *(\d+)((?:.{12}){6})$", block.split("\n -3")[0], re.M)
        values = np.zeros((points, 6))
        for node, text in rows[:points]:
            values[int(node) - 1] = [float(text[k:k + 12]) for k in range(0, 72, 12)]
        yield {"COPEN": values[:, 0], "CSLIP": values[:, 1:3], "CPRESS": values[:, 3], "CSHEAR": values[:, 4:]}


def run(deck, moments, folder):
    """Runs ccx in the folder; yields the rotation (rad) and the faces of each moment (N mm)."""
    (folder / "deck.inp").write_text(deck.text(moments))
    with open(folder / "log.txt", "w") as log:
        done = subprocess.run(["ccx", "-i", "deck"], cwd=folder, stdout=log, stderr=subprocess.STDOUT)
    dat = (folder / "deck.dat").read_text()
    motions = tables(dat, "displacements")
    if done.returncode or len(motions) != 2 + len(moments):
        raise SystemExit(f"ccx ended with code {done.returncode} after {len(motions)} of {2 + len(moments)} steps: see {log.name}")
    nodal = nodal_values((folder / "deck.frd").read_text(), len(deck.plan.points))
    steps = zip(motions, tables(dat, "contact stress"), tables(dat, "contact print energy"), nodal)
    for motion, stress, energy, values in list(steps)[2:]:
        faces = elements.ContactFaces(deck.contact, face_means(deck, stress, energy), values)
        yield motion[0, 1], faces if deck.plan.sectors == 1 else faces.all_round()


def solve(sphere, arguments):
    radius, far = sphere.contact_radius, 8 * sphere.contact_radius
    radii = elements.spacing(radius / arguments.faces, 1.1 * radius, far, arguments.growth)
    depth = elements.spacing(radius / arguments.faces, 0.25 * radius, far, arguments.growth)
    plan = elements.o_grid(radii, arguments.faces // 2) if arguments.circle else elements.sector(radii)
    deck = Deck(sphere, plan, depth, arguments.penalty, arguments.stick_slope, arguments.friction_while_pressing)
    check = ["--stick-slope", 1e9 * arguments.stick_slope, "--normal-stiffness", 1e9 * arguments.penalty, "--held-at", 1e-3 * far]
    return check, run(deck, [ratio * sphere.limit for ratio in arguments.ratios], arguments.folder)


def version():
    said = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout
    return "CalculiX " + re.search(r"Version (\S+)", said)[1]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--circle", action="store_true", help="the whole circle instead of a sector")
    parser.add_argument("--stick-slope", type=float, default=1e8, help="MPa/mm")
    parser.add_argument("--penalty", type=float, default=1e8, help="MPa/mm")
    parser.add_argument("--friction-while-pressing", type=float, default=1e-8, help="for its mistake: the scene's")
    parser.add_argument("--growth", type=float, default=1.25, help="from element to element away from the contact")
    elements.main(version, solve, parser)
