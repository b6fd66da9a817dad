"""Progress of work: a bar on a terminal, or a user's function.

Input: a user's argument `progress`.  Output: a function to call with the number of runs done, or
the time that a run has reached; or the items of a list, with a bar.
"""

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeAlias, TypeVar

from piezo_sym.errors import UsageError, quote

Tell: TypeAlias = Callable[..., object]
ItemT = TypeVar("ItemT")
#: A bar appears after this time [s].
SECOND = 1.0


@contextmanager
def progress_of(wanted: object, total: float, what: str, where: str) -> Iterator[Tell]:
    """Yield a function to call with the part of `total` done; a user's may take more arguments.

    `wanted` is True, False, None for a bar on a terminal, or the user's function. `what` is the
    label of the bar, `where` the place in errors.
    """
    if callable(wanted):
        yield wanted
        return
    if wanted is not None and not isinstance(wanted, bool):
        expected = "True, False, None or a function of what is done"
        raise UsageError(f"{quote(wanted)} shows no progress", where, expected)
    if not (sys.stderr.isatty() if wanted is None else wanted):
        yield lambda *_: None
        return
    from rich import progress
    from rich.console import Console

    console = Console(stderr=True)
    done: Any = progress.TextColumn("{task.completed:.4g} of {task.total:.4g}")
    columns = progress.TextColumn(what), progress.BarColumn(), done, progress.TimeRemainingColumn()
    bar = progress.Progress(*columns, console=console, transient=console.is_terminal)
    task, begun = bar.add_task(what, total=total), time.monotonic()

    def tell(done: float, *_: object) -> None:
        if time.monotonic() - begun > SECOND:
            bar.start()  # later calls change nothing
        bar.update(task, completed=done)

    try:
        yield tell
    finally:
        if bar.live.is_started:
            bar.stop()


def tracked(items: Sequence[ItemT], what: str) -> Iterator[ItemT]:
    """Yield items, with a bar on a terminal that is labelled `what`."""
    with progress_of(None, len(items), what, "") as tell:
        for done, item in enumerate(items):
            tell(done)
            yield item
        tell(len(items))
