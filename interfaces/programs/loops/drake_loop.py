"""Drake: the moment is imposed, up to 0.9 of the exact limit, a quarter in a second: its friction depends on the rate. A contact
point has no moment about its normal; hydroelastic contact has a patch, with the modulus that `slipstick law` writes."""

import importlib.util
import subprocess
from importlib.metadata import version

STEP = 1e-3  # s


def runs(sphere):
    if not importlib.util.find_spec("pydrake"):
        raise LookupError("this Python has no module pydrake")
    words = f"hydroelastic_modulus = {sphere.law['programs']['drake']['hydroelastic_modulus']:.5g}"
    return version("drake"), [("its own: a point of contact", loop(sphere, False)), (f"slipstick law: {words}", loop(sphere, True))]


def loop(sphere, hydroelastic):
    def run(folder):
        plant, simulator, moved = built(sphere, folder if hydroelastic else None)
        context, rows = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context()), []
        moved.child_body().SetSpatialInertiaInBodyFrame(context, mass(sphere))  # the file of `law` gives no inertia: 1 kg m^2
        load = plant.get_actuation_input_port()
        load.FixValue(context, [-sphere.load, 0.0])
        plant.GetJointByName("up").set_translation(context, sphere.radius)
        simulator.AdvanceTo(1.0)  # until it rests
        for k in range(500):  # ten steps each
            moment = 0.9 * sphere.limit * sphere.path(k / 100 * sphere.quarter)
            load.FixValue(context, [-sphere.load, moment])
            simulator.AdvanceTo(1.0 + 10 * STEP * (k + 1))
            rows.append((moment, moved.get_angle(context)))
        return rows
    return run


def mass(sphere):
    from pydrake.multibody.tree import SpatialInertia
    return SpatialInertia.SolidSphereWithMass(1.0, sphere.radius)


def built(sphere, folder):
    """The plant, its simulator and the rotating joint; with a folder the sphere comes from the file that `slipstick law` writes there."""
    from pydrake.geometry import AddContactMaterial, AddRigidHydroelasticProperties, HalfSpace, ProximityProperties, Sphere
    from pydrake.math import RigidTransform
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction
    from pydrake.multibody.tree import PrismaticJoint, RevoluteJoint
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, STEP)
    plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
    friction, model = CoulombFriction(sphere.friction, sphere.friction), plant.AddModelInstance("carrier")
    if folder:
        file = folder / "law.sdf"
        subprocess.run([sphere.slipstick, "law", sphere.scene, "--write", file, "--quiet"], check=True)
        Parser(plant).AddModels(str(file))
        body = plant.GetBodyByName("sphere")
    else:
        body = plant.AddRigidBody("sphere", model, mass(sphere))
        plant.RegisterCollisionGeometry(body, RigidTransform(), Sphere(sphere.radius), "sphere", friction)
    carrier = plant.AddRigidBody("between", model, mass(sphere))
    up = plant.AddJoint(PrismaticJoint("up", plant.world_frame(), carrier.body_frame(), [0, 0, 1]))
    turn = plant.AddJoint(RevoluteJoint("turn", carrier.body_frame(), body.body_frame(), [0, 0, 1]))
    plant.AddJointActuator("push", up)
    plant.AddJointActuator("twist", turn)
    ground = ProximityProperties()
    AddRigidHydroelasticProperties(ground)
    AddContactMaterial(friction=friction, properties=ground)
    plant.RegisterCollisionGeometry(plant.world_body(), RigidTransform(), HalfSpace(), "ground", ground)
    plant.Finalize()
    return plant, Simulator(builder.Build()), turn
