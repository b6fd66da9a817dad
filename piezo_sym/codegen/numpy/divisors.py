"""The parameters that a NumPy function needs as NumPy's numbers.

Input: the trees of a function, its quantities, the names of parameters.  Output: names.  `np.where`
computes both sides of a choice, and Python's own floats raise an error where they divide by zero;
NumPy's give inf, as C does.  What is positive by its form divides without error.
"""

from collections.abc import Collection, Iterable, Mapping

from piezo_sym.codegen.program import Quantity
from piezo_sym.expressions.tree import Add, Div, Expr, If, Mul, Node, Num, Pow, Sym, names, walk


def divisors(
    roots: Iterable[Node],
    quantities: Iterable[Quantity],
    parameters: Collection[str],
    positive: Collection[str],
) -> frozenset[str]:
    """Return the parameters by which choices divide other parameters, or of which they take roots.

    Parameters
    ----------
    roots, quantities : the trees of one function, the quantities in order.
    parameters : names of Python's floats; quantities made of them alone are floats, too.
    positive : those that are positive in the domain; b - r of two such may be zero.
    """
    values, floats = {q.name: q.value for q in quantities}, {*parameters}
    for name, value in values.items():
        floats |= {name} if {*names(value)} <= floats else set()
    trees = [*roots, *values.values()]
    left: list[Node] = [n for tree in trees for n in walk(tree) if isinstance(n, If)]
    seen, found = set[str](), set[str]()
    while left:
        for part in walk(left.pop()):
            if isinstance(part, Sym) and part.name in values.keys() - seen:
                seen.add(part.name)
                left.append(values[part.name])
            below = _below(part)
            if below and {*names(part)} <= floats and not _is_positive(below, positive, values):
                found.update(names(below))
    for name in reversed(values):
        found.update(names(values[name]) if name in found else ())
    return frozenset(found & {*parameters})


def _below(node: Node) -> Expr | None:
    """Return what a node divides by, or takes a root of."""
    match node:
        case Div(_, bottom):
            return bottom
        case Pow(base, exponent) if exponent < 0 or exponent.denominator != 1:
            return base
    return None


def _is_positive(node: Expr, positive: Collection[str], values: Mapping[str, Expr]) -> bool:
    """Return whether a tree has no part that may be zero or negative."""
    match node:
        case Num(value):
            return value > 0
        case Sym(name):
            known = name in values and _is_positive(values[name], positive, values)
            return known or name in positive
        case Add(parts):
            return all(_is_positive(part, positive, values) for part in parts)
        case Mul(left, right) | Div(left, right):
            return all(_is_positive(part, positive, values) for part in (left, right))
        case Pow(base, _):
            return _is_positive(base, positive, values)
    return False
