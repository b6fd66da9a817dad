"""A printed step, read back: rows of its integrands and its stage as values in normal form.

Input: the text of ``<model>_step.c``, and the proved stage, for names and places.  Output: values
by function and row.  The grammar:

    file        comments, the two headers, macros, fixed parts, functions, enumerations, tables
    function    static void <model>_{integrands, stage, ...}[_part_N](...), see `c_function`
    helper      static inline real power_N_of(real z) { return expression; }
    table       enum { NAME = n, ... };    static const int NAME[] = { n, ... };
    sections    functions of laws between two directives, and among them the co-states; then sizes
                and tables, those that tell of co-states between directives, too

Macros and fixed parts are those of `c_step_parts`. A mean that is given to a stage is the mean of
its integrand: a co-state plus terms that do not depend on the state. A branch is 1 where its
switching function is positive, else 0; in a stage branches alone make the choices:
``chosen(NAME > 0.0, value, value)``. `slopes` and most tables after it serve Newton's method alone;
`bends`, which a line ``#define BENDS`` announces, tells the engine where to split means. These are
only checked to be in the grammar, and to fill their arrays. If the system has stops, a table has
for each its bank, whether each lane has its own drive, and its inner state; `path_parameters` are
stiffness and limit of the inner state, `drives` the rates of coordinates. If there are stores and
bodies, `costates` are those of all states, and a table lists the states that are entropies.
"""

import ast
from collections import ChainMap
from collections.abc import Sequence
from dataclasses import replace
from typing import final

from piezo_sym.spec.elements.ports import Body, Storage
from piezo_sym.translation.c_function import NOT_COMPARED, CFunction
from piezo_sym.translation.c_reader import add_helper, add_part, check_parts, is_part
from piezo_sym.translation.c_scope import Branch, File, Scope, helper_is, kind_of
from piezo_sym.translation.c_step_parts import BENDS, SECTION, fixed_parts, macros_of
from piezo_sym.translation.c_text import python_of
from piezo_sym.translation.change import put, spelled
from piezo_sym.translation.expressions import refused
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import Key, Proved
from piezo_sym.translation.signs import reading

_SIGNATURES = {
    "integrands": "x p out",
    "stage": "x g b u p out rows s m",
    "costates": "x g p out",
    "slopes": "x g b u p out",
    "bends": "x p out",
    "path_parameters": "x p out",
    "drives": "x g b u p out",
}
_RESULTS = {"stage out": "rhs", "stage rows": "ledger", "stage m": "margins"}
_RESULTS |= {"slopes out": NOT_COMPARED, "bends out": NOT_COMPARED}


def read_step(text: str, known: Proved) -> dict[Key, Value]:
    """Return every row that the functions of a printed step write; `known` is of `proved_step`."""
    macros, calls = macros_of(text)
    parts = [*fixed_parts(text, known)]
    module = python_of(text, known.iphs.model.name, macros, [part for part, _ in parts])
    calls = {"chosen": "choice", **calls}
    file = File(known, "real", "reals", _SIGNATURES, calls, _RESULTS)
    return _Step(module, file, [name for _, name in parts]).rows(bends=BENDS in text)


