"""slipstick.speed.compare: slower benchmarks, benchmarks that cannot be judged, and how often it is wrong about made times."""
import copy
import math
import random
import unittest

import numpy as np
from slipstick.speed.compare import Compared, Comparison, Rules, compare, confirm
from slipstick.speed.timings import Benchmark, Timings

REPETITIONS = 10


def file_of(name, benchmarks):
    return Timings(name, benchmarks, host_name="somewhere", cpus=8, mhz=3000.0, load_average=0.3, library_build_type="release")


def timed(name, seconds):
    """One benchmark with these times, all of them the processor's."""
    return Benchmark(name, real=list(seconds), cpu=list(seconds))


def steady(name, seconds, seed, repetitions=REPETITIONS):
    """Evenly spread by a percent around a time; of two seeds, times differ but not their spread."""
    spread = random.Random(seed)
    return timed(name, [seconds * spread.uniform(0.995, 1.005) for _ in range(repetitions)])


def run_of(base, now, others=3):
    """Both files have steady benchmarks in addition to the given ones."""
    return (file_of("base.json", base + [steady(f"steady/{i}", 1e-3, 100 + i) for i in range(others)]),
            file_of("new.json", now + [steady(f"steady/{i}", 1e-3, 200 + i) for i in range(others)]))


def changed(factor, repetitions=REPETITIONS):
    """One benchmark, in the new file `factor` times as long."""
    return run_of([steady("it", 1e-3, 1, repetitions)], [steady("it", factor * 1e-3, 2, repetitions)])


def found(comparison):
    return next(benchmark for benchmark in comparison.benchmarks if benchmark.name == "it")


def draw(generator, benchmarks, repetitions, paired, slower=0, factor=1.0, scatter=0.03, outliers=0.05, drift=0.0):
    """Two files of equal benchmarks, but that the first `slower` ones take `factor` times as long in the new one. Times scatter
    as on real machines: lognormal, now and then (outliers: as a part of all) a third longer, and slowly changing speed that
    two builds run in turn share (drift: from one repetition to the next)."""
    shape = (2, benchmarks, repetitions)
    times = 1e-3 * np.exp(scatter * generator.normal(size=shape)) * np.where(generator.random(shape) < outliers, 1.3, 1.0)
    times *= np.exp(drift * generator.normal(size=shape[1:])).cumprod(axis=1)
    times[1, :slower] *= factor
    files = [file_of(name, [timed(f"operator/{i}", row) for i, row in enumerate(rows.tolist())])
             for name, rows in zip(("base.json", "new.json"), times)]
    for file in files:
        file.session = "one" if paired else ""
    return files


