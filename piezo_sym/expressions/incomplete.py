"""Why a text is no law, where Python's parser says only that it is none, and what to write."""

import json
import re
from keyword import kwlist

from piezo_sym.errors import listing, quote

NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
#: The keywords of Python that a law may have, or that are no one's names.
NO_NAMES = frozenset({"if", "else", "and", "or", "not", "True", "False", "None"})
KEYWORDS = frozenset(kwlist) - NO_NAMES
#: What to write for names of constants, of which laws know none.
CONSTANTS = {
    **dict.fromkeys(("pi", "Pi", "PI", "M_PI"), "constants are numbers: write 3.141592653589793"),
    "e": "constants are numbers: write exp(x) for e**x, and exp(1) for e",
    "inf": "a law is of finite numbers: leave out the limit that is none",
    "eps": "declare it in [parameters] with a small value and its unit",
}
#: Words that join comparisons, which the language of laws does not have, and those of C.
AND, OR = re.compile(r"\band\b|&&?"), re.compile(r"\bor\b|\|\|?")
CHAIN = re.compile(r"([^<>]+)([<>]=?)([^<>]+)([<>]=?[^<>]+)")
WITH_A_COMMA = re.compile(r"(?<![\w.,])\d+,\d+(?![\d.,])")


def incomplete(text: str) -> tuple[str, str]:
    """Return what is wrong with a text that cannot be parsed, and the remedy or ''."""
    words = NAME.findall(text)
    if keyword := next((word for word in words if word in KEYWORDS), ""):
        return f"has a keyword of Python, {quote(keyword)}", f"call it '{keyword}_0'"
    what = "is not a complete law"
    if bracket := _bracket(text):
        return what, bracket
    if words.count("if") > words.count("else"):
        return what, "an 'else' is missing, as in 'd*v if v > 0 else 0'"
    beside = re.search(r"[\w)] +[\w(]", text) and not NO_NAMES & {*words}
    return what, "write * between factors, as in d*v" * bool(beside)


def _bracket(text: str) -> str:
    """Return what to do about the first bracket without a second one, or ''."""
    opened = list[int]()
    for column, character in enumerate(text, start=1):
        if character == "(":
            opened.append(column)
        elif character == ")" and not opened:
            return f"the ')' at column {column} closes no bracket: take it out, or open one"
        elif character == ")":
            opened.pop()
    return f"close the bracket that opens at column {opened[-1]}" if opened else ""


def conditions_of(text: str) -> list[str]:
    """Return the conditions in a text that joins several: by a word, a sign, or as in 0 < a < b."""
    found = list[str]()
    for part in re.split(rf"{AND.pattern}|;|,(?![^(]*\))", text):
        bare = re.sub(r"^\(([^()]*)\)$", r"\1", part.strip())
        if chain := CHAIN.fullmatch(bare):
            low, sign, middle, rest = (piece.strip() for piece in chain.groups())
            found += [f"{low} {sign} {middle}", f"{middle} {rest}"]
        elif not re.search("[<>]", bare):  # a comma between arguments
            return [text]
        else:
            found.append(bare)
    return [text] if OR.search(text) else found


def one_by_one(text: str) -> str:
    """Return what to do about several conditions in a text, or "": a choice has one of its own."""
    several = [] if " if " in text else conditions_of(text)
    listed = listing(map(json.dumps, several))
    return f"write each condition as one of its own: {listed}" if len(several) > 1 else ""


def with_a_point(text: str) -> str:
    """Return how to write the first number with a decimal comma, or ''."""
    number = WITH_A_COMMA.search(text)
    return f"write {number.group().replace(',', '.')}, with a point" if number else ""
