"""The conditions of a domain that bind the names of a question's claim.

Input: conditions, and names.  Output: the conditions connected to the names, or those among them
that matter.  An `_Index` of a domain serves all questions whose conditions begin with it, so that
the cost of a question does not grow with the model.
"""

from collections.abc import Collection, Iterable, Iterator
from functools import lru_cache
from typing import final

from piezo_sym.expressions.tree import Cmp, Sym, names

#: Indexes kept; conditions that a question may have beyond those of its index.
MOST_KEPT, MOST_MORE = 8, 32


def connected(conditions: Iterable[Cmp], words: Iterable[str]) -> tuple[Cmp, ...]:
    """Return the conditions that share names with `words`, directly or through other conditions.

    Leaving out the others can only make a claim harder to prove; a counterexample needs them.
    """
    near = set(words)
    found = [(condition, names(condition)) for condition in conditions]
    while grown := {n for _, own in found if not near.isdisjoint(own) for n in own} - near:
        near |= grown
    return tuple(c for c, own in found if not own or not near.isdisjoint(own))


def binding(conditions: tuple[Cmp, ...], words: Collection[str]) -> tuple[Cmp, ...]:
    """Return the connected conditions without those that a free name can always satisfy.

    A name outside `words` can if all conditions bound it from the same side, such as the
    temperatures of other bodies that are above a common one.
    """
    index = _index_of(conditions)
    more = {c: None for c in conditions[index.length :] if c not in index.place}
    near = index.near(words, more)
    left = {*index.needed(words, more)}
    left.difference_update(*(gone for _, gone in _freed(left, words, index.sides)))
    last = len(index.place)
    places = {c: last + n for n, c in enumerate(more)}
    found = (c for c in (*index.kept, *left) if not names(c) or index.group(names(c)[0]) in near)
    return tuple(sorted(found, key=lambda c: places.get(c, index.place.get(c, last))))


def _freed(
    found: Iterable[Cmp], words: Collection[str], others: dict[str, set[str]]
) -> Iterator[tuple[str, tuple[Cmp, ...]]]:
    """Yield free names with the conditions that they satisfy, which are then left out.

    The order of names does not matter: fewer conditions only free more names.  `others` has, for
    each name, the sides from which conditions outside `found` bound it.
    """
    users: dict[str, dict[Cmp, str]] = {}
    for condition in found:
        for name, side in _sides(condition):
            if name not in words:
                users.setdefault(name, {})[condition] = side
    waiting = dict.fromkeys(users)
    while waiting:
        bounded = users[name := waiting.popitem()[0]]
        about = {*bounded.values(), *others.get(name, ())}
        if bounded and len(about) == 1 and all(about):
            gone = tuple(bounded)
            for condition in gone:
                for other, _ in _sides(condition):
                    if other in users:
                        del users[other][condition]
                        waiting[other] = None
            yield name, gone


@final
class _Index:
    """Conditions that many questions begin with.

    Attributes
    ----------
    length : their number.
    place : the index of each distinct condition.
    kept : those that no free name satisfies.
    sides : by name, the sides from which these bound it.
    """

    def __init__(self, conditions: tuple[Cmp, ...]) -> None:
        self.conditions, self.length = conditions, len(conditions)
        self.place = {c: n for n, c in enumerate(dict.fromkeys(conditions))}
        self._gone = dict(_freed(self.place, (), {}))
        gone = {c for freed in self._gone.values() for c in freed}
        self.kept = tuple(c for c in self.place if c not in gone)
        self.sides: dict[str, set[str]] = {}
        for condition in self.kept:
            for name, side in _sides(condition):
                self.sides.setdefault(name, set()).add(side)
        self._joined: dict[str, str] = {}
        for condition in self.place:
            first, *others = map(self.group, names(condition)) if names(condition) else ("",)
            self._joined.update(dict.fromkeys({*others} - {first}, first))

    def group(self, name: str) -> str:
        """Return the representative of all names that conditions connect with this one."""
        while (joined := self._joined.get(name)) is not None:
            further = self._joined.get(joined)
            if further is not None:
                self._joined[name] = further
            name = joined
        return name

    def near(self, words: Iterable[str], more: Iterable[Cmp]) -> set[str]:
        """Return the groups connected to `words`, also through the additional conditions."""
        near, left = {*map(self.group, words)}, [{*map(self.group, names(c))} for c in more]
        while grown := {g for groups in left if not near.isdisjoint(groups) for g in groups} - near:
            near |= grown
        return near

    def needed(self, words: Collection[str], more: Iterable[Cmp]) -> Iterator[Cmp]:
        """Yield the additional conditions, and those left out for a name that is no longer free.

        A name is no longer free if it is in `words`, or a yielded condition bounds its other side.
        """
        sides: dict[str, set[str]] = {}
        waiting, here = [*words], [*more]
        freed = dict(self._gone)
        while here or waiting:
            for condition in here:
                yield condition
                for name, side in _sides(condition):
                    sides.setdefault(name, set()).add(side)
                    waiting.append(name)
            here = []
            while waiting and not here:
                name = waiting.pop()
                gone = freed.get(name, ())
                own = {dict(_sides(condition))[name] for condition in gone}
                if gone and (name in words or not sides[name] <= own):
                    here = [*freed.pop(name)]


#: The last indexes, and the conditions of the last question.
_known: list[_Index] = []
_last: list[tuple[Cmp, ...]] = [()]


def _index_of(conditions: tuple[Cmp, ...]) -> _Index:
    """Return the longest known index that conditions begin with; a new one if that is too short."""
    before, _last[0] = _last[0], conditions
    fit = (one for one in _known if conditions[: one.length] == one.conditions)
    found = max(fit, key=lambda one: one.length, default=None)
    if found and len(conditions) - found.length <= MOST_MORE:
        return found
    pairs = zip(conditions, before, strict=False)
    most = min(len(conditions), len(before))
    same = next((n for n, (one, other) in enumerate(pairs) if one is not other), most)
    same = same if len(conditions) - same <= MOST_MORE else len(conditions)
    _known[:] = [_Index(conditions[:same]), *_known[: MOST_KEPT - 1]]
    return _known[0]


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
