"""Newton on the CPU, with its solver XPBD: loads are imposed, since its friction depends on the rate. A large inertia about the plane's
axes keeps the sphere from rolling."""

from stepping import of_module


def runs(sphere):
    mujoco = sphere.law["programs"]["mujoco"]["friction"]  # of the same form
    ours = {"mu": mujoco[0], "mu_torsional": mujoco[1]}
    words = ", ".join(f"{name} = {value:.5g}" for name, value in ours.items())
    return of_module("newton", "newton", Engine, sphere, ("its own: mu = 1, mu_torsional = 0.005", {}),
                     (f"slipstick law: {words}", ours))


class Engine:
    step_size = 1e-3  # s

    def __init__(self, sphere, mass, friction):
        import newton
        import warp
        warp.config.quiet = True
        warp.set_device("cpu")
        builder, shape = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0)), newton.ModelBuilder.ShapeConfig(density=0.0, **friction)
        own = 0.4 * mass * sphere.radius**2
        inertia = warp.mat33(1e5 * own, 0.0, 0.0, 0.0, 1e5 * own, 0.0, 0.0, 0.0, own)
        body = builder.add_body(xform=warp.transform((0.0, 0.0, sphere.radius), warp.quat_identity()), mass=mass, inertia=inertia,
                                lock_inertia=True)
        builder.add_shape_sphere(body, radius=sphere.radius, cfg=shape)
        builder.add_ground_plane(cfg=shape)
        self.model = builder.finalize()
        self.solver, self.control = newton.solvers.SolverXPBD(self.model), self.model.control()
        self.now, self.next, self.contacts = self.model.state(), self.model.state(), self.model.contacts()
        self.twist = 0.0

    def step(self, normal_load, moment, force):
        self.now.body_f.numpy()[0] = force, 0.0, -normal_load, 0.0, 0.0, moment
        self.model.collide(self.now, self.contacts)
        self.solver.step(self.now, self.next, self.control, self.contacts, self.step_size)
        self.now, self.next = self.next, self.now
        self.now.body_qd.numpy()[0, 3:5] = 0.0  # a view of memory on the CPU
        self.twist += self.step_size * float(self.now.body_qd.numpy()[0, 5])  # turns may be many
        return self.twist, float(self.now.body_q.numpy()[0, 0])
