"""Concurrent runs of boxes: in threads, or by any executor of `concurrent.futures`.

Input: boxes, and a function that submits one.  Output: results as they are completed; those that
complete together in the order of the boxes.  Few boxes are submitted at once, so that results do
not accumulate.
"""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, TypeAlias

from piezo_sym.errors import RunError, UsageError, legible
from piezo_sym.modules import module_of
from piezo_sym.run.module import GeneratedModule
from piezo_sym.sweeps.plan import Plan, Region
from piezo_sym.sweeps.run import Result, run_box

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model

Submit: TypeAlias = "Callable[[Region], Future[Result]]"

#: Tasks submitted at once to a user's executor, which may have many workers.
SENT_AT_ONCE = 256


class Stopped(Exception):
    """The sweep was stopped: ends the work of its threads, and does not reach the caller."""


@contextmanager
def threads_for(plan: Plan, module: GeneratedModule, count: int) -> Iterator[tuple[Submit, int]]:
    """Yield a function that submits a box to threads, and how many boxes to submit at once.

    The threads end soon after the context does. With `count` 1 the caller's thread runs the boxes,
    so that a debugger stops in a user's function.
    """
    if count == 1:
        yield lambda region: at_hand(run_box(plan.part(region), module, ignore)), 1
        return
    stop = Event()

    def watch(_: float) -> None:
        if stop.is_set():
            raise Stopped

    pool = ThreadPoolExecutor(count, "sweep")
    try:
        yield lambda region: pool.submit(run_box, plan.part(region), module, watch), 2 * count
    finally:
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)


def at_hand(result: Result) -> Future[Result]:
    """Return a completed future."""
    future: Future[Result] = Future()
    future.set_result(result)
    return future


def sender(
    plan: Plan, module: GeneratedModule, model: str | Path | Model, executor: Executor
) -> Submit:
    """Return a function that submits a box to a user's executor, pickled unless it has threads."""
    if isinstance(executor, ThreadPoolExecutor):
        return lambda region: executor.submit(run_box, plan.part(region), module, ignore)
    from piezo_sym.spec.load import load

    loaded = load(model) if isinstance(model, str | Path) else model
    return lambda region: executor.submit(run_pickled, pickled(plan.part(region), loaded))


def pickled(plan: Plan, model: Model) -> bytes:
    """Return the plan of a box and its model as bytes, functions by value if possible."""
    try:
        import cloudpickle as pickler
    except ImportError:
        pickler = pickle
    try:
        return bytes(pickler.dumps((plan, model)))
    except Exception as cause:  # pickling runs the code of a user's objects
        what = f"a function or value cannot be sent to another process: {legible(str(cause))}"
        remedy = "define functions in a module of their own, or `pip install cloudpickle`"
        raise UsageError(what, "sweep.executor", remedy=remedy) from cause


def run_pickled(box: bytes) -> Result:
    """Run a box in another process, with the module loaded or generated there."""
    plan, model = pickle.loads(box)
    return run_box(plan, module_of(model), ignore)


def ignore(_: float) -> None:
    """Do nothing; the watch of runs that are not stopped."""


def results(
    submit: Submit, boxes: Iterable[Region], at_once: int
) -> Generator[tuple[Region, Result], None, None]:
    """Yield boxes and results as they are completed; if the caller stops, cancel the others."""
    pending: dict[Future[Result], Region] = {}
    try:
        for box in boxes:
            pending[submit(box)] = box
            if len(pending) >= at_once:
                yield from completed(pending)
        while pending:
            yield from completed(pending)
    except BrokenExecutor as cause:
        what = f"a process of the executor died: {legible(str(cause))}"
        remedy = "with store=..., start again: what is done is kept"
        raise RunError(what, "sweep.executor", remedy=remedy) from cause
    finally:
        for future in pending:
            future.cancel()


def completed(pending: dict[Future[Result], Region]) -> Iterator[tuple[Region, Result]]:
    """Wait, then remove completed boxes and yield their results, in the order submitted."""
    running = wait(pending, return_when=FIRST_COMPLETED).not_done
    done = [(f, pending.pop(f)) for f in reversed(list(pending)) if f not in running]
    while done:  # frees each result before the next is requested
        future, box = done.pop()
        yield box, future.result()


def processors() -> int:
    """Return how many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
