"""How far work is: a bar on a terminal, or a user's function.

Input: what a user said of `progress`.  Output: a function told how many runs of a sweep are done,
or what time a run has reached; or the items of a list, one by one.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeAlias, TypeVar

from piezo_sym.errors import UsageError, quote

Tell: TypeAlias = Callable[..., object]
ItemT = TypeVar("ItemT")
#: A bar appears after so long [s].
SECOND = 1.0


@contextmanager
def progress_of(wanted: object, total: float, what: str, where: str) -> Iterator[Tell]:
    """Give a function to be told how much of `total` is done, and more, for a user's function.

    `wanted` is True or False; None for a bar on a terminal; or the user's function. `what` is what
    the bar is called, `where` for messages.
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
    drawn = progress.Progress(*columns, console=console, transient=console.is_terminal)
    task, begun = drawn.add_task(what, total=total), time.monotonic()

    def tell(done: float, *_: object) -> None:
        if time.monotonic() - begun > SECOND:
            drawn.start()  # once: later calls change nothing
        drawn.update(task, completed=done)

    try:
        yield tell
    finally:
        if drawn.live.is_started:
            drawn.stop()


def tracked(items: Sequence[ItemT], what: str) -> Iterator[ItemT]:
    """Yield items, with a bar on a terminal; `what` they are, in the plural."""
    with progress_of(None, len(items), what, "") as tell:
        for done, item in enumerate(items):
            tell(done)
            yield item
        tell(len(items))
