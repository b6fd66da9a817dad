"""Printed C as tokens, and its expressions as trees of Python's `ast`.

Input: the text of a C file.  Output: `Tokens`; and `File`, what the functions of one file share.
Comments are left out; of directives only the two ``#include`` lines and ``#pragma omp simd`` are in
the grammar, strings and characters are not.
"""

import ast
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from keyword import iskeyword
from types import MappingProxyType
from typing import final

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.translation.field import NotShownError
from piezo_sym.translation.known import Proved

_TOKEN = re.compile(
    r"(?P<space>\s+|/\*.*?\*/)"
    r"|#pragma omp simd(?P<pragma>(?: reduction\(\+:[\w,\s\\]*\))?)(?=\n)"
    r"|(?P<word>[A-Za-z_]\w*)"
    r"|(?P<number>(?:\d+\.\d*|\.\d+|\d+)(?:[eE][-+]?\d+)?)(?![\w.])"
    r"|(?P<sign>->|\|\||\+\+|--|\+=|[<>=!]=|[-+*/<>=?:,;(){}\[\]])",
    re.DOTALL | re.ASCII,
)
#: Comments, and the two headers: nothing of a file stands before them.
_HEAD = r'\s*(?:/\*(?:(?!\*/)[^\\])*\*/\s*)*(?:#include (?:"{model}\.h"|<math\.h>)\n\s*){{2}}'
_SPELLED, _CLOSING = {"||": "or", "->": "."}, {"(": ")", "[": "]"}
MOST_DIGITS = 9
#: How a step says that integrands have kinks; behind the end of a comment none is open.
BENDS = "\n/* Integrands have kinks: see run/engine. */\n#define BENDS\n"


@final
class Tokens:
    """The tokens of a C file, taken one by one; what is not as expected is refused.

    Parameters
    ----------
    text : the file.
    model : its name, which its header has.
    macros : what stands behind the headers and gives `spelled` their meaning.
    spelled : words that stand for others, or for nothing before what is in brackets.
    table : lines that have to stand somewhere behind them, once.

    Attributes
    ----------
    bends : whether the line `BENDS` is there.
    """

    def __init__(
        self,
        text: str,
        model: str,
        macros: str = "",
        spelled: Mapping[str, str] = MappingProxyType({}),
        table: str = "",
    ) -> None:
        head = re.match(_HEAD.format(model=re.escape(model)), text)
        for line in (f'#include "{model}.h"\n', "#include <math.h>\n"):
            if head is None or text.count(line) != 1:
                raise NotShownError(f"the C file should begin with one line {line.strip()}")
        assert head is not None
        if not text.startswith(macros, head.end()):
            raise NotShownError("the C file should define its words behind the headers")
        first, text = (
            text.count("\n", 0, head.end() + len(macros)),
            text[head.end() + len(macros) :],
        )
        self.found: list[str] = []
        self.bends = bool(macros) and BENDS in text
        text = text.replace(BENDS, "\n\n\n", int(self.bends))
        if table and text.count(table) != 1:
            raise NotShownError("the table of the step's paths is not the system's")
        text = text.replace(table, "\n" * table.count("\n"), int(bool(table)))
        self.at = 0
        self.sums: dict[int, frozenset[str]] = {}
        place = 0
        while place < len(text):
            match = _TOKEN.match(text, place)
            spliced = match is not None and match["pragma"] is None and "\\" in match[0]
            if match is None or spliced or "??" in match[0]:
                number = text.count("\n", 0, place) + first + 1
                raise NotShownError(f"line {number} of the C file is outside the grammar")
            place = match.end()
            self._keep(match, text, spelled)

    def _keep(self, match: re.Match[str], text: str, spelled: Mapping[str, str]) -> None:
        """Take a token as the next: a directive by its sums, a word by what it stands for."""
        if match["pragma"] is not None:
            self.sums[len(self.found)] = frozenset(re.findall(r"\w+", match["pragma"])[1:])
            self.found.append("#pragma")
        elif match["space"] is None:
            word = spelled.get(match[0], match[0])
            if match["word"] is not None and word == match[0] in spelled.values():
                raise NotShownError(f"the C file has {match[0]!r}, and another word for it")
            if not word and not text.startswith("(", match.end()):
                raise NotShownError(f"the C file has {match[0]!r} without what it is of")
            self.found += [word] if word else []

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
        """Take an expression: C's operators bind as Python's do, but for ``?`` and comparisons.

        A comparison of comparisons, which they read differently, is left for readers to refuse.
        """
        text = self._in_python()
        try:
            return ast.parse(text, mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            raise NotShownError(f"the C file has {text[:60]!r} for an expression") from error

    def _in_python(self) -> str:
        """Take an expression up to the token that ends it."""
        words: list[str] = []
        while (token := self.peek()) not in {";", ",", ")", "]", "}", ":", ""}:
            self.next()
            if token == "?":
                then = self._in_python()
                self.take(":")
                return f"({then}) if ({' '.join(words)}) else ({self._in_python()})"
            odd = iskeyword(token) or token in {"++", "--"}  # these mean others in Python
            if odd or (token.isdigit() and len(token) > MOST_DIGITS):
                raise NotShownError(f"the C file has {token[:20]!r} in an expression")
            words.append(self._inside(token) if token in _CLOSING else _SPELLED.get(token, token))
        if not words:
            raise NotShownError(f"the C file has {token!r} where an expression should be")
        return " ".join(words)

    def _inside(self, opening: str) -> str:
        """Take what stands in brackets; of casts, ``(double)NAN`` is in the grammar."""
        if self.taken("double"):
            self.take(")", "NAN")
            return "NAN"
        found = [self._in_python()]
        while self.taken(","):
            found.append(self._in_python())
        self.take(_CLOSING[opening])
        return f"{opening}{', '.join(found)}{_CLOSING[opening]}"


CALLS = {record.in_c: name for name, record in RECORDS.items() if record.smooth}
CALLS |= {"pow": "pow", "fabs": "abs", "copysign": "copysign"}
#: What the step's own words for comparisons stand for.
COMPARISONS: dict[str, ast.cmpop] = {"is_above": ast.Gt(), "is_at_least": ast.GtE()}


@final
@dataclass(frozen=True)
class Helper:
    """A function of the file's own: its parameters and their types, and what it returns."""

    parameters: tuple[tuple[str, str], ...]
    value: ast.expr


@final
@dataclass(frozen=True)
class File:
    """What the functions of a C file have in common.

    Attributes
    ----------
    model : with its name the name of each function begins.
    signatures : of each function, what its arguments are.
    record : the ending of the type that holds parameters.
    calls : the functions of the library that may be called, and what they are.
    results : of a function and an argument, which rows are written to it; else the function's.
    """

    known: Proved
    model: str
    signatures: Mapping[str, str]
    record: str
    calls: Mapping[str, str]
    results: Mapping[str, str] = field(default_factory=dict)
    helpers: dict[str, Helper] = field(default_factory=dict)
