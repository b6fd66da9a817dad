"""A printed NumPy module, read back: rows of its functions as values in normal form.

Input: the text of ``<model>.py`` and what it may name.  Output: values by function and row, and
what they are divided by.  The grammar is that of straight code: each name is assigned once, from
parameters, parts of x and u, or an expression; rows of `out` are written once.  Tables, parameters
and the helpers of a module have to be word for word what is expected.  Nothing is executed.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.translation.change import moved
from piezo_sym.translation.expressions import (
    PLAIN,
    WHOLE,
    Expressions,
    Read,
    Shape,
    joined,
    refuse,
)
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.reference import ALL, LEAST, SAME, Key, Proved

ARGUMENTS = {
    "initial_state": "u p",
    "_rates": "x u p out",
    "jacobian": "x u p",
    "margins": "x u p",
    "outputs": "x u p",
    "supply": "x u p",
    "heat": "x u p",
    "entropy_production": "x u p",
    "energy": "x p",
    "entropy": "x p",
    "temperatures": "x p",
}
CALLS = {f"np.{name}": name for name in ("exp", "expm1", "log", "sqrt", "sin", "cos", "tanh")}
CALLS |= {"np.abs": "abs", "np.sign": "sign", "np.minimum": "minimum", "np.maximum": "maximum"}
CALLS |= {"np.clip": "clip"}


def read_numpy(functions: Mapping[str, ast.FunctionDef], known: Proved) -> dict[Key, Value]:
    """Return every row that the functions of a module write; see `head` for the rest of it.

    Raises
    ------
    NotShownError
        If something is outside the grammar; it says what.
    """
    rows: dict[Key, Value] = {}
    for name, words in ARGUMENTS.items():
        if name not in functions:
            raise NotShownError(f"there is no function {name}")
        rows |= _Function(functions[name], words.split(), known).rows()
    return rows


@final
class _Function:
    """Reads one function.

    Names stand for values (`values`), or for arguments and index arrays (`roles`).
    """

    def __init__(self, node: ast.FunctionDef, words: Sequence[str], known: Proved) -> None:
        self.node, self.known, self.field = node, known, known.field
        self.name = node.name.replace("_rates", "rhs")
        given = node.args
        arguments = [arg.arg for arg in given.posonlyargs]
        others = (given.args, given.kwonlyargs, given.defaults, given.vararg, given.kwarg)
        if len(arguments) != len(words) or any(others) or node.decorator_list:
            refuse(node, "the arguments of a function")
        self.words = dict(zip(words, arguments, strict=True))
        unchecked = {"x", "u"} if node.name != "_rates" else set()
        self.roles = {a: w for w, a in self.words.items() if w not in unchecked}
        self.values: dict[str, Read] = {}
        self.lanes: dict[str, tuple[Value, Value]] = {}
        self.slots = known.slots[self.name]
        self.places = [known.position(self.slots, n) for n in range(len(self.slots) + 1)]
        self.filled = node.name == "_rates"
        self.found: dict[Key, Value] = {}
        self.field.derived = self.name == "jacobian"
        self.read = Expressions(self.field, known.numbers, self._leaf, CALLS, False)

    def rows(self) -> dict[Key, Value]:
        """Return the rows that the function writes."""
        doc, *body = self.node.body
        if not (isinstance(doc, ast.Expr) and isinstance(doc.value, ast.Constant)):
            refuse(doc, "a function without docstring")
        last = body.pop() if self.node.name != "_rates" else None
        for statement in body:
            self._statement(statement)
        if isinstance(last, ast.Return) and last.value:
            self._returned(last.value)
        elif last:
            refuse(last, "a last statement")
        if self.name == "initial_state":  # made of zeros
            written = {key[1] for key in self.found}
            left = (n for n in range(len(self.slots)) if n not in written)
            self.found |= {(self.name, n): self.field.zero for n in left}
        return self.found

    def _returned(self, value: ast.expr) -> None:
        if self.slots != (Slot(""),):
            if not self.filled or ast.unparse(value) != "out" or self.roles.get("out") != "out":
                refuse(value, "what is returned")
            return
        match value:
            case ast.Call(ast.Attribute(name, "copy"), [], []):
                value = name
            case ast.Call() if ast.unparse(value) == f"np.zeros({self.words['x']}.shape[1:])":
                value = ast.Constant(0)
        self.found[self.name, 0] = self._plain(value)

    def _statement(self, node: ast.stmt) -> None:
        match node:
            case ast.Assign([ast.Name(name)], value):
                self._assign(name, value)
            case ast.Assign([ast.Subscript(ast.Name(out), place)], value):
                self._write(out, place, value, added=False)
            case ast.AugAssign(ast.Subscript(ast.Name(out), place), ast.Add(), value):
                self._write(out, place, value, added=True)
            case _:
                refuse(node, "a statement")

    def _assign(self, name: str, value: ast.expr) -> None:
        text = ast.unparse(value)
        x, u, p = (self.words.get(word, "") for word in "xup")
        if (name, text) in {(x, f"_states({x}, {p})"), (u, f"_inputs({u})")}:
            self.roles[name] = {x: "x", u: "u"}[name]
        elif name in self.values or (name in self.roles and name not in self.lanes):
            raise NotShownError(f"{name} is assigned twice")
        elif name in {"np", "_states", "_inputs", "_lanes"} or name in (x, u, p):
            raise NotShownError(f"{name} is assigned")
        elif text.startswith("np.empty(") or text.startswith("np.zeros("):
            self._allocate(name, value)
        elif isinstance(value, ast.Call) and ast.unparse(value.func) == "np.arange":
            first, last = value.args
            self.lanes[name] = self._whole(first), self._whole(last)
            self.roles[name] = "lanes"
        else:
            self.values[name] = self.read.numeric(value)

    def _allocate(self, name: str, value: ast.expr) -> None:
        """Read how `out` is made; with zeros, rows may be left out."""
        x = self.words.get("x", "")
        square = f"np.zeros(({x}.shape[0], *{x}.shape))"
        zeros = ast.unparse(value).startswith("np.zeros(")
        match value:
            case ast.Call(_, [ast.Tuple([size, ast.Starred() as rest])], []) if (
                ast.unparse(rest) == f"*{x}.shape[1:]" and not zeros and x
            ):
                right = self._whole(size) == self.places[-1]
            case ast.Call(_, [size], []) if self.name == "initial_state" and zeros:
                right = self._whole(size) == self.places[-1]
            case _:
                right = ast.unparse(value) == square and self.name == "jacobian"
        if not right or self.filled or name != "out" and self.words.get("out"):
            refuse(value, "an array")
        self.filled, self.roles[name] = True, "out"
        self.zeros = zeros

    # Rows

    def _write(self, out: str, place: ast.expr, value: ast.expr, *, added: bool) -> None:
        if self.roles.get(out) != "out":
            refuse(place, "an array that is written")
        if self.name == "jacobian":
            self._entry(place, value, added=added)
            return
        n, bank = self._row(place)
        if isinstance(value, ast.Tuple) and bank and self.name == "initial_state":
            for lane, part in enumerate(value.elts):
                self._keep((self.name, n, lane), self._plain(part), added=added)
        elif bank:
            self._keep((self.name, n), self._of(value, {("lanes", bank), ("maybe", bank)}), added)
        elif self.name == "margins" and "np.min(" in ast.unparse(value):
            self._keep((self.name, n, LEAST), self._least(value), added)
        else:
            self._keep((self.name, n), self._plain(value), added)

    def _keep(self, key: Key, value: Value, added: bool) -> None:
        if added or key in self.found:
            raise NotShownError(f"{self.name}[{key[1]}] is written twice")
        self.found[key] = value

    def _entry(self, place: ast.expr, value: ast.expr, *, added: bool) -> None:
        if not isinstance(place, ast.Tuple) or len(place.elts) != 2:
            refuse(place, "a place in a matrix")
        diagonal = [
            isinstance(p, ast.Name | ast.BinOp) and _first_name(p) in self.lanes for p in place.elts
        ]
        if all(diagonal):
            row, col = (self._index_array(part) for part in place.elts)
            bank = self.slots[row].bank
            if bank is None or bank != self.slots[col].bank:
                refuse(place, "equal lanes of two banks")
            key, shapes = ("jacobian", row, col, SAME), {("lanes", bank), ("maybe", bank)}
        else:
            (row, rows), (col, cols) = (self._row(part) for part in place.elts)
            key, bank = ("jacobian", row, col, ALL), rows or cols
            shapes = {("lanes", bank), ("maybe", bank)} if bank else set()
            if rows and cols:
                shapes = {("row", rows), ("column", cols), ("pair", rows)}
        made = self._of(value, shapes, cols if not all(diagonal) and rows else "")
        before = self.found.get(key)
        covered = before or (key[:3] + (ALL,)) in self.found or (key[:3] + (SAME,)) in self.found
        if covered and not added:
            raise NotShownError(f"jacobian[{row}, {col}] is written twice")
        self.found[key] = made if before is None else before + made

    def _of(self, node: ast.expr, shapes: set[tuple[str, str]], cols: str | None = "") -> Value:
        """Return an expression that has one of some shapes, or the same for all lanes."""
        value, shape = self.read.numeric(node)
        fits = not shape.is_array or (shape.kind, shape.bank) in shapes
        if not fits or (shape.kind == "pair" and shape.other != cols):
            refuse(node, "an array of another shape")
        return value

    def _plain(self, node: ast.expr) -> Value:
        return self._of(node, set())

    def _least(self, node: ast.expr) -> Value:
        """Return what the least over the lanes is taken of."""
        match node:
            case ast.Call(ast.Attribute(ast.Name("np"), "min"), [arg], keywords):
                value, shape = self.read.numeric(arg)
                names = (part.id for part in ast.walk(arg) if isinstance(part, ast.Name))
                own = all(name in self.values and self.values[name][1] == shape for name in names)
                axis = [ast.unparse(word) for word in keywords] == ["axis=0"]
                if axis and (shape.kind == "lanes" or (shape.kind == "maybe" and own)):
                    return value
        refuse(node, "a least value")

    # Places

    def _whole(self, node: ast.expr) -> Value:
        value, shape = self.read.numeric(node)
        if shape != WHOLE:
            refuse(node, "an index")
        return value

    def _row(self, node: ast.expr, slots: Sequence[Slot] = ()) -> tuple[int, str | None]:
        """Return the slot of an index or of a slice, and its bank."""
        slots = slots or self.slots
        places = [self.known.position(slots, n) for n in range(len(slots) + 1)]
        if isinstance(node, ast.Slice):
            if node.lower is None or node.upper is None or node.step is not None:
                refuse(node, "a slice")
            ends = self._whole(node.lower), self._whole(node.upper)
            found = [
                n
                for n, slot in enumerate(slots)
                if slot.bank and ends == (places[n], places[n + 1])
            ]
        else:
            place = self._whole(node)
            found = [n for n, slot in enumerate(slots) if not slot.bank and places[n] == place]
        if not found:
            refuse(node, "a place of another row")
        return found[0], slots[found[0]].bank

    def _index_array(self, node: ast.expr) -> int:
        """Return the slot of ``lanes`` or of ``lanes + (second - (first))``."""
        shift = self.field.zero
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            shift, node = self._whole(node.right), node.left
        first, last = (
            self.lanes[_first_name(node)] if isinstance(node, ast.Name) else refuse(node, "lanes")
        )
        for n, slot in enumerate(self.slots):
            ends = first + shift, last + shift
            if slot.bank and ends == (self.places[n], self.places[n + 1]):
                return n
        refuse(node, "lanes of no bank")

    # Names

    def _leaf(self, node: ast.expr) -> Read:
        match node:
            case ast.Name(name) if name in self.values:
                return self.values[name]
            case ast.Attribute(ast.Name(p), name) if self.roles.get(p) == "p":
                return self._parameter(name, node)
            case ast.Subscript(ast.Name(x), place) if self.roles.get(x) in {"x", "u"}:
                return self._part(self.roles[x], place)
            case ast.Subscript(arg, place):
                return self._turned(arg, ast.unparse(place), node)
            case ast.Call(
                ast.Name("_lanes"), [ast.Attribute(ast.Name(p), name), count, axes], []
            ) if self.roles.get(p) == "p":
                bank = self.known.banks.get(name, "")
                dimensions = f"{self.words['x']}.ndim" if "x" in self.words else "1"
                right = name in self.known.names and ast.unparse(axes) == dimensions
                if bank and right and self._whole(count) == self.field.count(bank):
                    return self.known.names[name], Shape("maybe", bank)
            case ast.Call(ast.Attribute(ast.Name("np"), name), args, keywords):
                return self._array_call(name, args, [ast.unparse(word) for word in keywords], node)
        refuse(node, "an expression")

    def _parameter(self, name: str, node: ast.expr) -> Read:
        counts = {f"{slot.bank}_count": slot.bank for slot in self.known.slots["rhs"] if slot.bank}
        if name in counts:
            return self.field.count(counts[name]), WHOLE
        if name not in self.known.parameters or name in self.known.banks:
            refuse(node, "a parameter")
        return self.known.names[name], PLAIN

    def _part(self, role: str, place: ast.expr) -> Read:
        """Return a part of x or u."""
        slots = self.known.slots["rhs"] if role == "x" else self.known.inputs
        n, bank = self._row(place, slots)
        return self.known.names[slots[n].label], Shape("lanes", bank) if bank else PLAIN

    def _turned(self, arg: ast.expr, place: str, node: ast.expr) -> Read:
        """Return lanes as those of a matrix's rows or columns."""
        value, shape = self.read.numeric(arg)
        kind = {
            "(slice(None, None, None), None)": "row",
            ":, None": "row",
            "(:, None)": "row",
            "None": "column",
        }.get(place)
        if shape.kind != "lanes" or kind is None:
            refuse(node, "an index")
        value = moved(value, shape.bank, 1) if kind == "column" else value
        return value, Shape(kind, shape.bank)

    def _array_call(
        self, name: str, args: list[ast.expr], words: list[str], node: ast.expr
    ) -> Read:
        x = self.words.get("x", "")
        if name == "where" and len(args) == 3 and not words:
            return self.read.choice(*args)
        if name == "sum" and len(args) == 1 and words == ["axis=0"]:
            value, shape = self.read.numeric(args[0])
            if shape.kind == "lanes":
                return self.field.lane_sum(value, shape.bank), PLAIN
        if name == "ones" and len(args) == 1 and isinstance(args[0], ast.Tuple) and not words:
            count, *rest = args[0].elts
            if [ast.unparse(part) for part in rest] == [f"*(1,) * ({x}.ndim - 1)"]:
                slots = self.known.slots["rhs"]
                banks = {self.field.count(s.bank): s.bank for s in slots if s.bank}
                bank = banks.get(self._whole(count))
                if bank:
                    return self.field.one, Shape("lanes", bank)
        refuse(node, "a call")


def _first_name(node: ast.expr) -> str:
    name = node.left if isinstance(node, ast.BinOp) else node
    return name.id if isinstance(name, ast.Name) else ""
