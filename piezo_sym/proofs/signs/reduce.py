"""A law with parameters, reduced to a function of one real variable.

Input: a law, its letter, and a test of positivity.  Output: `Reduction` records.  The letter is
measured in units of positive parameters, i = i_1*s, and the law is written as prefactors times a
function of s alone: ``R*i + R*i_1*sin(i/i_1)`` is ``R*i_1*(s + sin(s))``.  A factor that depends on
s and on other parameters is a prefactor, too.  Both forms agree wherever the law is defined.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from piezo_sym.expressions.calculus import power
from piezo_sym.expressions.exact_eval import value_of
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
    ONE,
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
    Pow,
    Sym,
    names,
    rebuild,
    walk,
)

#: Whether a tree is known to be positive.
Positive = Callable[[Expr], bool]
#: A product of powers: base -> exponent, none of them zero.
Powers = Mapping[Expr, Fraction]


@final
@dataclass(frozen=True, slots=True)
class Reduction:
    """``law = product of prefactors * f(s)``, with ``letter = scale*s``."""

    prefactors: tuple[Expr, ...]  # the other factors, of any sign
    f: Expr  # a tree whose only name is `name`
    name: str  # the letter, which stands for s in `f`
    units: tuple[tuple[Expr, Fraction], ...]  # (positive base, power); their product is the scale

    @property
    def scale(self) -> Expr:
        """The positive factor from s to the letter, as a tree."""
        return _product(dict(self.units))

    def back(self, value: Fraction, values: Mapping[str, Fraction]) -> Fraction | None:
        """Return the letter for values of s and of the parameters; None if it is not rational."""
        try:
            size = value_of(self.scale, values)
        except (ArithmeticError, ValueError, KeyError):
            return None
        return value * size if isinstance(size, Fraction) else None


@final
@dataclass(frozen=True, slots=True)
class Product:
    """``number * free * bound``: a rational, powers without the letter, a tree with it (or 1)."""

    number: Fraction
    free: Powers
    bound: Expr = ONE


@final
@dataclass(frozen=True, slots=True)
class Setting:
    """The letter's name, its unit as a product of powers, and the test of positivity."""

    letter: str
    scale: Powers
    positive: Positive

    def is_positive(self, powers: Powers) -> bool:
        """Return whether each base of a product of powers is positive."""
        return all(map(self.positive, powers))


def reductions(law: Expr, letter: str, positive: Positive) -> list[Reduction]:
    """Return the reductions of a law to its letter alone, fewest prefactors with the letter first.

    The letter may take every real value; `positive` decides for trees without it.
    """
    plain, divided, single = settings(law, letter, positive)
    tried = [_reduction(law, setting) for setting in (plain, *divided, *single)]
    found = {reduction: outside for reduction, outside in tried if reduction}
    return sorted(found, key=lambda reduction: found[reduction])


def _reduction(law: Expr, setting: Setting) -> tuple[Reduction | None, int]:
    """Return the reduction in one unit of the letter, and the number of factors outside it."""
    inside = Product(Fraction(1), {})
    front, outside = list[Expr](), list[Expr]()
    for factor in _factors(law):
        if names(factor) and setting.letter not in names(factor):
            front.append(factor)
            continue
        part = factored(factor, setting)
        if {*names(part.bound)} <= {setting.letter}:
            inside = _times(inside, part)
        else:
            outside.append(factor)
    f = _tree(Product(inside.number, {}, inside.bound))
    if outside and setting.letter not in names(f):
        return None, 0
    free = (power(base, e) for base, e in inside.free.items())
    prefactors = (*front, *free, *outside)
    units = tuple(setting.scale.items())
    return Reduction(prefactors, f, setting.letter, units), len(outside)


def _factors(node: Expr) -> Iterator[Expr]:
    """Yield the factors of a product, divisors as powers."""
    match node:
        case Neg(arg):
            yield Num(Fraction(-1))
            yield from _factors(arg)
        case Mul(left, right):
            yield from _factors(left)
            yield from _factors(right)
        case Div(left, right) if right != ZERO:
            yield from _factors(left)
            yield from (Pow(part, Fraction(-1)) for part in _factors(right))
        case _:
            yield node


def settings(
    law: Expr, letter: str, positive: Positive
) -> tuple[Setting, list[Setting], list[Setting]]:
    """Return the units to try for the letter: 1, its divisors in arguments, each parameter."""
    plain = Setting(letter, {}, positive)
    divided: list[Powers] = []
    for arg in (arg for node in walk(law) for arg in _arguments(node)):
        found = factored(arg, plain)
        if found.bound == Sym(letter) and found.free and plain.is_positive(found.free):
            scale = {base: -e for base, e in found.free.items()}
            divided += [scale] if scale not in divided else []
    free = (Sym(name) for name in names(law) if name != letter)
    single = [Setting(letter, {name: Fraction(1)}, positive) for name in free if positive(name)]
    return plain, [Setting(letter, scale, positive) for scale in divided], single


def _arguments(node: Node) -> tuple[Expr, ...]:
    match node:
        case Call(_, args):
            return args
        case Pow(part, _) | (Div() as part):
            return (part,)
    return ()


