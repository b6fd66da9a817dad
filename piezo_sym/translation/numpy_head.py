"""What surrounds the functions of a printed NumPy module: imports, tables, parameters, helpers.

Input: the text of ``<model>.py`` and a `Proved`.  Output: its functions as trees, if the rest is as
expected: the helpers in this file, tables with the model's names, parameters with its values.  So
names such as ``np`` and ``_lanes`` have their usual meaning in every function.
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
from piezo_sym.spec.tables import banks, condition_text
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


_PARAMETERS = """\
@dataclass(frozen=True)
class Parameters:
    'Its text is free.'
"""


def numpy_functions(text: str, known: Proved) -> Mapping[str, ast.FunctionDef]:
    """Return the functions of a module that compute rows; refuse anything else unexpected."""
    if re.search(r"coding[:=]", "\n".join(text.split("\n")[:2])):
        raise NotShownError("the NumPy module has another coding")
    try:
        module = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise NotShownError(f"the NumPy module cannot be parsed: {error}") from error
    iphs = known.iphs
    called = (r.numpy_helper for r in RECORDS.values() if f"{r.numpy}(" in text)
    left, tables = [*_fixed(iphs), *chain.from_iterable(called)], _tables(known)
    functions: dict[str, ast.FunctionDef] = {}
    for node in module.body[1:]:
        match node:
            case ast.FunctionDef(name) if name in ARGUMENTS and name not in functions:
                functions[name] = node
            case ast.Assign([ast.Name(name)], value) if name in tables:
                if _rows(value) != tables.pop(name):
                    raise NotShownError(f"the table {name} is another one")
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


def _fixed(iphs: IPHS) -> list[str]:
    """Return the statements that every module has, and those of this model's parameters."""
    slots, lanes, model = iphs.system.states, iphs.circuit.lane_parameters, iphs.model
    size = [str(sum(s.bank is None for s in slots))]
    size += [f"p.{s.bank}_count" for s in slots if s.bank]
    found = _statements(_HELPERS.format(size=" + ".join(size), inputs=len(model.inputs)))
    if not banks(model):
        found = tuple(text for text in found if "_Lanes =" not in text and "_lanes(" not in text)
    fields = [
        f"    {name}: {'_Lanes' if name in lanes else 'float'} = {entry.si!r}"
        for name, entry in model.parameters.items()
    ]
    fields += [f"    {bank}_count: int = {count}" for bank, count in banks(model).items()]
    return [*found, *_statements("\n".join([_PARAMETERS, *fields]))]


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


def _rows(node: ast.expr) -> object:
    """Return the content of a table: constants, tuples, and records as (name, bank)."""
    match node:
        case ast.Tuple(parts):
            return tuple(map(_rows, parts))
        case ast.Call(ast.Name("Record"), [_, _, _, *_] as parts, []):
            name, _, _, bank, *_ = (*map(_rows, parts), None)
            return name, bank
        case ast.Call(ast.Name("Condition"), [text, strict], []):
            return _rows(text), _rows(strict)
    try:
        return ast.literal_eval(node)
    except ValueError as error:
        raise NotShownError("a table of the NumPy module is no list of constants") from error


def _tables(known: Proved) -> dict[str, object]:
    iphs, slots = known.iphs, known.slots
    model, system = iphs.model, iphs.system
    owners = iphs.circuit.lane_parameters
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
        "DOMAIN": tuple(
            (condition_text(c.tree), "=" not in c.tree.op) for c in iphs.circuit.conditions
        ),
    }