class ComparisonTest(unittest.TestCase):
    def expect(self, run, finding, code, remark="", **rules):
        comparison = compare(*run, Rules(**rules))
        self.assertEqual((found(comparison).finding, comparison.exit_code()), (finding, code))
        self.assertIn(remark, found(comparison).remark)

    def test_ratio_is_within_the_spread_of_the_times(self):
        it = found(compare(*changed(1.3)))
        self.assertAlmostEqual(it.ratio, 1.3, delta=0.01)
        self.assertTrue(it.low < it.ratio < it.high)
        self.assertAlmostEqual(it.base_seconds, 1e-3, delta=5e-6)
        self.assertAlmostEqual(it.new_seconds, 1.3e-3, delta=7e-6)
        self.assertAlmostEqual(it.p_value, 4 / 184756, delta=1e-12)  # separated samples of 10 and 10, one of four
        self.assertEqual(it.base_repetitions, REPETITIONS)

    def test_only_a_change_that_counts_is_slower(self):
        for factor, finding, code, effect in ((1.15, "slower", 1, 0.1), (1.0, "same", 0, 0.1), (1 / 1.08, "same", 0, 0.1),
                                              (1 / 1.15, "quicker", 0, 0.1), (1.08, "slower", 1, 0.05), (1.15, "same", 0, 0.2)):
            self.expect(changed(factor), finding, code, effect=effect)
        self.expect(changed(1.08), "same", 0)  # significant, but too small to count
        self.assertLess(found(compare(*changed(1.08))).p_value, 0.01)
        self.expect(changed(1.06), "same", 0, "slower, below what counts")
        scattered = [1e-3 * (1 + 0.05 * i) for i in range(10)]
        self.expect(run_of([timed("it", scattered)], [timed("it", scattered[::-1])]), "same", 0,
                    "scatters too much to rule 10 % out")

    def test_slower_by_chance_is_undecided(self):
        """56 of the hundred differences are positive, most by a third: the median is, and the ranks prove nothing."""
        close = [1 + 0.001 * i for i in range(10)]
        run = run_of([timed("it", [time * (1.6 if i < 3 else 1.0) for i, time in enumerate(close)])],
                     [timed("it", [time * (1.3 if i < 8 else 0.9) for i, time in enumerate(close)])])
        self.expect(run, "undecided", 2)
        self.assertGreaterEqual(found(compare(*run)).ratio, 1.1)
        self.assertGreater(found(compare(*run)).p_value, 0.01)

    def test_counts_the_least_chance_as_often_as_there_are_benchmarks(self):
        """Holm (1979): the least chance of m benchmarks counts m times. Here all but one of 36 pairs of 6 and 6 repetitions
        stand one way, with the chance 2 / C(12, 6) = 2/924: 4 times that is below the level of 0.01, 5 times is above."""
        for factor, other, decided, undecided in ((0.8, 1.0005, "quicker", "same"), (1.25, 1.0045, "slower", "undecided")):
            base = [1 + 0.001 * i for i in range(6)]
            now = [factor * time for time in base]
            now[-1 if factor < 1 else 0] = other
            for others, finding in ((3, decided), (4, undecided)):
                it = found(compare(*run_of([timed("it", base)], [timed("it", now)], others)))
                self.assertAlmostEqual(it.p_value, (others + 1) * 2 / 924, delta=1e-12)
                self.assertEqual(it.finding, finding)

    def test_too_few_repetitions_are_no_pass(self):
        """Four benchmarks: 4 / C(2 n, n) <= 0.01 from n = 6 on (924; 252 for n = 5)."""
        self.expect(changed(2.0, 3), "too few", 2, "6 repetitions")
        self.expect(changed(1.0, 1), "too few", 2)
        self.expect(changed(2.0, 6), "slower", 1)

    def test_pairs_need_more_repetitions(self):
        """30 / 2^n <= 0.01 from n = 12 on."""
        generator = np.random.default_rng(3)
        few, enough = (compare(*draw(generator, 30, n, True, 1, 2.0, scatter=0.001, outliers=0.0)) for n in (11, 12))
        self.assertTrue(few.paired)
        self.assertEqual((few.benchmarks[0].finding, few.exit_code(), enough.exit_code()), ("too few", 2, 1))
        self.assertIn("12 repetitions", few.benchmarks[0].remark)
        self.assertFalse(compare(*draw(generator, 30, 11, False)).paired)

    def test_benchmarks_in_one_file_and_failures_are_reported(self):
        a, b, good, new = (steady(name, 1e-3, 5) for name in ("a", "b", "it", "new"))
        failed, skipped, bad = Benchmark("it", error="disagrees"), Benchmark("it", skipped="no GPU"), copy.deepcopy(good)
        for base, now, finding, code, remark in (
                ([good], [], "only in base", 2, ""), ([], [good], "only in new", 2, ""),
                ([good], [failed], "failed", 1, "disagrees"), ([failed], [good], "not timed", 2, "in the base"),
                ([failed], [failed], "not timed", 2, "in the base"), ([good], [skipped], "not timed", 2, "skipped: no GPU"),
                ([good], [Benchmark("it")], "not timed", 2, "aggregates only")):
            self.expect(run_of(base, now), finding, code, remark)
        for time in (math.nan, math.inf, 0.0, -1.0):
            bad.real[4] = time
            self.expect(run_of([good], [bad]), "failed", 1)
            self.expect(run_of([bad], [good]), "not timed", 2)
        self.assertEqual((compare(*run_of([a], [b], 0)).exit_code(), Comparison().exit_code()), (2, 2))
        names = [benchmark.name for benchmark in compare(*run_of([b, a], [new, a, b], 0)).benchmarks]
        self.assertEqual(names, ["b", "a", "new"])  # the base's order

    def test_rules_that_mean_nothing_are_refused(self):
        for rules in (*({"effect": value} for value in (0.0, -0.1, math.nan)),
                      *({"level": value} for value in (0.0, 1.0, math.nan))):
            self.assertRaises(ValueError, Rules, **rules)


