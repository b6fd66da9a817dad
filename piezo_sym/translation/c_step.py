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
`slopes` and the tables behind it serve Newton's method alone: of them nothing is said, but that
they are in the grammar, and that slopes fill their array.
"""

import ast
from collections.abc import Mapping
from dataclasses import replace
from typing import final

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.iphs import IPHS
from piezo_sym.translation.c_form import Form
from piezo_sym.translation.c_function import Function
from piezo_sym.translation.c_reader import add_helper
from piezo_sym.translation.c_record import Record
from piezo_sym.translation.c_scope import CALLS, Branch, Helper, Scope
from piezo_sym.translation.c_tables import Tables
from piezo_sym.translation.c_text import Tokens
from piezo_sym.translation.change import put, spelled
from piezo_sym.translation.expressions import WHOLE
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import Key, Proved
from piezo_sym.translation.signs import compare, reading

_LIBRARY = (*(record.in_c for record in RECORDS.values() if record.smooth), "pow")
#: What the words of a step stand for, for numbers of one run.
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
""".replace("{functions}", "".join(f"#define {name}_of {name}\n" for name in _LIBRARY))
#: A choice is made by a branch alone: what stands for ``?`` is no word of C.
_SPELLED = {"real": "double", "zero": "0.0", "wide": "", "least": "min", "?": "no choice"}
_SPELLED |= {f"{name}_of": name for name in (*_LIBRARY, *(f"power_{n}" for n in range(2, 9)))}
_LEAST = ast.parse("a if a < b or a != a else b", mode="eval").body
_STAGE = "x g b u p out rows s m"
FORM = Form(
    {"integrands": "x p out", "stage": _STAGE, "slopes": "x g b u p out"},
    "reals",
    {name: CALLS[name] for name in _LIBRARY},
    {"stage out": "rhs", "stage rows": "ledger", "stage m": "margins"},
)


def read_step(text: str, iphs: IPHS, known: Proved) -> dict[Key, Value]:
    """Return every row that the integrands and the stage of a printed step write.

    Parameters
    ----------
    known : from `proved_step`.

    Raises
    ------
    NotShownError
        If something is outside the grammar; it says what.
    """
    return _Step(Tokens(text, iphs.model.name, MACROS, _SPELLED), iphs, known).rows()


