"""Statistics and report of `slipstick compare`: is any benchmark slower, and can that be judged?"""
from __future__ import annotations

import math
import statistics
from dataclasses import dataclass, field, replace
from typing import Any

from .. import verdict_files
from ..errors import InputError
from . import rank_tests, timings
from .obstacles import Rules, find_obstacles
from .timings import Benchmark, Timings, are_paired

# The verdicts on one benchmark, from the worst to the best. Undecided: slower by more than the threshold, but not
# significantly. Too few: this number of repetitions cannot prove any change. Failed: in the new file only. Not timed: it failed
# in the base, skipped itself, or has no repetitions. Not judged: an obstacle forbids it.
SEVERITY = ("slower", "failed", "undecided", "only in base", "only in new", "not timed", "too few", "not judged", "quicker",
            "same")
FAILURES = ("slower", "failed")
FINE = ("same", "quicker")
BY_TIMES = ("same", "slower", "quicker", "undecided", "too few")
SECOND_RUN = (*FAILURES, "undecided")


@dataclass
class Compared:
    """One benchmark of either file. Missing numbers, and the interval of too small a sample, are NaN."""
    name: str
    finding: str = "not judged"
    base_seconds: float = math.nan  # medians, by the clock
    new_seconds: float = math.nan
    ratio: float = math.nan  # new over base: Hodges and Lehmann's estimate (1963) on logarithms
    low: float = math.nan  # its 95 % interval
    high: float = math.nan
    p_value: float = math.nan  # of a ratio of one or below (above, where it is below one), with Holm's correction
    base_repetitions: int = 0
    new_repetitions: int = 0
    remark: str = ""


@dataclass
class Comparison:
    benchmarks: list[Compared] = field(default_factory=list)  # in the base's order, then those only in the new file
    obstacles: list[str] = field(default_factory=list)  # why times could not be judged: the machines, the build, the load
    paired: bool = False  # repetition by repetition

    def exit_code(self) -> int:
        """1: a benchmark is slower or failed in the new file only. 2: else, where something could not be judged, or nothing
        was."""
        findings = {benchmark.finding for benchmark in self.benchmarks}
        if findings & set(FAILURES):
            return 1
        return 0 if findings and findings <= set(FINE) and not self.obstacles else 2


def _log_ratio(base: Benchmark, now: Benchmark, paired: bool) -> rank_tests.Shift:
    """The shift of the logarithms of times, which is the logarithm of their ratio."""
    before, after = ([math.log(time) for time in benchmark.real] for benchmark in (base, now))
    if not paired:
        return rank_tests.rank_sum_shift(before, after)
    return rank_tests.signed_rank_shift([later - earlier for earlier, later in zip(before, after)])


def _trouble(benchmark: Benchmark) -> str:
    """Why a benchmark has no times to compare; empty: it has."""
    if benchmark.error or benchmark.skipped:
        return benchmark.error or "skipped: " + benchmark.skipped
    if not benchmark.real:
        return "aggregates only, no repetitions"
    return "" if benchmark.has_times() else "a time is no number above zero"


def _match(base: Benchmark | None, now: Benchmark | None) -> Compared:
    """A benchmark before times are compared, not judged where there are some; None: the file does not hold it."""
    given = base or now
    assert given is not None
    matched = Compared(given.name)
    if base is not None:
        matched.base_repetitions = len(base.real)
        matched.base_seconds = statistics.median(base.real) if base.has_times() else math.nan
    if now is not None:
        matched.new_repetitions = len(now.real)
        matched.new_seconds = statistics.median(now.real) if now.has_times() else math.nan
    if base is None or now is None:
        matched.finding = "only in base" if now is None else "only in new"
    elif _trouble(base):
        matched.finding, matched.remark = "not timed", "in the base: " + _trouble(base)
    elif _trouble(now):
        matched.finding, matched.remark = "failed" if now.error or now.real else "not timed", _trouble(now)
    return matched


