"""Small mistakes by rule: all mutations of a source, and a C++ source with many of them behind switches.

The rules work on characters. In the layout of clang-format, as in the usual one of Python, a binary operator has blanks on both
sides, and a sign has none after it. A mutation that is not valid C++ does not compile and is dropped then."""

import re
from dataclasses import dataclass

SWITCH = "::slipstick::mutation::"
BRACKETS = {"(": ")", "[": "]", "{": "}"}
# Precedence of operators. An operator that is not listed ends an operand.
LEVELS = {"||": 1, "or": 1, "&&": 2, "and": 2, "==": 3, "!=": 3, "<": 4, "<=": 4, ">": 4, ">=": 4, "is": 4,
          "is not": 4, "<<": 5, ">>": 5,
          "+": 6, "-": 6, "*": 7, "/": 7, "%": 7}
SIGN_LEVEL = 8
OPERATOR = r"(?:\|\||&&|<<|>>|[-+*/%=!<>]=|[-+*/%<>=?:]|(?:or|and|if|else|in|is|for|return|not|lambda)\b)"
COMPARED = {"<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<")}  # another boundary; the opposite
SWAPPED = {"+": "-", "-": "+", "*": "/", "/": "*", "==": "!=", "!=": "==",
           "is": "is not", "is not": "is"}
# Declarations that the compiler computes, and labels.
EXCLUDED_CPP = re.compile(r"\b(constexpr|consteval|static_assert|case|template|using|enum|typedef|concept)\b")


@dataclass(frozen=True)
class Mutation:
    """One mistake: characters from `start` to `end` become `shown`. Characters from `first` to `last` are the expression, or the
    statement, that holds them."""
    rule: str
    start: int
    end: int
    shown: str
    first: int
    last: int


def code_of(text, is_python):
    """The source with quotes instead of texts, blanks instead of comments and preprocessor lines. In Python a semicolon
    replaces the end of a line that ends a statement, and the colon before it."""
    if is_python:
        texts, comments = r'[rbfRBF]*(?:"""(?:.*?)"""|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\')', r"#[^\n]*"
    else:
        texts = r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\''
        comments = r"//[^\n]*|/\*.*?\*/|^[ \t]*#(?:\\\n|[^\n])*"

    def covered(match):
        return re.sub(r"[^\n]", " " if match.group().lstrip()[0] in "/#" else '"', match.group())

    code = re.sub(f"{texts}|{comments}", covered, text, flags=re.DOTALL | re.MULTILINE)
    if not is_python:
        return code
    depth, ended = 0, []
    for each in code:
        depth += (each in "([{") - (each in ")]}")
        ended.append(";" if each == "\n" and depth == 0 else each)
    return re.sub(r":(\s*;)", r";\1", "".join(ended))


def partner(code, at, step=1):
    """The bracket that closes the one at `at`, or opens it if step is -1."""
    depth = 0
    while 0 <= at < len(code):
        depth += (code[at] in "([{") - (code[at] in ")]}")
        if depth == 0:
            break
        at += step
    return at


def operand_before(code, at, level):
    """Begin of the left operand of the operator of precedence `level` behind `at`."""
    end = at
    while at > 0 and code[at - 1] not in "([{,;" and code[at - 2:at] != "}\n":
        stop = re.search(rf"(?:^|\s)({OPERATOR})\s+$", code[max(0, at - 12):at])
        if stop and LEVELS.get(stop.group(1), 0) < level:
            break
        at = partner(code, at - 1, -1) if code[at - 1] in ")]}" else at - 1
    return at + len(code[at:end]) - len(code[at:end].lstrip())


def operand_after(code, at, level):
    """End of the right operand that begins at `at`."""
    first = at
    while at < len(code) and code[at] not in ")]},;":
        stop = re.match(rf"\s+({OPERATOR})(?=\s)", code[at:at + 120])
        if stop and LEVELS.get(stop.group(1), 0) <= level:
            break
        at = partner(code, at) + 1 if code[at] in BRACKETS else at + 1
    return first + len(code[first:at].rstrip())


