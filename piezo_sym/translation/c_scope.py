"""What names mean inside a C function: arguments, variables, loops, helpers.

Input: declarations, as statements make them.  Output: the value of a name, a part of an array, a
call of one of the file's own functions.  A sum over lanes has a value when its loop has ended.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import final

from piezo_sym.translation.change import moved
from piezo_sym.translation.expressions import PLAIN, TEST, WHOLE, Expressions, Read, refused
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import Proved
from piezo_sym.translation.zero import is_zero

CALLS = {name: name for name in ("exp", "expm1", "log", "sqrt", "sin", "cos", "tanh", "pow")}
CALLS |= {"fabs": "abs", "copysign": "copysign"}


@final
@dataclass(frozen=True)
class Helper:
    """A function of the file: its parameters and their types, what it returns, what it may call."""

    names: tuple[tuple[str, str], ...]
    value: ast.expr
    known: Mapping[str, Helper]


@final
@dataclass(frozen=True)
class Argument:
    """What a helper is given, read where it is used: a choice does not need what it leaves out.

    `known` is what it was read as, by the path of choices.
    """

    node: ast.expr
    kind: str
    names: Mapping[str, Meaning]
    helpers: Mapping[str, Helper]
    known: dict[Value | None, Read] = field(default_factory=dict)


@final
@dataclass
class Variable:
    """A variable: its value so far, the loop of its declaration, those that read or add to it."""

    value: Value | None
    loop: int
    read: set[int] = field(default_factory=set)
    added: set[int] = field(default_factory=set)


@final
@dataclass(frozen=True)
class Lanes:
    """A pointer to a number per lane of a bank: that of lane 0."""

    value: Value
    bank: str


@final
@dataclass(frozen=True)
class Listed:
    """An array of numbers."""

    values: tuple[Value, ...]


Meaning = Read | Argument | Variable | Lanes | Listed


@final
class Scope:
    """The names of one function.

    Attributes
    ----------
    roles : what each argument is: x, u, p or out.
    names : what else a name means.
    lanes : the open loops' variables and banks, outermost first.
    open : the numbers of the open loops, 0 outside of all.
    """

    def __init__(
        self, known: Proved, helpers: Mapping[str, Helper], roles: Mapping[str, str]
    ) -> None:
        self.known, self.helpers, self.roles = known, helpers, roles
        self.names: dict[str, Meaning] = {}
        self.lanes: list[tuple[str, str]] = []
        self.open = [0]
        self.read = Expressions(known.field, known.numbers, known.real, self._leaf, CALLS, True)

    def declare(self, name: str, meaning: Meaning) -> None:
        """Give a new name a meaning."""
        taken = (self.names, self.roles, self.helpers, CALLS)
        if any(name in table for table in taken):
            raise NotShownError(f"{name} is declared twice")
        self.names[name] = meaning

    def pointer(self, node: ast.expr) -> Lanes:
        """Return what a pointer to a parameter's, or a state's, lanes points to."""
        match node:
            case ast.Attribute(ast.Name(p), name) if self.roles.get(p) == "p":
                name = name.rstrip("_")
                if name in self.known.parameters and name in self.known.banks:
                    return Lanes(self.known.names[name], self.known.banks[name])
            case ast.BinOp(left, ast.Add(), right):
                while isinstance(left, ast.BinOp) and isinstance(left.op, ast.Add):
                    right = ast.BinOp(left.right, ast.Add(), right)
                    left = left.left
                if isinstance(left, ast.Name) and self.roles.get(left.id) == "x":
                    layout = self.known.layouts["x"]
                    slot = layout.slots[layout.at(self.read.whole(right), bank=True)]
                    return Lanes(self.known.names[slot.label], slot.bank or "")
        raise refused(node, "a pointer")

    def _leaf(self, node: ast.expr) -> Read:
        match node:
            case ast.Name(name) if name in self.names:
                return self._named(self.names[name], node)
            case ast.Attribute(ast.Name(p), name) if self.roles.get(p) == "p":
                value, whole = self.known.parameter(name.rstrip("_"))  # names of a spec have none
                return value, WHOLE if whole else PLAIN
            case ast.Subscript(ast.Name(x), place) if self.roles.get(x) in {"x", "u"}:
                return self.known.part(self.roles[x], self.read.whole(place)), PLAIN
            case ast.Subscript(ast.Name(array), ast.Name(j)):
                found, loops = self.names.get(array), [name for name, _ in self.lanes]
                if isinstance(found, Lanes) and (j, found.bank) in self.lanes:
                    lane = loops.index(j)
                    return moved(found.value, found.bank, 1) if lane else found.value, PLAIN
            case ast.Call(ast.Name(function), args, []) if function in self.helpers:
                return self._inlined(self.helpers[function], args, node), PLAIN
        raise refused(node, "an expression")

    def _named(self, found: Meaning, node: ast.expr) -> Read:
        if isinstance(found, Argument):
            path = self.known.field.path
            if path not in found.known:
                found.known[path] = self._within(found.names, found.helpers, found.node)
            value, shape = found.known[path]
            if (shape == TEST) != (found.kind == "int"):
                raise refused(found.node, "an argument of another type")
            return value, shape if shape == TEST else PLAIN
        if isinstance(found, Variable):
            outside = self.open[self.open.index(found.loop) + 1 :]
            found.read.update(outside)
            if found.value is None or found.added & {*outside}:
                raise refused(node, "a sum that is read before its loop ends")
            return found.value, PLAIN
        if isinstance(found, tuple):
            return found
        raise refused(node, "an array as a number")

    def _inlined(self, helper: Helper, args: list[ast.expr], node: ast.expr) -> Value:
        """Return what a helper gives for some arguments."""
        if len(args) != len(helper.names):
            raise refused(node, "a call with other arguments")
        inner = {
            name: Argument(arg, kind, self.names, self.helpers)
            for (name, kind), arg in zip(helper.names, args, strict=True)
        }
        return self._within(inner, helper.known, helper.value)[0]

    def _within(
        self, names: Mapping[str, Meaning], helpers: Mapping[str, Helper], node: ast.expr
    ) -> Read:
        """Read an expression in which other names stand."""
        before = self.names, self.helpers
        self.names, self.helpers = dict(names), helpers
        read = self.read(node)
        self.names, self.helpers = before
        return read

    def lesser(self) -> bool:
        """Return whether the file's own ``min`` is the lesser of two numbers."""
        if "min" not in self.helpers:
            return False
        names = {n: (self.known.field.name(f"{n} of min"), PLAIN) for n in ("a", "b")}
        call = ast.Call(ast.Name("min"), [ast.Name("a"), ast.Name("b")], [])
        made = self._within(names, self.helpers, call)[0]
        return is_zero(made - self.read.apply("minimum", [value for value, _ in names.values()]))
