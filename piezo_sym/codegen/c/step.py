"""A collocation step in C, for every width of ``real``: one number, or one of each of many runs.

Input: a `Program` and its `Collocation`.  Output: the text of ``<model>_step.c``: the means'
integrands, a stage, the slopes, and the tables by which equations are eliminated; `run/engine`
drives them.  Nothing is compared there: branches are given, so the text holds for vectors too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.c.head import opening
from piezo_sym.codegen.c.lines import Words, indented, stage_lines, statement, used_only
from piezo_sym.codegen.c.names import added, c_names
from piezo_sym.codegen.c.order import Write, stages
from piezo_sym.codegen.c.paths import path_rows, path_table
from piezo_sym.codegen.c.real import REAL, powers_of
from piezo_sym.codegen.c.record import comment, give_text, place_text, record_text
from piezo_sym.codegen.collocation import Collocation
from piezo_sym.codegen.coupling import coupling_of, table
from piezo_sym.codegen.layout import Places, places
from piezo_sym.codegen.program import Field, Program, Quantity, Row, bank_of, needed
from piezo_sym.expressions.tree import names

NOTE = """\
/*
 * One step of energy-preserving Gauss collocation. The row `program` of the proofs covers the
 * functions `integrands` and `stage`; the others and the tables serve Newton's method.
 */"""


def c_step(program: Program, made: Collocation) -> str:
    """Return the text of a model's collocation step."""
    printer = _Printer(program, made)
    functions = [
        printer.integrands(),
        *printer.bends(),
        printer.stage(),
        printer.slopes(),
        printer.sizes(),
        *printer.paths(),
        place_text(program, printer.names),
        give_text(program, printer.names),
    ]
    text = "\n\n".join(functions)
    head = f'{opening(program)}\n{NOTE}\n#include "{program.name}.h"\n\n#include <math.h>'
    record = record_text(program, printer.names)
    return "\n\n".join([head, REAL, record, *powers_of(text), text, printer.tables()]) + "\n"


