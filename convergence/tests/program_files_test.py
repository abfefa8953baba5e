"""program_files_test.py PROGRAM: commands overwrite none of their input files, and file names may have any bytes."""

import json
import os
import shutil
from pathlib import Path

from program_run import SHORT_SCENE, SOURCE, ProgramTest

FIELD = SOURCE / "convergence/check/fields/contact-64-0.9.csv"
ODD = b"-a b\n'c\" $x `y` <z>&{} \xff"
SAID = "-a b\n'c\" $x `y` <z>&{} \u00ff"  # TOML is UTF-8
IN_TOML = "-a b\\n'c\\\" $x `y` <z>&{} \u00ff"


class ProgramFiles(ProgramTest):
    def kept(self, input_file, option, *words):
        """A command that would overwrite its input is refused and the file is unchanged."""
        content = Path(input_file).read_bytes()
        self.assertTrue(content)
        self.run_program(*words, code=2, says=(" ".join(option), "would overwrite", "allowed: another file"))
        self.assertEqual(Path(input_file).read_bytes(), content, words)

    def gates(self, source):
        self.write("gates.toml", f'[[gate]]\nid = "a"\n{source}\nquantity = "twist"\nbelow = 1.0\nbasis = "b"\n')

    def test_results_never_overwrite_a_file_of_the_command_line(self):
        self.write("scene.toml", SHORT_SCENE)
        self.write("study.toml", 'scene = "scene.toml"\ncells = [8, 12]\n')
        self.write("cases.toml", '[[family]]\nname = "f"\nwhy = "w"\nscene = "scene.toml"\n')
        self.gates('result = "result.json"')
        self.write("result.json", '{"twist": 0.5}')
        self.write("field.csv", "x1,x2,pressure,q1,q2\n0,0,1,0,1\n")
        self.write("profile.csv", "0,1\n1,0\n")
        for option, file, *words in (("--json", "scene.toml", "solve", "scene.toml"),
                                     ("--json", "field.csv", "check", "scene.toml", "field.csv"),
                                     ("--json", "study.toml", "study", "study.toml"),
                                     ("--json", "cases.toml", "hard", "cases.toml"),
                                     ("--junit", "gates.toml", "gate", "gates.toml"),
                                     ("--summary", "gates.toml", "gate", "gates.toml"),
                                     ("--json", "result.json", "compare", "result.json", "result.json"),
                                     ("--json", "scene.toml", "report", "scene.toml"),
                                     ("--json", "profile.csv", "exact", "--profile", "file:profile.csv",
                                      "--moment-ratio", "0.5")):
            self.kept(file, (option, file), *words, option, file)

    def test_results_never_overwrite_a_file_that_another_names(self):
        self.write("scene.toml", SHORT_SCENE + "extent = [1e-3, 1e-3]\n")
        for name, option in (("pressure.csv", "pressure.csv"), ("pressure-1.csv", "pressure-{step}.csv")):
            self.write(name, "x1,x2,pressure\n0,0,1e9\n")
            self.kept(name, ("--fields", name), "solve", "scene.toml", "--set", "contact.pressure=file", "--set",
                      f"contact.pressure_file={name}", "--fields", option)
        self.write("study.toml", 'scene = "scene.toml"\ncells = [8, 12]\n')
        self.gates('scene = "scene.toml"')
        json_scene = ("--json", "scene.toml")
        self.kept("scene.toml", json_scene, "study", "study.toml", *json_scene)
        self.kept("scene.toml", json_scene, "gate", "gates.toml", *json_scene)

    def test_results_never_overwrite_an_input_by_another_name(self):
        self.write("scene.toml", SHORT_SCENE)
        os.mkdir("below")
        os.symlink("scene.toml", "link.json")
        os.link("scene.toml", "hard.json")
        for name in ("./scene.toml", "below/../scene.toml", "link.json", "hard.json"):
            for scene in ("scene.toml", "link.json"):
                self.kept("scene.toml", ("--json", name), "solve", scene, "--json", name)

    def test_names_may_hold_anything(self):
        Path(os.fsdecode(ODD + b".toml")).write_text(SHORT_SCENE)
        self.run_program("solve", b"--json=" + ODD + b".json", b"--fields=" + ODD + b".csv", "--", ODD + b".toml")
        json.loads(Path(os.fsdecode(ODD + b".json")).read_bytes())
        self.run_program("check", "--", ODD + b".toml", ODD + b".csv")
        self.write(f"{SAID}.toml", SHORT_SCENE)
        self.write(f"{SAID}-study.toml", f'scene = "{IN_TOML}.toml"\ncells = [8, 12]\nquantities = ["twist_error"]\n')
        self.run_program("study", b"--output=" + ODD, b"--json=" + ODD + b".json", "--", f"{SAID}-study.toml")
        json.loads(Path(os.fsdecode(ODD + b".json")).read_bytes())
        Path(os.fsdecode(ODD + b"-gates.toml")).write_text(
            f'[[gate]]\nid = "{IN_TOML}"\nscene = "{IN_TOML}.toml"\nquantity = "twist_angle"\nbelow = 1.0\nbasis = "b"\n')
        self.run_program("gate", b"--output=" + ODD, b"--junit=" + ODD + b".xml", "--", ODD + b"-gates.toml")
        self.assertTrue(Path(os.fsdecode(ODD + b".xml")).read_bytes())

    def test_json_is_utf_8_whatever_a_file_is_called(self):
        name = b"caf\xe9.csv"
        shutil.copy(FIELD, os.fsdecode(name))
        self.result("check", str(SOURCE / "convergence/scenes/paper.toml"), name)
