"""hostile_output_test.py PROGRAM: what the program says and writes, whatever names, files and limits it is given."""

import json
import os
import random
import resource
import signal
import subprocess
import time
import unicodedata
import xml.etree.ElementTree
from pathlib import Path

from program_run import PROGRAM, SHORT_SCENE, ProgramTest

NASTY = "a\n::error::b\n  ::warning::c\n\u2003::d\n##vso[task.x]e\n##[error]f\n\x1b]0;g\x07\x7f\u009b1m\r::h\ufffe"
IN_TOML = json.dumps(NASTY)
NASTY_GATE = (f'[[gate]]\nid = {IN_TOML}\nresult = "result.json"\nquantity = "status"\nequals = {IN_TOML}\n'
              f'basis = {IN_TOML}\nreason = {IN_TOML}\n')
SEED = 20261124


def mutated(content, random_numbers):
    """Some bytes changed, left out or put in, or the file cut off."""
    content = bytearray(content)
    for _ in range(random_numbers.randint(1, 6)):
        at = random_numbers.randrange(len(content) + 1)
        some = random_numbers.choice((bytes([random_numbers.randrange(256)]), b"\x01", b"\x1b[2J", b"\xff\xfe", b"\xed\xa0\x80",
                                      b"\xef\xbf\xbf", b"]]>", b"&<\"'", b"\\u0000", b"\\ud800", b"\xc2\x9b", b"\0"))
        content[at:at + random_numbers.choice((0, 1, len(some)))] = some
    return bytes(content[:random_numbers.randrange(len(content))] if random_numbers.random() < 0.1 else content)


def no_processes():
    """A limit of the processes that the user already has leaves no room for more. Root has no such limit; the user `nobody` has."""
    if os.geteuid() == 0:
        os.setgid(65534)
        os.setuid(65534)
    resource.setrlimit(resource.RLIMIT_NPROC, (0, 0))


def no_memory():
    resource.setrlimit(resource.RLIMIT_AS, (120 << 20, 120 << 20))


