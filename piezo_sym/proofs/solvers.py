"""One interface to all solvers: a `Query` in, an `Answer` out.

Input: a `Query`.  Output: proved, refuted by a model, or unknown with the reason.  Each solver runs
in a process of its own (`worker`); one that hangs, crashes or is not installed gives `unknown`.
"""

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Protocol, final

from piezo_sym.processes import Worker
from piezo_sym.proofs.query import MARK, Query, marked

#: Seconds to wait for one answer; the solvers' own limits end a query long before.
PATIENCE = 20.0
#: Seconds to wait for the second solver.
LESS_PATIENCE = 5.0
#: A name in a query; the number of queries whose answers are kept.
NAME, MOST_KNOWN = re.compile(re.escape(MARK) + r"\w+"), 10_000
RESULTS = frozenset({"unsat", "sat", "unknown"})
#: Exceptions from reading a line that is no answer.
MALFORMED = (ValueError, TypeError, AttributeError, LookupError, ZeroDivisionError)


@final
@dataclass(frozen=True)
class Answer:
    """A solver's answer: ``unsat`` proves the claim; ``sat`` has a model if one is wanted."""

    result: str
    model: Mapping[str, Fraction] = field(default_factory=dict)
    reason: str = ""


class SolverLike(Protocol):
    """Answers queries: a solver, several of them, or a stand-in of a test."""

    def ask(self, query: Query) -> Answer:
        """Return the answer to a query; a failure of the solver is the answer ``unknown``."""


@final
class Solver:
    """A solver in a process of its own.

    Parameters
    ----------
    name : for messages.
    worker : the process, which answers as `worker` does.
    patience : seconds to wait for one answer.
    """

    def __init__(self, name: str, worker: Worker, patience: float = PATIENCE) -> None:
        self.name, self.worker, self.patience = name, worker, patience
        self._known: dict[str, Answer] = {}

    def ask(self, query: Query) -> Answer:
        """Return the answer to a query; ``unknown`` if the solver fails or takes too long."""
        order = [marked(name) for name in query.variables] if query.witness else []
        text = query.text()
        key = "" if order else _numbered(text)
        if key in self._known:
            return self._known[key]
        answer = self._asked(json.dumps({"text": text, "order": order}).encode())
        if key and answer.result != "unknown" and len(self._known) < MOST_KNOWN:
            self._known[key] = answer
        return answer

    def _asked(self, request: bytes) -> Answer:
        try:
            (line,) = self.worker.ask(request, self.patience)
            return _read(line)
        except (EOFError, OSError, *MALFORMED):
            self.worker.close()
            reason = f"{self.name} stopped, or took more than {self.patience:g} s"
            return Answer("unknown", reason=reason)


def _numbered(text: str) -> str:
    """Return a query with numbers for names, equal for queries that differ by names alone."""
    found: dict[str, str] = {}
    return NAME.sub(lambda name: found.setdefault(name[0], f"?{len(found)}"), text)


def _read(line: bytes) -> Answer:
    """Return the answer that a line holds; raises one of `MALFORMED` if the line is no answer."""
    found: dict[str, Any] = json.loads(line)
    values: Mapping[str, str] = found.get("model", {})
    model = {n.removeprefix(MARK): Fraction(text) for n, text in values.items()}
    answer = Answer(str(found["result"]), model, str(found.get("reason", "")))
    if answer.result not in RESULTS:
        raise ValueError(line)
    return answer


@final
@dataclass(frozen=True)
class Opinions:
    """Two solvers, the second for what the first does not know.

    Of the second solver's answers only a proof counts, as it gives no model that could be checked.
    """

    first: SolverLike
    second: SolverLike

    def ask(self, query: Query) -> Answer:
        """Return the first solver's answer, else the second's proof, else the reasons of both."""
        answer = self.first.ask(query)
        if answer.result != "unknown":
            return answer
        other = self.second.ask(query)
        if other.result == "unsat":
            return Answer("unsat")
        reason = other.reason or f"a second solver says {other.result}, without a model"
        return Answer("unknown", reason=f"{answer.reason}; {reason}")


def opinions() -> SolverLike:
    """Return z3, and cvc5 for what z3 does not know, if it is installed."""
    if find_spec("cvc5") is None:
        return solver("z3")
    return Opinions(solver("z3"), solver("cvc5", LESS_PATIENCE))


@cache
def solver(name: str, patience: float = PATIENCE) -> Solver:
    """Return the solver ``z3`` or ``cvc5``, whatever the patience in the one process of it."""
    return Solver(name, _worker(name), patience)


@cache
def _worker(name: str) -> Worker:
    return Worker("-E", str(Path(__file__).with_name("worker.py")), name)
