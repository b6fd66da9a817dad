"""A printed NumPy module, read back: rows of its functions as values in normal form.

Input: the text of ``<model>.py`` and what it may name.  Output: values by function and row, and
what they are divided by.  The grammar is that of straight code: each name is assigned once, from
parameters, parts of x and u, or an expression; rows of `out` are written once.  Tables, parameters
and the helpers of a module have to be word for word what is expected.  Nothing is executed.
"""

import ast
from collections.abc import Mapping, Sequence
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.translation.change import moved
from piezo_sym.translation.expressions import PLAIN, WHOLE, Expressions, Read, Shape, refused
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import ALL, LEAST, SAME, Key, Layout, Proved, Rows
from piezo_sym.translation.signs import reading

ARGUMENTS = dict.fromkeys(
    ["jacobian", "margins", "outputs", "supply", "elements", "heat", "entropy_production"], "x u p"
) | {"initial_state": "u p", "_rates": "x u p out", "temperatures": "x p"}
ARGUMENTS |= {"energy": "x p", "entropy": "x p"}
CALLS = {record.numpy: name for name, record in RECORDS.items() if record.smooth}
CALLS |= {"np.abs": "abs", "np.sign": "sign", "np.minimum": "minimum", "np.maximum": "maximum"}
CALLS |= {"np.clip": "clip"}

#: The decorator of a function with choices: it hides warnings from values that are not chosen.
QUIET = "np.errstate(divide='ignore', invalid='ignore')"


def read_numpy(functions: Mapping[str, ast.FunctionDef], known: Proved) -> dict[Key, Value]:
    """Return every row that the functions of a module write; for the rest see `numpy_head`."""
    rows: dict[Key, Value] = {}
    for name, words in ARGUMENTS.items():
        if name not in functions:
            raise NotShownError(f"there is no function {name}")
        with reading(known.field, name):
            rows |= _Function(functions[name], words.split(), known).rows()
    return rows