def _finding(benchmark: Compared, could_show: bool, rules: Rules) -> str:
    """The verdict by the numbers, which are all set."""
    slow = 1.0 + rules.effect
    if benchmark.p_value <= rules.level and benchmark.ratio >= slow:
        return "slower"
    if benchmark.p_value <= rules.level and benchmark.ratio <= 1.0 / slow:
        return "quicker"
    return "too few" if not could_show else "same" if benchmark.ratio < slow else "undecided"


def _remark(benchmark: Compared, enough: int, rules: Rules) -> str:
    """A remark on numbers that could be misread."""
    if benchmark.finding == "too few":
        return f"no change can be significant; {enough} repetitions in each file would do"
    if benchmark.finding == "same" and benchmark.low > 1.0:
        return "slower, below what counts"
    if benchmark.finding == "same" and not benchmark.high < 1.0 + rules.effect:
        return f"scatters too much to rule {100.0 * rules.effect:.0f} % out"
    return ""


def _judge(pairs: list[tuple[Compared, rank_tests.Shift]], paired: bool, rules: Rules) -> None:
    positive = rank_tests.holm([shift.p_positive for _, shift in pairs])
    negative = rank_tests.holm([shift.p_negative for _, shift in pairs])
    enough = 2  # repetitions in each file from which on a change can be significant
    while not rank_tests.least_chance(enough, enough, paired) * len(pairs) <= rules.level:
        enough += 1
    for i, (benchmark, shift) in enumerate(pairs):
        benchmark.ratio, benchmark.low, benchmark.high = (math.exp(x) for x in (shift.estimate, shift.low, shift.high))
        benchmark.p_value = negative[i] if shift.estimate < 0.0 else positive[i]
        least = rank_tests.least_chance(benchmark.base_repetitions, benchmark.new_repetitions, paired)
        benchmark.finding = _finding(benchmark, least * len(pairs) <= rules.level, rules)
        benchmark.remark = _remark(benchmark, enough, rules)


def compare(base: Timings, now: Timings, rules: Rules = Rules()) -> Comparison:
    """Two files of one session are compared repetition by repetition (Wilcoxon's signed ranks on the logarithms of ratios),
    others as independent samples (Mann and Whitney's test), both exactly. An obstacle leaves the numbers and takes the
    verdicts."""
    comparison = Comparison(paired=are_paired(base, now))
    known, pairs = {after.name: after for after in now.benchmarks}, []
    for before in base.benchmarks:
        after = known.pop(before.name, None)
        comparison.benchmarks.append(_match(before, after))
        if after is not None and comparison.benchmarks[-1].finding == "not judged":
            pairs.append((comparison.benchmarks[-1], _log_ratio(before, after, comparison.paired)))
    comparison.benchmarks += [_match(None, after) for after in known.values()]
    _judge(pairs, comparison.paired, rules)
    comparison.obstacles = find_obstacles(base, now, rules)
    for benchmark in comparison.benchmarks if comparison.obstacles else ():
        if benchmark.finding in BY_TIMES:
            benchmark.finding, benchmark.remark = "not judged", ""
    return comparison


def confirm(first: Comparison, second: Comparison) -> Comparison:
    """A comparison after its benchmarks of SECOND_RUN ran again. A benchmark is slower if both runs find it as much slower as
    counts and the second one significantly so, failed if it failed in both, undecided if the second run could neither prove nor
    clear it. The second run is a test of its own, of few benchmarks, so that it alarms by chance no more often than its level
    says. The numbers are the first run's, the chance is the second's."""
    again = {benchmark.name: benchmark for benchmark in second.benchmarks}
    result = replace(first, benchmarks=[replace(benchmark) for benchmark in first.benchmarks],
                     obstacles=first.obstacles + second.obstacles)
    for benchmark in result.benchmarks:
        if benchmark.finding not in SECOND_RUN:
            continue
        then = again.get(benchmark.name)
        benchmark.remark += (f"{'; ' if benchmark.remark else ''}first run: {_numbers(benchmark)}; "
                             f"second: {_numbers(then) if then else 'it did not run'}")
        if then is None:
            benchmark.finding = "undecided"
            continue
        benchmark.p_value = then.p_value
        if (benchmark.finding, then.finding) == ("undecided", "slower") or benchmark.finding == then.finding:
            benchmark.finding = then.finding
        else:
            benchmark.finding = "same" if then.finding in FINE else "undecided"
    return result


