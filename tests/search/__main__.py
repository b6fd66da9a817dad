"""The search: ``python -m tests.search --slices 0:50 --out FILE``.

A slice that FILE has is not run again; each adds one line of JSON, then the totals are printed.
"""

import argparse
import json
import signal
import sys
from collections import Counter
from pathlib import Path

from tests.search.proving import Prover
from tests.search.slices import SPECS, slice_of


def main(words=None, prover_of=Prover):
    """Run the slices asked for that are not there yet."""
    parser = argparse.ArgumentParser(prog="python -m tests.search", description=__doc__)
    parser.add_argument("--slices", default="0:1", help="from:to, to not included")
    parser.add_argument("--out", type=Path, default=Path("search.jsonl"))
    parser.add_argument("--specs", type=int, default=SPECS, help="specs of a slice")
    parser.add_argument("--limit", type=float, default=60, help="seconds of a spec")
    parser.add_argument("--stage", choices=("laws", "decide", "verify"), default="laws")
    asked = parser.parse_args(words)
    done = {record["slice"] for record in records(asked.out)}
    first, last = map(int, asked.slices.split(":"))
    prover = prover_of(asked.limit, asked.stage)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    try:
        for number in range(first, last):
            if number not in done:
                record = slice_of(number, prover, asked.specs)
                with asked.out.open("a") as file:
                    file.write(json.dumps(record) + "\n")
                print(line(record), flush=True)
    finally:
        prover.close()
    print(summary(records(asked.out)))


def records(path):
    """Return the records of a file."""
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def line(record):
    """Return a slice in a line."""
    kinds = Counter(fault["kind"] for fault in record["faults"])
    return f"slice {record['slice']}: {record['laws']} laws, {record['seconds']}, {dict(kinds)}"


def summary(found):
    """Return the totals."""
    total, seconds = Counter(), Counter()
    for record in found:
        total.update({k: v for k, v in record["counts"].items() if not k.startswith("refused:")})
        seconds.update(record["seconds"])
    laws = sum(record["laws"] for record in found)
    spent = sum(v for name, v in seconds.items() if "wall" not in name)
    rate = laws / max(spent, 1e-9) * 3600
    rounded = {name: round(value) for name, value in seconds.items()}
    rows = [f"  {name:32} {count}" for name, count in sorted(total.items())]
    return "\n".join([f"{laws} laws, {rounded} s, {rate:.0f} laws per hour of processor", *rows])


if __name__ == "__main__":
    main()
