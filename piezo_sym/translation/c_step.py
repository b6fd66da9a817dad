"""A printed step, read back: rows of its integrands and its stage as values in normal form.

Input: the text of ``<model>_step.c``, and the proved stage, for names and places.  Output: values
by function and row.  The grammar:

    file        comments, the two headers, MACROS, record, functions, enumerations, tables
    record      typedef struct { real NAME; real *NAME; long NAME; } <model>_reals;
    function    static void <model>_{integrands, stage, slopes, sizes}(...), see `c_function`;
                place_reals and give, which handle the record, word for word
    helper      static inline real power_N_of(real z) { return expression; }
    table       enum { NAME = n, ... };    static const int NAME[] = { n, ... };

MACROS say what a word means where ``real`` is one number.  A mean that a stage is given is that of
its integrand: a co-state and what is free of the state.  A branch is 1 where its switching function
is positive, else 0; a stage chooses by branches alone: ``chosen(NAME > 0.0, value, value)``.
`slopes` and most tables behind it serve Newton's method alone, and `bends`, which a line ``#define
BENDS`` announces, says where the engine splits means: of them nothing is said, but that they are in
the grammar, and that what they write fills its array.  Where the system has stops, a table tells of
each the bank, whether its lanes have drives of their own, and its inner state; `path_parameters`
are stiffness and limit of the inner state, `drives` the rates of coordinates.
"""

import ast
from collections import ChainMap
from dataclasses import replace
from typing import final

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.spec.elements.ports import Body, Storage
from piezo_sym.translation.c_data import (
    Tables,
    strict,
    take_enumeration,
    take_give,
    take_place,
    take_record,
    take_table,
)
from piezo_sym.translation.c_function import NOT_COMPARED, CFunction
from piezo_sym.translation.c_reader import add_helper
from piezo_sym.translation.c_scope import Branch, Scope, helper_is
from piezo_sym.translation.c_text import CALLS, File, Helper, Tokens
from piezo_sym.translation.change import put, spelled
from piezo_sym.translation.expressions import WHOLE
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import Key, Proved
from piezo_sym.translation.signs import reading

_LIBRARY = tuple(record.in_c for record in RECORDS.values() if record.smooth)
#: What the words of a step stand for, for numbers of one run; called functions have a line.
MACROS = """\
#if !defined(REAL_WIDTH) /* numbers of one run; run/engine has vectors of many */
#define REAL_WIDTH 1
#define ALONE
#if !defined(REAL)
#define REAL double /* or float */
#endif
typedef REAL real;
#define zero 0.0
#define wide(value) (value)
#define chosen(condition, then, other) ((condition) ? (then) : (other))
{functions}#define is_above(a, b) ((a) > (b))
#define is_at_least(a, b) ((a) >= (b))
#define least(a, b) ((a) < (b) || (a) != (a) ? (a) : (b))
#define OF(value, lane) (value)
#endif
"""
#: A choice is made by a branch alone: what stands for ``?`` is no word of C.
_SPELLED = {"real": "double", "zero": "0.0", "wide": "", "least": "min", "?": "no choice"}
_SPELLED |= {f"power_{n}_of": f"power_{n}" for n in range(2, 9)}
_LEAST = ast.parse("a if a < b or a != a else b", mode="eval").body
_SIGNATURES = {
    "integrands": "x p out",
    "stage": "x g b u p out rows s m",
    "slopes": "x g b u p out",
    "bends": "x p out",
    "path_parameters": "x p out",
    "drives": "x g b u p out",
}
_RESULTS = {"stage out": "rhs", "stage rows": "ledger", "stage m": "margins"}
_RESULTS |= {"slopes out": NOT_COMPARED, "bends out": NOT_COMPARED}


def read_step(text: str, known: Proved) -> dict[Key, Value]:
    """Return every row that the integrands and the stage of a printed step write.

    Parameters
    ----------
    known : from `proved_step`.
    """
    lines = {f"#define {name}_of {name}\n": name for name in _LIBRARY}
    lines = {line: name for line, name in lines.items() if line in text}
    spelled = _SPELLED | {f"{name}_of": name for name in lines.values()}
    macros = MACROS.replace("{functions}", "".join(lines))
    table = _path_table(known)
    return _Step(Tokens(text, known.iphs.model.name, macros, spelled, table), known).rows()


