"""test_snippets.py SOURCE_DIR PROGRAM: every block of README.md and docs/**/*.md runs with the exit code that the page
states, and every command named in a sentence exists."""
import pathlib
import re
import resource
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from pages import line_of, pages, relative, without_blocks
from snippets import Checkout, PageRun

ROOT = pathlib.Path(sys.argv[1]).resolve()
CHECKOUT = Checkout(ROOT, pathlib.Path(sys.argv[2]).absolute(), sys.executable)


def run(text, name="page.md"):
    with tempfile.TemporaryDirectory() as folder:
        return PageRun(CHECKOUT, name, text, pathlib.Path(folder) / "checkout").run()


class PagesTest(unittest.TestCase):
    def test_every_block_runs(self):
        runs = [run(page.read_text(), relative(page, ROOT)) for page in pages(ROOT)]
        left = [line for page in runs for line in page.left]
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        print(f"{sum(page.ran for page in runs)} snippets run, {len(left)} not run:", *left, sep="\n  ")
        print(f"{used.ru_utime + used.ru_stime:.1f} s of processor time")
        problems = [problem for page in runs for problem in page.problems]
        self.assertEqual("\n".join(problems), "")

    def test_every_command_in_a_sentence_exists(self):
        problems = []
        for page in pages(ROOT):
            text = without_blocks(page.read_text())
            for span in re.finditer(r"`([^`]+)`", text):
                words = " ".join(span[1].split())
                if re.match(r"(build/)?slipstick [a-z]|make [a-z]", words):
                    problems += [f"{relative(page, ROOT)}:{line_of(text, span.start())}: {problem}"
                                 for problem in CHECKOUT.command_problems(words)]
        self.assertEqual("\n".join(problems), "")

    def test_index_has_every_command(self):
        commands = re.findall(r"^  ([a-z]+) ", CHECKOUT.help("").partition("Subcommands:")[2], re.M)
        self.assertGreater(len(commands), 10)
        index = (ROOT / "docs/index.md").read_text()
        self.assertEqual([command for command in commands if f"`{command}`" not in index], [])


class RunnerTest(unittest.TestCase):
    """Made-up pages with mistakes, which must be found."""

    def assert_found(self, text, wanted):
        self.assertIn(wanted, "\n".join(run(text).problems))

    def test_good_page(self):
        page = run("`a.json`:\n\n```json\n{}\n```\n\n<!-- exit code: 3 -->\n```sh\ntest -f a.json; exit 3\n```\n"
                   "<!-- not run: hours -->\n```sh\nmake test\n```\n```text\nno\n```\n")
        self.assertEqual((page.problems, page.ran, page.left), ([], 2, ["page.md:12: hours"]))

    def test_wrong_exit_codes(self):
        self.assert_found("```sh\nfalse; true\n```\n", "ended with 1, not 0")
        self.assert_found("<!-- exit code: 1 -->\n```sh\ntrue\n```\n", "ended with 0, not 1")
        self.assert_found("```sh\nbuild/slipstick exact --moment-ration 0.5\n```\n", "ended with 2")

    def test_commands_that_do_not_exist_though_not_run(self):
        above = "<!-- not run: hours -->\n"
        self.assert_found(above + "```sh\nmake reprot\n```\n", "make reprot: no such target")
        self.assert_found(above + "```sh\nbuild/slipstick bench --filtre x\n```\n", "bench --filtre: no such option")
        self.assert_found(above + "```sh\nbuild/slipstick sovle a.toml\n```\n", "slipstick sovle: no such command")
        self.assert_found(above + "```sh\ncat convergence/scenes/no.toml\n```\n", "convergence/scenes/no.toml: no such file")

    def test_files(self):
        self.assert_found("`a.toml`:\n\n```toml\na = 1\n```\n", "no block uses it")
        self.assert_found("`convergence/scenes/paper.toml`:\n\n```toml\na = 1\n```\n", "is a file of the project")
        self.assert_found("```toml\na = \n```\n", "ended with 1")
        self.assert_found("```toml\n[upper]\n[load]\n```\n", "ended with 2")
        self.assert_found("```json\n{\n```\n", "Expecting")

    def test_other_languages(self):
        self.assert_found("```python\nimport no_such_module\n```\n", "no_such_module")
        self.assert_found("<!-- around:\nint main(void) { @@ }\n-->\n```c\nreturn 0\n```\n", "ended with 1")
        self.assert_found("```\nwhat is this\n```\n", "neither run nor text")
        self.assert_found("- in a list\n\n  ```sh\n  true\n  ```\n", "an indented block")
