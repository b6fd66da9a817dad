"""A printed C file, read back: rows of its functions as values in normal form.

Input: the text of ``<model>.c`` without the step, and the proved system, for names and places.
Output: values by function and row.  The grammar:

    file        comments, ``#include "<model>.h"``, ``#include <math.h>``, functions
    helper      static double NAME(double or int NAME, ...) { return expression; }
    statement   [const] double or long NAME = expression;   NAME += expression;
                [static] const double NAME[n] = { ... };    OUT[place] = or += expression;
                for (long j = 0; j < size; ++j) { ... }     { ... }     return expression;
    expression  ? :  ||  comparisons  + - * /  calls, names, numbers, NAME[place], P->NAME

A loop stands for every lane of a bank: what it adds up is a sum over lanes, what it writes is a row
of that lane.  Helpers mean what their text says.  Nothing is compiled or executed.
"""

import ast
import re
from collections.abc import Mapping
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.translation.c_scope import CALLS, Helper, Listed, Scope, Variable
from piezo_sym.translation.c_text import Tokens
from piezo_sym.translation.expressions import PLAIN, WHOLE, refused
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import LEAST, Key, Proved
from piezo_sym.translation.rows import Rows

SIGNATURES = dict.fromkeys(
    ["rhs", "jacobian", "margins", "outputs", "supply", "heat", "entropy_production"], "x u p out"
) | {"initial_state": "u p out", "temperatures": "x p out", "energy": "x p", "entropy": "x p"}
SIGNATURES |= {"states": "p", "processes": "p"}
_HELPERS = r"pick|sign|min|max|saturate|deadzone|power_[2-8]"


def read_c(text: str, name: str, known: Proved) -> dict[Key, Value]:
    """Return every row that the functions of a C file write.

    Raises
    ------
    NotShownError
        If something is outside the grammar; it says what.
    """
    tokens = Tokens(text, name)
    helpers: dict[str, Helper] = {}
    rows, seen = dict[Key, Value](), set[str]()
    while tokens.peek():
        if tokens.taken("static"):
            helper, made = _helper(tokens, helpers)
            if helper in helpers or helper in CALLS or not re.fullmatch(_HELPERS, helper):
                raise NotShownError(f"a function {helper} of the C file's own")
            helpers[helper] = made
            continue
        function = _Function(tokens, name, known, helpers)
        if function.name in seen:
            raise NotShownError(f"{function.name} is defined twice")
        seen.add(function.name)
        rows |= function.rows()
    if seen != SIGNATURES.keys():
        raise NotShownError("the C file lacks a function")
    return rows


def _helper(tokens: Tokens, helpers: Mapping[str, Helper]) -> tuple[str, Helper]:
    tokens.take("double")
    name, names = tokens.word(), list[tuple[str, str]]()
    tokens.take("(")
    while not names or tokens.taken(","):
        kind = tokens.one_of("double", "int")
        names.append((tokens.word(), kind))
    tokens.take(")", "{", "return")
    value = tokens.expression()
    tokens.take(";", "}")
    return name, Helper(tuple(names), value, dict(helpers))