@final
class _Step:
    """Reads a step: `functions` and `tables`, by their names without the model's name."""

    def __init__(self, module: ast.Module, file: File, sections: Sequence[str]) -> None:
        self.file, self.iphs, self.field = file, file.known.iphs, file.known.field
        self.functions: dict[str, ast.FunctionDef] = {}
        self.tables: dict[str, list[int]] = {}
        self.section = "head"
        for node in module.body:
            match node:
                case ast.Expr(ast.Constant(int() as n)):
                    self.section = sections[n]
                case ast.FunctionDef(name) if kind_of(node.returns) == "static inline real":
                    self._stands(name, "laws")
                    self._power(node)
                case ast.FunctionDef(name) if is_part(node):
                    self._own(name, "laws")
                    add_part(node, file)
                case ast.FunctionDef(name):
                    self.functions[self._own(name, "laws")] = node
                case ast.Assign([ast.Name(name)], number):
                    self.tables[self._own(name, "")] = [_number(number)]
                case ast.AnnAssign(
                    ast.Name(name), ast.Constant("static const int [ ]"), ast.List(numbers)
                ):
                    self.tables[self._own(name, "")] = [*map(_number, numbers)]
                case _:
                    raise refused(node, "a part of a step")

    def _own(self, name: str, section: str) -> str:
        """Return a function's or table's name without the model's name; refuse one used before.

        It stands in `section`, unless `SECTION` says another.
        """
        prefix = f"{self.iphs.model.name}_"
        word = name.removeprefix(prefix)
        if not name.startswith(prefix) or word in self.functions or word in self.tables:
            raise NotShownError(f"a function or table {name} of the step's own")
        self._stands(name, SECTION.get(word.partition("_part_")[0], section))
        return word

    def _stands(self, name: str, section: str) -> None:
        if self.section != section:
            raise NotShownError(f"{name} stands in a part that not all programs compile")

    def _power(self, node: ast.FunctionDef) -> None:
        """Record a helper after checking that it is an integer power."""
        add_helper(node, self.file, "power_[2-8]_of")
        n = int(node.name.split("_")[1])
        if not helper_is(self.file, node.name, lambda z: self.field.whole_power(z, n), 1):
            raise NotShownError(f"{node.name} is not shown to be a power")

    def rows(self, *, bends: bool) -> dict[Key, Value]:
        """Return the rows written; in a stage, margins choose by comparisons, the rest by branches.

        An integrand is returned as its co-state alone, without the terms free of the state.
        """
        more = ["path_parameters", "drives"] if self.file.known.paths else []
        more += ["costates"] if "costates" in self.file.known.slots else []
        wanted = {"integrands", "stage", "slopes", "sizes", *more, *["bends"] * bends}
        if self.functions.keys() != wanted:
            raise NotShownError("the step has other functions than it should")
        found = self._integrands()
        stage = self._function("stage", by_branches=True)
        found |= stage.rows({"out", "rows"})
        with reading(self.field, "margins"):
            found |= self._function("stage").rows({"m"})
        for name in more:
            found |= self._function(name, by_branches=name == "drives").rows()
        places = [*stage.switches], self._function("slopes").places
        check_parts(self.file)
        self._sizes(*places, self._function("bends").places if bends else None)
        self._told()
        limits, strict = self.tables.get("limits"), self.tables.get("strict")
        if not limits or strict is None or len(strict) != max(1, *limits):
            raise NotShownError("the step does not say which of its limits are strict")
        of_margins = enumerate(strict[: limits[0]])
        return found | {("strict", n): self.field.number(s) for n, s in of_margins}

    def _told(self) -> None:
        """Check the tables on the body that takes losses, on jumps, and on states in integrands."""
        iphs, known = self.iphs, self.file.known
        ports = [port for _, port in iphs.circuit.of(Storage, Body)]
        bodies = [n for n, port in enumerate(ports) if isinstance(port, Body)]
        lossy = any(isinstance(port, Storage) for port in ports)
        jumps = any(getattr(e, "discontinuous", False) for e in iphs.model.elements.values())
        used = {g for value in known.means.values() for g in value.parts}
        states = [known.names[slot.label] for slot in iphs.system.states]
        read = [n for n, value in enumerate(states) if not used.isdisjoint(value.parts)]
        wanted = {"heated": bodies[:1] if bodies and lossy else [-1], "jumps": [int(jumps)]}
        wanted |= {"reads": [len(read)]}
        if "costates" in known.slots:
            wanted |= {"bodies": [len(bodies)], "body": bodies}
        found = {word: self.tables.get(word) for word in wanted}
        if found != wanted or self.tables.get("read", [])[: len(read)] != read:
            raise NotShownError("the step does not say which states it reads, heats, or jumps with")

    def _function(self, name: str, *, by_branches: bool = False) -> CFunction:
        return CFunction(self.functions[name], self.file, by_branches=by_branches)

    def _integrands(self) -> dict[Key, Value]:
        """Read the integrands; a given mean is then that of its co-state plus the other terms."""
        with reading(self.field, "integrands"):
            rows = self._function("integrands").rows()
        known, model = self.file.known, self.iphs.model
        names = dict(known.names)
        fixed = [names[slot.label] for slot in known.slots["rhs"]]
        fixed += [names[name] for name in model.inputs]
        at = {g: self.field.one for value in fixed for g in value.parts}
        for key, value in rows.items():
            label = known.slots["integrands"][int(key[1])].label
            more = put(spelled(value - known.means[label]), at)
            if not more.parts.isdisjoint(at):
                raise NotShownError(f"{label} is not shown to be the mean of its function")
            rows[key] = value - more
            names[label] = names[label] + more
        self.file = replace(self.file, known=replace(known, names=names))
        return rows

    def _sizes(
        self, branches: list[Branch], slopes: list[Branch], bends: list[Branch] | None
    ) -> None:
        """Check the function of array sizes against the branches, slopes and bends written."""
        node, found = self.functions["sizes"], list[Value]()
        roles = dict(zip((arg.arg for arg in node.args.args), ("p", "out"), strict=True))
        types = [kind_of(part) for part in (*(a.annotation for a in node.args.args), node.returns)]
        if types != [f"const {self.iphs.model.name}_reals *", "long *", "static void"]:
            raise refused(node, "a function of such types")
        scope = Scope(self.file, roles, ChainMap())
        for part in node.body:
            match part:
                case ast.AnnAssign(ast.Name(name), ast.Constant("const long"), ast.expr() as value):
                    scope.declare(name, scope.meaning("index", value))
                case ast.Assign([ast.Subscript(ast.Name(out), ast.Constant(n))], value) if (
                    roles.get(out) == "out" and n == len(found)
                ):
                    found.append(scope.read.whole(value))
                case ast.Expr(ast.Name()):
                    pass
                case _:
                    raise refused(part, "a statement")
        known = self.file.known
        states, means, booked, processes = (
            known.layouts[name].places for name in ("rhs", "integrands", "ledger", "processes")
        )
        wanted = [states[-1], means[-1], self._end(branches), booked[-1], processes[-1]]
        wanted += [self._end(slopes), *known.sizes.values(), *states[:-1]]
        if found != [*wanted, *([] if bends is None else [self._end(bends)])]:
            raise NotShownError("the sizes of the step's arrays are not the system's")

    def _end(self, written: list[Branch]) -> Value:
        """Return how many numbers are written; refuse gaps between their places, or overlaps."""
        end, left = self.field.zero, dict(written)
        while end in left:
            bank = left.pop(end)
            end = end + (self.file.known.sizes[bank] if bank else self.field.one)
        if left or len(dict(written)) < len(written):
            raise NotShownError("the places of branches or slopes do not follow on one another")
        return end


def _number(node: ast.expr) -> int:
    """Return the integer of a literal, which may have a minus sign."""
    match node:
        case ast.Constant(int() as number):
            return number
        case ast.UnaryOp(ast.USub(), ast.Constant(int() as number)):
            return -number
    raise refused(node, "no whole number")
