# A script for Yade: two spheres from scene.json, the upper one twisted row by row.
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
O.dt, rows = scene["step"], []
for turn in scene["turns"]:
    O.bodies[upper].state.angVel = (0, 0, turn / (scene["steps"] * O.dt))
    for _ in range(scene["steps"]):
        O.step()
    rows.append(O.forces.t(lower)[2])
with open("out.json", "w") as file:
    json.dump(rows, file)