def operators(code):
    for match in re.finditer(r"(?<=[^\s,(=])\s(<=|>=|==|!=|is not|is|[-+*/<>])\s+(?=[^\s=])", code):
        sign, level = match.group(1), LEVELS[match.group(1)]
        first, last = operand_before(code, match.start(), level), operand_after(code, match.end(), level)
        for rule, other in zip(("boundary", "comparison"), COMPARED.get(sign, ())):
            yield Mutation(rule, *match.span(1), other, first, last)
        if sign in "+-*/" and '"' in (code[match.start() - 1], code[match.end()]):
            continue  # texts
        if sign in SWAPPED:
            yield Mutation("arithmetic" if sign in "+-*/" else "comparison", *match.span(1), SWAPPED[sign], first, last)
        if sign in "+-":
            yield Mutation("term", match.start(), last, "", first, last)


def conditions(code):
    """Each term of `a && b` becomes true, each of `a || b` false: as if it were not there."""
    for match in re.finditer(r"\s(&&|\|\||and|or)\s+", code):
        word, level = match.group(1), LEVELS[match.group(1)]
        shown = {"and": "True", "or": "False", "&&": "true", "||": "false"}[word]
        # The left operand of a && b && c is a && b: its own terms come with its own operator.
        left = operand_before(code, match.start(), level + 1)
        terms = [(match.end(), operand_after(code, match.end(), level))]
        if not re.search(rf"\s{re.escape(word)}\s+$", code[:left]):
            terms.append((left, match.start()))
        yield from (Mutation("condition", *term, shown, *term) for term in terms)


def signs(code):
    before = ("[(\\[{]", "[,=?:+*/<>-] ", "return ", "&& ", "\\|\\| ", "and ", "or ", "if ")
    for match in re.finditer("(?:" + "|".join(f"(?<={each})" for each in before) + r")(?:[-!]|not )(?=[\w(])", code):
        yield Mutation("sign", *match.span(), "", match.start(), operand_after(code, match.end(), SIGN_LEVEL))


def literals(code):
    for match in re.finditer(r"(?<![\w.'])(?:\d[\d']*\.?\d*(?:[eE][-+]?\d+)?|true|false|True|False)(?![\w.'])", code):
        literal, rule = match.group(), "constant"
        if code[match.start() - 1] == "[" and code[match.end()] == "]" and literal in "01":
            rule, shown = "index", str(1 - int(literal))
        elif literal.isalpha():
            shown = {"true": "false", "false": "true", "True": "False", "False": "True"}[literal]
        elif re.fullmatch(r"[\d']+", literal):
            shown = str(int(literal.replace("'", "")) + 1)
        else:
            shown = repr(2 * float(literal.replace("'", "")) or 1.0)
        yield Mutation(rule, *match.span(), shown, *match.span())


def coordinates(code):
    """x1 for x2, and similar exchanges."""
    for match in re.finditer(r"(?<![\w.>)\]])[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*\.[xnhq]([12])(?![\w(])", code):
        yield Mutation("index", *match.span(1), str(3 - int(match.group(1))), *match.span())


def extremes(code):
    for match in re.finditer(r"(?<![\w.])(?:std::)?(min|max)(?=\()", code):
        other = "max" if match.group(1) == "min" else "min"
        yield Mutation("extreme", *match.span(1), other, match.start(), partner(code, match.end()) + 1)


def statements(code, is_python):
    """An assignment or a call is dropped."""
    keywords = "return|if|for|while|switch|do|else|throw|delete|new|break|continue|private|public|assert|raise|yield"
    assigned = "[-+*/|&]= " if is_python else "[-+*/|&]?= "  # a Python name that is not set ends the program
    for match in re.finditer(rf"(?<=[;{{}}])\s+(?!(?:{keywords})\b)(?=([\w.:>\[\]-]+(?: {assigned}|\())(?!\s))", code):
        end = start = match.end()
        while end < len(code) and code[end] not in ";{}":
            end = partner(code, end) + 1 if code[end] in "([" else end + 1
        if code[end:end + 1] == ";":
            yield Mutation("statement", start, end, "pass" if is_python else "", start, end)


