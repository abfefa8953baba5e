"""Drake: loads are imposed, since its friction depends on the rate. A contact point has no moment about its normal; hydroelastic contact
has a patch, with the modulus that `slipstick law` writes."""

import subprocess
import tempfile
from functools import cache
from pathlib import Path

from stepping import of_module

STEP = 1e-3  # s


def runs(sphere):
    words = f"hydroelastic_modulus = {sphere.law['programs']['drake']['hydroelastic_modulus']:.5g}"
    return of_module("pydrake", "drake", Engine, sphere, ("its own: a point of contact", False), (f"slipstick law: {words}", True))


@cache
def built(sphere, hydroelastic):
    """Diagram, plant, body, and its joints along the normal, along the ground and about the normal. hydroelastic: the sphere comes from the
    file that `slipstick law` writes."""
    from pydrake.geometry import AddContactMaterial, AddRigidHydroelasticProperties, HalfSpace, ProximityProperties, Sphere
    from pydrake.math import RigidTransform
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction
    from pydrake.multibody.tree import PrismaticJoint, RevoluteJoint, SpatialInertia
    from pydrake.systems.framework import DiagramBuilder
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, STEP)
    plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
    friction, model = CoulombFriction(sphere.friction, sphere.friction), plant.AddModelInstance("carrier")
    light = SpatialInertia.SolidSphereWithMass(1e-6, sphere.radius)
    if hydroelastic:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "law.sdf"
            subprocess.run([sphere.slipstick, "law", sphere.scene, "--write", file, "--quiet"], check=True)
            Parser(plant).AddModels(str(file))
        body = plant.GetBodyByName("sphere")
    else:
        body = plant.AddRigidBody("sphere", model, light)
        plant.RegisterCollisionGeometry(body, RigidTransform(), Sphere(sphere.radius), "sphere", friction)
    frames = [plant.world_frame(), *(plant.AddRigidBody(f"carrier{k}", model, light).body_frame() for k in (1, 2)), body.body_frame()]
    joints = [plant.AddJoint(kind(name, one, other, axis)) for kind, name, one, other, axis in zip(
        (PrismaticJoint, PrismaticJoint, RevoluteJoint), ("up", "along", "turn"), frames, frames[1:], ([0, 0, 1], [1, 0, 0], [0, 0, 1]))]
    for joint in joints:
        plant.AddJointActuator(joint.name(), joint)
    ground = ProximityProperties()
    AddRigidHydroelasticProperties(ground)
    AddContactMaterial(friction=friction, properties=ground)
    plant.RegisterCollisionGeometry(plant.world_body(), RigidTransform(), HalfSpace(), "ground", ground)
    plant.Finalize()
    return builder.Build(), plant, body, joints


class Engine:
    step_size = STEP

    def __init__(self, sphere, mass, hydroelastic):
        from pydrake.multibody.tree import SpatialInertia
        from pydrake.systems.analysis import Simulator
        diagram, plant, body, self.joints = built(sphere, hydroelastic)
        self.simulator, self.steps = Simulator(diagram), 0
        self.context = plant.GetMyMutableContextFromRoot(self.simulator.get_mutable_context())
        # The file of `law` gives no inertia.
        body.SetSpatialInertiaInBodyFrame(self.context, SpatialInertia.SolidSphereWithMass(mass, sphere.radius))
        self.joints[0].set_translation(self.context, sphere.radius)
        self.loads = plant.get_actuation_input_port()

    def step(self, normal_load, moment, force):
        self.loads.FixValue(self.context, [-normal_load, force, moment])
        self.steps += 1
        self.simulator.AdvanceTo(self.steps * self.step_size)
        return self.joints[2].get_angle(self.context), self.joints[1].get_translation(self.context)
