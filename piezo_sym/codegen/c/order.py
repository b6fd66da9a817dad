"""The order in which scalar code computes a function: stages of shared values and loops over lanes.

Input: quantities and what is to be written.  Output: `LoopStage` records.  A value that needs no
sum over lanes is of stage 0, one that needs such a sum of a later one.  A bank has one loop a
stage: it computes each lane's quantities, adds up the sums and writes the lane's rows, so that
nothing has to be stored a lane; a quantity that a later loop needs again is computed again.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.codegen.program import Limit, Quantity, bank_of, needed
from piezo_sym.expressions.tree import Expr, LaneSum, names


@final
@dataclass(frozen=True)
class Write:
    """A value and where it goes: `target` is text; `bank` if there is one per lane.

    `how` is "=", "+=", or "min" for the least over the lanes.
    """

    target: str
    value: Expr
    bank: str | None = None
    how: str = "="


def least_over_lanes(
    array: str, limits: Iterable[Limit], lanes: Mapping[str, str]
) -> Iterator[Write]:
    """Yield what writes the margins of some conditions."""
    for n, limit in enumerate(limits):
        bank = bank_of(limit.margin, lanes)
        yield Write(f"{array}[{n}]", limit.margin, bank, "min" if bank else "=")


@final
@dataclass(frozen=True)
class LaneLoop:
    """A loop over the lanes of a bank: quantities of a lane, sums over lanes, rows of a lane."""

    bank: str
    lanes: tuple[Quantity, ...]
    sums: tuple[Quantity, ...]
    writes: tuple[Write, ...]


@final
@dataclass(frozen=True)
class LoopStage:
    """Values that all lanes share, then the loops that need no later ones."""

    shared: tuple[Quantity, ...]
    loops: tuple[LaneLoop, ...]


def stages(
    quantities: Sequence[Quantity], writes: Sequence[Write], banks: Iterable[str]
) -> tuple[LoopStage, ...]:
    """Return the stages that compute all that a function writes, rows of banks included."""
    level = _levels(quantities)
    last = max([0, *(_level(w.value, level) for w in writes), *level.values()])
    return tuple(_stage(n, quantities, writes, tuple(banks), level) for n in range(last + 1))


def lane_quantities(
    quantities: Sequence[Quantity], bank: str, roots: Iterable[Expr]
) -> tuple[Quantity, ...]:
    """Return the quantities of one lane that some expressions need, in order."""
    return needed([q for q in quantities if q.bank == bank], roots)[0]


def _levels(quantities: Sequence[Quantity]) -> dict[str, int]:
    """Return the first stage in which each quantity is known."""
    level: dict[str, int] = {}
    for quantity in quantities:
        after = int(isinstance(quantity.value, LaneSum))
        level[quantity.name] = _level(quantity.value, level) + after
    return level


def _level(value: Expr, level: Mapping[str, int]) -> int:
    return max((level.get(name, 0) for name in names(value)), default=0)


def _stage(
    n: int,
    quantities: Sequence[Quantity],
    writes: Sequence[Write],
    banks: tuple[str, ...],
    level: Mapping[str, int],
) -> LoopStage:
    shared = [
        q
        for q in quantities
        if not q.bank and not isinstance(q.value, LaneSum) and level[q.name] == n
    ]
    sums = [q for q in quantities if isinstance(q.value, LaneSum) and level[q.name] == n + 1]
    rows = [w for w in writes if w.bank and _level(w.value, level) == n]
    return LoopStage(tuple(shared), tuple(_loops(quantities, sums, rows, banks)))


def _loops(
    quantities: Sequence[Quantity],
    sums: Sequence[Quantity],
    rows: Sequence[Write],
    banks: tuple[str, ...],
) -> Iterator[LaneLoop]:
    for bank in banks:
        own = tuple(q for q in sums if isinstance(q.value, LaneSum) and q.value.bank == bank)
        written = tuple(row for row in rows if row.bank == bank)
        if own or written:
            roots = [*(q.value for q in own), *(row.value for row in written)]
            yield LaneLoop(bank, lane_quantities(quantities, bank, roots), own, written)
