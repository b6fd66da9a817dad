"""The process in which systems are examined: it can be stopped, and its memory is limited.

Input: an `IPHS` or a `Model`.  Output: a `Report`, and the texts of a module; what was not decided
in time, or with the memory there is, is OPEN and says so.
"""

from __future__ import annotations

import base64
import os
import pickle
import signal
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager, nullcontext
from functools import cache
from threading import Thread
from time import monotonic
from typing import TYPE_CHECKING, Any

from piezo_sym.errors import PiezoError
from piezo_sym.processes import Worker, beside
from piezo_sym.spec.values import Template
from piezo_sym.verification.protocol import ENDED, KILLED, LATE, OVERDUE, TOO_LARGE, Request, Stop

if TYPE_CHECKING:
    from piezo_sym.iphs import IPHS
    from piezo_sym.report import Report
    from piezo_sym.spec.model import Model

#: Seconds for a system of up to SMALL elements, and for each element more.
PATIENCE, MORE_PATIENCE, SMALL = 28.0, 1.0, 10
#: The most that these seconds are stretched on a machine where processes wait for a processor.
MOST_CROWDED = 4.0
#: Systems of fewer elements are read back sooner than a copy of a process pays: it takes 0.2 s of
#: work, as every page that it touches is copied.
FEWEST_BESIDE = 12
#: The line after the last message on a subject.
END = b"\n"


def started() -> None:
    """Start the process of this interpreter, which imports what it needs meanwhile."""
    _examiner().start()


def examined(subject: IPHS | Model) -> Report:
    """Return the report on a system, or on a model, made in the process of this interpreter.

    Raises `NetworkError` or `SpecError` if the model cannot be derived.
    """
    return _report(subject, Future())


@contextmanager
def examining(model: Model) -> Iterator[tuple[Future[Template], Future[Report]]]:
    """Yield the texts of a model's module and the verdicts on it, which are made from now on.

    Both results raise what `examined` raises; the texts raise a `ProofError` if the process ended
    before it had them.  All is abandoned if the context fails.
    """
    texts: Future[Template] = Future()
    verdicts: Future[Report] = Future()

    def examine() -> None:
        try:
            report = _report(model, texts)
            verdicts.set_result(report)
            report.raise_if_not_proved()
        except BaseException as error:  # raised again where something is asked for
            for future in (texts, verdicts):
                if not future.done():
                    future.set_exception(error)

    Thread(target=examine, daemon=True).start()
    try:
        yield texts, verdicts
    except BaseException:
        if not verdicts.done():
            _examiner().close()
        raise


def _report(subject: IPHS | Model, texts: Future[Template]) -> Report:
    """Return the report on a system; the texts of its module are set when they are known."""
    started()
    from piezo_sym.spec.model import Model
    from piezo_sym.verification.record import Record  # meanwhile

    model = subject if isinstance(subject, Model) else subject.model
    limit = PATIENCE + MORE_PATIENCE * max(0, len(model.elements) - SMALL)
    record, ends = Record(model.name, limit), monotonic() + limit * crowding()
    while True:
        stop: Stop | PiezoError | None = None
        request = Request(subject, ends - monotonic(), record.late, record.known)
        for message in messages(_examiner(), request):
            if isinstance(message, Stop | PiezoError):
                stop = message
            elif not isinstance(message, Template):
                record.take(message)
            elif not texts.done():
                texts.set_result(message)
        if isinstance(stop, PiezoError):
            raise stop
        if stop is None or not record.goes_on(stop):
            return record.report()


def crowding() -> float:
    """Return how many times longer work takes than on a machine that does nothing else."""
    try:
        waiting = os.getloadavg()[0] / (os.cpu_count() or 1)
    except OSError:  # this system does not say
        return 1.0
    return min(max(1.0, waiting), MOST_CROWDED)


def messages(worker: Worker, request: Request) -> Iterator[Any]:
    """Yield what `examine` does, then an error or a `Stop` if it did not come to its end."""
    try:
        for line in worker.ask(packed(request), max(0.0, request.seconds), END.__eq__):
            if line != END:
                yield pickle.loads(base64.b64decode(line))
    except TimeoutError:
        yield OVERDUE
    except (EOFError, BrokenPipeError):
        ends = {-signal.SIGALRM: LATE, -signal.SIGKILL: KILLED}  # whoever kills it wants no retry
        yield ends.get(worker.status or 0, ENDED)


def packed(subject: object) -> bytes:
    """Return a subject or message as one line, without its end."""
    return base64.b64encode(pickle.dumps(subject))


@cache
def _examiner() -> Worker:
    """Return the one process that examines systems for this interpreter."""
    return Worker("-m", "piezo_sym.verification.worker", group=True)  # solvers stop with it


def answer(request: Request) -> Iterator[object]:
    """Yield the messages on one subject; called in the process."""
    from piezo_sym.derivation import derive
    from piezo_sym.iphs import IPHS
    from piezo_sym.verification.examine import examine

    subject = request.subject
    try:
        iphs = subject if isinstance(subject, IPHS) else derive(subject)
        several = len(iphs.model.flatten().elements) >= FEWEST_BESIDE and (os.cpu_count() or 1) > 1
        apart = beside if several else nullcontext
        yield from examine(iphs, apart=apart, late=request.late, known=request.known)
    except PiezoError as error:
        yield error
    except EOFError:
        yield ENDED
    except (MemoryError, RecursionError):
        yield TOO_LARGE
