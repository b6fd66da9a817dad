"""Signals that end the process, delayed where an exception would be lost or leave work half done.

Input: a block.  Output: the signals, once it is complete.
"""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread

#: Exit code of a command that the user stopped (Ctrl-C), as in shells.
STOPPED = 130
_ENDINGS = (signal.SIGINT, signal.SIGTERM)


@contextmanager
def held_back() -> Iterator[list[int]]:
    """Delay signals that end the process until the block is complete: a write, or a call of C.

    The block gets the list of those received so far, to end sooner.
    """
    received: list[int] = []
    if current_thread() is not main_thread():
        yield received
        return
    before = {n: signal.signal(n, lambda number, _: received.append(number)) for n in _ENDINGS}
    try:
        yield received
    finally:
        for number, handler in before.items():
            signal.signal(number, handler or signal.SIG_DFL)
    for ending in received:
        signal.raise_signal(ending)
