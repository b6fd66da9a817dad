"""How far work is: a bar on a terminal, or a user's function.

Input: what a user said of `progress`.  Output: a function told how many runs of a sweep are done,
or what time a run has reached; or the items of a list, one by one.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from piezo_sym.errors import UsageError, quote

if TYPE_CHECKING:
    from rich.progress import ProgressColumn

Tell: TypeAlias = Callable[[float], object]
ItemT = TypeVar("ItemT")
#: A bar appears after so long [s].
SECOND = 1.0


@contextmanager
def progress_of(wanted: object, total: int) -> Iterator[Tell]:
    """Give a function to be told how many of `total` runs are done.

    `wanted` is True or False; None for a bar on a terminal; or a function of (done, total).
    """
    if callable(wanted):
        call: Callable[[float, int], object] = wanted
        yield lambda done: call(done, total)
        return
    if wanted is not None and not isinstance(wanted, bool):
        expected = "True, False, None or a function of (done, total)"
        raise UsageError(f"{quote(wanted)} shows no progress", "sweep.progress", expected)
    with bar(total, "sweep", shown=wanted) as tell:
        yield tell


@contextmanager
def watch_of(wanted: object, duration: object, start: float = 0.0) -> Iterator[Tell | None]:
    """Give what a run from `start` [s] is to tell the time that it has reached [s], or None.

    `wanted` is True for a bar; False or None for nothing; or a function of the time.
    """
    if callable(wanted):
        yield wanted
    elif wanted is None or wanted is False:
        yield None
    elif wanted is True:
        from rich.progress import TextColumn

        length = duration if isinstance(duration, int | float) else 0.0  # the run refuses others
        reached = TextColumn("{task.completed:.4g} s of {task.total:.4g} s")
        with bar(length, "simulated", reached, shown=True) as tell:
            yield lambda t: tell(t - start)
    else:
        expected = "True, False, None or a function of the time in s"
        raise UsageError(f"{quote(wanted)} shows no progress", "simulate.progress", expected)


def tracked(items: Sequence[ItemT], what: str) -> Iterator[ItemT]:
    """Yield items, with a bar on a terminal; `what` they are, in the plural."""
    with bar(len(items), what) as tell:
        for done, item in enumerate(items):
            tell(done)
            yield item
        tell(len(items))


@contextmanager
def bar(
    total: float, what: str, amount: ProgressColumn | None = None, *, shown: bool | None = None
) -> Iterator[Tell]:
    """Give a function to be told how much is done, for a bar on stderr, after a second.

    There is none where `shown` is False, or None and stderr is no terminal; `amount` is how it
    writes what is done, a number of the total when left out.
    """
    if not (sys.stderr.isatty() if shown is None else shown):
        yield lambda done: None  # noqa: ARG005
        return
    from rich import progress
    from rich.console import Console

    amount = amount or progress.MofNCompleteColumn()
    columns = progress.TextColumn(what), progress.BarColumn(), amount
    console = Console(stderr=True)
    end = progress.TimeRemainingColumn()
    drawn = progress.Progress(*columns, end, console=console, transient=console.is_terminal)
    task, begun = drawn.add_task(what, total=total), time.monotonic()

    def tell(done: float) -> None:
        if time.monotonic() - begun > SECOND:
            drawn.start()  # once: later calls change nothing
        drawn.update(task, completed=done)

    try:
        yield tell
    finally:
        if drawn.live.is_started:
            drawn.stop()
