#!/usr/bin/env python3
"""Makes small mistakes in the sources by rule, one at a time, and lists the mistakes that neither tests nor gates detect.

All C++ mutants are compiled into one build, each behind a switch. Each runs against the test suites of its folder that reach
it, the quickest first, and then against convergence/gates/quick.toml. Python mutants run against the tests of reports/.
judged.toml gives the reasons why some survivors are no gaps. Exit code 0: all others are detected; 1: some are not; 2: nothing could be
judged."""

import argparse
import json
import random
import sys
import tomllib
from collections import Counter, defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import mutated_build
import rules
import runs

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("analytic", "solver", "convergence", "bench", "reports")
# A mutant there could end other processes, or remove their files.
DANGEROUS = ("convergence/programs/run_program.cpp", "solver/input/whole_file.cpp")
# Programs that `make test` does not build: they check their own results.
NOT_TESTED = ("bench/suite/", "bench/work/work_counts_program.cpp", "analytic/certified/missing.cpp")
SPARE = 1.7  # proposed mutants for each requested one: not all of them compile


def sources(folder):
    pattern = "*.py" if folder == "reports" else "**/*.cpp"
    for path in sorted((ROOT / folder).glob(pattern)):
        name = path.relative_to(ROOT).as_posix()
        if "tests" not in path.parts and name not in DANGEROUS and not name.startswith(NOT_TESTED):
            yield name, path.read_text()


def sample(folder, count, chance):
    """`count` mutations of a folder, (file, text, mutation), rule by rule in turn, no two at the same place."""
    by_rule = defaultdict(list)
    for name, text in sources(folder):
        for mutation in rules.proposals(text, folder == "reports"):
            by_rule[mutation.rule].append((name, text, mutation))
    for found in by_rule.values():
        chance.shuffle(found)
    taken, of_file = [], defaultdict(list)
    while len(taken) < count and any(by_rule.values()):
        for rule in sorted(by_rule):
            while by_rule[rule]:
                name, text, mutation = by_rule[rule].pop()
                if not rules.overlaps(mutation, of_file[name]):
                    of_file[name].append(mutation)
                    taken.append((name, text, mutation))
                    break
    return taken[:count]


def propose(options):
    """For each folder, the number of requested mutants, and proposals in the order in which they are used."""
    proposed, number = {}, 0
    for i, folder in enumerate(options.folder):
        wanted = options.count * (i + 1) // len(options.folder) - options.count * i // len(options.folder)
        spare = 1 if folder == "reports" else SPARE
        found = sample(folder, int(spare * wanted), random.Random(f"{options.seed} {folder}"))
        proposed[folder] = wanted, [mutated_build.mutant_of(number + k, *each) for k, each in enumerate(found, 1)]
        number += len(found)
    return proposed


def judge(mutants, build, options, say):
    """{mutant: the test that detected it}; "": it survives, None: no test reaches it."""
    highest = max((each.number for each in mutants), default=0)
    folders = {each.folder for each in mutants} - {"reports"}
    tests = runs.python_tests(build.source / "reports", say) if any(each.folder == "reports" for each in mutants) else []
    suites = {folder: list(runs.google_suites(build.build, folder)) for folder in folders}
    gate = runs.gates(build.source, build.build)
    with ThreadPoolExecutor(options.jobs) as pool:
        everything = [suite for each in suites.values() for suite in each] + ([gate] if options.gates and folders else [])
        for trouble in pool.map(lambda suite: runs.measure(suite, highest, options.seconds), everything):
            if trouble:
                say(trouble)

        def judge_one(mutant):
            if mutant.folder == "reports":
                found = runs.python_killed_by(mutant, tests, build.source / "reports")
            else:
                found = runs.killed_by(mutant, suites[mutant.folder])
                if not found and options.gates and mutant.number in gate.reached:
                    found = runs.verdict(gate, mutant.number)
            say(f"{mutant.file}:{mutant.line}: {found or 'survives'}")
            return found

        return dict(zip(mutants, pool.map(judge_one, mutants)))


def reasons():
    """{(file, before, after): why a mutant is no gap}."""
    table = tomllib.loads(Path(__file__).with_name("judged.toml").read_text())
    return {(row["file"], row["before"], row["after"]): row["reason"] for row in table.get("mutant", [])}


