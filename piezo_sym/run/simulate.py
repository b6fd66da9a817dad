"""`simulate`: run a generated module; the table of contents of this stage.

Input: a generated module, and what the user wrote for inputs, parameters, initial state and times.
Output: an `xarray.Dataset`.

    dx/dt = rhs(x, u(t), p)    U(t) - U(0) = sum over ports of int_0^t y u dt
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from piezo_sym.errors import UsageError
from piezo_sym.run.checks import number, positive
from piezo_sym.run.dataset import to_dataset
from piezo_sym.run.discrete import METHOD, adaptive, fixed
from piezo_sym.run.engine import compiled
from piezo_sym.run.guard import check_start
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.integrate import Tolerance, batches, checked_method
from piezo_sym.run.ledger import record
from piezo_sym.run.module import checked
from piezo_sym.run.parameters import read_initial, read_parameters, read_times
from piezo_sym.run.scales import magnitudes
from piezo_sym.run.system import System

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    import xarray
    from numpy.typing import ArrayLike

    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.discrete import Watch
    from piezo_sym.run.engine import Engine
    from piezo_sym.run.inputs import InputValue
    from piezo_sym.run.integrate import Batch
    from piezo_sym.run.ledger import Trajectory
    from piezo_sym.run.module import GeneratedModule
    from piezo_sym.run.parameters import LaneValue

RTOL = 1e-5
RTOL_LEAST, RTOL_MOST = 1e-13, 0.1
ATOL_FACTOR = 1e-3


def simulate(
    module: GeneratedModule,
    *,
    inputs: Mapping[str, InputValue] | None = None,
    duration: float,
    rtol: float | None = None,
    step: float | None = None,
    parameters: Mapping[str, LaneValue] | None = None,
    initial: Mapping[str, LaneValue] | None = None,
    method: str = "LSODA",
    times: int | ArrayLike | None = None,
) -> xarray.Dataset:
    """Run a generated module from t = 0 and return all its quantities over time.

    The error of each step is held below rtol*|x| + atol. atol is rtol*1e-3 times the scale of
    the state, which is the largest magnitude that the state (for a bank: any of its lanes) has
    in a coarse first run with rtol 1e-3, or 1e-15 if that is larger; a coarse run that stops
    early never fails the run, and counts up to nine tenths of the time it reached. The solver
    starts again at every jump or corner of an input (samples: while they are at most 1000), and
    takes no step longer than an eighth of a period of an input, than the median distance of more
    than 1000 samples, or than 1/500 of the run where an input is a function. A function's own
    jumps are not known to it: give a signal, or (t, values).

    Parameters
    ----------
    module : a generated module.
    inputs : name -> number, (t, values) joined by straight lines, function of t [s], or signal;
        SI units. Those left out keep the module's defaults.
    duration : length of the run [s].
    rtol : relative tolerance, 1e-13 to 0.1; 1e-5 when left out.
    step : a fixed step [s] instead of rtol, for discrete_gradient; of order two.
    parameters : name -> number, for a bank's parameter also a list of one number a lane; and
        `<bank>_count` -> number of lanes. SI units.
    initial : state -> number, for a bank's state also a list of one number a lane. SI units.
        Those left out keep the module's initial state.
    method : RK23, RK45, DOP853, Radau, BDF or LSODA; or discrete_gradient, compiled: both
        balances to round-off, the error of its states below rtol of the largest magnitude of
        each. Without a compiler it warns, and LSODA runs instead.
    times : the samples: a number of even ones (1001 when left out), or increasing times [s].

    Returns
    -------
    xarray.Dataset
        Over `time` (nt,), and for banks (nt, lanes): states, inputs, `y_<port>`, `T_<body>`,
        `energy`, `entropy`; integrals since t = 0 `supplied_<port>`, `heat_<element>` [J] and
        `produced_<element>` [J/K]; `energy_residual` = U - U(0) - energy put in, which is the
        error of solver and quadrature. At a jump, inputs have their value after it, but at the
        end of the run their value before it. Attributes: units, model, method and its work.

    Raises
    ------
    UsageError : an argument is unknown, of the wrong kind, or not finite.
    RunError : the state leaves the domain, at t = 0, a sample or an accepted step; or the solver
        cannot go on. The message says when, and with which values.
    """
    checked(module)
    chosen, bound = checked_method(method), read_rtol(rtol)
    refuse_step(step, chosen, rtol)
    end = positive(duration, "simulate.duration")
    samples = read_times(times, end)
    values = read_parameters(module, parameters)
    system = System(module, values, read_inputs(module, inputs, end))
    x = read_initial(module, values, system.inputs.segments[0].at(0.0), initial)
    check_start(system, x)
    if chosen == METHOD and (engine := compiled(module)):
        trajectory, work = discrete(system, engine, x, samples, bound, step)
        return to_dataset(system, samples, trajectory, work)
    chosen = "LSODA" if chosen == METHOD else chosen
    trajectory, work = by_scipy(system, x, samples, chosen, bound)
    return to_dataset(system, samples, trajectory, work)


def read_rtol(rtol: object) -> float:
    """Return the relative tolerance; raise `UsageError` if SciPy could not honour it."""
    value = RTOL if rtol is None else number(rtol, "simulate.rtol")
    if not RTOL_LEAST <= value <= RTOL_MOST:
        expected = f"{RTOL_LEAST:g} to {RTOL_MOST:g}"
        what = f"{value:g} is out of range"
        raise UsageError(what, "simulate.rtol", expected)
    return value


def refuse_step(step: object, method: str, rtol: object) -> None:
    """Raise `UsageError` if a fixed step was asked of a method that chooses its own."""
    if step is None:
        return
    if method != METHOD:
        what = f"method {method} chooses its own steps"
        remedy = f"leave out step, for rtol sets the accuracy; or method='{METHOD}'"
        raise UsageError(what, "simulate.step", "nothing", remedy)
    positive(step, "simulate.step")
    if rtol is not None:
        what = "step and rtol are both given"
        raise UsageError(what, "simulate.step", "one of them", "leave out rtol for a fixed step")


def discrete(
    system: System,
    engine: Engine,
    x: FloatArray,
    samples: FloatArray,
    rtol: float,
    step: float | None,
) -> tuple[Trajectory, dict[str, object]]:
    """Return a run of the discrete gradient, and what it took."""
    if step is None:
        trajectory = adaptive([system], engine, x[None], samples, rtol).trajectory(0)
        accuracy: dict[str, object] = {
            "rtol": rtol,
            "states": "extrapolated from two runs",
            "ledger": "of the finer run, its balances exact",
        }
    else:
        trajectory = fixed([system], engine, x[None], samples, step).trajectory(0)
        accuracy = {"step": step}
    work = {
        "accepted_steps": trajectory.steps,
        "newton_iterations": trajectory.evaluations,
        "halvings": trajectory.halvings,
    }
    return trajectory, {"method": METHOD, **accuracy, **work}


def by_scipy(
    system: System,
    x: FloatArray,
    samples: FloatArray,
    method: str,
    rtol: float,
    watch: Watch | None = None,
) -> tuple[Trajectory, dict[str, object]]:
    """Return a run of one of SciPy's methods, and what it took; `watch` as in `discrete`."""
    scale, spent = magnitudes(system, x)
    tolerance = Tolerance(method, rtol, rtol * ATOL_FACTOR * scale)
    found = watched(batches(system, x, samples, tolerance), watch)
    trajectory = record(system, x, found, samples)
    work = {
        "method": method,
        "rtol": rtol,
        "accepted_steps": trajectory.steps,
        "rhs_evaluations": trajectory.evaluations,
        "scale_evaluations": spent,
    }
    return trajectory, work


def watched(found: Iterable[Batch], watch: Watch | None) -> Iterator[Batch]:
    """Yield batches, and tell the time that each begins from."""
    for batch in found:
        if watch and batch.stretches:
            watch(batch.stretches[0].start)
        yield batch
