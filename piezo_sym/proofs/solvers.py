"""Solvers behind one small face: a query's text in, an `Answer` out.

Input: a `Query`.  Output: proved, refuted by a model, or unknown with the reason.  Each solver runs
in a process of its own (`worker`); one that hangs, crashes or is not installed gives `unknown`.
"""

from __future__ import annotations

import atexit
import json
import subprocess
import sys
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any, final

from piezo_sym.proofs.query import Query

#: The most seconds to wait for one answer; far above what the solvers' own limits come to.
PATIENCE = 20.0
#: Answers that are kept: a query is asked again when a file is checked or a bank is written out.
MOST_KNOWN = 10_000


@final
@dataclass(frozen=True)
class Answer:
    """What a solver says of a query: ``unsat`` proves its claim, ``sat`` comes with a model."""

    result: str
    model: Mapping[str, Fraction] = field(default_factory=dict)
    reason: str = ""


@final
class Solver:
    """A solver in a process of its own, started when it is first asked.

    Parameters
    ----------
    command : what to start; it answers as `worker` does.
    name : for messages.
    patience : seconds to wait for one answer.
    """

    def __init__(self, name: str, command: tuple[str, ...], patience: float = PATIENCE) -> None:
        self.name, self.command, self.patience = name, command, patience
        self._process: subprocess.Popen[str] | None = None
        self._lock = threading.Lock()
        self._known: dict[str, Answer] = {}

    def ask(self, query: Query) -> Answer:
        """Return the answer to a query; never raises for what the solver does."""
        request = json.dumps({"text": query.text(), "order": query.variables})
        with self._lock:
            if request not in self._known:
                found = self._exchange(request)
                if found is None:
                    self.close()
                    reason = f"{self.name} stopped, or took more than {self.patience:g} s"
                    return Answer("unknown", reason=reason)
                self._keep(request, found)
            return self._known[request]

    def _keep(self, request: str, found: dict[str, Any]) -> None:
        model = {name: Fraction(text) for name, text in found.get("model", {}).items()}
        answer = Answer(str(found["result"]), model, str(found.get("reason", "")))
        self._known[request] = answer
        if len(self._known) > MOST_KNOWN:
            self._known.pop(next(iter(self._known)))

    def close(self) -> None:
        """Stop the process; the next question starts another."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None

    def _exchange(self, request: str) -> dict[str, Any] | None:
        """Send one line and read one; None if the process stops or hangs."""
        process = self._running()
        watch = threading.Timer(self.patience, process.kill)
        watch.start()
        try:
            assert process.stdin is not None
            assert process.stdout is not None
            process.stdin.write(request + "\n")
            process.stdin.flush()
            line = process.stdout.readline()
            found: dict[str, Any] | None = json.loads(line) if line.endswith("\n") else None
        except (OSError, ValueError):
            return None
        finally:
            watch.cancel()
        return found

    def _running(self) -> subprocess.Popen[str]:
        if self._process is None or self._process.poll() is not None:
            self.close()
            self._process = subprocess.Popen(
                self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
            )
        return self._process


@cache
def solver(name: str) -> Solver:
    """Return the solver ``z3`` or ``cvc5``, one process of each for the whole run."""
    worker = str(Path(__file__).with_name("worker.py"))
    made = Solver(name, (sys.executable, "-E", worker, name))
    atexit.register(made.close)
    return made
