"""What surrounds the functions of a printed NumPy module: imports, tables, parameters, helpers.

Input: the text of ``<model>.py`` and a `Proved`.  Output: its functions as trees, if all else in it
is as expected: helpers as they stand here, tables with the names of the model, parameters with its
values.  So a name such as ``np`` or ``_lanes`` means in every function what it should.
"""

import ast
import re
from collections.abc import Mapping
from copy import copy
from functools import cache
from itertools import chain

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.iphs import IPHS
from piezo_sym.spec.elements.ports import Body
from piezo_sym.spec.tables import banks, condition_text, conditions, lane_parameters
from piezo_sym.translation.field import NotShownError
from piezo_sym.translation.known import Proved
from piezo_sym.translation.numpy_reader import ARGUMENTS

_HELPERS = """
from dataclasses import dataclass
from typing import NamedTuple
import numpy as np
class Record(NamedTuple):
    name: str
    unit: str
    doc: str
    bank: str | None = None
class Condition(NamedTuple):
    text: str
    strict: bool
_Lanes = float | tuple[float, ...]
_BLOCK = 150_000
def _states(x, p):
    x = np.asarray(x, dtype=float)
    n = {size}
    if x.shape[:1] != (n,):
        raise ValueError(f"x has shape {{x.shape}}, but there are {{n}} states")
    return x
def _inputs(u):
    u = np.asarray(u, dtype=float)
    if u.shape[:1] != ({inputs},):
        raise ValueError(f"u has shape {{u.shape}}, but there are {inputs} inputs")
    return u
def _lanes(value, count, ndim):
    if np.ndim(value) == 0:
        return value
    value = np.asarray(value, dtype=float)
    if len(value) != count or value.ndim > ndim:
        raise ValueError(f"a parameter of a bank of {{count}} lanes has {{len(value)}} values")
    return value.reshape(*value.shape, *(1,) * (ndim - value.ndim))
def rhs(x, u, p, /):
    x, u = _states(x, p), _inputs(u)
    out = np.empty(x.shape)
    if x.ndim != 2 or x.size <= _BLOCK:
        _rates(x, u, p, out)
        return out
    step = max(1, _BLOCK // len(x))
    for first in range(0, x.shape[1], step):
        part = slice(first, first + step)
        _rates(x[:, part], u[:, part] if u.ndim == 2 else u, p, out[:, part])
    return out
"""


def numpy_functions(text: str, known: Proved) -> Mapping[str, ast.FunctionDef]:
    """Return the functions of a module that compute rows."""
    if re.search(r"coding[:=]", "\n".join(text.split("\n")[:2])):
        raise NotShownError("the NumPy module has another coding")
    try:
        module = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise NotShownError(f"the NumPy module cannot be parsed: {error}") from error
    iphs = known.iphs
    called = (r.numpy_helper for r in RECORDS.values() if f"{r.numpy}(" in text)
    left, tables = [*_helpers(iphs), *chain.from_iterable(called)], _tables(known)
    functions: dict[str, ast.FunctionDef] = {}
    for node in module.body[1:]:
        match node:
            case ast.FunctionDef(name) if name in ARGUMENTS and name not in functions:
                functions[name] = node
            case ast.Assign([ast.Name(name)], value) if name in tables:
                if _literal(value) != tables.pop(name):
                    raise NotShownError(f"the table {name} is another one")
            case ast.ClassDef("Parameters"):
                _check_parameters(node, iphs)
                tables.pop("Parameters", None)
            case _ if (bare := _bare(node)) in left:
                left.remove(bare)
            case _:
                raise NotShownError(f"line {node.lineno} of the NumPy module is unexpected")
    if tables or left or not _is_text(module.body[0]):
        missing = next(iter([*tables, *left]), "a docstring")
        raise NotShownError(f"the NumPy module lacks {missing[:40]}")
    return functions