@final
class _Step:
    """Reads a file, part by part."""

    def __init__(self, tokens: Tokens, iphs: IPHS, known: Proved) -> None:
        self.tokens, self.iphs, self.known, self.field = tokens, iphs, known, known.field
        self.name = iphs.model.name
        letters = (("a", "double"), ("b", "double"))
        self.helpers: dict[str, Helper] = {"min": Helper(letters, _LEAST, {})}
        self.branches: dict[Branch, Value] | None = None
        self.tables = Tables(tokens, self.name)
        self.written, self.slopes = list[Branch](), list[Branch]()
        self.found: dict[Key, Value] = {}

    def rows(self) -> dict[Key, Value]:
        """Return what is written."""
        record = Record(self.tokens, self.iphs.model)
        parts = [self._integrands, self._stage, self._slopes, self._sizes]
        parts += [record.take_place, record.take_give]
        while self.tokens.peek():
            if self.tokens.taken("enum"):
                self.tables.take_enumeration()
                continue
            self.tokens.take("static")
            if self.tokens.taken("inline"):
                self._power()
            elif self.tokens.taken("const"):
                self.tables.take_table()
            elif parts:
                parts.pop(0)()
            else:
                raise NotShownError("a function of the step's own")
        if parts:
            raise NotShownError("the step lacks a function")
        strict = self.tables.strict()
        return self.found | {("strict", n): self.field.number(s) for n, s in enumerate(strict)}

    def _power(self) -> None:
        """Take a function that is a whole power."""
        name = add_helper(self.tokens, self.helpers, "power_[2-8]")
        scope = Scope(self.known, self.helpers, {}, {}, {})
        exponent = int(name.removeprefix("power_"))
        if not scope.helper_is(name, lambda z: self.field.whole_power(z, exponent), 1):
            raise NotShownError(f"{name}_of is not shown to be a power")

    # Functions

    def _function(
        self, name: str, only: frozenset[str] | None = None, without: str = ""
    ) -> tuple[Function, dict[Key, Value]]:
        made = Function(
            *(self.tokens, self.name, self.known, self.helpers, FORM),
            only=only,
            without=without,
            branches=self.branches,
        )
        if made.name != name:
            raise NotShownError(f"the step has {made.name} where {name} should be")
        return made, made.rows()

    def _integrands(self) -> None:
        """Read what means are of; each is then the mean of a co-state and what is added to it."""
        with reading(self.field, "integrands"):
            _, rows = self._function("integrands")
        names, model = dict(self.known.names), self.iphs.model
        fixed = [names[slot.label] for slot in self.known.slots["rhs"]]
        fixed += [names[name] for name in model.inputs]
        at = {g: self.field.one for value in fixed for g in value.parts}
        for (_, n), value in rows.items():
            label = self.known.slots["integrands"][int(n)].label
            more = put(spelled(value - self.known.means[label]), at)
            if not more.parts.isdisjoint(at):
                raise NotShownError(f"{label} is not shown to be one")
            self.found["integrands", n] = value - more
            names[label] = names[label] + more
        self.known = replace(self.known, names=names)

    def _stage(self) -> None:
        """Read a stage: its switching functions, all that depends on them, then its margins."""
        start, known = self.tokens.at, self.found
        function, _ = self._function("stage", frozenset())
        uses = function.uses
        self._switches(start, function, _closure("s[]", uses))
        self.tokens.at = start
        _, rows = self._function("stage", without="m[]")
        known |= rows
        self.tokens.at, self.branches = start, None
        with reading(self.field, "margins"):
            _, rows = self._function("stage", _closure("m[]", uses))
        known |= rows

    def _switches(self, start: int, function: Function, only: frozenset[str]) -> None:
        """Read switching functions; one whose value depends on branches comes after these."""
        self.written, known = [*function.switches], dict[Branch, Value]()
        self.branches = known
        while len(known) < len(function.switches):
            self.tokens.at, before = start, len(known)
            function, _ = self._function("stage", only)
            for branch, value in function.switches.items():
                if value is not None and branch not in known:
                    known[branch] = compare(">", value, self.field.zero)
            if len(known) == before:
                raise NotShownError("a switching function depends on its own branch")

    def _slopes(self) -> None:
        function, _ = self._function("slopes", frozenset())
        self.slopes = function.places

    def _sizes(self) -> None:
        """Read the sizes of arrays."""
        tokens, known = self.tokens, self.known
        tokens.take("void", f"{self.name}_sizes", "(", "const", f"{self.name}_reals", "*")
        p = tokens.word()
        tokens.take(",", "long", "*")
        out, found = tokens.word(), list[Value]()
        tokens.take(")", "{")
        scope = Scope(known, {}, {p: "p", out: "out"}, {}, {})
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
        wanted = [places[-1], known.layouts["g"].places[-1], self._end(self.written)]
        processes = known.field.zero
        for slot in self.iphs.system.processes:
            processes = processes + (known.sizes[slot.bank] if slot.bank else known.field.one)
        wanted += [known.layouts["ledger"].places[-1], processes, self._end(self.slopes)]
        wanted += known.sizes.values()
        if found != [*wanted, *places[:-1]]:
            raise NotShownError("the sizes of the step's arrays are not the system's")

    def _end(self, written: list[Branch]) -> Value:
        """Return how many numbers are written: their places have to follow on one another."""
        end, left = self.field.zero, dict(written)
        while end in left:
            bank = left.pop(end)
            end = end + (self.known.sizes[bank] if bank else self.field.one)
        if left or len(dict(written)) < len(written):
            raise NotShownError("the places of branches or slopes do not follow on one another")
        return end


def _closure(result: str, uses: Mapping[str, set[str]]) -> frozenset[str]:
    """Return a result and the names that it needs, those that these need too."""
    found, left = set[str](), {result}
    while left:
        found |= left
        left = {name for word in left for name in uses.get(word, ())} - found
    return frozenset(found)
