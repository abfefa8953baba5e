"""PyBullet: loads are imposed, since its friction depends on the rate. A large inertia about the plane's axes keeps the sphere from
rolling."""

from stepping import of_module


def runs(sphere):
    mujoco = sphere.law["programs"]["mujoco"]["friction"]  # of the same form
    ours = {"lateralFriction": mujoco[0], "spinningFriction": mujoco[1]}
    words = ", ".join(f"{name} = {value:.5g}" for name, value in ours.items())
    return of_module("pybullet", "pybullet", Engine, sphere, ("its own: lateralFriction = 0.5", {"lateralFriction": 0.5}),
                     (f"slipstick law: {words}", ours))


class Engine:
    step_size = 1e-3  # s

    def __init__(self, sphere, mass, friction):
        import pybullet
        self.bullet = bullet = pybullet
        if bullet.isConnected():
            bullet.resetSimulation()
        else:
            bullet.connect(bullet.DIRECT)
        bullet.setTimeStep(self.step_size)
        ground = bullet.createMultiBody(0, bullet.createCollisionShape(bullet.GEOM_PLANE))
        bullet.changeDynamics(ground, -1, lateralFriction=1.0)  # Bullet multiplies the frictions of both bodies
        shape = bullet.createCollisionShape(bullet.GEOM_SPHERE, radius=sphere.radius)
        self.body = bullet.createMultiBody(mass, shape, basePosition=[0, 0, sphere.radius])
        bullet.changeDynamics(self.body, -1, localInertiaDiagonal=[1e9, 1e9, 0.4 * mass * sphere.radius**2], linearDamping=0,
                              angularDamping=0, **friction)
        self.twist = 0.0

    def step(self, normal_load, moment, force):
        bullet = self.bullet
        position, _ = bullet.getBasePositionAndOrientation(self.body)
        bullet.applyExternalForce(self.body, -1, [force, 0, -normal_load], position, bullet.WORLD_FRAME)
        bullet.applyExternalTorque(self.body, -1, [0, 0, moment], bullet.WORLD_FRAME)
        bullet.stepSimulation()
        self.twist += self.step_size * bullet.getBaseVelocity(self.body)[1][2]  # turns may be many
        return self.twist, bullet.getBasePositionAndOrientation(self.body)[0][0]
