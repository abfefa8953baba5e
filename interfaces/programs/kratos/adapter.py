"""Kratos (ContactStructuralMechanicsApplication): linear hexahedra of two bodies, dual mortar contact with augmented Lagrange
multipliers; pressed without friction, then twisted with it. The whole circle (an O-grid), since its contact takes no cyclic
conditions."""

import argparse
import sys
from importlib import metadata
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import elements  # noqa: E402

WITHOUT = 1e-6  # the friction coefficient while pressing: with zero, Kratos would take every node as sliding later, too
CLOSE = 2e-4  # of the wanted load and moment
MULTIPLIERS = """{"solver_type": "mixed_ulm_linear_solver", "tolerance": 1e-8, "max_iteration_number": 400,
"dual_lm_off_node_tolerance": 1e-2}"""
SETTINGS = """{
"problem_data": {"problem_name": "twist", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": 1000.0, "echo_level": 0},
"solver_settings": {"model_part_name": "Bodies", "domain_size": 3, "solver_type": "Static", "analysis_type": "non_linear", "echo_level": 0,
 "model_import_settings": {"input_type": "use_input_model_part"}, "material_import_settings": {"materials_filename": ""},
 "time_stepping": {"time_step": 1.0}, "move_mesh_flag": true, "reform_dofs_at_each_step": true, "max_iteration": 40,
 "convergence_criterion": "contact_residual_criterion", "residual_relative_tolerance": 1e-5, "residual_absolute_tolerance": 1e-9,
 "contact_settings": {"mortar_type": "ALMContactFrictional", "fancy_convergence_criterion": false,
  "mixed_ulm_solver_parameters": %s,
  "contact_displacement_relative_tolerance": 1e-5, "contact_residual_relative_tolerance": 1e-5}},
"processes": {"contact_process_list": [{"python_module": "alm_contact_process",
 "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication", "process_name": "ALMContactProcess",
 "Parameters": {"model_part_name": "Bodies", "contact_model_part": {"0": ["Upper", "Lower"]}, "assume_master_slave": {"0": ["Upper"]},
  "friction_coefficients": {"0": %g}, "contact_type": "Frictional", "not_normal_update_frictional": true,
  "search_parameters": {"search_factor": 2.0}}}]},
"output_processes": {}}""" % (MULTIPLIERS, WITHOUT)
# Multigrid takes 0.2 CPU seconds on 4 faces, the direct solver that Kratos comes with 8.
MULTIGRID = """{"solver_type": "amgcl", "smoother_type": "ilu0", "krylov_type": "lgmres", "coarsening_type": "aggregation",
"max_iteration": 300, "tolerance": 1e-8, "gmres_krylov_space_dimension": 100, "block_size": 3, "use_block_matrices_if_possible": true}"""


