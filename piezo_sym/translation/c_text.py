"""Printed C as a tree of Python's `ast`, so that both languages have one reader of expressions.

Input: the text of a C file.  Output: its functions, tables and enumerations, as statements:

    C                                         Python
    void f(const real *x) { ... }             def f(x: "const real *") -> "void": ...
    const double a = e;    double a;          a: "const double" = e    a: "double"
    static const int t[] = { 1, 2, };         t: "static const int [ ]" = [1, 2]
    enum { a = 1, b = 2 };                    a = 1    b = 2
    for (long j = 0; j < n; ++j) { ... }      for j in lanes(n): ...
    the same behind ``#pragma omp simd``      for j in simd(n, its sums): ...
    { ... }                                   with block: ...
    f(a, b);                                  f(a, b)
    c ? a : b    a || b    p->a               (a) if (c) else (b)    a or b    p.a

Operators bind as Python's do, but for ``?`` and for comparisons of comparisons; readers refuse
these, as they do all that they do not know.  Comments are left out; of directives only the two
``#include`` lines and ``#pragma omp simd`` are in the grammar, strings and characters are not.
"""

import ast
import re
from collections.abc import Iterator, Sequence
from keyword import iskeyword

from piezo_sym.translation.field import NotShownError

_COMMENT = r"/\*(?:(?!/\*|\*/|\?\?)[^\\])*\*/"
_TOKEN = re.compile(
    rf"(?P<space>\s+|{_COMMENT})"
    r"|#pragma omp simd(?: reduction\(\+:[\w,\s\\]*\))?(?=\n)"
    r"|(?!PIEZO_SYM_)[A-Za-z]\w*"  # no macros of headers, which may stand for nothing
    r"|(?:(?:\d+\.\d*|\.\d+)(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+|\d{1,9})(?![\w.])"
    r"|(?!//)(?:->|\|\||\+\+|--|\+=|[<>=!]=|[-+*/<>=?:,;(){}\[\]\ue000-\ue0ff])",
    re.ASCII,
)
_COMPARED = re.compile(r" (?:if|or|[<>]|[<>=!]=) ")
_SPELLED = {"||": "or", "->": "."}
_HEAD = rf'\s*(?:{_COMMENT}\s*)*#include "{{model}}\.h"\s*#include <math\.h>\n\s*'
_TYPE = r"((?:(?:static|inline|const|double|real|long|int|void|\*|restrict) )+)"
_LOOP = re.compile(r"(#[^;{}]* )?for \( long (\w+) = 0 ; \2 < ([^;{}]+) ; \+\+ \2 \) {")
_DECLARED = re.compile(rf"{_TYPE}(\w+)((?: \[ \d* ?\])?)( = .*)?")
_FUNCTION = re.compile(rf"{_TYPE}(\w+) \( ([^()]+) \)")


def python_of(text: str, model: str, macros: str = "", known: Sequence[str] = ()) -> ast.Module:
    """Return a C file as Python.

    It includes the header of `model`; `macros` is the text expected after the includes; the parts
    in `known` are expected word for word and in this order: each becomes the line of its number.
    """
    head = re.match(_HEAD.replace("{model}", re.escape(model)), text)
    begins = head is not None and text.startswith(macros, head.end())
    if head is None or not begins or re.search("[\ue000-\ue0ff]", text):
        raise NotShownError("the C file should begin with two headers, and define its words")
    rest, marks = text[head.end() + len(macros) :], [chr(0xE000 + n) for n in range(len(known))]
    for mark, part in zip(marks, known, strict=True):
        if rest.count(part) != 1:
            raise NotShownError(f"the C file has no, or another, {part.strip()[:60]!r}")
        rest = rest.replace(part, f"{mark}{part.count(chr(10)) * chr(10)}")
    words, place = list[str](), 0
    while place < len(rest):
        match = _TOKEN.match(rest, place)
        if match is None or (iskeyword(match[0]) and match[0] not in {"for", "return"}):
            number = (text[: head.end()] + macros + rest[:place]).count("\n") + 1
            raise NotShownError(f"line {number} of the C file is outside the grammar")
        place = match.end()
        words += [] if match["space"] else [_SPELLED.get(match[0], match[0])]
        words += [";"] if match[0] in marks else []
    lines = _lines(" ".join(words), marks)
    if macros and any(_COMPARED.search(line) for line in lines):
        raise NotShownError("the C file compares by operators where there may be many numbers")
    try:
        return ast.parse("\n".join(lines))
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise NotShownError(f"the C file cannot be parsed: {error}") from error


