"""Program to C99: one source file of functions of one state, without allocation and globals.

Input: a `Program`.  Output: the text of ``<model>.c``.  Its loops over lanes are made to be
vectorised; rows of a bank are written in the loop that also adds up the sums, where they can be.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.c.head import FUNCTIONS, declaration, opening, text_of
from piezo_sym.codegen.c.lines import (
    Words,
    define,
    indented,
    stage_lines,
    statement,
    used_only,
    write_lines,
)
from piezo_sym.codegen.c.names import added, c_names
from piezo_sym.codegen.c.order import Write, lane_quantities, stages
from piezo_sym.codegen.c.style import helpers
from piezo_sym.codegen.layout import Places, places
from piezo_sym.codegen.program import (
    Entry,
    Function,
    Outer,
    Program,
    Row,
    bank_of,
    jacobian_roots,
    needed,
)
from piezo_sym.expressions.tree import ZERO, Expr, Neg, Num


def c_source(program: Program) -> str:
    """Return the text of a program's C source file."""
    printer = _Printer(program)
    functions = [*printer.sizes(), *map(printer.function, program.functions)]
    functions += [printer.jacobian(), printer.margins()]
    parts = [
        f'{opening(program)}\n#include "{program.name}.h"\n\n#include <math.h>',
        *helpers("\n".join(functions)),
        *functions,
    ]
    return "\n\n".join(parts) + "\n"