class ObstaclesTest(unittest.TestCase):
    def expect(self, says, change=None, rules=None, now=None, base=None):
        """After a change to the files, or to one file's context: the obstacle, empty: none. One benchmark is slower by half."""
        files = changed(1.5)
        for file, values in zip(files, (base, now)):
            vars(file).update(values or {})
        if change is not None:
            change(*files)
        comparison = compare(*files, Rules(**(rules or {})))
        if not says:
            self.assertEqual((comparison.obstacles, comparison.exit_code()), ([], 1))
            return
        self.assertEqual((comparison.exit_code(), found(comparison).finding), (2, "not judged"))
        self.assertAlmostEqual(found(comparison).ratio, 1.5, delta=0.02)  # the numbers stay
        for part in says:
            self.assertIn(part, comparison.obstacles[0])

    def test_different_machines(self):
        self.expect(())
        for now, shown in (({"cpus": 4}, "num_cpus"), ({"host_name": "elsewhere"}, "host_name"),
                           ({"mhz": 3180.0}, "mhz_per_cpu"), ({"mhz": math.nan}, "mhz_per_cpu"),
                           ({"caches": '[{"level":2}]'}, "caches")):
            self.expect(("machines differ", shown), now=now)
            self.expect((), now=now, rules={"same_machine": True})
        self.expect((), now={"mhz": 3120.0})
        self.expect((), base={"session": "one"}, now={"session": "one", "mhz": 6000.0})  # one machine, whose clock may change

    def test_debug_builds(self):
        self.expect(("base.json", "--debug-library"), base={"library_build_type": "debug"})
        self.expect((), base={"library_build_type": "debug"}, rules={"debug_library": True})
        self.expect((), now={"library_build_type": "debug", "build_type": "release"})
        self.expect(("new.json", "debug build"), now={"build_type": "Debug"}, rules={"debug_library": True})

    def test_load_that_the_run_does_not_explain(self):
        for side, name in enumerate(("base.json", "new.json")):
            for average, threads, says in ((5.1, 1, (name, "loaded")), (4.9, 1, ()), (5.1, 2, ())):
                def load(*files):
                    files[side].load_average, files[side].benchmarks[-1].threads = average, threads
                self.expect(says, load)

    def test_most_benchmarks_wait(self):
        for side, factor, count, session, name, says in (
                (1, 1.6, 4, "", "", ("new.json", "4 of 4")), (0, 1.6, 4, "", "", ("base.json",)), (1, 1.2, 4, "", "", ()),
                (1, 20.0, 4, "", "", ()),  # by their nature
                (1, 1.6, 2, "", "", ()),  # a sleep in two of four
                (1, 1.6, 4, "one", "", ()),  # both sides of a pair wait alike
                (1, 1.6, 4, "", "/manual_time", ())):  # three bring their own clock
            def wait(*files):  # the first benchmarks of a file take longer by the clock than by the processor's time
                for benchmark in files[side].benchmarks[:count]:
                    benchmark.cpu = [time / factor for time in benchmark.real]
                for file in files:
                    file.session = session
                    for benchmark in file.benchmarks[1:]:
                        benchmark.name += name
            self.expect(says, wait)

    def test_one_run_against_itself(self):
        base, now = run_of([], [])
        now.benchmarks = base.benchmarks
        comparison = compare(base, now)
        self.assertEqual((len(comparison.obstacles), comparison.exit_code()), (1, 2))
        self.assertIn("compared with itself", comparison.obstacles[0])


def of_finding(finding, p_value=math.nan):
    return Comparison([Compared("it", finding, p_value=p_value)])


