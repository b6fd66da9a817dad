"""Program to a NumPy module: plain text that imports NumPy alone.

Input: a `Program`.  Output: the text of ``<model>.py``, with the interface of the contracts:
arrays of shape (n, *batch), banks spread.  Words of a spec reach the text only as checked
identifiers or inside string literals.
"""

import re
from collections.abc import Collection, Iterator, Sequence
from itertools import accumulate
from typing import final

from piezo_sym.codegen.layout import Places, places, size_in_words, term_lines
from piezo_sym.codegen.numpy.head import RATES, head
from piezo_sym.codegen.numpy.style import NUMPY, divisors, numpy_text
from piezo_sym.codegen.program import (
    Entry,
    ModuleFunction,
    OutputRow,
    Program,
    Quantity,
    bank_of,
    banks_of,
    jacobian_roots,
    needed,
)
from piezo_sym.expressions.text import PRODUCT, UNARY, enclose, piece
from piezo_sym.expressions.tree import ZERO, Add, Expr, LaneSum, Node, Sym, names, rename
from piezo_sym.spec.names import fresh

WIDTH = 96
#: `np.where` computes both sides of a choice, and the other may be a root of a negative number.
QUIET = '@np.errstate(divide="ignore", invalid="ignore")'
PARTIAL = re.compile(r"/|\*\*\(|np\.(sqrt|log|power)")


def numpy_module(program: Program) -> str:
    """Return the text of a program's NumPy module."""
    printer = _Printer(program)
    functions = [*map(printer.function, program.functions), printer.jacobian(), printer.margins()]
    parts = [head(program, "\n".join(functions)), *functions]
    return "\n\n\n".join(part.strip("\n") for part in parts) + "\n"


