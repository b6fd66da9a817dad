"""The checker's command: ``python -I piezo_sym/checker SPEC.toml PROOFS.json``.

Input: two files.  Output: a line per row and a count; exit status 0 if all rows are confirmed, 1 if
not, 2 if the input is bad.
"""

import json
import resource
import sys
from importlib import import_module
from pathlib import Path

SECONDS, BYTES = 900, 6 * 2**30


def main(arguments: list[str]) -> int:
    """Print which rows of a spec are confirmed; return the exit status."""
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))
    if not __package__:  # run as a folder: import it as a package, so that it hides no other module
        folder = str(Path(__file__).parent)
        sys.path[:] = [*(path for path in sys.path if path != folder), str(Path(folder).parent)]
    try:
        checker, rows = (import_module((__package__ or "checker") + name) for name in ("", ".rows"))
    except ImportError as error:
        print(f"{error.name} is not installed: pip install 'piezo_sym[proof]'", file=sys.stderr)  # noqa: T201
        return 2
    try:
        texts = [Path(path).read_text(encoding="utf-8-sig") for path in arguments]
        found_rows = list(rows.audit(checker.read_spec(texts[0]), json.loads(texts[1])))
    except (checker.InputError, OSError, ValueError, IndexError, RecursionError) as error:
        print(f"bad input: {str(error).partition(chr(10))[0][:200]}", file=sys.stderr)  # noqa: T201
        return 2
    for name, element, why in found_rows:
        word = "not confirmed" if why else "stated" if name == rows.STATED else "confirmed"
        line = f"{word} {name} {element}".rstrip() + f": {why}" * bool(why)
        print("".join(c if c.isprintable() else "?" for c in line))  # noqa: T201
    seen = [why for name, _, why in found_rows if name != rows.STATED]
    print(f"{seen.count('')} of {len(seen)} rows confirmed; printed text is not read here")  # noqa: T201
    return int(any(why for _, _, why in found_rows))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
