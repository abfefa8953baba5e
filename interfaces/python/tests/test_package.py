"""The package as a whole: its declarations of C functions agree with slipstick.h, and it contains all of its files."""
import ctypes
import pathlib
import re
import subprocess
import sys
import unittest

import slipstick
from slipstick import _library

ROOT = pathlib.Path(__file__).parents[3]
HEADER = re.sub(r"/\*.*?\*/", "", (ROOT / "interfaces/c/slipstick.h").read_text(), flags=re.S)


def kind(parameter):
    """The ctypes type for a parameter of C."""
    if "*" in parameter or "[" in parameter or "slipstick_progress" in parameter:
        return "pointer"
    return re.match(r"(?:const )?(\w+)", parameter.strip())[1]


def ctypes_kind(argument):
    return {ctypes.c_int: "int", ctypes.c_size_t: "size_t", ctypes.c_double: "double"}.get(argument, "pointer")


class PackageTest(unittest.TestCase):
    def test_declarations(self):
        declared = {name: [] if parameters.strip() == "void" else [kind(part) for part in parameters.split(",")]
                    for name, parameters in re.findall(r"\bslipstick_(\w+)\(([^;]*)\);", HEADER)}
        self.assertGreaterEqual(len(declared), len(_library._SIGNATURES))
        for name, (_, arguments) in _library._SIGNATURES.items():
            self.assertEqual([ctypes_kind(argument) for argument in arguments], declared[name], name)

    def test_structures(self):
        structures = {name: re.findall(r"(\w+);", body)
                      for body, name in re.findall(r"typedef struct \w+ \{(.*?)\} slipstick_(\w+);", HEADER, re.S)}
        self.assertEqual(list(_library.STATE.names), structures["state"])
        self.assertEqual(list(_library.CYCLE_STATE.names), structures["cycle_state"])
        self.assertEqual([name for name, _ in _library.Profile._fields_], structures["profile"])
        self.assertEqual([name for name, _ in _library.Indentation._fields_], structures["indentation"])

    def test_statuses_and_quantities(self):
        numbers = dict(re.findall(r"SLIPSTICK_(\w+) = (\d)", HEADER))
        for name in ("OK", "NOT_CONVERGED", "BAD_INPUT", "STOPPED", "NO_MEMORY", "FAILED"):
            self.assertEqual(getattr(_library, name), int(numbers[name]))
        for number, name in enumerate(slipstick.exact._WANTED):
            self.assertEqual(number, int(numbers[name.upper()]))

    def test_it_is_typed_and_documented(self):
        folder = pathlib.Path(slipstick.__file__).parent
        self.assertTrue((folder / "py.typed").exists())
        staged = {path.name for path in folder.glob("*.py")}
        self.assertEqual(staged, {path.name for path in (ROOT / "interfaces/python/slipstick").glob("*.py")})
        for name in slipstick.__all__:
            self.assertTrue(name == "__version__" or getattr(slipstick, name).__doc__, name)

    def test_typed_attributes_are_those_of_results(self):
        """The names that type checkers see are names of results."""
        solution = slipstick.solve(slipstick.scene("paper"), grid__cells=[24, 24])
        typed = set(slipstick.Solution.__annotations__) - {"message", "text"}
        self.assertGreater(len(typed), 15)
        self.assertLessEqual({name for name in typed if not name.startswith("_")}, set(solution))
        self.assertLessEqual(set(slipstick.Fields.__annotations__), set(solution.fields))

    def test_exact_offers_its_functions(self):
        names = {name for name, value in vars(slipstick.exact).items()
                 if getattr(value, "__module__", "") == "slipstick.exact" and not name.startswith("_")}
        self.assertEqual(set(slipstick.exact.__all__), names)

    def test_the_program_finds_the_files_of_the_package(self):
        run = subprocess.run([sys.executable, "-B", "-m", "slipstick", "solve", "convergence/scenes/cone.toml", "--model", "exact"],
                             capture_output=True, text=True, cwd="/")
        self.assertEqual((run.returncode, run.stdout[:5]), (0, "cone:"))
        self.assertIn("is the file of the package", run.stderr)

    def test_the_program_comes_with_it(self):
        run = subprocess.run([sys.executable, "-B", "-m", "slipstick", "--version"], capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stdout.strip()), (0, slipstick.__version__))
        version = re.search(r"VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text()[40:])[1]
        self.assertEqual(slipstick.__version__, version)
