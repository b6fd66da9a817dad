"""The head of a NumPy module: its docstring, records and parameters.

Input: a `Program`.  Output: text.  It has no date, path or host, so that it changes only when the
spec or the generator does.
"""

from collections.abc import Iterable

from piezo_sym.codegen.program import Described, Program, head_lines
from piezo_sym.expressions import functions
from piezo_sym.spec.names import fresh

STANDARD = ("from dataclasses import dataclass", "from typing import NamedTuple")

RECORDS = '''class Record(NamedTuple):
    """One row of an array, or of a bank one row per lane: its name, SI unit and meaning."""

    name: str
    unit: str
    doc: str
    bank: str | None = None


class Condition(NamedTuple):
    """A condition of the domain: its margin is > 0 inside, or >= 0 if it is not strict."""

    text: str
    strict: bool'''

SHAPES = '''def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = {size}
    if x.shape[:1] != (n,):
        raise ValueError(f"x has shape {{x.shape}}, but there are {{n}} states")
    return x


def _inputs(u):
    """Return inputs u, shape ({inputs}, *batch), as floats."""
    u = np.asarray(u, dtype=float)
    if u.shape[:1] != ({inputs},):
        raise ValueError(f"u has shape {{u.shape}}, but there are {inputs} inputs")
    return u'''

LANES_TYPE = "_Lanes = float | tuple[float, ...]  # a bank's parameter: one value, or one per lane"

LANES = '''def _lanes(value, count, ndim):
    """Return a bank's parameter: a number, or values of shape (count,) or (count, *batch)."""
    if np.ndim(value) == 0:
        return value
    value = np.asarray(value, dtype=float)
    if len(value) != count or value.ndim > ndim:
        raise ValueError(f"a parameter of a bank of {count} lanes has {len(value)} values")
    return value.reshape(*value.shape, *(1,) * (ndim - value.ndim))'''


#: The public right-hand side, which allocates the result and splits a large batch into parts.
RATES = '''_BLOCK = 150_000  # numbers in one part of a large batch: they fit in the cache


def rhs(x, u, p, /):
    """Rates dx/dt, the rows of J_ir dU/dx + g u; shape (n, *batch)."""
    x, u = _states(x, p), _inputs(u)
    out = np.empty(x.shape)
    if x.ndim != 2 or x.size <= _BLOCK:
        _rates(x, u, p, out)
        return out
    step = max(1, _BLOCK // len(x))
    for first in range(0, x.shape[1], step):
        part = slice(first, first + step)
        _rates(x[:, part], u[:, part] if u.ndim == 2 else u, p, out[:, part])
    return out'''


def head(program: Program, text: str = "") -> str:
    """Return everything before a module's first function; `text` is that of its functions."""
    called = [r.numpy_helper for r in functions.RECORDS.values() if f"{r.numpy}(" in text]
    imports, definitions = zip(("", ""), *(lines for lines in called if lines), strict=True)
    standard = "\n".join(sorted({*STANDARD, *imports} - {""}))
    p, counts = fresh("p", program.taken), "Parameters."
    notes = ["Arrays have shape (n, *batch); values are in SI units."]
    lines = head_lines(program, _plain, notes, (p, "Parameters()"), counts)
    start = [
        "\n".join([f'"""{lines[0]}', *lines[1:], '"""']),
        f"{standard}\n\nimport numpy as np",
        *definitions[1:],
        f'NAME = "{program.name}"\nSPEC_SHA256 = "{program.sha256}"',
    ]
    fixed = sum(field.bank is None for field in program.states)
    banks = (f"p.{field.bank}_count" for field in program.states if field.bank)
    shapes = SHAPES.format(size=" + ".join([str(fixed), *banks]), inputs=len(program.inputs))
    parts = ["\n\n".join(start), RECORDS, "\n".join(_tables(program)), _parameters(program), shapes]
    return "\n\n\n".join([*parts, *([LANES] if program.counts else [])])


def _plain(text: str) -> str:
    """Return text from a spec (printable, one line), changed so that it cannot end a docstring."""
    return text.replace("\\", "/").replace('"', "'")


def literal(text: str) -> str:
    """Return text from a spec as a string literal."""
    escaped = text.encode("unicode_escape").decode("ascii").replace('"', '\\"')
    return f'"{escaped}"'


def _tables(program: Program) -> Iterable[str]:
    yield "# rows of x; rows of u, and their default values"
    yield from _records("STATES", program.states)
    yield from _records("INPUTS", program.inputs)
    defaults = [str(program.defaults[field.name]) for field in program.inputs]
    yield f"INPUT_DEFAULTS = {_tuple(defaults)}"
    yield "# rows of outputs() and supply(): ports, named after the elements that have the inputs"
    yield from _records("OUTPUTS", program.outputs)
    yield "# rows of heat() and entropy_production(): processes, with the unit of the second"
    yield from _records("PROCESSES", program.processes)
    yield "# rows of temperatures(), and of elements()"
    yield from _records("BODIES", program.bodies)
    yield from _records("ELEMENTS", program.elements)
    yield "# fields of Parameters; elements of many lanes; conditions under which the proofs hold"
    yield from _records("PARAMETERS", program.parameters)
    yield f"BANKS = {_tuple([literal(bank) for bank in program.counts])}"
    yield "DOMAIN = ("
    for limit in program.limits:
        yield f"    Condition({literal(limit.text)}, {limit.strict}),"
    yield ")"


def _tuple(items: list[str]) -> str:
    return f"({items[0]},)" if len(items) == 1 else f"({', '.join(items)})"


def _records(name: str, fields: tuple[Described, ...]) -> Iterable[str]:
    if not fields:
        yield f"{name} = ()"
        return
    yield f"{name} = ("
    for field in fields:
        parts = [literal(field.name), literal(field.unit), literal(field.doc)]
        parts += [literal(field.bank)] if field.bank else []
        yield f"    Record({', '.join(parts)}),"
    yield ")"


def _parameters(program: Program) -> str:
    lines = [LANES_TYPE, "", ""] if program.counts else []
    lines += ["@dataclass(frozen=True)", "class Parameters:"]
    lines += [
        f'    """Parameters of {program.name} in SI units; defaults are the values of the spec."""',
        "",
    ]
    for field in program.parameters:
        kind = "_Lanes" if field.bank else "float"
        value = program.defaults[field.name]
        text = value if isinstance(value, str) else _tuple([*value])
        lines.append(f"    {field.name}: {kind} = {text}")
    lines += [f"    {bank}_count: int = {count}" for bank, count in program.counts.items()]
    return "\n".join(lines)
