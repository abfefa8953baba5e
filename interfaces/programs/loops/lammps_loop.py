"""LAMMPS, `lmp`: two equal spheres of twice the radius are one of this radius on a half-space. Motions are imposed, and
loads by a servo."""

import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from stepping import STEP, answered, at_rest


def runs(sphere):
    if not shutil.which("lmp"):
        raise LookupError("there is no lmp")
    version = subprocess.run(["lmp", "-h"], capture_output=True, text=True).stdout.split("Simulator - ")[-1].split("\n")[0]
    law = sphere.law["programs"]["lammps"]
    springs = f"sds {law['k_twist']} 0.0 {law['mu_twist']}"
    return version, [("its own: twisting marshall", twisted(sphere, "marshall")),
                     (f"slipstick law: twisting {springs}", twisted(sphere, springs))]


def twisted(sphere, twisting):
    def respond(path):
        rest, radius = at_rest(sphere, path), 2 * sphere.radius
        values = {"diameter": 2 * radius, "young": sphere.young, "poisson": sphere.poisson, "friction": sphere.friction,
                  "twisting": twisting, "step": STEP, "distance": 2 * radius - rest.radius[0]**2 / sphere.radius}
        words = ["lmp", "-in", Path(__file__).with_name("twist.lmp").resolve(), "-log", "none"]
        for name, value in values.items():
            words += ["-var", name, value]
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "rows.lmp").write_text("".join(rows_of(sphere, rest)))
            subprocess.run([str(word) for word in words], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            return answered(sphere, path, np.loadtxt(Path(folder) / "out.txt", ndmin=2))
    return respond


def rows_of(sphere, rest):
    """Commands of each row. The upper sphere turns about the normal; the lower one turns about the second axis of the plane, so that its
    surface slides along the first one and the normal stays."""
    shear = sphere.young / (4 * (1 + sphere.poisson))
    for contact, (about, along) in zip(rest.radius.tolist(), rest.given.tolist()):
        yield f"set atom 2 z {4 * sphere.radius - contact**2 / sphere.radius}\n"
        if rest.holds:
            stiffness = 16 / 3 * shear * contact**3, 16 * shear * contact / (2 - sphere.poisson)
            rate = [f"$(({load} - v_{name})/{each * STEP}:%.17g)" for load, name, each in
                    zip((about, along), ("moment", "force"), stiffness)]
            times, count = rest.steps, 1
        else:
            rate = [motion / (rest.steps * STEP) for motion in (about, along)]
            times, count = 1, rest.steps
        yield (f"variable turn equal {rate[0]}\nvariable slide equal {rate[1]}\nset atom 2 omega 0 0 ${{turn}}\n"
               f"set atom 1 omega 0 $(-v_slide/{2 * sphere.radius}) 0\nrun {count} pre no post no\n"
               f"variable twist equal $(v_twist+{count}*v_step*v_turn:%.17g)\n"
               f"variable path equal $(v_path+{count}*v_step*v_slide:%.17g)\n") * times
        yield 'print "$(v_moment:%.17g) $(v_force:%.17g) ${twist} ${path}" append out.txt screen no\n'
