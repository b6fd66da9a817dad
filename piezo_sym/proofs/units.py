"""The row ``units``: every law, input, condition and initial value has the unit that is needed.

Input: an `IPHS`, for its spec.  Output: one row PROVED, or a row REFUTED for each fault.  The
junction laws add like quantities only, so the equations have the right units if each law has.

A fault is a linear equation between the dimensions of names that does not hold.  The remedy is
found by solving it for the unit of one parameter, with which all faults vanish, or at least this
fault without a new one.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import islice
from typing import final

from piezo_sym.errors import quote, with_article
from piezo_sym.expressions.dimensions import (
    NONE,
    Dimension,
    Match,
    dimension,
    faults,
    times,
)
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import (
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    Mul,
    Neg,
    Node,
    Num,
    Sym,
    names,
    replaced,
    walk,
)
from piezo_sym.expressions.units import parse_unit
from piezo_sym.iphs import IPHS
from piezo_sym.report import Row, Verdict
from piezo_sym.spec.elements import with_ratio_in
from piezo_sym.spec.model import Model
from piezo_sym.spec.origins import Origins
from piezo_sym.spec.places import Place, places
from piezo_sym.spec.rename import Renaming
from piezo_sym.spec.tables import condition_text
from piezo_sym.spec.unit_text import quantity, unit_text

STATEMENT = "every term of every equation has its row's unit"
MOST_TERM = 60
MOST_CANDIDATES = 3
#: The most rewritten forms of a law that are tried.
MOST_RESPELLED = 100


@final
@dataclass(frozen=True)
class Check:
    """A rule on units, with its place."""

    place: Place
    rule: Match
    origins: Origins

    @cached_property
    def gap(self) -> Dimension:
        """The unit missing on its left."""
        return self.rule.gap(self.place.words)

    @property
    def where(self) -> str:
        """The place of the rule in the spec, as the user wrote it."""
        return self.origins.written(self.place.where)

    def name(self, name: str) -> str:
        """Return a name as the user spelled it at this place."""
        return self.origins.name(self.place.where, name)

    def text(self, node: Node) -> str:
        """Return a term as the user spelled it at this place, shortened if it is long."""
        bare = node.arg if isinstance(node, Neg) else node
        text = condition_text(bare) if isinstance(bare, Cmp) else spell(bare)
        text = Renaming({name: self.name(name) for name in names(bare)}).text(text)
        return text if len(text) <= MOST_TERM else f"{text[: MOST_TERM - 3]}..."


def units(iphs: IPHS) -> Iterator[Row]:
    """Yield one row if every unit fits, else a row for each fault."""
    model = iphs.model
    known = tuple(places(model))
    checks = tuple(Check(p, rule, model.origins) for p in known for rule in p.rules())
    wrong = [Check(p, rule, model.origins) for p in known for rule in faults(p.rules(), p.words)]
    if not wrong:
        yield Row("units", "", STATEMENT, Verdict.PROVED)
    for fault in wrong:
        remedy = _remedy(fault, checks) + _other_kind(fault, model) + _other_field(fault, model)
        reason = f"{fault.where}: {_finding(fault, model)}; {remedy}"
        yield Row("units", fault.place.element, STATEMENT, Verdict.REFUTED, None, reason)


def _finding(fault: Check, model: Model) -> str:
    """Return the fault in words: the smallest wrong term, its unit, and the unit needed."""
    rule = fault.rule
    left = f"{fault.text(rule.left)} {_unit(rule.left, fault.place, model)}"
    if rule.right is not None:
        right = f"{fault.text(rule.right)} {_unit(rule.right, fault.place, model)}"
        return f"{left} and {right} in {fault.text(rule.node)}, equal units are needed"
    if not rule.whole:
        return f"{left} in {fault.text(rule.node)}, a number without unit is needed"
    return f"{left}, {quantity(rule.needed, fault.place.unit)} is needed"


def _other_kind(fault: Check, model: Model) -> str:
    """Return the hint at kinds of coupling that take a ratio of this unit."""
    found = dimension(fault.rule.left, fault.place.words)
    if not fault.rule.whole or not fault.place.element or found is None:
        return ""
    kinds = with_ratio_in(found, model.elements[fault.place.element])
    unit = _unit(fault.rule.left, fault.place, model).removeprefix("is ")
    return "".join(
        f"; {with_article(kind)} takes {unit}{second and f' on {second}'}" for kind, second in kinds
    )


def _other_field(fault: Check, model: Model) -> str:
    """Return a hint at the field for whole laws if the unit fits: k*q is no stiffness, k is."""
    place, found = fault.place, dimension(fault.rule.left, fault.place.words)
    if not fault.rule.whole or not place.element:
        return ""
    element, own = model.elements[place.element], place.where.rpartition(".")[2]
    if any(isinstance(node, If) for node in walk(fault.rule.left)):
        return _as_contact(fault, own)  # a stiffness that jumps is refused, too
    marks = {f: mark for f, mark in element.law_fields() if f in element.form.one_of}
    for field, mark in marks.items():
        alike = own in marks and mark.units == marks[own].units
        if alike and parse_unit(mark.unit).dimension == found:
            words, law = field.replace("_", " "), fault.text(fault.rule.left)
            return f'; or is it the {words} itself? then {field} = "{law}" instead of {own}'
    return ""


def _as_contact(fault: Check, own: str) -> str:
    """Return a hint at k*max(q - g, 0) for `k if q > g else 0`, if its unit fits."""
    match fault.rule.left:
        case If(k, Cmp(">" | ">=", q, g), other) if other == ZERO:
            law = Mul(k, Call("max", (Add((q, Neg(g))), ZERO)))
            if not faults(replace(fault.place, tree=law).rules(), fault.place.words):
                return f'; or is it a contact? then {own} = "{fault.text(law)}"'
    return ""


def _unit(term: Expr, place: Place, model: Model) -> str:
    """Return the unit of a term as "is A/K", of a parameter or input as the spec spells it."""
    found = dimension(term, place.words)
    if found is None or found == NONE:
        return "has no unit"
    name = term.name if isinstance(term, Sym) and term.name not in place.fixed else ""
    entry = model.parameters.get(name) or model.inputs.get(name)
    return f"is {entry.dimension.si if entry else unit_text(found)}"


def _remedy(fault: Check, checks: tuple[Check, ...]) -> str:
    """Return what to change: the unit of a parameter, a number, an input, or the law."""
    suspects = [name for name in fault.place.given if _power(name, fault)]
    fits = {name: _fitting(name, checks) for name in suspects}
    if not any(fits.values()):  # several names are wrong: consider only the rules with each name
        own = {name: [c for c in checks if _power(name, c)] for name in suspects}
        fits = {name: _fitting(name, own[name]) for name in suspects}
    place, needed = fault.place, fault.rule.needed
    spelled = {needed: place.unit} if fault.rule.whole and place.unit else {}
    texts = {name: spelled.get(fit) or unit_text(fit) for name, fit in fits.items() if fit}
    offers = [f"{fault.name(name)}: {text} would fit" for name, text in texts.items()]
    if offers:
        return f"check the unit of {', or of '.join(offers[:MOST_CANDIDATES])}"
    return _other_remedy(fault, checks)


def _power(name: str, check: Check) -> Fraction:
    return Fraction(0) if name in check.place.fixed else check.rule.excess.get(name, Fraction(0))


def _fitting(name: str, checks: Iterable[Check]) -> Dimension | None:
    """Return the unit of `name` with which every check holds, or None if there is none."""
    fits = set()
    for check in checks:
        if power := _power(name, check):
            fits.add(times(check.place.given[name], check.gap, 1 / power))
        elif check.gap != NONE:
            return None
    return fits.pop() if len(fits) == 1 else None


def _other_remedy(fault: Check, checks: tuple[Check, ...]) -> str:
    """Return what to change if no change of a single parameter's unit removes the fault."""
    rule, words = fault.rule, fault.place.words
    if regrouped := _regrouped(fault):
        return regrouped
    for part, other in ((rule.right, rule.left), (rule.left, rule.right)):
        if part is not None and not names(part):
            unit = rule.needed if other is None else dimension(other, words)
            if unit and (factor := _factor(other)):
                part, unit = factor, times(NONE, unit, -1)
            return f"make {fault.text(part)} a parameter in {unit_text(unit or NONE)}"
    if isinstance(fault.place.tree, Sym) and fault.place.tree.name in fault.place.given:
        return _own_input(fault, fault.place.tree.name, checks)
    if rule.whole:
        more = _numbers(fault, rule.left)
        return f"multiply {fault.text(rule.left)} by {quantity(fault.gap)}{more}"
    part, size = rule.right or rule.left, times(NONE, fault.gap, -1)
    verb = "divide" if rule.right is None else "multiply"
    return f"{verb} {fault.text(part)} by {quantity(size)}{_numbers(fault, part)}"


