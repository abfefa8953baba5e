"""MuJoCo: the moment is imposed, up to 0.9 of the exact limit, a quarter in four seconds: its friction depends on the rate."""

import importlib.util
from importlib.metadata import version


def runs(sphere):
    if not importlib.util.find_spec("mujoco"):
        raise LookupError("this Python has no module mujoco")
    words = " ".join(map(str, sphere.law["programs"]["mujoco"]["friction"]))
    return version("mujoco"), [("its own: 1 0.005 0.0001", loop(sphere, "")),
                               (f"slipstick law: {words}", loop(sphere, f'friction="{words}"'))]


def loop(sphere, friction):
    def run(_):
        import mujoco
        size, worn = sphere.radius, f'condim="4" {friction}'
        model = mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep="1e-3" gravity="0 0 0" cone="elliptic"/><worldbody>
          <geom type="plane" size="1 1 .1" {worn}/><body pos="0 0 {size}"><joint name="z" type="slide" axis="0 0 1"/>
          <joint name="turn" type="hinge" axis="0 0 1"/><geom type="sphere" size="{size}" mass="1" {worn}/></body></worldbody>
          <actuator><motor joint="z"/><motor joint="turn"/></actuator></mujoco>""")
        data, rows = mujoco.MjData(model), []
        data.ctrl[0] = -sphere.load
        for _ in range(3000):  # until it rests
            mujoco.mj_step(model, data)
        start = data.qpos[1]
        for k in range(5 * sphere.quarter):
            data.ctrl[1] = 0.9 * sphere.limit * sphere.path(k)
            mujoco.mj_step(model, data)
            if k % 10 == 0:
                rows.append((data.ctrl[1], data.qpos[1] - start))
        return rows
    return run
