"""The attack: evaluates rows at blocks of points, descends from the worst, and confirms exactly.

Input: an `IPHS`, its module, rows.  Output: an `Attack` per row, or a `ContradictionError`.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain
from operator import itemgetter
from types import ModuleType
from typing import final

import numpy as np

from piezo_sym.errors import ContradictionError
from piezo_sym.expressions.tree import names
from piezo_sym.falsify.claims import TOLERANCE, Claim, claim_of
from piezo_sym.falsify.exact import broken
from piezo_sym.falsify.jumps import Sides, jump, sides_of
from piezo_sym.falsify.points import FEW, STAGES, Draw
from piezo_sym.falsify.probe import probe_of
from piezo_sym.falsify.space import Array, Evaluation, Mask, Space
from piezo_sym.iphs import IPHS

POINTS = 100_000
#: Lanes per bank of a point; the most lanes for which the spec's own values are tried.
LANES, MOST_LANES = 2, 512
#: Worst points kept per search, and those checked exactly; points tried near each, and how often.
KEPT, CHECKED, CHILDREN, DESCENTS = 8, 4, 24, 8
#: Rank of a value 0 where the row claims > 0: it may be rounding, so it is evaluated exactly.
ZERO = -1e-300


@final
@dataclass(frozen=True)
class Attack:
    """The result for a row."""

    #: id, element: of the row.
    id: str
    element: str
    #: The number of points inside the domain at which the row held, rounded down to one digit: on
    #: another processor a few of the points may lie outside, and the number is published.
    points: int
    #: Values by name at a point where the row is false in floats, though not exactly, or None.
    worst: Mapping[str, str] | None = None


@final
@dataclass(eq=False)
class Track:
    """The number of points tried for a claim, and the worst points that each search found."""

    claim: Claim
    points: int = 0
    worst: dict[str, list[tuple[float, Space, Array]]] = field(default_factory=dict)

    def see(self, kind: str, seen: Evaluation) -> None:
        """Evaluate the claim at points inside the domain."""
        with np.errstate(all="ignore"):
            applies = seen.holds(self.claim.where)
            self.points += int(applies.sum())
            if self.claim.id == "welldef":
                key = np.where(seen.undefined(self.claim.element), -1.0, 1.0)
            elif self.claim.says:
                key = self._least(seen, applies)
            else:
                return
        if self.claim.is_smooth or (key < 0).any():
            self._keep(kind, seen, np.where((key < 0) & seen.extreme, key / 1000, key))

    def _least(self, seen: Evaluation, applies: Mask) -> Array:
        """Return the least value/scale of the claim, and 2 where it does not apply."""
        least: Array = np.full(applies.shape, 2.0)
        for said in self.claim.says:
            value, scale = seen.of(said.value).value, seen.of(said.scale).size
            if not self.claim.is_smooth and not (value < -TOLERANCE * scale).any():
                continue
            ratio = np.clip(value / scale, -1, 1)
            sign = np.where(np.isnan(value), 2, np.sign(value))
            ratio = np.where(np.isnan(ratio), sign, ratio)
            if not self.claim.is_smooth:
                ratio = np.where(ratio < -TOLERANCE, ratio, 1)
            ratio = np.where(value == 0, ZERO if said.strict else 2, ratio)
            least = np.minimum(least, np.atleast_2d(ratio).min(axis=0))
        return np.where(applies, least, 2)

    def _keep(self, kind: str, seen: Evaluation, key: Array) -> None:
        """Keep the worst points that one search found."""
        known = self.worst.setdefault(kind, [])
        place = np.flatnonzero(key < (known[-1][0] if len(known) == KEPT else np.inf))
        first = place[np.argsort(key[place], kind="stable")[:KEPT]]
        known += [(float(key[n]), seen.space, seen.points[:, n]) for n in first]
        known.sort(key=itemgetter(0))
        del known[KEPT:]


@final
class Hunt:
    """An attack on the rows of one model."""

    def __init__(
        self, iphs: IPHS, module: ModuleType, claims: tuple[tuple[str, str], ...], points: int
    ) -> None:
        self.iphs = iphs
        spec, probe = module.Parameters(), probe_of(iphs)
        sizes = {bank: getattr(spec, f"{bank}_count") for bank in module.BANKS}
        self.spec = Space(module, probe, sizes)
        self.space = Space(module, probe, dict.fromkeys(sizes, LANES))
        found = {row: claim_of(probe, *row) for row in claims}
        self.wanted = min(points, self.space.most)
        self._tracks = {row: Track(claim) for row, claim in found.items() if claim}
        self.tracks = [*self._tracks.values()]
        trees = [condition.tree for condition in iphs.circuit.conditions]
        self.conditioned = {name for tree in trees for name in names(tree)}
        most = min(MOST_LANES, max(sizes.values(), default=1))
        known = [self.space.own(lane) for lane in range(0, most, LANES)]
        self.draw = Draw(self.space, np.concatenate(known, axis=1))

    def search(self) -> None:
        """Evaluate all rows at all points."""
        for kind, space, points in self._blocks():
            for n in range(0, points.shape[1], space.block):
                self._see(kind, space, points[:, n : n + space.block])

    def attack(self, row: tuple[str, str]) -> Attack | None:
        """Return the result for a row, after the search; None if it has no value at a point.

        Its suspicious points are evaluated exactly.  Raises `ContradictionError` if it is false.
        """
        if (track := self._tracks.get(row)) is None:
            return None
        claim, rounding = track.claim, None
        most = CHECKED if claim.says else KEPT
        for key, space, point in chain(*(worst[:most] for worst in track.worst.values())):
            value = broken(claim, space, point) if key < 0 else None
            if value:
                raise self._contradiction(claim, value, space.words(point))
            if key < ZERO and claim.says and not rounding:
                plain = not space.at(point[:, None]).out_of_range[0]
                rounding = (space, point) if plain else None  # not if products overflow
        if claim.id == "continuous":
            found = jump(claim, self.space, self.sides)
            if found:
                raise self._contradiction(claim, found[0], self.space.words(found[1]))
        worst = rounding[0].words(rounding[1]) if rounding else None
        points = int(str(track.points)[0]) * 10 ** (len(str(track.points)) - 1)
        return Attack(claim.id, claim.element, points, worst)

    def _see(self, kind: str, space: Space, points: Array) -> None:
        seen = space.at(points)
        for track in self.tracks:
            zero, equal = track.claim.zero, track.claim.equal
            if not (zero or equal):
                track.see(kind, seen)
                continue
            changed, columns = points.copy(), space.columns_of
            for name in zero:
                changed[columns[name]] = 0
            for name in equal:
                changed[columns[name]] = points[columns[equal[0]]]
            bound = self.conditioned.isdisjoint({*zero, *equal[1:]})
            track.see(kind, space.at(changed if bound else changed[:, space.at(changed).inside]))

    def _blocks(self) -> Iterator[tuple[str, Space, Array]]:
        """Yield blocks of points inside the domain, with the name of the search that found them."""
        draw, own = self.draw, self.spec.own()
        yield "own", self.spec, own[:, self.spec.at(own).inside]
        total = draw.inside(draw.known)
        draw.known = total if total.shape[1] else draw.known
        yield "own", self.space, total
        for kind, most in STAGES:
            found = draw.kinks(draw.known[:, -20:], most)
            draw.learn(found)
            yield kind, self.space, found
            total = np.concatenate([total, found], axis=1)
        count = total.shape[1]
        for _ in range(4 * self.wanted // self.space.block + 4):
            if count >= self.wanted:
                break
            new = draw.inside(draw.drawn(self.space.block))
            count += new.shape[1]
            total = total if total.shape[1] > FEW else np.concatenate([total, new], axis=1)
            yield "drawn", self.space, new
        yield "walked", self.space, draw.walked(total, self.wanted - count)
        yield from self._descended()

    def _descended(self) -> Iterator[tuple[str, Space, Array]]:
        """Yield points near the worst points of each row, repeatedly."""
        for n in range(DESCENTS):
            smooth = (track for track in self.tracks if track.claim.is_smooth)
            worst = (
                sorted(chain(*track.worst.values()), key=itemgetter(0))[:KEPT] for track in smooth
            )
            starts = [found for own in worst for found in own if found[1] is self.space]
            if len(starts) > (most := self.space.most // (4 * CHILDREN)):
                starts = sorted(starts, key=itemgetter(0))[:most]
            if starts:
                points = np.array([point for _, _, point in starts]).T
                moved = self.draw.moved(points, CHILDREN, 1.0 + n)
                yield "descended", self.space, self.draw.inside(moved)

    @cached_property
    def sides(self) -> list[Sides]:
        """Points on both sides of the kinks found."""
        return [sides_of(self.space, roots) for roots in self.draw.roots]

    def _contradiction(
        self, claim: Claim, value: str, words: Mapping[str, str]
    ) -> ContradictionError:
        at = ", ".join(f"{name} = {text}" for name, text in words.items())
        row = f"{claim.id} of {claim.element}" if claim.element else claim.id
        what = f"a proof and a number disagree: {row} is PROVED, but {value} at {at}"
        return ContradictionError(what, self.iphs.model.name, remedy="report it with the spec")
