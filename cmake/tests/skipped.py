"""skipped.py BUILD: lists the tests that the last run of ctest skipped, and the optional tests that were not built, each with the
reason and the package to install."""

import re
import sys
from collections import Counter
from pathlib import Path

TEST = re.compile(r"^\d+/\d+ Testing: (\S+)$", re.MULTILINE)
# A line of a script, a case of unittest, the reason of GoogleTest.
REASON = re.compile(r"^(?:SKIPPED|LEFT OUT): (.+)$|\.\.\. skipped ['\"](.*)['\"]$|^\S+:\d+: Skipped\n(.+)$", re.MULTILINE)


def skipped(log):
    """(test, reason, number of cases) for the log of ctest."""
    parts = TEST.split(log)[1:]
    for name, output in zip(parts[::2], parts[1::2]):
        reasons = Counter(next(filter(None, found)) for found in REASON.findall(output))
        yield from ((name, reason, cases) for reason, cases in reasons.items())


def main(build):
    lines = [f"{name}: {reason}" + (f" ({cases} cases)" if cases > 1 else "")
             for name, reason, cases in skipped((build / "Testing/Temporary/LastTest.log").read_text(errors="replace"))]
    left_out = build / "not_tested.txt"
    lines += left_out.read_text().splitlines() if left_out.exists() else []
    for line in sorted(lines):
        print(f"skipped: {line}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
