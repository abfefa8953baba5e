"""Runs the fenced blocks of a page in a scratch folder that looks like a checkout with a build in it.

A comment above a block gives properties that a reader need not see:
    <!-- not run: REASON -->      its commands are only compared with the Makefile and with --help
    <!-- exit code: 1 -->         the exit code of the block, if not 0
    <!-- needs: NAME -->          not run if there is no program or Python package of this name (Arb: no certified digits)
    <!-- around: CODE @@ CODE --> the program around a block that is a part of it
A block is written to a file if the text before it ends with the file's name in backquotes and a colon.
"""
import functools
import glob
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
from dataclasses import dataclass

from pages import line_of

BLOCK = re.compile(r"((?:^<!--(?:(?!-->).)*-->[ \t]*\n+)*)^```(\w*)\n(.*?)^```[ \t]*$", re.S | re.M)
HANGS = 900  # seconds, for a block that hangs; no block takes ten on an idle machine


@dataclass
class Block:
    language: str
    code: str
    file: str  # named before it, or empty
    line: int
    not_run: str
    needs: str
    exit_code: int
    around: str


def read_blocks(text):
    """The page's blocks in their order."""
    blocks = []
    for match in BLOCK.finditer(text):
        given = {"not run": "", "needs": "", "exit code": "0", "around": "@@"}
        for comment in re.findall(r"<!--(.*?)-->", match[1], re.S):
            key, _, value = comment.partition(":")
            if key.strip() in given:
                given[key.strip()] = value.strip("\n") if key.strip() == "around" else value.strip()
        before = re.sub(r"<!--.*?-->", "", text[:match.start()], flags=re.S).rstrip()
        name = re.search(r"`([\w./-]+\.\w+)`:$", before)
        blocks.append(Block(match[2], match[3], name[1] if name and match[2] != "sh" else "",
                            line_of(text, match.start(3)) - 1,
                            given["not run"], given["needs"], int(given["exit code"]), given["around"]))
    return blocks


