"""skipped_test.py SOURCE_DIR: skipped.py finds the reasons of scripts, of unittest and of GoogleTest in the log of ctest."""

import pathlib
import subprocess
import sys
import tempfile

LOG = """1/5 Testing: programs.tamaas
Output:
----------
LEFT OUT: tamaas is not installed
<end of output>
2/5 Testing: python.solve
test_frames (test_solve.Frames) ... skipped 'pandas is not installed'
test_other (test_solve.Frames) ... skipped 'pandas is not installed'
test_good (test_solve.Frames) ... ok
OK (skipped=2)
3/5 Testing: convergence_tests.RunProgram
[ RUN      ] RunProgram.DoesNotOutliveItsParent
/x/run_program_test.cpp:93: Skipped
only Linux kills a process with its parent
4/5 Testing: front_door.forge
SKIPPED: no PyYAML; install python3-yaml
5/5 Testing: solver_tests.Sphere
[  PASSED  ] 3 tests.
"""
LIST = """skipped: convergence_tests.RunProgram: only Linux kills a process with its parent
skipped: front_door.forge: no PyYAML; install python3-yaml
skipped: programs.tamaas: tamaas is not installed
skipped: python.solve: pandas is not installed (2 cases)
skipped: reports.browser: no browser
"""

with tempfile.TemporaryDirectory() as folder:
    log = pathlib.Path(folder) / "Testing/Temporary/LastTest.log"
    log.parent.mkdir(parents=True)
    log.write_text(LOG)
    (pathlib.Path(folder) / "not_tested.txt").write_text("reports.browser: no browser\n")
    script = pathlib.Path(sys.argv[1]) / "cmake/tests/skipped.py"
    found = subprocess.run([sys.executable, "-B", script, folder], capture_output=True, text=True, check=True).stdout
    sys.exit(found != LIST and f"{found}\nis not\n{LIST}")
