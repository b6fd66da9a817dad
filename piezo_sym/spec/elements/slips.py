"""What a store may have beside its energy: a slip, a law of its co-state and of the rate.

Input: the domain of a store, what it imposes, an element.  Output: fields, docstring, ports.  With
q' = v - slip(f, v) a spring slips in series, with Q' = i - slip(v, i) a capacitor in parallel; the
product of co-state and slip heats a body.
"""

from typing import Any

from piezo_sym.expressions.tree import Expr
from piezo_sym.spec.elements.base import state_symbol
from piezo_sym.spec.elements.domains import PhysicalDomain, PhysicalVariable, PowerVariable
from piezo_sym.spec.elements.marks import Fields, Jumps, OptionalBody, law_field
from piezo_sym.spec.elements.ports import Branch, DissipativePort


def fields(domain: PhysicalDomain, imposes: PowerVariable) -> Fields:
    """Return the fields of a slip: its law, what it heats, whether it jumps."""
    out, driven = domain.variable(imposes), domain.variable(imposes.other)
    letters = {out.letter: out.unit, driven.letter: driven.unit, "T": "K"}
    law = law_field(driven.unit, letters, default=None, sees=True)
    heats = {"heats": (OptionalBody, None, None), "discontinuous": (Jumps, False, None)}
    return {"slip": law, **heats}


def about(domain: PhysicalDomain, imposes: PowerVariable) -> str:
    """Return what a slip is, in words."""
    out, driven = domain.variable(imposes), domain.variable(imposes.other)
    return (
        f" With `slip` [{driven.unit}], a law of {out.letter}, its {out.name}, and of "
        f"{driven.letter}, its {driven.name}, the state's rate is {driven.letter} - slip, and "
        f"{out.name} times slip `heats` a body with the temperature T."
    )


def fault(element: Any) -> tuple[str, str, str, str] | None:
    """Return that a slip and what it heats belong together."""
    if (element.slip is None) == (element.heats is None):
        return None
    given, other = ("slip", "heats") if element.heats is None else ("heats", "slip")
    remedy = f"add {other} = '...', or leave {given} out"
    return f".{given}", f"{given} is given without {other}", "both or none", remedy


def alike(element: Any, costate: PhysicalVariable, size: str) -> tuple[str, str, str, str] | None:
    """Return that stores that do not slip, and give an across variable, are one."""
    if element.count is None or element.bank or getattr(element, "slip", None):
        return None
    what = f"count is given, and those in parallel have one {costate.name.replace('_', ' ')}"
    return ".count", what, f"one {element.kind}", f"give the {size} of all, their sum"


def beside(
    domain: PhysicalDomain,
    imposes: PowerVariable,
    element: Any,
    name: str,
    branch: Branch,
    stop: tuple[Expr, Expr] | None = None,
) -> tuple[Branch, DissipativePort]:
    """Return the branch of a store that slips, and its slip; of a stop its law and its limit."""
    out, driven, inner = domain.variable(imposes), domain.variable(imposes.other), f"{name}:inner"
    series = imposes is PowerVariable.THROUGH
    own, other = ((inner, branch[1]), (branch[0], inner)) if series else (branch, branch)
    return own, DissipativePort(
        letter=out.letter,
        law=stop[0] if stop else element.law("slip"),
        field="" if stop else "slip",
        output=f"slip_{name}",
        effort=f"{out.prefix}_{name}",
        branch=other,
        domain=domain,
        imposes=imposes.other,
        heats=element.heats,
        rate_letter=driven.letter,
        rate=f"{driven.prefix}_{name}",
        state=state_symbol(element, name),
        limit=stop[1] if stop else None,
    )
