"""Processes that answer requests: one may crash, hang or run out of memory, and nothing else does.

Input: a command, and requests of one line.  Output: the lines of an answer, in time or not at all.
Or some work, done in a copy of this process `beside` what this one does.
"""

from __future__ import annotations

import atexit
import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import BinaryIO, NoReturn, TypeVar, final
from weakref import WeakSet

T = TypeVar("T")

#: The longest line of an answer; of a process that never ends its line, no more than this is read.
LONGEST = 1 << 28
#: Of garbage collection: imports and large systems make many objects, but little garbage.
THRESHOLDS = 100_000, 50, 100
#: Makes glibc keep freed memory for the next request: to get it from the system again takes longer
#: than most answers.
KEEP_MEMORY = {"MALLOC_TRIM_THRESHOLD_": "256000000", "MALLOC_MMAP_THRESHOLD_": "256000000"}


@final
class Worker:
    """A process that answers one request after the other, started when it is first asked.

    Parameters
    ----------
    arguments : of this interpreter.
    group : whether it has a group of its own, which is stopped with it.
    """

    def __init__(self, *arguments: str, group: bool = False) -> None:
        self.arguments, self.group = arguments, group
        self.process: subprocess.Popen[bytes] | None = None
        self.status: int | None = None  # with which the last one ended
        self._lock = threading.Lock()
        _workers.add(self)
        atexit.register(self.close)

    def ask(
        self, request: bytes, seconds: float, is_last: Callable[[bytes], bool] = lambda _: True
    ) -> Iterator[bytes]:
        """Yield the lines of an answer; a process that does not give all of them is stopped.

        Raises `TimeoutError` if the answer takes longer than `seconds`. Raises `EOFError` or
        `OSError` if the process ends, or cannot be started.
        """
        late, asked = threading.Event(), threading.Lock()
        with self._lock:
            try:
                self._start()
                watch = threading.Timer(seconds, self._stop, (late, asked))
                watch.start()
                try:
                    yield from self._exchange(request, is_last)
                finally:
                    asked.acquire()  # a watch that is late itself stops no later request
                    watch.cancel()
                    if late.is_set():
                        self.close()
            except BaseException:  # late lines would be taken for the next answer
                self.close()
                if late.is_set():
                    raise TimeoutError from None
                raise

    def start(self) -> None:
        """Start the process, unless it runs."""
        with self._lock:
            self._start()

    def close(self) -> None:
        """Stop the process; the next request starts another."""
        process, self.process = self.process, None  # another thread may close it, too
        if process is None:
            return
        self._kill(process)
        self.status = process.wait()
        for pipe in (process.stdin, process.stdout):
            with suppress(OSError):  # from flushing what was not sent
                pipe and pipe.close()

    def forget(self) -> None:
        """In a forked copy, leave the process to the original; start another when asked."""
        self.process, self._lock = None, threading.Lock()

    def _start(self) -> None:
        if self.process is None or self.process.poll() is not None:
            self.close()
            self.process = subprocess.Popen(
                (sys.executable, "-P", *self.arguments),  # no package of the working folder
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=self.group,
                env={**os.environ, **KEEP_MEMORY, "PYTHONPATH": search_path()},
            )

    def _exchange(self, request: bytes, is_last: Callable[[bytes], bool]) -> Iterator[bytes]:
        if (process := self.process) is None:  # another thread has closed it
            raise EOFError
        to, back = process.stdin, process.stdout
        assert to is not None
        assert back is not None
        to.write(request + b"\n")
        to.flush()
        while True:
            line = back.readline(LONGEST)
            if not line.endswith(b"\n"):
                raise EOFError
            yield line
            if is_last(line):
                return

    def _stop(self, late: threading.Event, asked: threading.Lock) -> None:
        if asked.acquire(blocking=False):  # nothing has ended this request before
            late.set()
            if process := self.process:
                self._kill(process)
            asked.release()

    def _kill(self, process: subprocess.Popen[bytes]) -> None:
        with suppress(ProcessLookupError):
            if self.group:
                os.killpg(process.pid, signal.SIGKILL)
            process.kill()


_workers: WeakSet[Worker] = WeakSet()


def search_path() -> str:
    """Return where this process looks for modules, for one that is started with ``-P``."""
    known = (path for path in sys.path if isinstance(path, str))  # Python skips others, too
    return os.pathsep.join(path or os.getcwd() for path in known)


@contextmanager
def beside(work: Iterator[T]) -> Iterator[Iterator[T]]:
    """Yield the results of some work that a forked copy of this process does in the meantime.

    The copy ends with the context.  An exception of the work is raised when its next result is
    asked for; it is `EOFError` if the copy crashed or ran out of memory (it has the same limit).
    """
    (back, to), (alive, held) = os.pipe(), os.pipe()
    if (copy := os.fork()) == 0:
        os.close(back)
        os.close(held)
        _copied(work, os.fdopen(to, "wb"), alive)
    os.close(to)
    os.close(alive)
    with os.fdopen(back, "rb") as results:
        try:
            yield _received(results)
        finally:
            os.kill(copy, signal.SIGKILL)
            os.waitpid(copy, 0)
            os.close(held)


def _received(results: BinaryIO) -> Iterator[T]:
    while True:
        try:
            kind, value = pickle.load(results)
        except pickle.UnpicklingError:  # it ended while it wrote
            raise EOFError from None
        if kind == "raised":
            raise value
        yield value


def _copied(work: Iterator[T], results: BinaryIO, alive: int) -> NoReturn:
    """Do the work in the forked copy, until it is done or the original process has ended."""
    try:
        nothing = os.open(os.devnull, os.O_RDWR)  # other processes wait for its pipes to close
        os.dup2(nothing, 0)
        os.dup2(nothing, 1)
        for worker in _workers:
            worker.forget()
        threading.Thread(target=lambda: os.read(alive, 1) or os._exit(1), daemon=True).start()
        try:
            for value in work:
                pickle.dump(("yielded", value), results)
                results.flush()
        except Exception as error:
            pickle.dump(("raised", error), results)
            results.flush()
    finally:
        os._exit(0)
