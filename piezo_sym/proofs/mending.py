"""What mends a refuted law: conditions for [domain] under which it takes power in.

Input: the obligation of a refuted row, and the prover.  Output: conditions with which it is proved.
A law c*f, where f takes power in, does so where c >= 0; factors of c that the domain keeps from
being negative are left out.  A sum does so if each of its terms does: d >= 0 and d_3 >= 0 of
d*v + d_3*v**3; terms that differ by parameters alone are one, on each branch: beta >= abs(gam) of
beta*abs(v) + gam*v.  A factor with exp of the letter is asked for its values at 0 and far from it:
a <= 1 of tanh(v)*(1 - a*exp(-abs(v))).  Conditions that the values of the spec satisfy come first.
For a law that jumps, what to write instead is the same for all: `JUMPS` and `MEETS`.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache, reduce
from itertools import combinations

from piezo_sym.errors import STICKING
from piezo_sym.expressions.calculus import add, compared, inserted, mul, power
from piezo_sym.expressions.exact_eval import Value, all_hold
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tidying import reflected, settled, tidied
from piezo_sym.expressions.tree import (
    ONE,
    ZERO,
    Add,
    Call,
    Cmp,
    Expr,
    Neg,
    Num,
    Pow,
    Sym,
    names,
    replaced,
    walk,
)
from piezo_sym.iphs import IPHS
from piezo_sym.network import slope_of
from piezo_sym.proofs.branches import Branch, TooManyBranchesError, branches
from piezo_sym.proofs.conditions import in_words, turning
from piezo_sym.proofs.domain import spec_points
from piezo_sym.proofs.laws import branch_questions
from piezo_sym.proofs.obligations import Obligation, Question, SignOf
from piezo_sym.proofs.shortening import (
    factors_of,
    product_of,
    shortened,
    sided,
    sign_factors,
    without_factors,
)
from piezo_sym.proofs.signs.cases import summands
from piezo_sym.proofs.signs.reduce import Positive
from piezo_sym.spec.elements.ports import DissipativePort, Storage
from piezo_sym.spec.tables import condition_text

#: What to write for a law that jumps, as the end of a reason.
JUMPS = f"; a law that jumps on purpose says discontinuous = true; {STICKING}"
#: What to write where no law may jump: stores, temperatures, conductances, ratios.
MEETS = (
    "; only a law of dissipation may jump: let the two branches have one value there, as "
    "'a if x < b else a + c*(x - b)' does at b"
)
#: What to do about a law that gives power out in all of the domain, or for the values of the spec.
WRONG_SIGN = "; check the sign of the law"
#: Whether a question is not answered with a proof, and whether an obligation is proved.
Fails = Callable[[Question], bool]
Proved = Callable[[Obligation], bool]
#: Whether law*letter, or a law without letter, is shown to be >= 0 in the domain.
Shown = Callable[[Expr, str], bool]
#: Whether a row is proved where conditions hold besides those of the domain.
Mended = Callable[[tuple[Cmp, ...]], bool]
#: A test of positivity where conditions hold besides those of the domain.
Within = Callable[[Collection[Cmp]], Positive]
#: For a law with more branches, no conditions on the coefficients of its terms are looked for.
MOST = 16
STRICT = {"<=": "<", ">=": ">"}


def mending_conditions(
    obligation: Obligation, sign: SignOf, iphs: IPHS, fails: Fails, proved: Proved
) -> str:
    """Return conditions for [domain] under which the row of a law is proved, in words, or ''."""
    order, given = obligation.questions[0].order, iphs.model.parameters.keys()

    def shown(law: Expr, letter: str) -> bool:
        claim = Cmp(">=", mul(law, Sym(letter)) if letter else law, ZERO)
        question = Question("", order, sign.where, claim, claim)
        return not any(map(fails, branch_questions(law, question, letter)))

    def within(more: Collection[Cmp]) -> Positive:
        def positive(part: Expr) -> bool:
            claim = Cmp(">", part, ZERO)
            return not fails(Question("", order, (*more, *sign.where), claim, claim))

        return cache(positive)

    def mended(conditions: tuple[Cmp, ...]) -> bool:
        questions = tuple(replace(q, where=(*conditions, *q.where)) for q in obligation.questions)
        about = replace(sign, where=(*conditions, *sign.where))
        asked = replace(obligation, questions=questions, sign=about, rests_on=())
        return not within(conditions)(Neg(ONE)) and proved(asked)  # -1 > 0 only in no domain

    if shown(Neg(sign.law), sign.letter):
        return WRONG_SIGN
    points = spec_points(iphs)
    factor = _of_factor(sign.law, sign.letter, shown)
    if factor and not {*names(factor)} <= frozenset[str]().union(*points):
        factor = None  # the rate that drives a slip has no name in [domain]
    if factor and (said := turning([factor], iphs)):
        return said
    ways = [way for way in _ways(factor, sign, given, within, shown) if way]
    ways.sort(key=lambda way: (bool(_broken(way, points)), *_effort(way, given)))
    if not (conditions := _fewest(next(filter(mended, ways), ()), mended)):
        return _signed(sign.law, sign.letter, shown)
    broken = _broken(conditions, points)
    turned = any(isinstance(c.left, Neg) for c in broken)  # -d >= 0, where d is above 0
    said = in_words([condition_text(sided(c)) for c in conditions], broken, iphs)
    return said + WRONG_SIGN * turned


def _fewest(conditions: tuple[Cmp, ...], mended: Mended) -> tuple[Cmp, ...]:
    """Return conditions that mend a row without those that the others imply."""
    for claim in conditions if len(conditions) > 1 else ():
        rest = tuple(c for c in conditions if c != claim)
        conditions = rest if rest and mended(rest) else conditions
    return conditions


def _effort(conditions: Collection[Cmp], given: Collection[str]) -> tuple[bool, bool]:
    """Return whether a run may leave conditions, and whether one is more than a sign.

    No run leaves conditions on parameters alone.
    """
    leaves = any(not {*names(c)} <= {*given} for c in conditions)
    return leaves, any(not isinstance(c.left, Sym) or c.right != ZERO for c in conditions)


def _broken(conditions: Iterable[Cmp], points: Iterable[Mapping[str, Value]]) -> list[Cmp]:
    """Return the conditions that the values of the spec do not satisfy."""
    return [c for c in conditions if any(all_hold((c,), p) is False for p in points)]


def signed_roots(element: str, iphs: IPHS) -> str:
    """Return what to write for a root of a letter or state, which has no value below 0, or ''."""
    for placed, port in iphs.circuit.of(DissipativePort, Storage):
        v = Sym(port.letter if isinstance(port, DissipativePort) else port.state)
        for root in walk(port.law) if placed.element == element else ():
            match root:
                case Call("sqrt", (arg,)):
                    base = arg
                case Pow(arg, e) if e.denominator != 1:
                    base = arg
                case _:
                    continue
            if isinstance(reflected(base, v.name), Neg):
                size = replaced(root, {v: Call("abs", (v,))})
                flow = isinstance(port, DissipativePort)  # of a store, a factor such as 1 + abs(q)
                signed = mul(Call("sign", (v,)), size) if flow else size
                return f"; for both signs of {v.name}, {_instead(signed, root)}"
    return ""


def _signed(law: Expr, letter: str, shown: Shown) -> str:
    """Return what to write for an even power of the letter so that a law takes power in, or ''."""
    v = Sym(letter)
    for part in walk(law):
        match part:
            case Pow(base, e) if base == v and e % 2 == 0:
                signed = mul(power(v, e - 1), Call("abs", (v,)))
            case Call("abs", (arg,)) if arg == v:
                signed = v
            case _:
                continue
        turned = replaced(law, {part: signed})
        if shown(turned, letter) or _of_factor(turned, letter, shown):
            return f"; {_instead(signed, part)}, whose sign is not that of {letter}"
    return ""


def _instead(new: Expr, old: Expr) -> str:
    return f"write {spell(new)} for {spell(old)}"


def _ways(
    factor: Cmp | None, sign: SignOf, given: Collection[str], within: Within, shown: Shown
) -> Iterator[tuple[Cmp, ...]]:
    """Yield conditions that may mend a law: on its factors, on its terms, on its parameters."""
    if factor:
        yield from ((shortened(factor, within(())),), (factor,))
    elif sign.letter:
        yield _of_ends(sign.law, sign.letter, given, shown)
    yield _of_terms(sign, given, within)
    yield tuple(Cmp(">=", Sym(name), ZERO) for name in names(sign.law) if name in given)


def _of_factor(law: Expr, letter: str, shown: Shown) -> Cmp | None:
    """Return the condition under which a law has the sign of its letter; None if none is found.

    A conductance has the letter '' and must be >= 0.
    """
    slope = slope_of(law, letter) if letter else None
    factors = list(sign_factors(law if slope is None else slope))
    rest = [f for f in factors if letter and letter in names(f)]
    if letter and slope is None and not (rest and shown(reduce(mul, rest), letter)):
        return None
    kept = [f for f in factors if f not in rest and not shown(f, "")]
    return Cmp(">=", reduce(mul, kept), ZERO) if any(map(names, kept)) else None


def _of_ends(law: Expr, letter: str, given: Collection[str], shown: Shown) -> tuple[Cmp, ...]:
    """Return conditions on `given` names under which a factor is >= 0 at letter 0 and far from it.

    A factor with exp(-abs(v)), which is 1 at v = 0 and 0 far away, may lie between these values.
    """
    factors = list(sign_factors(law))
    for n, factor in enumerate(factors):
        others = [*factors[:n], *factors[n + 1 :]]
        moving = [f for f in others if letter in names(f)]
        bells = [e for e in walk(factor) if isinstance(e, Call) and e.function == "exp"]
        if bells and moving and shown(reduce(mul, moving), letter):
            ends = (replaced(factor, dict.fromkeys(bells, e)) for e in (ONE, ZERO))
            ends = (settled(inserted(compared(e), {letter: ZERO}), ()) for e in ends)
            fixed = (f for f in others if f not in moving)
            asked = dict.fromkeys(tidied(f) for f in (*ends, *fixed) if not shown(f, ""))
            found = tuple(Cmp(">=", f, ZERO) for f in asked)
            return found if all({*names(f)} <= {*given} for f in asked) else ()
    return ()


def _of_terms(sign: SignOf, fixed: Collection[str], within: Within) -> tuple[Cmp, ...]:
    """Return conditions on the `fixed` names under which all terms take power in; () if none."""
    try:
        pieces = branches(sign.law, sign.where)
    except TooManyBranchesError:
        return ()
    found = dict[Expr, None]()
    for branch in pieces if len(pieces) <= MOST else ():
        own = _of_branch(branch, sign.letter, fixed, within)
        if own is None:
            return ()
        found |= dict.fromkeys(own)
    everywhere = within(())
    claims = (without_factors(Cmp(">=", c, ZERO), everywhere) for c in found)
    conditions = dict.fromkeys(shortened(claim, everywhere) for claim in claims)
    if any(tidied(add(a.left, b.left)) == ZERO for a, b in combinations(conditions, 2)):
        return ()  # a coefficient must be zero, as a + d in (a + d)*abs(v)
    return _joined(c for c in conditions if names(c))


def _of_branch(
    branch: Branch, letter: str, fixed: Collection[str], within: Within
) -> list[Expr] | None:
    """Return what has to be >= 0 on a branch, if need be found for each sign of the letter."""
    inside = [Cmp(STRICT.get(c.op, c.op), c.left, c.right) for c in branch.conditions]
    if within(inside)(Neg(ONE)):
        return []  # no point is on it, or those of an edge alone
    own = _coefficients(branch, letter, fixed, within(inside))
    if own is not None or not letter:
        return own
    found = list[Expr]()
    for op in (">", "<"):
        positive = within((*inside, Cmp(op, Sym(letter), ZERO)))
        own = [] if positive(Neg(ONE)) else _coefficients(branch, letter, fixed, positive)
        if own is None:
            return None
        found += own
    return found


def _coefficients(
    branch: Branch, letter: str, fixed: Collection[str], positive: Positive
) -> list[Expr] | None:
    """Return what has to be >= 0 for a law to take power in on a branch; None if not known."""
    total: dict[frozenset[object], list[Expr]] = {}
    for term in summands(mul(branch.value, Sym(letter)) if letter else branch.value):
        number, powers = factors_of(term, positive)
        moving = {base: e for base, e in powers.items() if not {*names(base)} <= {*fixed}}
        for base, e in moving.items():
            if e % 2 == 0 or positive(base):
                continue
            if e.denominator != 1 or not positive(Neg(base)):
                return None
            number = -number
        constant = {base: e for base, e in powers.items() if base not in moving}
        total.setdefault(frozenset(moving.items()), []).append(product_of(number, constant))
    return [tidied(add(*parts)) for parts in total.values()]


def _joined(conditions: Iterable[Cmp]) -> tuple[Cmp, ...]:
    """Return conditions with a + b >= 0 and a - b >= 0 as a >= abs(b)."""
    left = list(conditions)
    for one, other in combinations(left, 2):
        a = tidied(mul(Num(ONE.value / 2), add(one.left, other.left)))
        b = tidied(add(one.left, Neg(a)))
        if isinstance(one.left, Add) and not isinstance(a, Add) and not isinstance(b, Add):
            both = Cmp(">=", a, Call("abs", (b.arg if isinstance(b, Neg) else b,)))
            return (*(c for c in left if c not in (one, other)), both)
    return tuple(left)
