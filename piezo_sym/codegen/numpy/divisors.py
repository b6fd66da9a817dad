"""The parameters that a NumPy function needs as NumPy's numbers.

Input: the trees of a function, its quantities, the names of parameters.  Output: names.  `np.where`
computes both sides of a choice, and Python's own floats raise an error where they divide by zero;
NumPy's give inf, as C does.  What is positive by its form divides without error.
"""

from collections.abc import Collection, Iterable

from piezo_sym.codegen.program import Quantity
from piezo_sym.expressions.tidying import sign_of
from piezo_sym.expressions.tree import Div, Expr, If, Node, Pow, Sym, names, walk


def divisors(
    roots: Iterable[Node],
    quantities: Iterable[Quantity],
    parameters: Collection[str],
    positive: Collection[str],
) -> frozenset[str]:
    """Return the parameters by which choices divide other parameters, or of which they take roots.

    `parameters` are names of Python's floats; quantities made of them alone are floats, too.  Those
    in `positive` are so in the domain; b - r of two such may be zero.
    """
    values, floats, above = {q.name: q.value for q in quantities}, {*parameters}, {*positive}
    for name, value in values.items():
        floats |= {name} if {*names(value)} <= floats else set()
        above |= {name} if sign_of(value, above) == 1 else set()
    trees = [*roots, *values.values()]
    left: list[Node] = [n for tree in trees for n in walk(tree) if isinstance(n, If)]
    seen, found = set[str](), set[str]()
    while left:
        for part in walk(left.pop()):
            if isinstance(part, Sym) and part.name in values.keys() - seen:
                seen.add(part.name)
                left.append(values[part.name])
            below = _below(part)
            if below and {*names(part)} <= floats and sign_of(below, above) != 1:
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
