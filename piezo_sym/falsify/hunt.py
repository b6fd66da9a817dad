"""The attack itself: points block by block, the worst of each row kept, followed and confirmed.

Input: an `IPHS`, its module, rows.  Output: an `Attack` per row, or a `ContradictionError`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any, final

import numpy as np

from piezo_sym.errors import ContradictionError
from piezo_sym.falsify.claims import Claim, claim_of, laws_of
from piezo_sym.falsify.exact import Exact, exact_of
from piezo_sym.falsify.points import CORNERS, FEW, ROOTS, Draw
from piezo_sym.falsify.probe import probe_of
from piezo_sym.falsify.space import Array, Seen, Space
from piezo_sym.iphs import IPHS
from piezo_sym.spec.expressions import Num, Sym
from piezo_sym.spec.tables import conditions, greater
from piezo_sym.spec.units import parse_unit

POINTS = 100_000
LANES = 2
KEPT, CHILDREN, DESCENTS = 8, 24, 8
#: Of a law's size; between neighbouring floats it may change by less than this.
JUMP = 1e-6


@final
@dataclass(frozen=True)
class Attack:
    """What became of a row.

    Attributes
    ----------
    id, element : of the row.
    points : inside the domain at which it held.
    worst : a point at which the module's number breaks it, by name, though the exact one does not.
    rounding : whether there is one.
    """

    id: str
    element: str
    points: int
    worst: Mapping[str, str] | None = None
    rounding: bool = False


@final
@dataclass(eq=False)
class Track:
    """What is kept of a claim: how many points, and the worst, by the way they were found."""

    claim: Claim
    points: int = 0
    worst: list[tuple[float, str, Space, Array]] = field(default_factory=list)
    lost: tuple[float, str, Space, Array] | None = None

    def see(self, kind: str, seen: Seen) -> None:
        """Take in points that are inside the domain."""
        with np.errstate(all="ignore"):
            value, scale = self.claim.look(seen)
            self.points += int((value[0] < np.inf).sum()) if self.claim.part else value.shape[1]
            if not self.claim.climbs and not (value < 0).any():
                return
            ratio = np.clip(value / scale, -1, 1)
            lost = np.isnan(ratio)
        if lost.any():
            ratio = np.where(lost, np.where(np.isnan(value), 2, np.sign(value)), ratio)
            if self.claim.climbs:
                self._lose(kind, seen, np.isnan(value).any(axis=0))
        key = ratio.min(axis=0, initial=2)
        self._keep(kind, seen, np.where((key < 0) & seen.extreme, key / 1000, key))

    def _keep(self, kind: str, seen: Seen, key: Array) -> None:
        """Keep the worst points of their kind."""
        most = min(KEPT, len(key))
        first = np.sort(np.argpartition(key, most - 1)[:most]) if most else []
        new = [(float(key[n]), kind, seen.space, seen.points[:, n]) for n in first]
        rest = [entry for entry in self.worst if entry[1] != kind]
        same = sorted([e for e in self.worst if e[1] == kind] + new, key=lambda e: e[0])
        self.worst = rest + same[:KEPT]

    def _lose(self, kind: str, seen: Seen, lost: Any) -> None:
        """Note a point where the number is nan though nothing overflowed."""
        place = np.flatnonzero(lost & ~seen.extreme & ~np.isinf(seen.laws).any(axis=0))
        if len(place) and self.lost is None:
            self.lost = (0.0, kind, seen.space, seen.points[:, place[0]])


@final
class Hunt:
    """An attack on the rows of one model."""

    def __init__(
        self,
        iphs: IPHS,
        module: ModuleType,
        claims: tuple[tuple[str, str], ...],
        hints: tuple[Mapping[str, object], ...],
        points: int,
    ) -> None:
        self.iphs, self.wanted = iphs, points
        probe = probe_of(iphs)
        spec = module.Parameters()
        sizes = {bank: getattr(spec, f"{bank}_count") for bank in module.BANKS}
        self.spec = Space(module, probe, sizes)
        self.space = Space(module, probe, dict.fromkeys(sizes, LANES))
        found = (claim_of(iphs, *row) for row in claims)
        self.tracks = [Track(claim) for claim in found if claim]
        known = [self.space.own(), *(self._hinted(hint) for hint in hints)]
        self.draw = Draw(self.space, np.concatenate(known, axis=1), self._positive(), self._pairs())

    def attacks(self) -> tuple[Attack, ...]:
        """Return what became of each row.

        Raises
        ------
        ContradictionError
            If one is false.
        """
        for kind, space, points in self._blocks():
            for n in range(0, points.shape[1], space.block):
                self._see(kind, space, points[:, n : n + space.block])
        exact = exact_of(self.iphs)
        return tuple(self._judged(track, exact) for track in self.tracks)

    def _see(self, kind: str, space: Space, points: Array) -> None:
        seen, prepared = space.at(points), None
        for track in self.tracks:
            if track.claim.prepared is None:
                track.see(kind, seen)
                continue
            if prepared is None:
                changed = track.claim.prepared(space, points)
                prepared = space.at(changed[:, space.at(changed).inside])
            track.see(kind, prepared)

    def _blocks(self) -> Iterator[tuple[str, Space, Array]]:
        """Yield points inside the domain, and how they were found."""
        draw, own = self.draw, self.spec.own()
        yield "own", self.spec, own[:, self.spec.at(own).inside]
        draw.known = draw.inside(draw.known)
        total = draw.known
        yield "own", self.space, draw.known
        if draw.known.shape[1]:
            kinks = draw.kinks(draw.known[:, :6], ROOTS)
            yield "kinks", self.space, kinks
            draw.learn(kinks)
            corners = draw.kinks(draw.known[:, -12:], CORNERS)
            yield "corners", self.space, corners
            draw.learn(corners)
            total = np.concatenate([total, kinks, corners], axis=1)
        else:
            draw.known = self._anything()
            draw.learn(draw.known[:, :0])
        count = total.shape[1]
        for _ in range(4 * self.wanted // self.space.block + 4):
            if count >= self.wanted:
                break
            new = draw.inside(draw.drawn(self.space.block))
            count += new.shape[1]
            total = total if total.shape[1] > FEW else np.concatenate([total, new], axis=1)
            yield "drawn", self.space, new
        if count < self.wanted and total.shape[1]:
            yield "walked", self.space, draw.walked(total, self.wanted - count)
        yield from self._descended()

    def _anything(self) -> Array:
        return np.concatenate([self.space.own()], axis=1)

    def _descended(self) -> Iterator[tuple[str, Space, Array]]:
        """Yield steps from the worst points of each row, from where they led, and so on."""
        for n in range(DESCENTS):
            starts = [
                point
                for track in self.tracks
                if track.claim.climbs
                for _, _, space, point in sorted(track.worst, key=lambda e: e[0])[:KEPT]
                if space is self.space
            ]
            if not starts:
                return
            moved = self.draw.moved(np.array(starts).T, CHILDREN, 1.0 + n)
            yield "descended", self.space, self.draw.inside(moved)

    def _judged(self, track: Track, exact: Exact) -> Attack:
        """Return what became of a row, its suspicious points evaluated exactly."""
        claim, rounding = track.claim, None
        doubtful = [entry for entry in sorted(track.worst, key=lambda e: e[0]) if entry[0] < 0]
        for _, kind, space, point in doubtful:
            value = exact.broken(claim, space, point)
            if value:
                raise self._contradiction(claim, value, space.words(point), kind)
            rounding = rounding or (space, point)
        if track.lost and rounding is None and exact.has_value(claim, *track.lost[2:]):
            rounding = track.lost[2:]
        if claim.id == "continuous":
            self._jumps(claim, exact)
        worst = rounding[0].words(rounding[1]) if rounding else None
        return Attack(claim.id, claim.element, track.points, worst, rounding is not None)

    def _jumps(self, claim: Claim, exact: Exact) -> None:
        """Look at a law on both sides of the kinks that states and inputs reach."""
        space = self.space
        for roots in self.draw.roots:
            edges = [edge.op == "if" for edge in space.probe.edges]
            sizes = [row.stop - row.start for row in space.edge_rows]
            chosen = np.repeat(edges, sizes)
            low, high = (space.at(roots.at(value)) for value in (roots.low, roots.high))
            near = chosen[roots.edge] & (roots.column >= space.inputs_at)
            near &= low.inside & high.inside & ~low.extreme
            for law in laws_of(space, claim.element):
                with np.errstate(all="ignore"):
                    jump = np.abs(high.laws[law] - low.laws[law])
                    big = (jump / (high.sizes[law] + low.sizes[law])).max(axis=0)
                big = np.where(near & np.isfinite(big), big, 0)
                for n in np.argsort(-big, kind="stable")[:4]:
                    if big[n] > JUMP:
                        pair = (low.points[:, n], high.points[:, n])
                        value = exact.jump(claim, space, *pair)
                        if value:
                            raise self._contradiction(claim, value, space.words(pair[1]), "kinks")

    def _contradiction(
        self, claim: Claim, value: str, words: Mapping[str, str], kind: str
    ) -> ContradictionError:
        at = ", ".join(f"{name} = {text}" for name, text in words.items())
        row = f"{claim.id} of {claim.element}" if claim.element else claim.id
        error = ContradictionError(
            f"a proof and a number disagree: {row} is PROVED, but {value} at {at}",
            self.iphs.model.name,
            remedy="this is a fault of piezo-sym: report it with the spec",
        )
        error.kind = kind
        return error

    # What the spec says of columns

    def _positive(self) -> Any:
        """Return which columns the domain keeps from being negative."""
        found = set()
        for condition in conditions(self.iphs.model):
            match greater(condition.tree):
                case greater_ if isinstance(greater_.left, Sym) and isinstance(greater_.right, Num):
                    found |= {greater_.left.name} if greater_.right.value >= 0 else set()
        return np.array([name in found for name, _ in self.space.columns])

    def _pairs(self) -> Any:
        """Return pairs of columns of equal dimension."""
        units = {f.name: parse_unit(f.unit).dimension for f in self.space.fields}
        columns = [(n, units[name]) for n, (name, _) in enumerate(self.space.columns)]
        pairs = [(a, b) for a, one in columns for b, other in columns if a != b and one == other]
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)

    def _hinted(self, hint: Mapping[str, object]) -> Array:
        """Return the spec's own point with the values of a hint, temperatures put in by entropy."""
        point = self.space.own()
        for n, (name, lane) in enumerate(self.space.columns):
            given = hint.get(f"{name}_{lane + 1}", hint.get(name))
            point[n] = point[n] if given is None else float(str(given))
        return point
