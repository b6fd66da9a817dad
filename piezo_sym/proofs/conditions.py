"""The conditions for [domain] under which the claims of a row hold.

Input: the questions of a row, and which of them fail.  Output: what to write, as the end of a
reason.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

from piezo_sym.errors import quote
from piezo_sym.expressions.exact_eval import Value, all_hold, value_of
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ONE, ZERO, Cmp, Expr, Pow, names, replaced
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.domain import spec_points
from piezo_sym.proofs.obligations import NEVER, Question
from piezo_sym.proofs.shortening import shortened, sided, without_factors
from piezo_sym.spec.elements.ports import Body, Exchange
from piezo_sym.spec.tables import condition_text, without_default

#: If the law of a temperature is longer than this, a condition says T_body > 0 in its place.
MOST_TEXT = 24
#: The slope with respect to the entropy S of each quantity that must rise with S.
SLOPES = {"energy": "T = dU/dS", "temperature": "dT/dS"}


def domain_conditions(
    questions: Sequence[Question],
    iphs: IPHS,
    ties: Iterable[Cmp],
    fails: Callable[[Question], bool],
) -> str:
    """Return conditions for [domain], such as n > 0, under which all claims hold, or ''.

    They use parameters, inputs, states and temperatures; `ties` replace the letters of laws.  For a
    claim ``!= 0`` the spec's own values decide between > 0 and < 0.  The text says whether these
    values satisfy the conditions; if no point does, it says which temperature falls with S.
    """
    points, letters = spec_points(iphs), {tie.left: tie.right for tie in ties}
    failed = [q for q in questions if fails(q)]
    broken = [
        Cmp(c.op, replaced(c.left, letters), replaced(c.right, letters))
        for c in (q.original for q in failed)
    ]
    known = frozenset[str]().union(*points)
    # claims that a law does not jump are equations, which [domain] does not take
    if not broken or not all(claim.op != "=" and known >= {*names(claim)} for claim in broken):
        return ""

    def mended(conditions: Iterable[Cmp]) -> bool:
        more = tuple(conditions)
        return not any(fails(replace(q, where=(*more, *q.where))) for q in questions)

    found = _conditions(broken, iphs, questions[0], fails)
    where = (*found, *questions[0].where)
    never = Question("", questions[0].order, where, NEVER, NEVER)  # follows if no point is there
    if not all(map(names, found)) or not fails(never):
        return _falling(failed, points)
    said = turning(found, iphs)
    if said or not mended(found):
        return said
    # leave out conditions that the others imply, long ones first
    for claim in sorted(found, key=lambda claim: -len(found[claim])):
        rest = tuple(c for c in found if c != claim)
        if rest and mended(rest):
            del found[claim]
    broken = [claim for claim in found if not _satisfied(claim, points)]
    return in_words([*found.values()], broken, iphs)


def turning(conditions: Iterable[Cmp], iphs: IPHS) -> str:
    """Return a text if a condition says which of two temperatures is higher, or ''.

    Such a condition, which turns where they are equal, would forbid heat to flow one way.
    """
    hot = {body.temperature for _, body in iphs.circuit.of(Body)}
    hot |= {port.input for _, port in iphs.circuit.of(Exchange)}
    for c in conditions:
        compared = hot & {*names(c)}
        level = Cmp("<=", c.left, c.right), Cmp(">=", c.left, c.right)
        equal = ({**point, **dict.fromkeys(compared, ONE.value)} for point in spec_points(iphs))
        if len(compared) > 1 and all(all_hold(level, point) for point in equal):
            said = quote(spell(c.left))
            return f"; {said} changes its sign with the temperature difference: change the law"
    return ""


def _conditions(
    broken: Iterable[Cmp], iphs: IPHS, question: Question, fails: Callable[[Question], bool]
) -> dict[Cmp, str]:
    """Return the conditions under which claims hold, without positive factors, and their texts."""
    points, bodies = spec_points(iphs), [port for _, port in iphs.circuit.of(Body)]
    found = dict[Cmp, str]()

    def follows(claim: Cmp, *more: Cmp) -> bool:
        where = (*more, *found, *question.where)
        return not fails(Question("", question.order, where, claim, claim))

    def positive(part: Expr) -> bool:
        return follows(Cmp(">", part, ZERO))

    for claim in sorted(broken, key=lambda claim: len(names(claim))):
        bare = without_factors(claim, positive)
        short = _at_root(shortened(bare, positive))
        bare = short if short == bare or follows(claim, short) else _at_root(bare)
        ops = (">", "<") if bare.op == "!=" else (bare.op,)
        ways = [Cmp(op, bare.left, bare.right) for op in ops]
        way = next((way for way in ways if _satisfied(way, points)), ways[0])
        warm = [f"{body.temperature} > 0" for body in bodies if body.law == claim.left]
        text = condition_text(sided(way))
        if warm and len(text) > MOST_TEXT:  # T > 0 is about the law itself, not `way`
            way, text = claim, warm[0]
        found.setdefault(way, text)
    return found


def _at_root(claim: Cmp) -> Cmp:
    """Return x**2 > 0, or x**2 != 0, as x != 0, and other claims as they are."""
    match claim:
        case Cmp(">" | "!=", Pow(base, exponent), right) if right == ZERO and exponent % 2 == 0:
            return Cmp("!=", base, ZERO)
    return claim


def _satisfied(condition: Cmp, points: Iterable[Mapping[str, Value]]) -> bool:
    """Return whether the values of the spec satisfy a condition."""
    return all(all_hold((condition,), point) for point in points)


def _falling(failed: Iterable[Question], points: Iterable[Mapping[str, Value]]) -> str:
    """Return a text if a temperature, or its slope, is <= 0 for the values of the spec, or ''."""
    for question in failed:
        for point in points if question.rising else ():
            if all_hold((Cmp("<=", question.original.left, ZERO),), point):
                slope, value = SLOPES[question.rising], value_of(question.original.left, point)
                return (
                    f"; {slope} has to be positive, and is {float(value):g} for the values of the "
                    f"spec: let the {question.rising} rise with S, as exp(S/c) does"
                )
    return ""


def in_words(conditions: Sequence[str], broken: Iterable[Cmp], iphs: IPHS) -> str:
    """Return that conditions mend a row; the values of the spec do not satisfy `broken`."""
    said, many = " and ".join(f"'{text}'" for text in conditions), len(conditions) > 1
    mends, words = f"mend{'' if many else 's'} it", {n: None for c in broken for n in names(c)}
    if words:
        which, cause = "them" if many else "it", without_default(iphs.model, words)
        mends = f"would mend it, but the values of the spec do not satisfy {which}"
        mends += f"; {cause}" * bool(cause)
    return f"; the condition{'s' * many} {said} in [domain] {mends}"
