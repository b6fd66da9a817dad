"""Sums, products and derivatives of laws, as short trees.

Input: trees, and a name to differentiate by.  Output: a tree.  Used for the generated Jacobians and
for the rules in the records of functions.  Constants are folded as exact rationals, so that
generated text does not depend on the version of SymPy.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from itertools import pairwise

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.grammar import parse_clause, parse_rule
from piezo_sym.expressions.tree import (
    ONE,
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    LaneSum,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    knots,
    names,
    rebuild,
    walk,
)


def add(*terms: Expr) -> Expr:
    """Return the sum of `terms`, zeros left out and sums flattened."""
    flat: list[Expr] = []
    for term in terms:
        flat.extend(term.terms if isinstance(term, Add) else (term,))
    kept = _folded([term for term in flat if term != ZERO])
    if not kept:
        return ZERO
    return kept[0] if len(kept) == 1 else Add(tuple(kept))


def _folded(terms: list[Expr]) -> list[Expr]:
    """Return terms with numbers added up and pairs of a term and its negative left out."""
    kept: dict[int, Expr] = {}
    places: dict[Expr, list[int]] = {}
    number, total = -1, Fraction(0)
    for n, term in enumerate(terms):
        if isinstance(term, Num):
            number, total = n if number < 0 else number, total + term.value
            kept[number] = Num(total)
        elif twins := places.get(neg(term)):
            del kept[twins.pop(0)]
        else:
            kept[n] = term
            places.setdefault(term, []).append(n)
    return [term for term in kept.values() if term != ZERO]


def neg(arg: Expr) -> Expr:
    """Return minus `arg`."""
    match arg:
        case Num(value):
            return Num(-value)
        case Neg(inner):
            return inner
        case If(then, condition, other):
            return If(neg(then), condition, neg(other))
    return Neg(arg)


def mul(left: Expr, right: Expr) -> Expr:
    """Return a product: numbers in front, signs outside, factors inside a choice of constants."""
    match left, right:
        case (_, Num(value)):
            return _scaled(value, left)
        case (Num(value), _):
            return _scaled(value, right)
        case (Neg(arg), _):
            return neg(mul(arg, right))
        case (_, Neg(arg)):
            return neg(mul(left, arg))
        case (If(then, condition, other), _) if _indicator(left):
            return If(mul(then, right), condition, mul(other, right))
        case (_, If(then, condition, other)) if _indicator(right):
            return If(mul(left, then), condition, mul(left, other))
        case (_, Div(top, bottom)):
            product = mul(left, top)
            return Div(product, bottom) if isinstance(bottom, Num) else div(product, bottom)
        case (Div(Num(), bottom), _):
            return div(mul(left.left, right), bottom)
        case (Mul(Num(value), inner), _):
            return _scaled(value, mul(inner, right))
        case (_, Mul(Num(value), inner)):
            return _scaled(value, mul(left, inner))
        case (_, Mul(first, second)):
            return mul(mul(left, first), second)
    return Mul(left, right)


def _indicator(node: Expr) -> bool:
    """Return whether `node` is a choice of constants, which a factor can enter."""
    return isinstance(node, If) and all(
        isinstance(part, Num) or _indicator(part) for part in (node.then, node.other)
    )


def _scaled(factor: Fraction, arg: Expr) -> Expr:
    if factor == 0:
        return ZERO
    if factor == 1:
        return arg
    match arg:
        case Num(value):
            return Num(factor * value)
        case Neg(inner):
            return neg(_scaled(factor, inner))
        case Mul(Num(value), rest):
            return _scaled(factor * value, rest)
        case Div(top, Num(value)):
            return _scaled(factor / value, top)
        case Div(top, Mul(Num(value), rest)):
            return div(_scaled(factor / value, top), rest)
    return neg(_scaled(-factor, arg)) if factor < 0 else Mul(Num(factor), arg)


def div(top: Expr, bottom: Expr) -> Expr:
    """Return a quotient: signs outside, numbers folded, a quotient of a quotient as one."""
    match top, bottom:
        case (Num(value), _) if value == 0:
            return ZERO
        case (_, Num(value)):
            return _scaled(1 / value, top)
        case (Neg(arg), _):
            return neg(div(arg, bottom))
        case (_, Neg(arg)):
            return neg(div(top, arg))
        case (Mul(Num(a), above), Mul(Num(b), below)):
            return _scaled(a / b, div(above, below))
        case (Div(above, below), _) if below == bottom:
            return Div(above, Pow(bottom, Fraction(2)))
        case (If(then, condition, other), _) if _indicator(top):
            return If(div(then, bottom), condition, div(other, bottom))
    return ONE if top == bottom else Div(top, bottom)


def power(base: Expr, exponent: Fraction) -> Expr:
    """Return a power; exponents 0 and 1 vanish, and so does a power of zero."""
    if exponent == 0:
        return ONE
    if base == ZERO and exponent > 0:
        return ZERO
    return base if exponent == 1 else Pow(base, exponent)


def derivative(node: Expr, name: str) -> Expr:
    """Return the derivative of `node` by the name `name`; at a kink, that of one of its sides."""
    if name not in names(node):
        return ZERO
    match node:
        case Sym():
            return ONE
        case Neg(arg):
            return neg(derivative(arg, name))
        case Add(terms):
            return add(*(derivative(term, name) for term in terms))
        case Mul(left, right):
            return add(mul(derivative(left, name), right), mul(left, derivative(right, name)))
        case Div(left, right):
            fall = div(mul(left, derivative(right, name)), power(right, Fraction(2)))
            return add(div(derivative(left, name), right), neg(fall))
        case Pow(base, exponent):
            outer = mul(Num(exponent), power(base, exponent - 1))
            return mul(outer, derivative(base, name))
        case Call() if knots(node):
            return derivative(choices(node), name)
        case Call(function, args):
            slopes = (rule(text, args[0], args[-1], node) for text in RECORDS[function].slopes)
            return add(*(mul(s, derivative(x, name)) for s, x in zip(slopes, args, strict=True)))
        case If(then, condition, other):
            one, two = derivative(then, name), derivative(other, name)
            return one if one == two else If(one, condition, two)
        case LaneSum(arg, bank):
            return LaneSum(derivative(arg, name), bank)
    return ZERO


def rule(text: str, x: Expr, w: Expr = ZERO, value: Expr = ZERO) -> Expr:
    """Return the tree of a rule in a function's record, with arguments and value inserted."""
    return inserted(parse_rule(text), {"x": x, "w": w, "y": value})


