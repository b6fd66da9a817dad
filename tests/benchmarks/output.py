"""A report as text: Markdown, JSON.

Input: a `Report`.  Output: text.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import TYPE_CHECKING

from piezo_sym.bench.contest import COLUMNS

if TYPE_CHECKING:
    from tests.benchmarks.machine import Machine
    from tests.benchmarks.report import Report

BATCHES = (
    "the time of a batch is that of one call, shared among its states; below about 1000 of them "
    "the call itself, some microseconds, is most of it, and ratios are smaller than these"
)
SWEEPS = (
    "the time of a sweep is that of one of its runs; small sweeps gain less by lanes and threads; "
    "single runs in C: each a call of its own; one by one: without lanes"
)


def about(machine: Machine) -> str:
    """Return where it was measured, in one line."""
    versions = ", ".join(f"{name} {number}" for name, number in machine.versions)
    return (
        f"{machine.processor}, {machine.cores} cores, {machine.system}; {machine.compiler}; "
        f"Python {machine.python}; {versions}; {machine.date}"
    )


def notes(report: Report) -> tuple[str, ...]:
    """Return what errors are, tolerances, and what was left out, one line each."""
    measures = {row.group: row.measure for row in report.rows if row.measure}
    lines = [f"errors of {group}: {measure}" for group, measure in measures.items()]
    told = (f"{row.group}, {row.other or row.ours}: {row.note}" for row in report.rows if row.note)
    lines += dict.fromkeys(told)
    if any(row.group.startswith("batch of") for row in report.rows):
        lines.append(BATCHES)
    if any(row.group == "sweep" for row in report.rows):
        lines.append(SWEEPS)
    return (*lines, *(f"left out: {line}" for line in report.left_out))


def markdown(report: Report) -> str:
    """Return a report as a Markdown document."""
    head = f"# Benchmark of {report.model}\n\n{about(report.machine)}\n\n"
    explained = (
        "Medians of interleaved repetitions in one process, short calls repeated for 20 ms each "
        "time; the ratio is the other's time over ours, round by round, with its quartiles.\n\n"
    )
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    lines += ["| " + " | ".join(row.cells) + " |" for row in report.rows]
    listed = "".join(f"- {line}\n" for line in notes(report))
    return f"{head}{explained}" + "\n".join(lines) + f"\n\n{listed}"


def as_json(report: Report) -> str:
    """Return a report as JSON: its dataclasses, field by field; seconds, and null for nothing."""
    return json.dumps(asdict(report), indent=1) + "\n"