def _numbers(benchmark: Compared) -> str:
    if not math.isfinite(benchmark.ratio):
        return benchmark.finding
    return f"{benchmark.finding} ({benchmark.ratio:.3f}, p {benchmark.p_value:.1g})"


# ---------------------------------------------------------------- report

HEADER = ("benchmark", "base", "new", "new/base", "95 % interval", "verdict")


def _seconds(seconds: float) -> str:
    if not math.isfinite(seconds):
        return "-"
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6), ("ns", 1e-9)):
        if seconds >= size:
            return f"{seconds / size:.4g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def _verdict(benchmark: Compared) -> str:
    """With the chance that it is none, where that says something."""
    if benchmark.finding == "same" and benchmark.low > 1.0:
        return benchmark.remark
    has_chance = benchmark.finding in (*SECOND_RUN, "quicker") and math.isfinite(benchmark.p_value)
    return f"{benchmark.finding} (p {benchmark.p_value:.1g})" if has_chance else benchmark.finding


def _row(benchmark: Compared) -> list[str]:
    return [benchmark.name, _seconds(benchmark.base_seconds), _seconds(benchmark.new_seconds),
            f"{benchmark.ratio:.3f}" if math.isfinite(benchmark.ratio) else "-",
            f"{benchmark.low:.3f} to {benchmark.high:.3f}" if math.isfinite(benchmark.low) else "-", _verdict(benchmark)]


def _table(benchmarks: list[Compared]) -> str:
    width = max(len(name) for name in (HEADER[0], *(benchmark.name for benchmark in benchmarks)))

    def line(row: Any) -> str:
        return f"  {row[0]:<{width}}  {row[1]:>8}  {row[2]:>8}  {row[3]:>8}  {row[4]:>14}  {row[5]}\n"

    text = line(HEADER)
    for benchmark in benchmarks:
        row = _row(benchmark)
        text += line(row) + (f"      {benchmark.remark}\n" if benchmark.remark not in ("", row[-1]) else "")
    return text


def _counts(benchmarks: list[Compared]) -> dict[str, int]:
    return {finding: sum(benchmark.finding == finding for benchmark in benchmarks) for finding in SEVERITY}


def _json(benchmark: Compared) -> dict[str, Any]:
    """A number that is missing is null, with a reason."""
    no_times = "no times to compare"
    no_interval = "too few repetitions for an interval" if math.isfinite(benchmark.ratio) else no_times
    reasons = {"base_seconds": "no time", "new_seconds": "no time", "ratio": no_times, "low": no_interval, "high": no_interval,
               "p_value": no_times}
    row: dict[str, Any] = {}
    for key, value in vars(benchmark).items():
        row[key] = value
        if isinstance(value, float) and not math.isfinite(value):
            row[key], row[f"{key}_reason"] = None, reasons[key]
    return row


def _case(benchmark: Compared) -> dict[str, Any]:
    """A case of a JUnit file: a slower or failed benchmark is a failure, one that could not be judged an error."""
    _, base, new, ratio, interval, verdict = _row(benchmark)
    shown = f"base {base}, new {new}, new/base {ratio} ({interval})"
    case = {"name": benchmark.name, "type": benchmark.finding, "shown": shown, "verdict": "passed",
            "seconds": benchmark.new_seconds if math.isfinite(benchmark.new_seconds) else 0.0}
    if benchmark.finding in FINE:
        return case
    return {**case, "verdict": "failure" if benchmark.finding in FAILURES else "error", "details": shown,
            "message": verdict + (f": {benchmark.remark}" if benchmark.remark else "")}


