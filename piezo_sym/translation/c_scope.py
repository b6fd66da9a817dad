"""What names mean inside a C function: arguments, constants, sums over lanes, helpers.

Input: expressions, and the names that stand where they are written.  Output: their values.  An
expression is read where its value is needed: a choice does not need what it leaves out, and a stage
chooses by switching functions that it writes later.
"""

from __future__ import annotations

import ast
from collections import ChainMap
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import final

from piezo_sym.translation.c_text import COMPARISONS, File, Helper
from piezo_sym.translation.change import moved
from piezo_sym.translation.expressions import PLAIN, TEST, WHOLE, Expressions, Read, refused
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.signs import compare, on_path
from piezo_sym.translation.zero import is_zero


@final
@dataclass(frozen=True, eq=False)
class Deferred:
    """An expression that is read where its value is needed, with the names where it is written.

    `kind` is the type of the helper's parameter that it is given for, if it is; `known` is what it
    was read as, by the path of choices.
    """

    node: ast.expr
    scope: Scope
    kind: str = ""
    known: dict[Value | None, Read] = field(default_factory=dict)

    def read(self) -> Read:
        """Return its value and shape."""
        field = self.scope.file.known.field
        # a statement is executed whatever is chosen
        with on_path(field, field.path if self.kind else field.one):
            if field.path not in self.known:
                read, test = self.scope.read, self.kind == "int"
                found = (read.test(self.node), TEST) if test else read.numeric(self.node)
                self.known[field.path] = found
            return self.known[field.path]

    @property
    def value(self) -> Value:
        """Its value."""
        return self.read()[0]


@final
@dataclass(eq=False)
class CVariable:
    """A variable: what it is set to, and what loops over the lanes of a bank add to it.

    It is not read in a loop that adds to it (`is_open`), and not changed when it has been read.
    `lanes` are those of the loops in which it is declared.
    """

    start: Deferred | None
    lanes: tuple[tuple[str, str], ...]
    parts: list[tuple[Deferred, str]] = field(default_factory=list)
    is_open: bool = False
    is_read: bool = False

    @cached_property
    def value(self) -> Value:
        """Its value after the loops."""
        assert self.start is not None
        field = self.start.scope.file.known.field
        sums = (field.lane_sum(part.value, bank) for part, bank in self.parts)
        return field.total((self.start.value, *sums))


@final
@dataclass(frozen=True)
class BranchReference:
    """A branch, or a pointer to one per lane of the bank in whose loop it is read."""

    place: Value
    shared: bool


#: The place of a branch, of the first lane where it has some, and the bank of these.
Branch = tuple[Value, str | None]
#: A `Value` is a pointer to the numbers of lanes, as that of lane 0; a list is an array.
Meaning = Read | Deferred | CVariable | Value | list[Deferred] | BranchReference


