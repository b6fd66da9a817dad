"""The letters and tokens of laws, checked before anything parses them.

Input: text from a user.  Output: nothing, or a `RefusedError` that says what is wrong with it.
"""

import re

from piezo_sym.errors import quote

LANGUAGE = "numbers, names, + - * / **, (), 'a if x < y else b', or a function as in exp(x)"
#: What to write instead of characters of other languages.
REMEDIES = {
    "^": "write ** for a power",
    "=": "write >= or <= in a condition",
    ".": "write a function by its name alone, as in tanh(v)",
    "|": "write abs(v)",
    "&": "write each condition as one of its own",
}
#: Elementwise operators of other languages.
DOTTED = {".*": "*", "./": "/", ".^": "**"}
MAX_DEPTH = 40
MAX_DIGITS = 40
MAX_LENGTH = 1000
MAX_LENGTH_OF_A_TABLE = 4000
MAX_MAGNITUDE = 300
MAX_PREFIXES = 8
TOKEN = re.compile(
    r"(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)"
    r"|(?P<operator>\*\*|<=|>=|[-+*/(),<>])"
    r"|(?P<space> +)"
)


class RefusedError(Exception):
    """The reason why a text is no law; the caller, which knows its place, raises a `SpecError`."""

    def __init__(self, what: str, expected: str = "", remedy: str = "") -> None:
        super().__init__(what)
        self.what, self.expected, self.remedy = what, expected, remedy


def check_letters(text: str) -> None:
    """Refuse a text that is too long, empty, or not plain ASCII on one line."""
    most = MAX_LENGTH_OF_A_TABLE if re.search(r"\btable *\(", text) else MAX_LENGTH
    if len(text) > most:
        what = f"is {len(text)} characters long"
        raise RefusedError(what, f"at most {most}", "split the law into parameters")
    if not text.strip():
        raise RefusedError("is empty", "a law, such as 'd*v'")
    odd = next((c for c in text if not " " <= c <= "~"), None)
    if odd is not None:
        what = f"has the character U+{ord(odd):04X}"
        raise RefusedError(what, "plain ASCII on one line", "type the name in Latin letters")


def check_tokens(text: str) -> None:
    """Refuse characters that form no token of the law language, and deep nesting."""
    position = depth = prefixes = 0
    while position < len(text):
        match = TOKEN.match(text, position)
        if match is None:
            what = f"has {quote(text[position])} at column {position + 1}"
            raise RefusedError(what, LANGUAGE, _remedy(text[position : position + 2]))
        token = match.group()
        depth += (token == "(") - (token == ")")
        prefixes = _prefixes(prefixes, match)
        if depth > MAX_DEPTH or prefixes > MAX_PREFIXES:
            raise RefusedError("is nested too deeply", f"at most {MAX_DEPTH} levels")
        if match.lastgroup == "number":
            _check_number(token, text[match.end() : match.end() + 1])
        position = match.end()


def _remedy(odd: str) -> str:
    """Return what to write instead of an unknown operator; `odd` is its first two characters."""
    if odd in DOTTED:
        return f"write {DOTTED[odd]} for {odd}"
    return REMEDIES.get(odd[0], "")


def _prefixes(count: int, match: re.Match[str]) -> int:
    """Return the number of operators in a row after one more token, spaces aside."""
    if match.lastgroup == "space":
        return count
    return count + 1 if match.group() in {"+", "-", "*", "/", "**"} else 0


def _check_number(token: str, following: str) -> None:
    if following.isalnum() or following == "_":
        what = f"has a number that runs into {quote(following)}"
        raise RefusedError(what, "a plain decimal number without unit, such as 0.5 or 1e-3")
    mantissa, _, exponent = token.lower().partition("e")
    digits = sum(c.isdigit() for c in mantissa)
    if digits > MAX_DIGITS or abs(int(exponent[:9] or "0")) > MAX_MAGNITUDE:
        what = f"has the number {quote(token)}"
        raise RefusedError(what, f"at most {MAX_DIGITS} digits and 1e+-{MAX_MAGNITUDE}")
