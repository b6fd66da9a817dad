"""Where the rows of a flat model stand in the spec as it was written, and their names there.

Input: places such as ``elements.left_out.current`` and names such as ``left_R`` of a flat model.
Output: ``components.left: elements.out.current`` and ``R``.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import final

from piezo_sym.errors import PiezoError

PLACE = re.compile(r"(?:elements|parameters|inputs|initial)\.\w+|domain\.assume\[\d+\]")


@final
@dataclass(frozen=True)
class Within:
    """A component that contains a row: its place, its own names for names and nodes outside."""

    place: str
    front: str  # of nodes that have its name in front
    words: Mapping[str, str]
    nodes: Mapping[str, str]
    spec: str = ""  # the file or shipped name of its spec


@final
@dataclass(frozen=True)
class Origin:
    """The place of a row as it was written, and the components around it, outermost first."""

    place: str
    within: tuple[Within, ...] = ()


@final
@dataclass(frozen=True)
class Origins:
    """The origins of the rows of a model; equality of models does not depend on them."""

    rows: dict[str, Origin] = field(default_factory=dict, compare=False)

    def of(self, row: str) -> Origin:
        """Return the origin of a row, such as ``elements.left_out``."""
        return self.rows.get(row) or Origin(row)

    def written(self, text: str) -> str:
        """Return a text with its places as they were written."""
        return PLACE.sub(lambda match: self.of(match[0]).place, text)

    def name(self, where: str, name: str) -> str:
        """Return a name as it was written at the origin of a place of the flat model."""
        for part in self._within(where):
            name = part.words.get(name, name)
        return name

    def spec(self, where: str) -> str:
        """Return the spec of the component that a place is in, as a spec names it, or ''."""
        return next((part.spec for part in reversed(self._within(where))), "")

    def node(self, where: str, node: str) -> str:
        """Return the place in [components] that connects a node of an element to ours, or ''."""
        around = ""
        for part in self._within(where):
            if node in part.nodes:
                return f"{around}{part.place}.nodes.{part.nodes[node]}"
            node, around = node.removeprefix(part.front), f"{around}{part.place}: "
        return ""

    def put_in(self, error: PiezoError) -> None:
        """Write the places in an error as they were written."""
        for part in ("what", "where", "expected", "remedy"):
            setattr(error, part, self.written(getattr(error, part)))
        error.__notes__ = [self.written(note) for note in getattr(error, "__notes__", ())]

    def _within(self, where: str) -> tuple[Within, ...]:
        row = PLACE.match(where)
        return self.of(row[0]).within if row else ()
