"""How far a sweep or a run is: a bar on a terminal, or a user's function.

Input: what a user said of `progress`.  Output: a function told how many runs are done, or what time
a run has reached.
"""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeAlias

from piezo_sym.errors import UsageError, quote

Told: TypeAlias = Callable[[int], object]
Reached: TypeAlias = Callable[[float], object]
SECOND = 1.0


@contextmanager
def progress_of(wanted: object, total: int) -> Iterator[Told]:
    """Give a function to be told how many runs are done.

    Parameters
    ----------
    wanted : True or False; None for a bar on a terminal; or a function of (done, total).
    total : the number of runs.

    Raises
    ------
    UsageError : `wanted` is nothing of these.
    """
    if callable(wanted):
        tell: Callable[[int, int], object] = wanted
        yield lambda done: tell(done, total)
        return
    if wanted is not None and not isinstance(wanted, bool):
        expected = "True, False, None or a function of (done, total)"
        raise UsageError(f"{quote(wanted)} shows no progress", "sweep.progress", expected)
    if wanted is None:
        wanted = sys.stderr.isatty()
    if wanted:
        with bar(total) as told:
            yield told
    else:
        yield lambda done: None  # noqa: ARG005


@contextmanager
def bar(total: int) -> Iterator[Told]:
    """Give a bar on the terminal, which appears after a second."""
    from rich.console import Console
    from rich.progress import Progress

    shown = Progress(console=Console(stderr=True))
    task, begun = shown.add_task("sweep", total=total), time.monotonic()

    def told(done: int) -> None:
        if time.monotonic() - begun > SECOND:
            shown.start()  # once: later calls change nothing
        shown.update(task, completed=done)

    try:
        yield told
    finally:
        if shown.live.is_started:
            shown.stop()


@contextmanager
def watch_of(wanted: object, duration: float) -> Iterator[Reached | None]:
    """Give what a run is to tell the time that it has reached [s], or None.

    Parameters
    ----------
    wanted : True for a bar; False or None for nothing; or a function of the time.
    duration : the length of the run [s].

    Raises
    ------
    UsageError : `wanted` is nothing of these.
    """
    if callable(wanted):
        yield wanted
    elif wanted is None or wanted is False:
        yield None
    elif wanted is True:
        with time_bar(duration, shown=True) as told:
            yield told
    else:
        expected = "True, False, None or a function of the time in s"
        raise UsageError(f"{quote(wanted)} shows no progress", "simulate.progress", expected)


@contextmanager
def time_bar(duration: float, *, shown: bool | None = None) -> Iterator[Reached]:
    """Give a function to be told the time reached [s]: a bar on stderr, after a second.

    Parameters
    ----------
    shown : whether there is a bar; when left out, on a terminal.
    """
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    bar = Progress(
        TextColumn("simulated"),
        BarColumn(),
        TextColumn("{task.completed:.4g} s of {task.total:.4g} s"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
        disable=not (sys.stderr.isatty() if shown is None else shown),
    )
    task, begun = bar.add_task("simulated", total=duration), time.monotonic()

    def told(reached: float) -> None:
        if time.monotonic() - begun > SECOND:
            bar.start()
        bar.update(task, completed=reached)

    try:
        yield told
    finally:
        bar.stop()
