"""Boxes run side by side: in threads, or by any executor of `concurrent.futures`.

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

from piezo_sym.errors import RunError, UsageError, one_line
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
    """The sweep was stopped: raised in its threads to end their work, and never passed on."""


@contextmanager
def threads_for(plan: Plan, module: GeneratedModule, count: int) -> Iterator[tuple[Submit, int]]:
    """Yield a function that submits a box to own threads; they end soon after the context does.

    A single thread is the caller's own, so that a debugger stops in a user's function.
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
    """Return a future that has its result."""
    future: Future[Result] = Future()
    future.set_result(result)
    return future


def sender(
    plan: Plan, module: GeneratedModule, model: str | Path | Model, executor: Executor
) -> Submit:
    """Return what submits a box to a user's executor; threads need nothing sent."""
    if isinstance(executor, ThreadPoolExecutor):
        return lambda region: executor.submit(run_box, plan.part(region), module, ignore)
    from piezo_sym.spec.load import load

    ready = load(model) if isinstance(model, str | Path) else model
    return lambda region: executor.submit(run_sent, packed(plan.part(region), ready))


def packed(plan: Plan, model: Model) -> bytes:
    """Return what a box needs as bytes for another process; functions by value if possible."""
    try:
        import cloudpickle as way
    except ImportError:
        way = pickle
    try:
        return bytes(way.dumps((plan, model)))
    except Exception as cause:  # pickling runs the code of a user's objects
        what = f"a function or value cannot be sent to another process: {one_line(str(cause))}"
        remedy = "define functions in a module of their own, or `pip install cloudpickle`"
        raise UsageError(what, "sweep.executor", remedy=remedy) from cause


def run_sent(sent: bytes) -> Result:
    """Run a box in another process, with the module loaded or generated there."""
    plan, model = pickle.loads(sent)
    return run_box(plan, module_of(model), ignore)


def ignore(_: float) -> None:
    """Do nothing: no one watches these runs."""


def results(
    submit: Submit, boxes: Iterable[Region], at_once: int
) -> Generator[tuple[Region, Result], None, None]:
    """Yield boxes and results as they are completed; if the caller stops, cancel the others."""
    pending: dict[Future[Result], Region] = {}
    try:
        for box in boxes:
            pending[submit(box)] = box
            if len(pending) >= at_once:
                yield from arrivals(pending)
        while pending:
            yield from arrivals(pending)
    except BrokenExecutor as cause:
        what = f"a process of the executor died: {one_line(str(cause))}"
        remedy = "with store=..., start again: what is done is kept"
        raise RunError(what, "sweep.executor", remedy=remedy) from cause
    finally:
        for future in pending:
            future.cancel()


def arrivals(
    pending: dict[Future[Result], Region],
) -> Generator[tuple[Region, Result], None, None]:
    """Wait, and yield what is completed, in the order submitted."""
    still = wait(pending, return_when=FIRST_COMPLETED).not_done
    ready = [(f, pending.pop(f)) for f in reversed(list(pending)) if f not in still]
    while ready:  # drops each result before the next is waited for
        future, box = ready.pop()
        yield box, future.result()


def processors() -> int:
    """Return how many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
