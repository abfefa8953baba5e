"""slipstick.speed.timings: files of Google Benchmark, old and new, whole and broken."""
import json
import math
import unittest
from pathlib import Path

from slipstick.errors import InputError
from slipstick.speed import compare, timings

CORPUS = Path(__file__).resolve().parent / "corpus/timings"
# As version 1.7 writes it, shortened.
FILE = r"""{
  "context": {
    "date": "2026-11-20T21:13:05+00:00", "host_name": "vm", "num_cpus": 2, "mhz_per_cpu": 2100, "cpu_scaling_enabled": true,
    "caches": [ { "type": "Data", "level": 1, "size": 32768, "num_sharing": 1 } ],
    "load_avg": [0.52,0.34,1.2], "library_build_type": "debug", "build_type": "release", "session": "s1" },
  "benchmarks": [
    { "name": "apply/8", "family_index": 0, "per_family_instance_index": 0, "run_name": "apply/8", "run_type": "iteration",
      "repetitions": 2, "repetition_index": 0, "threads": 2, "iterations": 331, "real_time": 2.1e+03, "cpu_time": 2.0e+03,
      "time_unit": "us", "error": 1e-16, "flops": Infinity },
    { "name": "apply/8", "family_index": 0, "per_family_instance_index": 0, "run_name": "apply/8", "run_type": "iteration",
      "repetitions": 2, "repetition_index": 1, "threads": 2, "iterations": 331, "real_time": 2.2e+03, "cpu_time": 2.1e+03,
      "time_unit": "us", "error": 2e-16, "flops": -NaN, "label": "a label that says NaN, \"Infinity\" and C:\\" },
    { "name": "apply/8_mean", "family_index": 0, "per_family_instance_index": 0, "run_name": "apply/8",
      "run_type": "aggregate", "aggregate_name": "mean", "real_time": 2.15e+03, "cpu_time": 2.05e+03, "time_unit": "us" },
    { "name": "apply_BigO", "run_name": "apply", "run_type": "aggregate", "aggregate_name": "BigO", "cpu_coefficient": 1.2 },
    { "name": "apply_RMS", "run_name": "apply", "run_type": "aggregate", "aggregate_name": "RMS", "rms": 0.1 }
  ]
}"""


def file_with(*rows, context=""):
    return f'{{"context": {{"num_cpus": 4{context}}}, "benchmarks": [{", ".join(rows)}]}}'


def benchmarks(*rows):
    return timings.parse(file_with(*rows), "file.json").benchmarks


