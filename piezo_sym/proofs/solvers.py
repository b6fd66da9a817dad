"""One interface to all solvers: a `Query` in, an `Answer` out.

Input: a `Query`.  Output: proved, refuted by a model, or unknown with the reason.  Each solver runs
in a process of its own (`worker`); one that hangs, crashes or is not installed gives `unknown`.
"""

from __future__ import annotations

import atexit
import json
import os
import re
import select
import subprocess
import sys
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Protocol, final

from piezo_sym.proofs.query import MARK, Query, marked

#: Seconds to wait for one answer; the solvers' own limits end a query long before.
PATIENCE = 20.0
#: Seconds to wait for the second solver, which is asked only where the first does not know.
LESS_PATIENCE = 5.0
#: Makes glibc keep freed memory for the next query: to get it from the system again takes longer
#: than most answers.
KEEP_MEMORY = {"MALLOC_TRIM_THRESHOLD_": "256000000", "MALLOC_MMAP_THRESHOLD_": "256000000"}
#: A name in a query; and of how many queries the answers are kept.
NAME, MOST_KNOWN = re.compile(re.escape(MARK) + r"\w+"), 10_000
RESULTS = frozenset({"unsat", "sat", "unknown"})


@final
@dataclass(frozen=True)
class Answer:
    """What a solver says: ``unsat`` proves the claim; ``sat`` has a model if one is wanted."""

    result: str
    model: Mapping[str, Fraction] = field(default_factory=dict)
    reason: str = ""


class Asks(Protocol):
    """What answers queries: a solver, several of them, or a stand-in of a test."""

    def ask(self, query: Query) -> Answer:
        """Return the answer to a query; never raises for what a solver does."""


@final
class Solver:
    """A solver in a process of its own, started when it is first asked.

    Parameters
    ----------
    command : the process to start; it answers as `worker` does.
    name : for messages.
    patience : seconds to wait for one answer.
    """

    def __init__(self, name: str, command: tuple[str, ...], patience: float = PATIENCE) -> None:
        self.name, self.command, self.patience = name, command, patience
        self._process: subprocess.Popen[bytes] | None = None
        self._lock = threading.Lock()
        self._known: dict[str, Answer] = {}

    def ask(self, query: Query) -> Answer:
        """Return the answer to a query; never raises for what the solver does."""
        order = [marked(name) for name in query.variables] if query.witness else []
        text = query.text()
        alike = "" if order else _numbered(text)
        if alike in self._known:
            return self._known[alike]
        answer = self._asked(json.dumps({"text": text, "order": order}))
        if alike and answer.result != "unknown" and len(self._known) < MOST_KNOWN:
            self._known[alike] = answer
        return answer

    def _asked(self, request: str) -> Answer:
        with self._lock:
            try:
                answer = _read(self._exchange(request))
            except BaseException:  # an answer that comes later would be taken for the next one's
                self.close()
                raise
            if answer is None:
                self.close()
                reason = f"{self.name} stopped, or took more than {self.patience:g} s"
                return Answer("unknown", reason=reason)
            return answer

    def close(self) -> None:
        """Stop the process; the next question starts another."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None

    def _exchange(self, request: str) -> str:
        """Send one line and return the answer; it is incomplete if the process stops or hangs."""
        left, read, end = f"{request}\n".encode(), b"", time.monotonic() + self.patience
        try:
            process = self._running()
            assert process.stdin is not None
            assert process.stdout is not None
            to, back = process.stdin.fileno(), process.stdout.fileno()
            ready = select.poll()
            ready.register(to, select.POLLOUT)
            ready.register(back, select.POLLIN)
            while not read.endswith(b"\n") and time.monotonic() < end:
                events = dict(ready.poll(max(0.0, 1000 * (end - time.monotonic()))))
                if back in events and (part := os.read(back, select.PIPE_BUF)):
                    read += part
                elif to in events:
                    left = left[os.write(to, left[: select.PIPE_BUF]) :]
                    if not left:
                        ready.unregister(to)
                else:  # timed out, or the process ended
                    break
        except (OSError, ValueError):  # gone, or closed by another thread
            return ""
        return "" if left else read.decode(errors="replace")

    def _running(self) -> subprocess.Popen[bytes]:
        if self._process is None or self._process.poll() is not None:
            self.close()
            self._process = subprocess.Popen(
                self.command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                bufsize=0,
                env={**os.environ, **KEEP_MEMORY},
            )
        return self._process


def _numbered(text: str) -> str:
    """Return a query with numbers for names: of two that differ by names alone, one is asked."""
    found: dict[str, str] = {}
    return NAME.sub(lambda name: found.setdefault(name[0], f"?{len(found)}"), text)


def _read(line: str) -> Answer | None:
    """Return the answer that a line holds, or None if the line is no answer."""
    if not line.endswith("\n"):
        return None
    try:
        found: dict[str, Any] = json.loads(line)
        values: Mapping[str, str] = found.get("model", {})
        model = {n.removeprefix(MARK): Fraction(text) for n, text in values.items()}
        answer = Answer(str(found["result"]), model, str(found.get("reason", "")))
    except (ValueError, TypeError, AttributeError, LookupError, ZeroDivisionError):
        return None
    return answer if answer.result in RESULTS else None


@final
@dataclass(frozen=True)
class Opinions:
    """Two solvers: where the first does not know, the second is asked.

    Of the second only a proof counts: it gives no model that could be checked.
    """

    first: Asks
    second: Asks

    def ask(self, query: Query) -> Answer:
        """Return the first's answer, or that the second has a proof, or the reasons of both."""
        answer = self.first.ask(query)
        if answer.result != "unknown":
            return answer
        other = self.second.ask(query)
        if other.result == "unsat":
            return Answer("unsat")
        said = other.reason or f"a second solver says {other.result}, without a model"
        return Answer("unknown", reason=f"{answer.reason}; {said}")


def opinions() -> Asks:
    """Return z3, and cvc5 for what z3 does not know, if it is installed."""
    if find_spec("cvc5") is None:
        return solver("z3")
    return Opinions(solver("z3"), solver("cvc5", LESS_PATIENCE))


@cache
def solver(name: str, patience: float = PATIENCE) -> Solver:
    """Return the solver ``z3`` or ``cvc5``, one process of each for the whole run."""
    worker = str(Path(__file__).with_name("worker.py"))
    made = Solver(name, (sys.executable, "-E", worker, name), patience)
    atexit.register(made.close)
    return made
