"""The process in which systems are examined: it can be stopped, and its memory is limited.

Input: an `IPHS` or a `Model`.  Output: a `Report`, and the texts of a module; what was not decided
in time, or with the memory there is, is OPEN and says so.
"""

from __future__ import annotations

import base64
import os
import pickle
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from functools import cache
from threading import Thread
from typing import TYPE_CHECKING, Any, final

from piezo_sym.errors import PiezoError
from piezo_sym.processes import Worker, beside
from piezo_sym.spec.values import Template

if TYPE_CHECKING:
    from piezo_sym.iphs import IPHS
    from piezo_sym.proofs.report import Report
    from piezo_sym.spec.model import Model

#: Seconds for a system of up to SMALL elements, and for each element more.
PATIENCE, MORE_PATIENCE, SMALL = 28.0, 1.0, 10
#: Systems of fewer elements are read back sooner than a copy of a process pays: it takes 0.2 s of
#: work, as every page that it touches is copied.
FEWEST_BESIDE = 12
#: Said where a process has ended.
ENDED = "not decided: the process ended, for want of memory or by a fault"
#: The line after the last message on a subject.
END = b"\n"


def started() -> None:
    """Start the process of this interpreter, which imports what it needs meanwhile."""
    _examiner().start()


def examined(iphs: IPHS) -> Report:
    """Return the report on a system, made in the process of this interpreter."""
    return _report(iphs, iphs.model, Future())


def examined_model(model: Model) -> Report:
    """Return the report on a model, derived and made in the process of this interpreter.

    Raises
    ------
    NetworkError, SpecError
        If the model cannot be derived.
    """
    return _report(model, model, Future())


@final
@dataclass(frozen=True)
class Examination:
    """What is being found of a model: who asks for it waits.

    What `examined_model` raises is raised by either; `template` raises a `ProofError` if the
    process ended before it had the texts of the module.
    """

    _texts: Future[Template]
    _verdicts: Future[Report]

    def template(self) -> Template:
        """Return the texts of the module, before anything is proved of them."""
        return self._texts.result()

    def report(self) -> Report:
        """Return the verdicts."""
        return self._verdicts.result()


@contextmanager
def examining(model: Model) -> Iterator[Examination]:
    """Give what is found of a model from now on; where this process fails before, nobody waits."""
    texts: Future[Template] = Future()
    verdicts: Future[Report] = Future()

    def examine() -> None:
        try:
            report = _report(model, model, texts)
            verdicts.set_result(report)
            report.raise_if_not_proved()
        except BaseException as error:  # raised again where something is asked for
            for future in (texts, verdicts):
                if not future.done():
                    future.set_exception(error)

    Thread(target=examine, daemon=True).start()
    try:
        yield Examination(texts, verdicts)
    except BaseException:
        if not verdicts.done():
            _examiner().close()
        raise


def _report(subject: IPHS | Model, model: Model, texts: Future[Template]) -> Report:
    """Return the report on a system; the texts of its module are set when they are known."""
    started()
    from piezo_sym.proofs.report import Report, Row, Verdict  # meanwhile

    seconds = PATIENCE + MORE_PATIENCE * max(0, len(model.elements) - SMALL)
    reports: list[Any] = []
    for message in messages(_examiner(), subject, seconds):
        if isinstance(message, Template):
            texts.set_result(message)
        else:
            reports.append(message)
    *reports, last = reports
    if isinstance(last, PiezoError):
        raise last
    if isinstance(last, Report):
        return last
    from piezo_sym.verification.examine import unfinished

    row = Row("derivation", "", "the system, derived", Verdict.OPEN, reason=last)
    return unfinished(reports[-1] if reports else Report(model.name, (row,)), last)


def messages(worker: Worker, subject: object, seconds: float) -> Iterator[Any]:
    """Yield a `Template`, `Report`s, or an error, or the reason why there is no more, as text.

    Parameters
    ----------
    subject : an `IPHS` or a `Model`.
    seconds : after which the process is stopped.
    """
    try:
        for line in worker.ask(packed(subject), seconds, END.__eq__):
            if line != END:
                yield pickle.loads(base64.b64decode(line))
    except TimeoutError:
        yield f"not decided in {seconds:g} s"
    except (EOFError, BrokenPipeError):
        yield ENDED


def packed(subject: object) -> bytes:
    """Return a subject or message as one line, without its end."""
    return base64.b64encode(pickle.dumps(subject))


@cache
def _examiner() -> Worker:
    """Return the process of this interpreter; there is one."""
    return Worker("-m", "piezo_sym.verification.worker", group=True)  # solvers stop with it


def answer(subject: Any) -> Iterator[object]:
    """Yield the messages on one subject; called in the process."""
    from piezo_sym.derivation import derive
    from piezo_sym.iphs import IPHS
    from piezo_sym.verification.examine import examine

    try:
        iphs = subject if isinstance(subject, IPHS) else derive(subject)
        several = len(iphs.model.flatten().elements) >= FEWEST_BESIDE and (os.cpu_count() or 1) > 1
        yield from examine(iphs, apart=beside if several else nullcontext)
    except PiezoError as error:
        yield error
    except EOFError:
        yield ENDED
    except (MemoryError, RecursionError):
        yield "needs more memory than it is given"