def _path_table(known: Proved) -> str:
    """Return the lines by which a step tells of its stops, if the system has some."""
    banks = [*known.sizes]
    states = [slot.label for slot in known.iphs.system.states]
    lines = [
        f"    {{{banks.index(bank) if bank else -1}, {int(own)}, {states.index(inner)}}},\n"
        for inner, bank, own in known.paths
    ]
    name = known.iphs.model.name
    # no comment is open where one ends
    comment = "/* Path functionals: bank or -1, whether each lane has a drive, inner state. */\n"
    head = f"{comment}#define PATHS {len(lines)}\nstatic const int {name}_path[PATHS][3] = {{\n"
    return f"{head}{''.join(lines)}}};\n" if lines else ""


@final
class _Step:
    """Reads a file, part by part."""

    def __init__(self, tokens: Tokens, known: Proved) -> None:
        self.tokens, self.iphs, self.field = tokens, known.iphs, known.field
        calls = {name: CALLS[name] for name in _LIBRARY}
        self.file = File(known, self.iphs.model.name, _SIGNATURES, "reals", calls, _RESULTS)
        self.file.helpers["min"] = Helper((("a", "double"), ("b", "double")), _LEAST)
        self.branches, self.slopes, self.bends = list[Branch](), list[Branch](), list[Branch]()
        self.found: dict[Key, Value] = {}

    def rows(self) -> dict[Key, Value]:
        """Return what is written."""
        tokens, model, tables = self.tokens, self.iphs.model, Tables()
        fields = take_record(tokens, model)
        parts = [self._integrands, *([self._bends] * tokens.bends), self._stage]
        parts += [self._slopes, self._sizes]
        parts += [self._path_parameters, self._drives] * bool(self.file.known.paths)
        parts += [lambda: take_place(tokens, model, fields)]
        parts += [lambda: take_give(tokens, model, fields)]
        while tokens.peek():
            more = Tables()
            word = tokens.one_of("enum", "static")
            if word == "enum":
                more = take_enumeration(tokens)
            elif tokens.taken("inline"):
                self._power()
            elif tokens.taken("const"):
                more = take_table(tokens)
            elif parts:
                parts.pop(0)()
            else:
                raise NotShownError("a function of the step's own")
            if any(name in tables or not name.startswith(f"{model.name}_") for name in more):
                raise NotShownError("a table of the step's own")
            tables |= more
        if parts:
            raise NotShownError("the step lacks a function")
        self._told(tables)
        of_margins = enumerate(strict(tables, model.name))
        return self.found | {("strict", n): self.field.number(s) for n, s in of_margins}

    def _told(self, tables: Tables) -> None:
        """Check what tables tell the engine: who takes losses, jumps, what integrands read."""
        iphs, name = self.iphs, self.iphs.model.name
        ports = [port for _, port in iphs.circuit.of(Storage, Body)]
        body = next((n for n, port in enumerate(ports) if isinstance(port, Body)), -1)
        lossy = any(isinstance(port, Storage) for port in ports)
        jumps = any(getattr(e, "discontinuous", False) for e in iphs.model.elements.values())
        used = {g for value in self.file.known.means.values() for g in value.parts}
        states = [self.file.known.names[slot.label] for slot in iphs.system.states]
        read = [n for n, value in enumerate(states) if not used.isdisjoint(value.parts)]
        wanted = {"heated": [body if lossy else -1], "jumps": [int(jumps)], "reads": [len(read)]}
        found = {word: tables.get(f"{name}_{word}") for word in wanted}
        if found != wanted or tables.get(f"{name}_read", [])[: len(read)] != read:
            raise NotShownError("the step does not say which states it reads, heats, or jumps with")

    def _power(self) -> None:
        """Take a function that is a whole power."""
        name = add_helper(self.tokens, self.file, "power_[2-8]")
        exponent = int(name.removeprefix("power_"))
        if not helper_is(self.file, name, lambda z: self.field.whole_power(z, exponent), 1):
            raise NotShownError(f"{name}_of is not shown to be a power")

    # Functions

    def _function(self, name: str, *, by_branches: bool = False) -> CFunction:
        made = CFunction(self.tokens, self.file, by_branches=by_branches)
        if made.name != name:
            raise NotShownError(f"the step has {made.name} where {name} should be")
        return made

    def _integrands(self) -> None:
        """Read what means are of; each is then the mean of a co-state and what is added to it."""
        with reading(self.field, "integrands"):
            rows = self._function("integrands").rows()
        known, model = self.file.known, self.iphs.model
        names = dict(known.names)
        fixed = [names[slot.label] for slot in known.slots["rhs"]]
        fixed += [names[name] for name in model.inputs]
        at = {g: self.field.one for value in fixed for g in value.parts}
        for (_, n), value in rows.items():
            label = known.slots["integrands"][int(n)].label
            more = put(spelled(value - known.means[label]), at)
            if not more.parts.isdisjoint(at):
                raise NotShownError(f"{label} is not shown to be one")
            self.found["integrands", n] = value - more
            names[label] = names[label] + more
        self.file = replace(self.file, known=replace(known, names=names))

    def _bends(self) -> None:
        self.bends = self._function("bends").places

    def _stage(self) -> None:
        """Read a stage: its rates and what it books by branches, its margins by comparisons."""
        start = self.tokens.at
        stage = self._function("stage", by_branches=True)
        self.branches = [*stage.switches]
        self.found |= stage.rows({"out", "rows"})
        self.tokens.at = start
        with reading(self.field, "margins"):
            self.found |= self._function("stage").rows({"m"})

    def _slopes(self) -> None:
        self.slopes = self._function("slopes").places

    def _path_parameters(self) -> None:
        self.found |= self._function("path_parameters").rows()

    def _drives(self) -> None:
        self.found |= self._function("drives", by_branches=True).rows()

    def _sizes(self) -> None:
        """Read the sizes of arrays."""
        tokens, known, name = self.tokens, self.file.known, self.iphs.model.name
        tokens.take("void", f"{name}_sizes", "(", "const", f"{name}_reals", "*")
        p = tokens.word()
        tokens.take(",", "long", "*")
        out, found = tokens.word(), list[Value]()
        tokens.take(")", "{")
        scope = Scope(self.file, {p: "p", out: "out"}, ChainMap())
        while not tokens.taken("}"):
            if tokens.taken("("):
                tokens.take("void", ")", p)
            elif tokens.taken("const"):
                tokens.take("long")
                name = tokens.word()
                tokens.take("=")
                scope.declare(name, (scope.read.whole(tokens.expression()), WHOLE))
            else:
                tokens.take(out, "[", str(len(found)), "]", "=")
                found.append(scope.read.whole(tokens.expression()))
            tokens.take(";")
        places = known.layouts["rhs"].places
        wanted = [places[-1], known.layouts["integrands"].places[-1], self._end(self.branches)]
        processes = known.field.zero
        for slot in self.iphs.system.processes:
            processes = processes + (known.sizes[slot.bank] if slot.bank else known.field.one)
        wanted += [known.layouts["ledger"].places[-1], processes, self._end(self.slopes)]
        wanted += known.sizes.values()
        bends = [self._end(self.bends)] * tokens.bends
        if found != [*wanted, *places[:-1], *bends]:
            raise NotShownError("the sizes of the step's arrays are not the system's")

    def _end(self, written: list[Branch]) -> Value:
        """Return how many numbers are written: their places have to follow on one another."""
        end, left = self.field.zero, dict(written)
        while end in left:
            bank = left.pop(end)
            end = end + (self.file.known.sizes[bank] if bank else self.field.one)
        if left or len(dict(written)) < len(written):
            raise NotShownError("the places of branches or slopes do not follow on one another")
        return end
