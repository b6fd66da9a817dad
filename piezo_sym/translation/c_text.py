"""Printed C as tokens, and its expressions as trees of Python's `ast`.

Input: the text of a C file.  Output: `Tokens`.  Comments are left out; of directives only the two
``#include`` lines and ``#pragma omp simd`` are in the grammar, strings and characters are not.
"""

from __future__ import annotations

import ast
import re
from typing import final

from piezo_sym.translation.field import NotShownError

_TOKEN = re.compile(
    r"(?P<space>\s+|/\*.*?\*/)"
    r"|#pragma omp simd(?P<pragma>(?: reduction\(\+:[\w,\s\\]*\))?)(?=\n)"
    r"|(?P<word>[A-Za-z_]\w*)"
    r"|(?P<number>(?:\d+\.\d*|\.\d+|\d+)(?:[eE][-+]?\d+)?)(?![\w.])"
    r"|(?P<sign>->|\|\||\+\+|\+=|[<>=!]=|[-+*/<>=?:,;(){}\[\]])",
    re.DOTALL,
)
#: Binary operators, weakest first; those of one level are taken from left to right.
_LEVELS: tuple[dict[str, type[ast.AST]], ...] = (
    {"||": ast.Or},
    {"==": ast.Eq, "!=": ast.NotEq},
    {"<": ast.Lt, "<=": ast.LtE, ">": ast.Gt, ">=": ast.GtE},
    {"+": ast.Add, "-": ast.Sub},
    {"*": ast.Mult, "/": ast.Div},
)
MOST_NESTED = 100


@final
class Tokens:
    """The tokens of a C file, taken one by one; what is not as expected is refused.

    Parameters
    ----------
    text : the file.
    model : its name, which its header has.
    """

    def __init__(self, text: str, model: str) -> None:
        heads = [f'#include "{model}.h"\n', "#include <math.h>\n"]
        for line in heads:
            if text.count(line) != 1:
                raise NotShownError(f"the C file should have one line {line.strip()}")
            text = text.replace(line, "")
        self.found: list[str] = []
        self.at, self.depth = 0, 0
        self.sums: list[frozenset[str]] = []
        place = 0
        while place < len(text):
            match = _TOKEN.match(text, place)
            if match is None or "??" in match[0]:
                number = text.count("\n", 0, place) + len(heads) + 1
                raise NotShownError(f"line {number} of the C file is outside the grammar")
            place = match.end()
            if match["pragma"] is not None:
                self.sums.append(
                    frozenset(re.findall(r"\w+", match["pragma"][len(" reduction") :]))
                )
                self.found.append("#pragma")
            elif match["space"] is None:
                self.found.append(match[0])

    def peek(self) -> str:
        """Return the next token, or nothing at the end."""
        return self.found[self.at] if self.at < len(self.found) else ""

    def next(self) -> str:
        """Return the next token, and take it."""
        self.at += 1
        return self.found[self.at - 1] if self.at <= len(self.found) else ""

    def taken(self, token: str) -> bool:
        """Take a token if it is the next; return whether it was."""
        found = self.peek() == token
        self.at += found
        return found

    def take(self, *tokens: str) -> None:
        """Take tokens that have to come next."""
        for token in tokens:
            if (found := self.next()) != token:
                raise NotShownError(f"the C file has {found!r} where {token!r} should be")

    def word(self) -> str:
        """Take an identifier."""
        found = self.next()
        if not found.isidentifier():
            raise NotShownError(f"the C file has {found!r} where a name should be")
        return found

    def one_of(self, *tokens: str) -> str:
        """Take one of some tokens."""
        found = self.next()
        if found not in tokens:
            raise NotShownError(f"the C file has {found!r} where {' or '.join(tokens)} should be")
        return found

    # Expressions

    def expression(self) -> ast.expr:
        """Take an expression."""
        self.depth += 1
        if self.depth > MOST_NESTED:
            raise NotShownError("the C file nests expressions too deeply")
        made = self._binary(0)
        if self.taken("?"):
            then = self.expression()
            self.take(":")
            made = ast.IfExp(made, then, self.expression())
        self.depth -= 1
        return made

    def _binary(self, level: int) -> ast.expr:
        """Take operators of a level, and what binds more strongly."""
        if level == len(_LEVELS):
            return self._unary()
        made = self._binary(level + 1)
        while operator := _LEVELS[level].get(self.peek()):
            self.next()
            right = self._binary(level + 1)
            made = _joined(made, operator(), right)
        return made

    def _unary(self) -> ast.expr:
        if self.taken("-"):
            return ast.UnaryOp(ast.USub(), self._unary())
        made = self._primary()
        while self.peek() in {"(", "[", "->"} and not isinstance(made, ast.Constant):
            if self.taken("->"):
                made = ast.Attribute(made, self.word())
            elif self.taken("["):
                made = ast.Subscript(made, self.expression())
                self.take("]")
            else:
                made = ast.Call(made, self._arguments(), [])
        return made

    def _arguments(self) -> list[ast.expr]:
        self.take("(")
        found = [self.expression()]
        while self.taken(","):
            found.append(self.expression())
        self.take(")")
        return found

    def _primary(self) -> ast.expr:
        if self.taken("("):
            if self.taken("double"):
                self.take(")", "NAN")
                return ast.Name("NAN")
            made = self.expression()
            self.take(")")
            return made
        if self.peek()[:1].isdigit() or self.peek()[:1] == ".":
            text = self.next()
            if text.isdigit() and (len(text) > 9 or (text[0] == "0" and text != "0")):
                raise NotShownError("the C file has an integer that is too long, or octal")
            return ast.Constant(int(text) if text.isdigit() else float(text))
        return ast.Name(self.word())


def _joined(left: ast.expr, operator: ast.AST, right: ast.expr) -> ast.expr:
    if isinstance(operator, ast.cmpop):
        return ast.Compare(left, [operator], [right])
    if isinstance(operator, ast.boolop):
        return ast.BoolOp(operator, [left, right])
    assert isinstance(operator, ast.operator)
    return ast.BinOp(left, operator, right)
