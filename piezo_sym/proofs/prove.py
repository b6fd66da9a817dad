"""Obligations to verdicts: the one place where something becomes PROVED.

Input: an `Obligation`, and the rows it rests on.  Output: a `Row`.  PROVED needs every residual
zero, every question answered with `unsat`, and every row it rests on PROVED.  REFUTED needs a
witness that was evaluated exactly in the law itself.  All else is OPEN, with the reason.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import product

import sympy as sp

from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ZERO, Cmp, names
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.asked import DomainOracle, moved_counterexample, simple_counterexample
from piezo_sym.proofs.assumptions import drive_of
from piezo_sym.proofs.conditions import domain_conditions
from piezo_sym.proofs.continuity import neighbour_questions
from piezo_sym.proofs.domain import rounded_points
from piezo_sym.proofs.mending import mending_conditions, signed_roots
from piezo_sym.proofs.obligations import Obligation, Question, Residual, SignOf
from piezo_sym.proofs.refutation import (
    Finding,
    beside_own_values,
    checked_model,
    power_of_zero,
    refutation,
)
from piezo_sym.proofs.sign_analysis import whole_sign
from piezo_sym.proofs.signs.certificate import Case
from piezo_sym.proofs.solvers import SolverLike, opinions
from piezo_sym.report import RESTS, Row, Verdict
from piezo_sym.spec.tables import condition_text

#: Size of banks in a refutation by algebra: with one lane, coupling between lanes would not show.
LANES = 2
#: First values that the symbols of a residual are given.
STARTS = (1, 2, 3)
LOOSE = "the domain may bound what drives the element, in a way that is not looked at"
#: Rows for which, once refuted, conditions for [domain] are looked for.
DECLARED = frozenset({"welldef", "temperature", "exergy", "environment"})
#: The remedy where an integrated energy is not shown to belong to its law.
GIVE = "the law's energy that was found could not be verified: give it, energy = '...'"
#: Open questions of an obligation after which no more are asked.
MOST_OPEN = 4
#: With more questions than this, no condition for [domain] is looked for: it repeats all of them.
MOST_MENDED = 500


def prove(
    obligation: Obligation, iphs: IPHS, before: Iterable[Row] = (), solver: SolverLike | None = None
) -> Row:
    """Return the verdict on one obligation.

    Parameters
    ----------
    obligation : what to show; from `obligations`.
    iphs : the system it is about.
    before : the rows so far; the obligation stays open if one it rests on is not among them.
    solver : for its questions; by default z3, and cvc5 where z3 does not know.
    """
    solver, known = solver or opinions(), tuple(before)
    found, method, certificate = _decide(obligation, iphs, known, solver)
    if found.verdict is Verdict.REFUTED and obligation.loose in (found.witness or {}):
        found = Finding(Verdict.OPEN, None, LOOSE)
    # a jump is shown by values on both sides of the edge: the law must have values there
    if found.verdict is Verdict.REFUTED and obligation.id == "continuous":
        values = {(row.id, row.element) for row in known} & {("welldef", obligation.element)}
        found = _unproved_premise(values, known) or found
    return Row(
        obligation.id,
        obligation.element,
        obligation.statement,
        found.verdict,
        found.witness,
        found.reason + _mended_by(found, obligation, iphs, solver),
        obligation.required,
        method,
        certificate=tuple(case.as_data() for case in certificate),
    )


def _decide(
    obligation: Obligation, iphs: IPHS, before: tuple[Row, ...], solver: SolverLike
) -> tuple[Finding, str, tuple[Case, ...]]:
    """Return the finding, the method, and the certificate."""
    if obligation.open_because:
        return Finding(Verdict.OPEN, None, obligation.open_because), "branches", ()
    for residual in obligation.residuals:
        if residual.empty and all(solver.ask(q.query).result == "unsat" for q in residual.empty):
            continue
        failed = _residual_failure(residual, iphs)
        if failed and residual.derived:
            return Finding(Verdict.OPEN, None, failed.reason, GIVE), "algebra", ()
        if failed:
            return failed, "algebra", ()
    method, certificate = "branches" if obligation.questions else "algebra", tuple[Case, ...]()
    failed = _first_failure(obligation.questions, solver)
    if failed and failed.verdict is Verdict.OPEN and obligation.sign and obligation.sign.letter:
        method = "intervals"
        failed, certificate = _by_intervals(obligation, iphs, obligation.sign, failed, solver)
    if failed and failed.verdict is Verdict.OPEN and obligation.letter:
        failed = _by_numbers(obligation, solver) or failed
    if failed and failed.verdict is Verdict.OPEN and obligation.id == "temperature":
        failed = _by_moved_numbers(obligation, iphs, solver) or failed
    if failed and failed.verdict is Verdict.OPEN:
        failed = beside_own_values(obligation.questions, iphs, solver) or failed
    failed = failed or _unproved_premise(obligation.rests_on, before)
    return failed or Finding(Verdict.PROVED), method, () if failed else certificate


def _first_failure(questions: Iterable[Question], solver: SolverLike) -> Finding | None:
    """Return the first refutation of a question, else the first open finding, else None."""
    left: list[Finding] = []
    for question in neighbour_questions(tuple(questions), solver):
        found = _failure(question, solver)
        if found and found.verdict is Verdict.REFUTED:
            return found
        left += [found] if found else []
        if len(left) == MOST_OPEN:
            break
    return left[0] if left else None


def _by_intervals(
    obligation: Obligation, iphs: IPHS, sign: SignOf, still_open: Finding, solver: SolverLike
) -> tuple[Finding | None, tuple[Case, ...]]:
    """Return the certificate of a law that `sign_analysis` proves passive, else the finding."""
    question = obligation.questions[0]
    found = whole_sign(sign, question.order, solver, rounded_points(iphs))
    if found is None:
        return still_open, ()
    if found.verdict is Verdict.PROVED:
        return None, found.certificate
    if found.numbers is not None:
        return refutation(question, found.numbers), ()
    return Finding(Verdict.OPEN, None, f"{obligation.statement}: {found.reason}"), ()


def _by_numbers(obligation: Obligation, solver: SolverLike) -> Finding | None:
    """Return the refutation of a claim by simple numbers, or None."""
    question = obligation.questions[0]
    conditions = question.where[: len(question.where) - len(question.branch)]
    domain = DomainOracle(conditions, question.order, solver)
    numbers = simple_counterexample(question.original, obligation.letter, domain)
    return refutation(question, numbers) if numbers else None


def _by_moved_numbers(obligation: Obligation, iphs: IPHS, solver: SolverLike) -> Finding | None:
    """Return the refutation of T > 0 or dT/dS > 0 by simple numbers, or None.

    Solvers know functions by bounds, and their model may be none of tanh(S/S_0).
    """
    for question in (question for question in obligation.questions if question.rising):
        domain = DomainOracle(question.where, question.order, solver)
        states = [n for n in names(question.original) if n not in iphs.model.parameters]
        for start, state in product((None, *rounded_points(iphs)), states):
            if numbers := moved_counterexample(question.original, state, domain, start):
                return refutation(question, numbers)
    return None


def _unproved_premise(
    premises: Iterable[tuple[str, str]], before: tuple[Row, ...]
) -> Finding | None:
    """Return the finding on the first premise that is not proved, or None."""
    for premise in premises:
        name = f"{premise[0]} of {premise[1]}" if premise[1] else premise[0]
        verdicts = [row.verdict for row in before if (row.id, row.element) == premise]
        if not verdicts:
            return Finding(Verdict.OPEN, None, f"{RESTS} {name}, which was not looked at")
        for verdict in verdicts:
            if verdict is not Verdict.PROVED:
                reason = f"{RESTS} {name}, which is {verdict.value}"
                return Finding(Verdict.OPEN, None, reason)
    return None


def _residual_failure(residual: Residual, iphs: IPHS) -> Finding | None:
    """Return None if a residual is zero, else the finding."""
    value = sp.expand(residual.expr)
    if value == 0:
        return None
    witness = _nonzero_point(iphs, value)
    if witness is None:
        reason = f"{residual.place} = {value} was not shown to be zero"
        return Finding(Verdict.OPEN, None, reason)
    numbers, at = witness
    return Finding(Verdict.REFUTED, numbers, f"{residual.place} = {value}, which is {at}")


def _nonzero_point(iphs: IPHS, expr: sp.Expr) -> tuple[dict[str, str], sp.Expr] | None:
    """Return exact numbers at which `expr` is not zero, and its value there, or None."""
    lanes = iphs.system.E.lanes
    counts = dict.fromkeys(lanes.counts, LANES)
    written = lanes.expand(expr, counts)
    symbols = sorted(written.free_symbols, key=lambda symbol: str(symbol.name))
    sizes = {symbol.name: str(counts[bank]) for bank, symbol in lanes.counts.items()}
    for start in STARTS:
        values = {s: sp.Integer(start + n % len(STARTS)) for n, s in enumerate(symbols)}
        try:
            value = written.xreplace(values)
        except TypeError:  # a side of a comparison has no real value there
            continue
        if value.is_number and value.is_zero is False:
            return {**sizes, **{s.name: str(v) for s, v in values.items()}}, value
    return None


def _failure(question: Question, solver: SolverLike) -> Finding | None:
    """Return None if the claim follows, else the finding."""
    answer = solver.ask(question.query)
    if answer.result == "unsat":
        return None
    if answer.result == "sat":
        shown = question.query.variables
        answer = solver.ask(replace(question, keep_all=True).query)
        if answer.result == "unsat":
            return None
        if answer.result == "sat":
            found = checked_model(question, answer, shown)
            if found.remedy:
                found = power_of_zero(question, solver) or found
            return _of_derived(question, found) if question.derived else found
    return Finding(Verdict.OPEN, None, f"{question.label}: {answer.reason}")


def _of_derived(question: Question, found: Finding) -> Finding:
    """Return why a question about an integrated energy is open, and what to write."""
    if found.witness is None or question.law is None or question.branch:
        return Finding(Verdict.OPEN, None, found.reason, GIVE)
    claim = question.original
    ops = (">", "<") if claim.op == "!=" else (claim.op,)  # [domain] takes no !=
    bounds = " or ".join(f"'{condition_text(Cmp(op, claim.left, claim.right))}'" for op in ops)
    at = ", ".join(f"{name} = {value}" for name, value in found.witness.items())
    reason = (
        f"the law's energy that was found has no value at {at}: add {bounds} to [domain], or give "
        f"the law's energy, energy = '...'"
    )
    return Finding(Verdict.OPEN, None, reason)


def _mended_by(found: Finding, obligation: Obligation, iphs: IPHS, solver: SolverLike) -> str:
    """Return what mends a row, as the end of its reason: a condition, else the finding's remedy."""
    refuted, conditions = found.verdict is Verdict.REFUTED, ""
    if obligation.sign and (refuted or found.reason.endswith(LOOSE)):
        conditions = mending_conditions(
            obligation,
            obligation.sign,
            iphs,
            lambda q: _failure(q, solver) is not None,
            lambda o: _decide(o, iphs, (), solver)[0].verdict is Verdict.PROVED,
        )
    if refuted and obligation.id == "welldef":
        conditions = signed_roots(obligation.element, iphs)
    if refuted and obligation.id == "odd":
        conditions = _held(found.witness or {}, obligation.element, iphs)
    if found.remedy or (refuted and obligation.id in DECLARED):
        conditions += _domain_conditions(obligation, iphs, solver)
    return conditions or (f"; {found.remedy}" if found.remedy else "")


