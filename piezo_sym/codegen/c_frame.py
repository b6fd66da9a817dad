"""What the C functions of a step share: identifiers, heads, and what each one unpacks.

Input: a `Program` and its `Step`.  Output: `Frame`, which makes a function of the lines in it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.c_lines import Words, indented, stage_lines, statement, used_only
from piezo_sym.codegen.c_names import KEPT, added, c_names
from piezo_sym.codegen.c_stages import Write, stages
from piezo_sym.codegen.places import Places, places
from piezo_sym.codegen.program import Field, Program, needed
from piezo_sym.codegen.step import Step
from piezo_sym.expressions.tree import Expr, Sym
from piezo_sym.spec.names import fresh

_STEP = ("x", "x_new", "u", "h", "p", "out")
#: The functions of a step: what each returns, and its arguments.
HEADS = {
    "newton_size": ("long", ("p",)),
    "newton": ("int", _STEP),
    "means": ("void", ("x", "x_new", "u", "p", "out")),
    "inside": ("int", ("x", "u", "p")),
}
#: Those of a dissipative step.
START_HEADS = {
    "newton_size_start": HEADS["newton_size"],
    "newton_start": HEADS["newton"],
    "means_start": ("void", _STEP),
}
_ALL = {**HEADS, **START_HEADS}


@final
class Frame:
    """The frame of the functions of one step."""

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
        words = ["x", "x_new", "u", "p", "out", "j", *map(array_of, reactions)]
        self.words = added(words, whole, self.names)
        self.after = after
        fields = (*program.parameters, *whole.states)
        arrays = {field.name: field.bank for field in fields if field.bank}
        self.lanes = {**whole.lane_names()}
        self.lines = Words(self.names, arrays, self.words["j"])
        slots = [Slot(field.name, field.bank) for field in program.states]
        self.states = places(slots, "end", whole.taken)

    def stages(self, roots: Sequence[Expr], writes: Sequence[Write]) -> Iterator[str]:
        """Yield the lines that compute `roots` and write what is to be written."""
        quantities, _ = needed(self.step.quantities, roots)
        lanes = [w for w in writes if w.bank]
        for stage in stages(quantities, lanes, self.program.counts):
            yield from stage_lines(stage, self.lines)
        for write in writes:
            if not write.bank:
                yield from statement(f"{write.target} {write.how}", write.value, self.lines)

    def row(self, n: int) -> str:
        """Return the place of state n, of the loop's lane if it is a bank's."""
        return self.index(self.states, n)

    def index(self, rows: Places, n: int) -> str:
        """Return the place of slot n, of the loop's lane if it is a bank's."""
        first = rows.position(n)
        if not rows.slots[n].bank:
            return first
        return self.words["j"] if first == "0" else f"{first} + {self.words['j']}"

    def head(self, name: str, restrict: str = "") -> str:
        """Return the first lines of a function, without body and semicolon."""
        w = self.words
        kinds = {
            **{word: f"const double *{restrict}{w[word]}" for word in ("x", "x_new", "u")},
            "h": f"double {self.names[self.step.h]}",
            "p": f"const {self.name}_parameters *{restrict}{w['p']}",
            "out": f"double *{restrict}{w['out']}",
        }
        result, arguments = _ALL[name]
        start = f"{result} {self.name}_{name}("
        return start + f",\n{' ' * len(start)}".join(kinds[word] for word in arguments) + ")"

    def function(self, name: str, body: Sequence[str], *, last: str = "") -> str:
        """Return a function: `body`, and before it what that uses; `last` is its last line."""
        lines = [*body, *([last] if last else [])]
        given = [word for word in _ALL[name][1] if word != "h"]
        definitions = list(self._unpacked(over_step="x_new" in given))
        kept = used_only(lines, definitions, [self.words[word] for word in given])
        head = self.head(name, "restrict ")
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


def array_of(reaction: Sym) -> str:
    """Return the name of the array that keeps a reaction of all lanes."""
    return f"kept_{reaction.name}"