def _is_text(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def _helpers(iphs: IPHS) -> list[str]:
    """Return what stands in every module, statement by statement."""
    slots = iphs.system.states
    size = [str(sum(s.bank is None for s in slots))]
    size += [f"p.{s.bank}_count" for s in slots if s.bank]
    helpers = _HELPERS.format(size=" + ".join(size), inputs=len(iphs.model.inputs))
    found = _statements(helpers)
    if not banks(iphs.model):
        return [text for text in found if "_Lanes =" not in text and "_lanes(" not in text]
    return [*found]


@cache
def _statements(text: str) -> tuple[str, ...]:
    return tuple(_bare(node) for node in ast.parse(text).body)


def _bare(node: ast.stmt) -> str:
    """Return a statement as text, without its docstring."""
    if not isinstance(node, ast.FunctionDef | ast.ClassDef):
        return ast.unparse(node)
    head, body = copy(node), node.body[_is_text(node.body[0]) :]
    head.body = []
    return f"{ast.unparse(head)}\n{ast.unparse(ast.Module(body, []))}"


def _literal(node: ast.expr) -> object:
    """Return a table: constants, tuples of them, and records without unit and text."""
    match node:
        case ast.Constant(value):
            return value
        case ast.UnaryOp(ast.USub(), ast.Constant(int() | float() as value)):
            return -value
        case ast.Tuple(parts):
            return tuple(map(_literal, parts))
        case ast.Call(ast.Name("Record"), [_, _, _, *_] as parts, []):
            name, _, _, *bank = map(_literal, parts)
            return (name, bank[0] if bank else None)
        case ast.Call(ast.Name("Condition"), [text, strict], []):
            return _literal(text), _literal(strict)
    raise NotShownError("a table of the NumPy module is no list of constants")


def _tables(known: Proved) -> dict[str, object]:
    iphs, slots = known.iphs, known.slots
    model, system = iphs.model, iphs.system
    owners = lane_parameters(model)
    return {
        "NAME": model.name,
        "SPEC_SHA256": model.sha256,
        "STATES": tuple((s.label, s.bank) for s in system.states),
        "INPUTS": tuple((name, None) for name in model.inputs),
        "INPUT_DEFAULTS": tuple(entry.si for entry in model.inputs.values()),
        "OUTPUTS": tuple((s.label, None) for s in system.ports),
        "PROCESSES": tuple((s.label, s.bank) for s in system.processes),
        "BODIES": tuple((placed.element, None) for placed, _ in iphs.circuit.of(Body)),
        "ELEMENTS": tuple((s.label, s.bank) for s in slots["elements"]),
        "PARAMETERS": tuple((name, owners.get(name)) for name in model.parameters),
        "BANKS": tuple(banks(model)),
        "DOMAIN": tuple((condition_text(c.tree), "=" not in c.tree.op) for c in conditions(model)),
        "Parameters": None,
    }


def _check_parameters(node: ast.ClassDef, iphs: IPHS) -> None:
    """Refuse parameters with other names, values or methods than the model's."""
    wanted: list[tuple[str, object]] = [(n, p.si) for n, p in iphs.model.parameters.items()]
    wanted += [(f"{bank}_count", count) for bank, count in banks(iphs.model).items()]
    found = []
    for part in node.body[1:]:
        match part:
            case ast.AnnAssign(ast.Name(name), ast.Name(kind), ast.Expr() | ast.expr() as value, 1):
                found.append((name, _literal(value)))
                if kind not in {"float", "int", "_Lanes"}:
                    raise NotShownError(f"parameter {name} has another type")
            case _:
                raise NotShownError("the class Parameters is not a list of numbers")
    frozen = [ast.unparse(item) for item in chain(node.decorator_list, node.bases, node.keywords)]
    if found != wanted or frozen != ["dataclass(frozen=True)"] or not _is_text(node.body[0]):
        raise NotShownError("the values of Parameters are not the model's")
