"""The discrete-gradient step in C: Newton's change, means for the ledger, and the domain's edge.

Input: a `Program` and its `Step`.  Output: functions for ``<model>.c``; `run/engine` drives them.
Each loops over lanes twice at most, so a step costs O(r).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.c_lines import Words, indented, stage_lines, statement, used_only
from piezo_sym.codegen.c_means import step_helpers
from piezo_sym.codegen.c_names import KEPT, added, c_names
from piezo_sym.codegen.c_stages import Write, stages
from piezo_sym.codegen.places import Places, places
from piezo_sym.codegen.program import Field, Limit, Program, Row, bank_of, needed
from piezo_sym.codegen.step import Step
from piezo_sym.spec.expressions import Call, Div, Expr, Mul, Sym, names
from piezo_sym.spec.names import fresh

#: Opens the part of a source that also holds where `double` stands for a vector of many states'
#: numbers: no conditions of C, no constants without type.
STEP = "/* The step of the discrete gradient, of one state or of many side by side. */"
#: The functions of a step: what each returns, and its arguments.
HEADS = {
    "newton_size": ("long", ("p",)),
    "newton": ("int", ("x", "x_new", "u", "h", "p", "out")),
    "means": ("void", ("x", "x_new", "u", "p", "out")),
    "inside": ("int", ("x", "u", "p")),
}


def c_step(program: Program, step: Step) -> tuple[str, str]:
    """Return the functions of the step, and their declarations for the header."""
    printer = _Printer(program, step)
    functions = [printer.newton_size(), printer.newton(), printer.means(), printer.inside()]
    text = "\n".join(functions)
    return "\n\n".join([*step_helpers(text), STEP, *functions]), printer.declarations()


@final
@dataclass(frozen=True)
class _Kept:
    """A reaction that a bank's lanes remember: of which state, in which array, at which place."""

    state: int
    bank: str
    array: str
    place: str
    value: Sym
    unknown: Sym


