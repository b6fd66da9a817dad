"""Mutants of printed text: one token changed, one line left out.

Input: the text of a NumPy module or a C file.  Output: (what was done, text) of each mutant.  What
leaves the meaning as it is (``n + 0`` and ``n - 0``, a name that nothing uses) is not made.
"""

import re

TOKEN = re.compile(r"[A-Za-z_]\w*|\d+\.?\d*(?:e-?\d+)?|\+=|->|<=|>=|[!=]=|\|\||\*\*|[-+*/<>=?:()]")
SWAPS = {
    "+": "-", "-": "+", "*": "/", "/": "*", "**": "*", "+=": "=",
    "<=": ">", ">": "<=", ">=": "<", "<": ">",
}  # fmt: skip
WORDS = {
    "exp": "cos", "expm1": "exp", "log": "exp", "sin": "cos", "cos": "sin", "tanh": "sin",
    "sqrt": "exp", "abs": "sign", "fabs": "exp", "minimum": "maximum", "maximum": "minimum",
    "min": "max", "max": "min", "sum": "max", "empty": "zeros", "zeros": "empty", "axis": "where",
    "copysign": "pow", "power_2": "power_3", "power_3": "power_2", "sign": "fabs",
    "exp_of": "cos_of", "expm1_of": "exp_of", "sqrt_of": "exp_of", "tanh_of": "sin_of",
    "zero": "wide", "wide": "zero", "chosen": "least", "least": "chosen",
    "out": "rows", "rows": "out", "m": "out", "s": "out",
}  # fmt: skip
FIXED = frozenset({"np", "p_", "p", "x", "u", "out", "for", "long", "const", "double", "return"})
FIXED |= {"real", "g", "b", "rows", "s", "m"}
HEADS = ("def ", "void ", "double ", "long ", "static ")
#: Behind this line of a step stands what serves Newton's method alone.
NEWTON = "/* Derivative of the rates"
DEFINED = re.compile(r"\s+(?:const )?(?:double |long |real )?(?:\*?(?:restrict )?)?(\w+) = ")
SAME = re.compile(r"\[[^]]*\+ 0\]|^\s*\(void\)|\(-1\)\*|out\[j\*n \+ j\] \+=")


def mutants(text):
    """Yield the mutants of every line of the functions of a module."""
    lines, last = text.split("\n"), text.split(NEWTON)[0].count("\n")
    first = next(n for n, line in enumerate(lines) if line.startswith(("def initial", *HEADS[1:])))
    scopes = _scopes(lines, first)
    for n in range(first, last + 1):
        plain = lines[n].strip()
        if (
            not plain
            or plain.startswith(("#", "/*", "* ", '"""', *HEADS[:2]))
            or SAME.search(plain)
        ):
            continue
        yield from _of_line(lines, n, *scopes[n])


def _of_line(lines, n, names, body):
    """Yield the mutants of a line, of a function that defines `names`."""
    line = lines[n]
    quiet = line.startswith("@np.errstate")  # without it NumPy warns; no value is another
    for what, new in (*_changed(line, names), *([] if quiet else [("left out", None)])):
        defined = DEFINED.match(line)
        if defined and not re.search(rf"\b{defined[1]}\b", body.replace(line, "", 1)):
            continue
        changed = [*lines[:n], *([new] if new is not None else []), *lines[n + 1 :]]
        yield f"line {n + 1} {line.strip()!r}: {what}", "\n".join(changed)


def _scopes(lines, first):
    """Return the names that each line's function defines, and its text."""
    found, names, body = {}, [], []
    for n in range(first, len(lines)):
        if lines[n].startswith(HEADS):
            names, body = [], []
        defined = DEFINED.match(lines[n])
        if defined and defined[1] not in names:
            names.append(defined[1])
        body.append(lines[n])
        found[n] = names, body
    return {n: (names, "\n".join(body)) for n, (names, body) in found.items()}


def _changed(line, names):
    for match in TOKEN.finditer(line.split("/*")[0]):
        for new in _others(match[0], names):
            yield f"{match[0]} -> {new}", line[: match.start()] + new + line[match.end() :]


def _others(token, names):
    if token in SWAPS or token in WORDS:
        yield {**SWAPS, **WORDS}[token]
    elif token[0].isdigit():
        yield str(int(token) + 1) if token.isdigit() else f"{float(token) + 1}"
    elif token in names and token not in FIXED and len(names) > 1:
        yield names[names.index(token) - 1]
