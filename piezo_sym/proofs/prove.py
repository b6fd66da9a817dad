"""Obligations to verdicts: the one place where something becomes PROVED.

Input: an `Obligation`, and the verdicts on what it rests on.  Output: a `Row`.  PROVED needs every
residual zero, every question answered with `unsat`, and everything it rests on PROVED.  REFUTED
needs a witness that was evaluated exactly in the law itself.  All else is OPEN, with the reason.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction

import sympy as sp

from piezo_sym.expressions.calculus import mul
from piezo_sym.expressions.exact_eval import TooCloseError, all_hold, value_of
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ZERO, Cmp, Expr, Sym, names
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.asked import Asked, tried
from piezo_sym.proofs.continuity import jumps, needed
from piezo_sym.proofs.domain import own_values
from piezo_sym.proofs.laws import on_branches
from piezo_sym.proofs.mending import mending
from piezo_sym.proofs.obligations import Obligation, Question, Residual, SignOf
from piezo_sym.proofs.report import Row, Verdict
from piezo_sym.proofs.sign_analysis import whole_sign
from piezo_sym.proofs.signs.certificate import Case
from piezo_sym.proofs.solvers import Answer, Asks, opinions
from piezo_sym.spec.tables import condition_text

#: Size of banks in a refutation by algebra: with one lane, coupling between lanes would not show.
LANES = 2
TRIES = (1, 2, 3)

LOOSE = "the domain may bound what drives the element, in a way that is not looked at"
#: Rows whose questions may be about parameters and inputs alone.
DECLARED = frozenset({"welldef", "exergy", "environment"})
#: What is said of an energy that was found for a law, and is not shown to be good.
GIVE = "the energy found for the law is not shown to be one: give it, energy = '...'"
#: Once so many questions of an obligation are open, the rest is not asked.
MOST_OPEN = 4

Found = tuple[Verdict, Mapping[str, str] | None, str]
Decided = tuple[Verdict, Mapping[str, str] | None, str, str, tuple[Case, ...]]


def prove(
    obligation: Obligation, iphs: IPHS, before: Iterable[Row] = (), solver: Asks | None = None
) -> Row:
    """Return the verdict on one obligation.

    Parameters
    ----------
    obligation : what to show; from `obligations`.
    iphs : the system it is about.
    before : the verdicts so far, with those of what it rests on; without them it stays open.
    solver : for its questions; z3, and cvc5 where z3 does not know, if none is given.
    """
    asked = solver or opinions()
    known = tuple(before)
    decided = _decide(obligation, iphs, known, asked)
    verdict, witness, reason, method, certificate = decided
    if verdict is Verdict.REFUTED and obligation.loose in (witness or {}):
        verdict, witness, reason = Verdict.OPEN, None, LOOSE
    if verdict is Verdict.REFUTED and obligation.id == "continuous":  # beside the edge, too
        values = {(row.id, row.element) for row in known} & {("welldef", obligation.element)}
        verdict, witness, reason = _not_proved(values, known) or (verdict, witness, reason)
    if verdict is Verdict.REFUTED and obligation.sign:
        reason += _mended(obligation.sign, obligation.questions, asked)
    if verdict is Verdict.REFUTED and obligation.id in DECLARED:
        reason += _declared(obligation.questions, iphs, asked)
    return Row(
        obligation.id,
        obligation.element,
        obligation.statement,
        verdict,
        witness,
        reason,
        obligation.required,
        method,
        certificate=tuple(case.as_data() for case in certificate),
    )


def _decide(obligation: Obligation, iphs: IPHS, before: tuple[Row, ...], solver: Asks) -> Decided:
    """Return the verdict with its witness and reason, the method, and the certificate."""
    if obligation.open_because:
        return Verdict.OPEN, None, obligation.open_because, "branches", ()
    for residual in obligation.residuals:
        if residual.empty and all(solver.ask(q.query).result == "unsat" for q in residual.empty):
            continue
        failed = _vanishes(residual, iphs)
        if failed and residual.found:
            return Verdict.OPEN, None, f"{failed[2]}; {GIVE}", "algebra", ()
        if failed:
            return *failed, "algebra", ()
    method, certificate = "branches" if obligation.questions else "algebra", tuple[Case, ...]()
    failed = _asked(obligation.questions, solver)
    if failed and failed[0] is Verdict.OPEN and obligation.sign and obligation.sign.letter:
        method = "intervals"
        failed, certificate = _as_a_whole(obligation, obligation.sign, failed, solver)
    if failed and failed[0] is Verdict.OPEN and obligation.letter:
        failed = _by_numbers(obligation, solver) or failed
    proved: Found = (Verdict.PROVED, None, "")
    failed = failed or _not_proved(obligation.rests_on, before)
    return *(failed or proved), method, () if failed else certificate


def _asked(questions: Iterable[Question], solver: Asks) -> Found | None:
    """Return the first question that is refuted, else the first that is open, else None."""
    left: list[Found] = []
    for question in needed(tuple(questions), solver):
        found = _answered(question, solver)
        if found and found[0] is Verdict.REFUTED:
            return found
        left += [found] if found else []
        if len(left) == MOST_OPEN:
            break
    return left[0] if left else None


def _as_a_whole(
    obligation: Obligation, sign: SignOf, still_open: Found, solver: Asks
) -> tuple[Found | None, tuple[Case, ...]]:
    """Return how a law fails to be passive, or its certificate if `sign_analysis` proves it."""
    question = obligation.questions[0]
    found = whole_sign(sign, question.order, solver)
    if found is None:
        return still_open, ()
    if found.verdict is Verdict.PROVED:
        return None, found.certificate
    if found.numbers is not None:
        return _broken(question, found.numbers), ()
    return (Verdict.OPEN, None, f"{obligation.statement}: {found.reason}"), ()


def _by_numbers(obligation: Obligation, solver: Asks) -> Found | None:
    """Return the refutation of a claim by simple numbers, or None."""
    question = obligation.questions[0]
    domain = question.where[: len(question.where) - len(question.branch)]
    asked = Asked(domain, question.order, solver)
    numbers = tried(question.original, obligation.letter, asked)
    return _broken(question, numbers) if numbers else None


def _not_proved(premises: Iterable[tuple[str, str]], before: tuple[Row, ...]) -> Found | None:
    """Return the first of some obligations that is not proved."""
    for premise in premises:
        name = f"{premise[0]} of {premise[1]}" if premise[1] else premise[0]
        verdicts = [row.verdict for row in before if (row.id, row.element) == premise]
        if not verdicts:
            return Verdict.OPEN, None, f"it rests on {name}, which was not looked at"
        for verdict in verdicts:
            if verdict is not Verdict.PROVED:
                return Verdict.OPEN, None, f"it rests on {name}, which is {verdict.value}"
    return None


def _vanishes(residual: Residual, iphs: IPHS) -> Found | None:
    """Return None if a residual is zero, else how it fails."""
    value = sp.expand(residual.expr)
    if value == 0:
        return None
    witness = _nonzero(iphs, value)
    if witness is None:
        reason = f"{residual.place} = {value} was not shown to be zero"
        return Verdict.OPEN, None, reason
    numbers, at = witness
    return Verdict.REFUTED, numbers, f"{residual.place} = {value}, which is {at}"


def _nonzero(iphs: IPHS, expr: sp.Expr) -> tuple[dict[str, str], sp.Expr] | None:
    """Return exact numbers at which `expr` is not zero, and its value there."""
    lanes = iphs.system.E.lanes
    counts = dict.fromkeys(lanes.counts, LANES)
    written = lanes.expand(expr, counts)
    symbols = sorted(written.free_symbols, key=lambda symbol: str(symbol.name))
    sizes = {symbol.name: str(counts[bank]) for bank, symbol in lanes.counts.items()}
    for start in TRIES:
        values = {s: sp.Integer(start + n % len(TRIES)) for n, s in enumerate(symbols)}
        try:
            value = written.xreplace(values)
        except TypeError:  # it compares what has no real value there
            continue
        if value.is_number and value.is_zero is False:
            return {**sizes, **{s.name: str(v) for s, v in values.items()}}, value
    return None


def _answered(question: Question, solver: Asks) -> Found | None:
    """Return None if the claim follows, else how it fails or why it is open."""
    answer = solver.ask(question.query)
    if answer.result == "unsat":
        return None
    if answer.result == "sat":
        shown = question.query.variables
        answer = solver.ask(replace(question, whole=True).query)
        if answer.result == "unsat":
            return None
        if answer.result == "sat":
            found = _refuted(question, answer, shown)
            return (Verdict.OPEN, None, f"{found[2]}; {GIVE}") if question.found else found
    return Verdict.OPEN, None, f"{question.label}: {answer.reason}"


def _refuted(question: Question, answer: Answer, shown: tuple[str, ...]) -> Found:
    """Return REFUTED if the model breaks the claim in the law itself, else OPEN."""
    values = {name: value for name, value in answer.model.items() if name in question.order}
    if not (all_hold(question.where, values) and _is_broken(question, values)):
        reason = f"{question.label}: bounds on the functions in it do not decide it"
        return Verdict.OPEN, None, reason
    return _broken(question, {name: value for name, value in values.items() if name in shown})


def _is_broken(question: Question, values: Mapping[str, Fraction]) -> bool:
    """Return whether a claim on a law certainly fails at a point of the domain."""
    if question.meeting:
        return jumps(question.meeting, values)
    if question.law is not None:
        return _has_no_value(question.law, values)
    return all_hold((question.original,), values) is False


def _has_no_value(law: Expr | Cmp, values: Mapping[str, Fraction]) -> bool:
    """Return whether a law, or a side of a comparison, certainly has no value."""
    try:
        for side in (law.left, law.right) if isinstance(law, Cmp) else (law,):
            value_of(side, values)
    except TooCloseError:
        return False
    except (ArithmeticError, ValueError):
        return True
    return False


def _broken(question: Question, values: Mapping[str, Fraction]) -> Found:
    """Return the refutation of a claim by numbers that break it."""
    left, right = question.original.left, question.original.right
    reason = f"{spell(left)} = {_value(left, values)}"
    if isinstance(question.law, Cmp):
        reason += f", where {condition_text(question.law)} has no value"
    if question.original.op in {"=", "<"}:
        reason = f"{question.label} is false: {_value(left, values)} and {_value(right, values)}"
        reason += "; a law that jumps on purpose says discontinuous = true" * bool(question.meeting)
    return Verdict.REFUTED, {name: str(value) for name, value in values.items()}, reason


def _mended(sign: SignOf, questions: tuple[Question, ...], solver: Asks) -> str:
    """Return the condition that mends a refuted law, as the end of a reason."""

    def shown(law: Expr, letter: str) -> bool:
        claim = Cmp(">=", mul(law, Sym(letter)) if letter else law, ZERO)
        asked = Question("", questions[0].order, sign.where, claim, claim)
        return _asked(on_branches(law, asked, letter), solver) is None

    condition = mending(sign.law, sign.letter, shown)
    return f"; the condition '{condition}' in [domain] mends it" * bool(condition)


def _declared(questions: tuple[Question, ...], iphs: IPHS, solver: Asks) -> str:
    """Return what parameters and inputs have to keep, as n > 0, for all questions to be answered.

    Values of the spec keep it, too; of what must not be zero that says the sign.
    """
    known = iphs.model.parameters.keys() | iphs.model.inputs.keys()
    broken = [q.original for q in questions if _answered(q, solver)]
    if not all(names(claim.left) and known >= {*names(claim.left)} for claim in broken):
        return ""
    points = own_values(iphs)

    def kept(conditions: tuple[Cmp, ...]) -> bool:
        return all(all_hold(conditions, point) for point in points)

    def mended(conditions: tuple[Cmp, ...]) -> bool:
        within = (replace(q, where=(*conditions, *q.where)) for q in questions)
        return kept(conditions) and _asked(within, solver) is None

    found: tuple[Cmp, ...] = ()
    for claim in broken:
        ops = (">", "<") if claim.op == "!=" else (claim.op,)
        ways = (Cmp(op, claim.left, claim.right) for op in ops)
        found += tuple(way for way in ways if kept((way,)) and way not in found)[:1]
    if not found or not mended(found):
        return ""
    for claim in found:  # what others imply is left out
        rest = tuple(c for c in found if c != claim)
        found = rest if rest and mended(rest) else found
    said, many = " and ".join(f"'{condition_text(claim)}'" for claim in found), len(found) > 1
    return f"; the condition{'s' * many} {said} in [domain] mend{'' if many else 's'} it"


def _value(law: Expr, values: Mapping[str, Fraction]) -> str:
    try:
        value = value_of(law, values)
    except (ArithmeticError, ValueError):
        return "no value"
    return str(value) if isinstance(value, Fraction) else f"{float(value):.6g}"
