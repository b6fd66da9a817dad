"""The conditions of a domain that bind the names of a question's claim.

Input: conditions, and names.  Output: the conditions connected to the names, or those among them
that matter.
"""

from collections.abc import Collection, Iterable
from functools import lru_cache

from piezo_sym.expressions.tree import Cmp, Sym, names


def connected(conditions: Iterable[Cmp], words: Iterable[str]) -> tuple[Cmp, ...]:
    """Return the conditions that share names with `words`, directly or through other conditions.

    Leaving out the others can only make a claim harder to prove; a counterexample needs them.
    """
    near = set(words)
    found = [(condition, names(condition)) for condition in conditions]
    while grown := {n for _, own in found if not near.isdisjoint(own) for n in own} - near:
        near |= grown
    return tuple(c for c, own in found if not own or not near.isdisjoint(own))


def binding(conditions: Iterable[Cmp], words: Collection[str]) -> tuple[Cmp, ...]:
    """Return the connected conditions without those that a free name can always satisfy.

    A name outside `words` can if all conditions bound it from the same side, such as the
    temperatures of other bodies that are above a common one.  The order of names does not matter:
    fewer conditions only free more names.
    """
    left = dict.fromkeys(connected(conditions, words))
    users: dict[str, dict[Cmp, str]] = {}
    for condition in left:
        for name, side in _sides(condition):
            if name not in words:
                users.setdefault(name, {})[condition] = side
    waiting = dict.fromkeys(users)
    while waiting:
        bounded = users[waiting.popitem()[0]]
        about = {*bounded.values()}
        for condition in tuple(bounded) if len(about) == 1 and all(about) else ():
            del left[condition]
            for other, _ in _sides(condition):
                if other in users:
                    del users[other][condition]
                    waiting[other] = None
    return tuple(left)


@lru_cache(1 << 14)
def _sides(condition: Cmp) -> tuple[tuple[str, str], ...]:
    """Return each name of a comparison with the side from which it is bounded, see `_side`."""
    return tuple((name, _side(name, condition)) for name in names(condition))


def _side(name: str, condition: Cmp) -> str:
    """Return the side from which a comparison bounds a name that is one of its sides, or ''."""
    sides = {"<": "below", ">": "above"}.get(condition.op[0], "")
    match condition.left, condition.right:
        case Sym(own), other if own == name and name not in names(other):
            return sides
        case other, Sym(own) if own == name and name not in names(other):
            return {"below": "above", "above": "below"}.get(sides, "")
    return ""