@final
@dataclass(frozen=True, eq=False)
class Scope:
    """The names of a function, of a loop in it, or of a helper that it calls.

    Attributes
    ----------
    roles : what each argument is: x, u, p, out, or of a stage g, b, rows, s, m.
    names : what else a name means.
    lanes : the variables and banks of the loops, outermost first.
    switches : what is written of switching functions, where choices are by branches alone.
    """

    file: File
    roles: Mapping[str, str]
    names: ChainMap[str, Meaning]
    lanes: tuple[tuple[str, str], ...] = ()
    switches: dict[Branch, Deferred | Value] | None = None

    @cached_property
    def read(self) -> Expressions:
        """The reader of expressions in which these names stand."""
        known = self.file.known
        return Expressions(
            known.field, known.numbers, known.real, self._leaf, self.file.calls, True
        )

    @property
    def banks(self) -> tuple[str, ...]:
        """The banks whose lanes the loops go over."""
        return tuple(bank for _, bank in self.lanes)

    def declare(self, name: str, meaning: Meaning) -> None:
        """Give a new name a meaning."""
        taken = (self.names, self.roles, self.file.helpers, self.file.calls)
        if any(name in table for table in taken):
            raise NotShownError(f"{name} is declared twice")
        self.names[name] = meaning

    def block(self) -> Scope:
        """Return what stands in a block: names of its own are forgotten behind it."""
        return replace(self, names=self.names.new_child())

    def of_lanes(self, name: str, bank: str) -> Scope:
        """Return what stands in a loop over the lanes of a bank."""
        inner = replace(self.block(), lanes=(*self.lanes, (name, bank)))
        inner.declare(name, (self.file.known.field.name("index", bank, len(self.lanes)), WHOLE))
        return inner

    def defer(self, node: ast.expr) -> Deferred:
        """Return an expression that is written here; refuse names that stand for nothing yet."""
        callable_ = (self.file.calls, self.file.helpers, {"chosen"}, COMPARISONS)
        parts = list(ast.walk(node))
        functions = [part.func for part in parts if isinstance(part, ast.Call)]
        if not all(any(ast.unparse(f) in table for table in callable_) for f in functions):
            raise refused(node, "a call")
        for part in parts:
            if isinstance(part, ast.Name) and part not in functions:
                found = self.names.get(part.id)
                if found is None and part.id not in {*self.roles, "NAN"}:
                    raise refused(part, "a name")
                if isinstance(found, CVariable):
                    if found.is_open or found.start is None:
                        raise refused(part, "a variable that is read too early")
                    found.is_read = True
        return Deferred(node, self)

    # Meanings

    def pointer(self, node: ast.expr) -> Value | BranchReference:
        """Return what a pointer to the lanes of a parameter or a part of an array points to."""
        known = self.file.known
        match node:
            case ast.Attribute(ast.Name(p), name) if self.roles.get(p) == "p":
                name = name.rstrip("_")
                if name in known.iphs.model.parameters and name in known.banks:
                    return known.names[name]
            case ast.BinOp(left, ast.Add(), right):
                while isinstance(left, ast.BinOp) and isinstance(left.op, ast.Add):
                    right = ast.BinOp(left.right, ast.Add(), right)
                    left = left.left
                role = self.roles.get(left.id, "") if isinstance(left, ast.Name) else ""
                if role == "b":
                    return BranchReference(self.read.whole(right), shared=False)
                if role in {"x", "g"}:
                    return known.part(role, self.read.whole(right), bank=True)
        raise refused(node, "a pointer")

    def _leaf(self, node: ast.expr) -> Read:
        known = self.file.known
        match node:
            case ast.Name(name) if name in self.names:
                return self._named(self.names[name], node)
            case ast.Attribute(ast.Name(p), name) if self.roles.get(p) == "p":
                value, whole = known.parameter(name.rstrip("_"))  # names of a spec have none
                return value, WHOLE if whole else PLAIN
            case ast.Subscript(ast.Name(x), place) if self.roles.get(x) in {"x", "u", "g"}:
                return known.part(self.roles[x], self.read.whole(place), bank=False), PLAIN
            case ast.Subscript(ast.Name(array), ast.Name(j)):
                found = self.names.get(array)
                for lane, (loop, bank) in enumerate(self.lanes):
                    if isinstance(found, Value) and loop == j and found.lanes == {(bank, 0)}:
                        return moved(found, bank, 1) if lane else found, PLAIN
            case ast.Call(
                ast.Name("chosen"), [ast.Call(ast.Name(word), sides, []), then, other], []
            ) if word in COMPARISONS and len(sides) == 2:
                condition = ast.Compare(sides[0], [COMPARISONS[word]], [sides[1]])
                if self.switches is None:
                    return self.read.choice(condition, then, other)
                return self.read.chosen(self._branch(condition, self.switches), then, other)
            case ast.Call(ast.Name(function), args, []) if function in self.file.helpers:
                return self._inlined(self.file.helpers[function], args, node), PLAIN
        raise refused(node, "an expression")

    def _named(self, found: Meaning, node: ast.expr) -> Read:
        match found:
            case Deferred():
                value, shape = found.read()
                return value if found.kind else self.file.known.field.letter(value), shape
            case CVariable():
                return found.value, PLAIN
            case tuple():
                return found
        raise refused(node, "an array as a number")

    def _inlined(self, helper: Helper, args: list[ast.expr], node: ast.expr) -> Value:
        """Return what a helper gives for some arguments."""
        if len(args) != len(helper.parameters):
            raise refused(node, "a call with other arguments")
        given = zip(helper.parameters, args, strict=True)
        names = {name: Deferred(arg, self, kind) for (name, kind), arg in given}
        return Scope(self.file, {}, ChainMap({**names})).read(helper.value)[0]

    # Branches

    def shared_branch(self, node: ast.expr) -> BranchReference | None:
        """Return the branch that ``b[place]`` is, if an expression is that."""
        match node:
            case ast.Subscript(ast.Name(b), place) if self.roles.get(b) == "b":
                return BranchReference(self.read.whole(place), shared=True)
        return None

    def branch(self, place: Value) -> Branch:
        """Return what branch stands at a place, of each lane in a loop."""
        if not self.banks:
            return place, None
        return place - self.file.known.field.name("index", self.banks[0]), self.banks[0]

    def _branch(self, condition: ast.expr, switches: dict[Branch, Deferred | Value]) -> Value:
        """Return 1 where a branch is taken: ``NAME > 0.0``, or ``NAME[j] > 0.0`` in a loop."""
        name, bank = "", None
        match condition:
            case ast.Compare(ast.Name(shared), [ast.Gt()], [ast.Constant(0.0)]):
                name = shared
            case ast.Compare(
                ast.Subscript(ast.Name(array), ast.Name(j)), [ast.Gt()], [ast.Constant(0.0)]
            ) if [j] == [loop for loop, _ in self.lanes]:
                name, bank = array, self.banks[0]
        found = self.names.get(name)
        if not isinstance(found, BranchReference) or found.shared != (bank is None):
            raise refused(condition, "a choice by something else than a branch")
        branch = found.place, bank
        switch = switches.pop(branch, None)  # while it is read, it is nobody's branch
        if switch is None:
            raise refused(condition, "a branch of no switching function, or of its own")
        if isinstance(switch, Deferred):
            switch = compare(">", switch.value, self.file.known.field.zero)
        switches[branch] = switch
        return switch


def helper_is(file: File, helper: str, function: Callable[..., Value], count: int) -> bool:
    """Return whether a function of the file's own is a given one, of so many numbers."""
    if helper not in file.helpers:
        return False
    args = [file.known.field.name(f"{n} of {helper}") for n in range(count)]
    names = {f"a{n}": (arg, PLAIN) for n, arg in enumerate(args)}
    call = ast.Call(ast.Name(helper), [ast.Name(name) for name in names], [])
    return is_zero(Scope(file, {}, ChainMap({**names})).read(call)[0] - function(*args))