def factored(node: Expr, setting: Setting) -> Product:
    """Return a tree as a product."""

    def of(part: Expr) -> Product:
        return factored(part, setting)

    match node:
        case Num(value):
            return Product(value, {})
        case Sym(name) if name == setting.letter:
            return Product(Fraction(1), setting.scale, node)
        case Sym() if setting.positive(Neg(node)):
            return Product(Fraction(-1), {Neg(node): Fraction(1)})
        case Neg(arg):
            return _times(Product(Fraction(-1), {}), of(arg))
        case Mul(left, right):
            return _times(of(left), of(right))
        case Div(left, right) if (below := of(right)).number:
            return _times(of(left), _raised(below, Fraction(-1), setting))
        case Pow(base, exponent) if (inner := of(base)).number:
            return _raised(inner, exponent, setting)
    if not names(node):
        return Product(Fraction(1), {}, node)
    if setting.letter not in names(node):
        return Product(Fraction(1), {node: Fraction(1)})
    match node:
        case Add(terms):
            return _sum([of(term) for term in terms])
        case Call(function, args):
            return _call(function, [of(arg) for arg in args], setting)
        case If(then, Cmp(op, left, right), other):
            _, sides = _shared([of(left), of(right)], setting, positive=True)
            free, (first, second) = _shared([of(then), of(other)], setting, positive=False)
            return Product(Fraction(1), free, If(first, Cmp(op, *sides), second))
    return Product(Fraction(1), {}, rebuild(node, lambda part: _tree(of(part))))


def _times(a: Product, b: Product) -> Product:
    if a.bound == ONE or b.bound == ONE:
        bound = b.bound if a.bound == ONE else a.bound
    elif isinstance(b.bound, Pow) and b.bound.exponent == -1:
        bound = Div(a.bound, b.bound.base)
    else:
        bound = Mul(a.bound, b.bound)
    return Product(a.number * b.number, _joined(a.free, b.free), bound)


def _joined(a: Powers, b: Powers) -> Powers:
    exponents = {base: a.get(base, Fraction(0)) + b.get(base, Fraction(0)) for base in {**a, **b}}
    return {base: exponent for base, exponent in exponents.items() if exponent}


def _raised(a: Product, exponent: Fraction, setting: Setting) -> Product:
    """Return a**e; (x y)^e = x^e y^e for integer e, else only if x > 0."""
    if exponent.denominator == 1:
        free = {base: e * exponent for base, e in a.free.items() if exponent}
        bound = ONE if a.bound == ONE else power(a.bound, exponent)
        return Product(a.number**exponent.numerator, free, bound)
    outside = {base: e for base, e in a.free.items() if setting.is_positive({base: e})}
    inside = {base: e for base, e in a.free.items() if base not in outside}
    free = {base: e * exponent for base, e in outside.items()}
    root = Pow(_tree(Product(a.number, inside, a.bound)), exponent)
    if setting.letter in names(root) or not names(root):
        return Product(Fraction(1), free, ONE if root == Pow(ONE, exponent) else root)
    return Product(Fraction(1), _joined(free, {root: Fraction(1)}))


def _sum(terms: list[Product]) -> Product:
    """Return a sum, with its powers free of the letter in front if all terms share them."""
    terms = [term for term in terms if term.number]
    if not terms:
        return Product(Fraction(0), {})
    first = terms[0]
    if all(term.free == first.free for term in terms):
        parts = tuple(_tree(Product(term.number, {}, term.bound)) for term in terms)
        return Product(Fraction(1), first.free, parts[0] if len(parts) == 1 else Add(parts))
    if all(term.bound == first.bound for term in terms):
        total = Add(tuple(_tree(Product(term.number, term.free)) for term in terms))
        return Product(Fraction(1), {total: Fraction(1)}, first.bound)
    return Product(Fraction(1), {}, Add(tuple(_tree(term) for term in terms)))


def _call(function: str, args: list[Product], setting: Setting) -> Product:
    """Return a function of products, with positive factors in front if it is homogeneous."""
    record = RECORDS[function]
    if record.power is not None and args[0].number:
        return _raised(args[0], record.power, setting)
    if record.degree is not None:
        free, parts = _shared(args, setting, positive=True)
        outside = free if record.degree else {}
        return Product(Fraction(1), outside, Call(function, parts))
    return Product(Fraction(1), {}, Call(function, tuple(_tree(arg) for arg in args)))


def _shared(
    parts: list[Product], setting: Setting, *, positive: bool
) -> tuple[Powers, tuple[Expr, ...]]:
    """Return the powers that all nonzero parts share, and the parts without them."""
    others = [part.free for part in parts if part.number]
    free = others[0] if others else {}
    if any(other != free for other in others) or (positive and not setting.is_positive(free)):
        return {}, tuple(_tree(part) for part in parts)
    return free, tuple(_tree(Product(part.number, {}, part.bound)) for part in parts)


def _tree(a: Product) -> Expr:
    """Return a product as a tree."""
    if a.number == 0:
        return ZERO
    factors = [part for part in (_product(a.free), a.bound) if part != ONE]
    if not factors:
        return Num(a.number)
    tree = factors[0] if len(factors) == 1 else Mul(*factors)
    signed = Neg(tree) if a.number == -1 else Mul(Num(a.number), tree)
    return tree if a.number == 1 else signed


def _product(powers: Powers) -> Expr:
    tree: Expr = ONE
    for base, exponent in powers.items():
        factor = power(base, exponent)
        tree = factor if tree == ONE else Mul(tree, factor)
    return tree
