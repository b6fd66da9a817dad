"""A function of printed C, read back: the rows that it writes as values in normal form.

Input: the tokens of a file, at a function.  Output: values by row.  The grammar:

    statement   [const] double or long NAME = expression;   NAME += expression;
                [static] const double NAME[n] = { ... };    OUT[place] = or += expression;
                for (long j = 0; j < size; ++j) { ... }     { ... }     return expression;
    expression  ? :  ||  comparisons  + - * /  calls, names, numbers, NAME[place], P->NAME

A loop stands for every lane of a bank: what it adds up is a sum over lanes, what it writes is a row
of that lane.  A function can be read in part: only some results, and the names that these need.
"""

import ast
from collections.abc import Collection, Mapping
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.translation.c_form import Form
from piezo_sym.translation.c_scope import Branch, Helper, Listed, Scope, UnreadError, Variable
from piezo_sym.translation.c_text import Tokens
from piezo_sym.translation.expressions import PLAIN, WHOLE, refused
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import LEAST, Key, Proved
from piezo_sym.translation.rows import Rows

#: Functions in which ``j < n ? listed[j] : (double)NAN`` is a number for each lane.
_LISTED = ("initial_state",)


@final
class Function:
    """Reads one function, statement by statement.

    Parameters
    ----------
    only : the results to read, such as ``out[]``, and the names that these need; all if None.
    without : a result that is not read.
    branches : what branches are known to be; if None, choices are by comparisons.

    Attributes
    ----------
    uses : the names in what each name, or result, is made of.
    switches : what is written of switching functions, by the branch that each decides.
    places : what is written and not read, by its place and bank.
    """

    def __init__(
        self,
        tokens: Tokens,
        model: str,
        known: Proved,
        helpers: Mapping[str, Helper],
        form: Form,
        *,
        only: Collection[str] | None = None,
        without: str = "",
        branches: Mapping[Branch, Value] | None = None,
    ) -> None:
        self.tokens, self.known, self.field = tokens, known, known.field
        self.name, roles = form.head(tokens, model)
        self.scope = Scope(known, helpers, roles, form.calls, branches)
        self.read, self.only, self.without = self.scope.read, only, without
        results = form.results(self.name, roles)
        self.written = {role: Rows(known, name) for role, name in results.items()}
        self.returned = "out" in roles.values()
        self.switches: dict[Branch, Value | None] = {}
        self.loops, self.summed, self.least = 0, set[str](), set[int]()
        self.uses: dict[str, set[str]] = {}
        self.places: list[Branch] = []
        self.field.derived = self.name == "jacobian"

    def rows(self) -> dict[Key, Value]:
        """Return the rows that the function writes."""
        self._block()
        found = {key: value for rows in self.written.values() for key, value in rows.found.items()}
        least = {("margins", n, LEAST) for n in self.least}
        if not self.returned or (self._is_read("m[]") and least - {*found}):
            raise NotShownError(f"{self.name} leaves numbers that were never written")
        return found

    def _is_read(self, name: str) -> bool:
        return name != self.without if self.only is None else name in self.only

    def _block(self) -> None:
        before = dict(self.scope.names)
        self.tokens.take("{")
        while not self.tokens.taken("}"):
            self._statement()
        self.scope.names = before

    def _statement(self) -> None:
        tokens = self.tokens
        if tokens.peek() == "{":
            self._block()
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
        self.returned, rows = True, self.written["out"]
        if rows.slots == (Slot(""),):
            rows.keep((self.name, 0), self.read.numeric(node)[0])
            return
        counted = self.known.layouts[{"states": "rhs", "processes": "heat"}[self.name]]
        if self.read.whole(node) != counted.places[-1]:
            raise refused(node, "another number of rows")

    def _value(self, name: str, node: ast.expr) -> Value | None:
        """Return what a name is set to, or adds, if it is to be read and can be."""
        parts = [*ast.walk(node)]
        words = {part.id for part in parts if isinstance(part, ast.Name)}
        called = {ast.unparse(part.func) for part in parts if isinstance(part, ast.Call)}
        if not called <= self.scope.callable:
            raise refused(node, "a call")
        self.uses.setdefault(name, set()).update(words)
        if self._is_read(name):
            try:
                return self.read.numeric(node)[0]
            except UnreadError:
                if self.only is None:
                    raise
        return None

    # Declarations

    def _declaration(self) -> None:
        tokens, declare = self.tokens, self.scope.declare
        fixed, constant = tokens.taken("static"), tokens.taken("const")
        kind, pointer = tokens.one_of("double", "long"), tokens.taken("*")
        _ = pointer and tokens.taken("restrict")
        name, loop = tokens.word(), self.scope.open[-1]
        if constant and not pointer and tokens.taken("["):
            declare(name, self._list())
        elif fixed or (kind == "long" and (pointer or not constant)) or pointer > constant:
            raise NotShownError(f"the declaration of {name}")
        elif not constant and not pointer and tokens.peek() == ";":
            declare(name, Variable(None, loop))
        else:
            tokens.take("=")
            node = tokens.expression()
            if pointer:
                declare(name, self.scope.pointer(node))
            elif constant and (branch := self.scope.given(node)):
                declare(name, branch)
            elif kind == "long":
                declare(name, (self.read.whole(node), WHOLE))
            elif (value := self._value(name, node)) is None or not constant:
                declare(name, Variable(value, loop))
            else:
                declare(name, (self.field.letter(value), PLAIN))
        tokens.take(";")

    def _list(self) -> Listed:
        tokens, values = self.tokens, list[Value]()
        size = tokens.next()
        tokens.take("]", "=", "{")
        while not tokens.taken("}"):
            values.append(self.read.numeric(tokens.expression())[0])
            tokens.take(",")
        if size != str(len(values)):
            raise NotShownError("a list of another length")
        return Listed(tuple(values))

    # Loops

    def _loop(self, pragma: frozenset[str] | None) -> None:
        tokens, rows = self.tokens, self.written["out"]
        tokens.take("for", "(", "long")
        name = tokens.word()
        tokens.take("=", "0", ";", name, "<")
        node = tokens.expression()
        tokens.take(";", "++", name, ")")
        size, square = self.read.whole(node), rows.size * rows.size
        if self.name == "jacobian" and size == square and not rows.found and not self.scope.lanes:
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
        scope, before, self.loops = self.scope, dict(self.scope.names), self.loops + 1
        number, outer, self.summed = self.loops, self.summed, set()
        scope.declare(name, (self.field.name("index", bank, len(scope.lanes)), WHOLE))
        scope.lanes.append((name, bank))
        scope.open.append(number)
        self._block()
        wrong = pragma is not None and (pragma != self.summed or self.loops != number)
        if wrong and self.only is None:
            raise NotShownError("a directive that names other sums than its loop has")
        scope.lanes.pop()
        scope.open.pop()
        scope.names, self.summed = before, outer

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
            self._switch(self.read.whole(place), node)
        elif place is not None and role in self.written:
            self._write(role, place, node, added=added)
        elif place is not None or not isinstance(found, Variable):
            raise NotShownError(f"{name} is changed")
        elif added:
            self._add(name, found, node)
        elif found.value is None and found.loop == self.scope.open[-1]:
            found.value = self._value(name, node)
        else:
            raise NotShownError(f"{name} is changed where it should not be")

    def _add(self, name: str, found: Variable, node: ast.expr) -> None:
        """Read what a loop adds to a sum over lanes."""
        value, loop = self._value(name, node), self.scope.open[-1]
        self.summed.add(name)
        if len(self.scope.lanes) != 1 or found.loop or loop in found.read:
            raise refused(node, "a sum that is changed where it should not be, or read in its loop")
        if value is None or found.value is None:
            if self.only is None:
                raise refused(node, "a sum without its first value")
            found.value = None
            return
        found.value = found.value + self.field.lane_sum(value, self.scope.lanes[0][1])
        found.added.add(loop)

    def _switch(self, place: Value, node: ast.expr) -> None:
        """Read a switching function, of each lane in a loop."""
        banks = [bank for _, bank in self.scope.lanes]
        branch = self.scope.branch(place, banks)
        value = self._value("s[]", node)
        if branch in self.switches or len(banks) > 1:
            raise refused(node, "a switching function that is not written once")
        self.switches[branch] = value

    def _write(self, role: str, place: ast.expr, node: ast.expr, *, added: bool) -> None:
        rows, at = self.written[role], self.read.whole(place)
        banks = tuple(bank for _, bank in self.scope.lanes)
        if not self._is_read(f"{role}[]"):
            self._value(f"{role}[]", node)
            self.summed |= {"the least"} if role == "m" and banks else set()
            self.places.append(self.scope.branch(at, banks))
            return
        if rows.name == "margins" and self._is_least(role, place, at, node):
            return
        key = rows.key_at(at, banks)
        listed = self.scope.listed(node) if self.name in _LISTED else ()
        if key is None or (listed and added):
            raise refused(place, "a place of another row")
        for lane, part in enumerate(listed):
            rows.keep((*key, lane), part)
        if not listed and (value := self._value(f"{role}[]", node)) is not None:
            rows.keep(key, value, added=added)

    def _is_least(self, role: str, place: ast.expr, at: Value, node: ast.expr) -> bool:
        """Read the least value over the lanes: ``out[n] = HUGE_VAL``, then ``min(out[n], ...)``."""
        n = int(at.constant) if at.constant is not None else -1
        match node:
            case ast.Name("HUGE_VAL") if not self.scope.lanes and n not in self.least:
                self.least.add(n)
                return True
            case ast.Call(ast.Name("min"), [ast.Subscript(ast.Name(name)) as first, value]):
                own = self.scope.roles.get(name) == role and n in self.least
                own = own and ast.unparse(first) == f"{name}[{ast.unparse(place)}]"
                if own and self.scope.lanes and self.scope.lesser():
                    self.summed.add("the least")
                    if (found := self._value(f"{role}[]", value)) is not None:
                        self.written[role].keep(("margins", n, LEAST), found)
                    return True
        if self.scope.lanes or n in self.least:
            raise refused(node, "a margin")
        return False
