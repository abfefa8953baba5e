"""Which small mistakes a Python source could hold, by rule; each in a source of its own.

Numbers in arguments, in tables of constants and in texts are left alone: there they are mostly sizes and places of what is
drawn."""

import ast
import copy

from cpp_rules import Mutation

COMPARED = {ast.Lt: (ast.LtE, ast.GtE), ast.LtE: (ast.Lt, ast.Gt), ast.Gt: (ast.GtE, ast.LtE), ast.GtE: (ast.Gt, ast.Lt),
            ast.Eq: (ast.NotEq,), ast.NotEq: (ast.Eq,), ast.Is: (ast.IsNot,), ast.IsNot: (ast.Is,), ast.In: (ast.NotIn,),
            ast.NotIn: (ast.In,)}
SWAPPED = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}


def changed(node, **fields):
    node = copy.copy(node)
    for name, value in fields.items():
        setattr(node, name, value)
    return node


def comparisons(node):
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        for rule, other in zip(("boundary", "comparison")[-len(COMPARED[type(node.ops[0])]):], COMPARED[type(node.ops[0])]):
            yield rule, changed(node, ops=[other()])


def is_text(node):
    return isinstance(node, ast.JoinedStr) or isinstance(node, ast.Constant) and isinstance(node.value, str)


def arithmetic(node):
    if isinstance(node, ast.BinOp) and type(node.op) in SWAPPED and not is_text(node.left) and not is_text(node.right):
        yield "arithmetic", changed(node, op=SWAPPED[type(node.op)]())
        if isinstance(node.op, (ast.Add, ast.Sub)):
            yield "term", node.left


def conditions(node):
    if isinstance(node, ast.BoolOp):
        for i in range(len(node.values)):
            rest = node.values[:i] + node.values[i + 1:]
            yield "condition", changed(node, values=rest) if len(rest) > 1 else rest[0]


def signs(node):
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.Not)):
        yield "sign", node.operand


def constants(node):
    if isinstance(node, ast.Constant) and isinstance(node.value, (bool, int, float)):
        value = node.value
        if isinstance(value, bool):
            yield "constant", changed(node, value=not value)
        else:
            yield "constant", changed(node, value=value + 1 if isinstance(value, int) else 2 * value or 1.0)


def indices(node):
    if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant) and node.slice.value in (0, 1):
        yield "index", changed(node, slice=ast.Constant(1 - node.slice.value))


def extremes(node):
    other = {"min": "max", "max": "min"}
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in other:
        yield "extreme", changed(node, func=ast.Name(other[node.func.id]))


def statements(node):
    if isinstance(node, (ast.Expr, ast.AugAssign)) and not isinstance(node.value, ast.Constant):
        yield "statement", ast.Pass()


RULES = (comparisons, arithmetic, conditions, signs, constants, indices, extremes, statements)


def visited(node, numbers=False):
    """The nodes that are code, and whether a number there has a meaning."""
    yield node, numbers
    for name, value in ast.iter_fields(node):
        for child in value if isinstance(value, list) else [value]:
            if not isinstance(child, ast.AST) or isinstance(child, ast.JoinedStr) or name in ("annotation", "returns"):
                continue
            inside = (numbers or isinstance(node, (ast.FunctionDef, ast.Lambda))) and not isinstance(child, ast.Dict)
            yield from visited(child, inside and name not in ("args", "keywords"))


def proposals(text):
    """All mutations of a source, in its order."""
    begins, at = [], 0
    for line in text.splitlines(keepends=True):
        begins.append((at, line.encode()))
        at += len(line)

    def position(line, column):
        begin, content = begins[line - 1]
        return begin + len(content[:column].decode())

    found = []
    for node, numbers in visited(ast.parse(text)):
        for rule in RULES if numbers else [each for each in RULES if each not in (constants, indices)]:
            for name, other in rule(node):
                start, end = position(node.lineno, node.col_offset), position(node.end_lineno, node.end_col_offset)
                new = ast.unparse(ast.fix_missing_locations(other))
                new = new if isinstance(other, (ast.Pass, ast.Constant)) else f"({new})"
                found.append(Mutation(name, start, end, new, ((start, end, new),)))
    return sorted(found, key=lambda each: (each.start, each.rule))
