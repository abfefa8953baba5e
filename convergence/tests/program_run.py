"""Base of the tests that run the program, each in a temporary folder."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = str(Path(sys.argv[1]).resolve())
SOURCE = Path(__file__).resolve().parents[2]
SCENES = SOURCE / "convergence/scenes"
SHORT_SCENE = """[upper]
shape = "sphere"
radius = 0.018
young_modulus = 210e9
poisson_ratio = 0.3
[lower]
young_modulus = 210e9
poisson_ratio = 0.3
[contact]
friction = 0.1
[load]
normal = 1000
moment_ratio = 0.5
[grid]
cells = [32, 32]
"""

# Behaves as Google Benchmark's programs do, with benchmarks that all take so long, and notes each of its runs.
BENCHMARKS = r"""#!/bin/sh
for word in "$@"; do
  case "$word" in
    --benchmark_list_tests*) printf '%s' '@NAMES@'; exit 0;;
    --benchmark_filter=*) filter="${word#*=}";;
    --benchmark_out=*) out="${word#*=}";;
  esac
done
echo "@LABEL@ $filter" >> '@FOLDER@/log'
name="$(printf %s "$filter" | tr -cd 'a-z0-9/:')"
cat > "$out" <<END
{"context": {"num_cpus": 2, "build_type": "release"}, "benchmarks": [
 {"name": "$name", "run_name": "$name", "run_type": "iteration", "real_time": @MS@, "cpu_time": @MS@, "time_unit": "ms"}]}
END
exit @EXIT@
"""


def made_benchmarks(file, names, milliseconds=1.0, code=0):
    """Writes such a program with benchmarks of these names, one a line; returns its file."""
    text = BENCHMARKS
    for key, value in (("NAMES", names), ("LABEL", file.name), ("FOLDER", file.parent), ("MS", milliseconds), ("EXIT", code)):
        text = text.replace(f"@{key}@", str(value))
    file.write_text(text)
    file.chmod(0o700)
    return file


class ProgramTest(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        before = os.getcwd()
        self.folder = Path(tempfile.mkdtemp(prefix="slipstick-program-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)

    def run_program(self, *words, code=0, says=()):
        """Runs the program and returns its output. Checks the exit code (`code`, one or several) and that the output has
        the texts `says`."""
        end = subprocess.run([PROGRAM, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        text = end.stdout.decode(errors="replace")
        self.assertIn(end.returncode, code if isinstance(code, tuple) else (code,), (words, text))
        for part in [says] if isinstance(says, str) else says:
            self.assertIn(part, text, words)
        return text

    def result(self, *words, code=0):
        text = self.run_program(*words, "--json", "-", code=code)
        return json.loads(text[text.index("{"):])  # after warnings

    def text_and_result(self, *words, code=0):
        """Both of one run."""
        text = self.run_program(*words, "--json", "both.json", code=code)
        return text, json.loads(Path("both.json").read_text())

    def write(self, name, text):
        Path(name).write_text(text)
        return name
