"""The domain's edge in C: whether a state lies inside, asked at every iteration of Newton's method.

Input: a `Frame`.  Output: a function for ``<model>.c``.
"""

from __future__ import annotations

from dataclasses import replace

from piezo_sym.codegen.c_frame import Frame
from piezo_sym.codegen.c_lines import Words, stage_lines, statement
from piezo_sym.codegen.c_names import KEPT
from piezo_sym.codegen.c_stages import Write, stages
from piezo_sym.codegen.program import Limit, Program, bank_of, needed
from piezo_sym.expressions.tree import Call, Div, Expr, Mul, Sym, names
from piezo_sym.spec.names import fresh


def inside(frame: Frame) -> str:
    """Return whether a state lies in the domain."""
    program = frame.program
    states = {field.name for field in program.states}
    limits = [limit for limit in program.limits if _moves(program, limit, states)]
    margins = [_like(program, limit.margin) for limit in limits]
    parts: list[str] = []
    body: list[str] = []
    quantities, _ = needed(program.quantities, margins)
    plain = _own_words(frame)
    writes = []
    for n, (limit, margin) in enumerate(zip(limits, margins, strict=True)):
        name = f"margin_{n + 1}_"
        bank = bank_of(margin, program.lane_names())
        if bank:
            body.append(f"double {name};")
        target = name if bank else f"const double {name}"
        writes.append(Write(target, margin, bank, "min" if bank else "="))
        parts.append(f"({name} {'>' if limit.strict else '>='} 0.0)")
    for stage in stages(quantities, writes, program.counts):
        body += stage_lines(stage, plain)
    for write in writes:
        if not write.bank:
            body += statement(f"{write.target} =", write.value, plain)
    last = f"return {' & '.join(parts) or '1'};"
    return frame.function("inside", body, last=last)


def _like(program: Program, margin: Expr) -> Expr:
    """Return a number of the sign of a margin: positive factors, and exp(d) - 1, are left out.

    Newton's method asks at every iteration, and only for the sign.
    """
    values = {quantity.name: quantity.value for quantity in program.quantities}
    positive = {
        limit.margin.name
        for limit in program.limits
        if limit.strict and isinstance(limit.margin, Sym) and limit.margin.name not in values
    }
    given = values.get(margin.name, margin) if isinstance(margin, Sym) else margin
    match given:
        case Mul(Sym(name), Call("expm1", (Div(top, Sym(below)),))) if {
            name,
            below,
        } <= positive:
            return top
    return margin


def _moves(program: Program, limit: Limit, states: set[str]) -> bool:
    """Return whether a condition depends on the state."""
    quantities, used = needed(program.quantities, [limit.margin])
    del quantities
    return bool(states & {*used, *names(limit.margin)})


def _own_words(frame: Frame) -> Words:
    """Return the identifiers of the program itself, beside those of the step."""
    own = {quantity.name: quantity.name for quantity in frame.program.quantities}
    plain = {name: fresh(name, KEPT) if name in KEPT else name for name in own}
    return replace(frame.lines, names={**plain, **frame.names})
