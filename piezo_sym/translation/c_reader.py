"""A printed C file, read back: rows of its functions as values in normal form.

Input: the text of ``<model>.c`` without the step, and what it may name.  Output: values by function
and row.  The grammar:

    file        comments, ``#include "<model>.h"``, ``#include <math.h>``, functions
    helper      static double NAME(double or int NAME, ...) { return expression; }
    statement   [const] double or long NAME = expression;   NAME += expression;
                [static] const double NAME[n] = { ... };    OUT[place] = or += expression;
                for (long j = 0; j < size; ++j) { ... }     { ... }     return expression;
    expression  ? :  ||  comparisons  + - * /  calls, names, numbers, NAME[place], P->NAME

A loop stands for every lane of a bank: what it adds up is a sum over lanes, what it writes is a row
of that lane.  Helpers mean what their text says.  Expressions become trees of Python's `ast`, which
`Expressions` reads.  Nothing is compiled or executed.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.translation.c_text import Tokens
from piezo_sym.translation.change import moved
from piezo_sym.translation.expressions import (
    PLAIN,
    TEST,
    WHOLE,
    Expressions,
    Read,
    Shape,
    refuse,
)
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.numpy_reader import ARGUMENTS
from piezo_sym.translation.reference import ALL, LEAST, SAME, Key, Proved
from piezo_sym.translation.zero import is_zero

CALLS = {name: name for name in ("exp", "expm1", "log", "sqrt", "sin", "cos", "tanh", "pow")}
CALLS |= {"fabs": "abs", "copysign": "copysign"}
_VOID = {name: f"{words} out".replace("out out", "out") for name, words in ARGUMENTS.items()}
SIGNATURES = {**_VOID, "rhs": "x u p out", "energy": "x p", "entropy": "x p"}
SIGNATURES |= {"states": "p", "processes": "p"}
del SIGNATURES["_rates"]


@final
@dataclass
class Cell:
    """A variable: what it has come to, the loop it is declared in, those that read or add to it."""

    value: Value | None
    loop: int
    read: set[int]
    added: set[int]


@final
@dataclass(frozen=True)
class Argument:
    """What a helper is given: it is read where it is used, so that a choice leaves out the other.

    `known` is what it was read as, by the path of choices.
    """

    node: ast.expr
    kind: str
    names: Mapping[str, object]
    helpers: Mapping[str, Helper]
    known: dict[Value | None, Read]


@final
@dataclass(frozen=True)
class Helper:
    """A function of the file itself: its parameters, with types, and what it returns."""

    names: tuple[tuple[str, str], ...]
    value: ast.expr
    known: Mapping[str, Helper]


def read_c(text: str, name: str, known: Proved) -> dict[Key, Value]:
    """Return every row that the functions of a C file write.

    Raises
    ------
    NotShownError
        If something is outside the grammar; it says what.
    """
    tokens = Tokens(text, name)
    helpers: dict[str, Helper] = {}
    rows: dict[Key, Value] = {}
    seen: set[str] = set()
    while tokens.peek():
        if tokens.taken("static"):
            helper, made = _helper(tokens, helpers)
            if helper in helpers or helper in CALLS or not re.fullmatch(_HELPER_NAMES, helper):
                raise NotShownError(f"a function {helper} of the C file's own")
            helpers[helper] = made
            continue
        function = _Function(tokens, name, known, helpers)
        if function.name in seen:
            raise NotShownError(f"{function.name} is defined twice")
        seen.add(function.name)
        rows |= function.rows()
    if missing := SIGNATURES.keys() - seen:
        raise NotShownError(f"the C file lacks {min(missing)}")
    return rows


_HELPER_NAMES = r"pick|sign|min|max|saturate|deadzone|power_[2-8]"


def _helper(tokens: Tokens, helpers: Mapping[str, Helper]) -> tuple[str, Helper]:
    tokens.take("double")
    name, names = tokens.word(), []
    tokens.take("(")
    while not tokens.taken(")"):
        names.append((tokens.one_of("double", "int"), tokens.word()))
        tokens.taken(",")
    tokens.take("{", "return")
    value = tokens.expression()
    tokens.take(";", "}")
    return name, Helper(tuple((n, t) for t, n in names), value, dict(helpers))


@final
class _Function:
    """Reads one function, statement by statement."""

    def __init__(
        self, tokens: Tokens, model: str, known: Proved, helpers: Mapping[str, Helper]
    ) -> None:
        self.tokens, self.known, self.field, self.helpers = tokens, known, known.field, helpers
        kind = tokens.one_of("void", "double", "long")
        self.name = tokens.word().removeprefix(f"{model}_")
        if self.name not in SIGNATURES:
            raise NotShownError(f"a function {self.name} of the C file")
        words = SIGNATURES[self.name].split()
        wanted = "void" if "out" in words else "long" if words == ["p"] else "double"
        self.roles = {self._argument(word, model, n): word for n, word in enumerate(words)}
        tokens.take(")")
        if kind != wanted or len(self.roles) != len(words):
            raise NotShownError(f"the types of {self.name}")
        self.names: dict[str, object] = {}
        self.lanes: list[tuple[str, str]] = []  # loop variables and their banks, outermost first
        self.loops, self.loop, self.summed = 0, 0, set[str]()
        self.open = [0]
        self.found: dict[Key, Value] = {}
        self.least: set[int] = set()
        self.zeros = self.name != "jacobian"
        self.slots = known.slots.get(self.name, ())
        self.field.derived = self.name == "jacobian"
        self.read = Expressions(self.field, known.numbers, self._leaf, CALLS, True)

    def _argument(self, word: str, model: str, n: int) -> str:
        self.tokens.take("," if n else "(")
        types = {"out": "double * restrict", "p": f"const {model}_parameters * restrict"}
        self.tokens.take(*types.get(word, "const double * restrict").split())
        return self.tokens.word()

    def rows(self) -> dict[Key, Value]:
        """Return the rows that the function writes."""
        self._block()
        if not self.zeros or (
            self.least and {(self.name, n, LEAST) for n in self.least} - {*self.found}
        ):
            raise NotShownError(f"{self.name} leaves numbers that were never written")
        return self.found

    def _block(self) -> None:
        before = dict(self.names)
        self.tokens.take("{")
        while not self.tokens.taken("}"):
            self._statement()
        self.names = before

    def _statement(self) -> None:
        tokens = self.tokens
        if tokens.peek() == "{":
            self._block()
        elif tokens.taken("#pragma"):
            self._loop(tokens.sums.pop(0))
        elif tokens.peek() == "for":
            self._loop(None)
        elif tokens.taken("return"):
            self._returned(tokens.expression())
            tokens.take(";")
            if tokens.peek() != "}" or self.loop:
                raise NotShownError(f"{self.name} goes on after it returns")
        elif tokens.taken("("):
            tokens.take("void", ")")
            if tokens.word() not in self.roles:
                raise NotShownError("an unused name that is no argument")
            tokens.take(";")
        elif tokens.peek() in {"const", "static", "double"}:
            self._declaration()
        else:
            self._change()

    def _returned(self, node: ast.expr) -> None:
        value, shape = self.read.numeric(node)
        if self.name in {"states", "processes"}:
            slots = self.known.slots[{"states": "rhs", "processes": "heat"}[self.name]]
            if shape != WHOLE or value != self.known.position(slots, len(slots)):
                refuse(node, "another number of rows")
        elif self.slots != (Slot(""),) or self.found:
            refuse(node, "a function that returns a number")
        else:
            self.found[self.name, 0] = value

    # Declarations

    def _declaration(self) -> None:
        tokens = self.tokens
        fixed = tokens.taken("static")
        constant, kind = tokens.taken("const"), tokens.one_of("double", "long")
        pointer = tokens.taken("*")
        if pointer:
            tokens.taken("restrict")
        name = tokens.word()
        if name in self.names or name in self.roles or name in self.helpers or name in CALLS:
            raise NotShownError(f"{name} is declared twice")
        if tokens.taken("["):
            self.names[name] = self._list(fixed)
        elif not constant and kind == "double" and not pointer:
            value = None if tokens.peek() == ";" else self._initial()
            self.names[name] = Cell(value, self.loop, set(), set())
        elif constant and not fixed:
            tokens.take("=")
            node = tokens.expression()
            self.names[name] = self._pointer(node) if pointer else self._constant(node, kind)
        else:
            raise NotShownError(f"the declaration of {name}")
        tokens.take(";")

    def _initial(self) -> Value:
        self.tokens.take("=")
        return self.read.numeric(self.tokens.expression())[0]

    def _constant(self, node: ast.expr, kind: str) -> Read:
        value, shape = self.read.numeric(node)
        if kind == "long" and shape != WHOLE:
            refuse(node, "an integer")
        return value, shape if kind == "long" else PLAIN

    def _pointer(self, node: ast.expr) -> tuple[Value, str]:
        """Return what a pointer to the lanes of a parameter or a state points to."""
        match node:
            case ast.Attribute(ast.Name(p), name) if self.roles.get(p) == "p":
                name = name.rstrip("_")
                if name in self.known.parameters and name in self.known.banks:
                    return self.known.names[name], self.known.banks[name]
            case ast.BinOp(_, ast.Add(), _) if self.roles.get(_first(node)) == "x":
                place, shape = self.read.numeric(_behind(node))
                slots = self.known.slots["rhs"]
                for n, slot in enumerate(slots):
                    if slot.bank and shape == WHOLE and place == self.known.position(slots, n):
                        return self.known.names[slot.label], slot.bank
        refuse(node, "a pointer")

    def _list(self, fixed: bool) -> tuple[str, list[Value]]:
        del fixed
        tokens, listed = self.tokens, list[Value]()
        size = tokens.word()
        tokens.take("]", "=", "{")
        while not tokens.taken("}"):
            listed.append(self.read.numeric(tokens.expression())[0])
            tokens.take(",")
        if size != str(len(listed)):
            raise NotShownError("a list of another length")
        return "listed", listed

    # Loops

    def _loop(self, pragma: frozenset[str] | None) -> None:
        tokens = self.tokens
        tokens.take("for", "(", "long")
        name = tokens.word()
        tokens.take("=", "0", ";", name, "<")
        node = tokens.expression()
        tokens.take(";", "++", name, ")")
        size, shape = self.read.numeric(node)
        if name in self.names or name in self.roles or shape != WHOLE:
            raise NotShownError(f"a loop over {name}")
        slots = self.known.slots["rhs"]
        square = self.known.position(slots, len(slots))
        if self.name == "jacobian" and size == square * square and not self.found:
            tokens.take("{", self._out(), "[", name, "]", "=", "0.0", ";", "}")
            self.zeros = True
            return
        banks = {self.field.count(slot.bank): slot.bank for slot in slots if slot.bank}
        if size not in banks or len(self.lanes) > 1:
            refuse(node, "a loop over no bank")
        self._lanes(name, banks[size], pragma)

    def _lanes(self, name: str, bank: str, pragma: frozenset[str] | None) -> None:
        """Read a loop over the lanes of a bank."""
        self.loops += 1
        outer, self.loop, summed, self.summed = self.loop, self.loops, self.summed, set()
        before = dict(self.names)
        index = self.field.name("index", bank, len(self.lanes))
        self.lanes.append((name, bank))
        self.open.append(self.loop)
        self.names[name] = index, WHOLE
        self._block()
        if pragma is not None and (pragma != self.summed or self.loops != self.loop):
            raise NotShownError("a directive that names other sums than its loop has")
        self.lanes.pop()
        self.open.pop()
        self.names, self.loop, self.summed = before, outer, summed

    def _out(self) -> str:
        return next(name for name, role in self.roles.items() if role == "out")

    # Changes

    def _change(self) -> None:
        tokens = self.tokens
        name = tokens.word()
        place = None
        if tokens.taken("["):
            place = tokens.expression()
            tokens.take("]")
        added = tokens.one_of("=", "+=") == "+="
        node = tokens.expression()
        tokens.take(";")
        if place is not None and self.roles.get(name) == "out":
            self._write(place, node, added=added)
            return
        cell = self.names.get(name)
        if not isinstance(cell, Cell) or place is not None:
            raise NotShownError(f"{name} is changed")
        value = self.read.numeric(node)[0]
        if not added and cell.value is None and cell.loop == self.loop:
            cell.value = value
        elif added and cell.value is not None and self.lanes and self.loop not in cell.read:
            self._add(name, cell, value)
        else:
            raise NotShownError(f"{name} is changed where it should not be")

    def _add(self, name: str, cell: Cell, value: Value) -> None:
        if len(self.lanes) > 1 or cell.loop or cell.value is None:
            raise NotShownError(f"{name} is a sum over two loops")
        cell.value = cell.value + self.field.lane_sum(value, self.lanes[0][1])
        cell.added.add(self.loop)
        self.summed.add(name)

    def _write(self, place: ast.expr, node: ast.expr, *, added: bool) -> None:
        key = self._place(place)
        if self.name == "margins" and self._is_least(place, node, key):
            return
        if self._is_listed(node):
            name = node.body.value.id  # type: ignore[attr-defined]  # as `_is_listed` saw
            for lane, value in enumerate(self.names[name][1]):  # type: ignore[index]
                self._keep((*key, lane), value)
            return
        value = self.read.numeric(node)[0]
        other = (*key[:3], {ALL: SAME, SAME: ALL}.get(str(key[-1]), ""))
        if added and self.name == "jacobian" and self.zeros:
            self.found[key] = self.found.get(key, self.field.zero) + value
        elif other in self.found:
            raise NotShownError(f"jacobian{list(key[1:3])} is written twice")
        elif added:
            refuse(node, "something added")
        else:
            self._keep(key, value)

    def _keep(self, key: Key, value: Value) -> None:
        if key in self.found or (self.name == "jacobian" and not self.zeros):
            raise NotShownError(f"{self.name}{list(key[1:])} is written twice")
        self.found[key] = value

    def _is_least(self, place: ast.expr, node: ast.expr, key: Key) -> bool:
        """Read the least value over the lanes: ``out[n] = HUGE_VAL``, then ``min(out[n], ...)``."""
        n = int(key[1])
        if isinstance(node, ast.Name) and node.id == "HUGE_VAL" and not self.loop:
            self.least.add(n)
            return True
        match node:
            case ast.Call(ast.Name("min"), [first, value]) if n in self.least and self.lanes:
                if ast.unparse(first) == f"{self._out()}[{ast.unparse(place)}]" and self._min():
                    self._keep((self.name, n, LEAST), self.read.numeric(value)[0])
                    self.summed.add("")
                    return True
        if self.loop or n in self.least:
            refuse(node, "a margin")
        return False

    def _min(self) -> bool:
        """Return whether the file's own ``min`` is the lesser of two numbers."""
        a, b = ast.Name("a"), ast.Name("b")
        values = {n: (self.field.name(f"{n} of min", "", 0), PLAIN) for n in ("a", "b")}
        wanted = self.read.apply("minimum", [value for value, _ in values.values()])
        if "min" not in self.helpers:
            return False
        made = self._within(values, self.helpers, ast.Call(ast.Name("min"), [a, b], []))[0]
        return is_zero(made - wanted)

    def _is_listed(self, node: ast.expr) -> bool:
        """Return whether a text is ``j < n ? listed[j] : (double)NAN``, n the list's length."""
        match node:
            case ast.IfExp(
                ast.Compare(ast.Name(j), [ast.Lt()], [ast.Constant(n)]),
                ast.Subscript(ast.Name(name), ast.Name(k)),
                ast.Name("NAN"),
            ) if self.lanes and j == k == self.lanes[-1][0] and self.name == "initial_state":
                listed = self.names.get(name)
                return isinstance(listed, tuple) and listed[0] == "listed" and len(listed[1]) == n
        return False

    def _place(self, node: ast.expr) -> Key:
        """Return the row, or row and column, of a place in `out`; it is of all open loops' lanes."""
        place, shape = self.read.numeric(node)
        banks = [bank for _, bank in self.lanes]
        inner = [self.field.name("index", bank, n) for n, bank in enumerate(banks)]
        for key, lanes, value in self._places(banks, inner):
            if shape == WHOLE and lanes == len(banks) and value == place:
                return key
        if shape == WHOLE and self.name == "margins" and place.constant is not None:
            if 0 <= place.constant < len(self.slots):
                return (self.name, int(place.constant))
        refuse(node, "a place of another row")

    def _places(self, banks: list[str], inner: list[Value]) -> list[tuple[Key, int, Value]]:
        """Return every place that the open loops can write: its key, its lanes, its number."""
        places = [self.known.position(self.slots, n) for n in range(len(self.slots) + 1)]
        size, found = places[-1], []
        for r, row in enumerate(self.slots):
            own = [(0, places[r])] if not row.bank else []
            if row.bank and banks[:1] == [row.bank]:
                own = [(1, places[r] + inner[0])]
            for used, first in own:
                if self.name != "jacobian":
                    found.append(((self.name, r), used, first))
                    continue
                for c, col in enumerate(self.slots):
                    start = first * size + places[c]
                    if not col.bank:
                        found.append((("jacobian", r, c, ALL), used, start))
                        continue
                    if banks[used:] == [col.bank]:
                        found.append((("jacobian", r, c, ALL), used + 1, start + inner[used]))
                    if used and banks == [col.bank] == [row.bank]:
                        found.append((("jacobian", r, c, SAME), 1, start + inner[0]))
        return found

    # Names

    def _leaf(self, node: ast.expr) -> Read:
        match node:
            case ast.Name(name) if name in self.names:
                return self._variable(name, node)
            case ast.Attribute(ast.Name(p), name) if self.roles.get(p) == "p":
                return self._parameter(name, node)
            case ast.Subscript(ast.Name(array), place) if self.roles.get(array) in {"x", "u"}:
                return self._part(self.roles[array], place)
            case ast.Subscript(ast.Name(array), ast.Name(j)) if array in self.names:
                found, lanes = self.names[array], [name for name, _ in self.lanes]
                if isinstance(found, tuple) and isinstance(found[1], str) and j in lanes:
                    value, bank = found
                    lane = lanes.index(j)
                    if self.lanes[lane][1] == bank:
                        return (moved(value, bank, lane) if lane else value), PLAIN
            case ast.Call(ast.Name(function), args, []) if function in self.helpers:
                return self._inlined(self.helpers[function], args)
        refuse(node, "an expression")

    def _inlined(self, helper: Helper, args: list[ast.expr]) -> Read:
        """Return what a helper gives for some arguments."""
        if len(args) != len(helper.names):
            refuse(helper.value, "a call with other arguments")
        given = zip(helper.names, args, strict=True)
        inner = {n: Argument(a, t, self.names, self.helpers, {}) for (n, t), a in given}
        return self._within(inner, helper.known, helper.value)[0], PLAIN

    def _within(
        self, names: Mapping[str, object], helpers: Mapping[str, Helper], node: ast.expr
    ) -> Read:
        """Read an expression in which other names stand."""
        before = self.names, self.helpers
        self.names, self.helpers = dict(names), helpers
        read = self.read(node)
        self.names, self.helpers = before
        return read

    def _variable(self, name: str, node: ast.expr) -> Read:
        found = self.names[name]
        if isinstance(found, Argument):
            path = self.field.path
            if path not in found.known:
                found.known[path] = self._within(found.names, found.helpers, found.node)
            value, shape = found.known[path]
            if (shape == TEST) != (found.kind == "int"):
                refuse(found.node, "an argument of another type")
            return value, shape if shape == TEST else PLAIN
        if isinstance(found, Cell):
            outside = self.open[self.open.index(found.loop) + 1 :]
            found.read.update(outside)
            if found.value is None or found.added & {*outside}:
                refuse(node, "a sum that is read before its loop ends")
            return found.value, PLAIN
        if isinstance(found, tuple) and isinstance(found[1], Shape):
            return found
        refuse(node, "a list or a pointer as a number")

    def _parameter(self, name: str, node: ast.expr) -> Read:
        name = name.rstrip("_")  # names of a spec have none there
        counts = {f"{s.bank}_count": s.bank for s in self.known.slots["rhs"] if s.bank}
        if name in counts:
            return self.field.count(counts[name]), WHOLE
        if name not in self.known.parameters or name in self.known.banks:
            refuse(node, "a parameter")
        return self.known.names[name], PLAIN

    def _part(self, role: str, place: ast.expr) -> Read:
        """Return a part of x or u that is no bank's."""
        slots = self.known.slots["rhs"] if role == "x" else self.known.inputs
        value, shape = self.read.numeric(place)
        for n, slot in enumerate(slots):
            if shape == WHOLE and not slot.bank and value == self.known.position(slots, n):
                return self.known.names[slot.label], PLAIN
        refuse(place, "a place of another row")


def _first(node: ast.expr) -> str:
    """Return the first name of a sum."""
    while isinstance(node, ast.BinOp):
        node = node.left
    return node.id if isinstance(node, ast.Name) else ""


def _behind(node: ast.BinOp) -> ast.expr:
    """Return a sum without its first term."""
    if isinstance(node.left, ast.BinOp) and isinstance(node.op, ast.Add):
        return ast.BinOp(_behind(node.left), node.op, node.right)
    return node.right
