"""Names in a spec, replaced: laws, conditions and initial values keep their spelling.

Input: texts or elements of a spec that was checked, and new names.  Output: the same with these.
"""

import re
from collections.abc import Callable, Mapping
from typing import Any

from piezo_sym.spec.elements.base import Element

#: A name, and not the exponent of a number.
WORD = re.compile(r"(?<![\w.])[A-Za-z_]\w*")


def reworded(text: str, words: Mapping[str, str]) -> str:
    """Return a law or a condition with new names."""
    return WORD.sub(lambda match: words.get(match[0], match[0]), text)


def started(start: Any, words: Mapping[str, str]) -> Any:
    """Return an initial value, or a list of them, with new names."""
    if isinstance(start, tuple):
        return tuple(started(part, words) for part in start)
    return reworded(start, words) if isinstance(start, str) else start


def relawed(element: Element, words: Mapping[str, str]) -> dict[str, Any]:
    """Return the laws of an element with new names, by field.

    Letters of a law stay; but T is a name where the element names no body whose temperature it is.
    """
    hot = any(to == "thermal_mass" for _, to, _ in element.references())
    made = {}
    for field, text, mark in element.laws():
        letters = set() if mark.own else {*mark.names} - (set() if hot else {"T"})
        made[field] = reworded(text, {word: words[word] for word in words.keys() - letters})
    return made


def renamed(
    element: Element,
    words: Mapping[str, str],
    body: Callable[[str], str],
    node: Callable[[str], str],
) -> dict[str, Any]:
    """Return the fields of an element with new names of symbols, bodies and nodes."""
    ways = {"thermal_mass": body, "node": node, "input": words.__getitem__}
    made = {**element.model_dump(exclude_none=True), **relawed(element, words)}
    if hasattr(element, "states"):
        made["states"] = {
            words[symbol]: state.model_copy(
                update={"between": state.between and tuple(map(node, state.between))}
            )
            for symbol, state in element.states.items()
        }
    for field, to, _ in (row for row in element.named() if row[0] != "states"):
        given = getattr(element, field)
        many = isinstance(given, tuple)
        made[field] = tuple(map(ways[to], given)) if many else ways[to](given)
    return made
