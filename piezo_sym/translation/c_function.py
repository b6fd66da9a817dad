"""A function of printed C, read back: the rows that it writes as values in normal form.

Input: the tokens of a file, at a function.  Output: values by row.  The grammar:

    statement   const double or long NAME = expression;     double NAME [= expression];
                const double *[restrict] NAME = pointer;    NAME = or += expression;
                [static] const double NAME[n] = { ... };    OUT[place] = or += expression;
                for (long j = 0; j < size; ++j) { ... }     { ... }     return expression;
    expression  ? :  ||  comparisons  + - * /  calls, names, numbers, NAME[place], P->NAME

A loop stands for every lane of a bank: what it adds up is a sum over lanes, what it writes is a row
of that lane.
"""

import ast
from collections import ChainMap
from collections.abc import Collection
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.translation.c_scope import Branch, CVariable, Deferred, Scope, helper_is
from piezo_sym.translation.c_text import File, Tokens
from piezo_sym.translation.expressions import WHOLE, refused
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import LEAST, Key, Rows

#: What may be written to: results, ledger rows, switching functions, margins.
WRITTEN = ("out", "rows", "s", "m")
#: What stands in `File.results` for rows that are not compared.
NOT_COMPARED = ""


@final
class CFunction:
    """A function, read statement by statement; its values are read where `rows` asks for them.

    Parameters
    ----------
    by_branches : whether choices are by branches alone; else they are by comparisons.

    Attributes
    ----------
    switches : what is written of switching functions, by the branch that each decides.
    places : what is written and not compared, by its place and bank.
    """

    def __init__(self, tokens: Tokens, file: File, *, by_branches: bool = False) -> None:
        self.tokens, self.file, self.known = tokens, file, file.known
        self.name, roles = self._head()
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
        self._block(self.scope)
        if not self.returned or self.least - {key for _, key, _, _ in self.written}:
            raise NotShownError(f"{self.name} leaves numbers that were never written")

    def rows(self, roles: Collection[str] = WRITTEN) -> dict[Key, Value]:
        """Return the rows that are written to some arguments."""
        self.known.field.derived = self.name == "jacobian"
        for part in self.constants if "out" in roles else ():
            part.read()
        found: dict[Key, Value] = {}
        for role, key, part, added in self.written:
            if role in roles:
                self.rows_of[role].keep(key, part.value, added=added)
                found[key] = self.rows_of[role].found[key]
        return found

    def _head(self) -> tuple[str, dict[str, str]]:
        """Take the head: the function's name, and what its arguments are by name."""
        tokens, prefix = self.tokens, f"{self.file.model}_"
        kind, word = tokens.one_of("void", "double", "long"), tokens.word()
        name = word[len(prefix) :] if word.startswith(prefix) else ""
        words = self.file.signatures.get(name, "").split()
        roles = {self._argument(word, n): word for n, word in enumerate(words)}
        tokens.take(")")
        wanted = "void" if "out" in words else "long" if words == ["p"] else "double"
        if kind != wanted or len(roles) != len(words) or not words:
            raise NotShownError(f"a function {word} of such types")
        return name, roles

    def _argument(self, role: str, n: int) -> str:
        self.tokens.take("," if n else "(")
        types = dict.fromkeys(WRITTEN, "double * restrict")
        types["p"] = f"const {self.file.model}_{self.file.record} * restrict"
        self.tokens.take(*types.get(role, "const double * restrict").split())
        return self.tokens.word()

    # Statements

    def _block(self, inner: Scope) -> None:
        outside, self.scope = self.scope, inner
        self.tokens.take("{")
        while not self.tokens.taken("}"):
            self._statement()
        self.scope = outside

    def _statement(self) -> None:
        tokens = self.tokens
        if tokens.peek() == "{":
            self._block(self.scope.block())
        elif tokens.taken("#pragma"):
            self._loop(tokens.sums[tokens.at - 1])
        elif tokens.peek() == "for":
            self._loop(None)
        elif tokens.taken("return"):
            self._return(tokens.expression())
        elif tokens.taken("("):  # (void)u;
            tokens.take("void", ")")
            tokens.one_of(*self.scope.roles)
            tokens.take(";")
        elif tokens.peek() in {"const", "static", "double"}:
            self._declaration()
        else:
            self._change()

    def _return(self, node: ast.expr) -> None:
        self.tokens.take(";")
        if self.tokens.peek() != "}" or self.returned or self.scope.lanes:
            raise refused(node, "a return")
        self.returned = True
        if self.rows_of["out"].slots == (Slot(""),):
            self.written.append(("out", (self.name, 0), self.scope.defer(node), False))
            return
        counted = self.known.layouts[{"states": "rhs", "processes": "heat"}[self.name]]
        if self.scope.read.whole(node) != counted.places[-1]:
            raise refused(node, "another number of rows")

    def _declaration(self) -> None:
        tokens, scope = self.tokens, self.scope
        fixed, constant = tokens.taken("static"), tokens.taken("const")
        kind, pointer = tokens.one_of("double", "long"), tokens.taken("*")
        _ = pointer and tokens.taken("restrict")
        name = tokens.word()
        if constant and not pointer and tokens.taken("["):
            scope.declare(name, self._list())
        elif fixed or (not constant and (kind == "long" or pointer)):
            raise NotShownError(f"the declaration of {name}")
        elif not constant and tokens.peek() == ";":
            scope.declare(name, CVariable(None, scope.lanes))
        else:
            tokens.take("=")
            node = tokens.expression()
            if pointer and kind == "double":
                scope.declare(name, scope.pointer(node))
            elif kind == "long" and not pointer:
                scope.declare(name, (scope.read.whole(node), WHOLE))
            elif constant and (branch := scope.shared_branch(node)):
                scope.declare(name, branch)
            else:
                part = self._kept(node)
                scope.declare(name, part if constant else CVariable(part, scope.lanes))
        tokens.take(";")

    def _list(self) -> list[Deferred]:
        tokens, values = self.tokens, list[Deferred]()
        size = tokens.next()
        tokens.take("]", "=", "{")
        while not tokens.taken("}"):
            values.append(self._kept(tokens.expression()))
            tokens.take(",")
        if size != str(len(values)):
            raise NotShownError("a list of another length")
        return values

    def _loop(self, pragma: frozenset[str] | None) -> None:
        tokens, rows = self.tokens, self.rows_of["out"]
        tokens.take("for", "(", "long")
        name = tokens.word()
        tokens.take("=", "0", ";", name, "<")
        node = tokens.expression()
        tokens.take(";", "++", name, ")")
        size, square = self.scope.read.whole(node), rows.size * rows.size
        first = not self.written and not self.scope.lanes
        if self.name == "jacobian" and size == square and first:
            out = next(name for name, role in self.scope.roles.items() if role == "out")
            tokens.take("{", out, "[", name, "]", "=", "0.0", ";", "}")
            rows.zeros = True
            return
        banks = self.known.bank_of_size
        if size not in banks or len(self.scope.lanes) > 1:
            raise refused(node, "a loop over no bank")
        self._lanes(name, banks[size], pragma)

    def _lanes(self, name: str, bank: str, pragma: frozenset[str] | None) -> None:
        """Read a loop over the lanes of a bank."""
        outside, self.loops = self.summed, self.loops + 1
        number, self.summed = self.loops, {}
        self._block(self.scope.of_lanes(name, bank))
        if pragma is not None and (pragma != self.summed.keys() or self.loops != number):
            raise NotShownError("a directive that names other sums than its loop has")
        for added in filter(None, self.summed.values()):
            added.is_open = False
        self.summed = outside

    # Changes

    def _change(self) -> None:
        tokens, place = self.tokens, None
        name = tokens.word()
        if tokens.taken("["):
            place = tokens.expression()
            tokens.take("]")
        added = tokens.one_of("=", "+=") == "+="
        node = tokens.expression()
        tokens.take(";")
        found, role = self.scope.names.get(name), self.scope.roles.get(name, "")
        if place is not None and role == "s" and not added:
            self._switch(self.scope.read.whole(place), node)
        elif place is not None and role in self.rows_of:
            self._write(role, place, node, added=added)
        elif place is not None or not isinstance(found, CVariable):
            raise NotShownError(f"{name} is changed")
        elif added:
            self._add(name, found, node)
        elif found.start is None and found.lanes == self.scope.lanes:
            found.start = self._kept(node)
        else:
            raise NotShownError(f"{name} is changed where it should not be")

    def _kept(self, node: ast.expr) -> Deferred:
        """Return what a variable or constant is set to; it is read even if nothing needs it."""
        self.constants.append(self.scope.defer(node))
        return self.constants[-1]

    def _add(self, name: str, found: CVariable, node: ast.expr) -> None:
        """Read what a loop adds to a sum over lanes."""
        part, banks = self._kept(node), self.scope.banks
        if len(banks) != 1 or found.lanes or found.is_read or found.start is None:
            raise refused(node, "a sum that is changed where it should not be, or read in its loop")
        found.is_open, self.summed[name] = True, found
        found.parts.append((part, banks[0]))

    def _switch(self, place: Value, node: ast.expr) -> None:
        """Read a switching function, of each lane in a loop."""
        branch = self.scope.branch(place)
        if branch in self.switches or len(self.scope.lanes) > 1:
            raise refused(node, "a switching function that is not written once")
        self.switches[branch] = self._kept(node)

    def _write(self, role: str, place: ast.expr, node: ast.expr, *, added: bool) -> None:
        rows, at = self.rows_of[role], self.scope.read.whole(place)
        if rows.name == NOT_COMPARED:
            self.places.append(self.scope.branch(at))
            self.scope.defer(node)
            return
        if rows.name == "margins" and self._is_least(role, place, at, node):
            return
        key = rows.key_at(at, self.scope.banks)
        listed = self._listed(node)
        if key is None or (listed and added):
            raise refused(place, "a place of another row")
        for lane, part in enumerate(listed):
            self.written.append((role, (*key, lane), part, False))
        if not listed:
            self.written.append((role, key, self.scope.defer(node), added))

    def _listed(self, node: ast.expr) -> list[Deferred]:
        """Return what ``j < n ? listed[j] : (double)NAN`` lists, n the list's length."""
        match node:
            case ast.IfExp(
                ast.Compare(ast.Name(j), [ast.Lt()], [ast.Constant(n)]),
                ast.Subscript(ast.Name(name), ast.Name(k)),
                ast.Name("NAN"),
            ) if self.scope.lanes and j == k == self.scope.lanes[-1][0]:
                found = self.scope.names.get(name)
                if isinstance(found, list) and n == len(found) > 1 and self.name == "initial_state":
                    return found
        return []

    def _is_least(self, role: str, place: ast.expr, at: Value, node: ast.expr) -> bool:
        """Read the least value over the lanes: ``out[n] = HUGE_VAL``, then ``min(out[n], ...)``."""
        n = int(at.constant) if at.constant is not None else -1
        key, scope = ("margins", n, LEAST), self.scope
        match node:
            case ast.Name("HUGE_VAL") if not scope.lanes and key not in self.least:
                self.least.add(key)
                return True
            case ast.Call(ast.Name("min"), [ast.Subscript(ast.Name(name)) as first, value]):
                own = scope.roles.get(name) == role and key in self.least
                own = own and ast.unparse(first) == f"{name}[{ast.unparse(place)}]"
                lesser = lambda a, b: scope.read.apply("minimum", [a, b])  # noqa: E731
                if own and scope.lanes and helper_is(self.file, "min", lesser, 2):
                    self.summed["the least"] = None
                    self.written.append((role, key, scope.defer(value), False))
                    return True
        if scope.lanes or key in self.least:
            raise refused(node, "a margin")
        return False