def _regrouped(fault: Check) -> str:
    """Return the advice to regroup a sum, or to divide, if all units fit then, or ''."""
    place, tree = fault.place, fault.place.tree
    if isinstance(tree, Cmp):
        return ""
    for old, new in islice(_respelled(tree), MOST_RESPELLED):
        law = replace(place, tree=replaced(tree, {old: new}))
        if len(spell(new)) <= MOST_TERM and not faults(law.rules(), place.words):
            return f"write {fault.text(new)} for {fault.text(old)}"
    return ""


def _respelled(tree: Expr) -> Iterator[tuple[Expr, Expr]]:
    """Yield (part of a law, what may be meant): a*(b + c) for a*b + c, a/b or b/a for a*b."""
    for node in walk(tree):
        match node:
            case Add(terms):
                for n, term in enumerate(terms[:-1]):
                    if isinstance(term, Mul):
                        inner = Mul(term.left, Add((term.right, *terms[n + 1 :])))
                        yield node, Add((*terms[:n], inner)) if n else inner
            case Mul(left, right):
                yield node, Div(left, right)
                yield node, Div(right, left)


def _factor(term: Expr | None) -> Num | None:
    """Return a numeric factor of a term, or None."""
    match term:
        case Num():
            return term
        case Neg(arg):
            return _factor(arg)
        case Mul(left, right):
            return _factor(left) or _factor(right)
    return None


def _own_input(fault: Check, name: str, checks: tuple[Check, ...]) -> str:
    """Return the remedy for an input, or a law that is one parameter, used with several units."""
    others = [
        check.where
        for check in checks
        if check.place.tree == fault.place.tree and check.rule.needed != fault.rule.needed
    ]
    wanted = f"one in {unit_text(fault.rule.needed)} of its own here"
    own = fault.name(name)
    used = f"{own} is used in {', '.join(others)} with another unit; " if others else ""
    if spec := fault.origins.spec(fault.place.where):
        table = "inputs" if f"inputs.{name}" in fault.origins.rows else "parameters"
        wanted += f", declared in [{table}] of {quote(spec)}"
    return f"{used}give {wanted}"


def _numbers(fault: Check, term: Expr) -> str:
    """Return the reminder, for a term with numbers, that these have no unit."""
    found = next((node for node in walk(term) if isinstance(node, Num) and node.value), None)
    return f", or make {fault.text(found)} a parameter with its unit" if found else ""