@final
class _Printer:
    """Prints the functions of one model's step."""

    def __init__(self, program: Program, made: Collocation) -> None:
        self.program, self.made, self.name = program, made, program.name
        stage, slopes = made.stage, made.slopes
        self.means = [Field(mean.name, "", "", mean.bank) for mean in made.means]
        self.given = [*self.means, *(field for path in made.paths for field in path.given())]
        self.branches = [Field(s.branch, "", "", s.bank) for s in stage.switches]
        both = {q.name: q for q in (*stage.quantities, *slopes.quantities)}
        whole = replace(
            program,
            states=(*program.states, *self.given, *self.branches),
            quantities=tuple(both.values()),
            taken=stage.taken | slopes.taken,
        )
        self.names = c_names(whole)
        self.words = added(
            ["x", "g", "b", "u", "p", "out", "rows", "s", "m", "j"], whole, self.names
        )
        fields = (*program.parameters, *whole.states)
        self.arrays = {field.name: field.bank for field in fields if field.bank}
        self.lines = Words(self.names, self.arrays, self.words["j"], "real")
        means = {mean.name for mean in self.means}  # slopes compute them
        own = {name: bank for name, bank in self.arrays.items() if name not in means}
        self.slope_lines = Words(self.names, own, self.words["j"], "real")
        self.coupling = coupling_of(program, slopes)

    # Functions

    def integrands(self) -> str:
        """Return what co-states that are given to a stage are means of."""
        rows = [Row(Slot(mean.name, mean.bank), mean.value) for mean in self.made.means]
        doc = (
            "Functions of the state whose weighted means over a step are the means g of its stages"
        )
        body = self._computed((), self._writes(rows, "out"), self.lines)
        return self._function("integrands", doc, "x p out", body, [*self._ends(rows)])

    def bends(self) -> Iterator[str]:
        """Yield the function that tells where integrands have kinks, if they have some."""
        rows = self.made.stage.bends
        doc = "Functions of the state that change their sign where integrands have kinks"
        if rows:
            body = self._computed((), self._writes(rows, "out"), self.lines)
            yield self._function("bends", doc, "x p out", body, [*self._ends(rows)])

    def stage(self) -> str:
        """Return the function of a stage: rates, what the ledger books, switching functions."""
        stage = self.made.stage
        rates = self._writes(stage.rates, "out")
        booked = self._writes(stage.booked, "rows")
        switches = [Row(Slot(s.branch, s.bank), s.value) for s in stage.switches]
        writes = [*self._writes(switches, "s"), *rates, *booked, *self._margins()]
        doc = (
            "A stage, for the state x, means g, branches b of laws, and inputs u. Writes the rates "
            "of the state to out; to rows, for the ledger, the power of ports, heat and entropy "
            "production of processes, and entropy rate of heat exchanges; to s the switching "
            "functions, whose signs decide the branches; to m the margins of those conditions of "
            "the domain that depend on the state"
        )
        body = self._computed(stage.quantities, writes, self.lines)
        ends = [*self._ends(stage.rates), *self._ends(stage.booked), *self._ends(switches)]
        return self._function("stage", doc, "x g b u p out rows s m", body, ends)

    def _margins(self) -> Iterator[Write]:
        """Yield the margins of the domain that a stage can leave, least over lanes."""
        lanes = {**{q.name: q.bank for q in self.made.stage.quantities if q.bank}, **self.arrays}
        for n, limit in enumerate(self.made.stage.limits):
            bank = bank_of(limit.margin, lanes)
            target = f"{self.words['m']}[{n}]"
            yield Write(target, limit.margin, bank, "min" if bank else "=")

    def slopes(self) -> str:
        """Return the derivative of the rates by the state, in the places of `coupling`."""
        writes = []
        for place in self.coupling.places:
            target = self._at(place.shared, place.lanes, place.bank)
            writes.append(Write(f"{self.words['out']}[{target}]", place.value, place.bank))
        body = self._computed(self.made.slopes.quantities, writes, self.slope_lines)
        doc = "Derivative of the rates by the state, on branches b; the tables tell its entries"
        return self._function("slopes", doc, "x g b u p out", body)

    def paths(self) -> Iterator[str]:
        """Yield the table of path functionals, and the function of what they take, if any."""
        if self.made.paths:
            rows, doc = path_rows(self.made.paths), "Stiffness and limit of each path functional"
            body = self._computed((), self._writes(rows, "out"), self.lines)
            ends = [*self._ends(rows)]
            yield path_table(self.program, self.made.paths)
            yield self._function("path_parameters", doc, "x p out", body, ends)

    def sizes(self) -> str:
        """Return the function that tells how many numbers each array has."""
        stage = self.made.stage
        banks = [f"{bank}_count" for bank in self.program.counts]
        counted = {
            "states": [Slot(f.name, f.bank) for f in self.program.states],
            "means": [Slot(f.name, f.bank) for f in self.means],
            "branches": [Slot(f.name, f.bank) for f in self.branches],
            "booked": [row.slot for row in stage.booked],
            "processes": [Slot(f.name, f.bank) for f in self.program.processes],
        }
        out, body, ends = self.words["out"], list[str](), list[tuple[str, str]]()
        for n, (what, slots) in enumerate(counted.items()):
            at = places(slots, f"end_{what}", self.made.stage.taken)
            ends += ((line.split()[0], f"const long {line};") for line in at.definitions())
            body.append(f"{out}[{n}] = {at.size if slots else 0}; /* {what} */")
        total = self._at(self.coupling.shared, dict(self.coupling.sizes), None)
        body.append(f"{out}[{len(counted)}] = {total}; /* slopes */")
        first, states = len(counted) + 1, range(len(self.program.states))
        body += [f"{out}[{first + n}] = {count}; /* lanes */" for n, count in enumerate(banks)]
        at = places(counted["states"], "end_states", self.made.stage.taken)
        first += len(banks)
        body += [f"{out}[{first + n}] = {at.position(n)}; /* first row */" for n in states]
        if self.made.stage.bends:
            at = places([row.slot for row in self.made.stage.bends], "end_bends", stage.taken)
            ends += ((line.split()[0], f"const long {line};") for line in at.definitions())
            body.append(f"{out}[{first + len(states)}] = {at.size}; /* bends */")
        doc = "How many numbers there are of each kind; lanes of each bank; first row of each state"
        kept = used_only(body, [*self._counts(), *ends], [self.words["p"]])
        head = f"static void {self.name}_sizes(const {self.name}_reals *p, long *{out})"
        head = head.replace(" *p,", f" *{self.words['p']},")
        return "\n".join([*comment(doc), head, "{", *indented([*kept, *body]), "}"])

    def tables(self) -> str:
        """Return the tables by which the equations of a step are solved."""
        limits = [int(limit.strict) for limit in self.made.stage.limits]
        head = ["#define BENDS /* integrands have kinks: see run/engine */"]
        head = head if self.made.stage.bends else []
        head += ["enum {", f"    {self.name}_limits = {len(limits)}, /* margins of a stage */"]
        records = len(self.program.states)
        used = {name for mean in self.made.means for name in names(mean.value)}
        read = [n for n, state in enumerate(self.program.states) if state.name in used]
        head += [f"    {self.name}_reads = {len(read)}, /* states that integrands read */"]
        head += [f"    {self.name}_records = {records}, /* states, a bank's counted once */"]
        taker = f"{self.name}_heated = {self.made.heated}"
        head += [f"    {taker}, /* the state that takes a dissipative step's loss */"]
        head += [f"    {self.name}_jumps = {int(self.made.jumps)} /* whether a law jumps */", "};"]
        head += [*table(f"{self.name}_strict", limits), *table(f"{self.name}_read", read)]
        return "\n".join([*head, *self.coupling.tables(self.name)])

    # Parts

    def _writes(self, rows: Sequence[Row], word: str) -> list[Write]:
        at = places([row.slot for row in rows], f"row_{word}", self.made.stage.taken)
        array = self.words[word]
        return [
            Write(f"{array}[{self._row(at, n)}]", row.value, row.slot.bank)
            for n, row in enumerate(rows)
        ]

    def _ends(self, rows: Sequence[Row]) -> Iterator[tuple[str, str]]:
        """Yield the definitions of where banks end among rows, if these have names."""
        for word in ("out", "rows", "s"):
            at = places([row.slot for row in rows], f"row_{word}", self.made.stage.taken)
            yield from ((line.split()[0], f"const long {line};") for line in at.definitions())

    def _computed(
        self, quantities: Sequence[Quantity], writes: Sequence[Write], words: Words
    ) -> list[str]:
        wanted = needed(quantities, [write.value for write in writes])[0]
        found = stages(wanted, [w for w in writes if w.bank], self.program.counts)
        lines = [line for stage in found for line in stage_lines(stage, words)]
        for write in writes:
            if not write.bank:
                lines += statement(f"{write.target} =", write.value, words)
        return lines

    def _row(self, at: Places, n: int) -> str:
        first, j = at.position(n), self.words["j"]
        if not at.slots[n].bank:
            return first
        return j if first == "0" else f"{first} + {j}"

    def _at(self, shared: int, lanes: dict[str, int], bank: str | None) -> str:
        """Return a place after `shared` numbers and some rows of lanes."""
        terms = [str(shared)] if shared or not lanes else []
        for name, rows in lanes.items():
            if rows:
                terms.append(f"{rows}*{name}_count" if rows > 1 else f"{name}_count")
        return " + ".join([*terms, *([self.words["j"]] if bank else [])]) or "0"

    def _function(
        self,
        name: str,
        doc: str,
        arguments: str,
        body: Sequence[str],
        more: Sequence[tuple[str, str]] = (),
    ) -> str:
        w, given = self.words, arguments.split()
        kinds = dict.fromkeys("xgbu", "const real *restrict ")
        kinds |= dict.fromkeys(("out", "rows", "s", "m"), "real *restrict ")
        kinds["p"] = f"const {self.name}_reals *restrict "
        definitions = [*self._counts(), *more, *self._unpacked(given)]
        kept = used_only(body, definitions, [w[word] for word in given])
        head = f"static void {self.name}_{name}("
        joint = f",\n{' ' * len(head)}"
        texts = joint.join(f"{kinds[word]}{w[word]}" for word in given)
        lines = [*comment(doc), f"{head}{texts})", "{", *indented([*kept, *body]), "}"]
        return "\n".join(lines)

    def _counts(self) -> Iterator[tuple[str, str]]:
        for bank in self.program.counts:
            yield f"{bank}_count", f"const long {bank}_count = {self.words['p']}->{bank}_count;"

    def _unpacked(self, given: Sequence[str]) -> Iterator[tuple[str, str]]:
        names, w = self.names, self.words
        for field in self.program.parameters:
            kind = "const real *restrict " if field.bank else "const real "
            yield names[field.name], f"{kind}{names[field.name]} = {w['p']}->{names[field.name]};"
        parts = {"x": self.program.states, "g": self.given, "b": self.branches}
        own = [] if "s" in given else self.means  # slopes compute these themselves
        for word, fields in parts.items():
            yield from self._fields(fields, w[word], own) if word in given else ()
        for n, entry in enumerate(self.program.inputs):
            yield names[entry.name], f"const real {names[entry.name]} = {w['u']}[{n}];"

    def _fields(
        self, fields: Sequence[Field], array: str, without: Sequence[Field]
    ) -> Iterator[tuple[str, str]]:
        at = places([Slot(f.name, f.bank) for f in fields], f"end_{array}", self.made.stage.taken)
        yield from ((line.split()[0], f"const long {line};") for line in at.definitions())
        for n, field in enumerate(fields):
            if field in without:
                continue
            name, place = self.names[field.name], at.position(n)
            pointer = f"const real *restrict {name} = {array} + {place};"
            yield name, pointer if field.bank else f"const real {name} = {array}[{place}];"