def _lines(code: str, marks: Sequence[str]) -> list[str]:
    """Return the lines of Python for C tokens that are separated by spaces."""
    code = code.replace(" ( double ) NAN ", " NAN ")
    code = re.sub(r"enum {([^{}]*)}", lambda match: f"enum{match[1]}".replace(",", "; enum"), code)
    code = _LOOP.sub(_loop, re.sub(r"= {([^{}]*)}", r"= [\1]", code))
    if re.search(r"\+\+|--|#", code):
        raise NotShownError("the C file has an increment, or a directive, at another place")
    *parts, last = re.split(r" *([;{}]) *", code)
    lines, depth, left = list[str](), 0, [*marks]
    for text, end in zip(parts[::2], parts[1::2], strict=True):
        if end == ";" and depth == 0 and text in left[:1]:
            left.remove(text)
            lines.append(f"{ord(text) - ord(marks[0])}")
        elif text in marks:
            raise NotShownError("the C file has its parts in another order, or one in a block")
        elif end == "{":
            lines.append(f"{' ' * depth}{_head(text, depth)}:")
            depth += 1
        elif end == "}" and not text and depth:
            lines += [f"{' ' * depth}pass"] if lines[-1].endswith(":") else []
            depth -= 1
        elif text or end == "}":
            lines.append(
                f"{' ' * depth}{_statement(text if depth else text.removeprefix('enum '))}"
            )
    if last or depth or left:
        raise NotShownError("the C file ends early, or has a part in a comment")
    return lines


def _loop(match: re.Match[str]) -> str:
    directive, name, size = match.groups()
    sums = re.findall(r"\w+", directive or "")[4:]
    lanes = "lanes" if directive is None else "simd"
    return f"for {name} in {lanes} ( {' , '.join([size, *sums])} ) {{"


def _head(text: str, depth: int) -> str:
    """Return the beginning of a function, a loop or a block."""
    function = _FUNCTION.fullmatch(text)
    if function and not depth:
        kind, name, given = function.groups()
        arguments = (part.rpartition(" ") for part in given.split(" , "))
        words = ", ".join(f"{own}: {kind!r}" for kind, _, own in arguments)
        return f"def {name}({words}) -> {kind.strip()!r}"
    if depth and (not text or text.startswith("for ")):
        return text or "with block"
    raise NotShownError(f"the C file has a block behind {text[:40]!r}")


def _statement(text: str) -> str:
    declared = _DECLARED.fullmatch(text)
    if declared:
        kind, name, size, value = declared.groups("")
        if "*" in kind:  # x + place points to x[place]
            value = re.sub(r"^( = \w+) \+ (.*)$", r"\1 [ \2 ]", value)
        return f"{name}: '{kind.strip()}{size}'{value and f' = {_chosen(value[3:])}'}"
    if re.fullmatch(r"\w+ \( \w+(?: , \w+)* \)", text):
        return text
    changed = re.fullmatch(r"(return|.+? \+?=|\( void \)) (.+)", text)
    if changed is None:
        raise NotShownError(f"the C file has a statement {text[:40]!r}")
    first, value = changed.groups()
    return f"{first.removeprefix('( void )')} {_chosen(value)}".strip()


def _chosen(text: str) -> str:
    """Return an expression with C's ``? :`` outside brackets replaced by Python's ``if else``.

    In a list this is done for each entry.
    """
    if text.startswith("[ ") and text.endswith(" ]"):
        return f"[{', '.join(map(_chosen, _parts(text[2:-2])))}]"
    test, choice, rest = text.partition(" ? ")
    then, _, other = rest.partition(" : ")
    if not choice:
        return text
    if any(part.count("(") != part.count(")") for part in (test, then)):
        raise NotShownError(f"the C file has a choice in brackets: {text[:40]!r}")
    return f"({then}) if ({test}) else ({_chosen(other)})"


def _parts(text: str) -> Iterator[str]:
    """Yield the parts between commas outside brackets; the text may end with a comma."""
    part = ""
    for piece in text.removesuffix(" ,").split(" , "):
        part = f"{part} , {piece}" if part else piece
        if all(part.count(left) == part.count(right) for left, right in ("()", "[]")):
            yield part
            part = ""
    if part:
        raise NotShownError(f"the C file has a list with a bracket: {part[:40]!r}")