class HostileOutput(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("scene.toml", SHORT_SCENE.replace("[32, 32]", "[8, 8]"))

    def ends(self, *words, **options):
        end = subprocess.run([PROGRAM, *words], capture_output=True, **options)
        return end.returncode, end.stdout.decode(errors="replace"), end.stderr.decode(errors="replace")

    def test_reports_for_ci_are_xml_whatever_the_result_holds(self):
        """300 mutations of a result and of timings: each report parses and contains the refused text."""
        numbers = random.Random(SEED)
        result = json.dumps({"status": "failed", "message": "caf\u00e9 <&>\"'", "a": [1, {"b": 2}]}).encode()
        timings = json.dumps({"context": {"num_cpus": 2}, "benchmarks": [
            {"name": "caf\u00e9", "real_time": 1, "cpu_time": 1, "time_unit": "ms"}] * 3}).encode()
        Path("base.json").write_bytes(timings)
        self.write("gates.toml", '[[gate]]\nid = "a"\nresult = "result.json"\nquantity = "message"\nequals = "b"\n'
                   'basis = "c"\n[[gate]]\nid = "b"\nresult = "result.json"\nquantity = "a[1].b"\nequals = 2\nbasis = "c"\n')
        refused = 0
        for i in range(300):
            Path("result.json").write_bytes(mutated(timings if i % 3 == 0 else result, numbers))
            if i % 3 == 0:
                code, *_ = self.ends("compare", "base.json", "result.json", "--same-machine", "--junit", "junit.xml")
                if not Path("junit.xml").exists():
                    continue  # refused before there is anything to report
            else:
                code, *_ = self.ends("gate", "gates.toml", "--junit", "junit.xml", "--summary", "summary.md")
            self.assertIn(code, (0, 1, 2), i)
            root = xml.etree.ElementTree.parse("junit.xml").getroot()
            reasons = [error.get("message") for error in root.iter("error")]
            self.assertTrue(code != 2 or all(reasons), i)
            refused += any("result.json: is not JSON (" in reason for reason in reasons)
            os.remove("junit.xml")
        self.assertGreater(refused, 100)

    def assert_plain(self, said):
        commands = [line for line in said.split("\n") if line.lstrip().startswith("::") or "##[" in line or "##vso[" in line]
        self.assertEqual(commands, [])
        self.assertEqual([c for c in said if unicodedata.category(c) == "Cc" and c not in "\n\t"], [])

    def test_names_and_reasons_command_neither_terminal_nor_ci(self):
        self.write("gates.toml", NASTY_GATE)
        self.write("result.json", json.dumps({"status": NASTY, "message": NASTY, NASTY: 1}))
        self.write("gates2.toml", NASTY_GATE.replace('quantity = "status"', 'quantity = "statu"').replace('"a\\n', '"b\\n'))
        self.write("broken.toml", NASTY_GATE.replace("basis", "bassis"))
        timings = {"context": {"num_cpus": 2}, "benchmarks": [
            {"name": NASTY, "real_time": 1, "cpu_time": 1, "time_unit": "ms", "error_occurred": True, "error_message": NASTY}]}
        self.write("base.json", json.dumps(timings))
        self.write("nasty.toml", f"name = {IN_TOML}\n{SHORT_SCENE}".replace("[32, 32]", "[8, 8]"))
        self.write("cases.toml", f'[[family]]\nname = {IN_TOML}\nwhy = {IN_TOML}\nscene = "scene.toml"\n[[family.vary]]\n'
                   'key = "contact.friction"\nvalues = [-1]\n')
        os.link("scene.toml", "b\n::error::c.toml")
        for words in (("gate", "gates.toml"), ("gate", "gates2.toml"), ("gate", "broken.toml"), ("solve", "nasty.toml"),
                      ("compare", "base.json", "base.json"), ("hard", "cases.toml", "--once", "--output", "runs"),
                      ("law", "nasty.toml"), ("solve", "scene.toml", "--set", f"name={IN_TOML}"),
                      ("solve", "scene.toml", "--set", f"contact.x={IN_TOML}"), ("solve", "b\n::error::c.toml"),
                      ("solve", "n\n::error::o.toml"), ("exact", "--profile", "x\n::error::y", "--moment-ratio", "0.5"),
                      ("solve", "scene.toml", "--x\n::error::y"), (NASTY,)):
            with self.subTest(words=words):
                _, *said = self.ends(*words)
                for text in said:
                    self.assert_plain(text)

    def test_two_outputs_are_two_files(self):
        self.write("gates.toml", '[[gate]]\nid = "a"\nresult = "r.json"\nquantity = "x"\nbelow = 1\nbasis = "b"\n')
        os.symlink("x.csv", "link.csv")
        os.symlink("link.csv", "chain.csv")
        os.symlink(".", "folder")
        for words in (("solve", "scene.toml", "--json", "x.csv", "--fields", "x.csv"),
                      ("solve", "scene.toml", "--json", "link.csv", "--fields", "./x.csv"),
                      ("solve", "scene.toml", "--json", "link.csv", "--fields", "chain.csv"),
                      ("solve", "scene.toml", "--json", "folder/x.csv", "--fields", os.path.abspath("x.csv")),
                      ("gate", "gates.toml", "--junit", "x.csv", "--summary", "x.csv"),
                      ("law", "--write", "x.csv", "--write", "x.csv")):
            self.run_program(*words, code=2, says=("is the file of --", "allowed: another file"))
            self.assertFalse(Path("x.csv").exists(), words)
        self.run_program("solve", "scene.toml", "--json", "x.json", "--fields", "x.csv")
        self.run_program("solve", "scene.toml", "--json", "/dev/null", "--fields", "/dev/null/../null.csv", code=2)

    def test_a_limit_below_zero_is_refused(self):
        for limit in ("-5", "-5GiB", "-0x5"):
            self.run_program("solve", "scene.toml", "--memory-limit", limit, code=2, says=("--memory-limit", "above zero"))

    def test_a_name_with_an_end_of_line_ends_no_comment(self):
        name = "p\n#error\nq\r.csv"
        self.write(name, "radius,pressure\n" + "".join(f"{i / 16:g},{2 - i / 16:g}\n" for i in range(17)))
        self.run_program("law", "--profile", f"file:{name}", "--write", "law.h", "--write", "law.csv", "--write", "law.table")
        for file in ("law.h", "law.csv", "law.table"):
            self.assertNotRegex(Path(file).read_bytes().decode(), "[\n\r](#error|q)", file)

    def test_processes_that_run_out_are_said_with_what_to_do(self):
        os.chmod(".", 0o777)
        try:
            _, _, said = self.ends("solve", "scene.toml", "--set", "solver.threads=1", "--figure", "fields.png",
                                    preexec_fn=no_processes)
        except PermissionError:
            self.skipTest("the limit does not hold for root, and no other user may run the program where it is")
        self.assertIn("no more threads or processes can be started; allowed: ", said)

    def test_memory_that_runs_out_is_said_with_what_to_do(self):
        code, _, said = self.ends("solve", "scene.toml", "--set", "grid.cells=[1024,1024]", "--set", "solver.threads=1",
                                  "--memory-limit", "8GB", preexec_fn=no_memory)
        self.assertEqual(code, 2, said)
        self.assertIn("memory ran out; allowed: ", said)

    def test_no_matplotlibrc_changes_a_figure(self):
        for name in ("without", "with", "broken"):
            self.run_program("solve", "scene.toml", "--figure", f"{name}.svg", "--quiet")
            Path("matplotlibrc").write_bytes(b"axes.linewidth: 9\nfont.size: 30\naxes.facecolor: red\nimage.cmap: jet\n" +
                                             (b"\xff\xfe\n" if name == "with" else b""))
        self.assertEqual(Path("with.svg").read_bytes(), Path("without.svg").read_bytes())
        self.assertEqual(Path("broken.svg").read_bytes(), Path("without.svg").read_bytes())

    def test_a_killed_figure_leaves_no_fields(self):
        """Killed while Python waits in the middle of it; only the process, or all of its group."""
        os.mkdir("python")
        self.write("python/sitecustomize.py", "import time\ntime.sleep(600)\n")
        for kill in (os.kill, os.killpg):
            for number in (signal.SIGTERM, signal.SIGKILL, signal.SIGINT):
                folder = self.folder / f"temporary-{kill.__name__}-{number}"
                folder.mkdir()
                run = subprocess.Popen([PROGRAM, "solve", "scene.toml", "--figure", "a.svg", "--quiet"], start_new_session=True,
                                       env={**os.environ, "TMPDIR": str(folder), "PYTHONPATH": "python"})
                while not list(folder.glob("*/fields.h5")):
                    self.assertIsNone(run.poll())
                    time.sleep(0.01)
                kill(run.pid, number)
                run.wait()
                until = time.monotonic() + 60
                while list(folder.iterdir()) and time.monotonic() < until:
                    time.sleep(0.01)
                self.assertEqual(list(folder.iterdir()), [], (kill, number))