class TimingsTest(unittest.TestCase):
    def test_reads_context_and_repetitions(self):
        read = timings.parse(FILE, "file.json")
        self.assertEqual((read.host_name, read.cpus, read.mhz, read.load_average, read.library_build_type, read.build_type,
                          read.session), ("vm", 2, 2100.0, 0.52, "debug", "release", "s1"))
        self.assertIn("32768", read.caches)
        benchmark, = read.benchmarks  # fits are of no benchmark
        self.assertEqual([round(time, 18) for time in benchmark.real + benchmark.cpu], [2.1e-3, 2.2e-3, 2.0e-3, 2.1e-3])
        self.assertEqual(benchmark.counters, {"error": 2e-16})  # no infinity, no NaN
        self.assertEqual((benchmark.name, benchmark.threads, benchmark.error, benchmark.has_times()), ("apply/8", 2, "", True))

    def test_rows_become_benchmarks(self):
        for unit, factor in (("ns", 1e-9), ("us", 1e-6), ("ms", 1e-3), ("s", 1.0)):
            read, = benchmarks(f'{{"name": "a", "real_time": 3, "cpu_time": 2, "time_unit": "{unit}"}}')
            self.assertAlmostEqual(read.real[0] / factor, 3.0, delta=1e-14)
            self.assertAlmostEqual(read.cpu[0] / factor, 2.0, delta=1e-14)
        mean, = benchmarks('{"name": "a_mean", "run_name": "a", "run_type": "aggregate", "real_time": 1}')
        self.assertEqual((mean.name, mean.has_times()), ("a", False))
        two = benchmarks(*(f'{{"name": "a", "family_index": {i}, "real_time": 1, "cpu_time": 1}}' for i in (0, 0, 1)))
        self.assertEqual([(read.name, len(read.real)) for read in two], [("a", 2), ("a #2", 1)])
        read, = benchmarks(r'{"name": "a \"NaN, -inf\\", "real_time": 1, "cpu_time": 1, "flops": NaN}')
        self.assertEqual((read.name, read.counters), ('a "NaN, -inf\\', {}))

    def test_reads_pytest_benchmark(self):
        """Shortened from a file of its version 5; rounds that were not saved are no repetitions."""
        text = json.dumps({
            "machine_info": {"node": "vm", "cpu": {"count": 2, "brand_raw": "AMD EPYC", "l3_cache_size": 1048576}},
            "commit_info": {}, "version": "5.2.0", "benchmarks": [
                {"name": "test_few", "fullname": "a.py::test_few", "stats": {"rounds": 3, "median": 2e-3, "data": [2e-3, 1e-3, 3e-3]}},
                {"name": "test_many", "fullname": "a.py::test_many", "stats": {"data": [1e-3 + 1e-6 * i for i in range(3001)]}},
                {"name": "test_few", "fullname": "a.py::test_few", "stats": {"median": 1e-3}}]})
        read = timings.parse(text, "file.json")
        self.assertEqual((read.host_name, read.cpus, read.names_machine), ("vm", 2, True))
        few, many, unsaved = read.benchmarks
        self.assertEqual((few.name, few.real, few.has_times()), ("a.py::test_few", [2e-3, 1e-3, 3e-3], True))
        self.assertEqual((unsaved.name, unsaved.has_times()), ("a.py::test_few #2", False))
        self.assertEqual(len(many.real), 30)  # neighbours together, none left out
        self.assertEqual(many.real, sorted(many.real))
        self.assertAlmostEqual(many.real[0], 1e-3 + 49.5e-6, delta=1e-9)
        self.assertAlmostEqual(many.real[-1], 1e-3 + 2950e-6, delta=1e-6)
        for spoil, says in ((lambda t: t["benchmarks"][0].pop("stats"), "benchmarks[0].stats"),
                            (lambda t: t["benchmarks"][0]["stats"].update(data=["1"]), "stats.data"),
                            (lambda t: t["machine_info"].update(node=3), "machine_info.node")):
            tree = json.loads(text)
            spoil(tree)
            with self.assertRaises(InputError) as refused:
                timings.parse(json.dumps(tree), "file.json")
            self.assertIn(says, str(refused.exception))

    def test_reads_hyperfine_which_names_no_machine(self):
        text = json.dumps({"results": [
            {"command": "sleep 0.01", "mean": 0.0144, "user": 8e-4, "times": [0.0149, 0.0170], "exit_codes": [0, 0]},
            {"command": "true", "times": [0.0, 1e-3]}]})
        read = timings.parse(text, "file.json")
        sleep, true = read.benchmarks
        self.assertEqual((sleep.name, sleep.real, sleep.has_times()), ("sleep 0.01", [0.0149, 0.0170], True))
        self.assertIn("repetition 1 is 0", true.error)
        other = timings.parse(text.replace("0.0149", "0.0150"), "other.json")
        for same_machine in (False, True):
            found = compare.compare(read, other, compare.Rules(same_machine=same_machine)).obstacles
            self.assertEqual([] if same_machine else [True], ["--same-machine" in each for each in found])

    def test_failures_skips_and_times_that_are_none_say_why(self):
        failed, skipped = benchmarks('{"name": "a", "error_occurred": true, "error_message": "disagrees", "real_time": 0.0}',
                                     '{"name": "b", "skipped": true, "skip_message": "no GPU"}')
        self.assertEqual((failed.error, failed.has_times()), ("disagrees", False))
        self.assertEqual((skipped.error, skipped.skipped, skipped.has_times()), ("", "no GPU", False))
        for time in ("NaN", "-NaN", "Infinity", "null", "0.0", "-1.5"):
            read, = benchmarks(*(f'{{"name": "a", "real_time": {each}, "cpu_time": 1}}' for each in (1, time)))
            self.assertIn("repetition 2", read.error)
            self.assertFalse(read.has_times())

    def test_other_files_are_refused_by_name_and_place(self):
        for text, says in (
                ("hello", "Google Benchmark"), (FILE[:len(FILE) // 2], "is not JSON"), ("", "is not JSON"),
                ("3", "no context and benchmarks"), ('{"benchmarks": []}', "no context and benchmarks"),
                ('{"context": [], "benchmarks": []}', "no context and benchmarks"),
                ('{"context": {}, "benchmarks": {}}', "no context and benchmarks"), (file_with(), "holds no benchmark"),
                (file_with("3"), "benchmarks[0]"), (file_with("{}"), "benchmarks[0].name"),
                (file_with('{"name": "a"}'), "benchmarks[0].real_time"),
                (file_with('{"name": "a", "real_time": 3, "time_unit": "min"}'),
                 'benchmarks[0].time_unit = "min": allowed: ns, us, ms, s'),
                (file_with('{"name": "a", "real_time": "1 ns"}'), "a number"),
                (file_with('{"name": "a", "real_time": 1e400}'), "1e400"),
                (file_with(f'{{"name": "a", "real_time": 1{400 * "0"}}}'), "too large"),
                (file_with('{"name": "a", "real_time": true}'), "a number"),
                (file_with('{"name": "a", "real_time": 1}', context=', "load_avg": 3'), "context.load_avg"),
                (file_with(200 * "[" + 200 * "]"), "more than 200 deep"), (100000 * "[", "more than 200 deep")):
            with self.assertRaises(InputError) as refused:
                timings.parse(text, "file.json")
            self.assertIn("file.json", str(refused.exception))
            self.assertIn(says, str(refused.exception))

    def test_any_text_is_compared_with_itself_or_refused(self):
        """The findings of fuzzers, and these cut off anywhere."""
        compared = 0
        for path in sorted(CORPUS.glob("*.json")):
            text = path.read_text()
            for size in range(len(text), 0, -max(1, len(text) // 50)):
                try:
                    read = timings.parse(text[:size], "new.json")
                except InputError:
                    continue
                report = compare.report("base.json", "new.json", compare.Rules(), compare.compare(read, read))
                json.dumps(report, allow_nan=False)
                compared += 1
        self.assertGreaterEqual(compared, 9)
        self.assertTrue(math.isnan(timings.parse((CORPUS / "bare-nan.json").read_text(), "new.json").benchmarks[0].real[0]))
