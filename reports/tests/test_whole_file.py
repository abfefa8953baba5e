#!/usr/bin/env python3
"""A page or a figure is the old one or the whole new one."""

import fcntl
import os
import resource
import signal
import stat
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))

from whole_file import write_whole  # noqa: E402


class WholeFile(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.file = self.folder / "page.html"

    def names(self):
        return sorted(os.listdir(self.folder))

    def test_is_written_and_written_anew(self):
        write_whole(self.file, b"old")
        self.file.chmod(0o640)
        write_whole(self.file, b"new")
        self.assertEqual(self.file.read_bytes(), b"new")
        self.assertEqual(stat.S_IMODE(self.file.stat().st_mode), 0o640)
        self.assertEqual(self.names(), ["page.html"])

    def test_a_full_disk_leaves_the_old_one(self):
        write_whole(self.file, b"old")
        link = self.folder / "link.html"
        link.symlink_to("page.html")
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        for name in (self.file, link, self.folder / "new.html"):
            resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
            try:
                with self.assertRaisesRegex(OSError, "File too large.*(page|new).html"):
                    write_whole(name, bytes(100_000))
            finally:
                resource.setrlimit(resource.RLIMIT_FSIZE, before)
            self.assertEqual(self.file.read_bytes(), b"old")
            self.assertEqual(self.names(), ["link.html", "page.html"])

    def test_whoever_is_killed_leaves_the_old_one(self):
        write_whole(self.file, b"old")
        lines = (f"import os, signal, sys; sys.path.insert(0, {str(HERE.parent)!r}); import pathlib, whole_file",
                 "os.replace = lambda *names: os.kill(os.getpid(), signal.SIGKILL)",
                 f"whole_file.write_whole(pathlib.Path({str(self.file)!r}), b'new')")
        self.assertEqual(subprocess.run([sys.executable, "-c", "\n".join(lines)]).returncode, -signal.SIGKILL)
        self.assertEqual(self.file.read_bytes(), b"old")
        self.assertEqual(len(self.names()), 2)
        write_whole(self.file, b"newer")
        self.assertEqual(self.names(), ["page.html"])

    def test_drafts_go_with_their_writer_only(self):
        for name in ("page.html.part-0123abcd", "page.html.part-4567abcd", "page.html.part-2.txt"):
            (self.folder / name).write_text("half")
        with open(self.folder / "page.html.part-4567abcd", "rb") as writer:
            fcntl.flock(writer, fcntl.LOCK_EX)
            write_whole(self.file, b"whole")
        self.assertEqual(self.names(), ["page.html", "page.html.part-2.txt", "page.html.part-4567abcd"])

    def test_links_and_devices_stay(self):
        link = self.folder / "link.html"
        link.symlink_to("page.html")
        write_whole(link, b"text")
        self.assertTrue(link.is_symlink())
        self.assertEqual(self.file.read_bytes(), b"text")
        write_whole(Path("/dev/null"), b"text")
        self.assertTrue(Path("/dev/null").is_char_device())

    def test_what_cannot_be_written_is_named(self):
        for path in (self.folder, self.folder / "no" / "page.html"):
            with self.assertRaisesRegex(OSError, str(path)):
                write_whole(path, b"text")
        self.assertEqual(self.names(), [])
