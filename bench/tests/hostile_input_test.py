"""hostile_input_test.py PROGRAM: every reader of the program against every way in which a file can be damaged: each is
refused at once, with its name, the allowed content and exit code 2. The findings of fuzzers are kept in the corpora of
the readers."""

import json
import math
import os
import subprocess
import unittest
from pathlib import Path

from program_run import PROGRAM, SHORT_SCENE, ProgramTest

try:
    import h5py
except ImportError:
    h5py = None

RADIUS = 4.89e-4
EXTENT = 8 / 3 * RADIUS  # of the contact and a cell around it


def sphere_field(peak):
    """The sphere's contact on 6 x 6 cells, turned."""
    lines = ["x1,x2,pressure,q1,q2"]
    for x1, x2 in (((i - 2.5) / 3, (j - 2.5) / 3) for i in range(6) for j in range(6)):
        pressure = peak * math.sqrt(max(0, 1 - x1 * x1 - x2 * x2))
        if pressure > 0:
            row = RADIUS * x1, RADIUS * x2, pressure, -0.1 * pressure * x2, 0.1 * pressure * x1
            lines.append(",".join(f"{value:.9g}" for value in row))
    return "\n".join(lines) + "\n"


TWISTS = [1e-5 * (i if i <= 15 else 30 - i) for i in range(31)]  # there and back, all of it sticking
STUDY = 'scene = "sphere.toml"\ncells = [8, 12]\n'
GATES = '[[gate]]\nid = "a"\nscene = "sphere.toml"\nquantity = "twist_error"\nbelow = 1.0\nbasis = "b"\n'
CASES = ('[[family]]\nname = "f"\nwhy = "w"\nscene = "sphere.toml"\n[[family.vary]]\nkey = "contact.friction"\n'
         'values = [0.1, 0.2]\n')
RUNS = '{"scene": "sphere.toml", "set": ["grid.cells=[8,8]"], "rounding": "upward", "output": "runs"}\n'
HEIGHTS = "0.1,0.2,0.3\n0.2,0.1,0.2\n"
FIELD = sphere_field(2e9)
COLUMNS = sphere_field(1.9186e9)  # carries 1000 N
LOOP = "time,moment,rotation\n" + "".join(f"{i},{25 * twist:g},{twist:g}\n" for i, twist in enumerate(TWISTS))
JSON_LOOP = json.dumps({"rotation": TWISTS, "moment": TWISTS}).replace("[0.0, ", "[0,")
PROFILE = "radius,pressure\n" + "".join(f"{i / 16:g},{2 - i / 16:g}\n" for i in range(17))
TIMINGS = json.dumps({"context": {"num_cpus": 2}, "benchmarks": 10 * [
    {"name": "a", "real_time": 1, "cpu_time": 1, "time_unit": "ms"}]})
LONG_KEY = "a" + 32 * ' . "a b"'  # of 33 parts
LONG = "a key of more than 32 parts; allowed: 32"
GIVEN = ("solve", "sphere.toml", "--set", "contact.pressure=file", "--set", f"grid.extent=[{EXTENT},{EXTENT}]",
         "--set", "grid.cells=[8,8]", "--set")
# Each kind of file, and the command that reads it.
READERS = {
    "scene.toml": (SHORT_SCENE, ("solve", "scene.toml")),
    "study.toml": (STUDY, ("study", "study.toml", "--output", "runs")),
    "gates.toml": (GATES, ("gate", "gates.toml", "--output", "runs")),
    "cases.toml": (CASES, ("hard", "cases.toml", "--once", "--output", "runs")),
    "runs.jsonl": (RUNS, ("run", "runs.jsonl")),
    "heights.csv": (HEIGHTS, ("solve", "map.toml")),
    "columns.csv": (COLUMNS, (*GIVEN, "contact.pressure_file=columns.csv")),
    "columns.h5": (None, (*GIVEN, "contact.pressure_file=columns.h5")),
    "field.csv": (FIELD, ("check", "sphere.toml", "field.csv")),
    "loop.csv": (LOOP, ("check", "sphere.toml", "loop.csv")),
    "loop.json": (JSON_LOOP, ("check", "sphere.toml", "loop.json")),
    "profile.csv": (PROFILE, ("exact", "--profile", "file:profile.csv", "--moment-ratio", "0.5")),
    "result.json": ('{"twist_error": 0.5}', ("gate", "result.toml")),
    "timings.json": (TIMINGS, ("compare", "timings.json", "other.json", "--same-machine")),
}

