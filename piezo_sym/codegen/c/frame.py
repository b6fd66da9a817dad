"""The frame of a C function: its comment, its head, and the definitions at the start of its body.

Input: a `Program` and the arrays that functions take.  Output: the text of functions.  Those of a
module compute with `double`, those of a step with `real`: numbers of one run, or vectors of many.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.c.head import comment, declaration
from piezo_sym.codegen.c.lines import Words, Write, computing, indented, used_only, write_lines
from piezo_sym.codegen.c.parts import in_parts
from piezo_sym.codegen.layout import Places, places
from piezo_sym.codegen.program import Described, OutputRow, Program, Quantity, needed
from piezo_sym.expressions.tree import Expr

Definition = tuple[str, str]  # a name, and the line that defines it


@final
@dataclass(frozen=True)
class FunctionFrame:
    """The frame that the functions of one C file share."""

    program: Program
    arrays: Mapping[str, Sequence[Described]]  # the fields of each argument that is an array
    words: Mapping[str, str]  # the C name of each argument, and of the printer's own variables
    lines: Words
    taken: Collection[str]  # every name in use
    known: Collection[str] = ()  # names that bodies define themselves, although arguments hold them

    def function(
        self,
        name: str,
        arguments: Sequence[str],
        doc: str,
        body: Sequence[str],
        local: Sequence[Definition] = (),
    ) -> str:
        """Return a function; `local` definitions are at hand, besides those from its arguments."""
        definitions = [*self.sizes(), *local, *self._parameters()]
        for word in arguments:
            definitions += self._elements(word) if word in self.arrays else []
        unique: dict[str, str] = {}
        for defined, line in definitions:
            if defined not in self.known:
                unique.setdefault(defined, line)
        used = used_only(body, [*unique.items()], [self.words[word] for word in arguments])
        head = declaration(self.program, name, arguments, self.words, self.lines.number)
        return "\n".join([*comment(doc), head, "{", *indented([*used, *body]), "}"])

    def writing(
        self,
        name: str,
        arguments: Sequence[str],
        doc: str,
        quantities: Sequence[Quantity],
        writes: Sequence[Write],
        *,
        first: Sequence[str] = (),
        last: Sequence[str] = (),
        roots: Sequence[Expr] = (),
        local: Sequence[Definition] = (),
    ) -> str:
        """Return a function that computes and writes; a large one calls parts, printed before it.

        Parameters
        ----------
        first, last : the caller's lines, before and after the rest.
        roots : the expressions that these lines need.
        local : as in `function`.
        """
        wanted = needed(quantities, [*roots, *(write.value for write in writes)])[0]
        fields = [array for word, array in self.arrays.items() if word != "u"]
        groups, left = in_parts(wanted, writes, fields)
        texts, calls = list[str](), list[str]()
        given = ", ".join(self.words[word] for word in arguments)
        for n, group in enumerate(groups, 1):
            part, what = f"{name}_part_{n}", f"Part {n} of {len(groups)} of `{name}`"
            inner = self.computed(quantities, group)
            texts.append(self.function(part, arguments, what, inner, local))
            calls.append(f"{self.program.name}_{part}({given});")
        own = [*first, *calls, *self.computed(quantities, left, roots), *last]
        return "\n\n".join([*texts, self.function(name, arguments, doc, own, local)])

    def sizes(self) -> Iterator[Definition]:
        """Yield the sizes of banks."""
        for bank in self.program.counts:
            yield f"{bank}_count", f"const long {bank}_count = {self.words['p']}->{bank}_count;"

    def _parameters(self) -> Iterator[Definition]:
        for field in self.program.parameters:
            name, star = self.lines.names[field.name], "*restrict " if field.bank else ""
            yield name, f"const {self.lines.number} {star}{name} = {self.words['p']}->{name};"

    def _elements(self, word: str) -> Iterator[Definition]:
        """Yield the definitions of the fields of an array, a bank's as a pointer to its lanes."""
        fields, array, number = self.arrays[word], self.words[word], self.lines.number
        at = self.layout(word, [field.slot for field in fields])
        yield from ends(at)
        for n, field in enumerate(fields):
            name, place = self.lines.names[field.name], at.positions[n]
            pointer = f"const {number} *restrict {name} = {array} + {place};"
            yield name, pointer if field.bank else f"const {number} {name} = {array}[{place}];"

    def layout(self, word: str, slots: Sequence[Slot]) -> Places:
        """Return the places of the rows of an array."""
        return places(slots, f"end_{word}", self.taken)

    def writes(self, word: str, rows: Sequence[OutputRow]) -> tuple[list[Write], list[Definition]]:
        """Return the writes of rows to an array, and the definitions that they use."""
        at = self.layout(word, [row.slot for row in rows])
        writes = [
            Write(f"{self.words[word]}[{self.place(at, n)}]", row.value, row.slot.bank)
            for n, row in enumerate(rows)
            if not row.listed
        ]
        return writes, [*ends(at)]

    def place(self, at: Places, n: int, lane: str = "") -> str:
        """Return the place of slot n; for a bank, in lane `lane`, or else in the loop's lane."""
        first, lane = at.positions[n], lane or self.words["j"]
        if not at.slots[n].bank:
            return first
        return lane if first == "0" else f"{first} + {lane}"

    def computed(
        self,
        quantities: Sequence[Quantity],
        writes: Sequence[Write],
        roots: Sequence[Expr] = (),
    ) -> list[str]:
        """Return the lines that compute what `writes` and `roots` need, and write."""
        wanted = needed(quantities, [*roots, *(write.value for write in writes)])[0]
        body = [*computing(wanted, writes, self.program.counts, self.lines)]
        last = [line for w in writes if not w.bank for line in write_lines(w, self.lines)]
        return [*body, *(["/* result */"] if last and body else []), *last]


def ends(at: Places) -> Iterator[Definition]:
    """Yield the definitions of the ends of banks that have names."""
    yield from ((name, f"const long {name} = {end};") for name, end in at.ends.items())
