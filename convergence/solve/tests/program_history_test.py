"""program_history_test.py PROGRAM: output, files and exit codes of load histories."""

import itertools
import json
import math
from pathlib import Path

from program_run import SHORT_SCENE, ProgramTest

# Steel bodies on 24 x 24 cells, W = 1000 N, mu W = 100 N.
BODIES = SHORT_SCENE.replace("moment_ratio = 0.5\n", "").replace("[32, 32]", "[24, 24]")
FORCES = "[[step]]\nname = 'pull'\nforce = [30.0, 40.0]\n[[step]]\nforce = [0.0, 0.0]\n"
MIXED = ("[[step]]\nforce = [20.0, 0.0]\nmoment_ratio = 0.3\n[[step]]\nnormal = 800.0\n[[step]]\ntwist = 0.0\n"
         "[[step]]\ndisplacement = [0.0, 1e-7]\n[[step]]\nmoment_ratio = 0.0\nforce = [0.0, 0.0]\n")


def turning(**ratios):
    return "".join(f"[[step]]\nname = '{name}'\nmoment_ratio = {ratio}\n" for name, ratio in ratios.items())


CYCLE = turning(out=0.8, back=-0.8, again=0.8)


def unexplained(node, path=""):
    """Paths of nulls without a reason, and of empty reasons."""
    if isinstance(node, list):
        return [found for i, one in enumerate(node)
                for found in ([f"{path}[{i}]"] if one is None else unexplained(one, f"{path}[{i}]"))]
    if not isinstance(node, dict):
        return []
    found = [f"{path}.{key}" for key, value in node.items()
             if (value is None and key + "_reason" not in node) or (key.endswith("_reason") and not value)]
    return found + [inner for key, value in node.items() for inner in unexplained(value, f"{path}.{key}")]