if not (Path(PROGRAM).parent / "python/slipstick/_native").exists():
    for read_by_the_package in ("loop.csv", "loop.json", "timings.json"):
        del READERS[read_by_the_package]


def changed(text, old, new):
    assert old in text, old
    return text.replace(old, new, 1)


def second_row(row):
    lines = COLUMNS.splitlines()
    return "\n".join([*lines[:2], row, *lines[3:]]) + "\n"


# A defect of a text, and the word that the message must have in addition to the file.
DAMAGES = [
    *(("scene.toml", changed(SHORT_SCENE, old, new), says) for old, new, *says in (
        ("0.018", "nan", "upper.radius = nan", "positive"),
        ("0.018", "inf", "upper.radius = inf", "finite"),
        ("0.018", "1e400", ":3"),
        ("[32, 32]", "[1000000, 1000000]", "grid.cells", "1000000", "65536"),
        ("0.018", "{ a = 1 }", "upper.radius", "a number"),
        ('"sphere"', '"' + 3000000 * "a" + '"', 'upper.shape = "aaa'),
        ("radius", 3000000 * "a" + " = 1\nradius", ":3"),
        ("[grid]", f"[{LONG_KEY}]\n[grid]", ":14", LONG),
        ("[upper]", f"{LONG_KEY} = 1\n[upper]", ":1", LONG),
        ("[upper]", f"{8 * 'a.'}a = {250 * ('{ ' + 28 * 'a.' + 'a = ')}1{250 * '}'}\n[upper]", ":1", LONG),
        ("[grid]", 100001 * "[[step]]\n" + "[grid]", "step = 100001 tables", "at most 100000"),
        ("[upper]", "cycles = 100001\n[upper]", "cycles = 100001"),
        ('shape = "sphere"\nradius = 0.018\n', 'shape = [' + 1001 * '{ shape = "sphere", radius = 1 }, ' + "]\n",
         "upper.shape = 1001 tables: allowed: at most 1000"))),
    ("study.toml", STUDY + "tolerances = [nan]\n", ("tolerances[0] = nan", "positive")),
    ("study.toml", changed(STUDY, "12", "1000000"), ("cells[1] = 1000000", "16384")),
    ("study.toml", STUDY + "shift = 2\n", ("shift", "shifts")),
    ("study.toml", "cells = [8, 12]\n", ("scene", "missing")),
    *(("gates.toml", changed(GATES, old, new), says) for old, new, *says in (
        ("1.0", "nan", "gate[0].below = nan", "finite"),
        ("1.0", "-1", "positive"),
        ("below", "bellow = 1\nbelow", ":5", "gate[0].bellow", "nearest known one is gate[0].below"),
        ("scene =", "study = 'a.toml'\nscene =", "one of scene and study"),
        ("scene =", "set = 1\nscene =", "gate[0].set = 1", "a table"),
        ('scene = "sphere.toml"\n', "", "one of scene and study"),
        ("below", "bellow", ":5", "gate[0].bellow", "nearest known one is gate[0].below"),
        ('id = "a"\n', "", "gate[0].id"),
        ('quantity = "twist_error"\n', "", "gate[0].quantity"),
        ("below = 1.0\n", "", "below, above, both, equals, of and within, or published"),
        ("below = 1.0", "below = 1.0\nequals = 3", "equals"),
        ("below = 1.0", "below = 1.0\nabove = 1.0", "less than below"),
        ('basis = "b"\n', "", "gate[0].basis", "active gate"),
        ('"b"', "''", "gate[0].basis"),
        ("basis", "status = 'off'\nbasis", '"off"', "expected_failure"),
        ("basis", "platform_spread = -1\nbasis", "platform_spread"),
        ("[[gate]]", "[[gates]]", "gates"),
        ("[[gate]]", "[[gate]", ":1"))),
    ("gates.toml", 'gate = "a"\n', ("gate = ", "[[gate]]")),
    ("cases.toml", changed(CASES, "why", "whi"), ("why",)),
    ("cases.toml", "\n", ("[[family]]",)),
    ("cases.toml", CASES + "speed = 3\n", ("speed",)),
    ("cases.toml", changed(CASES, "[0.1, 0.2]", "[]"), ("values = []", "at least one")),
    *(("runs.jsonl", RUNS + changed(RUNS, old, new), (":2", *says)) for old, new, *says in (
        ('{"scene', '["scene', "is not JSON"),
        (RUNS, "[1]", "is no run"),
        ('"sphere.toml"', "3", "scene = 3", "a text"),
        ('"scene": "sphere.toml", ', "", "scene = (missing)", "a scene file"),
        ('"set"', '"sets"', "sets = ", "name, scene, set"),
        ('["grid.cells=[8,8]"]', '[8, 8]', "set = [8,8]", "a list of texts"),
        ('"upward"', '"up"', 'rounding = "up"', "nearest, upward, downward"),
        ('"rounding": "upward"', '"variant": "flipped"', 'variant = "flipped"', "none"),
        ('"rounding": "upward"', '"profile": 1', "profile = 1", "true or false"),
        ('"runs"', '""', 'output = ""', "the folder"),
        ('"rounding"', '"name": "paper-0", "rounding"', 'name = "paper-0"', "has changed"),
        ('"rounding"', '"fields": "sphere.toml", "rounding"', "fields sphere.toml", "would overwrite"))),
    ("heights.csv", changed(HEIGHTS, "0.3", "inf"), (":1", "inf", "finite")),
    ("heights.csv", changed(HEIGHTS, "0.3", "1e400"), (":1", "1e400", "finite")),
    ("heights.csv", changed(HEIGHTS, "0.3\n", "0.3,x\n"), (":1",)),
    ("heights.csv", HEIGHTS + "1,2\n", (":3", "2 values; allowed: 3")),
    ("heights.csv", changed(HEIGHTS, "0.3", "0.3um"), (":1", "0.3um", "finite number")),
    ("columns.csv", second_row("0,1e-4,nan,1e7,0"), (":3", "nan", "finite")),
    ("columns.csv", second_row("0,1e-4,inf,1e7,0"), (":3", "inf", "finite")),
    ("columns.csv", second_row("0,1e-4,1e400,1e7,0"), (":3", "1e400", "finite")),
    ("columns.csv", second_row("0,1e-4,,1e7,0"), (":3", "finite")),
    ("columns.csv", "", ("has no column x1; its columns: none",)),
    ("columns.csv", "x1,x2,pressure,q1,q2\n", ("holds no rows",)),
    ("columns.csv", second_row("0,1e-4\0,1e9,1e7,0"), (":3", "\\x00", "finite")),
    ("columns.csv", second_row(100000 * ","), (":3", "more than 65536 values")),
    ("columns.csv", second_row("0,1e-4,1e9"), (":3", "3 values; allowed: 5")),
    ("columns.csv", second_row("0,1e-4,1 GPa,1e7,0"), (":3", "1 GPa", "finite")),
    ("columns.csv", changed(COLUMNS, "pressure", "p"), ("no column pressure", "x1, x2, p")),
    ("columns.csv", changed(COLUMNS, "q2", "x1"), ("two columns x1; allowed: one",)),
    ("field.csv", FIELD + "4.075e-4,-4.075e-4,-1e9,0,1\n", ("row 33", "pressure = -1", "zero or positive")),
    ("field.csv", FIELD + "8.15e-5,8.15e-5,1e9,0,1\n", ("row 33",)),
    ("field.csv", FIELD + "8.2e-5,8e-5,1e9,0,1\n", ("row",)),
    ("field.csv", FIELD + "0,1e200,1e9,0,1\n", ("allowed",)),
    ("loop.csv", changed(LOOP, "1,0.00025", "1,nan"), (":3", "nan", "finite")),
    ("loop.csv", changed(LOOP, "\n2,", "\n1,"), ("row 3", "time = 1", "later")),
    ("loop.json", changed(JSON_LOOP, "rotation", "height"), ("no rotation", "twist")),
    ("loop.json", changed(JSON_LOOP, "[0,", '["a",'), ("rotation", "a list of numbers")),
    ("loop.json", changed(JSON_LOOP, "[0,", "[1e400,"), ("is not JSON",)),
    ("loop.json", changed(JSON_LOOP, "[0,", "[0,0,"), ("equally many",)),
    ("profile.csv", changed(PROFILE, "0,2", "0,nan"), (":2", "nan")),
    ("profile.csv", changed(PROFILE, "0,2", "0,inf"), (":2", "inf")),
    ("profile.csv", changed(PROFILE, "0,2", "0,1e400"), (":2", "allowed")),
    ("profile.csv", changed(PROFILE, "0,2", "0,-2"), (":2", "-2", "allowed: finite and not negative")),
    ("profile.csv", "0,1\n1,0.5\n", ("16",)),
    *(("profile.csv", changed(PROFILE, old, new), says) for old, new, *says in (
        ("radius", "r", ":1", "radius = r; allowed: a number"),
        ("1.9375", "x", ":3", "pressure = x; allowed: a number"),
        ("1.9375", "2 Pa", ":3", "2 Pa; allowed: a number"),
        ("1.9375", "1,5", ":3", "0.0625,1,5; allowed: radius,pressure"),
        (",1.9375", "", ":3", "0.0625; allowed: radius,pressure"),
        ("0.125", "# p\n\n0.01", ":6", "radius = 0.01; allowed: finite and more than the one before, 0.0625"))),
    ("profile.csv", ((1 << 20) + 1) * " ", ("allowed: a CSV file", "it is larger")),
    ("result.json", '{"twist_error": NaN}', ("not JSON",)),
    ("timings.json", changed(TIMINGS, '"ms"', '"weeks"'), ("time_unit", "weeks")),
    ("timings.json", '{"context": {}, "benchmarks": 3}', ("benchmarks",)),
    ("timings.json", '{"context": {}, "benchmarks": []}', ("benchmark",)),
]


