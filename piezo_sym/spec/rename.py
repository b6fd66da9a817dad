"""New names in a spec; laws, conditions and initial values keep their spelling otherwise.

Input: texts or elements of a checked spec, and new names.  Output: the same under the new names.
Components, cells of banks and lanes are written out by it.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

from piezo_sym.spec.elements.base import Element, state_symbol

#: A name, and not the exponent of a number.
WORD = re.compile(r"(?<![\w.])[A-Za-z_]\w*")


@final
@dataclass(frozen=True)
class Renaming:
    """New names for symbols (`words`), elements and nodes; a bank is renamed like an element."""

    words: Mapping[str, str]
    element: Callable[[str], str] = str
    node: Callable[[str], str] = str

    def text(self, text: str) -> str:
        """Return a law or a condition with new names."""
        return WORD.sub(lambda match: self.words.get(match[0], match[0]), text)

    def start(self, start: Any) -> Any:
        """Return an initial value, or a list of them, with new names."""
        if isinstance(start, tuple):
            return tuple(map(self.start, start))
        return self.text(start) if isinstance(start, str) else start

    def fields(self, element: Element, name: str) -> dict[str, Any]:
        """Return the fields of an element, called `name` before, with new names."""
        fields = {**element.model_dump(exclude_none=True), **self._laws(element)}
        if states := getattr(element, "states", None):
            fields["states"] = {self._word(symbol): self._state(s) for symbol, s in states.items()}
        new_names = {"thermal_mass": self.element, "node": self.node, "input": self._word}
        for to, new in new_names.items():
            for field in dict(element.named(to)).keys() - {"states"}:
                given = getattr(element, field)
                fields[field] = tuple(map(new, given)) if isinstance(given, tuple) else new(given)
        if element.letter and (symbol := state_symbol(element, name)) in self.words:
            fields["state"] = self.words[symbol]
        if "bank" in fields:
            fields["bank"] = self.element(fields["bank"])
        return fields

    def _word(self, word: str) -> str:
        return self.words.get(word, word)

    def _state(self, state: Any) -> Any:
        nodes = state.between and tuple(map(self.node, state.between))
        return state.model_copy(update={"between": nodes})

    def _laws(self, element: Element) -> dict[str, str]:
        """Return the laws of an element with new names, by field.

        A law's letters stay.  T is a letter if the element names its body, else a symbol of the
        model.
        """
        hot = any(element.named("thermal_mass"))
        laws = {}
        for law in element.laws(""):
            letters = set() if law.mark.own else {*law.letters} - (set() if hot else {"T"})
            words = {word: self.words[word] for word in self.words.keys() - letters}
            laws[law.field] = Renaming(words).text(law.text)
        return laws
