"""Path functionals in C: their inner states, and what they take.

Input: a `Program` and its paths.  Output: a table for the engine, and rows for the printer.
"""

from __future__ import annotations

from collections.abc import Sequence

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.paths import Path
from piezo_sym.codegen.program import OutputRow, Program


def path_table(program: Program, paths: Sequence[Path]) -> str:
    """Return the table of path functionals."""
    index, banks = {s.name: n for n, s in enumerate(program.states)}, [*program.counts]
    lines = ["/* Path functionals: bank or -1, whether each lane has a drive, inner state. */"]
    lines += [f"#define PATHS {len(paths)}", f"static const int {program.name}_path[PATHS][3] = {{"]
    for path in paths:
        bank = banks.index(path.bank) if path.bank else -1
        lines.append(f"    {{{bank}, {int(path.own)}, {index[path.inner]}}},")
    return "\n".join([*lines, "};"])


def path_rows(paths: Sequence[Path]) -> list[OutputRow]:
    """Return what each path functional takes."""
    values = [(path, value) for path in paths for value in (path.stiffness, path.limit)]
    return [OutputRow(Slot(path.inner, path.bank), value) for path, value in values]


def drive_rows(paths: Sequence[Path]) -> list[OutputRow]:
    """Return the rates of coordinates."""
    return [OutputRow(Slot(p.slip, p.bank if p.own else None), p.drive) for p in paths]
