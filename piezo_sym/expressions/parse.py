"""Text of a law to a checked tree.

Input: text from a user.  Output: a tree, or a `SpecError`.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import TypeVar

from piezo_sym.errors import SpecError, quote
from piezo_sym.expressions.exact_eval import evaluate
from piezo_sym.expressions.grammar import RefusedError, read_condition, read_law
from piezo_sym.expressions.size import check_size
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Cmp, Div, Expr, Sym, children, names

Tree = TypeVar("Tree", Expr, Cmp)


def parse_law(text: str, where: str) -> Expr:
    """Return the tree of a law; `where` is its place in the spec, for the message.

    Raises `SpecError` if the text is not of the law language, or a constant part has no value.
    """
    return _located(_law, text, where)


def parse_condition(text: str, where: str) -> Cmp:
    """Return the tree of one comparison, such as ``T > T_0``.

    Raises `SpecError` if the text is not one comparison of two laws.
    """
    return _located(_condition, text, where)


def _located(read: Callable[[str], Tree], text: str, where: str) -> Tree:
    try:
        return read(text)
    except RefusedError as refused:
        what = f"{quote(text)} {refused.what}"
        raise SpecError(what, where, refused.expected, refused.remedy) from None


@lru_cache(maxsize=16384)
def _law(text: str) -> Expr:
    tree = read_law(text)
    check_size(tree)
    _check_constants(tree)
    return tree


@lru_cache(maxsize=16384)
def _condition(text: str) -> Cmp:
    tree = read_condition(text)
    for side in (tree.left, tree.right):
        check_size(side)
        _check_constants(side)
    return tree


def _check_constants(node: Expr | Cmp) -> bool:
    """Return whether `node` is constant; refuse the smallest constant part without a value."""
    constant = all([_check_constants(part) for part in children(node)])
    if isinstance(node, Div) and not names(node.right) and evaluate(node.right, {}) == 0:
        what = f"divides by {quote(spell(node.right))}, which is zero"
        raise RefusedError(what, remedy="divide by something else")
    if isinstance(node, Cmp) or not constant or isinstance(node, Sym):
        return constant and not isinstance(node, Sym)
    try:
        evaluate(node, {})
    except (ArithmeticError, ValueError):
        what = f"has the constant part {quote(spell(node))} without a finite real value"
        raise RefusedError(what, remedy="give the number itself") from None
    return True
