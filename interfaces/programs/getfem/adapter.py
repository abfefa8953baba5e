"""GetFEM (Renard, Poulios and others): linear hexahedra and prisms of two bodies that touch node by node, Lagrange multipliers with
Alart and Curnier's augmentation; pressed without friction, then twisted with friction. A sector of 10 degrees with cyclic
conditions."""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import elements  # noqa: E402

APART = 1.0  # mm between the meshes of the bodies: GetFEM merges points that coincide
LOWER, UPPER = 1, 2  # regions: the far ends of the bodies
HEXAHEDRA = ("GT_QK(3,1)", "FEM_QK(3,1)", "IM_HEXAHEDRON(5)", [0, 1, 3, 2, 4, 5, 7, 6])
PRISMS = ("GT_PRISM(3,1)", "FEM_PK_PRISM(3,1)", "IM_PRODUCT(IM_TRIANGLE(4),IM_GAUSS1D(4))", range(6))


class Problem:
    """Both bodies, flat with the sphere's gap between them, in one mesh and one field u (mm). `motion`: the rotation (rad) and the approach (mm) of the upper body's far end,
    where moment and load act. Multipliers are forces (N) between the pairs of nodes that may touch."""

    def __init__(self, sphere, plan, depth):
        import getfem
        from scipy.spatial import cKDTree
        getfem.util_trace_level(0)
        self.getfem, self.sphere, self.plan = getfem, sphere, plan
        gap = sphere.radius - np.sqrt(sphere.radius**2 - np.sum(plan.points**2, axis=1))
        self.bodies = [elements.extruded(plan, depth, 0 * gap, upper) for upper in (True, False)]
        self.bodies[1].nodes[..., 2] -= APART
        mesh = getfem.Mesh("empty", 3)
        self.space, self.points = getfem.MeshFem(mesh, 3), getfem.MeshIm(mesh)
        for body in self.bodies:
            for (shape, functions, rule, order), cells in zip((PRISMS, HEXAHEDRA), body.elements):
                corners = body.nodes.reshape(-1, 3)[cells[:, order]]
                added = mesh.add_convex(getfem.GeoTrans(shape), corners.transpose(2, 1, 0))
                self.space.set_fem(getfem.Fem(functions), added)
                self.points.set_integ(getfem.Integ(rule), added)
        mark_ends(mesh, plan.points[plan.rim], depth[-1])
        tree = cKDTree(self.space.basic_dof_nodes()[:, ::3].T)
        self.freedom = [3 * tree.query(body.nodes.reshape(-1, 3))[1] for body in self.bodies]  # the first of a node's three
        self.contact = plan.within(1.2 * sphere.contact_radius)
        used = np.unique(np.concatenate([faces.ravel() for faces in self.contact.faces]))
        self.touching = np.setdiff1d(used, plan.pairs[:, 1])
        self.gap = gap[self.touching]
        self.guess = np.sqrt(np.maximum(1 - 2 * self.gap / sphere.approach, 0))  # Hertz's pressure, for the start

    def ties(self):
        """The matrix of the equations that turn one cut face into the other one and keep the axis on itself."""
        cos, sin = np.cos(self.plan.angle), np.sin(self.plan.angle)
        rows = []
        for body, freedom in zip(self.bodies, self.freedom):
            for layer in range(len(body.nodes)):
                start = layer * len(self.plan.points)
                rows += [[(freedom[start] + k, 1)] for k in (0, 1) if start not in body.driven]
                for one, other in self.plan.pairs + start:
                    if other not in body.driven:
                        one, other = freedom[one], freedom[other]
                        rows += [[(other, 1), (one, -cos), (one + 1, sin)], [(other + 1, 1), (one, -sin), (one + 1, -cos)],
                                 [(other + 2, 1), (one + 2, -1)]]
        return self.matrix(rows)

    def matrix(self, rows):
        """A sparse matrix of rows of (degree of freedom, factor)."""
        matrix = self.getfem.Spmat("empty", len(rows), self.space.nbdof())
        for k, row in enumerate(rows):
            for freedom, factor in row:
                matrix.add(k, int(freedom), float(factor))
        return matrix

    def relative(self, directions):
        """The matrix of the lower body's displacements less the upper one's at the pairs, direction by direction."""
        upper, lower = (freedom[self.touching] for freedom in self.freedom)
        return self.matrix([[(b + k, 1), (a + k, -1)] for a, b in zip(upper, lower) for k in directions])

    def model(self):
        """The bodies with the load and an unknown pressing force, and the number of the brick of the loads."""
        sphere, model = self.sphere, self.getfem.Model("real")
        model.add_fem_variable("u", self.space)
        model.add_initialized_data("lambda", sphere.young * sphere.poisson / (1 + sphere.poisson) / (1 - 2 * sphere.poisson))
        model.add_initialized_data("mu", sphere.young / 2 / (1 + sphere.poisson))
        model.add_isotropic_linearized_elasticity_brick(self.points, "u", "lambda", "mu")
        model.add_Dirichlet_condition_with_multipliers(self.points, "u", self.space, LOWER)
        model.add_variable("motion", 2)
        model.add_filtered_fem_variable("drive", self.space, UPPER)
        rigid = "({0}(1)*[-X(2); X(1); 0] + {0}(2)*[0; 0; 1])".format
        model.add_linear_term(self.points, f"Test_drive.(u - {rigid('motion')}) + drive.(Test_u - {rigid('Test_motion')})", UPPER)
        ties = self.ties()
        model.add_variable("tie", ties.size()[0])
        model.add_explicit_matrix("tie", "u", ties, 1)
        loads = model.add_explicit_rhs("motion", np.array([0, -sphere.load]) / self.plan.sectors)
        model.add_variable("press", len(self.touching))
        model.add_initialized_data("r", sphere.young * sphere.contact_radius / 40)  # N/mm
        model.add_initialized_data("gap", self.gap)
        return model, loads

    def solve(self, moments):
        """Yields of each moment (N mm) the rotation and the forces (pairs, 3) on the lower body: pressing force and shear."""
        options = ("max_iter", 100, "max_res", 1e-6, "lsolver", "mumps")
        pressed, _ = self.model()
        pressed.add_basic_contact_brick("u", "press", "r", self.relative([2]), "gap")
        still = self.getfem.Spmat("empty", 2, 2)
        still.add(0, 0, self.sphere.young)  # without friction nothing else holds the rotation
        pressed.add_explicit_matrix("motion", "motion", still)
        pressed.set_variable("press", -self.sphere.load / self.plan.sectors * self.guess / self.guess.sum())
        pressed.solve(*options)
        twisted, loads = self.model()
        twisted.add_variable("shear", 2 * len(self.touching))
        for name, value in (("friction", self.sphere.friction), ("one", 1.0), ("start", -pressed.variable("u"))):
            twisted.add_initialized_data(name, value)  # GetFEM adds the last one to u: slip counts from the start
        twisted.add_basic_contact_brick("u", "press", "shear", "r", self.relative([2]), self.relative([0, 1]), "friction", "gap",
                                        "one", 1, "one", "start")
        for name in ("u", "motion", "drive", "tie", "press"):
            twisted.set_variable(name, pressed.variable(name))
        for moment in moments:
            twisted.set_private_rhs(loads, np.array([moment, -self.sphere.load]) / self.plan.sectors)
            twisted.solve(*options)
            shear = twisted.variable("shear").reshape(-1, 2)
            yield twisted.variable("motion")[0], np.column_stack([-twisted.variable("press"), shear])


