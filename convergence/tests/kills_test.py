#!/usr/bin/env python3
"""Kills studies and reports at random moments and starts them again. Checks that no process and no incomplete file is
left, no solve is repeated and the result is the same."""

import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree
from pathlib import Path

MARKER = "SLIPSTICK_TEST_MARKER"
TIMES = ("seconds", "provenance", "peak_bytes")  # may differ from run to run
PATIENCE = 120  # seconds; a killed process ends sooner on any machine
SCENE = Path(__file__).parents[1] / "scenes" / "paper.toml"


def processes_of(folder):
    """The running processes with this folder as their MARKER; /proc shows no environment of an ended one."""
    found, mark = [], f"{MARKER}={folder}".encode() + b"\0"
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and mark in (entry / "environ").read_bytes():
                found.append(int(entry.name))
        except OSError:  # it has ended, or belongs to another user
            pass
    return found


def without_times(tree):
    if isinstance(tree, dict):
        return {key: without_times(value) for key, value in tree.items() if key.partition(".")[0] not in TIMES}
    return [without_times(value) for value in tree] if isinstance(tree, list) else tree


def read_whole(path):
    """Reads a file by the format of its ending; raises if it is incomplete."""
    if path.suffix == ".json":
        return json.loads(path.read_text(encoding="utf-8"))
    if path.suffix == ".h5":
        import h5py  # only a report writes HDF5

        with h5py.File(path) as file:
            return {name: file[name][:].tobytes() for name in file}
    if path.suffix == ".svg":
        xml.etree.ElementTree.parse(path)
    elif path.suffix == ".pdf":
        assert path.read_bytes().rstrip().endswith(b"%%EOF")
    elif path.suffix == ".html":
        assert path.read_text(encoding="utf-8").rstrip().endswith("</html>")
    elif path.suffix == ".toml":
        return path.read_text(encoding="utf-8")
    return None


def is_draft(path):
    return ".part" in path.name


class Command:
    """A command and its output folder."""

    def __init__(self, words, folder, results):
        self.words, self.folder, self.results = words, folder, results

    def start(self):
        environment = {**os.environ, MARKER: str(self.folder)}
        self.log = open(self.folder.with_suffix(".log"), "w")
        return subprocess.Popen(self.words, env=environment, stdout=self.log, stderr=self.log, start_new_session=True)

    def processes(self):
        return processes_of(self.folder)

    def files(self):
        return [path for path in self.folder.rglob("*") if path.is_file()]

    def broken(self):
        """Files that are neither whole nor drafts."""
        bad = []
        for path in self.files():
            try:
                if not is_draft(path):
                    read_whole(path)
            except Exception as error:  # any error of a reader
                bad.append(f"{path}: {error!r}")
        return bad

    def finished(self):
        """Kept results, with the time and the inode of each file."""
        return {path: (path.stat().st_mtime_ns, path.stat().st_ino) for path in self.folder.rglob("points/*.json")}

    def answer(self):
        found = {}
        for pattern in self.results:
            for path in self.folder.glob(pattern):
                found[path.name] = without_times(read_whole(path))
        return found

    def clear(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)


def study(program, folder):
    file = folder.with_suffix(".toml")
    file.write_text(f'scene = "{SCENE}"\ncells = [12, 16, 24, 32]\nquantities = ["twist_error"]\n')
    return Command([program, "study", file, "--output", folder / "points", "--json", folder / "study.json", "--quiet"],
                   folder, ["study.json"])


def report(program, folder):
    return Command([program, "report", "--quick", "--output", folder], folder,
                   ["data/report.json", "data/*.h5"])


def kill_children(command, parent, choose):
    """Kills one child process, if there is one before the parent ends."""
    while parent.poll() is None:
        others = [process for process in command.processes() if process != parent.pid]
        if others:
            try:
                os.kill(choose(others), signal.SIGKILL)
            except ProcessLookupError:
                continue
            return


def strike(command, kind, parent, choose):
    if kind == "worker":
        kill_children(command, parent, choose)
    elif kind == "group":
        os.killpg(parent.pid, signal.SIGKILL)
    else:
        parent.kill()


def comes_true(condition):
    end = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True


class Tally:
    def __init__(self):
        self.kills = self.struck = self.lost = self.children = self.broken = self.differing = self.drafts = 0

    def add(self, **counts):
        for name, count in counts.items():
            setattr(self, name, getattr(self, name) + count)

    def faults(self):
        return self.lost + self.children + self.broken + self.differing + self.drafts

    def __str__(self):
        return (f"{self.kills} kills ({self.struck} before the end): {self.lost} finished runs solved again, "
                f"{self.children} processes left, {self.broken} files broken, {self.drafts} drafts left, "
                f"{self.differing} results differing")


def complain(*words):
    print("kills_test.py:", *words, file=sys.stderr)


def try_kind(command, kind, kills, random_numbers, tally):
    command.clear()
    begin = time.monotonic()
    if command.start().wait() != 0:
        sys.exit(f"kills_test.py: the command fails undisturbed: {command.log.name}")
    length = time.monotonic() - begin
    good = command.answer()
    command.clear()
    done = 0
    while done < kills:
        complain(f"{kind}: kill {done + 1} of {kills}, {tally.faults()} faults so far")
        begin = time.monotonic()
        parent = command.start()
        try:
            parent.wait(random_numbers.uniform(0, length))
        except subprocess.TimeoutExpired:
            strike(command, random_numbers.choice(["parent", "worker", "group"]) if kind == "report" else kind, parent,
                   random_numbers.choice)
            parent.wait()
            tally.add(struck=1)
        done += 1
        tally.add(kills=1)
        if not comes_true(lambda: not command.processes()):
            complain(kind, "left", command.processes())
            tally.add(children=len(command.processes()))
            for process in command.processes():
                os.kill(process, signal.SIGKILL)
        bad = command.broken()
        for line in bad:
            complain(kind, line)
        tally.add(broken=len(bad))
        if kind == "report" and done < kills and random_numbers.random() < 0.6:
            continue  # the restarted command is killed again
        before = command.finished()
        if command.start().wait() != 0:
            complain(kind, "does not resume:", Path(command.log.name).read_text())
            tally.add(differing=1)
        after = command.finished()
        again = [path for path in before if after.get(path) != before[path]]
        drafts = [path for path in command.files() if is_draft(path)]
        for path in again:
            complain(kind, "solved again:", path)
        for path in drafts:
            complain(kind, "draft left:", path)
        tally.add(lost=len(again), drafts=len(drafts), differing=int(command.answer() != good))
        command.clear()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path)
    parser.add_argument("--kills", type=int, default=6)
    parser.add_argument("--kinds", nargs="+", default=["study", "worker", "group"],
                        choices=["study", "worker", "group", "report"], help="kinds of kills, in equal parts")
    parser.add_argument("--seed", type=int, default=1, help="seed of the random moments")
    arguments = parser.parse_args()
    if not Path("/proc/self/environ").exists():
        print("skipped: only Linux kills a process with its parent and shows the parent of each")
        return 0
    random_numbers = random.Random(arguments.seed)
    faults = 0
    with tempfile.TemporaryDirectory(prefix="slipstick-kills-") as folder:
        for number, kind in enumerate(arguments.kinds):
            kills = (arguments.kills + number) // len(arguments.kinds)
            tally = Tally()
            make = report if kind == "report" else study
            try_kind(make(arguments.program.resolve(), Path(folder) / kind), kind, kills, random_numbers, tally)
            print(f"{kind}: {tally}")
            faults += tally.faults()
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