@final
class _Printer:
    """Prints the functions of one program."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self.lanes = program.lane_names()
        self.parameters = frozenset(field.name for field in program.parameters)
        margins = (limit.margin for limit in program.limits if limit.strict)
        self.positive = frozenset(m.name for m in margins if isinstance(m, Sym))
        self.arrays = _names_with_lane_axis(program)
        words = {word: fresh(word, program.taken) for word in ("x", "u", "p", "out", "lanes")}
        self.x, self.u, self.p, self.out, self.index = words.values()
        self.words = words
        self.states = places([field.slot for field in program.states], "end", program.taken)

    def function(self, function: ModuleFunction) -> str:
        """Return one function of the module."""
        if function.name == "rhs":
            return f"{RATES}\n\n\n{self._rates(function)}"
        roots = [tree for row in function.rows for tree in (row.listed or (row.value,))]
        doc = f"{function.doc}; shape {_shape(function)}"
        if function.scalar:
            value = function.rows[0].value
            zero = f"np.zeros({self.x}.shape[1:])"
            text = f"{value.name}.copy()" if isinstance(value, Sym) else numpy_text(value)
            result = [f"return {zero if value == ZERO else text}"]
            return self._computing(function.name, function.arguments, doc, roots, result)
        rows = self._rows(function)
        result = [] if rows is self.states else [*rows.definitions()]
        initial = function.name == "initial_state"
        empty = f"np.empty(({rows.size}, *{self.x}.shape[1:]))"
        result.append(f"{self.out} = {f'np.zeros({rows.size})' if initial else empty}")
        for n, row in enumerate(function.rows):
            if initial and row.value == ZERO and not row.listed:
                continue
            text = self._listed(row) if row.listed else numpy_text(row.value)
            result += _assignment(f"{self.out}[{rows.index(n)}]", text, row.value)
        result.append(f"return {self.out}")
        listed = {name for row in function.rows for part in row.listed for name in names(part)}
        return self._computing(function.name, function.arguments, doc, roots, result, listed)

    def _rates(self, function: ModuleFunction) -> str:
        """Return the function that writes the rates of a batch, or of a part of it."""
        doc = "Write the rates dx/dt into `out`"
        roots, result = [row.value for row in function.rows], list[str]()
        for n, row in enumerate(function.rows):
            target = f"{self.out}[{self.states.index(n)}]"
            result += _assignment(target, numpy_text(row.value), row.value)
        return self._computing("_rates", ("x", "u", "p", "out"), doc, roots, result)

    def jacobian(self) -> str:
        """Return the function that fills the Jacobian."""
        doc = "Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)"
        roots = tuple(jacobian_roots(self.program.jacobian))
        result = [f"{self.out} = np.zeros(({self.x}.shape[0], *{self.x}.shape))"]
        for entry in self.program.jacobian:
            result += self._entry(entry)
        result.append(f"return {self.out}")
        return self._computing("jacobian", ("x", "u", "p"), doc, roots, result)

    def margins(self) -> str:
        """Return the function of the margins, by which the conditions of the domain hold."""
        limits = self.program.limits
        doc = "Margin by which each condition of DOMAIN holds; of a bank, the least one"
        doc += "; shape (len(DOMAIN), *batch)"
        result = [f"{self.out} = np.empty(({len(limits)}, *{self.x}.shape[1:]))"]
        parameters = {field.name for field in self.program.parameters if field.bank}
        for n, limit in enumerate(limits):
            text = numpy_text(limit.margin)
            if bank_of(limit.margin, self.lanes):
                constant = {*names(limit.margin)} <= parameters
                text = f"np.min({text if constant else self._with_lane_axis(limit.margin)}, axis=0)"
                result.append(f"{self.out}[{n}] = {text}")
            else:
                result += _assignment(f"{self.out}[{n}]", text, limit.margin)
        result.append(f"return {self.out}")
        roots = [limit.margin for limit in limits]
        return self._computing("margins", ("x", "u", "p"), doc, roots, result)

    def _computing(
        self,
        name: str,
        arguments: Sequence[str],
        doc: str,
        roots: Collection[Node],
        result: Sequence[str],
        listed: Collection[str] = (),
    ) -> str:
        """Return a function: its head, unpacked arguments, the quantities it needs, its result."""
        quantities, used = needed(self.program.quantities, roots)
        words = [self.words[argument] for argument in arguments]
        lines = [f"def {name}({', '.join(words)}, /):", f'"""{doc}."""']
        driven = any(field.name in used for field in self.program.inputs)
        given = [word for word in words if word == self.x or (word == self.u and driven)]
        given = [] if name == "_rates" else given
        check = {self.x: f"_states({self.x}, {self.p})", self.u: f"_inputs({self.u})"}
        lines += [f"{word} = {check[word]}" for word in given]
        lines += [f"{bank}_count = {self.p}.{bank}_count" for bank in self.program.counts]
        lines += self.states.definitions()
        dimensions = f"{self.x}.ndim" if "x" in arguments else "1"
        floats = divisors(roots, quantities, self.parameters, self.positive).difference(listed)
        lines += self._unpacking(used, dimensions, listed, floats)
        note = ""
        for quantity in quantities:
            if quantity.note != note:
                note = quantity.note
                lines.append(f"# {note}")
            lines += self._definition(quantity)
        alone = len(result) == 1 and name != "_rates"  # the one line of a scalar
        lines += ["# result"] if quantities and not alone else []
        text = "\n".join([lines[0], *(f"    {line}" for line in (*lines[1:], *result))])
        return f"{QUIET}\n{text}" if any(map(PARTIAL.search, _choices(text))) else text

    def _unpacking(
        self,
        used: frozenset[str],
        dimensions: str,
        listed: Collection[str],
        floats: Collection[str],
    ) -> Iterator[str]:
        """Yield the lines that unpack used names from arguments.

        Those `listed` are made arrays, and `floats` NumPy's numbers.
        """
        program = self.program
        for field in (field for field in program.parameters if field.name in used):
            value = f"{self.p}.{field.name}"
            if field.bank:
                ones = f"*np.ones({field.bank}_count)" if field.name in listed else ""
                value = f"_lanes({value}, {field.bank}_count, {dimensions}){ones}"
            elif field.name in floats:
                value = f"np.float64({value})"
            yield f"{field.name} = {value}"
        for n, slot in enumerate(self.states.slots):
            if slot.label in used:
                yield f"{slot.label} = {self.x}[{self.states.index(n)}]"
        for n, field in enumerate(program.inputs):
            if field.name in used:
                yield f"{field.name} = {self.u}[{n}]"

    def _definition(self, quantity: Quantity) -> list[str]:
        text = numpy_text(quantity.value)
        if isinstance(quantity.value, LaneSum):
            text = f"np.sum({self._with_lane_axis(quantity.value.arg)}, axis=0)"
        return _assignment(quantity.name, text, quantity.value)

    def _with_lane_axis(self, value: Expr) -> str:
        """Return an expression's text, with an axis of lanes even if its parameters have none."""
        text = piece(value, NUMPY)
        if bank_of(value, self.arrays):
            return text[0]
        bank = bank_of(value, self.lanes)
        ones = f"np.ones(({bank}_count, *(1,) * ({self.x}.ndim - 1)))"
        return f"{enclose(text, PRODUCT)}*{ones}"

    def _listed(self, row: OutputRow) -> str:
        """Return the tuple of a row's values per lane, each with the parameters of its lane."""
        parts = list[str]()
        for lane, value in enumerate(row.listed):
            items = {name: f"{name}[{lane}]" for name in names(value) if name in self.lanes}
            parts.append(numpy_text(rename(value, items)))
        return f"({', '.join(parts)})"

    def _rows(self, function: ModuleFunction) -> Places:
        """Return the places of a function's rows."""
        slots = [row.slot for row in function.rows]
        if slots == self.states.slots:
            return self.states
        return places(slots, "end", [*self.program.taken, *self.states.ends])

    def _entry(self, entry: Entry) -> Iterator[str]:
        rows, cols = self.states.slots[entry.row], self.states.slots[entry.col]
        place = f"{self.states.index(entry.row)}, {self.states.index(entry.col)}"
        same = rows.bank is not None and rows.bank == cols.bank
        joint = "="
        for outer in entry.outer:
            left = self._factor(outer.left, ":, None")
            right = self._factor(outer.right, "None")
            yield f"{self.out}[{place}] {joint} {left}*{right}"
            joint = "+="
        if entry.value == ZERO:
            return
        if same:
            first, last = self.states.bounds(entry.row)
            yield f"{self.index} = np.arange({first}, {last})"
            second = self.states.positions[entry.col]
            shift = "" if entry.row == entry.col else f" + ({second} - ({first}))"
            place = f"{self.index}, {self.index}{shift}"
        lines = _assignment(f"{self.out}[{place}]", numpy_text(entry.value), entry.value)
        yield lines[0].replace(" = ", f" {joint} ", 1)
        yield from lines[1:]

    def _factor(self, value: Expr, index: str) -> str:
        """Return a factor of a product over pairs of lanes, its lanes along one of two axes."""
        if bank_of(value, self.lanes) is None:
            return enclose(piece(value, NUMPY), UNARY)
        return f"({self._with_lane_axis(value)})[{index}]"


