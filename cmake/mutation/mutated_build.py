"""A copy of the sources that holds all mutants, each behind its switch, built once."""

import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import rules
from runs import PROGRAMS

SWITCH = Path(__file__).with_name("switch.hpp")
ROUNDS = 8  # of building; each drops the mutants that do not compile


class BuildFailed(Exception):
    pass


@dataclass(frozen=True)
class Mutant:
    number: int
    file: str
    mutation: rules.Mutation
    line: int
    lines: range  # of the expression that it changes
    before: str
    after: str

    @property
    def folder(self):
        return self.file.split("/")[0]


def mutant_of(number, file, text, mutation):
    line, before, after = rules.lines(text, mutation)
    first, last = (text.count("\n", 0, at) + 1 for at in (mutation.first, mutation.last))
    return Mutant(number, file, mutation, line, range(first, last + 1), before, after)


def write_if_changed(path, text):
    """An untouched file is not compiled again."""
    if not path.is_file() or path.read_bytes() != text.encode():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode())


class MutatedBuild:
    def __init__(self, root, work):
        self.root, self.source, self.build = root, work / "source", work / "build"

    def copy_sources(self):
        listed = subprocess.run(["git", "-C", self.root, "ls-files", "--cached", "--others", "--exclude-standard", "-z"],
                                capture_output=True, text=True, check=True).stdout.split("\0")
        files = {name for name in listed if name and (self.root / name).is_file()}
        for old in [path for path in self.source.rglob("*") if path.is_file()]:
            if old.relative_to(self.source).as_posix() not in files:
                old.unlink()
        for name in files:
            if not name.endswith(".cpp"):
                self.copy(name)

    def copy(self, name):
        target = self.source / name
        if not target.is_file() or target.read_bytes() != (self.root / name).read_bytes():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(self.root / name, target)

    def write_mutants(self, mutants):
        """All C++ sources, including the mutated ones."""
        for path in [each for each in self.root.glob("*/**/*.cpp")] + list(self.root.glob("*.cpp")):
            name = path.relative_to(self.root).as_posix()
            if name.startswith("build"):
                continue
            held = [(each.number, each.mutation) for each in mutants if each.file == name]
            if held:
                head = f'#include "{SWITCH}"\n#line 1 "{self.source / name}"\n'
                write_if_changed(self.source / name, head + rules.with_all(path.read_text(), held))
            else:
                self.copy(name)

    def configure(self):
        flags = ["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG", "-DCMAKE_CXX_FLAGS=-w",
                 "-DSLIPSTICK_BENCHMARKS=ON"]
        self.command(["cmake", "-S", self.source, "-B", self.build, "-G", "Ninja", *flags])

    def command(self, words):
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
        if done.returncode != 0:
            raise BuildFailed(done.stdout[-4000:] + done.stderr[-4000:])

    def compile(self, mutants, jobs, gates):
        """Builds the mutants into the tests of their folders and, with `gates`, into the program; returns the ones that compile."""
        known = (self.build / "build.ninja").read_text()
        targets = [program for folder in {each.folder for each in mutants} for program in PROGRAMS[folder]
                   if re.search(rf"^build {program}[ :]", known, re.MULTILINE)] + ["slipstick"] * gates
        for _ in range(ROUNDS):
            self.write_mutants(mutants)
            done = subprocess.run(["ninja", "-C", self.build, f"-j{jobs}", "-k", "0", *targets],
                                  capture_output=True, text=True)
            if done.returncode == 0:
                return mutants
            bad = self.named(done.stdout + done.stderr, mutants)
            if not bad:
                raise BuildFailed((done.stdout + done.stderr)[-8000:])
            mutants = [each for each in mutants if each not in bad]
        raise BuildFailed(f"something does not compile after {ROUNDS} rounds")

    def named(self, output, mutants):
        """The mutants on lines that the compiler names: in errors; or else in remarks; or else in the same files."""
        place = re.escape(str(self.source)) + r"/([^:\s]+):(\d+):"
        for pattern in (rf"{place}\d+: (?:error|  required from)", rf"{place}\d+:"):
            lines = {(file, int(line)) for file, line in re.findall(pattern, output)}
            bad = [each for each in mutants if any((each.file, line) in lines for line in each.lines)]
            if bad:
                return bad
        files = {file for file, _ in re.findall(place, output)}
        return [each for each in mutants if each.file in files]
