"""MuJoCo: loads are imposed, since its friction depends on the rate."""

from stepping import of_module


def runs(sphere):
    words = " ".join(map(str, sphere.law["programs"]["mujoco"]["friction"]))
    return of_module("mujoco", "mujoco", Engine, sphere, ("its own: 1 0.005 0.0001", ""),
                     (f"slipstick law: {words}", f'friction="{words}"'))


class Engine:
    step_size = 1e-3  # s

    def __init__(self, sphere, mass, friction):
        import mujoco
        size, worn = sphere.radius, f'condim="4" {friction}'
        self.model = mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep="{self.step_size}" gravity="0 0 0" cone="elliptic"/>
          <worldbody><geom type="plane" size="9 9 .1" {worn}/><body pos="0 0 {size}"><joint type="slide" axis="0 0 1"/>
          <joint type="slide" axis="1 0 0"/><joint type="hinge" axis="0 0 1"/>
          <geom type="sphere" size="{size}" mass="{mass}" {worn}/></body></worldbody></mujoco>""")
        self.data, self.advance = mujoco.MjData(self.model), mujoco.mj_step

    def step(self, normal_load, moment, force):
        self.data.qfrc_applied[:] = -normal_load, force, moment
        self.advance(self.model, self.data)
        return self.data.qpos[2], self.data.qpos[1]
