# A script for Yade: two spheres from scene.json, the upper one twisted there and back.
import json
import math

with open("scene.json") as file:
    scene = json.load(file)
O.materials.append(CohFrictMat(young=scene["young"], poisson=scene["poisson"], frictionAngle=math.atan(scene["friction"]),
                               momentRotationLaw=True, isCohesive=False, alphaKr=0, etaRoll=-1, density=7800, **scene["twisting"]))
lower, upper = O.bodies.append([sphere((0, 0, height), scene["radius"], fixed=True) for height in (0, scene["distance"])])
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()]),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D()], [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],
                             [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(always_use_moment_law=True,
                                                                        useIncrementalForm=scene["incremental"])]),
             NewtonIntegrator(damping=0)]
O.dt, quarter, rows = 1e-6, scene["quarter"], []
for step in range(5 * quarter):
    speed = scene["rotation"] / (quarter * O.dt)
    O.bodies[upper].state.angVel = (0, 0, -speed if quarter <= step < 3 * quarter else speed)
    O.step()
    if step % 10 == 0:
        rows.append((step, O.forces.t(lower)[2]))
with open("out.json", "w") as file:
    json.dump(rows, file)
