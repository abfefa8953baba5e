"""Runs the cells of every notebook in docs/notebooks, in their order and in one namespace. Their assertions hold, and
each notebook is valid in format 4. (Jupyter is not needed.)"""
import ast
import json
import pathlib
import unittest

FOLDER = pathlib.Path(__file__).parents[3] / "docs/notebooks"


def show(value):
    """As Jupyter shows the last value of a cell."""
    text = value._repr_html_() if hasattr(value, "_repr_html_") else repr(value)
    assert isinstance(text, str) and text
    print(text[:200])


def run_cell(code, namespace, name):
    tree = ast.parse(code, name)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, name, "exec"), namespace)
    if last is not None:
        value = eval(compile(ast.Expression(last.value), name, "eval"), namespace)
        if value is not None:
            show(value)


class NotebookTest(unittest.TestCase):
    def test_cells(self):
        notebooks = sorted(FOLDER.glob("*.ipynb"))
        self.assertTrue(notebooks)
        for file in notebooks:
            notebook = json.loads(file.read_text())
            self.assertEqual(notebook["nbformat"], 4)
            namespace = {"__name__": "__main__"}
            for number, cell in enumerate(notebook["cells"]):
                self.assertEqual(cell.get("outputs", []), [], "outputs are not kept")
                if cell["cell_type"] == "code":
                    run_cell("".join(cell["source"]), namespace, f"{file.name}, cell {number}")