def _held(witness: Mapping[str, str], element: str, iphs: IPHS) -> str:
    """Return the note that states in a letter's drive were held while its sign changed, or ''."""
    for tie in drive_of(iphs, element):
        driving = {slot.label for slot in iphs.system.states} & {*names(tie.right)}
        if held := [name for name in witness if name in driving]:
            said = f"{' and '.join(held)} {'were' if len(held) > 1 else 'was'} held"
            return f"; {said} while {spell(tie.left)} = {spell(tie.right)} changed its sign"
    return ""


def _domain_conditions(obligation: Obligation, iphs: IPHS, solver: SolverLike) -> str:
    """Return the conditions for [domain] that mend a row, as the end of its reason, or ''."""
    if len(obligation.questions) > MOST_MENDED:
        return ""
    ties = drive_of(iphs, obligation.element)
    asked = neighbour_questions(obligation.questions, solver)
    questions = tuple(replace(q, where=(*ties, *q.where)) for q in asked)
    # a loop of resistors has a solution where each of their slopes is >= 0, which passivity asks
    loops = iphs.junction.slopes if (obligation.id, obligation.element) == ("welldef", "") else ()
    slopes = [Cmp(">=", slope.law, ZERO) for slope in loops]
    signed = tuple(replace(q, original=claim) for q in questions for claim in slopes)
    found = (
        domain_conditions(tried, iphs, ties, lambda q: _failure(q, solver) is not None)
        for tried in (signed, questions)
    )
    return next(filter(None, found), "")
