"""Numbers that refute a claim: they are evaluated exactly, in the law itself.

Input: a `Question`, and a solver's model.  Output: a finding: REFUTED with the numbers, or OPEN.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple, final

from piezo_sym.expressions.exact_eval import (
    RefusedPowerError,
    TooCloseError,
    Value,
    all_hold,
    value_of,
)
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Expr, names, walk
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.continuity import jumps
from piezo_sym.proofs.domain import spec_points
from piezo_sym.proofs.mending import JUMPS, MEETS
from piezo_sym.proofs.obligations import Question
from piezo_sym.proofs.solvers import Answer, SolverLike
from piezo_sym.report import Verdict
from piezo_sym.spec.tables import condition_text

#: The remedy for a power with an exponent that need not be positive.
POSITIVE = "a base without kinks, which is positive, takes any exponent"


@final
class Finding(NamedTuple):
    """A verdict on a claim, with its witness and reason, and a remedy if it is known already."""

    verdict: Verdict
    witness: Mapping[str, str] | None = None
    reason: str = ""
    remedy: str = ""


def beside_own_values(
    questions: Iterable[Question], iphs: IPHS, solver: SolverLike
) -> Finding | None:
    """Return the refutation of a claim by the spec's own values with some replaced, or None.

    A solver knows functions such as exp by bounds alone, so its model seldom lies in the domain:
    the parameters and inputs of the model are tried with the spec's own state.
    """
    given = iphs.model.parameters.keys() | iphs.model.inputs.keys()
    for question in questions:
        about = {*names(question.original)}
        if question.meeting or question.derived or not about <= given:
            continue
        answer = solver.ask(replace(question, witness=True).query)
        # equations hold by construction: they give a temperature its value
        conditions = [condition for condition in question.where if condition.op != "="]
        taken = {name: answer.model[name] for name in about & answer.model.keys()}
        points = spec_points(iphs, taken) if taken.keys() == about else ()
        for point in points:
            false = all_hold((question.original,), taken) is False
            if false and all_hold(conditions, point) and _lacks_value(question.law, point):
                return refutation(question, taken)
    return None


def _lacks_value(law: Expr | Cmp | None, point: Mapping[str, Value]) -> bool:
    """Return whether the law of a question, if it has one, has no value at a point.

    Names that the point does not give, such as the drive, are 0.
    """
    if law is None:
        return True
    return _has_no_value(law, {**dict.fromkeys(names(law), Fraction(0)), **point})


def checked_model(question: Question, answer: Answer, shown: tuple[str, ...]) -> Finding:
    """Return REFUTED if the model breaks the claim in the law itself, else OPEN."""
    values = {name: value for name, value in answer.model.items() if name in question.order}
    if not (all_hold(question.where, values) and _is_broken(question, values)):
        reason = f"{question.label}: {_why_undecided(question, values)}"
        return Finding(Verdict.OPEN, None, reason, _remedy(question.law, values))
    return refutation(question, {name: value for name, value in values.items() if name in shown})


def power_of_zero(question: Question, solver: SolverLike) -> Finding | None:
    """Return the refutation of a law by a power of zero with a negative exponent, or None.

    Laws may have a power of zero only with an exponent > 0.  But only a negative exponent is a
    counterexample, since in mathematics the others have a value.
    """
    for part in walk(question.law) if question.law else ():
        match part:
            case Call("pow", (base, exponent)):
                claim = Cmp(">=", exponent, ZERO)
                where = (*question.where, Cmp("=", base, ZERO))
                asked = replace(question, where=where, claim=claim, original=claim)
                answer = solver.ask(replace(asked, keep_all=True).query)
                found = answer.model and checked_model(asked, answer, asked.query.variables)
                if found and found.witness:
                    reason = f"{found.reason} is the exponent of {spell(base)} = 0"
                    return found._replace(reason=reason)
    return None


def _why_undecided(question: Question, values: Mapping[str, Value]) -> str:
    """Return why a model refutes nothing: it is not known to be a point of the domain."""
    false = all_hold((question.original,), values) is False
    for condition in question.where:
        if false and condition not in question.branch and _has_no_value(condition, values):
            tie, about = condition.op == "=", {*names(question.original), *names(condition)}
            about -= {*names(condition.left)} if tie else set()
            at = ", ".join(f"{name} = {value}" for name, value in values.items() if name in about)
            what = spell(condition.left) if tie else condition_text(condition)
            return f"it is false at {at}, where '{what}' has no value"
    if _remedy(question.law, values):
        return "laws may have no power of what may be zero with another exponent"
    return "bounds on the functions in it do not decide it"


def _remedy(law: Expr | Cmp | None, values: Mapping[str, Value]) -> str:
    """Return the remedy for a power that laws may not have, if one is met at a point, else ''."""
    return POSITIVE if law and isinstance(_fault(law, values), RefusedPowerError) else ""


def _is_broken(question: Question, values: Mapping[str, Value]) -> bool:
    """Return whether a claim certainly fails at a point of the domain."""
    if question.meeting:
        return jumps(question.meeting, values)
    if question.law is not None:
        return _has_no_value(question.law, values)
    return all_hold((question.original,), values) is False


def _has_no_value(law: Expr | Cmp, values: Mapping[str, Value]) -> bool:
    """Return whether a law, or a side of a comparison, certainly has no value in mathematics."""
    fault = _fault(law, values)
    return not (fault is None or isinstance(fault, TooCloseError | RefusedPowerError))


def _fault(law: Expr | Cmp, values: Mapping[str, Value]) -> Exception | None:
    """Return why a law, or a side of a comparison, has no value, or None."""
    try:
        for side in (law.left, law.right) if isinstance(law, Cmp) else (law,):
            value_of(side, values)
    except (ArithmeticError, ValueError) as fault:
        return fault
    return None


def refutation(question: Question, values: Mapping[str, Value]) -> Finding:
    """Return the finding that numbers break a claim."""
    left, right = question.original.left, question.original.right
    reason = f"{spell(left)} = {_value(left, values)}"
    if isinstance(question.law, Cmp):
        reason += f", where {condition_text(question.law)} has no value"
    if question.original.op in {"=", "<"}:
        reason = f"{question.label} is false: {_value(left, values)} and {_value(right, values)}"
    if question.meeting and question.original.op == "=":
        reason += JUMPS if question.meeting.may_jump else MEETS
    witness = {name: str(value) for name, value in values.items()}
    return Finding(Verdict.REFUTED, witness, reason)


def _value(law: Expr, values: Mapping[str, Value]) -> str:
    try:
        value = value_of(law, values)
    except (ArithmeticError, ValueError):
        return "no value"
    return str(value) if isinstance(value, Fraction) else f"{float(value):.6g}"