def clause(text: str, x: Expr, value: Expr) -> tuple[Cmp, ...]:
    """Return the comparisons of a fact in a function's record, with argument and value inserted."""
    words = {"x": x, "y": value}
    parts = parse_clause(text)
    return tuple(Cmp(c.op, inserted(c.left, words), inserted(c.right, words)) for c in parts)


def choices(node: Expr) -> Expr:
    """Return a call of a function with kinks as choices, for widths >= 0; other trees unchanged."""
    if isinstance(node, Call) and (pairs := knots(node)):
        return _pieces(node.args[0], pairs)
    if isinstance(node, Call) and node.function in RECORDS and RECORDS[node.function].choices:
        return rule(RECORDS[node.function].choices, node.args[0], node.args[-1])
    return node


def _pieces(x: Expr, pairs: tuple[tuple[Expr, Expr], ...]) -> Expr:
    """Return a table as choices by bisection: six comparisons lead to each piece of 64 knots."""
    if len(pairs) > 2:
        n = len(pairs) // 2
        return If(_pieces(x, pairs[: n + 1]), Cmp("<", x, pairs[n][0]), _pieces(x, pairs[n:]))
    (a, y), (b, z) = (tuple(map(_number, pair)) for pair in pairs)
    slope = div(add(z, neg(y)), add(b, neg(a)))
    if (b, z) == (ZERO, ZERO):  # through the origin: rounding must not give the wrong sign there
        return mul(slope, x)
    return add(y, mul(slope, add(x, neg(a))))


def increasing(node: Node) -> Iterator[Cmp]:
    """Yield the conditions that knots of tables increase, except for numbers that do."""
    for part in walk(node):
        for (a, _), (b, _) in pairwise(knots(part)):
            match _number(a), _number(b):
                case Num(low), Num(high) if low < high:
                    continue
            yield Cmp("<", a, b)


def _number(node: Expr) -> Expr:
    """Return minus a number as one number; other trees unchanged."""
    return neg(node.arg) if isinstance(node, Neg) and isinstance(node.arg, Num) else node


def kinks(node: Expr) -> Iterator[Cmp]:
    """Yield the comparisons that choose the branches of a function with kinks."""
    yield from (part.condition for part in walk(choices(node)) if isinstance(part, If))


def inserted(node: Expr, words: Mapping[str, Expr]) -> Expr:
    """Return a tree with names replaced, its sums and products simplified as here."""
    if isinstance(node, Sym):
        return words.get(node.name, node)
    return rebuilt(node, lambda part: inserted(part, words))


def rebuilt(node: Expr, change: Callable[[Expr], Expr]) -> Expr:
    """Return `node` with `change` applied to its parts, its own operation simplified as here."""
    match node:
        case Neg(arg):
            return neg(change(arg))
        case Add(terms):
            return add(*map(change, terms))
        case Mul(left, right):
            return mul(change(left), change(right))
        case Div(left, right):
            return div(change(left), change(right))
        case Pow(base, exponent):
            return power(change(base), exponent)
    return rebuild(node, change)


def compared(node: Expr) -> Expr:
    """Return an expression in which all kinks are choices by comparisons."""
    return choices(rebuild(node, compared))


def is_affine(law: Expr, variables: Iterable[str]) -> bool:
    """Return whether a law is jointly affine in some variables."""
    used = {*variables} & {*names(law)}
    return all(used.isdisjoint(names(derivative(law, name))) for name in used)
