"""Why a text is no law, where Python's parser says only that it is none, and what to write."""

import re
from keyword import kwlist

from piezo_sym.errors import quote

NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
#: The keywords of Python that a law may have, or that are no one's names.
NO_NAMES = frozenset({"if", "else", "and", "or", "not", "True", "False", "None"})
KEYWORDS = frozenset(kwlist) - NO_NAMES
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


def with_a_point(text: str) -> str:
    """Return how to write the first number with a decimal comma, or ''."""
    number = WITH_A_COMMA.search(text)
    return f"write {number.group().replace(',', '.')}, with a point" if number else ""
