"""Queries to solvers, and their text.

Input: comparisons of polynomials, which may have choices.  Output: a `Query`, and its text in
SMT-LIB 2, which z3 and cvc5 both read.  A query asserts the opposite of its claim: `unsat` proves
the claim.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from piezo_sym.expressions.tree import Add, Cmp, Expr, If, Mul, Neg, Num, Pow, Sym, names
from piezo_sym.proofs.rational import Clause

#: Prefix of each name of a model in a query: no word of SMT-LIB or of a solver begins with it.
MARK = "?"


@final
@dataclass(frozen=True)
class Query:
    """One question: whether the claim follows from what is given, for all real numbers."""

    label: str  # in words, such as ``V_hysteron*i >= 0 where i > i_0``
    variables: tuple[str, ...]  # names, in the order in which a witness should be simple
    given: tuple[Clause, ...]  # clauses; in each at least one comparison holds
    claim: Cmp  # the comparison that should follow
    #: Whether numbers that break the claim are wanted; they cost more than the answer.
    witness: bool = False

    def text(self) -> str:
        """Return the query in SMT-LIB 2, without ``check-sat``."""
        lines = [f"(declare-const {marked(name)} Real)" for name in self.variables]
        lines += [f"(assert {_clause(clause)})" for clause in self.given]
        lines.append(f"(assert (not {_comparison(self.claim)}))")
        return "\n".join(lines)


def query(
    label: str,
    order: Iterable[str],
    given: Iterable[Clause],
    claim: Cmp,
    *,
    about: Iterable[str] = (),
    witness: bool = False,
) -> Query:
    """Return a query; it declares every name in it, and those in `about`."""
    clauses = tuple(dict.fromkeys(given))
    used = {*names(claim), *about}
    used |= {name for clause in clauses for part in clause for name in names(part)}
    known = dict.fromkeys([*order, *sorted(used)])
    return Query(label, tuple(name for name in known if name in used), clauses, claim, witness)


def _clause(clause: Clause) -> str:
    first, *others = map(_comparison, clause)
    return f"(or {first} {' '.join(others)})" if others else first


def _comparison(part: Cmp) -> str:
    if part.op == "!=":
        return f"(not (= {_term(part.left)} {_term(part.right)}))"
    return f"({part.op} {_term(part.left)} {_term(part.right)})"


def _term(node: Expr) -> str:
    match node:
        case Num(value):
            return _number(value)
        case Sym(name):
            return marked(name)
        case Neg(arg):
            return f"(- {_term(arg)})"
        case Add(terms):
            return f"(+ {' '.join(_term(term) for term in terms)})"
        case If(then, condition, other):
            return f"(ite {_comparison(condition)} {_term(then)} {_term(other)})"
        case Mul():
            return f"(* {' '.join(_term(factor) for factor in _factors(node))})"
        case Pow(base, exponent) if exponent.denominator == 1 and exponent > 0:
            return f"(* {' '.join([_term(base)] * exponent.numerator)})"
    raise TypeError(f"{type(node).__name__} is no polynomial")


def _factors(node: Expr) -> list[Expr]:
    if isinstance(node, Mul):
        return [*_factors(node.left), *_factors(node.right)]
    return [node]


def _number(value: Fraction) -> str:
    size = str(abs(value.numerator))
    text = size if value.denominator == 1 else f"(/ {size} {value.denominator})"
    return f"(- {text})" if value < 0 else text


def marked(name: str) -> str:
    """Return a name with the prefix that it has in a query."""
    return MARK + name
