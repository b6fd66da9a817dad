"""`simulate`: run a generated module; the table of contents of this stage.

Input: a generated module, and a user's inputs, parameters, initial state and times.  Output: an
`xarray.Dataset`.

    dx/dt = rhs(x, u(t), p)    U(t) - U(0) = sum over ports of int_0^t y u dt
                               S(t) - S(0) = entropy produced + entropy exchanged
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from math import inf
from os import PathLike
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from piezo_sym.errors import UsageError, quote
from piezo_sym.run.checks import number, positive
from piezo_sym.run.collocation import METHOD, FixedStep, read_order, stages_for
from piezo_sym.run.guard import SLACK
from piezo_sym.run.inputs import InputValue, warn_undriven
from piezo_sym.run.method import checked_method, choose_method
from piezo_sym.run.module import GeneratedModule, checked
from piezo_sym.run.parameters import LaneValue, read_parameters, sample_times, start_of
from piezo_sym.run.planned import Request
from piezo_sym.run.streaming import check_memory, streamed
from piezo_sym.run.watched import read_outputs, read_watched

if TYPE_CHECKING:
    import xarray

RTOL = 1e-5
#: The least duration of a run, as a fraction of its start time: a double has 16 digits.
RESOLVED = 1e-11
#: The longest run [s], over the age of the universe: steps of longer ones lose all digits.
LONGEST = 1e18
RTOL_LEAST, RTOL_MOST = 1e-13, 0.1


def simulate(
    module: GeneratedModule,
    *,
    inputs: Mapping[str, InputValue] | None = None,
    duration: float,
    rtol: float | None = None,
    step: float | None = None,
    order: int | None = None,
    parameters: Mapping[str, LaneValue] | None = None,
    initial: Mapping[str, LaneValue] | xarray.Dataset | None = None,
    t0: float | None = None,
    method: str | None = None,
    times: int | ArrayLike | None = None,
    events: Mapping[str, str] | None = None,
    stop: str | None = None,
    outputs: str | Sequence[str] | None = None,
    store: str | PathLike[str] | None = None,
    dissipative_start: bool = False,
    progress: bool | Callable[[float], object] | None = None,
) -> xarray.Dataset:
    """Run a model from `t0` and return all its quantities over time.

    The method is the discrete gradient, compiled, unless another is named. Both its balances close
    to round-off at every sample, for the states returned. With `rtol` it is Gauss collocation with
    mean co-states over each step, of order eight or twelve: the largest error of a run is about
    rtol times each state's largest magnitude (of a bank: of any lane). Where there are stores and
    bodies, but no `stop`, the equations of a step are solved to about rtol/20; the energy that is
    left of them goes to the first body, and the heat of every process is scaled by one factor
    within 1e-4 of 1, so that both balances are exact. Other steps, and those that this factor would
    not do for, are solved to round-off. Steps end where a law has a kink or a jump, or go over
    kinks where many lanes have some and rtol is 1e-6 or more. Errors add up where nothing damps
    them: after hundreds of periods an oscillation is off in phase by more than rtol; and motions
    much faster than the steps may keep, after a jump, errors of some tens of rtol. A sample is the
    end of a step of its own, so other `times` change no value at the times that both have, except
    where heat or entropy produced would decrease between samples. With `step` the order of the
    error is `order`, where laws and inputs are smooth; steps go over kinks; and motions much faster
    than a step ring from step to step after a jump: see `dissipative_start`.

    SciPy's methods hold the error of each step below rtol*|x| + atol. atol is rtol*1e-3 times the
    scale of the state: its largest magnitude (for a bank: that of any lane) in a coarse first run
    with rtol 1e-3, but at least 1e-15; of a coarse run that stops early, the first nine tenths
    count.

    Steps end at every jump or corner of an input (of samples: if they are at most 1000). With rtol,
    no step is longer than a quarter of the run, half a period of a sine or chirp (SciPy's methods:
    an eighth), an eighth of a period of a triangle, the median distance of more than 1000 samples,
    or 1/500 of the run where an input is a function. A function is called some thousand times
    before the run, with arrays if it takes them, to find its jumps and to approximate it by
    polynomials. A pulse shorter than 1/2000 of the run is seen only by chance: give a signal, or
    (t, values).

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`; here, of
        `piezo_sym.run`, a generated module.
    inputs : name -> number, (t, values) joined by straight lines, function of t [s], or signal;
        SI units. Those left out keep the module's defaults.
    duration : length of the run [s].
    rtol : relative tolerance, 1e-13 to 0.1; 1e-5 when left out. The discrete gradient takes less
        than 1e-12 as 1e-12: errors below are round-off.
    step : a fixed step [s] instead of rtol, for the discrete gradient alone. Steps end at samples,
        at breaks of inputs and at the end of the run; between two of these they are equal, and
        no longer than this.
    order : 2, 4, 6, 8, 10 or 12, with `step` alone; 2 when left out.
    parameters : name -> number, for a bank's parameter also a list of one number per lane; and
        `<bank>_count` -> number of lanes. SI units.
    initial : state -> number, for a bank's state also a list of one number per lane, SI units; a
        body's temperature may stand for its entropy: {"T_body": 320.0}. Those left out keep the
        module's initial state. Stores that are joined have one state, the sum of theirs, with the
        ratios of what is between them: `show` says which. Or a Dataset
        of this model, or an instant of one, ``run.isel(time=-1)``: the run goes on from its last
        state, with its parameters but for those given; integrals begin at 0 again, and inputs are
        given anew: an `InputWarning` names those of the run that are left out.
    t0 : the time at which the run starts [s]; when left out, 0, or the last time of a Dataset.
    method : discrete_gradient when left out, or one of SciPy's: RK23, RK45, DOP853, Radau, BDF,
        LSODA. Left out, a module without C beside it runs by LSODA; and so does one whose C cannot
        be compiled here, with one `EngineWarning`.
    times : the samples: a number of even ones, or increasing times [s]. When left out, 1001 even
        ones; with `step`, as many ends of steps, equally far apart, as 1001 allow, and the end.
    events : name -> expression, such as ``{"hit": "q - 1e-3"}``: the times at which it changes its
        sign, to round-off, are the coordinate of that name, and `<quantity>_at_<name>` are the
        states, inputs, outputs and temperatures there. Expressions are texts in the language of
        laws, of states (a lane as ``phi_1``), inputs, `y_<port>`, `T_<body>`, parameters and what
        `outputs` names (of a bank ``hysteron.effort_1``), in SI.
        They are evaluated at the samples and four times per step: two changes between neighbouring
        times are not seen. A warning says where a run has too many steps for that. Not with `step`.
    stop : a comparison, such as ``"T_body > 350"``: the run ends when it first holds, with a sample
        there; the attribute `stopped` says when. The samples are those of `times` until then, so
        give more of them where `duration` is much longer than what you expect.
    outputs : "all", a name, or a list such as ``["spring", "damper.heat"]``: of elements, beside
        the rest, named ``<element>.effort``, `.flow`, `.power` (into the element: of a source, the
        negative of what it supplies), `.energy` of what stores and `.heat` of what dissipates it.
        Couplings have `.effort_1` ... `.flow_2`, and the power from branch 1 to 2; a storage,
        `.effort_<state>`.
    store : a path, ``"run.zarr"``: the run is written to a new Zarr store, window after window, and
        the Dataset reads from there on demand; events are written at the end. Steps end where
        windows of some 100,000 samples do. Needs `piezo_sym[store]`.
    progress : a function, called with the time [s] reached every few milliseconds; True, for a bar.
    dissipative_start : for discrete_gradient with `step`. The first step after t = 0, and after
        each jump of an input, is made of four quarters that damp motions faster than they are,
        which would ring from step to step for a long time. The energy lost heats the first
        thermal_mass, `heat_numerical` and `produced_numerical`; both balances stay exact. It helps
        where steps are longer than the fastest time constant, and harms where they are not: on
        piezo_stack, 2 ms after V_in jumps to 100 V, steps of 0.2 ms are off by 1.3e-4 instead of
        1.1e-2 of the states' sizes; steps of 5 us by 4e-6 instead of 7e-7.

    Returns
    -------
    xarray.Dataset
        Over `time` (nt,), and for banks (nt, lanes): states, inputs, `y_<port>`, `T_<body>`,
        `energy`, `entropy`; integrals since t = 0 `supplied_<port>`, `heat_<element>` [J] and
        `produced_<element>` [J/K], and `entropy_exchanged_<port>` [J/K], which the surroundings
        bring (of an ambient: lam (T_e/T - 1)); `energy_residual` = U - U(0) - energy put in, and
        `entropy_residual` = S - S(0) - entropy produced - entropy exchanged: round-off with the
        discrete gradient, the error of solver and quadrature with SciPy's. At a jump, inputs
        have their value after it, but at the end of the run their value before it. Attributes:
        `units` of each quantity; `model`, `parameter_<name>`, `method`, `rtol` or `step`, `order`,
        `engine` (its compiler, or why there is none), the work (`accepted_steps`,
        `newton_iterations`, `halvings`: refused steps; of SciPy `rhs_evaluations`).

    Raises
    ------
    UsageError : an argument is unknown, of the wrong kind, or not finite.
    EngineError : `step` or method='discrete_gradient' was asked for, and there is no engine.
    RunError : the state leaves the domain, at t = 0, a sample or an accepted step; or the solver
        cannot go on. The message says when, and with which values; its `partial`, and that of a
        `KeyboardInterrupt`, is the Dataset until then, or until shortly before it stops: its last
        sample, as a rule the end of the last step, is one from which another run can go on; that of
        a `RunError` has the events until then.
    """
    checked(module)
    if progress is not None and not callable(progress):
        expected = "a function of the time in s, or None"
        raise UsageError(f"{quote(progress)} shows no progress", "simulate.progress", expected)
    named, tolerance = checked_method(method), read_rtol(rtol)
    fixed, length = read_step(step, order, named, rtol), positive(duration, "simulate.duration")
    named = read_dissipative_start(dissipative_start, named)
    start, state, given = start_of(module, t0, initial, parameters)
    warn_undriven(module, initial, inputs)
    check_resolved(start, length)
    samples = sample_times(times, step, length, start)
    values, chosen = read_parameters(module, given), choose_method(module, named, step)
    slack = inf if hasattr(initial, "data_vars") and not parameters else SLACK  # SciPy keeps none
    options = dissipative_start, progress, read_outputs(module, outputs), slack
    request = Request(module, values, inputs, chosen, tolerance, fixed, *options)
    if store is not None:
        return streamed(request, start, samples, state, (events, stop), store)
    check_memory(request, samples)
    planned = request.planned(start, length, state)
    return planned.dataset(samples, read_watched(planned.system, events, stop, step))


def check_resolved(start: float, length: float) -> None:
    """Raise `UsageError` if a run is too long, or too short for the 16 digits of its start."""
    if length > LONGEST:
        what = f"{quote(length)} is too long"
        raise UsageError(what, "simulate.duration", f"at most {LONGEST:g} s")
    if not abs(start) * RESOLVED < length:
        what = f"times from t0 = {start:g} s on cannot be told apart in a run of {length:g} s"
        raise UsageError(what, "simulate.t0", remedy="begin nearer to 0")


def stages_of(options: Mapping[str, Any]) -> int | None:
    """Return the stages of a run's steps; None for SciPy's methods, or if options are wrong."""
    method, rtol, step, order = map(options.get, ("method", "rtol", "step", "order"))
    if method not in (None, METHOD):
        return None
    with suppress(UsageError):
        fixed = read_step(step, order, METHOD, rtol)
        return fixed.order // 2 if fixed else stages_for(read_rtol(rtol))[0]
    return None


def read_rtol(rtol: object) -> float:
    """Return the relative tolerance; raise `UsageError` if it is out of range."""
    value = RTOL if rtol is None else number(rtol, "simulate.rtol")
    if not RTOL_LEAST <= value <= RTOL_MOST:
        expected = f"{RTOL_LEAST:g} to {RTOL_MOST:g}"
        what = f"{value:g} is out of range"
        raise UsageError(what, "simulate.rtol", expected)
    return value


def read_step(step: object, order: object, method: str | None, rtol: object) -> FixedStep | None:
    """Return the fixed step, or None; raise `UsageError` where other arguments exclude it."""
    if step is None:
        if order is not None:
            what = "there is no fixed step"
            raise UsageError(what, "simulate.order", "nothing", "leave it out, or give step")
        return None
    if method not in (None, METHOD):
        what = f"method {method} chooses its own steps"
        remedy = "leave out step, for rtol sets the accuracy; or leave out method"
        raise UsageError(what, "simulate.step", "nothing", remedy)
    length = positive(step, "simulate.step")
    if rtol is not None:
        what = "step and rtol are both given"
        raise UsageError(what, "simulate.step", "one of them", "leave out rtol for a fixed step")
    return FixedStep(length, 2 if order is None else read_order(order, "simulate.order"))


def read_dissipative_start(dissipative_start: object, method: str | None) -> str | None:
    """Return the method, which dissipative starts restrict to the discrete gradient."""
    where = "simulate.dissipative_start"
    if not isinstance(dissipative_start, bool):
        raise UsageError(f"{quote(dissipative_start)} is no truth value", where, "True or False")
    if dissipative_start and method not in (None, METHOD):
        what = f"method {method} has no dissipative start"
        raise UsageError(what, where, "False", f"leave it out, or method='{METHOD}'")
    return METHOD if dissipative_start else method
