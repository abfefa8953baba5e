# A script for Yade: two spheres from scene.json, moved row by row. The lower one turns about y, so that its surface slides along x.
import json
import math

with open("scene.json") as file:
    scene = json.load(file)
O.materials.append(CohFrictMat(young=scene["young"], poisson=scene["poisson"], frictionAngle=math.atan(scene["friction"]),
                               momentRotationLaw=True, isCohesive=False, alphaKr=0, etaRoll=-1, density=7800, **scene["twisting"]))
lower, upper = O.bodies.append([sphere((0, 0, height), scene["radius"], fixed=True) for height in (0, scene["distances"][0])])
O.engines = [NewtonIntegrator(damping=0), ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()]),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D()], [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],
                             [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(always_use_moment_law=True,
                                                                        useIncrementalForm=scene["incremental"])])]
O.dt, rows, twist, path, radius = scene["step"], [], 0.0, 0.0, scene["radius"]
O.step()
spring = O.interactions[lower, upper].phys


def loads():
    return O.forces.t(lower)[2], O.forces.f(lower)[0]


for distance, given in zip(scene["distances"], scene["given"]):
    O.bodies[upper].state.pos = (0, 0, distance)
    for _ in range(scene["steps"]):
        if scene["holds"]:  # a servo: the missing loads over the stiffnesses
            turn, slide = [(load - now) / each for load, now, each in zip(given, loads(), (spring.ktw, spring.ks))]
        else:
            turn, slide = [motion / scene["steps"] for motion in given]
        O.bodies[upper].state.angVel, O.bodies[lower].state.angVel = (0, 0, turn / O.dt), (0, -slide / radius / O.dt, 0)
        O.step()
        twist, path = twist + turn, path + slide
    rows.append([*loads(), twist, path])
with open("out.json", "w") as file:
    json.dump(rows, file)
