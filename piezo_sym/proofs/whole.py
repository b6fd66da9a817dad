"""The sign of a law as a whole, where its branches in polynomials were not enough.

Input: an `Obligation` that names a law, and a solver.  Output: a verdict with its witness, or None.

A law that reduces to ``prefactors * f(s)``, its letter being a positive scale times s, has the sign
of both: the solver looks at the prefactors, interval arithmetic at ``f(s)*s``.  A sum is passive if
each term is.  Where nothing is proved, simple numbers are tried in the law itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import reduce as fold

from piezo_sym.proofs.exactly import holds
from piezo_sym.proofs.obligations import Obligation, Question, SignOf
from piezo_sym.proofs.report import Verdict
from piezo_sym.proofs.signs import Reduction, decide_sign, reduce
from piezo_sym.proofs.solvers import Asks
from piezo_sym.spec.calculus import mul
from piezo_sym.spec.expressions import ONE, ZERO, Add, Cmp, Expr, Neg, Sym, names
from piezo_sym.spec.tables import greater

#: Values of a letter that are tried against a law, in this order.
TRIED = tuple(
    sign * size
    for size in map(Fraction, ("1", "2", "3", "1/2", "5", "4", "10", "1/10", "20", "100"))
    for sign in (1, -1)
)

Numbers = Mapping[str, Fraction]
Outcome = tuple[Verdict, Numbers | None, str]


def whole_sign(obligation: Obligation, solver: Asks) -> Outcome | None:
    """Return the verdict on the law of an obligation, with the numbers that refute it."""
    sign = obligation.sign
    if sign is None or not obligation.questions:
        return None
    question = obligation.questions[0]
    numbers = tried(question, sign.letter, solver)
    if numbers:
        return Verdict.REFUTED, numbers, ""
    return _decided(sign.law, sign, question, solver)


def _decided(law: Expr, sign: SignOf, question: Question, solver: Asks) -> Outcome | None:
    """Return the verdict on a law, or on a sum from its terms."""
    reduction = reduce(law, sign.letter, _positive(question))
    if reduction is not None:
        return _of_reduction(reduction, question, solver)
    if not isinstance(law, Add):
        return None
    found = [_decided(term, sign, question, solver) for term in law.terms]
    if all(outcome is not None and outcome[0] is Verdict.PROVED for outcome in found):
        return Verdict.PROVED, None, ""
    return None


def _of_reduction(reduction: Reduction, question: Question, solver: Asks) -> Outcome | None:
    """Return the verdict on ``prefactors * f(s) * s``."""
    start: Expr = ONE
    front = fold(mul, reduction.prefactors, start)
    power = mul(reduction.f, Sym(reduction.name))
    if not _follows(question, Cmp(">=", front, ZERO), solver):
        if not _follows(question, Cmp("<=", front, ZERO), solver):
            return None
        front, power = Neg(front), Neg(power)
    decision = decide_sign(power, reduction.name)
    if decision.verdict is not Verdict.REFUTED or decision.witness is None:
        return decision.verdict, None, decision.reason
    needed = {*names(question.original), *(name for name, _ in reduction.units)}
    point = _model(question, Cmp("<=", front, ZERO), solver, needed)
    if point is None:
        return None
    numbers = {**point, reduction.name: reduction.back(decision.witness, point)}
    return (Verdict.REFUTED, numbers, "") if _breaks(question, numbers) else None


def _positive(question: Question) -> frozenset[str]:
    """Return the names that the domain says are positive."""
    return frozenset(
        c.left.name
        for c in map(greater, question.where)
        if c.op == ">" and isinstance(c.left, Sym) and c.right == ZERO
    )


def _domain(question: Question) -> tuple[Cmp, ...]:
    """Return what is assumed of a question besides the conditions of its branch."""
    return question.where[: len(question.where) - len(question.branch)]


def _follows(question: Question, claim: Cmp, solver: Asks) -> bool:
    made = Question("", question.order, _domain(question), claim, claim)
    answers = (solver.ask(part.query()).result for part in made.smooth())
    return claim.left == ONE or all(answer == "unsat" for answer in answers)


def _model(question: Question, claim: Cmp, solver: Asks, wanted: set[str]) -> Numbers | None:
    """Return simple numbers in the domain at which a claim is false, or None."""
    about = tuple(name for name in question.order if name in wanted)
    original = Cmp(">=", Add((claim.left, *map(Sym, about))), ZERO)  # all of their names
    made = Question("", question.order, _domain(question), claim, original)
    for part in made.smooth():
        answer = solver.ask(part.query())
        if answer.result == "sat":
            found = answer.model.items()
            return {name: value for name, value in found if name in question.order}
    return None


def tried(question: Question, letter: str, solver: Asks) -> Numbers | None:
    """Return the first simple numbers at which the law breaks its claim."""
    point = _model(question, Cmp("<", ONE, ZERO), solver, {*names(question.original)})
    for value in TRIED if point is not None else ():
        numbers = {**(point or {}), letter: value}
        if _breaks(question, numbers):
            return numbers
    return None


def _breaks(question: Question, numbers: Numbers) -> bool:
    """Return whether numbers lie in the domain and break the claim in the law itself."""
    try:
        return all(_holding(question, numbers)) and not holds(question.original, numbers)
    except (ArithmeticError, ValueError):
        return False


def _holding(question: Question, numbers: Numbers) -> Iterator[bool]:
    for condition in _domain(question):
        if {*names(condition)} <= numbers.keys():
            yield holds(condition, numbers)
