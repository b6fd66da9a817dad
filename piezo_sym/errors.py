"""The errors of the package: one line with the fault, the place, what was expected, the remedy.

Input: these four parts.  Output: an exception whose ``str`` is one printable line, and whose
``exit_code`` is that of the command line (1: not proved or drifted, 2: spec or command wrong, 3: a
proof and a number disagree).
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from math import nan
from numbers import Real
from typing import Any, ClassVar, final

MAX_QUOTE = 60
MAX_PLACE = 200
MOST_KNOWN = 60
#: A number of NumPy, as `repr` writes it.
WRAPPED = re.compile(r"\bnp\.\w+\(([^()]*)\)")


@dataclass(eq=False)
class PiezoError(Exception):
    """Base of all errors of this package; never raised itself.

    Attributes
    ----------
    what : the fault, in a few words.
    where : the place: a dotted path in the spec, a file, an option.
    expected : a valid value.
    remedy : what to do.
    """

    what: str
    where: str = ""
    expected: str = ""
    remedy: str = ""

    exit_code: ClassVar[int] = 2

    def __str__(self) -> str:
        """Return the error as one line of printable text."""
        where = self.where
        if len(where) > MAX_PLACE:
            where = f"{where[: MAX_PLACE // 2]}...{where[-MAX_PLACE // 2 + 3 :]}"
        parts = [f"{where}: {self.what}" if where else self.what]
        if self.expected:
            parts.append(f"expected {self.expected}")
        if self.remedy:
            parts.append(self.remedy)
        return legible("; ".join(parts))

    def put_in(self, outer: str) -> None:
        """Name an outer place, such as a file, in front of the places of an error and its notes.

        Notes, which Python shows below an error, are further errors found with it, a line each.
        """
        self.where = f"{outer}: {self.where}" if self.where else outer
        self.__notes__ = [f"{outer}: {note}" for note in getattr(self, "__notes__", ())]

    def lines(self) -> list[str]:
        """Return the error and those found with it, a line each."""
        return [str(self), *getattr(self, "__notes__", ())]


@final
class SpecError(PiezoError):
    """A spec that cannot be read, or says something impossible."""


@final
class NetworkError(PiezoError):
    """A network whose junction laws have no, or more than one, solution."""


class UsageError(PiezoError):
    """A call or a command with wrong arguments."""


@final
class UnknownNameError(UsageError, KeyError):
    """A call that gives a value to, or asks a table for, a name that does not exist."""

    name: str = ""


@final
class FileError(PiezoError):
    """A file that cannot be read or written."""


@final
class RunError(PiezoError):
    """A simulation that left its domain or could not go on; says when and why.

    `partial` is the Dataset so far, if `simulate` has begun to step; `time` [s] is when inputs
    leave the domain.
    """

    partial: Any = None
    time: float = nan
    reached: Any = None  # the times and the `Trajectory` of `partial`


@final
class EngineError(PiezoError):
    """A module that cannot be compiled or loaded; runs then go on in NumPy."""


@final
class ProofError(PiezoError):
    """A required property that is refuted or open."""

    exit_code: ClassVar[int] = 1


@final
class ContradictionError(PiezoError):
    """A proved row that exact arithmetic finds false at a point: a fault of this package."""

    exit_code: ClassVar[int] = 3


@final
class DriftError(PiezoError):
    """Generated files that differ from what their specs generate."""

    exit_code: ClassVar[int] = 1


class InputWarning(UserWarning):
    """An input or a start that may not be what is meant; one that is left out among them."""


def legible(text: str) -> str:
    """Return a message with every character that does not print escaped, so that it is one line."""
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


def one_line(text: str) -> str:
    """Return `text` as one line of ASCII, with all other characters escaped."""
    return "".join(c if c.isascii() else ascii(c)[1:-1] for c in legible(text))


def quote(value: object) -> str:
    """Return a short, printable form of a user's value: of a number itself, else quoted."""
    text = value if isinstance(value, str) else WRAPPED.sub(r"\1", repr(value))
    short = text if len(text) <= MAX_QUOTE else f"{text[: MAX_QUOTE - 3]}..."
    is_number = isinstance(value, Real) and not isinstance(value, bool)
    return legible(short if is_number else f"'{short}'")


def listing(names: Iterable[str], most: int = 12) -> str:
    """Return names as a list for a message, cut after `most` of them."""
    known = list(names)
    cut = ", ".join(known[:most]) or "none"
    return f"{cut}, and {len(known) - most} more" if len(known) > most else cut


def with_article(noun: str) -> str:
    """Return a noun with "a" or "an"."""
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"


#: What to write where dry friction, F_c*sign(v), holds a state at rest: no step crosses the jump.
STICKING = "friction that sticks is a 'stop', or F_c*tanh(v/v_0) with a small v_0, not F_c*sign(v)"
#: Names up to this length are similar only if they begin alike: F_0 is not meant to be T_0.
SHORT = 3


def similar(word: str, known: Iterable[str]) -> str:
    """Return the known name that `word` may be meant for, or ''."""
    names, short = list(known), word[:MAX_QUOTE]
    match = [name for name in names if name.lower() == short.lower()]
    like = [name for name in names if len(short) > SHORT or name[:1] == short[:1]]
    return next(iter(match or get_close_matches(short, like, n=1, cutoff=0.6)), "")


def nearest(word: str, known: Iterable[str]) -> str:
    """Return "did you mean 'x'?" with the known name nearest to `word`, or the known names."""
    names = list(known)
    match = similar(word, names)
    return f"did you mean '{match}'?" if match else f"known: {listing(names, MOST_KNOWN)}"
