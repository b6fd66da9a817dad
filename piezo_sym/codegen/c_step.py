"""The discrete-gradient step in C: Newton's change, means for the ledger, and the domain's edge.

Input: a `Program` and its `Step`.  Output: functions for ``<model>.c``; `run/engine` drives them.
Each loops over lanes twice at most, so a step costs O(r).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.c_lines import Words, indented, loop_lines, stage_lines, statement, used_only
from piezo_sym.codegen.c_means import SOLVE, step_helpers
from piezo_sym.codegen.c_names import KEPT, added, c_names
from piezo_sym.codegen.c_stages import Loop, Write, lane_quantities, stages
from piezo_sym.codegen.newton import Step
from piezo_sym.codegen.places import Places, places
from piezo_sym.codegen.program import Field, Limit, Program, Row, bank_of, needed
from piezo_sym.spec.expressions import Expr, names
from piezo_sym.spec.names import fresh


def c_step(program: Program, step: Step) -> tuple[str, str]:
    """Return the functions of the step, and their declarations for the header."""
    printer = _Printer(program, step)
    functions = [printer.newton(), printer.means(), printer.inside()]
    text = "\n".join(functions)
    return "\n\n".join([*step_helpers(text), *functions]), printer.declarations()


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
        for word in (step.h, *step.unknowns):
            self.names[word] = fresh(word, {*step.taken, *KEPT}) if word in KEPT else word
        words = ("x", "x_new", "u", "p", "out", "j", "matrix", "right", "solved")
        self.words = added(words, whole, self.names)
        self.after = after
        fields = (*program.parameters, *whole.states)
        arrays = {field.name: field.bank for field in fields if field.bank}
        self.lanes = {**whole.lane_names()}
        self.lines = Words(self.names, arrays, self.words["j"])
        slots = [Slot(field.name, field.bank) for field in program.states]
        self.states = places(slots, "end", whole.taken)

    # Functions

    def newton(self) -> str:
        """Return Newton's equations, solved: the change to take from the state after the step."""
        step, size = self.step, len(self.step.right)
        w = self.words
        roots = [*(value for _, value in step.matrix), *step.right]
        body = list(self._stages(roots, ()))
        body.append(f"double {w['matrix']}[{size * size}] = {{0.0}};")
        for (row, col), value in step.matrix:
            body += statement(f"{w['matrix']}[{row * size + col}] =", value, self.lines)
        body.append(f"double {w['right']}[{size}];")
        for row, value in enumerate(step.right):
            body += statement(f"{w['right']}[{row}] =", value, self.lines)
        solve = f"{self.name}_solve_"
        body += [f"if (!{solve}({w['matrix']}, {w['right']}))", "    return 0;"]
        for n, unknown in enumerate(step.unknowns):
            body.append(f"const double {self.names[unknown]} = {w['right']}[{n}];")
        for unknown, state in zip(step.unknowns, step.shared, strict=False):
            body.append(f"{w['out']}[{self._row(state)}] = {self.names[unknown]};")
        for state, value in step.lanes:
            bank = str(self.program.states[state].bank)
            write = Write(f"{w['out']}[{self._row(state)}]", value, bank)
            own = lane_quantities(step.quantities, bank, [value])
            body += loop_lines(Loop(bank, own, (), (write,)), self.lines)
        function = self._function("newton", body, last="return 1;")
        return f"{SOLVE.format(name=solve, size=size)}\n\n{function}"

    def means(self) -> str:
        """Return what the ledger books of a step: rates, each a mean over the step."""
        rows = self._mean_rows()
        at = places([row.slot for row in rows], "row", self.step.taken)
        writes = [
            Write(f"{self.words['out']}[{self._index(at, n)}]", row.value, row.slot.bank)
            for n, row in enumerate(rows)
        ]
        body = [f"const long {line};" for line in at.definitions()]
        body += self._stages([write.value for write in writes], writes)
        return self._function("means", body)

    def inside(self) -> str:
        """Return whether a state lies in the domain."""
        states = {field.name for field in self.program.states}
        limits = [limit for limit in self.program.limits if self._moves(limit, states)]
        parts: list[str] = []
        body: list[str] = []
        quantities, _ = needed(self.program.quantities, [limit.margin for limit in limits])
        plain = _own_words(self, self.program)
        writes = []
        for n, limit in enumerate(limits):
            name = f"margin_{n + 1}_"
            bank = bank_of(limit.margin, self.program.lane_names())
            if bank:
                body.append(f"double {name};")
            target = name if bank else f"const double {name}"
            writes.append(Write(target, limit.margin, bank, "min" if bank else "="))
            parts.append(f"{name} {'>' if limit.strict else '>='} 0.0")
        for stage in stages(quantities, writes, self.program.counts):
            body += stage_lines(stage, plain)
        for write in writes:
            if not write.bank:
                body += statement(f"{write.target} =", write.value, plain)
        last = f"return {' && '.join(parts) or '1'};"
        return self._function("inside", body, last=last, over_step=False)

    def declarations(self) -> str:
        """Return the declarations of the functions, with what they are for."""
        exchanges, name = len(self.step.entropies), self.name
        return "\n".join(
            [
                "/*",
                " * The step of the discrete gradient: x to x_new over h, inputs u at its middle.",
                f" * {name}_newton: out[n], the change that Newton's method takes from x_new;",
                " *     0 if its equations are singular.",
                f" * {name}_means: over the step, the mean power of each port [W], heat [W] and",
                " *     entropy production [W/K] of each process (of a bank: of each lane), and",
                f" *     entropy rate of each of {exchanges} heat exchanges [W/K].",
                f" * {name}_inside: whether a state lies in the domain.",
                " */",
                f"enum {{ {name}_exchange_count = {exchanges} }};",
                *(f"{line};" for line in map(self._head, ("newton", "means", "inside"))),
            ]
        )

    # Parts

    def _mean_rows(self) -> tuple[Row, ...]:
        step = self.step
        return (*step.supplies, *step.heats, *step.productions, *step.entropies)

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

    def _head(self, name: str) -> str:
        w = self.words
        state = f"const double *{w['x']}"
        after = f"const double *{w['x_new']}"
        inputs, p = f"const double *{w['u']}", f"const {self.name}_parameters *{w['p']}"
        out = f"double *{w['out']}"
        given = {
            "newton": ("int", [state, after, inputs, f"double {self.names[self.step.h]}", p, out]),
            "means": ("void", [state, after, inputs, p, out]),
            "inside": ("int", [state, inputs, p]),
        }
        result, arguments = given[name]
        start = f"{result} {self.name}_{name}("
        return start + f",\n{' ' * len(start)}".join(arguments) + ")"

    def _function(
        self,
        name: str,
        body: Sequence[str],
        *,
        last: str = "",
        over_step: bool = True,
    ) -> str:
        lines = [*body, *([last] if last else [])]
        w = self.words
        given = [w["x"], w["u"], w["p"], *([w["x_new"]] if over_step else [])]
        kept = used_only(lines, list(self._unpacked(over_step)), given)
        return "\n".join([self._head(name), "{", *indented([*kept, *lines]), "}"])

    def _unpacked(self, over_step: bool) -> Iterator[tuple[str, str]]:
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


def _own_words(printer: _Printer, program: Program) -> Words:
    """Return the identifiers of the program itself, beside those of the step."""
    own = {quantity.name: quantity.name for quantity in program.quantities}
    plain = {name: fresh(name, KEPT) if name in KEPT else name for name in own}
    return replace(printer.lines, names={**plain, **printer.names})
