"""What names mean inside a C function: arguments, constants, sums over lanes, helpers.

Input: expressions, and the names known at the place of each.  Output: their values.  An expression
is read only when its value is needed: a choice does not need the value that it does not take, and a
stage chooses by switching functions that it writes later.
"""

from __future__ import annotations

import ast
from collections import ChainMap
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import final

from piezo_sym.translation.change import moved
from piezo_sym.translation.expressions import PLAIN, TEST, WHOLE, Expressions, Read, Shape, refused
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import Proved
from piezo_sym.translation.signs import compare, on_path
from piezo_sym.translation.zero import is_zero

#: The comparison that each macro of a step stands for.
_COMPARISONS = {"is_above": ">", "is_at_least": ">="}
#: The macros of a step that do not stand for functions of the C library.
_WORDS = {"wide", *_COMPARISONS}


@final
@dataclass(frozen=True)
class File:
    """What the functions of a C file have in common."""

    known: Proved
    number: str  # the type of its numbers
    record: str  # the type that holds parameters
    signatures: Mapping[str, str]  # the roles of each function's arguments, in order
    calls: Mapping[str, str]  # library functions that may be called, and the functions they compute
    #: By "function argument", the function of `Proved` whose rows are written; else the same one.
    results: Mapping[str, str] = field(default_factory=dict)
    helpers: dict[str, ast.FunctionDef] = field(default_factory=dict)  # functions of the file's own
    parts: dict[str, ast.FunctionDef] = field(default_factory=dict)  # of functions
    called: set[str] = field(default_factory=set)  # the parts that functions call


@final
@dataclass(frozen=True, eq=False)
class Deferred:
    """An expression that is read when its value is needed, with the scope in which it stands.

    `kind` is the parameter's type if it is an argument of a helper, else ""; `known` has the value
    read so far on each path of choices.
    """

    node: ast.expr
    scope: Scope
    kind: str = ""
    known: dict[Value | None, Read] = field(default_factory=dict)

    def read(self) -> Read:
        """Return the expression's value and shape."""
        field = self.scope.file.known.field
        # a statement is executed on every branch; only an argument of a helper may not be needed
        with on_path(field, field.path if self.kind else field.one):
            if field.path not in self.known:
                read, test = self.scope.read, self.kind == "int"
                found = (read.test(self.node), TEST) if test else read.numeric(self.node)
                self.known[field.path] = found
            return self.known[field.path]

    @property
    def value(self) -> Value:
        """The expression's value."""
        return self.read()[0]


@final
@dataclass(eq=False)
class CVariable:
    """A variable: its first value, and the terms that loops over the lanes of a bank add to it.

    It must not be read in a loop that adds to it (`is_open`), nor changed after it has been read.
    `lanes` has variable and bank of each loop in which it is declared.
    """

    start: Deferred | None
    lanes: tuple[tuple[str, str], ...]
    parts: list[tuple[Deferred, str]] = field(default_factory=list)
    is_open: bool = False
    is_read: bool = False

    @cached_property
    def value(self) -> Value:
        """The variable's value after the loops."""
        assert self.start is not None
        field = self.start.scope.file.known.field
        sums = (field.lane_sum(part.value, bank) for part, bank in self.parts)
        return field.total((self.start.value, *sums))


#: The place of a branch (with one per lane, of the first lane), and the bank or None.
Branch = tuple[Value, str | None]
#: Whether a name points to one branch per lane, and its place in the array of branches.
Place = tuple[bool, Value]
#: A `Read` with lanes is a pointer to them; a list is an array.
Meaning = Read | Deferred | CVariable | Place | list[Deferred]


