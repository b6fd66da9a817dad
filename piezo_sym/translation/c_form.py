"""What the functions of a printed C file look like, before their statements.

Input: the tokens of a file, at a function.  Output: its name, and what each of its arguments is.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import final

from piezo_sym.translation.c_text import Tokens
from piezo_sym.translation.field import NotShownError

#: What may be written to: results, ledger rows, switching functions, margins.
WRITTEN = ("out", "rows", "s", "m")


@final
@dataclass(frozen=True)
class Form:
    """The functions of a file.

    Attributes
    ----------
    signatures : of each function, what its arguments are.
    record : the ending of the type that holds parameters.
    calls : the functions of the library that it may call, and what they are.
    written : of a function and an argument, what the rows are that it gets; else the function's.
    """

    signatures: Mapping[str, str]
    record: str
    calls: Mapping[str, str]
    written: Mapping[str, str] = field(default_factory=dict)

    def head(self, tokens: Tokens, model: str) -> tuple[str, dict[str, str]]:
        """Take the head of a function; return its name, and what its arguments are by name."""
        kind, word, prefix = tokens.one_of("void", "double", "long"), tokens.word(), f"{model}_"
        name = word[len(prefix) :] if word.startswith(prefix) else ""
        words = self.signatures.get(name, "").split()
        roles = {self._argument(tokens, word, model, n): word for n, word in enumerate(words)}
        tokens.take(")")
        wanted = "void" if "out" in words else "long" if words == ["p"] else "double"
        if kind != wanted or len(roles) != len(words) or not words:
            raise NotShownError(f"a function {word} of such types")
        return name, roles

    def _argument(self, tokens: Tokens, word: str, model: str, n: int) -> str:
        tokens.take("," if n else "(")
        types = dict.fromkeys(WRITTEN, "double * restrict")
        types["p"] = f"const {model}_{self.record} * restrict"
        tokens.take(*types.get(word, "const double * restrict").split())
        return tokens.word()

    def results(self, name: str, roles: Mapping[str, str]) -> dict[str, str]:
        """Return what the rows are that a function writes to each of its arguments."""
        given = {"out", *roles.values()} & {*WRITTEN} - {"s"}
        return {role: self.written.get(f"{name} {role}", name) for role in sorted(given)}
