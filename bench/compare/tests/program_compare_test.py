"""program_compare_test.py PROGRAM: `slipstick compare` as users run it: exit codes and output."""

import json
import random
from pathlib import Path

from program_run import ProgramTest

MACHINE = {"host_name": "somewhere", "num_cpus": 8, "mhz_per_cpu": 3000, "cpu_scaling_enabled": False,
           "caches": [{"type": "Unified", "level": 2, "size": 2097152, "num_sharing": 1}], "load_avg": [0.3, 0.2, 0.1],
           "library_build_type": "release"}


def steady(name, seconds, seed, repetitions=10):
    """Evenly spread by a percent around a time; of two seeds, times differ but not their spread."""
    spread = random.Random(seed)
    rows = []
    for i in range(repetitions):
        time = 1e3 * seconds * spread.uniform(0.995, 1.005)
        rows.append({"name": name, "run_name": name, "run_type": "iteration", "repetition_index": i, "threads": 1,
                     "iterations": 10, "real_time": time, "cpu_time": time, "time_unit": "ms"})
    return rows


class ProgramCompare(ProgramTest):
    def timings(self, name, *benchmarks, **machine):
        """As Google Benchmark writes them."""
        rows = [row for benchmark in benchmarks for row in benchmark]
        return self.write(name, json.dumps({"context": {**MACHINE, **machine}, "benchmarks": rows}))

    def two(self, name, factor, seed):
        """Two benchmarks, the first slower by the given factor."""
        return self.timings(name, steady("apply/dcfft/64", factor * 61.2e-3, seed),
                            steady("apply|(direct)/8", 1e-6, seed + 1))

    def compare(self, factor, *words, code=0, says=()):
        """A base, and a new file that is as many times slower; None: as they stand."""
        if factor is not None:
            self.two("base.json", 1.0, 1)
            self.two("new.json", factor, 3)
        return self.run_program("compare", "base.json", "new.json", *words, code=code, says=says)

    def test_has_help_with_an_example(self):
        self.run_program("compare", "--help", says=("Example", "slipstick compare base.json new.json", "--json",
                                                    "--quiet", "Exit code"))

    def test_exit_code_says_what_was_found(self):
        self.compare(1.0, says="2 benchmarks: 2 same")
        self.compare(1.2, code=1, says=("apply/dcfft/64    61.", " ms  ", "slower (p ",
                                        "2 benchmarks: 1 same, 1 slower"))
        self.compare(0.8)
        self.compare(1.2, "--effect", "30%", "--level", "0.02", says="30 % or more, by chance in 2 of 100")
        self.compare(1.06, "--effect", "0.05", code=1)
        self.compare(1.2, "--level", "1e-9", code=2)  # too few repetitions for that

    def test_worst_stands_first(self):
        self.timings("base.json", steady("a", 1e-3, 1), steady("b", 1.0, 2), steady("c", 1e-9, 3))
        self.timings("new.json", steady("a", 1e-3, 4), steady("b", 1.2, 5), steady("c", 2e-9, 6))
        text = self.compare(None, code=1)
        self.assertLess(text.index("\n  c "), text.index("\n  b "))
        self.assertLess(text.index("\n  b "), text.index("\n  a "))

    def test_bad_input_is_exit_code_2(self):
        self.two("base.json", 1.0, 1)
        self.run_program("compare", "base.json", "/no/such/file.json", code=2, says="/no/such/file.json")
        self.write("new.json", '{"results": []}')
        self.compare(None, code=2, says=("new.json", "Google Benchmark"))
        self.run_program("compare", "base.json", code=2)
        for effect in ("10", "0", "-5%", "ten", "nan", "5%%", "150%"):
            self.compare(1.2, f"--effect={effect}", code=2, says=("--effect", "10% or 0.10"))
        for level in ("0", "0.6", "nan"):
            self.compare(1.2, "--level", level, code=2)
        self.compare(1.2, "--summary", "/no/such/folder/s.md", code=2)

    def test_what_cannot_be_judged_is_exit_code_2_and_shown(self):
        self.two("base.json", 1.0, 1)
        self.timings("new.json", steady("apply/dcfft/64", 2.0, 8), steady("apply|(direct)/8", 1e-6, 9),
                     host_name="elsewhere")
        self.compare(None, code=2, says=("machines differ", "elsewhere", "not judged", " s  ",
                                         "2 benchmarks: 2 not judged"))
        self.compare(None, "--same-machine", code=1)
        self.timings("new.json", steady("apply/fft/64", 61.2e-3, 8), steady("apply|(direct)/8", 1e-6, 9),
                     library_build_type="debug")
        self.compare(None, code=2, says="--debug-library")
        self.compare(None, "--debug-library", code=2, says=("only in base", "1 only in new"))

    def test_writes_json(self):
        result = json.loads(self.compare(1.2, "--json", "-", code=1))
        self.assertEqual((result["exit_code"], result["counts"]["slower"], len(result["benchmarks"])), (1, 1, 2))
        first = result["benchmarks"][0]
        self.assertEqual((first["name"], first["finding"]), ("apply/dcfft/64", "slower"))
        self.assertAlmostEqual(first["ratio"], 1.2, delta=0.01)
        self.assertLess(first["low"], first["ratio"])
        self.assertGreater(first["high"], first["ratio"])
        self.assertEqual(self.compare(1.2, "--quiet", code=1), "")

    def test_missing_numbers_are_null_with_a_reason(self):
        """JSON has no NaN: what is in one file only has no ratio, and says so."""
        self.timings("base.json", steady("a", 1e-3, 1), steady("b", 1.0, 2, 3))
        self.timings("new.json", steady("b", 1.2, 5, 3))
        alone, few = json.loads(self.compare(None, "--json", "-", code=2))["benchmarks"]
        self.assertIsNone(alone["ratio"])
        self.assertEqual(alone["ratio_reason"], "no times to compare")
        self.assertIsInstance(few["ratio"], float)
        for key in ("low", "high"):
            self.assertIsNone(few[key])
            self.assertIn("too few", few[f"{key}_reason"])

    def test_writes_junit_and_markdown(self):
        self.compare(1.2, "--junit", "out.xml", "--summary", "out.md", code=1)
        for file, parts in (("out.xml", ('tests="2" failures="1" errors="0"', '<failure message="slower',
                                         'name="apply|(direct)/8"')),
                            ("out.md", ("### 2 benchmarks: 1 same, 1 slower", "| apply/dcfft/64 | 61.",
                                        "| apply\\|(direct)/8 | "))):
            for part in parts:
                self.assertIn(part, Path(file).read_text())
        self.timings("new.json", steady("apply/dcfft/64", 1.0, 8), steady("other", 1e-6, 9), host_name='a "b" & <c>')
        self.compare(None, "--junit", "out.xml", code=2)
        for part in ('tests="4" failures="0" errors="4"', "a &quot;b&quot; &amp; &lt;c&gt;"):
            self.assertIn(part, Path("out.xml").read_text())

    def test_markdown_stays_below_64_kilobytes(self):
        self.timings("base.json", *(steady(f"{i:060}", 1e-3, i, 2) for i in range(1200)))
        self.timings("new.json", *(steady(f"{i:060}", 1e-3, 5000 + i, 2) for i in range(1200)))
        self.compare(None, "--quiet", "--summary", "out.md", code=2)
        self.assertLess(Path("out.md").stat().st_size, 64000)
        self.assertIn("none worse than these, are left out here", Path("out.md").read_text())
