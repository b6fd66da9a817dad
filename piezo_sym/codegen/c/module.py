"""Program to C99: one source file of functions of one state, without allocation and globals.

Input: a `Program`.  Output: the text of ``<model>.c``.  Compilers can vectorise its loops over
lanes; where possible, rows of a bank are written in the loop that adds up the sums.
"""

from collections.abc import Iterator
from typing import final

from piezo_sym.codegen.c.frame import FunctionFrame, ends
from piezo_sym.codegen.c.head import FUNCTIONS, opening
from piezo_sym.codegen.c.lines import (
    Words,
    Write,
    define,
    indented,
    lane_quantities,
    least_over_lanes,
    statement,
)
from piezo_sym.codegen.c.style import c_names, fresh_names, helpers
from piezo_sym.codegen.program import (
    Entry,
    ModuleFunction,
    Outer,
    OutputRow,
    Program,
    bank_of,
    banks_of,
    jacobian_roots,
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
        self.program, self.lanes, names = program, program.lane_names(), c_names(program)
        words = fresh_names(("x", "u", "p", "out", "n", "j", "l", "left"), program, names)
        banks = banks_of((*program.parameters, *program.states))
        self.lines = Words(names, banks, words["j"])
        arrays = {"x": program.states, "u": program.inputs}
        self.frame = FunctionFrame(program, arrays, words, self.lines, program.taken)
        self.states = self.frame.layout("x", [field.slot for field in program.states])
        self.out, self.n, self.j = (words[word] for word in ("out", "n", "j"))

    def sizes(self) -> Iterator[str]:
        """Yield the functions that return the numbers of states and of processes."""
        counted = {"states": self.program.states, "processes": self.program.processes}
        for name, fields in counted.items():
            at = self.frame.layout("out", [field.slot for field in fields])
            body = [f"return {at.size};"]
            yield self.frame.function(name, ("p",), FUNCTIONS[name], body, [*ends(at)])

    def function(self, function: ModuleFunction) -> str:
        """Return one function of the module."""
        arguments, frame = function.arguments, self.frame
        if function.scalar:
            value = function.rows[0].value
            body = frame.computed(self.program.quantities, [], [value])
            body += statement("return", value, self.lines)
            return frame.function(function.name, arguments, function.doc, body)
        writes, local = frame.writes("out", function.rows)
        at, last = frame.layout("out", [row.slot for row in function.rows]), list[str]()
        for n, row in enumerate(function.rows):
            last += self._listed(frame.place(at, n), row) if row.listed else []
        name, arguments, doc = function.name, (*arguments, "out"), function.doc
        quantities = self.program.quantities
        return frame.writing(name, arguments, doc, quantities, writes, last=last, local=local)

    def jacobian(self) -> str:
        """Return the function that fills the Jacobian, row after row."""
        entries, n, j = self.program.jacobian, self.n, self.j
        writes = [self._entry(entry) for entry in entries if entry.value != ZERO]
        first = [f"for (long {j} = 0; {j} < {n}*{n}; ++{j}) {{"]
        first += [f"    {self.out}[{j}] = 0.0;", "}"]
        outer = [(entry, outer) for entry in entries for outer in entry.outer]
        return self.frame.writing(
            "jacobian",
            ("x", "u", "p", "out"),
            FUNCTIONS["jacobian"],
            self.program.quantities,
            writes,
            first=first,
            last=[line for entry, product in outer for line in self._outer(entry, product)],
            roots=[root for entry, _ in outer for root in jacobian_roots([entry])],
            local=[*ends(self.states), (n, f"const long {n} = {self.states.size};")],
        )

    def margins(self) -> str:
        """Return the function of the margins, by which the conditions of the domain hold."""
        writes = least_over_lanes(self.out, self.program.limits, self.lanes)
        body = self.frame.computed(self.program.quantities, [*writes])
        doc = FUNCTIONS["margins"]
        return self.frame.function("margins", ("x", "u", "p", "out"), doc, body)

    def _listed(self, place: str, row: OutputRow) -> Iterator[str]:
        """Yield the lines that write a list of values per lane; lanes beyond the list are NAN."""
        name, size = f"{self.lines.names[row.slot.label]}_listed_", len(row.listed)
        fixed = all(isinstance(v.arg if isinstance(v, Neg) else v, Num) for v in row.listed)
        yield f"{'static ' if fixed else ''}const double {name}[{size}] = {{"
        for j, value in enumerate(row.listed):
            text = self.lines.text(value, str(j))
            if bank_of(value, self.lines.arrays):  # do not read beyond the lanes of the run
                text = f"{j} < {row.slot.bank}_count ? {text} : (double)NAN"
            yield f"    {text},"
        yield "};"
        yield f"for (long {self.j} = 0; {self.j} < {row.slot.bank}_count; ++{self.j}) {{"
        yield f"    {self.out}[{place}] = {self.j} < {size} ? {name}[{self.j}] : (double)NAN;"
        yield "}"

    def _place(self, entry: Entry, column_lane: str) -> str:
        """Return the target of an entry: its row in the loop's lane, its column in another."""
        row = self.frame.place(self.states, entry.row)
        col = self.frame.place(self.states, entry.col, column_lane)
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
        left, j, col = self.frame.words["left"], self.j, self.frame.words["l"]
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
        """Yield the definitions of the quantities of a lane that a value needs."""
        for quantity in lane_quantities(self.program.quantities, bank or "", [value]):
            yield from define(quantity, self.lines, lane)
