"""program_bench_test.py PROGRAM: `slipstick bench` as users run it, on made programs: exit codes and output written
where."""

import json
from pathlib import Path

from program_run import ProgramTest, made_benchmarks



class ProgramBench(ProgramTest):
    def made_program(self, label, names, milliseconds=1.0, code=0):
        return str(made_benchmarks(self.folder / label, names, milliseconds, code))

    def against(self, factor, *options, code=0, says=()):
        """Two builds; the new one takes this many times as long."""
        self.run_program("bench", "--filter", "f", "--against", self.made_program("base", "f/cells:8\n"), "--program",
                         self.made_program("now", "f/cells:8\n", factor), "--output", "out", *options, code=code,
                         says=says)

    def log(self):
        return Path("log").read_text().splitlines()

    def test_is_green_where_nothing_is_slower(self):
        self.against(1.01, "--rounds", "10", says="repetition by repetition")

    def test_turns_the_order_round_every_time(self):
        self.against(1.0, "--rounds", "2", code=2)  # too few to say anything
        name = r"^(f/cells:8)$"
        self.assertEqual(self.log(), [f"base {name}", f"now {name}", f"now {name}", f"base {name}"])

    def test_calls_nothing_slower_before_a_second_session_twice_as_long(self):
        self.against(1.2, "--rounds", "10", code=1, says=("first run: slower (1.2", "second: slower (1.2"))
        self.assertEqual(sum(line.startswith("now ") for line in self.log()), 30)

    def test_reports_what_is_in_one_build_only(self):
        self.run_program("bench", "--filter", "f", "--against", self.made_program("base", "common\nold\n"), "--program",
                         self.made_program("now", "new\ncommon\n", 1.01), "--output", "out", "--rounds", "10", code=2,
                         says=("1 only in base", "1 only in new", "1 same"))
        found = json.loads(Path("out/comparison.json").read_text())
        self.assertEqual([(row["name"], row["finding"]) for row in found["benchmarks"]],
                         [("common", "same"), ("old", "only in base"), ("new", "only in new")])

    def test_a_name_may_look_like_a_regular_expression(self):
        program = self.made_program("both", "f<2.5>(x)|g\n")
        self.run_program("bench", "--against", program, "--program", program, "--output", "out", "--rounds", "2", code=2)
        self.assertEqual(set(self.log()), {r"both ^(f<2\.5>\(x\)\|g)$"})

    def test_says_which_benchmark_failed(self):
        program = self.made_program("broken", "f\n", code=3)
        self.run_program("bench", "--against", program, "--program", program, "--output", "out", code=2,
                         says="benchmark f ended with code 3")

    def test_finds_what_is_slower_and_keeps_the_timings(self):
        self.against(1.15, "--rounds", "10", "--json", "new.json", code=1, says="slower")
        for file in ("new.json", "out/base.json", "out/new.json"):
            self.assertEqual(len(json.loads(Path(file).read_text())["benchmarks"]), 10, file)
        sessions = {json.loads(Path(f"out/{file}.json").read_text())["context"]["session"] for file in ("base", "new")}
        self.assertEqual(len(sessions), 1)

    def test_says_when_there_are_too_few_rounds(self):
        self.against(1.5, "--rounds", "3", code=2, says="too few")

    def test_compares_the_second_of_two_methods_with_the_first(self):
        program = self.made_program("both", "f\ng\n")
        self.run_program("bench", "--pair", "f", "g", "--program", program, "--output", "out", "--rounds", "2", code=2,
                         says=("g against f, ", "g over f"))
        self.assertLessEqual({"both ^(f)$", "both ^(g)$"}, set(Path("log").read_text().splitlines()))

    def test_refuses_what_it_cannot_do(self):
        self.run_program("bench", "--against", "nothing", "--program", "nothing", code=2)
