"""Products of a system's matrices as expressions: terms, sums over lanes, rates of slips.

Input: a `LaneMatrix` and the names of its factors.  Output: terms, or sums to define.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from piezo_sym.algebra.lanes import LaneMatrix
from piezo_sym.algebra.symbols import coefficient
from piezo_sym.codegen.program import Names, Quantity
from piezo_sym.expressions.calculus import mul, neg
from piezo_sym.expressions.tree import Expr, LaneSum, Sym
from piezo_sym.iphs import IPHS
from piezo_sym.spec.elements.ports import Conductor, DissipativePort

SUMS = "sums over lanes"


def product(
    block: LaneMatrix, row: int, factors: Sequence[Expr], sums: Mapping[Expr, Sym]
) -> Iterator[Expr]:
    """Yield the terms of ``(block @ factors)[row]``, column by column, `sums` by their names."""
    for c, full, own in block.by_row.get(row, ()):
        bank, factor = block.cols[c].bank, factors[c]
        if full != 0:
            yield mul(coefficient(full), sums[LaneSum(factor, bank)] if bank else factor)
        if own != 0:
            yield mul(coefficient(own), factor)


def sums_in(blocks: Sequence[LaneMatrix], factors: Sequence[Sym], new: Names) -> Iterator[Quantity]:
    """Yield the sums over lanes in products of blocks and some factors."""
    entries = ((b.cols[c], c, full) for b in blocks for (_, c), full, _ in b.entries())
    columns = {c: slot.bank for slot, c, full in entries if full != 0}
    for c, bank in sorted(columns.items()):
        if bank:
            yield Quantity(new(f"sum_{factors[c].name}"), LaneSum(factors[c], bank), None, SUMS)


def slip_rate(
    iphs: IPHS,
    state: str,
    own: int,
    given: tuple[Sequence[Sym], Sequence[Sym]],
    sums: Mapping[Expr, Sym],
) -> Iterator[Expr]:
    """Yield the terms of the rate of a state, without those of its own slip, process `own`."""
    system, (costates, inputs) = iphs.system, given
    row = [slot.label for slot in system.states].index(state)
    yield from product(system.J0, row, costates, sums)
    yield from product(system.G, row, inputs, sums)
    laws = [port.output for _, port in iphs.circuit.of(DissipativePort, Conductor)]
    full, lanes = (
        {at: b for at, b in part.items() if at[1] != own} for part in (system.B.full, system.B.own)
    )
    rest = replace(system.B, full=full, own=lanes)
    yield from (neg(term) for term in product(rest, row, [*map(Sym, laws)], sums))
