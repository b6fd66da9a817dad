"""The condition of [domain] under which a law that is refuted takes power in.

Input: the law of a refuted row.  Output: the condition as text, or nothing.  A law that is c times
what takes power in does so where c >= 0; of c, factors that the domain keeps from being negative
are left out.  A slip takes power in on each branch if the factor that parameters are there does:
Bouc-Wen's, where beta + gam >= 0 and beta - gam >= 0.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import reduce

import sympy as sp

from piezo_sym.algebra.coefficients import coefficient
from piezo_sym.algebra.symbols import to_sympy
from piezo_sym.expressions.calculus import mul
from piezo_sym.expressions.tree import ONE, ZERO, Call, Cmp, Div, Expr, Mul, Neg, names
from piezo_sym.network import slope_of
from piezo_sym.proofs.obligations import Question
from piezo_sym.spec.tables import condition_text

#: Whether an expression times another, or alone where that is 1, is shown not to be negative.
Shown = Callable[[Expr, str], bool]
Follows = Callable[[Question], bool]


def mending(law: Expr, letter: str, shown: Shown) -> str:
    """Return the condition that makes a law have the sign of its letter; without one, be >= 0.

    Parameters
    ----------
    law, letter : of a dissipative law; of a conductance the letter is empty.
    shown : whether the domain has a law times a letter, or alone, be not negative.
    """
    slope = slope_of(law, letter) if letter else None
    factors = list(_factors(law if slope is None else slope))
    rest = [f for f in factors if letter and letter in names(f)]
    if rest and not shown(reduce(mul, rest), letter):
        return ""
    kept = [f for f in factors if f not in rest and not shown(f, "")]
    if not any(map(names, kept)):
        return ""
    return condition_text(Cmp(">=", reduce(mul, kept), ZERO))


def branchwise(questions: Iterable[Question], fixed: Collection[str], shown: Follows) -> list[Expr]:
    """Return what of parameters alone has to be >= 0 for each claim to hold on its branch.

    Parameters
    ----------
    questions : each whether an expression is not negative.
    fixed : the parameters.
    shown : whether a question is answered with yes.
    """
    found = dict[Expr, None]()
    for question in (q for q in questions if not shown(q)):
        power = question.claim.left
        table = {name: sp.Symbol(name, real=True) for name in names(power)}
        parts = sp.factor_list(sp.Mul(*sp.fraction(sp.together(to_sympy(power, table)))))[1]
        own = [f for f, n in parts if n % 2 and {s.name for s in f.free_symbols} <= {*fixed}]
        own = [f for f in own if f.is_polynomial()]
        factor = sp.Mul(*(f for f in own if not shown(_says(question, coefficient(f)))))
        for law in map(coefficient, (factor, -factor)):
            if names(law) and shown(_says(question, mul(power, law))):
                found[law] = None
                break
    return list(found)


def _says(question: Question, law: Expr) -> Question:
    """Return the question whether a law is not negative where another one is asked."""
    return replace(question, claim=Cmp(">=", law, ZERO))


def as_text(laws: Sequence[Expr]) -> str:
    """Return that laws are not negative; of a + b and a - b, as a >= abs(b)."""
    if len(laws) == 2:
        table = {name: sp.Symbol(name, real=True) for law in laws for name in names(law)}
        one, other = (to_sympy(law, table) for law in laws)
        a, b = ((one + way * other) / 2 for way in (1, -1))
        if a.is_Symbol and (b.is_Symbol or (-b).is_Symbol):
            size = Call("abs", (coefficient(b if b.is_Symbol else -b),))
            return condition_text(Cmp(">=", coefficient(a), size))
    return "' and '".join(condition_text(Cmp(">=", law, ZERO)) for law in laws)


def _factors(law: Expr) -> Iterator[Expr]:
    """Yield factors whose product has the sign of a law."""
    match law:
        case Mul(left, right) | Div(left, right):
            yield from (*_factors(left), *_factors(right))
        case Neg(arg):
            yield from (Neg(ONE), *_factors(arg))
        case _:
            yield law
