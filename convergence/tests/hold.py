"""Stops a program when it renames a finished file, so that a test can act at a known moment on a slow machine too."""

import os
import subprocess
import time

PATIENCE = 600  # seconds, longer than it takes on any machine
SOURCE = r"""
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void hold(void) {
  FILE* const draft = fopen(getenv("HOLD_DRAFT"), "w");
  fprintf(draft, "%d", (int)getpid());
  fclose(draft);
  renameat(AT_FDCWD, getenv("HOLD_DRAFT"), AT_FDCWD, getenv("HOLD_FLAG"));
  while (access(getenv("HOLD_FLAG"), F_OK) == 0) usleep(1000);
}

/* All processes of the program count in one file. */
static int is_the_one(const char* file) {
  if (fnmatch(getenv("HOLD_FILES"), file, 0) != 0) return 0;
  const int count = open(getenv("HOLD_COUNT"), O_WRONLY | O_CREAT | O_APPEND, 0600);
  if (write(count, "x", 1) != 1) abort();
  const long number = (long)lseek(count, 0, SEEK_CUR);
  close(count);
  return number == atol(getenv("HOLD_NUMBER"));
}

int rename(const char* from, const char* to) {
  const int held = is_the_one(to);
  const int after = getenv("HOLD_AFTER") != NULL;
  if (held && !after) hold();
  const int result = renameat(AT_FDCWD, from, AT_FDCWD, to);
  if (held && after) hold();
  return result;
}

/* Gives another process time to put a file there. */
int remove(const char* file) {
  if (getenv("HOLD_REMOVALS") != NULL) usleep(20000);
  return unlink(file) == 0 || (errno == EISDIR && rmdir(file) == 0) ? 0 : -1;
}
"""


class Hold:
    """A program with this environment waits before, or just after, it renames to the file of this pattern and number,
    counted from 1 over all its processes."""

    def __init__(self, folder, files, number, after=False):
        self.flag = folder / "held"
        library, count = folder / "hold.so", folder / "hold.count"
        subprocess.run([os.environ.get("CC", "cc"), "-shared", "-fPIC", "-x", "c", "-", "-o", library], input=SOURCE, text=True,
                       check=True)
        for old in (count, self.flag):
            old.unlink(missing_ok=True)
        self.environment = os.environ | {
            "LD_PRELOAD": str(library), "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0",
            "HOLD_FILES": files, "HOLD_NUMBER": str(number), "HOLD_COUNT": str(count), "HOLD_FLAG": str(self.flag),
            "HOLD_DRAFT": str(folder / "held.draft")} | ({"HOLD_AFTER": "1"} if after else {})

    def process(self, program):
        """Waits until a process of the program is held; returns its id."""
        end = time.monotonic() + PATIENCE
        while not self.flag.exists():
            assert program.poll() is None, "it ended, and was never held"
            assert time.monotonic() < end, "it is not held"
            time.sleep(0.005)
        return int(self.flag.read_text())

    def release(self):
        self.flag.unlink()
