"""Program to Julia: the rates as ``<model>_rhs!(dx, x, u, p)``, for solvers such as those of SciML.

Input: a `Program`.  Output: the text of ``<model>_rhs.jl``, which needs no package.  Parameters are
the fields of p, those of a bank one number or one per lane; rows are those of the NumPy module.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.c.style import c_number
from piezo_sym.codegen.layout import Places, places
from piezo_sym.codegen.program import Program, described, needed
from piezo_sym.errors import one_line
from piezo_sym.expressions.text import ATOM, POWER, SUM, Piece, Style, enclose, write
from piezo_sym.expressions.tree import Expr, LaneSum
from piezo_sym.spec.names import fresh

#: Words of Julia that a spec may use: keywords, and what the text calls beside laws' functions.
_KEPT = """abstract baremodule begin clamp const end export false function global ifelse let local
macro missing module mutable nothing ones primitive quote struct sum true type using"""
KEPT = frozenset(_KEPT.split())
#: Functions of laws that Julia lacks, one line each.
HELPERS = """pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)"""


def julia_rates(program: Program) -> str:
    """Return the text of a program's rates in Julia."""
    taken = {*program.taken, *KEPT}
    own = [f.name for f in (*program.parameters, *program.states, *program.inputs)]
    own += [quantity.name for quantity in program.quantities]
    names = {name: fresh(name, taken) if name in KEPT else name for name in own}
    x, u, p, dx = words = tuple(fresh(word, taken) for word in ("x", "u", "p", "dx"))
    head = described(program, one_line, ["Julia; values are in SI units."], (p, "NamedTuple"))
    body = "\n".join(f"    {line}".rstrip() for line in _body(program, names, words))
    defaults = ", ".join(_defaults(program))
    return (
        "\n".join(f"# {line}".rstrip() for line in head)
        + f"\n\n{HELPERS}\n\nconst {program.name}_parameters = (; {defaults})\n\n"
        + f"function {program.name}_rhs!({dx}, {x}, {u}, {p})\n{body}\n    return {dx}\nend\n"
    )


def _defaults(program: Program) -> Iterator[str]:
    for field in program.parameters:
        value = program.defaults[field.name]
        text = value if isinstance(value, str) else f"[{', '.join(value)}]"
        yield f"{field.name} = {text}"
    yield from (f"{bank}_count = {count}" for bank, count in program.counts.items())


def _body(program: Program, names: dict[str, str], words: tuple[str, ...]) -> Iterator[str]:
    """Yield what the function unpacks, the quantities that rates need, and the rates."""
    x, u, p, dx = words
    rates = next(f.rows for f in program.functions if f.name == "rhs")
    quantities, used = needed(program.quantities, [row.value for row in rates])
    at = places([Slot(f.name, f.bank) for f in program.states], "end", {*program.taken, *KEPT})
    yield from (f"{bank}_count = {p}.{bank}_count" for bank in program.counts)
    yield from at.definitions()
    for field in (field for field in program.parameters if field.name in used):
        lanes = f" .* ones({field.bank}_count)" if field.bank else ""
        yield f"{names[field.name]} = {p}.{field.name}{lanes}"
    for n, state in enumerate(program.states):
        if state.name in used:
            yield f"{names[state.name]} = {x}[{_index(at, n)}]"
    for n, entry in enumerate(program.inputs, 1):
        if entry.name in used:
            yield f"{names[entry.name]} = {u}[{n}]"
    style = _style(names)
    for quantity in quantities:
        each = "@. " if quantity.bank else ""
        yield f"{names[quantity.name]} = {each}{_text(quantity.value, style)}"
    for n, row in enumerate(rates):
        joint = ".= @." if row.slot.bank else "="
        yield f"{dx}[{_index(at, n)}] {joint} {_text(row.value, style)}"


def _index(at: Places, n: int) -> str:
    """Return the index of a state from 1 on, of a bank's states a range."""
    first, last = at.bounds(n)
    begin = str(int(first) + 1) if first.isdigit() else f"{first} + 1"
    return f"{begin} : {last}" if at.slots[n].bank else begin


def _text(value: Expr, style: Style) -> str:
    if isinstance(value, LaneSum):
        return f"sum(@. {write(value.arg, style)})"
    return write(value, style)


def _style(names: dict[str, str]) -> Style:
    def power(base: Piece, exponent: Fraction) -> Piece:
        if exponent == Fraction(1, 2):
            return f"sqrt({base[0]})", ATOM
        by = (str(exponent.numerator), ATOM) if exponent.denominator == 1 else c_number(exponent)
        return f"{enclose(base, ATOM)}^{enclose(by if exponent > 0 else (by[0], SUM), ATOM)}", POWER

    return Style(
        number=c_number,
        name=lambda name: (names.get(name, name), ATOM),  # sizes of banks are locals, too
        power=power,
        call=lambda name, args: (f"{name}({', '.join(text for text, _ in args)})", ATOM),
        choose=lambda then, test, other: (f"ifelse({test}, {then[0]}, {other[0]})", ATOM),
        lane_sum=lambda arg, _: (f"sum(@. {arg[0]})", ATOM),
    )
