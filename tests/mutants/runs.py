"""What the package says of a spec, with or without a mutant, and what notices a mutant.

Input: a spec's text.  Output: plain data, made in a process of its own.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import pickle
import signal
import sys
import tempfile
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.mutants.mutant import Mutant, install

CHECKER = Path(__file__).parents[2] / "piezo_sym" / "checker" / "__main__.py"
#: Points of an attack, far fewer than usual.
POINTS = 4000
#: Seconds for one fork, and the cost of a z3 query in its own units.
SECONDS, LIMIT = 60, 4_000_000

Said = dict[str, Any]


def forked(function: Callable[..., Any], *given: Any, seconds: int = SECONDS) -> Any:
    """Return what a function gives in a fork of this process; ``{"crash": ...}`` if it ends."""
    sys.stdout.flush()
    inlet, outlet = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(inlet)
        signal.alarm(seconds)
        try:
            answer = function(*given)
        except BaseException as error:  # whatever a mutant does
            last = traceback.extract_tb(error.__traceback__)[-1]
            answer = {"crash": f"{type(error).__name__}: {error} ({last.name}, {last.lineno})"}
        with os.fdopen(outlet, "wb") as pipe:
            pickle.dump(answer, pipe)
        os._exit(0)
    os.close(outlet)
    with os.fdopen(inlet, "rb") as pipe:
        data = pipe.read()
    os.waitpid(child, 0)
    return pickle.loads(data) if data else {"crash": f"no answer in {seconds} s"}


def decided(text: str) -> Said:
    """Return the verdicts on a spec and its system, or that it is refused."""
    from piezo_sym.derivation import derive
    from piezo_sym.errors import PiezoError
    from piezo_sym.proofs import decide
    from piezo_sym.spec.load import parse

    _answer_here()
    try:
        iphs = derive(parse(text))
    except PiezoError as error:
        return {"rows": {}, "system": (), "refused": str(error)}
    report = decide(iphs)
    return {"rows": _verdicts(report), "system": _system(iphs, report)}


def mutated(text: str, mutant: Mutant) -> Said:
    """Return what a mutant says of a spec: rows, proofs; and whether the net notices anything."""
    install(mutant)
    _answer_here()
    from piezo_sym.codegen import collocation_of, lower, printed
    from piezo_sym.derivation import derive
    from piezo_sym.errors import ContradictionError
    from piezo_sym.falsify import falsify, module_from
    from piezo_sym.proofs import Report, decide, proofs_json
    from piezo_sym.spec.load import parse
    from piezo_sym.translation import program_row

    iphs = derive(parse(text))
    report = decide(iphs)
    texts = printed(lower(iphs, ""), collocation_of(iphs))
    rows = (*report.rows, program_row(iphs, texts))
    whole = Report(report.model, rows, report.stated, report.system)
    said = {"rows": _verdicts(whole), "system": _system(iphs, report), "net": ""}
    said["proofs"] = proofs_json(whole, iphs.model, "made by a test")
    claims = [key for key, verdict in said["rows"].items() if verdict == "PROVED"]
    try:
        attacks = falsify(iphs, module_from(texts[".py"]), claims, points=POINTS)
    except ContradictionError as error:
        said["net"] = str(error)
    else:
        said["net"] = "" if all(a.points for a in attacks) else "no point of the domain"
    return said


def _verdicts(report: Any) -> dict[tuple[str, str], str]:
    return {(row.id, row.element): row.verdict.value for row in report.rows}


def _system(iphs: Any, report: Any) -> tuple[str, ...]:
    """Return what is published of a system, and what is shown of it."""
    shown = (iphs.rhs, iphs.y, iphs.U, iphs.S, iphs.sigma)
    return (json.dumps(report.system), *map(str, shown))


def _answer_here() -> None:
    """Let z3 and cvc5 answer in this process: it is one that may hang or end."""
    from piezo_sym.proofs import solvers, worker

    class Here:
        def __init__(self, name: str) -> None:
            self.name = name

        def ask(self, request: bytes, _: float) -> tuple[bytes]:
            line = worker.answered(self.name, request.decode())
            return (line.encode(),)

    worker.Z3_LIMIT = LIMIT
    solvers.solver = lambda name, *_: solvers.Solver(name, Here(name))


def checked(text: str, proofs: str) -> Said:
    """Return the rows that the checker's own program does not confirm, and why."""
    if any(name.partition(".")[0] == "piezo_sym" for name in sys.modules):
        raise ImportError("the checker shares nothing with the package")
    printed = io.StringIO()
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / name for name in ("spec.toml", "proofs.json")]
        for path, content in zip(paths, (text, proofs), strict=True):
            path.write_text(content, encoding="utf-8")
        known: dict[str, Any] = {"__name__": "__checker__", "__file__": str(CHECKER)}
        exec(compile(CHECKER.read_bytes(), str(CHECKER), "exec"), known)  # as `python -I` does
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            code = known["main"](list(map(str, paths)))
    lines = printed.getvalue().splitlines()
    refused = [line.removeprefix("not confirmed ") for line in lines if line.startswith("not ")]
    if code == 2:
        refused = [f"all rows: {lines[-1]}"]
    return {"refused": dict(line.partition(": ")[::2] for line in refused)}
