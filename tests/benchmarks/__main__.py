"""``python -m tests.benchmarks [SPEC]``: the reports that are kept in ``notebooks/``.

Input: a spec and what drives it.  Output: the table in Markdown, also as a file, and as JSON.
Peers come with the extra ``bench``; each is left out where it is not installed.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

from piezo_sym import PiezoError, load
from piezo_sym.cli.words import Units, pairs
from piezo_sym.files import write_text
from piezo_sym.run.checks import positive
from tests.benchmarks.groups import GROUPS, bench
from tests.benchmarks.output import as_json, markdown
from tests.benchmarks.settings import QUICK, THOROUGH


def main(words: list[str] | None = None) -> int:
    """Measure what is asked for, print the report, and return the exit code."""
    given = _parser().parse_args(words)
    settings = QUICK if given.quick else THOROUGH
    try:
        report = bench(
            load(given.spec),
            inputs=dict(pairs(given.input, "--input", Units(given.spec).signal)),
            duration=positive(given.duration, "--duration"),
            only=given.only,
            settings=replace(settings, rounds=given.repeat) if given.repeat else settings,
            say=lambda group: print(f"measuring {group} ...", file=sys.stderr),
        )
    except PiezoError as error:
        print(error, file=sys.stderr)
        return 2
    print(markdown(report))
    for path, text in ((given.json, as_json), (given.markdown, markdown)):
        if path is not None:
            write_text(path, text(report))
    return 0


def _parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(prog="python -m tests.benchmarks")
    made.add_argument("spec", nargs="?", default="piezo_stack", help="path or shipped name")
    made.add_argument(
        "--only", action="append", default=[], metavar="GROUP", help=", ".join(GROUPS)
    )
    made.add_argument(
        "--quick", action="store_true", help="few repetitions, no peers over 1 s a run"
    )
    made.add_argument("--repeat", type=int, help="repetitions of each call")
    made.add_argument("--duration", type=float, default=0.1, help="of the short run [s]")
    made.add_argument("--input", action="append", default=[], metavar="NAME=VALUE", help="SI")
    made.add_argument("--json", type=Path, help="file for the report as JSON")
    made.add_argument("--markdown", type=Path, help="file for the report as Markdown")
    return made


if __name__ == "__main__":
    sys.exit(main())
