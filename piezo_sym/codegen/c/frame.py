"""The frame of a C function: its comment, its head, and what its body unpacks of its arguments.

Input: a `Program` and the arrays that functions take.  Output: the text of functions.  `double`
functions are those of a module, `real` ones those of a step: for one run, or for vectors of many.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.c.head import comment, declaration
from piezo_sym.codegen.c.lines import Words, indented, stage_lines, used_only, write_lines
from piezo_sym.codegen.c.order import Write, stages
from piezo_sym.codegen.layout import Places, places
from piezo_sym.codegen.program import Described, OutputRow, Program, Quantity, needed
from piezo_sym.expressions.tree import Expr

Definition = tuple[str, str]  # a name, and the line that defines it


@final
@dataclass(frozen=True)
class FunctionFrame:
    """What the functions of one C file have in common.

    Attributes
    ----------
    arrays : of each argument that is an array, what it holds.
    words : the C name of each argument, and of what the printer adds.
    taken : every name in use.
    """

    program: Program
    arrays: Mapping[str, Sequence[Described]]
    words: Mapping[str, str]
    lines: Words
    taken: Collection[str]

    def function(
        self,
        name: str,
        arguments: Sequence[str],
        doc: str,
        body: Sequence[str],
        *,
        local: Sequence[Definition] = (),
        known: Collection[str] = (),
    ) -> str:
        """Return a function.

        Parameters
        ----------
        local : what the body may use besides its arguments.
        known : names that the body defines itself, though an argument holds them.
        """
        definitions = [*self.sizes(), *local, *self._parameters()]
        for word in arguments:
            definitions += self._elements(word) if word in self.arrays else []
        once: dict[str, str] = {}
        for defined, line in definitions:
            once.setdefault(defined, line)
        kept = used_only(
            body,
            [item for item in once.items() if item[0] not in known],
            [self.words[word] for word in arguments],
        )
        head = declaration(self.program, name, arguments, self.words, self.lines.number)
        return "\n".join([*comment(doc), head, "{", *indented([*kept, *body]), "}"])

    def sizes(self) -> Iterator[Definition]:
        """Yield the sizes of banks."""
        for bank in self.program.counts:
            yield f"{bank}_count", f"const long {bank}_count = {self.words['p']}->{bank}_count;"

    def _parameters(self) -> Iterator[Definition]:
        for field in self.program.parameters:
            name, star = self.lines.names[field.name], "*restrict " if field.bank else ""
            yield name, f"const {self.lines.number} {star}{name} = {self.words['p']}->{name};"

    def _elements(self, word: str) -> Iterator[Definition]:
        """Yield what an array holds, a bank's as a pointer to its lanes."""
        fields, array, number = self.arrays[word], self.words[word], self.lines.number
        at = self.layout(word, [Slot(field.name, field.bank) for field in fields])
        yield from ends(at)
        for n, field in enumerate(fields):
            name, place = self.lines.names[field.name], at.position(n)
            pointer = f"const {number} *restrict {name} = {array} + {place};"
            yield name, pointer if field.bank else f"const {number} {name} = {array}[{place}];"

    def layout(self, word: str, slots: Sequence[Slot]) -> Places:
        """Return where the rows of an array stand."""
        return places(slots, f"end_{word}", self.taken)

    def writes(self, word: str, rows: Sequence[OutputRow]) -> tuple[list[Write], list[Definition]]:
        """Return what writes rows to an array, and the ends of banks that it uses."""
        at = self.layout(word, [row.slot for row in rows])
        found = [
            Write(f"{self.words[word]}[{self.place(at, n)}]", row.value, row.slot.bank)
            for n, row in enumerate(rows)
            if not row.listed
        ]
        return found, [*ends(at)]

    def place(self, at: Places, n: int, lane: str = "") -> str:
        """Return the place of slot n, of the loop's lane if it is a bank's."""
        first, lane = at.position(n), lane or self.words["j"]
        if not at.slots[n].bank:
            return first
        return lane if first == "0" else f"{first} + {lane}"

    def computed(
        self,
        quantities: Sequence[Quantity],
        writes: Sequence[Write],
        roots: Sequence[Expr] = (),
        lines: Words | None = None,
    ) -> list[str]:
        """Return the lines that compute what is needed, and write it."""
        words = lines or self.lines
        wanted = needed(quantities, [*roots, *(write.value for write in writes)])[0]
        found = stages(wanted, writes, self.program.counts)
        body = [line for stage in found for line in stage_lines(stage, words)]
        last = [line for w in writes if not w.bank for line in write_lines(w, words)]
        return [*body, *(["/* result */"] if last and body else []), *last]


def ends(at: Places) -> Iterator[Definition]:
    """Yield the definitions of where banks end, if these have names."""
    yield from ((line.split()[0], f"const long {line};") for line in at.definitions())