@final
class _Printer:
    """Prints the functions of one program."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self.lanes = program.lane_names()
        self.names = c_names(program)
        self.words = added(("x", "u", "p", "out", "n", "j", "l", "left"), program, self.names)
        fields = (*program.parameters, *program.states)
        arrays = {field.name: field.bank for field in fields if field.bank}
        self.lines = Words(self.names, arrays, self.words["j"])
        slots = [Slot(field.name, field.bank) for field in program.states]
        self.states = places(slots, "end", program.taken)
        self.out, self.n, self.j = (self.words[word] for word in ("out", "n", "j"))

    # Functions

    def sizes(self) -> Iterator[str]:
        """Yield the functions that tell how many states and processes there are."""
        for name, fields in (
            ("states", self.program.states),
            ("processes", self.program.processes),
        ):
            rows = places([Slot(f.name, f.bank) for f in fields], "row", self.program.taken)
            body = [f"return {rows.size};"]
            yield self._function(name, ("p",), body, [*self._places(rows)])

    def function(self, function: Function) -> str:
        """Return one function with a row a slot."""
        if function.scalar:
            body = self._computed([function.rows[0].value], [])
            body += statement("return", function.rows[0].value, self.lines)
            return self._function(function.name, function.arguments, body)
        slots = [row.slot for row in function.rows]
        same = slots == self.states.slots
        rows = self.states if same else places(slots, "row", self.program.taken)
        plain = [(n, row) for n, row in enumerate(function.rows) if not row.listed]
        writes = [self._write(rows, n, row.slot, row.value) for n, row in plain]
        ends = [] if same else [*self._places(rows)]
        body = self._computed([], writes)
        for n, row in enumerate(function.rows):
            body += self._listed(rows, n, row) if row.listed else []
        return self._function(function.name, (*function.arguments, "out"), body, ends)

    def jacobian(self) -> str:
        """Return the function that fills the Jacobian, row after row."""
        entries, n, j = self.program.jacobian, self.n, self.j
        writes = [self._entry(entry) for entry in entries if entry.value != ZERO]
        roots = list(jacobian_roots(self.program.jacobian))
        body = [f"for (long {j} = 0; {j} < {n}*{n}; ++{j}) {{"]
        body += [f"    {self.out}[{j}] = 0.0;", "}"]
        body += self._computed(roots, writes)
        for entry in entries:
            for outer in entry.outer:
                body += self._outer(entry, outer)
        size = [(n, f"const long {n} = {self.states.size};")]
        return self._function("jacobian", ("x", "u", "p", "out"), body, size)

    def margins(self) -> str:
        """Return the function that tells how far inside its domain a state is."""
        writes = []
        for n, limit in enumerate(self.program.limits):
            bank = bank_of(limit.margin, self.lanes)
            how = "min" if bank else "="
            writes.append(Write(f"{self.out}[{n}]", limit.margin, bank, how))
        body = self._computed([], writes)
        return self._function("margins", ("x", "u", "p", "out"), body)

    # Parts of a function

    def _function(
        self,
        name: str,
        arguments: Sequence[str],
        body: Sequence[str],
        more: Sequence[tuple[str, str]] = (),
    ) -> str:
        """Return a function from its body, with what the body uses unpacked."""
        definitions = [*self._sizes(), *more, *self._unpacked()]
        given = [self.words[argument] for argument in arguments]
        lines = [*used_only(body, definitions, given), *body]
        doc = f"/* {text_of(self._doc(name))}. */"
        head = declaration(self.program, name, arguments, self.words, restrict="restrict ")
        return "\n".join([doc, head, "{", *indented(lines), "}"])

    def _doc(self, name: str) -> str:
        docs = {function.name: function.doc for function in self.program.functions}
        return docs.get(name) or FUNCTIONS[name]

    def _computed(self, roots: Iterable[Expr], writes: Sequence[Write]) -> list[str]:
        """Return the lines that compute what is needed, and write it."""
        wanted = [*roots, *(write.value for write in writes)]
        quantities = needed(self.program.quantities, wanted)[0]
        found = stages(quantities, writes, self.program.counts)
        lines = [line for stage in found for line in stage_lines(stage, self.lines)]
        last = [line for w in writes if not w.bank for line in write_lines(w, self.lines)]
        return [*lines, *(["/* result */"] if last and lines else []), *last]

    def _sizes(self) -> Iterator[tuple[str, str]]:
        """Yield the sizes of banks, and where the states of many banks end."""
        p = self.words["p"]
        for bank in self.program.counts:
            yield f"{bank}_count", f"const long {bank}_count = {p}->{bank}_count;"
        yield from self._places(self.states)

    def _places(self, rows: Places) -> Iterator[tuple[str, str]]:
        yield from ((line.split()[0], f"const long {line};") for line in rows.definitions())

    def _unpacked(self) -> Iterator[tuple[str, str]]:
        program, names = self.program, self.names
        x, u, p = (self.words[word] for word in ("x", "u", "p"))
        for field in program.parameters:
            kind = "const double *restrict " if field.bank else "const double "
            name = names[field.name]
            yield name, f"{kind}{name} = {p}->{name};"
        for n, field in enumerate(program.states):
            name, place = names[field.name], self.states.position(n)
            value = f"const double *{name} = {x} + {place};"
            yield name, value if field.bank else f"const double {name} = {x}[{place}];"
        for n, field in enumerate(program.inputs):
            yield names[field.name], f"const double {names[field.name]} = {u}[{n}];"

    def _row(self, rows: Places, n: int, lane: str = "") -> str:
        """Return the place of slot n, of the loop's lane if it is a bank's."""
        first = rows.position(n)
        if not rows.slots[n].bank:
            return first
        lane = lane or self.j
        return lane if first == "0" else f"{first} + {lane}"

    def _write(self, rows: Places, n: int, slot: Slot, value: Expr) -> Write:
        return Write(f"{self.out}[{self._row(rows, n)}]", value, slot.bank)

    def _listed(self, rows: Places, n: int, row: Row) -> Iterator[str]:
        """Yield the lines that write values listed a lane; lanes beyond the list are NAN."""
        name, size = f"{self.names[row.slot.label]}_listed_", len(row.listed)
        fixed = all(isinstance(v.arg if isinstance(v, Neg) else v, Num) for v in row.listed)
        yield f"{'static ' if fixed else ''}const double {name}[{size}] = {{"
        yield from (f"    {self.lines.text(v, str(j))}," for j, v in enumerate(row.listed))
        yield "};"
        yield f"for (long {self.j} = 0; {self.j} < {row.slot.bank}_count; ++{self.j}) {{"
        place = self._row(rows, n)
        yield f"    {self.out}[{place}] = {self.j} < {size} ? {name}[{self.j}] : (double)NAN;"
        yield "}"

    # Entries of the Jacobian

    def _place(self, entry: Entry, column_lane: str) -> str:
        """Return the place of an entry in the array, of the lanes of its row and column."""
        row, col = self._row(self.states, entry.row), self._row(self.states, entry.col, column_lane)
        start = f"({row})*{self.n}" if " " in row else f"{row}*{self.n}"
        start = {"0": "", "1": f"{self.n} + "}.get(row, f"{start} + ")
        return f"{self.out}[{start}{col}]"

    def _entry(self, entry: Entry) -> Write:
        slots = self.states.slots[entry.row], self.states.slots[entry.col]
        how = "+=" if entry.outer else "="
        return Write(self._place(entry, self.j), entry.value, slots[0].bank or slots[1].bank, how)

    def _outer(self, entry: Entry, outer: Outer) -> Iterator[str]:
        """Yield the loops that add a product over all pairs of lanes."""
        rows, cols = (self.states.slots[n].bank for n in (entry.row, entry.col))
        left, j, col = self.words["left"], self.j, self.words["l"]
        yield f"for (long {j} = 0; {j} < {rows}_count; ++{j}) {{"
        yield f"    double {left};"
        yield "    {"
        inner = [*self._lane(rows, outer.left, j)]
        inner += statement(f"{left} =", outer.left, self.lines)
        yield from indented(inner, 2)
        yield "    }"
        yield f"    for (long {col} = 0; {col} < {cols}_count; ++{col}) {{"
        inner = [*self._lane(cols, outer.right, col)]
        inner += statement(f"{self._place(entry, col)} += {left}*", outer.right, self.lines, col)
        yield from indented(inner, 2)
        yield from ("    }", "}")

    def _lane(self, bank: str | None, value: Expr, lane: str) -> Iterator[str]:
        """Yield the definitions of a lane's quantities that a value needs."""
        for quantity in lane_quantities(self.program.quantities, bank or "", [value]):
            yield from define(quantity, self.lines, lane)
