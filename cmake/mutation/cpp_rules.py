"""Which small mistakes a C++ source could hold, by rule, and the source with all of them behind a switch.

Works on characters: in clang-format's layout an operator between two operands has blanks on both sides, a sign has none
behind it. What this mistakes for an operand does not compile and is dropped then."""

import re
from dataclasses import dataclass

SWITCH = "::slipstick::mutation::"
EXCLUDED = re.compile(r"\b(constexpr|consteval|static_assert|case|template|using|enum|typedef|concept)\b")
BRACKETS = {"(": ")", "[": "]", "{": "}"}


@dataclass(frozen=True)
class Mutation:
    """One mistake: at `start`, characters up to `end` become `shown`; in the source that holds all mutants, each of
    `edits` (start, end, text, with {n} for the mutant's number) is made instead."""
    rule: str
    start: int
    end: int
    shown: str
    edits: tuple


def code_of(text):
    """The source with quotes in the place of texts and characters, blanks in that of comments and preprocessor lines."""
    texts = r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\''
    comments = r"//[^\n]*|/\*.*?\*/|^[ \t]*#(?:\\\n|[^\n])*"

    def covered(match):
        return re.sub(r"[^\n]", " " if match.group().lstrip()[0] in "/#" else '"', match.group())

    return re.sub(f"{texts}|{comments}", covered, text, flags=re.DOTALL | re.MULTILINE)


def closing(code, opening):
    """Where the bracket at `opening` is closed."""
    depth = 0
    for at in range(opening, len(code)):
        if code[at] in "([{":
            depth += 1
        elif code[at] in ")]}":
            depth -= 1
            if depth == 0:
                return at
    return len(code)


def excluded_ranges(code):
    """Declarations that the compiler computes, labels, and what stands in angle brackets."""
    for match in re.finditer(r"(?<=\w)<(?:[^<>;(){}]|<(?:[^<>;(){}]|<[^<>;(){}]*>)*>)*>", code):
        yield match.span()
    for match in EXCLUDED.finditer(code):
        word, at = match.group(), match.end()
        if word == "template":
            yield match.start(), code.find("\n", at)
        elif code[:match.start()].endswith("if "):
            yield match.start(), closing(code, code.index("(", at))
        elif word == "case":
            yield match.start(), re.compile(r"(?<!:):(?!:)").search(code, at).start()
        else:
            while at < len(code) and code[at] != ";":
                if code[at] in BRACKETS:
                    body = code[at] == "{"
                    at = closing(code, at)
                    if body and code[at + 1:at + 2] == "\n":
                        break
                at += 1
            yield match.start(), at


def left_bound(code, at):
    """Where the operand of && or || begins that ends at `at`."""
    while at > 0:
        at -= 1
        if code[at] in ")]}":
            depth = 0
            while at >= 0:
                depth += (code[at] in ")]}") - (code[at] in "([{")
                if depth == 0:
                    break
                at -= 1
        elif (code[at] in "([{,;?" or code[at] == ":" and ":" not in (code[at - 1], code[at + 1])
              or code[at - 1:at + 1] in ("&&", "||") or code[at - 1:at + 2] == " = " or code[at - 6:at + 1] == "return "):
            at += 1
            break
    return at + len(code[at:]) - len(code[at:].lstrip())


def right_bound(code, at):
    """Where the operand of && or || ends that begins at `at`."""
    begin = at
    while at < len(code):
        if code[at] in BRACKETS:
            at = closing(code, at)
        elif (code[at] in ")]},;?" or code[at] == ":" and ":" not in (code[at - 1], code[at + 1])
              or code[at:at + 2] in ("&&", "||")):
            break
        at += 1
    return begin + len(code[begin:at].rstrip())


def whole(rule, match, shown, text, group=0):
    start, end = match.span(group)
    return Mutation(rule, start, end, shown, ((start, end, text),))


# Each operator with its name, the one whose boundary differs, and the opposite.
COMPARED = {"<": ("less", "<=", "less_equal", ">=", "greater_equal"),
            "<=": ("less_equal", "<", "less", ">", "greater"),
            ">": ("greater", ">=", "greater_equal", "<=", "less_equal"),
            ">=": ("greater_equal", ">", "greater", "<", "less")}
SWAPPED = {"+": ("plus", "-", "minus"), "-": ("minus", "+", "plus"), "*": ("multiplies", "/", "divides"),
           "/": ("divides", "*", "multiplies"), "==": ("equal_to", "!=", "not_equal_to"),
           "!=": ("not_equal_to", "==", "equal_to")}


def between(rule, match, original, shown, mutated):
    sign = match.group(1)
    text = f"{sign} {SWITCH}Operator<std::{original}<>, {mutated}>{{{{{{n}}}}}} {sign}"
    return whole(rule, match, shown, text, 1)


def operators(code):
    for match in re.finditer(r"(?<=[^\s,(=]) (<=|>=|==|!=|[-+*/<>])(?=\s)", code):
        sign = match.group(1)
        if sign in COMPARED:
            original, near, near_name, far, far_name = COMPARED[sign]
            yield between("boundary", match, original, near, f"{SWITCH}OfWhole<std::{near_name}<>>")
            yield between("comparison", match, original, far, f"std::{far_name}<>")
        else:
            original, other, name = SWAPPED[sign]
            yield between("comparison" if "=" in sign else "arithmetic", match, original, other, f"std::{name}<>")
        if sign in "+-":
            end = right_bound_of_term(code, match.end() + 1)
            edit = between("term", match, original, "", f"{SWITCH}First").edits
            yield Mutation("term", match.start(), end, "", edit)


