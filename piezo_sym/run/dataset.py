"""The Dataset of a run: every quantity at its samples and the ledger, by name, with units.

Input: a `DrivenModule`, the sample times (nt,), a `Trajectory`.  Output: an `xarray.Dataset` with
coordinate `time` [s] and, for each bank, its lanes 1..r.  Sweeps use the same functions.

    supplied_port(t) = int_0^t y u dt
    heat_k(t) = int_0^t W_k z_k dt        produced_k(t) = int_0^t W_k z_k/T dt
    entropy_exchanged_a(t) = int_0^t lam (T_e - T)/T dt
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from math import inf, nan
from typing import TYPE_CHECKING, Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.errors import UsageError, quote
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.module import (
    Record,
    heat_exchanges,
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
#: A quantity without its numbers: name, dimensions, shape, attributes.
Field: TypeAlias = tuple[str, tuple[str, ...], tuple[int, ...], tuple[tuple[str, Any], ...]]
#: Datasets of at most so many samples are kept to be copied.
MOST_KEPT = 10_000
#: How the heat of a conduction is described: no heat is released, and it may be negative.
CONDUCTED = "heat conducted"


@final
@dataclass(frozen=True)
class Trajectory:
    """A run at its sample times (nt,), nan at those it has not reached, and its work."""

    start: FloatArray  # (n,): the state at t = 0
    states: FloatArray  # (n, nt)
    inputs: FloatArray  # (m, nt)
    #: (ports + 2 processes + exchanges, nt): supplied, heat, produced, exchanged
    integrals: FloatArray
    steps: int = 0
    evaluations: int = 0
    halvings: int = 0
    numerical: FloatArray | None = None  # (2, nt): heat and entropy produced by dissipative starts

    @staticmethod
    def blank(system: DrivenModule, start: FloatArray, samples: int) -> Trajectory:
        """Return a run that has reached no sample."""
        module = system.module
        processes = row_count(module.PROCESSES, system.parameters)
        sums = len(module.OUTPUTS) + 2 * processes + len(heat_exchanges(module))
        rows = start.size, len(module.INPUTS), sums
        states, inputs, integrals = (np.full((size, samples), np.nan) for size in rows)
        return Trajectory(start, states, inputs, integrals)

    def at(self, places: NDArray[np.intp]) -> Trajectory:
        """Return the run at the samples with these numbers (k,)."""
        return replace(
            self,
            states=self.states[:, places],
            inputs=self.inputs[:, places],
            integrals=self.integrals[:, places],
            numerical=None if self.numerical is None else self.numerical[:, places],
        )

    def reached(self, times: FloatArray) -> tuple[FloatArray, Trajectory]:
        """Return the times and the run at the samples reached."""
        missing = np.isnan(self.states).any(axis=0)
        count = int(np.argmax(missing)) if missing.any() else missing.size
        return times[:count], self.at(np.arange(count))

    def later(self, times: FloatArray, t: float, since: float) -> tuple[FloatArray, Trajectory]:
        """Return the times and the run at its samples behind the time `since` and up to t [s]."""
        rows = np.arange(*np.searchsorted(times, [since, t], side="right").tolist())
        return self.at(rows).reached(times[rows])

    def until(self, times: FloatArray, t: float, last: Trajectory) -> tuple[FloatArray, Trajectory]:
        """Return the times and the run at the samples reached, and at `last`, if t [s] is later."""
        times, run = self.reached(times)
        if not self.steps or t <= max(times, default=-inf):
            return times, run
        over_time = [name for name, values in vars(run).items() if np.ndim(values) == 2]
        joined: dict[str, Any] = {
            name: np.hstack([getattr(run, name), getattr(last, name)]) for name in over_time
        }
        return np.append(times, t), replace(run, **joined)


@final
@dataclass(frozen=True)
class Evaluation:
    """The values of a run, or of runs of equal sizes, at samples: arrays (rows, [runs], nt)."""

    system: DrivenModule
    states: FloatArray
    inputs: FloatArray | None  # None to leave them out of the quantities
    values: Mapping[str, FloatArray]  # of the module's functions; energies have no rows
    start: tuple[FloatArray, FloatArray]  # energy and entropy at t = 0; of many runs (runs, 1)
    integrals: FloatArray
    numerical: FloatArray | None = None  # as in `Trajectory`
    dims: tuple[str, ...] = ("time",)  # of a quantity, without the lanes of its bank

    @staticmethod
    def of(system: DrivenModule, run: Trajectory) -> Evaluation:
        """Evaluate one run."""
        module, p, x, u = system.module, system.parameters, run.states, run.inputs
        values = {
            "outputs": module.outputs(x, u, p),
            "temperatures": module.temperatures(x, p),
            "energy": module.energy(x, p),
            "entropy": module.entropy(x, p),
        }
        start = module.energy(run.start, p), module.entropy(run.start, p)
        return Evaluation(system, x, u, values, start, run.integrals, run.numerical)

    def instants(self) -> Iterator[Named]:
        """Yield the quantities that are functions of state and inputs."""
        module, dims, values = self.system.module, self.dims, self.values
        named = partial(named_rows, self.system, dims)
        yield from named(module.STATES, self.states)
        if self.inputs is not None:
            yield from named(module.INPUTS, self.inputs)
        yield from named(module.OUTPUTS, values["outputs"], "y_")
        yield from named(module.BODIES, values["temperatures"], "T_")
        yield "energy", (dims, values["energy"], attributes("J", "energy U"))
        yield "entropy", (dims, values["entropy"], attributes("J/K", "entropy S"))

    def ledger(self) -> Iterator[Named]:
        """Yield integrals over ports and processes since the start; residuals of both balances."""
        system, dims = self.system, self.dims
        module, named = system.module, partial(named_rows, system, dims)
        size, exchanging = row_count(module.PROCESSES, system.parameters), heat_exchanges(module)
        ends = np.cumsum([len(module.OUTPUTS), size, size, len(exchanging)])
        supplied, heat, produced, exchanged, _ = np.split(self.integrals, ends)
        gained = np.sum(produced, axis=0) + np.sum(exchanged, axis=0)
        ambients = [module.OUTPUTS[n] for n in exchanging]
        yield from named(module.OUTPUTS, supplied, "supplied_", ("J", "energy put in by"))
        yield from named(module.PROCESSES, heat, "heat_", ("J", "heat released by"))
        yield from named(module.PROCESSES, produced, "produced_", ("J/K", "entropy produced by"))
        yield from named(ambients, exchanged, "entropy_exchanged_", ("J/K", "entropy brought by"))
        if self.numerical is not None:
            about = f"by dissipative starts since t = {system.inputs.start:g}"
            heat, produced = self.numerical
            yield "heat_numerical", (dims, heat, attributes("J", f"heat released {about}"))
            text = f"entropy produced {about}"
            yield "produced_numerical", (dims, produced, attributes("J/K", text))
            gained = gained + produced
        energy = self.values["energy"] - self.start[0] - np.sum(supplied, axis=0)
        entropy = self.values["entropy"] - self.start[1] - gained
        yield "energy_residual", (dims, energy, attributes("J", "U - U(0) - energy put in"))
        text = "S - S(0) - entropy produced - entropy exchanged"
        yield "entropy_residual", (dims, entropy, attributes("J/K", text))


def named_rows(
    system: DrivenModule,
    dims: tuple[str, ...],
    records: Sequence[Record],
    values: FloatArray,
    prefix: str = "",
    integral: tuple[str, str] | None = None,
) -> Iterator[Named]:
    """Yield a variable per record from `values` (rows, *dims).

    `integral` is the unit and the description of integrals, which replace those of the records.
    """
    for record, row in zip(records, system.rows(records), strict=True):
        attrs = attributes(record.unit, record.doc or record.name)
        if integral:
            text = f"{integral[1]} {quote(record.name)}"
            if prefix == "heat_" and record.doc.startswith("conduction "):
                text = f"{CONDUCTED} by {quote(record.name)} from its first body to its second"
            attrs = attributes(integral[0], f"{text} since t = {system.inputs.start:g}")
        array = np.moveaxis(values[row], 0, -1) if record.bank else values[row.start]
        over = (*dims, record.bank) if record.bank else dims
        yield f"{prefix}{record.name}", (over, array, attrs)


def to_dataset(
    system: DrivenModule,
    times: FloatArray,
    trajectory: Trajectory,
    attrs: Mapping[str, Any],
    more: Iterable[Named] = (),
) -> xarray.Dataset:
    """Return a run as a Dataset, with these attributes and quantities beside its own."""
    evaluation, module = Evaluation.of(system, trajectory), system.module
    arrays: dict[str, Any] = {}
    fields = list[Field]()
    for name, (dims, array, about) in (*evaluation.instants(), *evaluation.ledger(), *more):
        if name in arrays or name in {"time", *module.BANKS}:
            what = f"two quantities are named '{name}'"
            raise UsageError(what, f"model '{module.NAME}'", remedy="rename one in the spec")
        arrays[name] = array
        fields.append((name, dims, array.shape, tuple(about.items())))
    make = blank if times.size <= MOST_KEPT else blank.__wrapped__
    made = make(tuple(fields), times.tobytes(), lane_counts(system)).copy(data=arrays)
    made.attrs |= model_attrs(system) | dict(attrs)
    return made


@lru_cache(maxsize=8)
def blank(
    fields: tuple[Field, ...], times: bytes, counts: tuple[tuple[str, int], ...]
) -> xarray.Dataset:
    """Return a Dataset without numbers: runs in a loop differ in those alone, and copy it."""
    import xarray

    data = {
        name: xarray.Variable(dims, np.broadcast_to(nan, shape), dict(about), fastpath=True)
        for name, dims, shape, about in fields
    }  # from tuples, xarray would import all of Dask
    return xarray.Dataset(data, dict(coordinates(counts, np.frombuffer(times).copy())))


def model_attrs(system: DrivenModule) -> dict[str, Any]:
    """Return the attributes that name the model and its parameters."""
    module, used = system.module, vars(system.parameters).items()
    model = {"model": module.NAME, "spec_sha256": module.SPEC_SHA256, "proofs": verdict_of(module)}
    plain = {n: np.asarray(v) if isinstance(v, tuple) else v for n, v in used}
    return model | {f"parameter_{name}": value for name, value in plain.items()}


def lane_counts(system: DrivenModule) -> tuple[tuple[str, int], ...]:
    """Return the banks of a model, each with the number of its lanes."""
    return tuple((bank, lanes(system.parameters, bank)) for bank in system.module.BANKS)


def coordinates(counts: Iterable[tuple[str, int]], times: FloatArray) -> Iterator[Named]:
    """Yield the time and the lanes of each bank, as pandas indexes.

    From arrays, xarray would make these itself, but only after an attempt to import pint.
    """
    import pandas

    yield "time", (("time",), pandas.Index(times), attributes("s", "time"))
    for bank, count in counts:
        numbers = pandas.RangeIndex(1, count + 1)
        yield bank, ((bank,), numbers, attributes("1", f"lane of bank '{bank}'"))


def attributes(unit: str, long_name: str) -> dict[str, Any]:
    """Return the attributes of a variable."""
    return {"units": unit, "long_name": long_name}
