"""The discrete-gradient step in C: Newton's change, means for the ledger, and the domain's edge.

Input: a `Program`, its `Step`, and a dissipative one.  Output: functions for ``<model>.c``;
`run/engine` drives them.  Each loops over lanes twice at most, so a step costs O(r).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.codegen.c_frame import HEADS, START_HEADS, Frame, array_of
from piezo_sym.codegen.c_inside import inside
from piezo_sym.codegen.c_lines import statement, used_only
from piezo_sym.codegen.c_means import step_helpers
from piezo_sym.codegen.c_stages import Write
from piezo_sym.codegen.places import places
from piezo_sym.codegen.program import Program, Row
from piezo_sym.codegen.step import Step
from piezo_sym.expressions.tree import Sym

#: Opens the part of a source that also holds where `double` stands for a vector of many states'
#: numbers: no conditions of C, no constants without type.
STEP = "/* The step of the discrete gradient, of one state or of many side by side. */"


def c_step(program: Program, step: Step, start: Step | None = None) -> tuple[str, str]:
    """Return the functions of the step, and their declarations for the header.

    Parameters
    ----------
    start : the dissipative step, if the system has one.
    """
    frame = Frame(program, step)
    functions = [*_Printer(frame).functions(), inside(frame)]
    functions = [STEP, *functions]
    declared = _declarations(frame)
    if start:
        lossy = Frame(program, start)
        functions = [*_Printer(lossy, "_start").functions(), *functions]
        declared += f"\n\n{_start_declarations(lossy)}"
    text = "\n".join(functions)
    return "\n\n".join([*step_helpers(text), *functions]), declared


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
    """Prints the functions of one step; `ending` is that of their names."""

    def __init__(self, frame: Frame, ending: str = "") -> None:
        self.frame, self.ending = frame, ending
        self.program, self.step = frame.program, frame.step
        self.words, self.states, self.lines = frame.words, frame.states, frame.lines

    def functions(self) -> list[str]:
        """Return the functions."""
        return [self.newton_size(), self.newton(), self.means()]

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
            Write(f"{out}[{self.frame.row(n)}]", step.changes[n].free, self.program.states[n].bank)
            for n in lanes
        ]
        unknowns = [unknown for n in lanes for _, unknown in step.changes[n].reactions]
        roots = [*step.pivots, *unknowns, *(step.changes[n].free for n in shared)]
        body = [f"double *restrict {k.array} = {k.place};" for k in kept]
        body += self.frame.stages(roots, writes)
        for n in shared:
            body += statement(f"{out}[{self.frame.row(n)}] =", step.changes[n].free, self.lines)
        for n in lanes:
            body += self._lane_change(n, [k for k in kept if k.state == n])
        solved = [f"({self.lines.text(pivot)} > 0.0)" for pivot in step.pivots]
        last = f"return {' & '.join(solved) or '1'};"
        return self.frame.function(f"newton{self.ending}", body, last=last)

    def _kept(self) -> Iterator[_Kept]:
        """Yield what lanes have to remember, and where."""
        place = f"{self.words['out']} + {self.states.size}"
        for n, field in enumerate(self.program.states):
            for value, unknown in self.step.changes[n].reactions if field.bank else ():
                array = self.words[array_of(value)]
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
            yield f"    {self.words['out']}[{self.frame.row(n)}] -= {' + '.join(terms)};"
            yield "}"

    def newton_size(self) -> str:
        """Return the function that tells how much room `newton` needs."""
        sizes = [self.states.size, *(f"{kept.bank}_count" for kept in self._kept())]
        return self.frame.function(
            f"newton_size{self.ending}", [], last=f"return {' + '.join(sizes)};"
        )

    def means(self) -> str:
        """Return what the ledger books of a step: rates, each a mean over the step."""
        rows = _mean_rows(self.step)
        at = places([row.slot for row in rows], "row", self.step.taken)
        writes = [
            Write(f"{self.words['out']}[{self.frame.index(at, n)}]", row.value, row.slot.bank)
            for n, row in enumerate(rows)
        ]
        body = list(self.frame.stages([write.value for write in writes], writes))
        ends = [(line.split()[0], f"const long {line};") for line in at.definitions()]
        lines = [*used_only(body, ends, ()), *body]
        return self.frame.function(f"means{self.ending}", lines)


def _declarations(frame: Frame) -> str:
    """Return the declarations of the functions, with what they are for."""
    exchanges, name = len(frame.step.entropies), frame.name
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
            *(f"{line};" for line in map(frame.head, HEADS)),
        ]
    )


def _start_declarations(frame: Frame) -> str:
    """Return the declarations of the functions of the dissipative step."""
    name = frame.name
    return "\n".join(
        [
            "/*",
            " * The dissipative step: co-states of stores at its end, for a start after a jump.",
            f" * As {name}_newton_size, {name}_newton and {name}_means; the means end with",
            " *     heat [W] and entropy production [W/K] of what the step itself loses.",
            " */",
            *(f"{line};" for line in map(frame.head, START_HEADS)),
        ]
    )


def _mean_rows(step: Step) -> tuple[Row, ...]:
    rows = (*step.supplies, *step.heats, *step.productions, *step.entropies)
    return (*rows, *step.numerical)
