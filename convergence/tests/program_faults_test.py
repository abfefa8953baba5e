"""program_faults_test.py PROGRAM: how commands end if they cannot write, or find no memory or processes. main() writes
for all commands, so all are tested here."""

import json
import os
import resource
import signal
import subprocess
from pathlib import Path

from program_run import PROGRAM, SCENES, ProgramTest

PAPER = str(SCENES / "paper.toml")
SMALL = ("solve", PAPER, "--set", "grid.cells=[12,12]")
TOO_LARGE = "cannot be written: File too large"


def opened_as(number, file):
    return lambda: os.dup2(os.open(file, os.O_RDWR), number)


def limit_files(size):
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))
    return limit


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (200 << 20, 200 << 20))  # 64 threads' stacks take 512 MB of it


def become_nobody():
    if os.getuid() == 0:
        os.setuid(65534)


def limit_processes():
    resource.setrlimit(resource.RLIMIT_NPROC, (1, 1))
    become_nobody()  # the limit does not hold for root


def nobody_reads():
    reader, writer = os.pipe()
    os.close(reader)
    os.dup2(writer, 1)


def nobody_reads_and_no_signal():
    nobody_reads()
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)


class ProgramFaults(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("study.toml", f'scene = "{PAPER}"\ncells = [8, 12]\nquantities = ["twist_error"]\n')
        self.write("gates.toml", f'[[gate]]\nid = "tiny"\nscene = "{PAPER}"\nset = {{ "grid.cells" = [12, 12] }}\n'
                   'quantity = "status"\nequals = "converged"\nbasis = "the solve converges"\n')
        self.write("hard.toml", f'[[family]]\nname = "tiny"\nwhy = "it is small"\nscene = "{PAPER}"\n'
                   '[[family.vary]]\nkey = "grid.cells"\nvalues = [[12, 12]]\n')

    def ends(self, words, code, prepare=None):
        """Returns standard error after a check of the exit code. Standard output goes to the file out unless `prepare`,
        called in the child process, redirects it."""
        with open("out", "wb") as out:
            end = subprocess.run([PROGRAM, *words], stdout=out, stderr=subprocess.PIPE, preexec_fn=prepare)
        complaint = end.stderr.decode()
        self.assertEqual(end.returncode, code, (words, complaint))
        return complaint

    def commands(self):
        """Commands with a result; their solves are small and kept."""
        self.ends((*SMALL, "--quiet", "--fields", "fields.csv"), 0)
        return (("exact", "--moment-ratio", "0.5"), SMALL, ("solve", PAPER, "--model", "exact"),
                ("check", PAPER, "fields.csv"), ("study", "study.toml", "--output", "points"),
                ("gate", "gates.toml", "--output", "points"),
                ("hard", "hard.toml", "--once", "--output", "points"))

    def whole_result(self):
        self.assertIsInstance(json.loads(Path("result.json").read_text()), dict)
        os.remove("result.json")

    def test_a_standard_output_that_takes_nothing_is_exit_code_2(self):
        """If standard output cannot be written the command fails, but a result file is written."""
        full = opened_as(1, "/dev/full")
        for command in self.commands():
            for fault in (full, lambda: os.close(1)):
                self.assertIn("standard output: cannot be written: ", self.ends(command, 2, fault))
                self.ends((*command, "--json", "-"), 2, fault)
                self.ends((*command, "--json", "result.json"), 2, fault)
                self.whole_result()
                self.ends((*command, "--quiet", "--json", "result.json"), 0, fault)
        self.ends(("--help",), 2, full)

    def test_closed_streams_are_no_files_of_others(self):
        """With closed standard streams, their descriptor numbers are not used for files and pipes: HDF5 is written and
        read, and studies start processes."""
        self.ends((*SMALL, "--quiet", "--fields", "whole.h5"), 0)
        check = ("check", PAPER, "whole.h5")
        others = ((*SMALL, "--fields", "fields.h5"), ("study", "study.toml", "--output", "others"))
        for closed in range(1, 8):
            def close_some():
                for stream in range(3):
                    if closed >> stream & 1:
                        os.close(stream)
            for words in (check, *(others if closed == 7 else ())):
                self.ends((*words, "--quiet", "--json", "result.json"), 0, close_some)
                self.whole_result()
        self.assertEqual(Path("fields.h5").read_bytes(), Path("whole.h5").read_bytes())

    def test_a_reader_that_leaves_ends_it_quietly(self):
        """As in `slipstick study ... | head -1`: no message, nothing lost in files."""
        for command in self.commands():
            complaint = self.ends((*command, "--json", "result.json"), -signal.SIGPIPE, nobody_reads)
            self.assertNotIn("slipstick:", complaint)
            self.whole_result()
            self.assertIn("standard output: cannot be written: Broken pipe",
                          self.ends(command, 2, nobody_reads_and_no_signal))

    def test_a_full_standard_error_costs_nothing(self):
        """A command continues if its progress line cannot be written."""
        for command in self.commands():
            self.ends(command, 0, opened_as(2, "/dev/full"))
            self.assertGreater(Path("out").stat().st_size, 20)

    def test_a_full_disk_is_said_and_leaves_no_part(self):
        """The message names the file, the cause and the remedy. An old file is unchanged."""
        commands = self.commands()
        cases = [((*command, "--json", "x.json"), "x.json") for command in commands]
        cases += [((*SMALL, "--fields", name), name) for name in ("x.csv", "x.h5", "x.vti")]
        cases += [((*commands[5], "--junit", "x.xml"), "x.xml"), ((*commands[5], "--summary", "x.md"), "x.md")]
        for words, name in cases:
            file = Path(name)
            self.ends((*words, "--quiet"), 0)  # its solves are kept
            for old in ("old", None):
                file.unlink() if old is None else file.write_text(old)
                complaint = self.ends((*words, "--quiet"), 2, limit_files(100))
                self.assertIn(f"{name}: {TOO_LARGE}", complaint)
                self.assertIn("make room", complaint)
                self.assertEqual(file.read_text() if file.exists() else None, old)
                self.assertEqual(list(self.folder.rglob("*.part*")), [])

    def test_a_file_keeps_its_permissions_and_a_link_or_device_its_place(self):
        os.symlink("old.json", "link.json")
        for limit, code in ((None, 0), (limit_files(100), 2)):
            self.write("old.json", "old")
            os.chmod("old.json", 0o600)
            complaint = self.ends((*SMALL, "--quiet", "--json", "link.json"), code, limit)
            self.assertEqual(Path("old.json").read_text() == "old", code == 2)
            self.assertEqual(Path("old.json").stat().st_mode & 0o777, 0o600)
            self.assertTrue(Path("link.json").is_symlink())
        self.assertIn(f"link.json: {TOO_LARGE}", complaint)
        self.ends((*SMALL, "--quiet", "--json", "/dev/null"), 0)
        self.assertTrue(Path("/dev/null").is_char_device())
        complaint = self.ends((*SMALL, "--quiet", "--json", "/dev/full"), 2)
        for part in ("/dev/full: cannot be written: No space left", "make room"):
            self.assertIn(part, complaint)
        longest = 250 * "n" + ".json"
        self.ends((*SMALL, "--quiet", "--json", longest), 0)
        json.loads(Path(longest).read_text())
        self.assertEqual(list(self.folder.rglob("*.part*")), [])

    def test_a_folder_that_may_not_be_written_is_said(self):
        """Root may write anywhere, so that another user tries."""
        os.mkdir("closed", 0o555)
        os.chmod(".", 0o755)
        for words in ((*SMALL, "--json", "closed/a.json"), ("study", "study.toml", "--output", "closed")):
            try:
                complaint = self.ends(words, 2, become_nobody)
            except PermissionError:
                self.skipTest("no other user may run the program where it is")
            self.assertIn("cannot be written: Permission denied", complaint)
            self.assertEqual(list(Path("closed").iterdir()), [])

    def test_a_study_on_a_full_disk_stops_and_goes_on(self):
        study = ("study", "study.toml", "--output", "points", "--json", "result.json")
        complaint = self.ends(study, 2, limit_files(1024))
        self.assertIn(TOO_LARGE, complaint)
        self.assertIn("the same command goes on from there", complaint)
        self.assertEqual([*self.folder.rglob("*.json*"), *self.folder.rglob("*.part*")], [])
        self.ends(study, 0)

    def test_where_nothing_can_be_written_nothing_is_solved(self):
        self.write("plain", "a file")
        os.mkdir("d.csv")
        lost = "no/such/folder/x"
        for words, name in (((*SMALL, "--json", lost), f"--json {lost}"), ((*SMALL, "--json", "."), "--json ."),
                            ((*SMALL, "--fields", f"{lost}.h5"), f"--fields {lost}.h5"),
                            ((*SMALL, "--fields", "d.csv"), "--fields d.csv"),
                            ((*SMALL, "--figure", f"{lost}.svg"), f"{lost}.svg"),
                            (("study", "study.toml", "--output", "plain"), "plain"),
                            (("report", "--quick", "--output", "plain/report"), "plain/report"),
                            (("gate", "gates.toml", "--junit", lost), f"--junit {lost}")):
            complaint = self.ends(words, 2)
            self.assertTrue(complaint.startswith(f"slipstick: {name}"), complaint)
            self.assertIn("cannot be written: ", complaint)
            self.assertRegex(complaint, "name a file in that folder" if name.split()[-1] in (".", "d.csv") else "make its folder|plain")
            self.assertEqual(Path("out").read_text(), "")

    def test_threads_that_cannot_start_are_said(self):
        """The threads that did start end, and so does the program."""
        for limit in (limit_memory, limit_processes):
            with self.subTest(limit.__name__):
                try:
                    runs = subprocess.run([PROGRAM, "--version"], preexec_fn=limit, capture_output=True).returncode == 0
                except PermissionError:
                    runs = False
                if not runs:  # a sanitizer needs more memory; uid 65534 may not read this folder
                    self.skipTest("the program does not run under this limit")
                self.ends((*SMALL, "--set", "solver.threads=1"), 0, limit)
                complaint = self.ends((*SMALL, "--set", "solver.threads=64"), 2, limit)
                self.assertIn("solver.threads = 64: allowed: up to ", complaint)
