#!/usr/bin/env python3
"""Counts the work of solves and their parts and writes it as JSON, which gates read. Instructions are counted by valgrind's
callgrind; where that is not installed they are null. Example:

  bench/work/count_work.py build/bench/slipstick_work build/gates/work.json
"""
from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path


def read_callgrind(file):
    """The instructions of each object (program or library). A call's line has the inclusive cost, which stands again at the
    lines of the callee. Raises ValueError where they do not add up to the total."""
    counts, names, current, total, of_call = {}, {}, "", None, False
    for line in Path(file).read_text(errors="replace").splitlines():
        found = re.match(r"(c?)ob=(\(\d+\))?(.*)", line)
        if found:  # "(3) /lib/libm.so.6" names object 3, a later "(3)" refers to that name
            called, number, name = found.groups()
            name = names.setdefault(number, name.strip()) if number else name
            current = current if called else name
        elif line.startswith("totals:"):
            total = int(line.split()[1])
        elif re.match(r"[-+*\d]", line) and not of_call:  # "position count", where the position may be relative
            name = os.path.basename(current)
            counts[name] = counts.get(name, 0) + int(line.split()[1])
        of_call = line.startswith("calls=")
    if not total or total != sum(counts.values()):
        raise ValueError(f"{file}: not what callgrind writes: {sum(counts.values())} instructions of {total}")
    return counts


def count_instructions(program, case):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "callgrind"
        end = subprocess.run(["valgrind", "--tool=callgrind", "--quiet", f"--callgrind-out-file={out}",
                              "--toggle-collect=*do_counted_work*", program, "--do", case], check=False)
        if end.returncode:
            raise ValueError(f"{case} under valgrind ended with code {end.returncode}")
        counts = read_callgrind(out)
    own = counts.pop(os.path.basename(program), 0)
    return {"total": own + sum(counts.values()), "program": own, "libraries": dict(sorted(counts.items()))}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="slipstick_work")
    parser.add_argument("json", type=Path, help="file for the counts")
    arguments = parser.parse_args()
    result = json.loads(subprocess.run([arguments.program], stdout=subprocess.PIPE, check=True).stdout)
    counts = result["counts"]
    try:
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for case, found in zip(counts, list(pool.map(lambda case: count_instructions(arguments.program, case), counts))):
                counts[case]["instructions"] = found
                del counts[case]["instructions_reason"]
    except FileNotFoundError:
        for case in counts.values():
            case["instructions_reason"] = "valgrind is not installed"
    arguments.json.parent.mkdir(parents=True, exist_ok=True)
    arguments.json.write_text(json.dumps(result, indent=2) + "\n")


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, subprocess.CalledProcessError) as problem:
        print(f"count_work.py: {problem}", file=sys.stderr)
        sys.exit(2)