class Checkout:
    """Sources, program and interpreter for the pages. All paths are absolute."""

    def __init__(self, root, program, python):
        self.root, self.program, self.python = pathlib.Path(root), pathlib.Path(program), python

    @functools.lru_cache(maxsize=None)
    def help(self, command):
        result = subprocess.run([self.program, *([command] if command else []), "--help"], capture_output=True, text=True)
        return result.stdout if result.returncode == 0 else ""

    @functools.cached_property
    def targets(self):
        return set(re.findall(r"^([\w-]+):", (self.root / "Makefile").read_text(), re.M))

    def make_scratch(self, folder):
        """A copy of a checkout in which a block cannot write into the sources' top folder."""
        folder.mkdir(parents=True)
        for name in ["analytic", "bench", "convergence", "cmake", "docs", "interfaces", "reports", "solver", "Makefile"]:
            (folder / name).symlink_to(self.root / name)
        (folder / "build/bench").mkdir(parents=True)
        (folder / "build/slipstick").symlink_to(self.program)
        benchmarks = self.program.parent / "bench/slipstick_benchmarks"
        (folder / "build/bench/slipstick_benchmarks").symlink_to(benchmarks)
        build = self.program.parent
        for name in ["lib", "python"]:
            (folder / "build" / name).symlink_to(build / name)
        (folder / "programs").mkdir()
        python = folder / "programs/python3"
        python.write_text(f"#!/bin/sh\nexec {shlex.quote(str(self.python))} -B \"$@\"\n")
        python.chmod(0o755)
        return {**os.environ, "PATH": f"{folder}/programs:{os.environ['PATH']}", "MPLBACKEND": "agg",
                "PYTHONPATH": f"{build}/python"}

    @functools.lru_cache(maxsize=None)
    def has(self, need):
        """Whether there is such a program, or Python can import it, or the program proves digits (Arb)."""
        if shutil.which(need):
            return True
        certified = [self.program, "exact", "--moment-ratio", "0.5", "--certified", "15"]
        words = certified if need == "Arb" else [self.python, "-c", f"import {need}"]
        return subprocess.run(words, capture_output=True).returncode == 0

    def command_problems(self, text):
        """Options, targets of make and files of the project that the commands name and that do not exist."""
        problems = []
        for line in text.replace("\\\n", " ").splitlines():
            try:
                words = shlex.split(line, comments=True)
            except ValueError as error:
                problems.append(f"{line.strip()}: {error}")
                continue
            for place, word in enumerate(words):
                if (word.endswith("build/slipstick") or (place, word) == (0, "slipstick")) and len(words) > place + 1:
                    problems += self.slipstick_problems(words[place + 1:])
                    break
            if words and words[0] == "make":
                given = re.sub(r"-C \S+", "", " ".join(words[1:])).split()
                problems += [f"make {word}: no such target" for word in given
                             if re.fullmatch(r"[a-z-]+", word) and word not in self.targets]
            for word in words:
                top = word.partition("/")[0]
                if "/" in word and top.isalpha() and top != "build" and (self.root / top).is_dir() and not glob.glob(str(self.root / word)):
                    problems.append(f"{word}: no such file")
        return problems

    def slipstick_problems(self, words):
        command = "" if words[0].startswith("-") else words[0]
        if command and not re.search(rf"^  {re.escape(command)} ", self.help(""), re.M):
            return [f"slipstick {command}: no such command"]
        text = self.help(command)
        options = [word.partition("=")[0] for word in words if word.startswith("--")]
        return [f"slipstick {command} {option}: no such option" for option in options
                if not re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", text)]


class PageRun:
    """Runs the blocks of one page in their order, in one scratch folder."""

    def __init__(self, checkout, name, text, folder):
        self.checkout, self.name, self.text, self.folder = checkout, name, text, folder
        self.ran, self.left, self.problems = 0, [], []

    def run(self):
        environment = self.checkout.make_scratch(self.folder)
        if re.search(r"^[ \t>]+```", self.text, re.M):
            self.problems.append(f"{self.name}: an indented block is not seen by this test")
        blocks = read_blocks(self.text)
        for block in blocks:
            problems = self.run_block(block, blocks, environment)
            self.problems += [f"{self.name}:{block.line}: {problem}" for problem in problems]
        return self

    def leave(self, block, reason):
        self.left.append(f"{self.name}:{block.line}: {reason}")
        return []

    def run_block(self, block, blocks, environment):
        if block.language == "text":
            return []
        if block.not_run:
            self.leave(block, block.not_run)
            return self.checkout.command_problems(block.code) if block.language == "sh" else []
        if block.needs and not self.checkout.has(block.needs):
            return self.leave(block, f"{block.needs} is not there")
        run = getattr(self, f"run_{block.language}", None)
        if not block.language or run is None:
            return [f"a block in '{block.language}' is neither run nor text: say why with <!-- not run: ... -->"]
        if block.file:
            file = (self.folder / block.file).resolve()
            if not file.is_relative_to(self.folder.resolve()):
                return [f"{block.file} is a file of the project: no block writes it"]
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(block.code)
            if file.suffix in (".toml", ".json", ".csv", ".c", ".f90", ".jl") and not any(
                    file.name in other.code for other in blocks if other is not block):
                return [f"{block.file} is written, but no block uses it"]
        self.ran += 1
        return run(block, environment)

    def execute(self, block, words, environment):
        try:
            result = subprocess.run(words, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=HANGS,
                                    stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            return [f"hangs:\n{block.code}"]
        if result.returncode == block.exit_code:
            return []
        return [f"ended with {result.returncode}, not {block.exit_code}:\n{block.code}{result.stdout}{result.stderr}"]

    def run_sh(self, block, environment):
        return self.execute(block, ["bash", "-eu", "-o", "pipefail", "-c", block.code], environment)

    def run_python(self, block, environment):
        code = block.around.replace("@@", block.code)
        return self.execute(block, [self.checkout.python, "-B", "-c", code], environment)

    def run_fortran(self, block, _):
        return [] if block.file else ["say the name of this file before it"]

    run_julia = run_fortran

    def run_c(self, block, environment, compiler=("cc", "-std=c11"), suffix="c"):
        if block.file:
            return []  # commands compile it
        if not shutil.which(compiler[0]):
            self.ran -= 1
            return self.leave(block, f"{compiler[0]} is not installed")
        source = self.folder / f"block-{block.line}.{suffix}"
        source.write_text(block.around.replace("@@", block.code))
        program = source.with_suffix("")
        problems = self.execute(block, [*compiler, "-Wall", "-Werror", source, "-o", program], environment)
        return problems or self.execute(block, [program], environment)

    def run_cpp(self, block, environment):
        include = self.checkout.program.parent / "include"
        return self.run_c(block, environment, ("c++", "-std=c++20", f"-I{include}", "-I/usr/include/eigen3"), "cpp")

    def run_toml(self, block, environment):
        if block.file:
            return []  # commands read it
        scene = self.folder / f"block-{block.line}.toml"
        scene.write_text(block.code)
        if re.search(r"^\[upper\]", block.code, re.M) and re.search(r"^\[load\]", block.code, re.M):
            return self.execute(block, ["build/slipstick", "solve", scene, "--plan"], environment)
        return self.execute(block, [self.checkout.python, "-c",
                                    "import sys, tomllib; tomllib.load(open(sys.argv[1], 'rb'))", scene], environment)

    def run_json(self, block, _):
        try:
            json.loads(block.code)
        except ValueError as error:
            return [str(error)]
        return []

    def run_csv(self, block, _):
        return [] if block.file else ["say the name of this file before it"]

    def run_yaml(self, block, _):
        """A workflow must be YAML, and its commands must exist."""
        try:
            import yaml
        except ImportError:
            self.ran -= 1
            return self.leave(block, "python3-yaml is not installed")
        try:
            content = yaml.safe_load(block.code)
        except yaml.YAMLError as error:
            return [str(error)]
        jobs = content.get("jobs", {}) if isinstance(content, dict) else {}
        steps = [step for job in jobs.values() for step in job["steps"]]
        return [problem for step in steps for problem in self.checkout.command_problems(step.get("run", ""))]