@final
class _Printer:
    """Prints the functions of one step."""

    def __init__(self, program: Program, step: Step) -> None:
        self.program, self.step, self.name = program, step, program.name
        banks = [field.bank for field in program.states]
        after = [Field(n, "", "", bank) for n, bank in zip(step.after, banks, strict=True)]
        whole = replace(
            program,
            states=(*program.states, *after),
            quantities=step.quantities,
            taken=step.taken,
        )
        self.names = c_names(whole)
        self.names[step.h] = fresh(step.h, {*step.taken, *KEPT}) if step.h in KEPT else step.h
        reactions = (value for change in step.changes for value, _ in change.reactions)
        words = ["x", "x_new", "u", "p", "out", "j", *map(_array, reactions)]
        self.words = added(words, whole, self.names)
        self.after = after
        fields = (*program.parameters, *whole.states)
        arrays = {field.name: field.bank for field in fields if field.bank}
        self.lanes = {**whole.lane_names()}
        self.lines = Words(self.names, arrays, self.words["j"], picked=True)
        slots = [Slot(field.name, field.bank) for field in program.states]
        self.states = places(slots, "end", whole.taken)

    # Functions

    def newton(self) -> str:
        """Return Newton's equations, solved: the change to take from the state after the step.

        A lane's change needs those of shared states, which need sums over lanes: what a lane has
        to remember meanwhile is kept in `out`, beyond the states.
        """
        step, out = self.step, self.words["out"]
        lanes = [n for n, field in enumerate(self.program.states) if field.bank]
        shared = [n for n, field in enumerate(self.program.states) if not field.bank]
        kept = list(self._kept())
        writes = [Write(f"{k.array}[{self.words['j']}]", k.value, k.bank) for k in kept]
        writes += [
            Write(f"{out}[{self._row(n)}]", step.changes[n].free, self.program.states[n].bank)
            for n in lanes
        ]
        unknowns = [unknown for n in lanes for _, unknown in step.changes[n].reactions]
        roots = [*step.pivots, *unknowns, *(step.changes[n].free for n in shared)]
        body = [f"double *restrict {k.array} = {k.place};" for k in kept]
        body += self._stages(roots, writes)
        for n in shared:
            body += statement(f"{out}[{self._row(n)}] =", step.changes[n].free, self.lines)
        for n in lanes:
            body += self._lane_change(n, [k for k in kept if k.state == n])
        solved = [f"({self.lines.text(pivot)} > 0.0)" for pivot in step.pivots]
        return self._function("newton", body, last=f"return {' & '.join(solved) or '1'};")

    def _kept(self) -> Iterator[_Kept]:
        """Yield what lanes have to remember, and where."""
        place = f"{self.words['out']} + {self.states.size}"
        for n, field in enumerate(self.program.states):
            for value, unknown in self.step.changes[n].reactions if field.bank else ():
                array = self.words[_array(value)]
                yield _Kept(n, str(field.bank), array, place, value, unknown)
                place = f"{array} + {field.bank}_count"

    def _lane_change(self, n: int, kept: Sequence[_Kept]) -> Iterator[str]:
        """Yield the loop that takes the reactions of a bank's lanes from their changes."""
        bank, j = str(self.program.states[n].bank), self.words["j"]
        terms = [f"{k.array}[{j}]*{self.lines.text(k.unknown)}" for k in kept]
        if terms:
            yield f"/* {bank}: reactions */"
            yield "#pragma omp simd"
            yield f"for (long {j} = 0; {j} < {bank}_count; ++{j}) {{"
            yield f"    {self.words['out']}[{self._row(n)}] -= {' + '.join(terms)};"
            yield "}"

    def newton_size(self) -> str:
        """Return the function that tells how much room `newton` needs."""
        sizes = [self.states.size, *(f"{kept.bank}_count" for kept in self._kept())]
        return self._function("newton_size", [], last=f"return {' + '.join(sizes)};")

    def means(self) -> str:
        """Return what the ledger books of a step: rates, each a mean over the step."""
        rows = self._mean_rows()
        at = places([row.slot for row in rows], "row", self.step.taken)
        writes = [
            Write(f"{self.words['out']}[{self._index(at, n)}]", row.value, row.slot.bank)
            for n, row in enumerate(rows)
        ]
        body = list(self._stages([write.value for write in writes], writes))
        ends = [(line.split()[0], f"const long {line};") for line in at.definitions()]
        return self._function("means", [*used_only(body, ends, ()), *body])

    def inside(self) -> str:
        """Return whether a state lies in the domain."""
        states = {field.name for field in self.program.states}
        limits = [limit for limit in self.program.limits if self._moves(limit, states)]
        margins = [self._like(limit.margin) for limit in limits]
        parts: list[str] = []
        body: list[str] = []
        quantities, _ = needed(self.program.quantities, margins)
        plain = _own_words(self, self.program)
        writes = []
        for n, (limit, margin) in enumerate(zip(limits, margins, strict=True)):
            name = f"margin_{n + 1}_"
            bank = bank_of(margin, self.program.lane_names())
            if bank:
                body.append(f"double {name};")
            target = name if bank else f"const double {name}"
            writes.append(Write(target, margin, bank, "min" if bank else "="))
            parts.append(f"({name} {'>' if limit.strict else '>='} 0.0)")
        for stage in stages(quantities, writes, self.program.counts):
            body += stage_lines(stage, plain)
        for write in writes:
            if not write.bank:
                body += statement(f"{write.target} =", write.value, plain)
        last = f"return {' & '.join(parts) or '1'};"
        return self._function("inside", body, last=last)

    def declarations(self) -> str:
        """Return the declarations of the functions, with what they are for."""
        exchanges, name = len(self.step.entropies), self.name
        return "\n".join(
            [
                "/*",
                " * The step of the discrete gradient: x to x_new over h, inputs u at its middle.",
                f" * {name}_newton: out[n], the change that Newton's method takes from x_new, in",
                f" *     an array of {name}_newton_size numbers; 0 if the step is too long.",
                f" * {name}_means: over the step, the mean power of each port [W], heat [W] and",
                " *     entropy production [W/K] of each process (of a bank: of each lane), and",
                f" *     entropy rate of each of {exchanges} heat exchanges [W/K].",
                f" * {name}_inside: whether a state lies in the domain.",
                " */",
                f"enum {{ {name}_exchange_count = {exchanges} }};",
                *(f"{line};" for line in map(self._head, HEADS)),
            ]
        )

    # Parts

    def _mean_rows(self) -> tuple[Row, ...]:
        step = self.step
        return (*step.supplies, *step.heats, *step.productions, *step.entropies)

    def _like(self, margin: Expr) -> Expr:
        """Return a number of the sign of a margin: positive factors, and exp(d) - 1, are left out.

        Newton's method asks at every iteration, and only for the sign.
        """
        values = {quantity.name: quantity.value for quantity in self.program.quantities}
        positive = {
            limit.margin.name
            for limit in self.program.limits
            if limit.strict and isinstance(limit.margin, Sym) and limit.margin.name not in values
        }
        given = values.get(margin.name, margin) if isinstance(margin, Sym) else margin
        match given:
            case Mul(Sym(name), Call("expm1", (Div(top, Sym(below)),))) if {
                name,
                below,
            } <= positive:
                return top
        return margin

    def _moves(self, limit: Limit, states: set[str]) -> bool:
        """Return whether a condition depends on the state."""
        quantities, used = needed(self.program.quantities, [limit.margin])
        del quantities
        return bool(states & {*used, *names(limit.margin)})

    def _stages(self, roots: Sequence[Expr], writes: Sequence[Write]) -> Iterator[str]:
        quantities, _ = needed(self.step.quantities, roots)
        lanes = [w for w in writes if w.bank]
        for stage in stages(quantities, lanes, self.program.counts):
            yield from stage_lines(stage, self.lines)
        for write in writes:
            if not write.bank:
                yield from statement(f"{write.target} {write.how}", write.value, self.lines)

    def _row(self, n: int) -> str:
        return self._index(self.states, n)

    def _index(self, rows: Places, n: int) -> str:
        """Return the place of slot n, of the loop's lane if it is a bank's."""
        first = rows.position(n)
        if not rows.slots[n].bank:
            return first
        return self.words["j"] if first == "0" else f"{first} + {self.words['j']}"

    def _head(self, name: str, restrict: str = "") -> str:
        w = self.words
        kinds = {
            **{word: f"const double *{restrict}{w[word]}" for word in ("x", "x_new", "u")},
            "h": f"double {self.names[self.step.h]}",
            "p": f"const {self.name}_parameters *{restrict}{w['p']}",
            "out": f"double *{restrict}{w['out']}",
        }
        result, arguments = HEADS[name]
        start = f"{result} {self.name}_{name}("
        return start + f",\n{' ' * len(start)}".join(kinds[word] for word in arguments) + ")"

    def _function(self, name: str, body: Sequence[str], *, last: str = "") -> str:
        lines = [*body, *([last] if last else [])]
        given = [word for word in HEADS[name][1] if word != "h"]
        definitions = list(self._unpacked(over_step="x_new" in given))
        kept = used_only(lines, definitions, [self.words[word] for word in given])
        head = self._head(name, "restrict ")
        return "\n".join([head, "{", *indented([*kept, *lines]), "}"])

    def _unpacked(self, *, over_step: bool) -> Iterator[tuple[str, str]]:
        program, names_, w = self.program, self.names, self.words
        for bank in program.counts:
            yield f"{bank}_count", f"const long {bank}_count = {w['p']}->{bank}_count;"
        for line in self.states.definitions():
            yield line.split()[0], f"const long {line};"
        for field in program.parameters:
            kind = "const double *restrict " if field.bank else "const double "
            yield (
                names_[field.name],
                f"{kind}{names_[field.name]} = {w['p']}->{names_[field.name]};",
            )
        yield from self._states(program.states, w["x"])
        if over_step:
            yield from self._states(self.after, w["x_new"])
        for n, entry in enumerate(program.inputs):
            yield names_[entry.name], f"const double {names_[entry.name]} = {w['u']}[{n}];"

    def _states(self, fields: Sequence[Field], array: str) -> Iterator[tuple[str, str]]:
        for n, field in enumerate(fields):
            name, place = self.names[field.name], self.states.position(n)
            pointer = f"const double *restrict {name} = {array} + {place};"
            yield name, pointer if field.bank else f"const double {name} = {array}[{place}];"


def _array(reaction: Sym) -> str:
    """Return the name of the array that keeps a reaction of all lanes."""
    return f"kept_{reaction.name}"


def _own_words(printer: _Printer, program: Program) -> Words:
    """Return the identifiers of the program itself, beside those of the step."""
    own = {quantity.name: quantity.name for quantity in program.quantities}
    plain = {name: fresh(name, KEPT) if name in KEPT else name for name in own}
    return replace(printer.lines, names={**plain, **printer.names})
