"""The tables of a printed step, read back: whole numbers by name.

Input: the tokens of ``<model>_step.c``.  Output: which margins of a stage have to be positive; the
other tables serve Newton's method alone, and only have to be tables.
"""

from typing import final

from piezo_sym.translation.c_text import Tokens
from piezo_sym.translation.field import NotShownError


@final
class Tables:
    """Enumerations and tables of a model, taken one by one."""

    def __init__(self, tokens: Tokens, model: str) -> None:
        self.tokens, self.model = tokens, model
        self.numbers: dict[str, list[int]] = {}

    def take_enumeration(self) -> None:
        """Take what stands behind ``enum``."""
        self.tokens.take("{")
        while not self.tokens.taken("}"):
            name = self.tokens.word()
            self.tokens.take("=")
            self._keep(name, [self._number()])
            if self.tokens.peek() != "}":
                self.tokens.take(",")
        self.tokens.take(";")

    def take_table(self) -> None:
        """Take what stands behind ``static const``."""
        self.tokens.take("int")
        name, found = self.tokens.word(), list[int]()
        self.tokens.take("[", "]", "=", "{")
        while not self.tokens.taken("}"):
            found.append(self._number())
            self.tokens.take(",")
        self.tokens.take(";")
        self._keep(name, found)

    def strict(self) -> list[int]:
        """Return of each margin of a stage whether it has to be positive; else it may be zero."""
        limits = self.numbers.get(f"{self.model}_limits")
        strict = self.numbers.get(f"{self.model}_strict")
        if not limits or strict is None or len(strict) != max(1, *limits):
            raise NotShownError("the step does not say which of its limits are strict")
        return strict[: limits[0]]

    def _number(self) -> int:
        turn, text = (-1 if self.tokens.taken("-") else 1), self.tokens.next()
        if not text.isdecimal() or (text[0] == "0" and text != "0"):
            raise NotShownError(f"the step has {text[:20]!r} where a whole number should be")
        return turn * int(text)

    def _keep(self, name: str, numbers: list[int]) -> None:
        if name in self.numbers or not name.startswith(f"{self.model}_"):
            raise NotShownError(f"a table {name} of the step's own")
        self.numbers[name] = numbers
