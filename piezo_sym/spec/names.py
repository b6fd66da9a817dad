"""Which words may be names, and fresh names for what the generator adds.

Input: a word from a spec.  Output: the word, or a `SpecError` that offers a better one.  Names end
up as identifiers in Python and C and as file names, so they are plain ASCII, at most 40
characters, no keyword of a language a user exports to, and no name the law language already uses.
A trailing underscore is kept for the generator, so that `fresh` never meets a user's name.
"""

import keyword
import re
from collections.abc import Collection

from piezo_sym.errors import SpecError, quote
from piezo_sym.expressions.functions import FUNCTIONS

MAX_NAME = 40
NAME = re.compile(r"[A-Za-z](?:[A-Za-z0-9_]*[A-Za-z0-9])?")
#: The generated module's one import.
IMPORT = "np"

_C = """auto break case char const continue default do double else enum extern float for goto if
inline int long register restrict return short signed sizeof static struct switch typedef union
unsigned
void volatile while main NULL bool true false"""
_MATLAB = """break case catch classdef continue else elseif end for function global if otherwise
parfor persistent return spmd switch try while"""
_MODELICA = """algorithm and annotation assert block break class connect connector constant
constrainedby der discrete each else elseif elsewhen encapsulated end enumeration equation
expandable extends external false final flow for function if import impure in initial inner input
loop model not operator or outer output package parameter partial protected public pure record
redeclare replaceable
return stream then true type when while within time"""
_DEVICES = "con prn aux nul " + " ".join(f"com{n} lpt{n}" for n in range(1, 10))

KEYWORDS = (
    frozenset(keyword.kwlist)
    | frozenset(keyword.softkwlist) - {"_"}
    | frozenset(f"{_C} {_MATLAB} {_MODELICA}".split())
)
DEVICES = frozenset(_DEVICES.split())
OFFERS = {"end": "tip", "time": "t", "der": "d"}


def check_name(word: str, where: str) -> str:
    """Return `word` if it can name a model or an element.

    Raises `SpecError` if it cannot be a file's name and an identifier.
    """
    if not NAME.fullmatch(word) or len(word) > MAX_NAME:
        what = f"{quote(word)} is not a name"
        expected = f"a letter, then letters, digits or '_' (not last), at most {MAX_NAME} in all"
        remedy = "rename it" + " in plain ASCII" * (not word.isascii())
        raise SpecError(what, where, expected, remedy)
    if word.lower() in DEVICES:
        what = f"{quote(word)} is a device on some systems, and names become files"
        raise SpecError(what, where, remedy=f"call it '{word}1'")
    return word


def check_symbol(word: str, where: str, taken: Collection[str] = ()) -> str:
    """Return `word` if it can be a symbol: a parameter, an input or a state.

    Raises `SpecError` if it is no identifier, a keyword, an import or a function of the law
    language.
    """
    check_name(word, where)
    if word in KEYWORDS:
        offers = OFFERS.get(word, f"{word}_0"), *(f"{word}_{n}" for n in range(len(taken) + 1))
        remedy = f"call it '{next(offer for offer in offers if offer not in taken)}'"
        what = f"{quote(word)} is a keyword of Python, C, MATLAB or Modelica"
        raise SpecError(what, where, remedy=remedy)
    if word == IMPORT or word in FUNCTIONS:
        use = "a function of laws" if word in FUNCTIONS else "kept for modules"
        raise SpecError(f"{quote(word)} is {use}", where, remedy=f"call it '{word}_0'")
    return word


def fresh(base: str, taken: Collection[str]) -> str:
    """Return `base`, with underscores added until it is not in `taken`."""
    name = base
    while name in taken or name in KEYWORDS or name in FUNCTIONS:
        name += "_"
    return name
