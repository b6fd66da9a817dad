"""What names mean inside a C function: arguments, variables, loops, helpers.

Input: declarations, as statements make them.  Output: the value of a name, a part of an array, a
call of one of the file's own functions.  A sum over lanes has a value when its loop has ended.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import final

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.translation.change import moved
from piezo_sym.translation.expressions import PLAIN, TEST, WHOLE, Expressions, Read, refused
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import Proved
from piezo_sym.translation.zero import is_zero

CALLS = {record.in_c: name for name, record in RECORDS.items() if record.smooth}
CALLS |= {"pow": "pow", "fabs": "abs", "copysign": "copysign"}


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


@final
@dataclass(frozen=True)
class Branches:
    """A branch, or a pointer to one per lane of the bank in whose loop it is read."""

    place: Value
    shared: bool


#: The place of a branch, of the first lane where it has some, and the bank of these.
Branch = tuple[Value, str | None]
Meaning = Read | Argument | Variable | Lanes | Listed | Branches


#: What the step's own words for comparisons stand for.
COMPARISONS: dict[str, ast.cmpop] = {"is_above": ast.Gt(), "is_at_least": ast.GtE()}


def comparison(node: ast.expr) -> ast.expr:
    """Return what a comparison of ``real`` stands for: ``is_above(a, b)`` for ``a > b``."""
    match node:
        case ast.Call(ast.Name(word), [left, right], []) if word in COMPARISONS:
            return ast.Compare(left, [COMPARISONS[word]], [right])
    raise refused(node, "a comparison")


class UnreadError(NotShownError):
    """A name stands for what has not been read: more is to be read before."""


@final
class Scope:
    """The names of one function.

    Attributes
    ----------
    roles : what each argument is: x, u, p, out, or of a stage g, b, rows, s, m.
    names : what else a name means.
    lanes : the open loops' variables and banks, outermost first.
    open : the numbers of the open loops, 0 outside of all.
    branches : what branches are known to be, where choices are by branches alone.
    """

    def __init__(
        self,
        known: Proved,
        helpers: Mapping[str, Helper],
        roles: Mapping[str, str],
        calls: Mapping[str, str],
        branches: Mapping[Branch, Value] | None,
    ) -> None:
        self.known, self.helpers, self.roles = known, helpers, roles
        self.calls, self.branches = calls, branches
        self.names: dict[str, Meaning] = {}
        self.lanes: list[tuple[str, str]] = []
        self.open = [0]
        self.read = Expressions(known.field, known.numbers, known.real, self._leaf, calls, True)

    @property
    def callable(self) -> frozenset[str]:
        """What an expression may call."""
        return frozenset({*self.calls, *self.helpers, "chosen", *COMPARISONS})

    def declare(self, name: str, meaning: Meaning) -> None:
        """Give a new name a meaning."""
        taken = (self.names, self.roles, self.helpers, self.calls)
        if any(name in table for table in taken):
            raise NotShownError(f"{name} is declared twice")
        self.names[name] = meaning

    def pointer(self, node: ast.expr) -> Lanes | Branches:
        """Return what a pointer to the lanes of a parameter or a part of an array points to."""
        match node:
            case ast.Attribute(ast.Name(p), name) if self.roles.get(p) == "p":
                name = name.rstrip("_")
                if name in self.known.parameters and name in self.known.banks:
                    return Lanes(self.known.names[name], self.known.banks[name])
            case ast.BinOp(left, ast.Add(), right):
                while isinstance(left, ast.BinOp) and isinstance(left.op, ast.Add):
                    right = ast.BinOp(left.right, ast.Add(), right)
                    left = left.left
                role = self.roles.get(left.id, "") if isinstance(left, ast.Name) else ""
                if role == "b":
                    return Branches(self.read.whole(right), shared=False)
                if role in {"x", "g"}:
                    layout = self.known.layouts[role]
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
            case ast.Subscript(ast.Name(x), place) if self.roles.get(x) in {"x", "u", "g"}:
                return self.known.part(self.roles[x], self.read.whole(place)), PLAIN
            case ast.Call(ast.Name("chosen"), [test, then, other], []):
                condition = comparison(test)
                if self.branches is None:
                    return self.read.choice(condition, then, other)
                return self.read.chosen(self._branch(condition, self.branches), then, other)
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
            if found.added & {*outside}:
                raise refused(node, "a sum that is read before its loop ends")
            if found.value is None:
                raise UnreadError(f"{ast.unparse(node)} is read before it has a value")
            return found.value, PLAIN
        if isinstance(found, tuple):
            return found
        raise refused(node, "an array as a number")

    def branch(self, place: Value, banks: Sequence[str]) -> Branch:
        """Return what branch stands at a place, of each lane in a loop."""
        if not banks:
            return place, None
        return place - self.known.field.name("index", banks[0]), banks[0]

    def given(self, node: ast.expr) -> Branches | None:
        """Return the branch that a declaration takes from what is given, if it does."""
        match node:
            case ast.Subscript(ast.Name(b), place) if self.roles.get(b) == "b":
                return Branches(self.read.whole(place), shared=True)
        return None

    def _branch(self, condition: ast.expr, branches: Mapping[Branch, Value]) -> Value:
        """Return 1 where a branch is taken: ``NAME > 0.0``, or ``NAME[j] > 0.0`` in a loop."""
        match condition:
            case ast.Compare(ast.Name(name), [ast.Gt()], [ast.Constant(0.0)]):
                bank = None
            case ast.Compare(
                ast.Subscript(ast.Name(name), ast.Name(j)), [ast.Gt()], [ast.Constant(0.0)]
            ) if [j] == [loop for loop, _ in self.lanes]:
                bank = self.lanes[0][1]
            case _:
                raise refused(condition, "a choice by something else than a branch")
        found = self.names.get(name)
        if not isinstance(found, Branches) or found.shared != (bank is None):
            raise refused(condition, "a choice by something else than a branch")
        if (found.place, bank) not in branches:
            raise UnreadError("a branch of no switching function")
        return branches[found.place, bank]

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

    def helper_is(self, helper: str, function: Callable[..., Value], count: int) -> bool:
        """Return whether a function of the file's own is a given one, of so many numbers."""
        if helper not in self.helpers:
            return False
        names = {f"a{n}": self.known.field.name(f"{n} of {helper}") for n in range(count)}
        call = ast.Call(ast.Name(helper), [ast.Name(name) for name in names], [])
        meanings = {name: (value, PLAIN) for name, value in names.items()}
        made = self._within(meanings, self.helpers, call)[0]
        return is_zero(made - function(*names.values()))

    def lesser(self) -> bool:
        """Return whether the file's own ``min`` is the lesser of two numbers."""
        return self.helper_is("min", lambda a, b: self.read.apply("minimum", [a, b]), 2)

    def listed(self, node: ast.expr) -> tuple[Value, ...]:
        """Return what ``j < n ? listed[j] : (double)NAN`` lists, n the list's length."""
        match node:
            case ast.IfExp(
                ast.Compare(ast.Name(j), [ast.Lt()], [ast.Constant(n)]),
                ast.Subscript(ast.Name(name), ast.Name(k)),
                ast.Name("NAN"),
            ) if self.lanes and j == k == self.lanes[-1][0]:
                found = self.names.get(name)
                if isinstance(found, Listed) and n == len(found.values) > 1:
                    return found.values
        return ()
