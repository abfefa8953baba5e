"""action_test.py PROGRAM SOURCE_DIR: the steps of action.yml, run as GitHub runs them, with made-up gh and pip."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import yaml
except ImportError:
    print("SKIPPED: no PyYAML; install python3-yaml")
    sys.exit(77)

PROGRAM, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
ACTION = yaml.safe_load((SOURCE / "action.yml").read_text())
GATE = "[[gate]]\nid = '{0}'\nresult = 'mine.json'\nquantity = 'x'\nbelow = {1}\nbasis = 'b'\n"
FAKES = {"gh": """echo "gh $*" >> "$CALLS"
case "$*" in
  *commits/v1.0.0*|*commits/1234567*) echo 1234567890;;
  *commits/*) echo 999;;
  *download*) touch "${@: -1}/slipstick-1.whl";;
esac""", "python3": """echo "python3 $*" >> "$CALLS"
mkdir -p "$3/bin"
printf '#!/bin/sh\\necho "pip $* commit=$SLIPSTICK_COMMIT" >> "$CALLS"\\n' > "$3/bin/pip"
chmod +x "$3/bin/pip" """}


class ActionTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        self.fake("slipstick", f'exec "{PROGRAM}" "$@"')
        self.calls = self.folder / "calls"
        self.calls.touch()

    def fake(self, name, script):
        path = self.folder / "bin" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"#!/bin/bash\n{script}\n")
        path.chmod(0o700)

    def act(self, ref="v1.0.0", code=0, action=SOURCE, **inputs):
        """Runs the steps up to one that fails with this code; returns the action's outputs."""
        given = {name: each["default"] for name, each in ACTION["inputs"].items()}
        values = {f"inputs.{name}": value for name, value in given.items()}
        values |= {f"inputs.{name.replace('_', '-')}": value for name, value in inputs.items()}
        values |= {"github.token": "t", "github.action_repository": "o/s", "github.action_ref": ref, "github.action_path": str(action)}

        def filled(text):
            def value(match):
                return next((found for each in match[1].split("||") if (found := values.get(each.strip()))), "")
            return re.sub(r"\$\{\{(.*?)\}\}", value, text)

        for step in ACTION["runs"]["steps"]:
            if "if" in step and not values[step["if"].split(" ")[0]]:
                continue
            output = self.folder / "output"
            output.write_text("")
            environment = {**os.environ, "PATH": f"{self.folder}/bin:/usr/bin:/bin", "GITHUB_OUTPUT": str(output),
                           "GITHUB_PATH": "path", "GITHUB_STEP_SUMMARY": "summary.md", "RUNNER_TEMP": str(self.folder),
                           "CALLS": str(self.calls), **{key: filled(text) for key, text in step["env"].items()}}
            done = subprocess.run(["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]], env=environment,
                                  capture_output=True, text=True)
            values |= {f"steps.{step['id']}.outputs.{key}": text
                       for key, _, text in (line.partition("=") for line in output.read_text().splitlines())}
            if done.returncode:
                break
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return {name: filled(each["value"]) for name, each in ACTION["outputs"].items()}

    def test_gates(self):
        Path("mine.json").write_text('{"x": 1}')
        Path("gates.toml").write_text(GATE.format("paper-1", 2) + GATE.format("paper-2", 3))
        Path("bad.toml").write_text(GATE.format("bad", 0.5))
        Path("paper-1").touch()  # the shell must not put this name in the place of paper-*
        out = self.act(gates="gates.toml bad.toml", code=1)
        self.assertEqual((out["verdict"], out["counts"]), ("failed", "3 gates: 2 passed, 1 failed"))
        report = Path(out["report"])
        self.assertEqual(json.loads((report / "gates.json").read_text())["exit_code"], 1)
        self.assertIn("<testcase", (report / "gates.xml").read_text())
        self.assertEqual(json.loads(Path(out["badge"]).read_text())["message"], "1 of 3 gates failed")
        self.assertIn("### 3 gates", Path("summary.md").read_text())
        out = self.act(gates="gates.toml bad.toml", gate_options="--only paper-*\n --history h.jsonl")
        self.assertEqual((out["verdict"], out["counts"]), ("passed", "2 gates: 2 passed"))
        self.assertEqual(len(Path("h.jsonl").read_text().splitlines()), 1)
        out = self.act(gates="missing.toml", code=2)
        self.assertEqual(out["verdict"], "not judged")

    def test_fields(self):
        scene, field = SOURCE / "convergence/scenes/paper.toml", SOURCE / "convergence/check/fields/contact-64-0.9.csv"
        for ratio, code, verdict, color in (("0.9", 0, "passed", "brightgreen"), ("0.8", 1, "failed", "red"),
                                            ("2", 2, "not judged", "yellow")):
            out = self.act(scene=str(scene), field=str(field), options=f"--set load.moment_ratio={ratio}", code=code)
            self.assertEqual((out["verdict"], out["counts"]), (verdict, ""))
            self.assertEqual(json.loads(Path(out["badge"]).read_text())["color"], color)
            self.assertIn("<testcase", (Path(out["report"]) / "check.xml").read_text())
        self.assertIn("### bad", Path("summary.md").read_text())

    def test_installs_the_commit_that_is_asked_for(self):
        """A tag or the commit of a release takes the wheel of the release; any other commit is built from the action's folder."""
        (self.folder / "bin/slipstick").unlink()
        for name, script in FAKES.items():
            self.fake(name, script)
        action = self.folder / "action"
        (action / "cmake").mkdir(parents=True)
        (action / "CMakeLists.txt").write_text((SOURCE / "CMakeLists.txt").read_text())
        (action / "cmake/setup").write_text('#!/bin/sh\necho setup >> "$CALLS"\n')
        (action / "cmake/setup").chmod(0o700)
        for ref, installed in (("v1.0.0", "/slipstick-1.whl commit=\n"), ("1234567", "/slipstick-1.whl commit=\n"),
                               ("abcdef0", f"{action} commit=abcdef0\n")):
            self.calls.write_text("")
            self.act(ref=ref, action=action)
            self.assertTrue(self.calls.read_text().endswith(installed), self.calls.read_text())
            self.assertEqual("setup" in self.calls.read_text(), ref == "abcdef0")
        self.calls.write_text("")
        self.act(wheel="mine.whl", action=action)
        self.assertIn("install --quiet mine.whl", self.calls.read_text())
        self.assertNotIn("gh ", self.calls.read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
