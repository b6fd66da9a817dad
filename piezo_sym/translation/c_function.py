"""A function of printed C, read back: the rows that it writes as values in normal form.

Input: a function as `c_text` gives it.  Output: values by row.  The grammar, in C:

    statement   const double or long NAME = expression;     double NAME [= expression];
                const double *[restrict] NAME = pointer;    NAME = or += expression;
                [static] const double NAME[n] = { ... };    OUT[place] = or += expression;
                for (long j = 0; j < size; ++j) { ... }     { ... }     return expression;
                FUNCTION_part_N(its own arguments);
    expression  ? :  ||  comparisons  + - * /  calls, names, numbers, NAME[place], P->NAME

A loop stands for every lane of a bank: what it adds up is a sum over lanes, what it writes is a row
of that lane.
"""

import ast
from collections import ChainMap
from collections.abc import Collection, Iterable
from dataclasses import replace
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.translation.c_scope import (
    Branch,
    CVariable,
    Deferred,
    File,
    Scope,
    helper_is,
    kind_of,
)
from piezo_sym.translation.expressions import refused
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import LEAST, Key, Rows

#: Arguments that may be written to: results, ledger rows, switching functions, margins.
WRITTEN = ("out", "rows", "s", "m")
#: The value in `File.results` for rows that are not compared with the proved system.
NOT_COMPARED = ""