class History(ProgramTest):
    def solve(self, steps, *options, **expected):
        return self.run_program("solve", self.write("scene.toml", BODIES + steps), *options, **expected)

    def solved(self, steps, *options, **expected):
        return json.loads(self.solve(steps, *options, "--json", "-", **expected))

    def written(self):
        return json.loads(Path("r.json").read_text())

    def test_has_a_line_and_a_result_for_each_step(self):
        self.solve(CYCLE, "--json", "r.json", says=["\n  out ", "\n  back ", "\n  again ", "3 steps"])
        result = self.written()
        steps, history = result["steps"], result["history"]
        self.assertEqual((len(steps), history["steps"]), (3, 3))
        for step in steps:
            self.assertEqual((step["status"], step["cycle"]), ("converged", 1))
        self.assertEqual(steps[1]["name"], "back")
        self.assertAlmostEqual(steps[1]["moment_ratio"], -0.8, delta=4.5e-16)
        totals = [step["dissipated_total"] for step in result["steps"]]
        self.assertEqual(totals[-1], result["dissipated_total"])
        self.assertEqual(result["dissipated_total"], result["history"]["dissipated"])
        for k, step in enumerate(result["steps"]):  # the energy lost in a step is the growth of the total
            self.assertAlmostEqual(step["dissipated"], totals[k] - (totals[k - 1] if k else 0), delta=1e-12 * totals[-1])
        for key in ("dissipated", "operator_applications"):
            total = math.fsum(step[key] for step in steps)
            self.assertAlmostEqual(history[key], total, delta=4.5e-16 * total)
        self.assertEqual(history["worst_gap"], max(step["certificate"]["gap"] for step in steps))
        for key in ("twist_angle", "moment", "dissipated", "twist_error", "stick_radius", "limit"):
            self.assertEqual(result[key], steps[2][key], key)  # the result has the last step's value

    def test_shows_the_size_of_the_force(self):
        line = next(line for line in self.solve(FORCES).splitlines() if line.startswith("  pull "))
        self.assertEqual(line.split()[3], "50")

    def test_cycles_repeat_the_steps(self):
        steps = self.solved(CYCLE, "--set", "cycles=2")["steps"]
        self.assertEqual((len(steps), steps[3]["cycle"], steps[3]["name"]), (6, 2, "out"))

    def test_refuses_the_force_that_friction_carries_on_any_grid(self):
        for cells, force in itertools.product(([24, 24], [21, 26], [30, 33]), ([100.0, 0.0], [0.0, -100.0], [60.0, 80.0])):
            self.solve(f"[[step]]\nforce = {force}\n", "--set", f"grid.cells={cells}", code=2, says=["slips everywhere"])

    def test_keeps_the_steps_before_gross_slip(self):
        self.solve(CYCLE, "--set", "step[2].moment=0.05", "--json", "r.json", code=2,
                   says=["step[2].moment = 0.05", "slips everywhere"])
        result = self.written()
        self.assertEqual(result["status"], "not_converged")
        self.assertIn("step[2].moment = 0.05", result["message"])
        self.assertEqual((len(result["steps"]), result["history"]["steps"]), (2, 2))
        self.assertEqual(result["steps"][1]["name"], "back")
        self.assertEqual(unexplained(result), [])

    def test_nothing_is_written_where_the_first_step_is_refused(self):
        self.solve(CYCLE, "--set", "step[0].moment=0.05", "--json", "r.json", code=2)
        self.assertFalse(Path("r.json").exists())

    def test_stops_at_a_step_that_misses_its_tolerance(self):
        # The first step needs no iterations, the second one more than allowed.
        result = self.solved(turning(rest=0.0, far=0.9, back=0.0), "--set", "solver.max_iterations=3", "--quiet", code=1)
        self.assertEqual(result["status"], "not_converged")
        self.assertEqual([step["status"] for step in result["steps"]], ["converged", "not_converged"])
        self.assertIn("within 3 operator applications", result["steps"][1]["message"])
        self.assertEqual(unexplained(result), [])

    def test_fields_of_each_step_or_of_the_last(self):
        self.solve(CYCLE, "--quiet", "--fields", "f-{step}.csv")
        self.solve(CYCLE, "--quiet", "--fields", "last.csv")
        texts = [Path(f"f-{step}.csv").read_text() for step in (1, 2, 3)]
        self.assertTrue(all(texts))
        self.assertFalse(Path("f-4.csv").exists())
        self.assertNotEqual(texts[1], texts[2])
        self.assertEqual(Path("last.csv").read_text(), texts[2])

    def test_overrides_a_load_of_one_step(self):
        steps = self.solved(CYCLE, "--set", "step[1].moment_ratio=-0.3")["steps"]
        for step, ratio in zip(steps, (0.8, -0.3)):
            self.assertAlmostEqual(step["moment_ratio"], ratio, delta=1e-13)  # relative error of the cells' sum
        self.solve(CYCLE, "--set", "step[3].moment_ratio=0.1", code=2, says="step[3]")

    def test_exact_model_answers_the_last_step(self):
        # By Masing's rule the twist after unloading is that of first loading less twice the twist of half the moment.
        def answer(**ratios):
            return self.solved(turning(**ratios), "--model", "exact")

        rest = answer(out=0.8, rest=0.0)
        loaded, half = answer(out=0.8)["twist_angle"], answer(half=0.4)["twist_angle"]
        self.assertEqual(rest["moment"], 0.0)
        self.assertAlmostEqual(rest["twist_angle"] / (loaded - 2.0 * half), 1.0, delta=1e-13)
        self.assertEqual(unexplained(rest), [])
        self.solve(CYCLE, "--model", "exact", "--set", "step[1].moment=-0.05", code=2,
                   says=["step[1].moment = -0.05", "gross slip"])

    def test_exact_model_says_what_spence_does_not(self):
        # Under full coupling only the stick ratio is known.
        rubber = ["--set", "lower.young_modulus=1e9", "--set", "lower.poisson_ratio=0.0", "--set", "contact.friction=0.3"]
        steps = "[[step]]\nnormal = 500.0\n[[step]]\nnormal = 1000.0\n"
        for coupling in ("pressure", "full"):
            options = [*rubber, "--set", f"contact.coupling={coupling}"]
            result = self.solved(steps, "--model", "exact", *options)
            self.assertEqual(unexplained(result), [])
            self.assertIsInstance(result["stick_ratio"], float)
            self.assertEqual(result["contact_radius"] is None, coupling == "full")
            self.solve(steps, "--model", "exact", "--fields", "f.csv", *options, code=2,  # there are no tractions to write
                       says=["stick ratio      0.", 'solver.model = "exact"', "stick ratio only"])
            self.assertFalse(Path("f.csv").exists())
            self.solve(steps, "--fields", "f.csv", *options)
            self.assertNotIn("q1_exact", Path("f.csv").read_text().splitlines()[0])
            Path("f.csv").unlink()

    def test_says_how_far_the_limit_is(self):
        # At 0.8 of the limit moment the factor is 1/0.8, about the axis.
        for step in self.solved(CYCLE)["steps"]:
            self.assertAlmostEqual(step["limit"]["factor"], 1.25, delta=1e-9)
            for x in step["limit"]["centre"]:
                self.assertAlmostEqual(x, 0.0, delta=1e-9 * step["contact_radius"])
        force = self.solved(FORCES)
        pulled, released = (step["limit"] for step in force["steps"])
        self.assertAlmostEqual(pulled["factor"], 2.0, delta=1e-6)
        self.assertNotIn("centre", pulled)
        self.assertAlmostEqual(pulled["direction"][0], 0.6, delta=1e-6)
        self.assertIsNone(released["factor"])
        self.assertEqual(unexplained(force), [])

    def test_every_number_is_finite_or_has_a_reason(self):
        # With and without an exact answer, at rest, without friction, in mixed loads.
        changes = ["name=plain", "contact.friction=0", "lower.young_modulus=70e9", "contact.pressure=hertz",
                   "solver.max_iterations=2"]
        written = 0
        for steps, change in itertools.product((CYCLE, turning(rest=0.0, on=0.5), MIXED), changes):
            self.solve(steps, "--json", "r.json", "--set", change, code=(0, 1, 2))
            if Path("r.json").exists():
                self.assertEqual(unexplained(self.written()), [], (change, steps))
                Path("r.json").unlink()
                written += 1
            else:
                self.solve(steps, "--set", change, code=2)
        self.assertGreaterEqual(written, 10)  # mixed loads have no answer without friction
