"""What a solver says of parameters in a domain, and simple numbers tried against a claim.

Input: a domain, the order of names in a witness, and a solver.  Output: whether claims follow, a
point of the domain, and numbers in the domain that break a claim.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import product
from typing import final

from piezo_sym.proofs.exactly import holds
from piezo_sym.proofs.obligations import Question
from piezo_sym.proofs.query import connected
from piezo_sym.proofs.solvers import Answer, Asks
from piezo_sym.spec.expressions import ONE, ZERO, Add, Call, Cmp, Expr, Neg, Num, Sym, names
from piezo_sym.spec.tables import greater

#: Values of a letter that are tried against a law, in this order.
TRIED = tuple(
    sign * size
    for size in map(Fraction, ("1", "2", "3", "1/2", "5", "4", "10", "1/10", "20", "100"))
    for sign in (1, -1)
)
#: Of these, how many are tried where a parameter is moved too; how (factor, summand) it is moved.
FEW = 8
MOVES = tuple((Fraction(a), Fraction(b)) for a, b in ((10, 0), (-1, 0), (1, 1), (1, -1)))
MOVES += ((Fraction(1, 10), Fraction(0)),)

NEVER = Cmp("<", ONE, ZERO)

Numbers = Mapping[str, Fraction]


@final
@dataclass(frozen=True)
class Asked:
    """What a solver says of parameters in a domain.

    Attributes
    ----------
    where : the domain.
    order : names, in the order in which a witness should be simple.
    solver : whom to ask.
    known : answers on what is positive.
    """

    where: tuple[Cmp, ...]
    order: tuple[str, ...]
    solver: Asks
    known: dict[Expr, bool] = field(default_factory=dict)

    def positive(self, part: Expr) -> bool:
        """Return whether a tree is shown to be positive."""
        if part not in self.known:
            self.known[part] = self._positive(part)
        return self.known[part]

    def _positive(self, part: Expr) -> bool:
        match part:
            case Num(value):
                return value > 0
            case Call("exp", _):
                return True
            case Neg(arg) if self.positive(arg):
                return False
            case Sym():
                if Cmp(">", part, ZERO) in map(greater, self.where):
                    return True
        return self.follows(Cmp(">", part, ZERO))

    def follows(self, claim: Cmp) -> bool:
        """Return whether a claim holds in all of the domain."""
        return all(answer.result == "unsat" for answer in self._answers(claim, claim))

    def empty(self) -> bool:
        """Return whether no point is in the domain."""
        made = Question("", self.order, self.where, NEVER, NEVER, whole=True)
        return self.solver.ask(made.query()).result == "unsat"

    def point(self, claim: Cmp, wanted: Iterable[str]) -> Numbers | None:
        """Return simple numbers in the domain at which a claim is false, or None."""
        about = {*wanted, *names(claim)}
        about |= {name for condition in connected(self.where, about) for name in names(condition)}
        named = tuple(Sym(name) for name in self.order if name in about)
        for answer in self._answers(claim, Cmp(">=", Add((ZERO, *named)), ZERO)):
            if answer.result == "sat":
                return {n: value for n, value in answer.model.items() if n in self.order}
        return None

    def _answers(self, claim: Cmp, original: Cmp) -> Iterator[Answer]:
        made = Question("", self.order, self.where, claim, original)
        return (self.solver.ask(part.query()) for part in made.smooth())

    def breaks(self, claim: Cmp, numbers: Numbers) -> bool:
        """Return whether numbers lie in the domain and break a claim, which is evaluated exactly.

        Conditions on other names have nothing to do with it.
        """
        try:
            inside = all(holds(c, numbers) for c in connected(self.where, names(claim)))
            return inside and not holds(claim, numbers)
        except (ArithmeticError, ValueError, KeyError):
            return False


def tried(claim: Cmp, letter: str, asked: Asked) -> Numbers | None:
    """Return the first simple numbers in the domain at which a claim is broken, or None."""
    placed = _placed(claim, letter, asked, asked.point(NEVER, names(claim)))
    return next((numbers for numbers in placed if asked.breaks(claim, numbers)), None)


def _placed(claim: Cmp, letter: str, asked: Asked, point: Numbers | None) -> Iterator[Numbers]:
    """Yield a point with values for the letter; where a state gives it, with that state's too."""
    if point is None:
        return
    if not _tied(letter, asked):
        yield from ({**point, letter: value} for value in TRIED)
        return
    for value in TRIED[:FEW]:
        where = (*asked.where, Cmp("=", Sym(letter), Num(value)))
        found = replace(asked, where=where, known={}).point(NEVER, names(claim))
        yield from () if found is None else (found,)


def _tied(letter: str, asked: Asked) -> bool:
    return any(c.op == "=" for c in connected(asked.where, {letter}))


def moved(claim: Cmp, letter: str, asked: Asked) -> Numbers | None:
    """Return simple numbers that break a claim, one parameter moved away from the simplest."""
    point = asked.point(NEVER, names(claim))
    if point is None or _tied(letter, asked):
        return None
    for name, (factor, step) in product(names(claim), MOVES):
        for value in TRIED[:FEW] if name != letter else ():
            numbers = {**point, name: point[name] * factor + step, letter: value}
            if asked.breaks(claim, numbers):
                return numbers
    return None
