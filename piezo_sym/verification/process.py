"""The process in which systems are examined: it can be stopped, and its memory is limited.

Input: an `IPHS`, or the text of a spec.  Output: a `Report`; what was not decided in time, or with
the memory there is, is OPEN and says so.
"""

from __future__ import annotations

import atexit
import os
import pickle
import signal
import struct
import subprocess
import sys
import threading
from collections.abc import Iterator
from functools import cache
from typing import IO, TYPE_CHECKING, Any, final

from piezo_sym.errors import PiezoError

if TYPE_CHECKING:
    from piezo_sym.iphs import IPHS
    from piezo_sym.proofs.report import Report
    from piezo_sym.spec.model import Model

#: Seconds for a system of up to SMALL elements, and for each element more.
PATIENCE, MORE_PATIENCE, SMALL = 28.0, 1.0, 10
LENGTH = struct.Struct(">Q")


def started() -> None:
    """Start the process of this interpreter, which imports what it needs meanwhile."""
    _examiner().start()


def examined(iphs: IPHS) -> Report:
    """Return the report on a system, made in the process of this interpreter."""
    return _report(iphs, iphs.model)


def examined_model(model: Model) -> Report:
    """Return the report on a model, derived and made in the process of this interpreter.

    Raises
    ------
    NetworkError, SpecError
        If the model cannot be derived.
    """
    return _report(model, model)


def _report(subject: IPHS | Model, model: Model) -> Report:
    seconds = PATIENCE + MORE_PATIENCE * max(0, len(model.elements) - SMALL)
    report: Report | None = None
    reason = ""
    for kind, content in _examiner().ask(subject, seconds):
        if kind == "report":
            report = content
        elif kind == "error":
            raise content
        else:
            reason = content
    if report is not None and not reason:
        return report
    from piezo_sym.proofs.report import Report, Row, Verdict
    from piezo_sym.verification.examine import unfinished

    if report is None:
        row = Row("derivation", "", "the system, derived", Verdict.OPEN, reason=reason)
        report = Report(model.name, (row,))
    return unfinished(report, reason)


@final
class Examiner:
    """A process that examines one system after the other, started when it is first asked."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._lock = threading.Lock()

    def ask(self, subject: object, seconds: float) -> Iterator[tuple[str, Any]]:
        """Yield ("report", Report) once or more, then perhaps ("error", ...) or ("late", reason).

        Parameters
        ----------
        subject : an `IPHS` or a `Model`.
        seconds : after which the process is stopped.
        """
        late = threading.Event()
        with self._lock:
            try:
                process = self._running()
                watch = threading.Timer(seconds, self._kill, (process, late))
                watch.start()
                try:
                    yield from _exchange(process, pickle.dumps(subject))
                finally:
                    watch.cancel()
            except EOFError:
                self.close()
                reason = (
                    f"not decided in {seconds:g} s"
                    if late.is_set()
                    else "not decided: the process ended, for want of memory or by a fault"
                )
                yield "late", reason
            except BaseException:  # an answer that comes later would be taken for the next one's
                self.close()
                raise

    def start(self) -> None:
        """Start the process, unless it runs."""
        with self._lock:
            self._running()

    def close(self) -> None:
        """Stop the process; the next question starts another."""
        if self._process is not None:
            self._kill(self._process, threading.Event())
            self._process.wait()
            for pipe in (self._process.stdin, self._process.stdout):
                if pipe is not None:
                    pipe.close()
            self._process = None

    def _running(self) -> subprocess.Popen[bytes]:
        if self._process is None or self._process.poll() is not None:
            self.close()
            self._process = subprocess.Popen(
                (sys.executable, "-m", "piezo_sym.verification.worker"),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=True,  # its solvers stop with it
                env=_environment(),
            )
        return self._process

    @staticmethod
    def _kill(process: subprocess.Popen[bytes], done: threading.Event) -> None:
        done.set()
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            return


def _environment() -> dict[str, str]:
    """Return the environment in which the process finds the modules that this one does."""
    return {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}


def _exchange(process: subprocess.Popen[bytes], request: bytes) -> Iterator[tuple[str, Any]]:
    assert process.stdin is not None
    assert process.stdout is not None
    try:
        write(process.stdin, request)
    except BrokenPipeError as error:
        raise EOFError from error
    while True:
        kind, content = pickle.loads(read(process.stdout))
        if kind == "end":
            return
        yield kind, content


def write(pipe: IO[bytes], message: bytes) -> None:
    """Write one message, after its length."""
    pipe.write(LENGTH.pack(len(message)) + message)
    pipe.flush()


def read(pipe: IO[bytes]) -> bytes:
    """Return the next message.

    Raises
    ------
    EOFError
        If the other side is gone.
    """
    head = pipe.read(LENGTH.size)
    if len(head) < LENGTH.size:
        raise EOFError
    (length,) = LENGTH.unpack(head)
    body = pipe.read(length)
    if len(body) < length:
        raise EOFError
    return body


@cache
def _examiner() -> Examiner:
    """Return the process of this interpreter; there is one."""
    made = Examiner()
    atexit.register(made.close)
    return made


def answer(subject: Any) -> Iterator[tuple[str, Any]]:
    """Yield the messages on one subject; called in the process."""
    from piezo_sym.derivation import derive
    from piezo_sym.iphs import IPHS
    from piezo_sym.verification.examine import examine

    try:
        iphs = subject if isinstance(subject, IPHS) else derive(subject)
        for report in examine(iphs):
            yield "report", report
    except PiezoError as error:
        yield "error", error
    except (MemoryError, RecursionError):
        yield "late", "needs more memory than it is given"
    yield "end", None