def right_bound_of_term(code, at):
    """Where the term that begins at `at` ends; for show only."""
    begin = at
    while at < len(code):
        if code[at] in BRACKETS:
            at = closing(code, at)
        elif code[at] in ")]},;?" or re.match(r" (?:[-+<>]|<=|>=|==|!=|&&|\|\||:)\s", code[at:at + 4]):
            break
        at += 1
    return begin + len(code[begin:at].rstrip())


def conditions(code):
    """Each term of `a && b` becomes true, each of `a || b` false: as if it were not there."""
    for match in re.finditer(r" (&&|\|\|)(?=\s)", code):
        sign = match.group(1)
        opened, shown = ("({s}on({{n}}) || ", "true") if sign == "&&" else ("(!{s}on({{n}}) && ", "false")
        opened = opened.format(s=SWITCH)
        first, end = left_bound(code, match.start()), match.start()
        if code[:first].rstrip()[-2:] not in ("&&", "||"):
            yield Mutation("condition", first, end, shown, ((first, first, opened), (end, end, ")")))
        second = re.compile(r"\S").search(code, match.end()).start()
        end = right_bound(code, second)
        yield Mutation("condition", second, end, shown, ((second, second, opened), (end, end, ")")))


def signs(code):
    before = ("[(\\[{]", "[,=?:+*/<>-] ", "return ", "&& ", "\\|\\| ")
    for match in re.finditer("(?:" + "|".join(f"(?<={each})" for each in before) + r")[-!](?=[\w(])", code):
        name = {"-": "minus", "!": "negation"}[match.group()]
        yield whole("sign", match, "", f"{SWITCH}{name}{{{{{{n}}}}}}->*")


def literals(code):
    for match in re.finditer(r"(?<![\w.'])(?:\d[\d']*\.?\d*(?:[eE][-+]?\d+)?|true|false)(?![\w.'])", code):
        literal = match.group()
        if code[match.start() - 1] == "[" and code[match.end()] == "]" and literal in "01":
            other = str(1 - int(literal))
            yield whole("index", match, other, f"{SWITCH}index({{n}}, {literal})")
            continue
        if literal in ("true", "false"):
            shown = "false" if literal == "true" else "true"
        elif re.fullmatch(r"[\d']+", literal):
            shown = str(int(literal.replace("'", "")) + 1)
        else:
            shown = repr(2 * float(literal.replace("'", "")) or 1.0)
        yield whole("constant", match, shown, f"{SWITCH}constant({{n}}, {literal})")


def coordinates(code):
    """x1 for x2 and the like."""
    for match in re.finditer(r"(?<![\w.>)\]])([A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*\.)([xnhq])([12])(?![\w(])", code):
        owner, letter, digit = match.groups()
        other = f"{owner}{letter}{3 - int(digit)}"
        yield whole("index", match, other, f"({SWITCH}on({{n}}) ? {other} : {match.group()})")


def extremes(code):
    for match in re.finditer(r"\bstd::(min|max)(?=\()", code):
        other = "max" if match.group(1) == "min" else "min"
        yield whole("extreme", match, f"std::{other}",
                    f"{SWITCH}Extreme<{str(other == 'max').lower()}>{{{{{{n}}}}}}")


def statements(code):
    """An assignment or a call that is left out."""
    for match in re.finditer(r"(?<=[;{}])\s*\n\s*(?=([\w.:>\[\]-]+(?: [-+*/|&]?= |\())(?!\s))", code):
        start = match.end()
        if re.match(r"(return|if|for|while|switch|do|else|throw|delete|new|break|continue|private|public)\b", code[start:]):
            continue
        end = start
        while end < len(code) and code[end] not in ";{}":
            end = closing(code, end) if code[end] in "([" else end
            end += 1
        if code[end:end + 1] == ";":
            yield Mutation("statement", start, end, "", ((start, start, f"if (!{SWITCH}on({{n}})) "),))


RULES = (operators, conditions, signs, literals, coordinates, extremes, statements)


def proposals(text):
    """All mutations of a source, in its order."""
    code = code_of(text)
    excluded = list(excluded_ranges(code))
    found = [mutation for rule in RULES for mutation in rule(code)]
    return sorted((each for each in found
                   if not any(first <= start < last for first, last in excluded for start, _, _ in each.edits)),
                  key=lambda each: (each.start, each.rule))


def overlaps(mutation, others):
    """Whether two edits take the same place; one within another's term is no matter."""
    taken = {at for other in others for at, _, _ in other.edits}
    return any(start in taken for start, _, _ in mutation.edits) or any(
        start < at < end for start, end, _ in mutation.edits for at in taken) or any(
        first < start < last for start, _, _ in mutation.edits for other in others for first, last, _ in other.edits)


def with_all(text, numbered):
    """The source that holds the mutants: `numbered` are (number, mutation)."""
    edits = sorted(((start, end, new.format(n=number)) for number, mutation in numbered
                    for start, end, new in mutation.edits), reverse=True)
    for start, end, new in edits:
        text = text[:start] + new + text[end:]
    return text


def lines(text, mutation):
    """The line's number, its text before and after."""
    first = text.rfind("\n", 0, mutation.start) + 1
    last = text.find("\n", mutation.end)
    last = len(text) if last < 0 else last
    before = " ".join(text[first:last].split())
    after = " ".join((text[first:mutation.start] + mutation.shown + text[mutation.end:last]).split())
    return text.count("\n", 0, mutation.start) + 1, before, after