def _assignment(target: str, text: str, value: Expr) -> list[str]:
    """Return an assignment; a sum that is too long for a line gets one line per term."""
    if len(target) + len(text) + 7 <= WIDTH or not isinstance(value, Add):
        return [f"{target} = {text}"]
    terms = term_lines(value, lambda part: piece(part, NUMPY))
    return [f"{target} = (", *(f"    {term}" for term in terms), ")"]


def _names_with_lane_axis(program: Program) -> dict[str, str]:
    """Return the bank of every name whose value has an axis of lanes, since a state is in it.

    A value of parameters alone may be one number for all lanes.
    """
    lanes = banks_of(program.states)
    for quantity in program.quantities:
        if quantity.bank and bank_of(quantity.value, lanes):
            lanes[quantity.name] = quantity.bank
    return lanes


def _choices(text: str) -> Iterator[str]:
    """Yield the arguments of each call of `np.where`."""
    for part in text.split("np.where(")[1:]:
        depths = accumulate(((c == "(") - (c == ")") for c in part), initial=1)
        yield part[: next((n for n, depth in enumerate(depths) if not depth), None)]


def _shape(function: ModuleFunction) -> str:
    """Return the shape of a result, for its docstring."""
    if function.scalar:
        return "(*batch)"
    if function.name == "initial_state":
        return "(n,)"
    return f"({size_in_words([row.slot for row in function.rows])}, *batch)"