def fate_of(found, reason):
    if found:
        return "gates" if found.startswith("the gates") else "tests"
    return "judged" if reason else "surviving"


def report(judged, known):
    """One row for each mutant, and counts of outcomes by folder."""
    rows, totals = [], defaultdict(Counter)
    for mutant, found in sorted(judged.items(), key=lambda each: (each[0].file, each[0].line)):
        reason = known.get((mutant.file, mutant.before, mutant.after), "")
        rows.append({"file": mutant.file, "line": mutant.line, "rule": mutant.mutation.rule, "before": mutant.before,
                     "after": mutant.after, "fate": fate_of(found, reason), "seen_by": found or "",
                     "reached": found is not None, "reason": reason})
        totals[mutant.folder][rows[-1]["fate"]] += 1
    return rows, {folder: dict(count) for folder, count in totals.items()}


def print_report(rows, totals):
    for row in rows:
        if row["fate"] in ("judged", "surviving"):
            fate = row["fate"] if row["reached"] else f"{row['fate']}, no test reaches it"
            print(f"{row['file']}:{row['line']}: {row['rule']}, {fate}", f"  - {row['before']}", f"  + {row['after']}",
                  *([f"  {row['reason']}"] if row["reason"] else []), sep="\n")
    print(f"\n{'folder':12}{'made':>10}{'by tests':>10}{'by gates':>10}{'judged':>10}{'surviving':>10}")
    for folder, count in list(totals.items()) + [("all", sum((Counter(each) for each in totals.values()), Counter()))]:
        print(f"{folder:12}{sum(count.values()):10}" +
              "".join(f"{count.get(each, 0):10}" for each in ("tests", "gates", "judged", "surviving")))


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--count", type=int, default=240, help="mutants, spread over the folders and rules (240)")
    parser.add_argument("--seed", type=int, default=1, help="of the choice (1)")
    parser.add_argument("--folder", action="append", choices=FOLDERS, help="these alone; may be repeated")
    parser.add_argument("--no-gates", dest="gates", action="store_false", help="tests only: half a minute less a survivor")
    parser.add_argument("--seconds", type=float, help="leave out what takes longer without a mutant: a first look")
    parser.add_argument("--jobs", type=int, default=2, help="that many at a time (2)")
    parser.add_argument("--work", type=Path, default=ROOT / "build-mutants", help="folder of the mutated build")
    parser.add_argument("--json", type=Path, help="the report as JSON")
    parser.add_argument("--list", action="store_true", help="show the mutants that would be tried, and build nothing")
    options = parser.parse_args(arguments)
    options.folder = options.folder or list(FOLDERS)
    if options.count < len(options.folder) or options.jobs < 1:
        parser.error("--count must be at least the number of folders, --jobs at least 1")
    return options


def main(arguments):
    options = parse(arguments)
    known = reasons()
    proposed = propose(options)
    if options.list:
        for _, mutants in proposed.values():
            for each in mutants:
                print(f"{each.file}:{each.line}: {each.mutation.rule}\n  - {each.before}\n  + {each.after}")
        return 0

    def say(line):
        print(line, file=sys.stderr, flush=True)

    build = mutated_build.MutatedBuild(ROOT, options.work.resolve())
    try:
        build.copy_sources()
        compiled = cpp = [each for folder, (_, mutants) in proposed.items() if folder != "reports" for each in mutants]
        if cpp:
            build.write_mutants(cpp)
            build.configure()
            compiled = build.compile(cpp, options.jobs, options.gates)
            say(f"{len(compiled)} of {len(cpp)} C++ mutants compile")
    except mutated_build.BuildFailed as trouble:
        say(f"the mutants could not be built:\n{trouble}")
        return 2
    taken = [each for wanted, mutants in proposed.values()
             for each in [each for each in mutants if each.folder == "reports" or each in compiled][:wanted]]
    judged = judge(taken, build, options, say)
    rows, totals = report(judged, known)
    if options.json:
        options.json.write_text(json.dumps({"seed": options.seed, "totals": totals, "mutants": rows}, indent=1) + "\n")
    print_report(rows, totals)
    return 1 if any(row["fate"] == "surviving" for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