class HostileInput(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("sphere.toml", SHORT_SCENE.replace("[32, 32]", "[8, 8]"))
        self.write("map.toml", SHORT_SCENE.replace(
            'shape = "sphere"\nradius = 0.018',
            'shape = "height_map"\nfile = "heights.csv"\nspacing = [1e-4, 1e-4]\nends_at_grid_edge = true')
            .replace("cells = [32, 32]\n", "").replace("[grid]\n", ""))
        self.write("result.toml", '[[gate]]\nid = "a"\nresult = "result.json"\nquantity = "twist_error"\nbelow = 1.0\n'
                   'basis = "b"\n')
        self.write("other.json", TIMINGS.replace('"real_time": 1,', '"real_time": 1.01,'))

    def good(self, name):
        text, _ = READERS[name]
        if text is None:
            self.run_program("solve", "sphere.toml", "--set", "grid.cells=[8,8]", "--set",
                             f"grid.extent=[{EXTENT},{EXTENT}]", "--fields", name)
        else:
            self.write(name, text)
        return Path(name).read_bytes()

    def ends(self, name):
        """The exit code and the output."""
        end = subprocess.run([PROGRAM, *READERS[name][1]], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60)
        return end.returncode, end.stdout.decode(errors="replace")

    def refused(self, name, damage, says=()):
        code, said = self.ends(name)
        self.assertEqual(code, 2, (name, damage, said[:4000]))
        for part in (name, *says):
            self.assertIn(part, said, (name, damage))
        self.assertLess(len(said), 4000, (name, damage))

    def test_what_is_whole_is_read(self):
        for name in READERS:
            self.good(name)
            code, said = self.ends(name)
            self.assertIn(code, (0, 1), (name, said))

    def test_what_is_no_file_is_refused(self):
        for name in READERS:
            self.refused(name, "missing")
            os.mkdir(name)
            self.refused(name, "a folder")
            os.rmdir(name)
            os.mkfifo(name)
            self.refused(name, "a pipe without a writer")
            # The first address of a process's memory cannot be read.
            for target, what, *says in (("/dev/zero", "a device", "cannot be read", "allowed"), (name, "a link to itself"),
                                        ("/proc/self/mem", "an error while reading")):
                os.remove(name)
                os.symlink(target, name)
                self.refused(name, what, says)
            os.remove(name)
            Path(name).touch()
            os.truncate(name, 1 << 36)  # takes no room on the disk
            self.refused(name, "64 GiB")

    def test_what_holds_something_else_is_refused(self):
        for name, (text, _) in READERS.items():
            for damage, content in (("empty", b""), ("a program", b"\x7fELF\x02\x01\x01\0\0\0\xff\xfe\0\x01"),
                                    ("UTF-16", b"\xff\xfe" + (text or "")[:20].encode()), ("Latin-1", b"caf\xe9 = 1\n"),
                                    ("a page", b"<!doctype html><html><body>Not found</body></html>\n"),
                                    ("deep", 200000 * b"["), ("an endless line", 300000 * b"a")):
                Path(name).write_bytes(content)
                if damage != "empty" or name not in ("gates.toml", "runs.jsonl"):  # there is nothing to do
                    self.refused(name, damage)

    def test_what_is_cut_off_anywhere_is_read_or_refused(self):
        """A beginning may be a whole file too, as where a last line is missing. SLIPSTICK_TEST_ALL=1 cuts at more places."""
        step = 7 if os.environ.get("SLIPSTICK_TEST_ALL") == "1" else 29
        for name in READERS:
            whole = self.good(name)
            for size in range(0, len(whole), len(whole) // 8 if READERS[name][0] is None else step):
                Path(name).write_bytes(whole[:size])
                code, said = self.ends(name)
                self.assertIn(code, (0, 1, 2), (name, size, said))
                if code == 2:
                    self.assertTrue(name in said or "sphere.toml" in said or "map.toml" in said, (name, size, said))

    @unittest.skipIf(os.geteuid() == 0, "root may read everything")
    def test_what_may_not_be_read_is_refused(self):
        for name in READERS:
            self.good(name)
            os.chmod(name, 0)
            self.refused(name, "unreadable")

    def test_a_wrong_value_is_refused_with_its_key_and_what_is_allowed(self):
        for name, text, says in (damage for damage in DAMAGES if damage[0] in READERS):
            self.write(name, text)
            self.refused(name, text[:300], says)

    @unittest.skipIf(h5py is None, "without h5py")
    def test_datasets_are_looked_at_before_memory_is_taken(self):
        """Only numbers of the file itself are read."""
        def refused(make, *says):
            with h5py.File("heights.h5", "w") as file:
                make(file)
            self.run_program("solve", "map.toml", "--set", 'upper.file="heights.h5"', code=2, says=("heights.h5", *says))

        for options, *says in (
                ({"shape": (3,)}, "dataset height", "has 1 dimensions; allowed: 2"), ({"shape": (2, 2, 2)}, "has 3 dimensions"),
                ({"shape": (0, 3)}, "0 x 3 values; allowed: from 1 to "),
                ({"shape": (1 << 20, 1 << 20), "chunks": (1000, 1)}, "1048576 x 1048576 values"),
                ({"shape": (1, 1), "dtype": h5py.string_dtype()}, "holds no numbers"),
                ({"shape": (1, 1), "dtype": h5py.vlen_dtype(float)}, "holds no numbers"),
                ({"shape": (1, 1), "dtype": [("a", "f8")]}, "holds no numbers"),
                ({"shape": (2, 2), "dtype": "f8", "external": [("/dev/zero", 0, h5py.h5f.UNLIMITED)]}, "has its data elsewhere")):
            refused(lambda file: file.create_dataset("height", **options), *says)
        refused(lambda file: file.create_group("height"), "is no dataset")
        refused(lambda file: file.__setitem__("height", h5py.ExternalLink("/etc/hostname", "/x")), "is a link")
        refused(lambda file: None, "no such dataset")

    @unittest.skipIf(h5py is None, "without h5py")
    def test_a_file_that_crashes_the_library_is_named(self):
        """It divides by the size of a chunk in the file. Newer versions of the library refuse a zero there."""
        with h5py.File("heights.h5", "w") as file:
            file.create_dataset("height", (0x5A18, 1), dtype="i4", chunks=(0x5A17, 1))
        whole, size = Path("heights.h5").read_bytes(), b"\x17\x5a\0\0"
        self.assertIn(size, whole)
        Path("heights.h5").write_bytes(whole.replace(size, b"\0\0\0\0", 1))
        said = self.run_program("solve", "map.toml", "--set", 'upper.file="heights.h5"', code=2)
        self.assertRegex(said, "heights.h5: .*(does not survive|is no dataset)")

    @unittest.skipIf(h5py is None, "without h5py")
    def test_a_wrong_column_of_hdf5_is_named(self):
        self.good("columns.h5")
        with h5py.File("columns.h5", "a") as file:
            file["pressure"][3] = math.nan
        self.refused("columns.h5", "NaN", ("pressure", "allowed: a finite number"))
        with h5py.File("columns.h5", "a") as file:
            del file["pressure"]
        self.refused("columns.h5", "no pressure", ("pressure", "no such dataset"))

    def test_what_is_nested_without_end_is_refused(self):
        """A value deep in brackets or in tables, which recursion would follow until the stack ends."""
        for levels in (201, 40000, 500000):
            for name, text in (("result.json", '{"twist_error": 0.5, "x": ' + levels * "[" + levels * "]" + "}"),
                               ("result.json", levels * '{"twist_error":' + "1" + levels * "}"),
                               ("loop.json", changed(JSON_LOOP, "[0,", "[" + levels * "[" + levels * "]" + ",")),
                               ("timings.json", changed(TIMINGS, '"num_cpus": 2', levels * '"a": {' + levels * "}"))):
                if name in READERS:
                    self.write(name, text)
                    self.refused(name, levels, ("more than 200 deep",))
        self.write("result.json", '{"twist_error": 0.5, "x": ' + 199 * "[" + 199 * "]" + "}")
        self.assertEqual(self.ends("result.json")[0], 0)

    def test_many_keys_cost_no_more_than_many_numbers(self):
        """In processor time: work that grew like the square of this number would take a minute."""
        self.write("result.json", json.dumps({**{f"k{i}": i for i in range(300000)}, "twist_error": 0.5}))
        before = os.times()
        self.assertEqual(self.ends("result.json")[0], 0)
        after = os.times()
        self.assertLess(after.children_user - before.children_user, 15)

    def test_what_is_no_key_may_be_long(self):
        for text in (f"# {5000 * '.'}{100 * ' 0.5'}\n", 2 * f"# {40 * '{'} a = {{\n"):
            self.write("scene.toml", text + SHORT_SCENE)
            self.run_program("solve", "scene.toml", "--plan")

    def test_tables_in_an_override_are_counted_too(self):
        self.write("scene.toml", SHORT_SCENE)
        for key in (LONG_KEY, 60000 * "a." + "a"):
            self.run_program("solve", "scene.toml", "--set", f"{key}=1", code=2, says="a key of 1 to 32 parts")
            for value in (f"{{{key}=1}}", f"[{{{key}=1}}]", f"1\n{key}=1", "".join(f"{{{'.'.join(31 * 'a')}=" for _ in
                                                                                   range(200)) + 200 * "}"):
                said = self.run_program("solve", "scene.toml", "--set", f"grid.cells={value}", code=2, says=LONG)
                self.assertLess(len(said), 4000)

    def test_dots_in_a_string_are_no_parts_of_a_key(self):
        name = " ".join(f"{i}.{i}" for i in range(1, 40))
        for text in (f'"{name}"', f"'{name}'", f'"\\"{name}\\""', f'"""{name}"""', f"'''{name}\''''"):
            self.write("scene.toml", f"name = {text}  # {name}\n{SHORT_SCENE}")
            self.run_program("solve", "scene.toml", "--plan")
            self.run_program("solve", "scene.toml", "--plan", "--set", f"name={text}")
            self.write("scene.toml", f"name = {text}\n{'.'.join(33 * 'a')} = 1\n{SHORT_SCENE}")
            self.run_program("solve", "scene.toml", code=2, says=("scene.toml:2", LONG))

    def test_no_text_reaches_the_terminal_as_commands(self):
        """A terminal executes text after an escape character."""
        self.write("scene.toml", changed(SHORT_SCENE, '"sphere"', '"\\u001b]0;title\\u0007"'))
        said = self.run_program("solve", "scene.toml", code=2, says="\\x1b]0;title")
        self.assertNotIn("\x1b", said)
        self.assertNotIn("\x07", said)
