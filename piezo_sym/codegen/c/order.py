"""The order in which scalar code computes a function: stages of shared values and loops over lanes.

Input: quantities and writes.  Output: `LoopStage` records.  A value that needs no sum over lanes is
of stage 0; one that needs such a sum is of a later stage.  A bank has one loop per stage, which
computes the quantities of each lane, adds up the sums and writes the rows of the lane, so that
nothing is stored per lane; a quantity that a later loop needs is computed again.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.codegen.program import Limit, Quantity, bank_of, needed
from piezo_sym.expressions.tree import Expr, LaneSum, names


@final
@dataclass(frozen=True)
class Write:
    """A value and its target, a text; `bank` if there is one per lane.

    `how` is "=", "+=", or "min" for the minimum over the lanes.
    """

    target: str
    value: Expr
    bank: str | None = None
    how: str = "="


def least_over_lanes(
    array: str, limits: Iterable[Limit], lanes: Mapping[str, str]
) -> Iterator[Write]:
    """Yield the writes of the margins of some conditions."""
    for n, limit in enumerate(limits):
        bank = bank_of(limit.margin, lanes)
        yield Write(f"{array}[{n}]", limit.margin, bank, "min" if bank else "=")


@final
@dataclass(frozen=True)
class LaneLoop:
    """A loop over the lanes of a bank: quantities per lane, sums over lanes, rows per lane."""

    bank: str
    lanes: tuple[Quantity, ...]
    sums: tuple[Quantity, ...]
    writes: tuple[Write, ...]


@final
@dataclass(frozen=True)
class LoopStage:
    """Values that all lanes share, then the loops that need nothing of later stages."""

    shared: tuple[Quantity, ...]
    loops: tuple[LaneLoop, ...]


def stages(
    quantities: Sequence[Quantity], writes: Sequence[Write], banks: Iterable[str]
) -> tuple[LoopStage, ...]:
    """Return the stages that compute all writes of a function, and write the rows of banks."""
    level = _levels(quantities)
    last = max([0, *(_level(w.value, level) for w in writes), *level.values()])
    return tuple(_stage(n, quantities, writes, tuple(banks), level) for n in range(last + 1))


def lane_quantities(
    quantities: Sequence[Quantity], bank: str, roots: Iterable[Expr]
) -> tuple[Quantity, ...]:
    """Return the quantities of one lane that some expressions need, in order."""
    return needed([q for q in quantities if q.bank == bank], roots)[0]


def _levels(quantities: Sequence[Quantity]) -> dict[str, int]:
    """Return the first stage in which the value of each quantity is available."""
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
    shared, loops = list[Quantity](), list[LaneLoop]()
    sums: dict[str, list[Quantity]] = {bank: [] for bank in banks}
    for q in quantities:
        if isinstance(q.value, LaneSum):
            if level[q.name] == n + 1:
                sums[q.value.bank].append(q)
        elif not q.bank and level[q.name] == n:
            shared.append(q)
    for bank, summed in sums.items():
        rows = [w for w in writes if w.bank == bank and _level(w.value, level) == n]
        if roots := [*(q.value for q in summed), *(w.value for w in rows)]:
            lanes = lane_quantities(quantities, bank, roots)
            loops.append(LaneLoop(bank, lanes, tuple(summed), tuple(rows)))
    return LoopStage(tuple(shared), tuple(loops))
