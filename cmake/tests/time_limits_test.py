"""time_limits_test.py BUILD_FOLDER SECONDS: every test has this time limit or a longer one; limits are for tests that hang, not for busy machines."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

build, least = sys.argv[1], float(sys.argv[2])
with tempfile.TemporaryDirectory() as folder:  # in the build folder it would empty the log of the ctest that runs this test
    Path(folder, "CTestTestfile.cmake").write_text(f'subdirs("{Path(build).as_posix()}")\n')
    listing = subprocess.run(["ctest", "--test-dir", folder, "--show-only=json-v1"], capture_output=True, text=True, check=True)
tests = [test for test in json.loads(listing.stdout)["tests"] if not test["name"].endswith("_NOT_BUILT")]
limits = {test["name"]: next((each["value"] for each in test["properties"] if each["name"] == "TIMEOUT"), 0)
          for test in tests}
short = [f"{name}: {limit:g} s" for name, limit in limits.items() if not limit >= least]
print(f"{len(tests)} tests, {len(short)} of which may take less than {least:g} s", *short[:20], sep="\n")
sys.exit(1 if short or not tests else 0)
