"""The rules that make mutants: each applies in made-up sources where it should, and nowhere else."""

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

MUTATION = Path(__file__).resolve().parents[1] / "mutation"
SWITCH = MUTATION / "switch.hpp"
sys.path.insert(0, str(MUTATION))

import rules  # noqa: E402


def mutants(line, rule, head, tail, is_python):
    """The mutations of a function's line by one rule."""
    text = head + line + tail
    return {rules.mutated(text, each)[len(head):-len(tail)] for each in rules.proposals(text, is_python) if each.rule == rule}


def cpp(line, rule):
    return mutants(line, rule, "void f() {\n  ", "\n}\n", False)


def python(line, rule):
    return mutants(line, rule, "def f(a, b):\n    ", "\n", True)


class Cpp(unittest.TestCase):
    def test_a_comparison_is_turned_round_or_moved_by_its_boundary(self):
        self.assertEqual(cpp("if (a < b) g();", "comparison"), {"if (a >= b) g();"})
        self.assertEqual(cpp("if (a < b) g();", "boundary"), {"if (a <= b) g();"})
        self.assertEqual(cpp("if (a == b) g();", "comparison"), {"if (a != b) g();"})

    def test_arithmetic_changes_its_operator_or_loses_its_second_term(self):
        self.assertEqual(cpp("x = a * b + c;", "arithmetic"), {"x = a / b + c;", "x = a * b - c;"})
        self.assertEqual(cpp("x = f(a - b(c, d) * e) + g;", "term"), {"x = f(a) + g;", "x = f(a - b(c, d) * e);"})

    def test_each_term_of_a_condition_is_dropped(self):
        self.assertEqual(cpp("if (a && b(c, d) && !e) g();", "condition"),
                         {"if (true && b(c, d) && !e) g();", "if (a && true && !e) g();", "if (a && b(c, d) && true) g();"})
        self.assertEqual(cpp("const bool x = a || (b && c);", "condition"),
                         {"const bool x = false || (b && c);", "const bool x = a || false;",
                          "const bool x = a || (true && c);", "const bool x = a || (b && true);"})
        self.assertEqual(cpp("return f(a) == \"b\" && c[0] == 'd';", "condition"),
                         {"return true && c[0] == 'd';", 'return f(a) == "b" && true;'})

    def test_a_sign_is_lost(self):
        self.assertEqual(cpp("return -a - !b;", "sign"), {"return a - !b;", "return -a - b;"})
        self.assertEqual(cpp("if (!b) g(-a);", "sign"), {"if (b) g(-a);", "if (!b) g(a);"})

    def test_a_constant_grows_and_an_index_becomes_the_other(self):
        line = "x = 0.5 * a[0] + 3 * b.x1;"
        self.assertEqual(cpp(line, "constant"), {"x = 1.0 * a[0] + 3 * b.x1;", "x = 0.5 * a[0] + 4 * b.x1;"})
        self.assertEqual(cpp(line, "index"), {"x = 0.5 * a[1] + 3 * b.x1;", "x = 0.5 * a[0] + 3 * b.x2;"})
        self.assertEqual(cpp("x = 0.0; y = true;", "constant"), {"x = 1.0; y = true;", "x = 0.0; y = false;"})

    def test_a_minimum_becomes_a_maximum_and_a_statement_is_dropped(self):
        self.assertEqual(cpp("return std::min(a, b);", "extreme"), {"return std::max(a, b);"})
        self.assertEqual(cpp("g(a);\n  x += h({1, 2});\n  int y = 3;\n  return y;", "statement"),
                         {";\n  x += h({1, 2});\n  int y = 3;\n  return y;", "g(a);\n  ;\n  int y = 3;\n  return y;"})

    def test_texts_comments_types_and_what_the_compiler_computes_are_left_alone(self):
        for line in ('log("a < b + 1 && !c");', "g();  // a < b + 1", "/* a < b\n  c - 1 */ g();",
                     "constexpr int x = 2 + 3;", "static_assert(2 + 2 == 4 && a);", "case 3:",
                     "std::array<double, 3> x;", "using T = A<B<2>, 4>;",
                     'log(R"(a < b + 1)");', "log('1');", "enum E { kOne = 1, kTwo = 2 };", "T* x; U& y; V&& z;"):
            with self.subTest(line):
                self.assertEqual({each.shown for each in rules.proposals(f"void f() {{\n  {line}\n}}\n")
                                  if each.rule != "statement"}, set())
        self.assertEqual(rules.proposals("#if A > 1 && B\n#define C \\\n  1 + 2\n#endif\n"), [])
        self.assertEqual(rules.proposals("constexpr int f(int a) {\n  return a + 1;\n}\n"), [])

    def test_what_follows_is_not_left_alone(self):
        self.assertEqual(cpp("if constexpr (k > 1) x = a * b;", "arithmetic"), {"if constexpr (k > 1) x = a / b;"})
        text = "template <int n = 1>\nint f(int a) {\n  return a * n;\n}\n"
        self.assertEqual([each.shown for each in rules.proposals(text)], ["/"])

    def test_all_mutants_stand_behind_switches_in_one_source_of_as_many_lines(self):
        text = "bool f() {\n  return a < 2 &&\n         -b + c > 0.5;\n}\n"
        taken = []
        for each in rules.proposals(text):
            if not rules.overlaps(each, taken):
                taken.append(each)
        mutated = rules.with_all(text, list(enumerate(taken, 1)))
        self.assertEqual(mutated.count("\n"), text.count("\n"))
        for number in range(1, len(taken) + 1):
            self.assertIn(f"choose({number}, ", mutated)
        self.assertEqual(rules.with_all(text, []), text)


