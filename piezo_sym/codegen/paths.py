"""Path functionals: elements whose effort depends on the way that their coordinate goes.

Input: the quantities of a system.  Output: its `Path` records, and what a stage and the slopes for
Newton's method are told of them.  An elastic-plastic stop has an inner state z and the effort
f = stiffness*z; z goes with the coordinate while |z| < limit, and where it would leave, it stays,
the rest slips and all that is done becomes heat.  A stage is given weighted means of effort, rate
of the slip and heat, exact along the step (run/engine/stop.c), and in which part of the step z goes
with the coordinate.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import final

from piezo_sym.codegen.program import Described, Names, bank_of
from piezo_sym.codegen.quantities import Quantities
from piezo_sym.expressions.calculus import add, derivative, div, mul, neg
from piezo_sym.expressions.tree import ONE, Expr, Sym, rebuild
from piezo_sym.spec.elements.ports import Conductor, DissipativePort, Storage


@final
@dataclass(frozen=True)
class Path:
    """A stop, or one in each lane of a bank.

    Attributes
    ----------
    inner : a state, whose rate is `drive` less `slip` and whose energy is stiffness*inner**2/2.
    bank : of the inner state.
    drive : the rate of the coordinate, of quantities of a stage that no path gives.
    own : whether each lane has a drive of its own.
    stiffness : in parameters.
    limit : of the inner state, >= 0, as it is where a step begins.
    effort, slip, heat, share : the names of what stages are given.
    """

    inner: str
    bank: str | None
    drive: Expr
    own: bool
    stiffness: Expr
    limit: Expr
    effort: str
    slip: str
    heat: str
    share: str

    def given(self) -> Iterator[Described]:
        """Yield what stages are given, in the order of the engine."""
        for name in (self.effort, self.slip, self.heat, self.share):
            yield Described(name, "", "", self.bank)

    @property
    def slip_in_motion(self) -> Expr:
        """The slip in the mean, of the part of the step in which it yields."""
        return mul(add(ONE, neg(Sym(self.share))), self.drive)


def paths_of(q: Quantities, new: Names) -> tuple[Path, ...]:
    """Return the stops of a system."""
    stores = {port.state: port for _, port in q.stores if isinstance(port, Storage)}
    found = []
    processes = q.iphs.circuit.of(DissipativePort, Conductor)
    for k, (placed, port) in enumerate(processes):
        if isinstance(port, Conductor) or port.limit is None:
            continue
        store, bank = stores[port.state], placed.bank
        slope = derivative(store.law, store.state)
        heat = next((d.name for d in q.defined if d.value == q.heats[k]), None)
        drive = q.drive(k)
        found.append(
            Path(
                inner=store.state,
                bank=bank,
                drive=drive,
                own=bank_of(drive, q.lanes) is not None,
                stiffness=slope,
                limit=div(port.limit, slope),
                effort=store.costate,
                slip=port.output,
                heat=heat or new(f"heat_{port.output}"),
                share=new(f"share_{port.output}"),
            )
        )
    return tuple(found)


def given_to(q: Quantities, paths: Sequence[Path]) -> Quantities:
    """Return the quantities of a stage, to which paths give efforts, slips and heats."""
    given = {name for path in paths for name in (path.effort, path.slip, path.heat)}
    heats = {q.heats[k]: Sym(p.heat) for p in paths for k in [q.outputs.index(Sym(p.slip))]}

    def put(node: Expr) -> Expr:
        return heats.get(node) or rebuild(node, put)

    rest = tuple(replace(d, value=put(d.value)) for d in q.defined if d.name not in given)
    return replace(q, defined=rest, heats=tuple(map(put, q.heats)), given=_lanes(paths))


def in_motion(q: Quantities, paths: Sequence[Path]) -> Quantities:
    """Return quantities for slopes, from which Newton's method learns how paths go by the state."""
    slips = {path.slip: path.slip_in_motion for path in paths}
    defined = tuple(replace(d, value=slips.get(d.name, d.value)) for d in q.defined)
    return replace(q, defined=defined, given=_lanes(paths))


def _lanes(paths: Sequence[Path]) -> dict[str, str]:
    return {field.name: field.bank for path in paths for field in path.given() if field.bank}