class SecondRunTest(unittest.TestCase):
    def test_only_what_it_confirms_counts(self):
        open_ones = ("undecided", "not judged", "only in base", "too few", "not timed")
        for first, seconds, code in (
                ("slower", ("slower",), 1), ("failed", ("failed",), 1), ("undecided", ("slower",), 1),  # a test of its own
                ("failed", ("slower",), 2), ("slower", ("failed",), 2),
                *((first, ("same", "quicker"), 0) for first in ("slower", "failed", "undecided")),
                *((first, open_ones, 2) for first in ("slower", "failed", "undecided"))):
            for second in seconds:
                self.assertEqual(confirm(of_finding(first), of_finding(second)).exit_code(), code, (first, second))
        self.assertEqual(confirm(of_finding("slower"), Comparison()).exit_code(), 2)
        self.assertEqual(confirm(of_finding("same"), Comparison()).exit_code(), 0)
        self.assertEqual(confirm(of_finding("same"), Comparison(obstacles=["the machines differ"])).exit_code(), 2)
        remark = confirm(of_finding("slower"), of_finding("same")).benchmarks[0].remark
        self.assertEqual(remark, "first run: slower; second: same")
        first = of_finding("slower", 0.04)
        self.assertEqual(confirm(first, of_finding("slower", 0.002)).benchmarks[0].p_value, 0.002)  # of the test that decided
        self.assertEqual(confirm(first, Comparison()).benchmarks[0].p_value, 0.04)


DRIFTING = {"drift": 0.05}  # wilder than a quiet server: times in turn, while the speed of the machine wanders
IDLE = {"scatter": 0.02, "outliers": 0.02}


class MadeTimesTest(unittest.TestCase):
    def judged(self, draw_files):
        """Exit codes after the first run, and after the second run of the benchmarks that looked slower."""
        first = compare(*draw_files())
        names = {benchmark.name for benchmark in first.benchmarks if benchmark.finding in ("slower", "failed", "undecided")}
        if not names:
            return first.exit_code(), first.exit_code()
        again = draw_files()
        for file in again:
            file.benchmarks = [benchmark for benchmark in file.benchmarks if benchmark.name in names]
        return first.exit_code(), confirm(first, compare(*again)).exit_code()

    def test_a_build_against_itself_gives_no_alarm(self):
        """No alarm in 500 runs: with 95 %, fewer than one in 160 gives one. Where one repetition in twenty takes a third
        longer, once in thousands of benchmarks half of a file's do: what is doubtful by that, the second run clears."""
        generator = np.random.default_rng(11)
        for repetitions, paired, noise in ((16, True, DRIFTING), (10, False, {})):
            verdicts = [self.judged(lambda: draw(generator, 30, repetitions, paired, **noise)) for _ in range(500)]
            self.assertNotIn(1, {first for first, _ in verdicts})
            self.assertEqual({confirmed for _, confirmed in verdicts}, {0})
            self.assertLessEqual(sum(first == 2 for first, _ in verdicts), 5)

    def test_alarms_come_as_often_as_the_level_says_where_every_change_counts(self):
        """400 runs at 5 % give 20 alarms in the mean, and 33 at three standard deviations; some must occur."""
        generator = np.random.default_rng(13)
        for paired in (True, False):
            alarms = sum(compare(*draw(generator, 5, 10, paired, **DRIFTING), Rules(effect=1e-9, level=0.05)).exit_code() == 1
                         for _ in range(400))
            self.assertLessEqual(alarms, 33)
            self.assertGreaterEqual(alarms, 3 if paired else 0)

    def test_fifteen_percent_are_found_every_time(self):
        """As on an idle machine, run in turn while its speed wanders. Among 30 benchmarks the first run does not always prove
        the slowdown, but always repeats the benchmark, and the second run proves it."""
        generator = np.random.default_rng(15)
        for paired, repetitions, noise, runs in ((True, 20, {**IDLE, **DRIFTING}, 200), (False, 14, IDLE, 100)):
            for _ in range(runs):
                first, confirmed = self.judged(lambda: draw(generator, 30, repetitions, paired, 1, 1.15, **noise))
                self.assertNotEqual(first, 0)
                self.assertEqual(confirmed, 1)
