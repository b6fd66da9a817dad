"""A second program on the same spec: ``piezo_sym/checker``, which shares nothing with the first.

Input: the text of a spec and of its ``proofs.json``.  Output: a `Recheck`, what the checker says of
each row.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import final

from piezo_sym.errors import UsageError
from piezo_sym.files import temporary_folder

CHECKER = Path(__file__).parents[1] / "checker"
#: Seconds that the checker is given for one spec.
PATIENCE = 600.0
#: A line of the checker: its verdict, the row's id and element, and the reason.
LINE = re.compile(r"(confirmed|not confirmed|stated) (\w+)(?: (\w+))?(?:: (.*))?")


@final
@dataclass(frozen=True)
class Recheck:
    """What the checker says of a report."""

    said: str  # what it printed
    #: (id, element) -> ``confirmed``, ``stated`` (it is not looked at), or ``not confirmed: `` and
    #: the reason.
    rows: Mapping[tuple[str, str], str] = field(default_factory=dict)
    failed: str = ""  # why there are no rows, if the checker ended early

    def faults(self, information: frozenset[tuple[str, str]] = frozenset()) -> list[str]:
        """Return a line for all that is not confirmed, except rows that are only information."""
        rows = [
            f"not confirmed {' '.join(filter(None, key))}{word.removeprefix('not confirmed')}"
            for key, word in self.rows.items()
            if word.startswith("not") and key not in information
        ]
        return [self.failed, *rows] if self.failed else rows


def check_installed() -> None:
    """Raise `UsageError`, which names what to install, where the checker needs it."""
    if find_spec("cvc5") is None:
        remedy = "pip install 'piezo_sym[proof]'"
        raise UsageError("cvc5 is not installed", "--recheck", remedy=remedy)


def recheck(spec: str, proofs: str) -> Recheck:
    """Return what the checker says of every row, for the texts of a spec and its ``proofs.json``.

    Raises `UsageError` if what the checker needs is not installed.
    """
    check_installed()
    folder = temporary_folder()
    paths = folder / "spec.toml", folder / "proofs.json"
    for path, text in zip(paths, (spec, proofs), strict=True):
        path.write_text(text, encoding="utf-8")
    command = (sys.executable, "-I", str(CHECKER), *map(str, paths))
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=PATIENCE, check=False
        )
    except subprocess.TimeoutExpired:
        return Recheck("", failed=f"not confirmed: the checker took more than {PATIENCE:g} s")
    return _read(done.returncode, (done.stdout + done.stderr).strip())


def _read(code: int, said: str) -> Recheck:
    """Return what was printed as data; an exit status that the rows do not explain is a failure."""
    found = [match.groups() for match in map(LINE.fullmatch, said.splitlines()) if match]
    rows = {
        (name, element or ""): f"{word}: {reason}" if reason else word
        for word, name, element, reason in found
    }
    explained = code == int(any(word.startswith("not") for word in rows.values()))
    last = said.splitlines()[-1] if said else "the checker printed nothing"
    return Recheck(said, rows, "" if rows and explained else f"not confirmed: {last}")
