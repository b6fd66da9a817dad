"""Mutants of printed text: one token changed, one line left out.

Input: the text of a NumPy module or a C file.  Output: (what was done, text) of each mutant.  What
leaves the meaning as it is (``<`` for ``<=`` at an edge where a law is continuous) is not made.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

TOKEN = re.compile(r"[A-Za-z_]\w*|\d+\.?\d*(?:e-?\d+)?|\+=|->|<=|>=|[!=]=|\|\||\*\*|[-+*/<>=?:()]")
SWAPS = {
    "+": "-",
    "-": "+",
    "*": "/",
    "/": "*",
    "<=": ">",
    ">": "<=",
    ">=": "<",
    "+=": "=",
    "**": "*",
}
WORDS = {
    "exp": "cos", "expm1": "exp", "log": "exp", "sin": "cos", "cos": "sin", "tanh": "sin",
    "sqrt": "exp", "abs": "sign", "fabs": "exp", "minimum": "maximum", "maximum": "minimum",
    "min": "max", "max": "min", "sum": "max", "empty": "zeros", "zeros": "empty", "axis": "where",
    "copysign": "pow", "power_2": "power_3", "power_3": "power_2", "sign": "fabs",
}  # fmt: skip
FIXED = frozenset({"np", "p_", "x", "u", "out", "for", "long", "const", "double", "return", "void"})


def mutants(text: str, start: str) -> Iterator[tuple[str, str]]:
    """Yield the mutants of every line from the first that begins with `start`."""
    lines = text.split("\n")
    first = next(n for n, line in enumerate(lines) if line.startswith(start))
    scopes = _scopes(lines, first)
    for n in range(first, len(lines)):
        line = lines[n]
        if _is_code(line):
            for what, new in (*_changed(line, scopes[n]), ("left out", None)):
                changed = [*lines[:n], *([new] if new is not None else []), *lines[n + 1 :]]
                yield f"line {n + 1} {line.strip()!r}: {what}", "\n".join(changed)


def _is_code(line: str) -> bool:
    plain = line.strip()
    return bool(plain) and not plain.startswith(
        ("#", "/*", '"""', "def ", "long ", "void ", "double piezo")
    )


def _scopes(lines: list[str], first: int) -> dict[int, list[str]]:
    """Return the names that each line's function defines."""
    names: list[str] = []
    found: dict[int, list[str]] = {}
    for n in range(first, len(lines)):
        if lines[n].startswith(("def ", "void ", "double ", "long ", "static ")):
            names = []
        match = re.match(
            r"\s+(?:const )?(?:double |long )?(?:\*?(?:restrict )?)?(\w+) = ", lines[n]
        )
        if match and match[1] not in names:
            names.append(match[1])
        found[n] = names
    return found


def _changed(line: str, names: list[str]) -> Iterator[tuple[str, str]]:
    for match in TOKEN.finditer(line.split("/*")[0]):
        token, (a, b) = match[0], match.span()
        for new in _others(token, names, line[:a]):
            yield f"{token} -> {new}", line[:a] + new + line[b:]


def _others(token: str, names: list[str], before: str) -> Iterator[str]:
    if token in SWAPS and not before.rstrip().endswith(("*restrict", "const double")):
        yield SWAPS[token]
    elif token in WORDS:
        yield WORDS[token]
    elif token[0].isdigit():
        yield str(int(token) + 1) if token.isdigit() else f"{float(token) + 1}"
    elif token in names and token not in FIXED and len(names) > 1:
        yield names[names.index(token) - 1]