class Problem:
    """Both bodies in one model part. Nodes: the upper body's, the lower one's."""

    def __init__(self, sphere, plan, depth):
        import KratosMultiphysics as kratos
        import KratosMultiphysics.ContactStructuralMechanicsApplication as contact
        import KratosMultiphysics.StructuralMechanicsApplication as structural
        from KratosMultiphysics.ContactStructuralMechanicsApplication import auxiliary_methods_solvers
        from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import StructuralMechanicsAnalysis
        kratos.Logger.GetDefaultOutput().SetSeverity(kratos.Logger.Severity.WARNING)
        # Kratos' own choice falls back to the whole system with multipliers, which multigrid does not solve.
        auxiliary_methods_solvers.AuxiliaryCreateLinearSolver = lambda *_: contact.MixedULMLinearSolver(
            kratos.AMGCLSolver(kratos.Parameters(MULTIGRID)), kratos.Parameters(MULTIPLIERS))
        self.kratos, self.contact, self.sphere, self.plan, self.time = kratos, contact, sphere, plan, 0.0
        model = kratos.Model()
        self.analysis = StructuralMechanicsAnalysis(model, kratos.Parameters(SETTINGS))
        self.part = model["Bodies"]
        steel = self.part.CreateNewProperties(1)
        for name, value in ((kratos.YOUNG_MODULUS, sphere.young), (kratos.POISSON_RATIO, sphere.poisson), (kratos.DENSITY, 1.0),
                            (kratos.CONSTITUTIVE_LAW, structural.LinearElastic3DLaw())):
            steel[name] = value
        gap = sphere.radius - np.sqrt(sphere.radius**2 - np.sum(plan.points**2, axis=1))
        bodies = [elements.extruded(plan, depth, surface, upper) for surface, upper in ((gap, True), (0 * gap, False))]
        self.first = [1, 1 + bodies[0].nodes[..., 0].size]
        self.points = np.vstack([body.nodes.reshape(-1, 3) for body in bodies])
        for number, point in enumerate(self.points, 1):
            self.part.CreateNewNode(number, *map(float, point))
        cells = np.vstack([cells + first for body, first in zip(bodies, self.first) for cells in body.elements])
        for number, cell in enumerate(cells.tolist(), 1):
            self.part.CreateNewElement("SmallDisplacementElement3D8N", number, cell, steel)
        self.faces = plan.within(1.6 * sphere.contact_radius)
        number = 0
        for name, first, turn in (("Upper", self.first[0], -1), ("Lower", self.first[1], 1)):
            side = self.part.CreateSubModelPart(name)
            side.AddNodes((np.unique(self.faces.faces[0]) + first).tolist())
            for face in (self.faces.faces[0][:, ::turn] + first).tolist():
                side.CreateNewCondition("SurfaceCondition3D4N", number := number + 1, face, steel)
        self.analysis.Initialize()
        self.driven, self.held = (body.driven + first for body, first in zip(bodies, self.first))
        for number in (*self.driven, *self.held):
            for axis in (kratos.DISPLACEMENT_X, kratos.DISPLACEMENT_Y, kratos.DISPLACEMENT_Z):
                self.part.Nodes[int(number)].Fix(axis)

    def step(self, approach, twist):
        """Moves the upper body's end; the load and the moment (N, N mm) on it."""
        kratos, analysis, solver = self.kratos, self.analysis, self.analysis._GetSolver()
        self.time = solver.AdvanceInTime(self.time)
        for number in self.driven:
            x, y, _ = self.points[number - 1]
            motion = {kratos.DISPLACEMENT_X: -twist * y, kratos.DISPLACEMENT_Y: twist * x, kratos.DISPLACEMENT_Z: -approach}
            for axis, value in motion.items():
                self.part.Nodes[int(number)].SetSolutionStepValue(axis, 0, float(value))
        analysis.InitializeSolutionStep()
        solver.Predict()
        solver.SolveSolutionStep()
        analysis.FinalizeSolutionStep()
        forces = np.array([self.part.Nodes[int(number)].GetSolutionStepValue(kratos.REACTION) for number in self.held])
        x, y, _ = self.points[self.held - 1].T
        return forces[:, 2].sum(), -(x @ forces[:, 1] - y @ forces[:, 0])

    def pressed(self):
        """The approach (mm) that carries the load, reached in steps."""
        for part in (0.25, 0.5, 0.75):
            self.step(part * self.sphere.approach, 0.0)
        starts = 0.85 * self.sphere.approach, 0.9 * self.sphere.approach
        return secant(lambda approach: self.step(approach, 0.0)[0], self.sphere.load, starts)

    def solve(self, moments):
        """Yields of each moment (N mm) the twist (rad), and pressure and shear (points, 3) on the lower body (MPa)."""
        approach = self.pressed()
        for node in self.part.Nodes:  # where Kratos keeps it once the contact is initialised
            node.SetValue(self.kratos.FRICTION_COEFFICIENT, self.sphere.friction)
        shear = self.sphere.young / 2 / (1 + self.sphere.poisson)
        stuck = 3 / 8 / shear / self.sphere.contact_radius**3  # the twist by a unit moment without slip; each step adds more
        twist, moment = 0.0, 0.0
        for wanted in moments:
            for part in (1 / 3, 2 / 3):
                twist += (wanted - moment) / 3 * stuck
                carried = self.step(approach, twist)[1]
            starts = [twist + factor * (wanted - carried) * stuck for factor in (1.0, 1.2)]
            twist = secant(lambda twist: self.step(approach, twist)[1], wanted, starts)
            moment = wanted
            yield twist, self.tractions()

    def tractions(self):
        """Multipliers of the upper body's nodes: the force of each over its area."""
        values = np.zeros((len(self.plan.points), 3))
        for number in np.unique(self.faces.faces[0]):
            node = self.part.Nodes[int(number) + self.first[0]]
            if node.Is(self.kratos.ACTIVE):
                shear = node.GetValue(self.contact.AUGMENTED_TANGENT_CONTACT_PRESSURE)
                values[number] = [-node.GetValue(self.contact.AUGMENTED_NORMAL_CONTACT_PRESSURE), shear[0], shear[1]]
        return values


def secant(of, wanted, starts):
    """The argument at which `of` is close to the wanted value, from two that are below it."""
    before, now = starts
    first, second = of(before), of(now)
    for _ in range(12):
        if abs(second / wanted - 1) < CLOSE:
            return now
        before, now, first = now, now + (wanted - second) * (now - before) / (second - first), second
        second = of(now)
    raise SystemExit(f"kratos: {second:g} in place of {wanted:g} after 12 steps")


def solve(sphere, arguments):
    radius, far = sphere.contact_radius, 8 * sphere.contact_radius
    size = radius / arguments.faces
    plan = elements.o_grid(elements.spacing(size, 1.1 * radius, far, arguments.growth), max(2, arguments.faces // 2))
    problem = Problem(sphere, plan, elements.spacing(size, 0.25 * radius, far, arguments.growth))

    def answers():
        for twist, values in problem.solve([ratio * sphere.limit for ratio in arguments.ratios]):
            yield twist, elements.ContactFaces(problem.faces, None, {"pressure": values[:, 0], "q": values[:, 1:]})

    return ["--held-at", 1e-3 * far, "--read-as", "kind=forces"], answers()


def version():
    return f"Kratos {metadata.version('KratosContactStructuralMechanicsApplication')}"  # importing it would print a banner


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--growth", type=float, default=1.5, help="from element to element away from the contact")
    elements.main(version, solve, options)
