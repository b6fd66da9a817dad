"""The checker's command: ``python -I piezo_sym/checker SPEC.toml PROOFS.json``.

Input: two files.  Output: a line per row, a count; exit 0 if all are confirmed, 1 if not, 2 if the
input is bad.
"""

from __future__ import annotations

import json
import sys
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

MAX_PROOFS = 20_000_000


def main(arguments: list[str]) -> int:
    """Print what is confirmed of a spec; return the exit status."""
    if not __package__:  # run as a folder: it becomes a package, and hides no other module
        folder = str(Path(__file__).parent)
        sys.path[:] = [path for path in sys.path if path != folder]
        found = spec_from_file_location("checker", f"{folder}/__init__.py")
        if found and found.loader:
            sys.modules["checker"] = module_from_spec(found)
            found.loader.exec_module(sys.modules["checker"])
    package = __package__ or "checker"
    checker, rows_of = sys.modules[package], import_module(f"{package}.rows").audit
    try:
        spec, proofs = (Path(path).read_text(encoding="utf-8-sig") for path in arguments)
        if len(proofs) > MAX_PROOFS:
            raise ValueError("the proofs are too large")
        stated = json.loads(proofs)
        rows = list(rows_of(checker.read_spec(spec), stated if isinstance(stated, dict) else {}))
    except (checker.InputError, OSError, ValueError, RecursionError) as error:
        print(f"bad input: {str(error).splitlines()[0][:200]}", file=sys.stderr)  # noqa: T201
        return 2
    lines = [f"{'not ' * bool(why)}confirmed {name} {element}".rstrip() + f": {why}" * bool(why) for name, element, why in rows]
    good = sum(not why for _, _, why in rows)
    print(*lines, f"{good} of {len(rows)} rows confirmed", sep="\n")  # noqa: T201
    return 0 if good == len(rows) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