@final
class _Function:
    """Reads one function, whose names are values, arguments (`roles`) or index arrays (`lanes`)."""

    def __init__(self, node: ast.FunctionDef, words: Sequence[str], known: Proved) -> None:
        self.node, self.known, self.field = node, known, known.field
        self.name = node.name.replace("_rates", "rhs")
        given = node.args
        arguments = [arg.arg for arg in given.posonlyargs]
        others = {**vars(given), "posonlyargs": [], "returns": node.returns}
        noted = [arg.annotation for arg in given.posonlyargs if arg.annotation]
        marks = [ast.unparse(mark) for mark in node.decorator_list]
        if (
            marks not in ([], [QUIET])
            or len(arguments) != len(words)
            or any(others.values())
            or noted
        ):
            raise refused(node, "the arguments of a function")
        self.words = dict(zip(words, arguments, strict=True))
        self.x = self.words.get("x", "")
        self.unchecked = {"x", "u"} & {*words} if node.name != "_rates" else set()
        self.roles = {a: w for w, a in self.words.items() if w not in self.unchecked}
        self.values: dict[str, Read] = {}
        self.lanes: dict[str, tuple[Value, Value]] = {}
        self.written = Rows(known, self.name)
        self.own: tuple[str, str] | None = None  # (lane, bank) of an entry in a list
        self.field.derived = self.name == "jacobian"
        self.read = Expressions(self.field, known.numbers, self._leaf, CALLS, False)

    def rows(self) -> dict[Key, Value]:
        """Return the rows that the function writes."""
        doc, *body = self.node.body
        last = body.pop() if "out" not in self.words and body else None
        for statement in body:
            self._statement(statement)
        if not (isinstance(doc, ast.Expr) and isinstance(doc.value, ast.Constant)):
            raise refused(doc, "a function without docstring")
        if "x" in self.unchecked:
            raise refused(doc, "a function that takes states of any shape")
        if isinstance(last, ast.Return) and last.value:
            self._return(last.value)
        elif last:
            raise refused(last, "a last statement")
        if self.name == "initial_state":  # made of zeros
            found = self.written.found
            left = {*range(len(self.written.slots))} - {key[1] for key in found}
            found |= {(self.name, n): self.field.zero for n in left}
        return self.written.found

    def _return(self, value: ast.expr) -> None:
        if self.written.slots != (Slot(""),):
            if not isinstance(value, ast.Name) or self.roles.get(value.id) != "out":
                raise refused(value, "what is returned")
            return
        match value:
            case ast.Call(ast.Attribute(name, "copy"), [], []):
                value = name
            case ast.Call() if ast.unparse(value) == f"np.zeros({self.x}.shape[1:])":
                value = ast.Constant(0)
        self.written.keep((self.name, 0), self._of(value))

    def _statement(self, node: ast.stmt) -> None:
        match node:
            case ast.Assign([ast.Name(name)], value):
                self._assign(name, value)
            case ast.Assign([ast.Subscript(ast.Name(out), place)], value) if self._is_out(out):
                self._write(place, value, added=False)
            case ast.AugAssign(ast.Subscript(ast.Name(out), place), ast.Add(), value) if (
                self._is_out(out)
            ):
                self._write(place, value, added=True)
            case _:
                raise refused(node, "a statement")

    def _is_out(self, name: str) -> bool:
        return self.roles.get(name) == "out"

    def _assign(self, name: str, value: ast.expr) -> None:
        p, u = self.words["p"], self.words.get("u", "")
        checks = {self.x: ("x", f"_states({self.x}, {p})"), u: ("u", f"_inputs({u})")}
        role, checked = checks.get(name, ("", ""))
        role = role if role and ast.unparse(value) == checked else ""
        words = {"np", "_states", "_inputs", "_lanes", *self.words.values()}
        kept = any(name in table for table in (words, CALLS, self.values, self.roles))
        if role in self.unchecked:
            self.unchecked.remove(role)
            self.roles[name] = role
        elif isinstance(value, ast.Call) and ast.unparse(value.func) == "np.arange":
            if kept or len(value.args) != 2 or value.keywords:
                raise refused(value, "an index array")
            first, last = value.args
            self.lanes[name] = self.read.whole(first), self.read.whole(last)
        elif kept or name in self.lanes:
            raise NotShownError(f"{name} is assigned twice")
        elif isinstance(value, ast.Call) and ast.unparse(value.func) in {"np.empty", "np.zeros"}:
            self._allocate(value)
            self.roles[name] = "out"
        else:
            read, shape = self.read.any(value)
            self.values[name] = self.field.letter(read) if shape != WHOLE else read, shape

    def _allocate(self, value: ast.Call) -> None:
        """Check how the result is allocated: rows may stay unwritten only in an array of zeros."""
        zeros, shape = ast.unparse(value.func) == "np.zeros", next(iter(value.args), value)
        square = f"({self.x}.shape[0], *{self.x}.shape)"
        match shape:
            case ast.Tuple([size, ast.Starred() as rest]) if not zeros:
                right = ast.unparse(rest) == f"*{self.x}.shape[1:]"
                right = right and self.read.whole(size) == self.written.size
            case ast.Tuple():
                right = zeros and ast.unparse(shape) == square and self.name == "jacobian"
            case _:
                right = self.read.whole(shape) == self.written.size
                right = right and zeros and self.name == "initial_state"
        if not right or len(value.args) != 1 or value.keywords or "out" in self.roles.values():
            raise refused(value, "an array")
        self.written.zeros = zeros

    def _write(self, place: ast.expr, value: ast.expr, *, added: bool) -> None:
        name, rows = self.name, self.written
        key, banks = self._key(place)
        if isinstance(value, ast.Tuple) and banks and name == "initial_state":
            for lane, part in enumerate(value.elts):
                self.own = str(lane), banks[0]
                rows.keep((*key, lane), self._of(part), added=added)
            self.own = None
        elif name == "margins" and (least := self._least(value)):
            rows.keep((*key, LEAST), least, added=added)
        else:
            shapes = [Shape(kind, bank) for bank in banks for kind in ("lanes", "maybe")]
            if len(banks) == 2:
                shapes = [Shape("row", banks[0]), Shape("column", banks[1]), Shape("pair", *banks)]
            rows.keep(key, self._of(value, shapes), added=added)

    def _key(self, place: ast.expr) -> tuple[Key, tuple[str, ...]]:
        """Return the key of the row or entry at an index, and the banks whose lanes it spans."""
        parts = place.elts if isinstance(place, ast.Tuple) else [place]
        matrix = self.name == "jacobian"
        equal = matrix and all(_first(part) in self.lanes for part in parts)
        found = [self._slot(part, self.written.layout, equal=equal) for part in parts]
        banks = tuple(bank for _, bank in found if bank)
        if len(parts) != 1 + matrix or (equal and len({*banks}) > 1):
            raise refused(place, "a place of another row")
        kind = [SAME if equal else ALL] if matrix else []
        return (self.name, *(n for n, _ in found), *kind), banks[:1] if equal else banks

    def _of(self, node: ast.expr, shapes: Sequence[Shape] = ()) -> Value:
        """Return the value of an expression; refuse an array whose shape is not one of `shapes`."""
        value, shape = self.read.numeric(node)
        if shape.bank and shape not in shapes:
            raise refused(node, "an array of another shape")
        return value

    def _least(self, node: ast.expr) -> Value | None:
        """Return the value per lane in ``np.min(value, axis=0)``, or None for other expressions."""
        match node:
            case ast.Call(ast.Attribute(ast.Name("np"), "min"), [arg], [axis]):
                value, shape = self.read.numeric(arg)
                names = (part.id for part in ast.walk(arg) if isinstance(part, ast.Name))
                own = all(self.values.get(n, (0, shape))[1] == shape for n in names)
                right = shape.kind == "lanes" or (shape.kind == "maybe" and own)
                return value if right and ast.unparse(axis) == "axis=0" else None
        return None

    def _slot(
        self, node: ast.expr, layout: Layout, *, equal: bool = False
    ) -> tuple[int, str | None]:
        """Return the slot of an index, a slice or (`equal`) an array of lanes, and its bank."""
        match node:
            case ast.Slice(lower, upper, None) if lower and upper:
                first, last = self.read.whole(lower), self.read.whole(upper)
            case ast.Name(name) if equal:
                first, last = self.lanes[name]
            case ast.BinOp(ast.Name(name), ast.Add(), right) if equal:
                shift = self.read.whole(right)
                first, last = (end + shift for end in self.lanes[name])
            case _:
                return layout.at(self.read.whole(node), bank=False), None
        n = layout.at(first, bank=True)
        if last != layout.places[n + 1]:
            raise refused(node, "lanes of another bank")
        return n, layout.slots[n].bank

    def _leaf(self, node: ast.expr) -> Read:
        match node:
            case ast.Name(name) if name in self.values:
                return self.values[name]
            case ast.Attribute(ast.Name(p), name) if self.roles.get(p) == "p":
                value, whole = self.known.parameter(name)
                return value, WHOLE if whole else PLAIN
            case ast.Subscript(ast.Name(x), place) if self.roles.get(x) in {"x", "u"}:
                layout = self.known.layouts[self.roles[x]]
                n, bank = self._slot(place, layout)
                value = self.known.names[layout.slots[n].label]
                return value, Shape("lanes", bank) if bank else PLAIN
            case ast.Subscript(ast.Name(name), place) if self.own and name in self.values:
                value, shape = self.values[name]
                if shape.kind == "lanes" and self.own == (ast.unparse(place), shape.bank):
                    return value, PLAIN
            case ast.Subscript(arg, place):
                kind = {"(:, None)": "row", "None": "column"}.get(ast.unparse(place))
                value, shape = self.read.numeric(arg)
                if kind and shape.kind == "lanes":
                    value = moved(value, shape.bank, 1) if kind == "column" else value
                    return value, Shape(kind, shape.bank)
            case ast.Call(ast.Name("_lanes"), [ast.Attribute(ast.Name(p), name), size, axes], []):
                bank = self.known.banks.get(name, "")
                dimensions = f"{self.x}.ndim" if self.x else "1"
                known = name in self.known.iphs.model.parameters and self.roles.get(p) == "p"
                known = known and ast.unparse(axes) == dimensions
                if bank and known and self.read.whole(size) == self.known.sizes[bank]:
                    return self.known.names[name], Shape("maybe", bank)
            case ast.Call(ast.Attribute(ast.Name("np"), name), args, keywords):
                return self._array_call(name, args, [ast.unparse(word) for word in keywords], node)
        raise refused(node, "an expression")

    def _array_call(
        self, name: str, args: list[ast.expr], words: list[str], node: ast.expr
    ) -> Read:
        match name, args, words:
            case "where", [test, then, other], []:
                return self.read.choice(test, then, other)
            case "float64", [arg], []:  # leaves floats unchanged
                return self.read.numeric(arg)
            case "sum", [arg], ["axis=0"] if self.own is None:  # no sum in an entry of a list
                value, shape = self.read.numeric(arg)
                if shape.kind == "lanes":
                    return self.field.lane_sum(value, shape.bank), PLAIN
            case "ones", [size], [] if not self.x:
                if bank := self.known.bank_of_size.get(self.read.whole(size), ""):
                    return self.field.one, Shape("lanes", bank)
            case "ones", [ast.Tuple([size, rest])], []:
                bank = self.known.bank_of_size.get(self.read.whole(size), "")
                if bank and ast.unparse(rest) == f"*(1,) * ({self.x}.ndim - 1)":
                    return self.field.one, Shape("lanes", bank)
        raise refused(node, "a call")


def _first(node: ast.expr) -> str:
    """Return the name of a name, or of the first summand of a sum; '' for other expressions."""
    name = node.left if isinstance(node, ast.BinOp) else node
    return name.id if isinstance(name, ast.Name) else ""