@final
class _Function:
    """Reads one function, statement by statement."""

    def __init__(
        self, tokens: Tokens, model: str, known: Proved, helpers: Mapping[str, Helper]
    ) -> None:
        self.tokens, self.known, self.field = tokens, known, known.field
        kind = tokens.one_of("void", "double", "long")
        word, prefix = tokens.word(), f"{model}_"
        self.name = word[len(prefix) :] if word.startswith(prefix) else ""
        words = SIGNATURES.get(self.name, "").split()
        roles = {self._argument(word, model, n): word for n, word in enumerate(words)}
        tokens.take(")")
        wanted = "void" if "out" in words else "long" if words == ["p"] else "double"
        if kind != wanted or len(roles) != len(words) or not words:
            raise NotShownError(f"a function {word} of such types")
        self.scope, self.written = Scope(known, helpers, roles), Rows(known, self.name)
        self.read, self.keep = self.scope.read, self.written.keep
        self.out = next((name for name, role in roles.items() if role == "out"), "")
        self.loops, self.summed, self.least = 0, set[str](), set[int]()
        self.returned = kind == "void"
        self.field.derived = self.name == "jacobian"

    def _argument(self, word: str, model: str, n: int) -> str:
        self.tokens.take("," if n else "(")
        types = {"out": "double * restrict", "p": f"const {model}_parameters * restrict"}
        self.tokens.take(*types.get(word, "const double * restrict").split())
        return self.tokens.word()

    def rows(self) -> dict[Key, Value]:
        """Return the rows that the function writes."""
        self._block()
        found = self.written.found
        if not self.returned or {(self.name, n, LEAST) for n in self.least} - {*found}:
            raise NotShownError(f"{self.name} leaves numbers that were never written")
        return found

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
            self._loop(tokens.sums.pop(0))
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
        if self.written.slots == (Slot(""),):
            self.keep((self.name, 0), self.read.numeric(node)[0])
            return
        counted = self.known.layouts[{"states": "rhs", "processes": "heat"}[self.name]]
        if self.read.whole(node) != counted.places[-1]:
            raise refused(node, "another number of rows")

    # Declarations

    def _declaration(self) -> None:
        tokens = self.tokens
        fixed, constant = tokens.taken("static"), tokens.taken("const")
        kind, pointer = tokens.one_of("double", "long"), tokens.taken("*")
        _ = pointer and tokens.taken("restrict")
        name = tokens.word()
        if constant and not pointer and tokens.taken("["):
            self.scope.declare(name, self._list())
        elif (
            fixed or (not constant and (pointer or kind == "long")) or (pointer and kind == "long")
        ):
            raise NotShownError(f"the declaration of {name}")
        elif not constant and not pointer and tokens.peek() == ";":
            self.scope.declare(name, Variable(None, self.scope.open[-1]))
        else:
            tokens.take("=")
            node = tokens.expression()
            if pointer and constant:
                self.scope.declare(name, self.scope.pointer(node))
            elif constant:
                whole = (self.read.whole(node), WHOLE) if kind == "long" else None
                value = self.field.zero if whole else self.field.letter(self.read.numeric(node)[0])
                self.scope.declare(name, whole or (value, PLAIN))
            else:
                value = self.read.numeric(node)[0]
                self.scope.declare(name, Variable(value, self.scope.open[-1]))
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
        tokens = self.tokens
        tokens.take("for", "(", "long")
        name = tokens.word()
        tokens.take("=", "0", ";", name, "<")
        node = tokens.expression()
        tokens.take(";", "++", name, ")")
        size, square = self.read.whole(node), self.written.size * self.written.size
        inside = self.written.found or self.scope.lanes
        if self.name == "jacobian" and size == square and not inside:
            tokens.take("{", self.out, "[", name, "]", "=", "0.0", ";", "}")
            self.written.zeros = True
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
        if pragma is not None and (pragma != self.summed or self.loops != number):
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
        found, loop = self.scope.names.get(name), self.scope.open[-1]
        if place is not None and name == self.out:
            self._write(place, node, added=added)
        elif place is not None or not isinstance(found, Variable):
            raise NotShownError(f"{name} is changed")
        elif not added and found.value is None and found.loop == loop:
            found.value = self.read.numeric(node)[0]
        elif added and len(self.scope.lanes) == 1 and found.loop == 0 and found.value is not None:
            value = self.read.numeric(node)[0]
            if loop in found.read:
                raise refused(node, "a sum that is read in its loop")
            found.value = found.value + self.field.lane_sum(value, self.scope.lanes[0][1])
            found.added.add(loop)
            self.summed.add(name)
        else:
            raise NotShownError(f"{name} is changed where it should not be")

    def _write(self, place: ast.expr, node: ast.expr, *, added: bool) -> None:
        at, banks = self.read.whole(place), tuple(bank for _, bank in self.scope.lanes)
        if self.name == "margins" and self._is_least(place, at, node):
            return
        key = self.written.key_at(at, banks)
        listed = self._listed(node)
        if key is None or (listed and added):
            raise refused(place, "a place of another row")
        for lane, value in enumerate(listed):
            self.keep((*key, lane), value)
        if not listed:
            self.keep(key, self.read.numeric(node)[0], added=added)

    def _is_least(self, place: ast.expr, at: Value, node: ast.expr) -> bool:
        """Read the least value over the lanes: ``out[n] = HUGE_VAL``, then ``min(out[n], ...)``."""
        n = int(at.constant) if at.constant is not None else -1
        match node:
            case ast.Name("HUGE_VAL") if not self.scope.lanes and n not in self.least:
                self.least.add(n)
                return True
            case ast.Call(ast.Name("min"), [first, value]) if n in self.least and self.scope.lanes:
                if (
                    ast.unparse(first) == f"{self.out}[{ast.unparse(place)}]"
                    and self.scope.lesser()
                ):
                    self.keep((self.name, n, LEAST), self.read.numeric(value)[0])
                    self.summed.add("the least")
                    return True
        if self.scope.lanes or n in self.least:
            raise refused(node, "a margin")
        return False

    def _listed(self, node: ast.expr) -> tuple[Value, ...]:
        """Return what ``j < n ? listed[j] : (double)NAN`` lists, n the list's length."""
        match node:
            case ast.IfExp(
                ast.Compare(ast.Name(j), [ast.Lt()], [ast.Constant(n)]),
                ast.Subscript(ast.Name(name), ast.Name(k)),
                ast.Name("NAN"),
            ) if self.scope.lanes and j == k == self.scope.lanes[-1][0]:
                found = self.scope.names.get(name)
                if isinstance(found, Listed) and n == len(found.values) > 1:
                    return found.values if self.name == "initial_state" else ()
        return ()
