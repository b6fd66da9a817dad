"""`sweep`: many runs of a model in one call; the table of contents of this stage.

Input: a model, the quantities to sweep and their values, and the arguments of a run.  Output: one
`xarray.Dataset` over the swept dimensions.

    read_plan -> Plan -> boxes, each a Plan -> run_box, in parallel -> Results -> Dataset
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from concurrent.futures import Executor
from contextlib import ExitStack, closing
from dataclasses import replace
from functools import partial
from inspect import signature
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import xarray
from numpy.typing import ArrayLike

from piezo_sym.errors import UsageError, nearest, quote
from piezo_sym.files import path_of
from piezo_sym.modules import module_of
from piezo_sym.progress import progress_of
from piezo_sym.run.checks import checked_call, integer
from piezo_sym.run.inputs import InputValue, warn_given
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.parameters import LaneValue
from piezo_sym.run.simulate import simulate
from piezo_sym.spec.starts import warn_parted
from piezo_sym.sweeps.frame import NOT_RUN, Memory, Results, frame_of
from piezo_sym.sweeps.plan import Plan, Reduction, read_plan
from piezo_sym.sweeps.pool import SENT_AT_ONCE, Submit, processors, results, sender, threads_for

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model


class SweepWarning(UserWarning):
    """Some runs of a sweep failed; the Dataset says which and why."""


@partial(checked_call, name="sweep")
def sweep(
    model: str | Path | Model,
    *,
    over: Mapping[Any, Any],
    inputs: Mapping[str, InputValue] | None = None,
    duration: float,
    rtol: float | None = None,
    step: float | None = None,
    order: int | None = None,
    parameters: Mapping[str, LaneValue] | None = None,
    initial: Mapping[str, LaneValue] | None = None,
    method: str | None = None,
    times: int | ArrayLike | None = None,
    reduce: Reduction | None = None,
    reduce_by: Literal["run", "chunk"] = "run",
    executor: Executor | None = None,
    threads: int | None = None,
    store: str | Path | None = None,
    progress: object = None,
    **others: object,
) -> xarray.Dataset:
    """Run a model over a grid of parameters, sizes, inputs and initial values.

    Runs with equal inputs and sizes take one call of C, and boxes of them run in parallel. A run
    that fails is nan, with the reason in `error`; the others are not affected.

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`.
    over : name -> list or array of values; each is a dimension, and their product is run. Names
        are those of parameters, `<bank>_count`, inputs, states and `T_<body>` (both at t = 0);
        where two quantities share one, write "parameters.x", "inputs.x" or "initial.x". Values are
        as for `simulate`, SI units; if one is a list of one value per lane, texts label all.
        A mapping of labels (numbers or texts) to values gives the dimension these labels. A tuple
        of names -> a list of tuples, or an array (points, names): zipped values, one dimension
        "L_T_e", with coordinates L and T_e along it.
    inputs, duration, rtol, step, order, parameters, initial, times : of all runs, as for
        `simulate`: 1001 samples when `times` is left out, each of which costs steps of its own;
        with `reduce="last"` and a tolerance the end alone.
    method : as for `simulate`; discrete_gradient when left out, and without a compiler LSODA.
    reduce : "last", the values at the last sample; "mean", the mean over time (by trapezoids); or a
        function of a run's Dataset (as of `simulate`, swept values as coordinates; that of an
        input or of another name in use is `over_<name>`) that gives a Dataset, a DataArray, a
        number, or a mapping of names to these. Trajectories are then not kept.
    reduce_by : "run", the function takes one run; "chunk", it takes many at once, over the
        dimension `member`, which its results keep: faster by far.
    executor : any `concurrent.futures.Executor`, such as `client.get_executor()` of Dask, instead
        of threads. To send functions to other processes, install cloudpickle.
    threads : their number; that of the processors when left out. With 1, the caller's runs all.
    store : the path of a Zarr store (`pip install piezo_sym[store]`), written box by box. The same
        call continues where it was stopped; another one is refused. `xarray.open_zarr` opens it.
    progress : whether to show a bar, or a function of (done, total); None: a bar on a terminal.

    Returns
    -------
    xarray.Dataset
        The quantities of `simulate`, over (swept dimensions, `time`, [bank]); a swept input is
        `u_<input>`, over its own dimension, and others have none. The dimension of a swept
        start is `initial_<state>` or `initial_T_<body>`. Banks with fewer lanes than the largest
        are padded with nan. `error`: "" where a run succeeds.

    Raises
    ------
    UsageError : an argument is wrong; before anything runs.
    FileError : the store cannot be used.
    RunError : a process of the executor died.
    KeyboardInterrupt : its `partial` is the Dataset so far; `error` of other runs is "not run".

    Warns
    -----
    SweepWarning : runs failed.

    Examples
    --------
    >>> from piezo_sym import sine, sweep
    >>> drive = {f: sine(100, f) for f in (50.0, 100.0)}
    >>> found = sweep("piezo_stack", over={"V_in": drive, "L": [5e-4, 1e-3, 5e-3]}, duration=0.02)
    >>> dict(found.q.sizes)
    {'V_in': 2, 'L': 3, 'time': 1001}
    """
    refuse_others(others)
    count = processors() if threads is None else integer(threads, "sweep.threads", 1)
    refuse_executor(executor, threads)
    module: Any = module_of(model)
    runs = (inputs, duration, rtol, step, order, parameters, initial, method, times)
    plan = read_plan(module, over, runs, reduce, reduce_by)
    swept = (target.name for _, target in plan.swept() if target.kind == "initial")
    warn_parted(model, module, {**plan.initial, **dict.fromkeys(swept)})
    warn_given(module, inputs)
    plan, sink = sink_of(plan, module, store, count)
    with ExitStack() as stack:
        if executor is None:
            submit, at_once = stack.enter_context(threads_for(plan, module, count))
        else:
            submit, at_once = sender(plan, module, model, executor), SENT_AT_ONCE
        run_missing(sink, submit, at_once, progress, plan.size)
    dataset = sink.dataset()
    warn(dataset, plan)
    return dataset


def run_missing(sink: Results, submit: Submit, at_once: int, progress: object, total: int) -> None:
    """Run the boxes that are missing, and store the results as they are completed."""
    boxes = list(sink.missing())
    done = total - sum(prod(part.stop - part.start for part in box) for box in boxes)
    bar = progress_of(progress, total, "sweep", "sweep.progress")
    try:
        with bar as tell, closing(results(submit, boxes, at_once)) as completed:
            for region, result in completed:
                sink.take(region, result)
                done += result.errors.size
                tell(done, total)
    except KeyboardInterrupt:
        raise interrupted(sink.dataset()) from None


def interrupted(partial: xarray.Dataset) -> KeyboardInterrupt:
    """Return the interrupt of a sweep that has these results."""
    errors = partial["error"].values
    text = f"{np.sum(errors != NOT_RUN)} of {errors.size} runs are done: .partial of this exception"
    stopped = KeyboardInterrupt(f"{text}; with store=... the same call goes on from them")
    vars(stopped)["partial"] = partial
    return stopped


def refuse_others(others: Iterable[str]) -> None:
    """Raise `UsageError` for arguments that a sweep does not take, such as events of its runs."""
    for name in others:
        if name in signature(simulate).parameters:
            remedy = "leave it out, or call simulate() for each run"
            raise UsageError(f"runs of a sweep have no {name}", f"sweep.{name}", remedy=remedy)
        known = [word for word in signature(sweep).parameters if word != "others"]
        raise UsageError(f"unknown argument {quote(name)}", "sweep", remedy=nearest(name, known))


def refuse_executor(executor: object, threads: object) -> None:
    """Raise `UsageError` if `executor` is not one, or threads are given, too."""
    if executor is None:
        return
    if threads is not None:
        raise UsageError("executor and threads are both given", "sweep.threads", "one of them")
    if not callable(getattr(executor, "submit", None)):
        expected = "an executor of concurrent.futures"
        raise UsageError(f"{quote(executor)} has no 'submit'", "sweep.executor", expected)


def sink_of(
    plan: Plan, module: GeneratedModule, store: str | Path | None, threads: int
) -> tuple[Plan, Results]:
    """Return the plan with the size of its boxes, and what collects their results."""
    frame = frame_of(plan, module)
    plan = replace(plan, most=max(1, min(plan.most, -(-plan.size // (2 * threads)))))
    if store is None:
        return plan, Memory(plan, frame)
    from piezo_sym.sweeps.store import store_at

    return store_at(path_of(store, "sweep.store"), plan, frame, module.SPEC_SHA256)


def warn(dataset: xarray.Dataset, plan: Plan) -> None:
    """Warn in one line if runs failed."""
    errors = dataset["error"].values.ravel()
    failed = np.flatnonzero(errors != "")
    if failed.size:
        many = f"{failed.size} of {plan.size} runs failed, see 'error'; the first: "
        warnings.warn(f"{many}{errors[failed[0]]}", SweepWarning, stacklevel=4)
