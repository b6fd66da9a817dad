"""The obligations on a model's domain and on the divisors of its junction laws.

Input: an `IPHS`.  Output: obligations that conditions of the domain have values and that divisors
are not zero, and the reason to leave all rows open if the domain has no known point.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from decimal import Context
from fractions import Fraction
from types import MappingProxyType

from piezo_sym.algebra.symbols import coefficient
from piezo_sym.expressions.exact_eval import Value, all_hold, value_of
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ZERO, Cmp, Expr, Neg, names
from piezo_sym.expressions.tree import replace as put
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.assumptions import Assumptions
from piezo_sym.proofs.laws import branch_questions, value_questions
from piezo_sym.proofs.obligations import NEVER, Obligation, Question
from piezo_sym.proofs.solvers import SolverLike
from piezo_sym.spec.elements.ports import Body, Coupling

#: To six significant digits, as the numbers that a witness shows.
ROUNDED = Context(prec=6)
NOTHING: Mapping[str, Fraction] = MappingProxyType({})
#: A longer divisor is shown only in part.
MOST_TEXT = 60


def domain_defined(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    """Yield the obligation that each condition has a value where those before it hold.

    Conditions that always have a value come first, as the order of conditions is free.
    """
    trees = [condition.tree for condition in iphs.circuit.conditions]
    ties = replace(assumptions, where=tuple(c for c in assumptions.where if c.op == "="))

    def questions() -> Iterator[Question]:
        partial = [tree for tree in trees if value_questions(tree, ties)]
        known = [tree for tree in trees if tree not in partial]
        for tree in partial:
            yield from value_questions(tree, replace(ties, where=(*known, *ties.where)))
            known.append(tree)

    statement, latex = "the domain: each condition has a value", r"\mathcal{D}"
    obligation = Obligation("welldef", "", statement, latex, assumptions.texts)
    obligation = obligation.asking(questions, "a condition of the domain")
    if obligation.questions or obligation.open_because:
        yield obligation


def divisors(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    """Yield the obligation that each divisor of the junction laws is not zero.

    Divisors are ratios of levers and determinants of resistive loops.
    """
    words = {port.name: port.ratio for _, port in iphs.circuit.of(Coupling)}
    words |= {str(slope.symbol.name): slope.law for slope in iphs.junction.slopes}
    forms = map(coefficient, iphs.junction.divisors)
    for form in dict.fromkeys(f.arg if isinstance(f, Neg) else f for f in forms):
        yield _nonzero(form, words, assumptions)


def _nonzero(form: Expr, words: Mapping[str, Expr], assumptions: Assumptions) -> Obligation:
    """State that a divisor of the junction laws is not zero."""
    text = spell(form)
    short = text if len(text) <= MOST_TEXT else f"{text[: MOST_TEXT - 3]}..."
    statement = f"{short} != 0: the junction laws divide by it"
    obligation = Obligation("welldef", "", statement, r"\det \ne 0", assumptions.texts)
    law = put(form, words)
    question = assumptions.question(f"{short} != 0", Cmp("!=", law, ZERO))
    return obligation.asking(
        lambda: (*value_questions(law, assumptions), *branch_questions(law, question)), short
    )


def why_empty(iphs: IPHS, assumptions: Assumptions, solver: SolverLike) -> str:
    """Return the reason to leave all open if the domain has no known point, else ''.

    The spec's own values should be one; where that is not certain, the solver looks for another.
    Both are evaluated exactly.
    """
    if _all_inside(assumptions, spec_points(iphs)):
        return ""
    question = assumptions.question("the domain is empty", NEVER)
    answer = solver.ask(replace(question, keep_all=True).query)
    if answer.result == "sat" and _all_inside(assumptions, (answer.model,)):
        return ""
    given = ", ".join(assumptions.texts)
    if answer.result == "unsat":
        return f"no point is in the domain, where all is true: {given}"
    return f"no point is known to be in the domain: {given}"


def _all_inside(assumptions: Assumptions, points: tuple[Mapping[str, Value], ...]) -> bool:
    """Return whether every point is certainly in the domain."""
    # equations hold by construction: they give a temperature its value
    conditions = [condition for condition in assumptions.where if condition.op != "="]
    return bool(points) and all(all_hold(conditions, point) for point in points)


def rounded_points(iphs: IPHS) -> tuple[dict[str, Fraction], ...]:
    """Return the spec's own values in each lane, rounded; without those that are not rational."""
    return tuple(
        {
            name: Fraction(ROUNDED.divide(value.numerator, value.denominator))
            for name, value in point.items()
            if isinstance(value, Fraction)
        }
        for point in spec_points(iphs)
    )


def spec_points(
    iphs: IPHS, given: Mapping[str, Fraction] = NOTHING
) -> tuple[dict[str, Value], ...]:
    """Return the spec's own values in each lane of its banks; () if one of them has no value.

    Values in `given` replace the spec's own; temperatures follow from the rest.
    """
    model = iphs.model
    lists = {name: parameter.lanes for name, parameter in model.parameters.items()}
    sizes = [*map(len, lists.values()), *map(len, iphs.starts)]
    points = []
    try:
        for lane in range(max(sizes, default=1)):
            values: dict[str, Value] = {
                name: Fraction(given[min(lane, len(given) - 1)]) for name, given in lists.items()
            }
            values |= {name: Fraction(entry.si) for name, entry in model.inputs.items()}
            values |= given
            values |= {
                slot.label: value_of(parts[min(lane, len(parts) - 1)], values)
                for slot, parts in zip(iphs.system.states, iphs.starts, strict=True)
            }
            values |= given
            for _, port in iphs.circuit.of(Body):
                if values.keys() >= {*names(port.law)}:
                    values[port.temperature] = value_of(port.law, values)
            points.append(values)
    except (ArithmeticError, ValueError):
        return ()
    return tuple(points)