def mark_ends(mesh, rim, depth):
    """Regions of the faces at the rim and at the far end of each body."""
    outer = mesh.outer_faces()
    x, y, z = np.array([mesh.pts()[:, mesh.pid_in_faces(outer[:, [k]])].mean(axis=1) for k in range(outer.shape[1])]).T
    upper = z > -APART / 2
    end = (np.hypot(x, y) > 0.97 * np.hypot(*rim.T).max()) | (np.where(upper, z, -z - APART) > 0.999 * depth)
    mesh.set_region(LOWER, outer[:, end & ~upper])
    mesh.set_region(UPPER, outer[:, end & upper])


def solve(sphere, arguments):
    radius, far = sphere.contact_radius, 8 * sphere.contact_radius
    size = radius / arguments.faces
    plan = elements.sector(elements.spacing(size, 1.1 * radius, far, 1.25))
    problem = Problem(sphere, plan, elements.spacing(size, 0.25 * radius, far, 1.25))

    def answers():
        for rotation, forces in problem.solve([ratio * sphere.limit for ratio in arguments.ratios]):
            values = np.zeros((len(plan.points), 3))
            values[problem.touching] = forces
            values[0] *= plan.sectors  # all sectors share the node on the axis
            field = elements.ContactFaces(problem.contact, None, {"pressure": values[:, 0], "q": values[:, 1:]}).all_round()
            yield rotation, field.over_nodal_areas()

    return ["--held-at", 1e-3 * far, "--read-as", "kind=forces"], answers()


def version():
    from getfem._getfem import getfem_env
    return "GetFEM " + getfem_env("version")


if __name__ == "__main__":
    elements.main(version, solve)