class Switch(unittest.TestCase):
    SOURCE = """#include <algorithm>
#include <cstdio>
int main(int a, char**) {
  std::printf("%d ", a < 1);
  std::printf("%d ", a == 1);
  std::printf("%d ", a *  // thrice
                         3);
  std::printf("%d ", std::min(a, 7));
  std::printf("%g", 0.5);
}
"""
    # Output of the program, started without arguments, after this replacement.
    WRITTEN = {"": "0 1 3 1 0.5", "<=": "1 1 3 1 0.5", "!=": "0 0 3 1 0.5", "/": "0 1 0 1 0.5", "max": "0 1 3 7 0.5",
               "1.0": "0 1 3 1 1"}

    @unittest.skipUnless(shutil.which("c++"), "no compiler")
    def test_one_program_does_what_each_mutant_would(self):
        chosen = [each for each in rules.proposals(self.SOURCE) if each.shown and each.shown in self.WRITTEN]
        self.assertEqual({each.shown for each in chosen} | {""}, set(self.WRITTEN))
        with tempfile.TemporaryDirectory() as folder:
            source, program, reached = (Path(folder, name) for name in ("mutated.cpp", "program", "reached"))
            source.write_text(f'#include "{SWITCH}"\n' + rules.with_all(self.SOURCE, list(enumerate(chosen, 1))))
            subprocess.run(["c++", "-std=c++20", source, "-o", program], check=True)
            for number, shown in enumerate([""] + [each.shown for each in chosen]):
                run = subprocess.run([program], capture_output=True, text=True, env={"SLIPSTICK_MUTANT": str(number)})
                self.assertEqual(run.stdout, self.WRITTEN[shown], shown)
            reached.write_bytes(bytes(len(chosen) + 1))
            subprocess.run([program], capture_output=True, env={"SLIPSTICK_REACHED": str(reached)})
            self.assertEqual(list(reached.read_bytes()), [0] + [1] * len(chosen))


class Python(unittest.TestCase):
    def test_each_rule_applies(self):
        self.assertEqual(python("return a < b", "comparison"), {"return a >= b"})
        self.assertEqual(python("return a < b", "boundary"), {"return a <= b"})
        self.assertEqual(python("return a + b", "arithmetic"), {"return a - b"})
        self.assertEqual(python("x = a + b\n    y = a", "term"), {"x = a\n    y = a"})
        self.assertEqual(python("return a and b", "condition"), {"return True and b", "return a and True"})
        self.assertEqual(python("if a < 1 or b:\n        pass", "condition"),
                         {"if False or b:\n        pass", "if a < 1 or False:\n        pass"})
        self.assertEqual(python("return not a", "sign"), {"return a"})
        self.assertEqual(python("return 2.0 * a", "constant"), {"return 4.0 * a"})
        self.assertEqual(python("return a[0]", "index"), {"return a[1]"})
        self.assertEqual(python("return min(a, b)", "extreme"), {"return max(a, b)"})
        self.assertEqual(python("a.append(b)\n    a += b", "statement"), {"pass\n    a += b", "a.append(b)\n    pass"})

    def test_texts_and_what_is_drawn_with_are_left_alone(self):
        for text in ('"""Two < 3."""\n', "SIZE = 3.5\n", "def f(a, b=2):\n    return a\n",
                     "def f(a):\n    return f'{a + 1:.3f}'\n", "def f(a):\n    return {'width': 2}\n",
                     "def f(a) -> 'b':\n    return draw(a, 3, linewidth=0.5)\n"):
            self.assertEqual(rules.proposals(text, True), [], text)


if __name__ == "__main__":
    unittest.main()