RULES = (operators, conditions, signs, literals, coordinates, extremes)


def excluded_cpp(code):
    """(first, last) of constant expressions, labels, and text in angle brackets."""
    for match in re.finditer(r"(?<=\w)<(?:[^<>;(){}]|<(?:[^<>;(){}]|<[^<>;(){}]*>)*>)*>", code):
        yield match.span()
    for match in EXCLUDED_CPP.finditer(code):
        word, at = match.group(), match.end()
        if word == "template":
            yield match.start(), code.find("\n", at)
        elif code[:match.start()].endswith("if "):
            yield match.start(), partner(code, code.index("(", at))
        elif word == "case":
            yield match.start(), re.compile(r"(?<!:):(?!:)").search(code, at).start()
        else:
            while at < len(code) and code[at] != ";":
                if code[at] in BRACKETS:
                    is_body = code[at] == "{"
                    at = partner(code, at)
                    if is_body and code[at + 1:at + 2] == "\n":
                        break
                at += 1
            yield match.start(), at


def excluded_python(code):
    """(first, last) of text outside of functions, and of signatures."""
    for match in re.finditer(r"(?:^|;)(?:[^\s;]|\s*(?:def|class)\s)[^;]*", code):
        yield match.span()


def is_size(code, at):
    """Whether `at` stands among the arguments of a call or in a table of a Python source. The numbers there are mostly sizes
    and positions in a drawing."""
    depth = 0
    for i in range(at - 1, -1, -1):
        depth += (code[i] in ")]}") - (code[i] in "([{")
        if depth < 0:
            return code[i] == "{" or re.search(r"[\w\])]\($", code[:i + 1]) is not None
        if code[i] == ";":
            break
    return False


def proposals(text, is_python=False):
    """All mutations of a source, in its order."""
    code = code_of(text, is_python)
    excluded = list(excluded_python(code) if is_python else excluded_cpp(code))
    found = [each for rule in RULES for each in rule(code)] + list(statements(code, is_python))
    return sorted((each for each in found if not any(first <= each.start < last for first, last in excluded)
                   and not (is_python and each.rule == "constant" and is_size(code, each.start))),
                  key=lambda each: (each.start, each.rule))


def overlaps(mutation, others):
    return any(mutation.first < each.last and each.first < mutation.last for each in others)


def mutated(text, mutation):
    return text[:mutation.start] + mutation.shown + text[mutation.end:]


def with_all(text, numbered):
    """The C++ source that holds the mutants, on as many lines: `numbered` are (number, mutation), none over another."""
    # Without comments: a mutated expression stands on one line.
    bare = "".join(" " if c == " " else t for t, c in zip(text, code_of(text, False)))
    for number, each in sorted(numbered, key=lambda pair: -pair[1].first):
        first, last = each.first, each.last
        if each.rule == "statement":
            text = f"{text[:first]}if (!{SWITCH}on({number})) {text[first:]}"
            continue
        # Between numbers that are not whole `<` and `<=` differ nowhere.
        whole = f"static_assert(std::integral<std::decay_t<decltype({bare[first:each.start]})>>);"
        changed = f"return {SWITCH}plain({bare[first:each.start]}{each.shown}{bare[each.end:last]});"
        changed = " ".join(f"{whole if each.rule == 'boundary' else ''} {changed}".split())
        text = (f"{text[:first]}{SWITCH}choose({number}, [&] {{ {changed} }}, "
                f"[&] {{ return {SWITCH}plain({text[first:last]}); }}){text[last:]}")
    return text


def lines(text, mutation):
    """The line's number, its text before and after."""
    first = text.rfind("\n", 0, mutation.start) + 1
    last = text.find("\n", mutation.end)
    last = len(text) if last < 0 else last
    before = " ".join(text[first:last].split())
    after = " ".join((text[first:mutation.start] + mutation.shown + text[mutation.end:last]).split())
    return text.count("\n", 0, mutation.start) + 1, before, after