@final
@dataclass(frozen=True, eq=False)
class Scope:
    """The names of a function, of a loop in it, or of a helper that it calls."""

    file: File
    roles: Mapping[str, str]  # what each argument is: x, u, p, out, or of a stage g, b, rows, s, m
    names: ChainMap[str, Meaning]  # the meaning of all other names
    #: (variable, bank) of each loop, outermost first; in a list, (index of the entry, bank).
    lanes: tuple[tuple[str, str], ...] = ()
    #: The switching functions written so far if branches alone make the choices, else None.
    switches: dict[Branch, Deferred | Value] | None = None

    @cached_property
    def read(self) -> Expressions:
        """The reader of expressions in this scope."""
        known = self.file.known
        return Expressions(known.field, known.numbers, self._leaf, self.file.calls, True)

    @property
    def banks(self) -> tuple[str, ...]:
        """The banks whose lanes the loops go over."""
        return tuple(bank for _, bank in self.lanes)

    def declare(self, name: str, meaning: Meaning) -> None:
        """Give a name a meaning; refuse a name that has one."""
        taken = (self.names, self.roles, self.file.helpers, self.file.calls, _WORDS, {"zero"})
        if any(name in table for table in taken):
            raise NotShownError(f"{name} is declared twice")
        self.names[name] = meaning

    def block(self) -> Scope:
        """Return the scope of a block; names declared in it are unknown after it."""
        return replace(self, names=self.names.new_child())

    def of_lanes(self, name: str, bank: str) -> Scope:
        """Return the scope of a loop over the lanes of a bank."""
        inner = replace(self.block(), lanes=(*self.lanes, (name, bank)))
        inner.declare(name, (self.file.known.field.name("index", bank, len(self.lanes)), WHOLE))
        return inner

    def defer(self, node: ast.expr) -> Deferred:
        """Return an expression of this scope, to be read later; refuse names without a meaning."""
        parts = list(ast.walk(node))
        functions = [part.func for part in parts if isinstance(part, ast.Call)]
        file, called = self.file, set(map(ast.unparse, functions)) - _WORDS
        if any(name not in file.calls and name not in file.helpers for name in called):
            raise refused(node, "a call")
        for part in parts:
            if isinstance(part, ast.Name) and part not in functions:
                found = self.names.get(part.id)
                if found is None and part.id not in self.roles and part.id not in {"NAN", "zero"}:
                    raise refused(part, "a name")
                if isinstance(found, CVariable):
                    if found.is_open or found.start is None:
                        raise refused(part, "a variable that is read too early")
                    found.is_read = True
        return Deferred(node, self)

    def meaning(self, kind: str, node: ast.expr) -> Meaning:
        """Return the meaning of a constant that is declared as a number, an index or a pointer."""
        known = self.file.known
        match kind, node:
            case "index", _:
                return self.read.whole(node), WHOLE
            case _, ast.Subscript(ast.Name(b), place) if self.roles.get(b) == "b":
                return kind == "pointer", self.read.whole(place)
            case "number", _:
                return self.defer(node)
            case _, ast.Subscript(ast.Name(x), place) if self.roles.get(x) in {"x", "g"}:
                value = known.part(self.roles[x], self.read.whole(place), bank=True)
            case _, ast.Attribute(ast.Name(p), name) if self.roles.get(p) == "p":
                if name.rstrip("_") not in known.iphs.model.parameters:
                    raise refused(node, "a pointer")
                value = known.names[name.rstrip("_")]
            case _:
                raise refused(node, "a pointer")
        banks = [bank for bank, _ in value.lanes]
        if not banks:
            raise refused(node, "a pointer")
        return value, Shape("lanes", banks[0])

    def _leaf(self, node: ast.expr) -> Read:
        known, names, real = self.file.known, self.names, self.file.number == "real"
        match node:
            case ast.Name(name) if name in names:
                match names[name]:
                    case Deferred() as found:
                        value, shape = found.read()
                        return value if found.kind else known.field.letter(value), shape
                    case CVariable() as found:
                        return found.value, PLAIN
                    case (Value() as value, Shape(bank="") as shape):
                        return value, shape
            case ast.Name("zero") if real:
                return known.field.zero, PLAIN
            case ast.Attribute(ast.Name(p), name) if self.roles.get(p) == "p":
                value, whole = known.parameter(name.rstrip("_"))  # no name of a spec ends with _
                return value, WHOLE if whole else PLAIN
            case ast.Subscript(ast.Name(x), place) if self.roles.get(x) in {"x", "u", "g"}:
                return known.part(self.roles[x], self.read.whole(place), bank=False), PLAIN
            case ast.Subscript(ast.Name(array), ast.Name() | ast.Constant() as place):
                for lane, (loop, bank) in enumerate(self.lanes):
                    at = ast.unparse(place), bank
                    match names.get(array):
                        case (Value() as value, Shape("lanes", own)) if (loop, own) == at:
                            return moved(value, bank, 1) if lane else value, PLAIN
            case ast.Call(ast.Name("wide"), [arg], []) if real:
                return self.read.any(arg)
            case ast.Call(ast.Name(word), [left, right], []) if real and word in _COMPARISONS:
                if self.switches is not None:
                    return self._branch(node, self.switches), TEST
                sides = self.read.numeric(left)[0], self.read.numeric(right)[0]
                return compare(_COMPARISONS[word], *sides), TEST
            case ast.Call(ast.Name(function), args, []) if function in self.file.helpers:
                return self._inlined(self.file.helpers[function], args, node), PLAIN
        raise refused(node, "an expression")

    def _inlined(self, helper: ast.FunctionDef, args: list[ast.expr], node: ast.expr) -> Value:
        """Return the value of a helper for some arguments."""
        if len(args) != len(helper.args.args):
            raise refused(node, "a call with other arguments")
        names = ChainMap[str, Meaning]()
        for own, arg in zip(helper.args.args, args, strict=True):
            names[own.arg] = Deferred(arg, self, kind_of(own.annotation))
        match helper.body:
            case [ast.Return(ast.expr() as value)]:
                return Scope(self.file, {}, names).read(value)[0]
        raise refused(node, "a call of what is more than an expression")

    def listed(self, node: ast.expr) -> list[Deferred]:
        """Return the entries of `listed` in ``j < n ? listed[j] : (double)NAN`` of length n."""
        match node, self.lanes:
            case ast.IfExp(
                ast.Compare(ast.Name(j), [ast.Lt()], [ast.Constant(n)]),
                ast.Subscript(ast.Name(name), ast.Name(k)),
                ast.Name("NAN"),
            ), [*_, (own, _)] if j == k == own:
                found = self.names.get(name)
                if isinstance(found, list) and n == len(found) > 1:
                    fits = {part.scope.banks for part in found} <= {(), self.banks}
                    return found if fits else []
        return []

    def branch(self, place: Value) -> Branch:
        """Return the branch at a place; in a loop, the place of the first lane's, and the bank."""
        if not self.banks:
            return place, None
        return place - self.file.known.field.name("index", self.banks[0]), self.banks[0]

    def _branch(self, condition: ast.expr, switches: dict[Branch, Deferred | Value]) -> Value:
        """Return 1 where a branch is taken: ``is_above(NAME, 0.0)``, or ``NAME[j]`` in a loop."""
        name, bank = "", None
        match condition:
            case ast.Call(ast.Name("is_above"), [ast.Name(shared), ast.Constant(0.0)]):
                name = shared
            case ast.Call(
                ast.Name("is_above"),
                [ast.Subscript(ast.Name(array), ast.Name(j)), ast.Constant(0.0)],
            ) if [j] == [loop for loop, _ in self.lanes]:
                name, bank = array, self.banks[0]
        match self.names.get(name):
            case (bool() as pointer, Value() as place) if pointer == (bank is not None):
                branch = place, bank
            case _:
                raise refused(condition, "a choice by something else than a branch")
        switch = switches.pop(branch, None)  # it must not choose by its own sign
        if switch is None:
            raise refused(condition, "a branch of no switching function, or of its own")
        if isinstance(switch, Deferred):
            switch = compare(">", switch.value, self.file.known.field.zero)
        switches[branch] = switch
        return switch


def helper_is(file: File, name: str, function: Callable[..., Value], count: int) -> bool:
    """Return whether a helper of the file is shown to equal `function` of `count` numbers."""
    if name not in file.helpers:
        return False
    args = [file.known.field.name(f"{n} of {name}") for n in range(count)]
    names = {f"a{n}": (arg, PLAIN) for n, arg in enumerate(args)}
    call = ast.Call(ast.Name(name), [ast.Name(arg) for arg in names], [])
    return is_zero(Scope(file, {}, ChainMap({**names})).read(call)[0] - function(*args))


def kind_of(annotation: ast.expr | None) -> str:
    """Return a type, as `c_text` writes it."""
    return str(annotation.value) if isinstance(annotation, ast.Constant) else ""
