"""A run at its samples, its ledger, and its Dataset: every quantity by name, with units.

Input: a `DrivenModule`, the sample times (nt,), a `Trajectory`.  Output: an `xarray.Dataset` with
coordinate `time` [s] and, for each bank, its lanes 1..r under the element's name.  Sweeps name the
quantities of many runs by the same functions.

    supplied_port(t) = int_0^t y u dt
    heat_k(t) = int_0^t W_k z_k dt        produced_k(t) = int_0^t W_k z_k/T dt
    entropy_exchanged_a(t) = int_0^t lam (T_e - T)/T dt
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.errors import UsageError, listing, nearest, quote
from piezo_sym.run.checks import FloatArray, is_vector
from piezo_sym.run.module import (
    GeneratedModule,
    Record,
    exchanges,
    lanes,
    row_count,
    verdict_of,
)
from piezo_sym.run.system import DrivenModule

if TYPE_CHECKING:
    import pandas
    import xarray

Variable: TypeAlias = tuple[tuple[str, ...], "NDArray[Any] | pandas.Index[Any]", dict[str, Any]]
Named: TypeAlias = tuple[str, Variable]
#: Where quantities of elements are asked for, and the word for all of them.
OUTPUTS, EVERY = "simulate.outputs", "all"


@final
@dataclass(frozen=True)
class Trajectory:
    """A run at its sample times (nt,), nan beyond what it reached, and what it took."""

    start: FloatArray  # (n,): the state at t = 0
    states: FloatArray  # (n, nt)
    inputs: FloatArray  # (m, nt)
    #: (ports + 2 processes + exchanges, nt): supplied, heat, produced, exchanged
    integrals: FloatArray
    steps: int = 0
    evaluations: int = 0
    halvings: int = 0
    numerical: FloatArray | None = None  # (2, nt): heat and entropy that dissipative starts produce

    @staticmethod
    def blank(system: DrivenModule, start: FloatArray, samples: int) -> Trajectory:
        """Return a run that has not begun."""
        module, p = system.module, system.parameters
        sums = len(module.OUTPUTS) + 2 * row_count(module.PROCESSES, p) + len(exchanges(module))
        rows = start.size, len(module.INPUTS), sums
        states, inputs, integrals = (np.full((size, samples), np.nan) for size in rows)
        return Trajectory(start, states, inputs, integrals)

    def at(self, places: NDArray[np.intp]) -> Trajectory:
        """Return some of the samples."""
        return replace(
            self,
            states=self.states[:, places],
            inputs=self.inputs[:, places],
            integrals=self.integrals[:, places],
            numerical=None if self.numerical is None else self.numerical[:, places],
        )

    def until(self, times: FloatArray) -> tuple[FloatArray, Trajectory]:
        """Return the times and samples of a run that has no more states."""
        missing = np.isnan(self.states).any(axis=0)
        count = int(np.argmax(missing)) if missing.any() else missing.size
        return times[:count], self.at(np.arange(count))


@final
@dataclass(frozen=True)
class Known:
    """What is known of a run, or of runs of equal sizes, at samples: arrays (rows, [runs], nt)."""

    system: DrivenModule
    states: FloatArray
    inputs: FloatArray | None  # or left out
    values: Mapping[str, FloatArray]  # of the module's functions; energies have no rows
    start: tuple[FloatArray, FloatArray]  # energy and entropy there; of many runs (runs, 1)
    integrals: FloatArray
    numerical: FloatArray | None = None  # as in a `Trajectory`
    dims: tuple[str, ...] = ("time",)  # of a quantity, lanes of a bank aside

    @staticmethod
    def of(system: DrivenModule, run: Trajectory) -> Known:
        """Return what is known of one run."""
        module, p, x, u = system.module, system.parameters, run.states, run.inputs
        values = {
            "outputs": module.outputs(x, u, p),
            "temperatures": module.temperatures(x, p),
            "energy": module.energy(x, p),
            "entropy": module.entropy(x, p),
        }
        start = module.energy(run.start, p), module.entropy(run.start, p)
        return Known(system, x, u, values, start, run.integrals, run.numerical)

    def instants(self) -> Iterator[Named]:
        """Yield what states and inputs at one time decide."""
        module, dims, values = self.system.module, self.dims, self.values
        named = partial(spread, self.system, dims)
        yield from named(module.STATES, self.states)
        if self.inputs is not None:
            yield from named(module.INPUTS, self.inputs)
        yield from named(module.OUTPUTS, values["outputs"], "y_")
        yield from named(module.BODIES, values["temperatures"], "T_")
        yield "energy", (dims, values["energy"], described("J", "energy U"))
        yield "entropy", (dims, values["entropy"], described("J/K", "entropy S"))

    def ledger(self) -> Iterator[Named]:
        """Yield what ports and processes did since the start, and what both balances leave over."""
        module, dims, named = self.system.module, self.dims, partial(spread, self.system, self.dims)
        processes, exchanging = self.system.rows(module.PROCESSES), exchanges(module)
        size, ports = processes[-1].stop if processes else 0, len(module.OUTPUTS)
        ends = np.cumsum([ports, size, size, len(exchanging)])
        supplied, heat, produced, exchanged, _ = np.split(self.integrals, ends)
        made = np.sum(produced, axis=0) + np.sum(exchanged, axis=0)
        ambients = [module.OUTPUTS[n] for n in exchanging]
        yield from named(module.OUTPUTS, supplied, "supplied_", ("J", "energy put in by"))
        yield from named(module.PROCESSES, heat, "heat_", ("J", "heat released by"))
        yield from named(module.PROCESSES, produced, "produced_", ("J/K", "entropy produced by"))
        yield from named(ambients, exchanged, "entropy_exchanged_", ("J/K", "entropy brought by"))
        if self.numerical is not None:
            about = f"by dissipative starts since t = {self.system.inputs.start:g}"
            heat, produced = self.numerical
            yield "heat_numerical", (dims, heat, described("J", f"heat released {about}"))
            text = f"entropy produced {about}"
            yield "produced_numerical", (dims, produced, described("J/K", text))
            made = made + produced
        energy = self.values["energy"] - self.start[0] - np.sum(supplied, axis=0)
        entropy = self.values["entropy"] - self.start[1] - made
        yield "energy_residual", (dims, energy, described("J", "U - U(0) - energy put in"))
        text = "S - S(0) - entropy produced - entropy exchanged"
        yield "entropy_residual", (dims, entropy, described("J/K", text))


def spread(
    system: DrivenModule,
    dims: tuple[str, ...],
    records: Sequence[Record],
    values: FloatArray,
    prefix: str = "",
    integral: tuple[str, str] | None = None,
) -> Iterator[Named]:
    """Yield the rows of `values` (rows, *dims) by record; `integral`: its unit and text."""
    for record, part in zip(records, system.rows(records), strict=True):
        attrs = described(record.unit, record.doc or record.name)
        if integral:
            text = f"{integral[1]} {quote(record.name)} since t = {system.inputs.start:g}"
            attrs = described(integral[0], text)
        found = np.moveaxis(values[part], 0, -1) if record.bank else values[part.start]
        over = (*dims, record.bank) if record.bank else dims
        yield f"{prefix}{record.name}", (over, found, attrs)


def to_dataset(
    system: DrivenModule,
    times: FloatArray,
    trajectory: Trajectory,
    attrs: Mapping[str, Any],
    asked: Iterable[Named] = (),
) -> xarray.Dataset:
    """Return a run as a Dataset; `attrs` are added to its own, `asked` to its quantities."""
    import xarray

    known = Known.of(system, trajectory)
    coords = dict(coordinates(system, times))
    data: dict[str, xarray.Variable] = {}
    for name, variable in (*known.instants(), *known.ledger(), *asked):
        if name in data or name in coords:
            what = f"two quantities are named '{name}'"
            raise UsageError(what, f"model '{system.module.NAME}'", remedy="rename one in the spec")
        data[name] = xarray.Variable(*variable, fastpath=True)  # else xarray imports all of Dask
    return xarray.Dataset(data, coords, model_attrs(system) | dict(attrs))


def model_attrs(system: DrivenModule) -> dict[str, Any]:
    """Return the attributes that say what was run: the model and the parameters used."""
    used = vars(system.parameters).items()
    parameters = {f"parameter_{name}": np.asarray(value)[()] for name, value in used}
    module = system.module
    told = {"model": module.NAME, "spec_sha256": module.SPEC_SHA256, "proofs": verdict_of(module)}
    return {**told, **parameters}


def coordinates(system: DrivenModule, times: FloatArray) -> Iterator[Named]:
    """Yield the time and the lanes of each bank.

    As pandas indexes: xarray makes them of arrays only after trying to import pint.
    """
    import pandas

    yield "time", (("time",), pandas.Index(times), described("s", "time"))
    for bank in system.module.BANKS:
        numbers = pandas.RangeIndex(1, lanes(system.parameters, bank) + 1)
        yield bank, ((bank,), numbers, described("1", f"lane of bank '{bank}'"))


def described(unit: str, long_name: str) -> dict[str, Any]:
    """Return the attributes of a variable."""
    return {"units": unit, "long_name": long_name}


def read_outputs(module: GeneratedModule, outputs: object) -> tuple[str, ...]:
    """Return the quantities that are asked for, in the module's order; raise `UsageError`."""
    names = tuple(record.name for record in module.ELEMENTS)
    if outputs is None:
        return ()
    if outputs == EVERY:
        return names
    if not is_vector(outputs):
        expected = f"'{EVERY}', or a list of elements and quantities such as 'damper.heat'"
        raise UsageError(f"{quote(outputs)} is no list of names", OUTPUTS, expected)
    wanted = set[str]()
    for asked in outputs:  # type: ignore[attr-defined]  # a vector
        found = [name for name in names if asked in (name, name.rpartition(".")[0])]
        if not found:
            raise UsageError(f"unknown name {quote(asked)}", OUTPUTS, remedy=_remedy(asked, names))
        wanted.update(found)
    return tuple(name for name in names if name in wanted)


def _remedy(asked: object, names: tuple[str, ...]) -> str:
    element = str(asked).rpartition(".")[0]
    own = [name.rpartition(".")[2] for name in names if name.rpartition(".")[0] == element]
    if own:
        return f"'{element}' has {listing(own)}"
    return nearest(str(asked), (*dict.fromkeys(name.rpartition(".")[0] for name in names), *names))


def element_variables(
    system: DrivenModule, run: Trajectory, names: tuple[str, ...]
) -> Iterator[Named]:
    """Yield the quantities of elements over a run that have these names."""
    if names:
        module = system.module
        values = module.elements(run.states, run.inputs, system.parameters)
        for name, variable in spread(system, ("time",), module.ELEMENTS, values):
            if name in names:
                yield name, variable
