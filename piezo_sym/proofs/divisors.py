"""What the junction laws divide by is not zero: ratios of levers, and what resistive loops bring.

Input: an `IPHS`.  Output: obligations, one a divisor.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import sympy as sp

from piezo_sym.algebra.coefficients import coefficient
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ZERO, Cmp, Expr, Neg, rename
from piezo_sym.expressions.tree import replace as put
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.definitions import heated
from piezo_sym.proofs.assumptions import Assumptions
from piezo_sym.proofs.branches import TooManyBranchesError
from piezo_sym.proofs.laws import on_branches, valued
from piezo_sym.proofs.obligations import Obligation, Question
from piezo_sym.spec.elements.ports import Conductor, Coupling, Resistor

MOST_TEXT = 60


def divisors(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    """Yield for each expression that the junction laws divide by that it is not zero."""
    words = dict(_words(iphs))
    for divisor in iphs.junction.divisors:
        yield _obligation(divisor, words, assumptions)


def _obligation(
    divisor: sp.Expr, words: Mapping[str, Expr], assumptions: Assumptions
) -> Obligation:
    form = coefficient(divisor)
    form = form.arg if isinstance(form, Neg) else form
    text = spell(form)
    short = text if len(text) <= MOST_TEXT else f"{text[: MOST_TEXT - 3]}..."
    statement = f"{short} != 0: the junction laws divide by it"
    latex = r"\det \ne 0"
    made = Obligation("welldef", "", statement, latex, assumptions.texts)
    law = put(form, words)
    claim = Cmp("!=", law, ZERO)
    question = Question(f"{short} != 0", assumptions.order, assumptions.where, claim, claim)
    try:
        found = (*valued(law, assumptions), *on_branches(law, question))
    except TooManyBranchesError:
        return replace(made, open_because=f"{short} has too many branches; use fewer kinks")
    return replace(made, questions=tuple(dict.fromkeys(found)))


def _words(iphs: IPHS) -> Iterator[tuple[str, Expr]]:
    """Yield what ratios and slopes stand for, in the words of the domain."""
    for _, port in iphs.circuit.of(Coupling):
        hot = {"T": iphs.circuit.body(port.body).temperature} if port.body else {}
        yield port.name, rename(port.ratio, hot)
    processes = tuple(iphs.circuit.of(Resistor, Conductor))
    for slope in iphs.junction.slopes:
        body = iphs.circuit.body(heated(processes[slope.process][1]))
        yield str(slope.symbol.name), rename(slope.law, {"T": body.temperature})