def report(base: str, now: str, rules: Rules, comparison: Comparison, second: Comparison | None = None) -> dict[str, Any]:
    """The comparison as a text with the worst benchmark first, as the JSON result, and as the rows of JUnit's XML and of a table
    in Markdown. base, now: names of the files. second: the second run of the benchmarks that looked slower, if any."""
    worst_first = sorted(comparison.benchmarks, key=lambda benchmark: (
        SEVERITY.index(benchmark.finding), 0.0 if math.isnan(benchmark.ratio) else -benchmark.ratio))
    counts = _counts(comparison.benchmarks)
    total = len(comparison.benchmarks)
    counted = ", ".join(f"{number} {finding}" for finding, number in reversed(counts.items()) if number)
    title = f"{total} benchmark{'' if total == 1 else 's'}: {counted}"
    heading = f"{now} against {base}, {'repetition by repetition' if comparison.paired else 'as independent runs'}"
    counting = (f"what counts: {100.0 * rules.effect:.3g} % or more, by chance in {100.0 * rules.level:.3g} of 100 such "
                "comparisons at most")
    obstacles = [{"name": f"obstacle {i}", "type": "obstacle", "verdict": "error", "message": obstacle}
                 for i, obstacle in enumerate(comparison.obstacles, 1)]
    result = {"exit_code": comparison.exit_code(), "base": base, "new": now, "effect": rules.effect, "level": rules.level,
              "paired": comparison.paired, "counts": counts, "obstacles": comparison.obstacles,
              "benchmarks": [_json(benchmark) for benchmark in comparison.benchmarks]}
    if second is not None:
        result["second_run"] = [_json(benchmark) for benchmark in second.benchmarks]
    return {"exit_code": comparison.exit_code(), "result": result, "heading": heading, "title": title, "rules": counting,
            "text": "".join((f"{heading}\n", _table(worst_first), *(f"could not judge: {obstacle}\n" for obstacle in
                                                                    comparison.obstacles), f"{title} ({counting})\n")),
            "junit": verdict_files.junit("slipstick compare", heading, [*obstacles, *map(_case, comparison.benchmarks)]),
            "markdown": verdict_files.markdown_table(
                f"### {title}\n\n{verdict_files.markdown_text(heading)}; {counting}.\n\n"
                + "".join(f"- could not judge: {verdict_files.markdown_text(each)}\n" for each in comparison.obstacles) + "\n",
                [*HEADER, ""], [[verdict_files.markdown_text(benchmark.name), *_row(benchmark)[1:],
                                 verdict_files.markdown_text(benchmark.remark)] for benchmark in worst_first], "benchmarks")}


def _effect(text: str) -> float:
    """"10%" or "0.10"."""
    try:
        effect = float(text[:-1]) / 100.0 if text.endswith("%") else float(text)
    except ValueError:
        effect = math.nan
    if not 0.0 < effect <= 1.0:
        raise InputError(f"command line: --effect = {text}: allowed: a part of the time, as 10% or 0.10, up to 100%")
    return effect


def answer(request: dict[str, Any]) -> dict[str, Any]:
    """Compares the texts of two files."""
    level = math.nan if request["level"] is None else request["level"]  # JSON has no NaN
    if not 0.0 < level <= 0.5:
        raise InputError(f"command line: --level = {level:g}: allowed: a chance above 0, at most 0.5")
    rules = Rules(_effect(request["effect"]), level, request["same_machine"], request["debug_library"])
    base, now = (timings.parse(request[f"{side}_text"], request[side]) for side in ("base", "new"))
    return report(request["base"], request["new"], rules, compare(base, now, rules))
