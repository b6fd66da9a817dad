"""A law with parameters, reduced to a function of one real variable.

Input: a law, its letter, and the names that are positive.  Output: a `Reduction`, or None.  The
letter is measured in units of positive parameters, i = i_1*s; the law is written as a product in
which all that does not depend on s stands in front: ``R*i + R*i_1*sin(i/i_1)`` is
``R*i_1*(s + sin(s))``.  Both agree wherever the law is defined.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from piezo_sym.spec.calculus import power
from piezo_sym.spec.expressions import (
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
    Num,
    Pow,
    Sym,
    names,
    rebuild,
    walk,
)

#: Functions with f(c z, c w) = c f(z, w) for every c > 0.
HOMOGENEOUS = ("abs", "min", "max", "deadzone", "saturate")

#: A product of powers: base -> exponent, none of them zero.
Powers = Mapping[Expr, Fraction]


@final
@dataclass(frozen=True, slots=True)
class Reduction:
    """``law = product of prefactors * f(s)``, with ``letter = scale*s``.

    Attributes
    ----------
    prefactors : factors free of the letter; their signs are not looked at here.
    f : the rest, a tree whose only name is `name`.
    name : the letter, which stands for s in `f`.
    units : the positive names, and their powers, whose product is the scale.
    """

    prefactors: tuple[Expr, ...]
    f: Expr
    name: str
    units: tuple[tuple[str, int], ...]

    @property
    def scale(self) -> Expr:
        """The positive factor from s to the letter, as a tree."""
        return _product({Sym(name): Fraction(e) for name, e in self.units})

    def back(self, value: Fraction, values: Mapping[str, Fraction]) -> Fraction:
        """Return the letter's value for a value of s and of the parameters."""
        for name, exponent in self.units:
            value *= values[name] ** exponent
        return value


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
    """What the letter is called, what it is measured in, and which names are positive."""

    letter: str
    scale: Powers
    positive: frozenset[str]

    def is_positive(self, powers: Powers) -> bool:
        """Return whether a product of powers is positive because each base is."""
        return all(isinstance(base, Sym) and base.name in self.positive for base in powers)


def reduce(law: Expr, letter: str, positive: frozenset[str]) -> Reduction | None:
    """Return a law as prefactors times a function of its letter alone, if it can be so written.

    Parameters
    ----------
    law : a tree.
    letter : the variable, which may take every real value.
    positive : parameters, and a temperature, that are positive.
    """
    for scale in _scales(law, letter, positive - {letter}):
        found = _factored(law, Setting(letter, scale, positive - {letter}))
        if set(names(found.bound)) <= {letter}:
            f = _tree(Product(found.number, {}, found.bound))
            prefactors = tuple(power(base, e) for base, e in found.free.items())
            units = tuple((names(base)[0], int(e)) for base, e in scale.items())
            return Reduction(prefactors, f, letter, units)
    return None


def _scales(law: Expr, letter: str, positive: frozenset[str]) -> Iterator[Powers]:
    """Yield what the letter may be measured in: nothing, what it is divided by, one parameter."""
    yield {}
    plain = Setting(letter, {}, positive)
    for node in walk(law):
        for arg in node.args if isinstance(node, Call) else ():
            found = _factored(arg, plain)
            whole = all(e.denominator == 1 for e in found.free.values())
            if found.bound == Sym(letter) and whole and plain.is_positive(found.free):
                yield {base: -e for base, e in found.free.items()}
    for name in names(law):
        if name in positive:
            yield {Sym(name): Fraction(1)}


def _factored(node: Expr, setting: Setting) -> Product:
    """Return a tree as a product."""

    def of(part: Expr) -> Product:
        return _factored(part, setting)

    match node:
        case Num(value):
            return Product(value, {})
        case Sym(name) if name == setting.letter:
            return Product(Fraction(1), setting.scale, node)
        case Neg(arg):
            return _times(Product(Fraction(-1), {}), of(arg))
        case Mul(left, right):
            return _times(of(left), of(right))
        case Div(left, right) if (below := of(right)).number:
            return _times(of(left), _raised(below, Fraction(-1), setting))
        case Pow(base, exponent) if (inner := of(base)).number:
            return _raised(inner, exponent, setting)
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
    """Return a**e; (x y)^e = x^e y^e for whole e, else only if x > 0."""
    if exponent.denominator == 1:
        free = {base: e * exponent for base, e in a.free.items() if exponent}
        bound = ONE if a.bound == ONE else power(a.bound, exponent)
        return Product(a.number**exponent.numerator, free, bound)
    outside = {base: e for base, e in a.free.items() if setting.is_positive({base: e})}
    inside = {base: e for base, e in a.free.items() if base not in outside}
    free = {base: e * exponent for base, e in outside.items()}
    root = Pow(_tree(Product(a.number, inside, a.bound)), exponent)
    if setting.letter in names(root):
        return Product(Fraction(1), free, root)
    whole = root == Pow(ONE, exponent)
    return Product(Fraction(1), free if whole else _joined(free, {root: Fraction(1)}))


def _sum(terms: list[Product]) -> Product:
    """Return a sum, what is free of the letter taken out if all terms share it."""
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
    """Return a function of products, positive factors taken out where the function lets them."""
    if function == "sqrt" and args[0].number:
        return _raised(args[0], Fraction(1, 2), setting)
    if function in HOMOGENEOUS or function == "sign":
        free, parts = _shared(args, setting, positive=True)
        outside = {} if function == "sign" else free
        return Product(Fraction(1), outside, Call(function, parts))
    return Product(Fraction(1), {}, Call(function, tuple(_tree(arg) for arg in args)))


def _shared(
    parts: list[Product], setting: Setting, *, positive: bool
) -> tuple[Powers, tuple[Expr, ...]]:
    """Return the powers that all parts other than zero share, and the parts without them."""
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
    if a.number == 1:
        return tree
    return Neg(tree) if a.number == -1 else Mul(Num(a.number), tree)


def _product(powers: Powers) -> Expr:
    tree: Expr = ONE
    for base, exponent in powers.items():
        factor = power(base, exponent)
        tree = factor if tree == ONE else Mul(tree, factor)
    return tree