@final
class CFunction:
    """A function, read statement by statement; its values are read where `rows` asks for them.

    Parameters
    ----------
    by_branches : whether branches alone make the choices; else comparisons do.

    Attributes
    ----------
    switches : the switching functions that are written, by the branch that each decides.
    places : place and bank of each value that is written but not compared.
    """

    def __init__(self, node: ast.FunctionDef, file: File, *, by_branches: bool = False) -> None:
        self.file, self.known = file, file.known
        prefix = f"{file.known.iphs.model.name}_"
        self.name = node.name.removeprefix(prefix) if node.name.startswith(prefix) else ""
        roles = self._roles(node)
        self.switches: dict[Branch, Deferred | Value] = {}
        self.places: list[Branch] = []
        switches = self.switches if by_branches else None
        self.scope = Scope(file, roles, ChainMap(), switches=switches)
        given = {"out", *roles.values()} & {*WRITTEN} - {"s"}
        named = {role: file.results.get(f"{self.name} {role}", self.name) for role in given}
        self.rows_of = {role: Rows(self.known, name) for role, name in named.items()}
        self.constants = list[Deferred]()
        self.written = list[tuple[str, Key, Deferred, bool]]()
        self.loops, self.summed, self.least = 0, dict[str, CVariable | None](), set[Key]()
        self.returned = "out" in roles.values()
        self.node, self.whole, self.called = node, self.scope, set[str]()
        self._block(self.scope, node.body)
        if not self.returned or self.least - {key for _, key, _, _ in self.written}:
            raise NotShownError(f"{self.name} leaves numbers that were never written")

    def rows(self, roles: Collection[str] = WRITTEN) -> dict[Key, Value]:
        """Return the rows that the function writes to the arguments with some roles."""
        self.known.field.derived = self.name == "jacobian"
        for part in self.constants if "out" in roles else ():
            part.read()
        found: dict[Key, Value] = {}
        for role, key, part, added in self.written:
            if role in roles:
                self.rows_of[role].keep(key, part.value, added=added)
                found[key] = self.rows_of[role].found[key]
        return found

    def _roles(self, node: ast.FunctionDef) -> dict[str, str]:
        """Return the role (x, u, p, out, ...) of each argument by its name; refuse other types."""
        words, file = self.file.signatures.get(self.name, "").split(), self.file
        types = dict.fromkeys(WRITTEN, f"{file.number} * restrict")
        types["p"] = f"const {file.known.iphs.model.name}_{file.record} * restrict"
        wanted = [types.get(word, f"const {file.number} * restrict") for word in words]
        kind = "void" if "out" in words else "long" if words == ["p"] else "double"
        static = "static " if file.number == "real" else ""
        roles = dict(zip((arg.arg for arg in node.args.args), words, strict=False))
        found = [kind_of(arg.annotation) for arg in node.args.args]
        if found != wanted or kind_of(node.returns) != static + kind or not words:
            raise NotShownError(f"a function {node.name} of such types")
        return roles

    def _block(self, inner: Scope, body: Iterable[ast.stmt]) -> None:
        outside, self.scope = self.scope, inner
        for node in body:
            if self.returned and "out" not in self.scope.roles.values():
                raise refused(node, "a statement behind a return")
            self._statement(node)
        self.scope = outside

    def _statement(self, node: ast.stmt) -> None:
        match node:
            case ast.AnnAssign(ast.Name(name), kind, value):
                self._declare(name, kind_of(kind), value)
            case ast.Assign([ast.Subscript(ast.Name(array), place)], value):
                self._change(array, place, value, added=False)
            case ast.AugAssign(ast.Subscript(ast.Name(array), place), ast.Add(), value):
                self._change(array, place, value, added=True)
            case ast.Assign([ast.Name(name)], value):
                self._set(name, value)
            case ast.AugAssign(ast.Name(name), ast.Add(), value):
                self._add(name, value)
            case ast.For(ast.Name(name), ast.Call(ast.Name(word), [size, *sums]), body):
                names = [*map(ast.unparse, sums)]
                self._loop(name, size, body, set(names) if word == "simd" else None)
            case ast.With(body=body):
                self._block(self.scope.block(), body)
            case ast.Return(ast.expr() as value):
                self._return(value)
            case ast.Expr(ast.Call(ast.Name(name), args, [])) if name in self.file.parts:
                self._part_of(name, args)
            case ast.Expr(ast.Name(name)) if name in self.scope.roles:  # (void)u;
                pass
            case ast.Pass():
                pass
            case _:
                raise refused(node, "a statement")

    def _part_of(self, name: str, args: list[ast.expr]) -> None:
        """Read a call of a part: it takes the function's own arguments and calls no part itself."""
        part, own, writes = self.file.parts[name], self.node, "out" in self.scope.roles.values()
        given = [ast.unparse(arg) for arg in args] == [arg.arg for arg in own.args.args]
        same = given and ast.unparse(part.args) == ast.unparse(own.args)
        alone = self.scope is self.whole and name not in self.called
        if not (same and alone and writes and name.startswith(f"{own.name}_part_")):
            raise NotShownError(f"{name} is no part of {own.name}, or called elsewhere")
        self.called.add(name)
        self.file.called.add(name)
        self._block(replace(self.scope, names=ChainMap()), part.body)

    def _return(self, node: ast.expr) -> None:
        if self.returned or self.scope.lanes:
            raise refused(node, "a return")
        self.returned = True
        if self.rows_of["out"].slots == (Slot(""),):
            self.written.append(("out", (self.name, 0), self.scope.defer(node), False))
            return
        counted = self.known.layouts[{"states": "rhs", "processes": "heat"}[self.name]]
        if self.scope.read.whole(node) != counted.places[-1]:
            raise refused(node, "another number of rows")

    def _declare(self, name: str, kind: str, value: ast.expr | None) -> None:
        scope, number = self.scope, self.file.number
        pointer = f"const {number} *"
        kinds = {f"const {number}": "number", "const long": "index"}
        kinds |= {pointer: "pointer", f"{pointer} restrict": "pointer"}
        if kind == number:
            start = self._kept(value) if value else None
            scope.declare(name, CVariable(start, scope.lanes))
        elif isinstance(value, ast.List):
            if kind.removeprefix("static ") != f"const {number} [ {len(value.elts)} ]":
                raise NotShownError("a list of another length")
            scope.declare(name, [self._part(n, part) for n, part in enumerate(value.elts)])
        elif kind in kinds and value:
            meaning = scope.meaning(kinds[kind], value)
            self.constants += [meaning] if isinstance(meaning, Deferred) else []
            scope.declare(name, meaning)
        else:
            raise NotShownError(f"the declaration of {name}")

    def _loop(
        self, name: str, size: ast.expr, body: list[ast.stmt], named: set[str] | None
    ) -> None:
        rows, lanes = self.rows_of["out"], self.scope.read.whole(size)
        first = not self.written and not self.scope.lanes
        if self.name == "jacobian" and lanes == rows.size * rows.size and first:
            out = next(name for name, role in self.scope.roles.items() if role == "out")
            if [ast.unparse(part) for part in body] != [f"{out}[{name}] = 0.0"] or named:
                raise refused(size, "a loop over no bank")
            rows.zeros = True
            return
        banks = self.known.bank_of_size
        if lanes not in banks or len(self.scope.lanes) > 1:
            raise refused(size, "a loop over no bank")
        outside, self.loops = self.summed, self.loops + 1
        number, self.summed = self.loops, {}
        self._block(self.scope.of_lanes(name, banks[lanes]), body)
        if named is not None and (named != self.summed.keys() or self.loops != number):
            raise NotShownError("a directive that names other sums than its loop has")
        for added in filter(None, self.summed.values()):
            added.is_open = False
        self.summed = outside

    def _kept(self, node: ast.expr) -> Deferred:
        """Return the expression that a variable is set to; it is read even if nothing needs it."""
        self.constants.append(self.scope.defer(node))
        return self.constants[-1]

    def _part(self, n: int, node: ast.expr) -> Deferred:
        """Return entry n of a list; ``n < size ? part : (double)NAN`` is of lane n of a bank."""
        outside = self.scope
        match node:
            case ast.IfExp(ast.Compare(lane, [ast.Lt()], [size]), part, ast.Name("NAN")):
                bank = self.known.bank_of_size.get(outside.read.whole(size))
                if bank and ast.unparse(lane) == str(n) and not outside.lanes:
                    self.scope, node = replace(outside, lanes=((str(n), bank),)), part
        found, self.scope = self._kept(node), outside
        return found

    def _set(self, name: str, node: ast.expr) -> None:
        found = self.scope.names.get(name)
        if not isinstance(found, CVariable) or found.start or found.lanes != self.scope.lanes:
            raise NotShownError(f"{name} is changed where it should not be")
        found.start = self._kept(node)

    def _add(self, name: str, node: ast.expr) -> None:
        """Read what a loop adds to a sum over lanes."""
        part, banks, found = self._kept(node), self.scope.banks, self.scope.names.get(name)
        sums = isinstance(found, CVariable) and found.start and not found.lanes
        if not isinstance(found, CVariable) or not sums or len(banks) != 1 or found.is_read:
            raise refused(node, "a sum that is changed where it should not be, or read in its loop")
        found.is_open, self.summed[name] = True, found
        found.parts.append((part, banks[0]))

    def _change(self, array: str, place: ast.expr, node: ast.expr, *, added: bool) -> None:
        role, at = self.scope.roles.get(array, ""), self.scope.read.whole(place)
        if role == "s" and not added:
            self._switch(at, node)
            return
        if role not in self.rows_of:
            raise NotShownError(f"{array} is changed")
        rows = self.rows_of[role]
        if rows.name == NOT_COMPARED:
            self.places.append(self.scope.branch(at))
            self.scope.defer(node)
            return
        if rows.name == "margins" and self._is_least(role, place, at, node):
            return
        key = rows.key_at(at, self.scope.banks)
        listed = self.scope.listed(node) if self.name == "initial_state" else []
        if key is None or (listed and added):
            raise refused(place, "a place of another row")
        for lane, part in enumerate(listed):
            self.written.append((role, (*key, lane), part, False))
        if not listed:
            self.written.append((role, key, self.scope.defer(node), added))

    def _switch(self, place: Value, node: ast.expr) -> None:
        """Read the assignment of a switching function, in a loop one per lane."""
        branch = self.scope.branch(place)
        if branch in self.switches or len(self.scope.lanes) > 1:
            raise refused(node, "a switching function that is not written once")
        self.switches[branch] = self._kept(node)

    def _is_least(self, role: str, place: ast.expr, at: Value, node: ast.expr) -> bool:
        """Return whether it finds a minimum: ``out[n] = HUGE_VAL``, then ``min(out[n], ...)``."""
        n = int(at.constant) if at.constant is not None else -1
        key, scope = ("margins", n, LEAST), self.scope
        most, least = (
            ("wide(HUGE_VAL)", "least") if self.file.number == "real" else ("HUGE_VAL", "min")
        )
        if ast.unparse(node) == most and not scope.lanes and key not in self.least:
            self.least.add(key)
            return True
        match node:
            case ast.Call(ast.Name(word), [ast.Subscript(ast.Name(name)) as first, value]):
                own = scope.roles.get(name) == role and key in self.least and word == least
                own = own and ast.unparse(first) == f"{name}[{ast.unparse(place)}]"
                lesser = lambda a, b: scope.read.apply("minimum", [a, b])  # noqa: E731
                known = word == "least" or helper_is(self.file, "min", lesser, 2)
                if own and scope.lanes and known:
                    self.summed["the least"] = None
                    self.written.append((role, key, scope.defer(value), False))
                    return True
        if scope.lanes or key in self.least:
            raise refused(node, "a margin")
        return False
