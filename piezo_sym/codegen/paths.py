"""Path functionals: elements whose effort depends on the path of their coordinate.

Input: the quantities of a system.  Output: its `Path` records, and the quantities of a stage and of
the slopes for Newton's method with them.  An elastic-plastic stop has an inner state z and the
effort f = stiffness*z.  While |z| < limit, z follows the coordinate; at the limit z stays, the
coordinate slips, and the work becomes heat.  A stage is given the weighted means of effort, slip
rate and heat, exact along the step (run/engine/stop.c), and the share of the step in which z
follows the coordinate.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import final

from piezo_sym.codegen.program import Described, Names, bank_of, banks_of, needed
from piezo_sym.codegen.quantities import Quantities
from piezo_sym.expressions.calculus import add, derivative, div, mul, neg
from piezo_sym.expressions.tree import ONE, Expr, Sym, replaced
from piezo_sym.spec.elements.ports import DissipativePort, Storage


@final
@dataclass(frozen=True)
class Path:
    """A stop, or one in each lane of a bank."""

    inner: str  # the inner state; its rate is `drive` - `slip`, its energy stiffness*inner**2/2
    bank: str | None  # of the inner state
    drive: Expr  # the rate of the coordinate, in quantities that do not depend on paths
    own: bool  # whether each lane has its own drive
    seen: bool  # whether a drive depends on the inner state, as by a lever's ratio
    stiffness: Expr  # in parameters
    limit: Expr  # of the inner state, >= 0, at the beginning of a step
    #: effort, slip, heat, share: the names of the means and the share that stages are given.
    effort: str
    slip: str
    heat: str
    share: str

    def given(self) -> Iterator[Described]:
        """Yield the values that stages are given, in the order of the engine."""
        for name in (self.effort, self.slip, self.heat, self.share):
            yield Described(name, "", "", self.bank)

    @property
    def mean_slip(self) -> Expr:
        """The mean slip rate: the drive, in the share of the step in which the stop yields."""
        return mul(add(ONE, neg(Sym(self.share))), self.drive)


def paths_of(q: Quantities, new: Names) -> tuple[Path, ...]:
    """Return the stops of a system."""
    stores = {port.state: port for _, port in q.stores if isinstance(port, Storage)}
    paths = []
    limited = [
        (k, placed, port)
        for k, (placed, port) in enumerate(q.processes)
        if isinstance(port, DissipativePort) and port.limit is not None
    ]
    seen = needed(q.defined, (q.drive(k) for k, *_ in limited))[1]
    for k, placed, port in limited:
        store, bank = stores[port.state], placed.bank
        assert port.limit is not None
        slope = derivative(store.law, store.state)
        heat = next((d.name for d in q.defined if d.value == q.heats[k]), None)
        drive = q.drive(k)
        paths.append(
            Path(
                inner=store.state,
                bank=bank,
                drive=drive,
                own=bank_of(drive, q.lanes) is not None,
                seen=store.state in seen,
                stiffness=slope,
                limit=div(port.limit, slope),
                effort=store.costate,
                slip=port.output,
                heat=heat or new(f"heat_{port.output}"),
                share=new(f"share_{port.output}"),
            )
        )
    return tuple(paths)


def stage_quantities(q: Quantities, paths: Sequence[Path]) -> Quantities:
    """Return the quantities of a stage, which is given the efforts, slips and heats of paths."""
    if not paths:
        return q
    given = {name for path in paths for name in (path.effort, path.slip, path.heat)}
    named = {q.heats[k]: Sym(p.heat) for p in paths for k in [q.outputs.index(Sym(p.slip))]}
    kept = [d for d in q.defined if d.name not in given]
    defined = tuple(replace(d, value=replaced(d.value, named)) for d in kept)
    heats = tuple(replaced(heat, named) for heat in q.heats)
    return replace(q, defined=defined, heats=heats, given=_lanes(paths))


def slope_quantities(q: Quantities, paths: Sequence[Path]) -> Quantities:
    """Return the quantities for slopes: slips of paths as differentiable functions of the state."""
    if not paths:
        return q
    slips = {path.slip: path.mean_slip for path in paths}
    defined = tuple(replace(d, value=slips.get(d.name, d.value)) for d in q.defined)
    return replace(q, defined=defined, given=_lanes(paths))


def _lanes(paths: Sequence[Path]) -> dict[str, str]:
    return banks_of(field for path in paths for field in path.given())
