"""A second program on the same spec: ``piezo_sym/checker``, which shares nothing with the first.

Input: the text of a spec and of its ``proofs.json``.  Output: what the checker prints, one line per
row, and whether it confirmed them all.
"""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

from piezo_sym.errors import UsageError
from piezo_sym.files import temporary_folder

CHECKER = Path(__file__).parents[1] / "checker"
NEEDS = ("cvc5", "flint")
#: Seconds that the checker is given for one spec.
PATIENCE = 600.0


def recheck(spec: str, proofs: str) -> tuple[bool, str]:
    """Return whether the checker confirmed every row of a report, and what it printed.

    Parameters
    ----------
    spec : the text of the spec, as the user wrote it.
    proofs : the text of ``proofs.json``.

    Raises
    ------
    UsageError
        If what the checker needs is not installed.
    """
    missing = [name for name in NEEDS if find_spec(name) is None]
    if missing:
        remedy = "pip install 'piezo_sym[proof]'"
        raise UsageError(f"{' and '.join(missing)} is not installed", "--recheck", remedy=remedy)
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
        return False, f"not confirmed: the checker took more than {PATIENCE:g} s"
    return done.returncode == 0, (done.stdout + done.stderr).strip()
