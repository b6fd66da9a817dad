"""Signals from samples: straight lines between (t, values), from arrays or a text file.

Input: times [s] and values, or a delimited text file with a header.  Output: a frozen `Samples`.
"""

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import inf
from os import PathLike
from pathlib import Path
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from piezo_sym.errors import FileError, UsageError, listing, nearest, quote
from piezo_sym.run.checks import FloatArray, increasing, vector
from piezo_sym.run.signals import MOST_CORNERS, Signal

DELIMITERS = ",;\t"
SLACK = 1e-9  # of the duration: a last sample may fall short by rounding


@final
@dataclass(frozen=True, eq=False)
class Samples(Signal):
    """Straight lines between samples; see `samples`."""

    times: FloatArray
    values: FloatArray

    def _values(self, t: FloatArray | float) -> FloatArray:
        return np.asarray(np.interp(t, self.times, self.values))

    def knots(self, duration: float) -> FloatArray:
        """Return the times of the samples in (0, duration)."""
        return self.times[(self.times > 0) & (self.times < duration)]

    def _corners(self, duration: float) -> Iterable[float]:
        """Return the times of the samples when they are few, otherwise none."""
        knots = self.knots(duration)
        return knots if knots.size <= MOST_CORNERS else ()

    def max_step(self, duration: float) -> float:
        """Return the median distance of the samples when they are many, otherwise infinity."""
        knots = self.knots(duration)
        return float(np.median(np.diff(knots))) if knots.size > MOST_CORNERS else inf

    def covers(self, duration: float) -> bool:
        """Return whether the samples span [0, duration]."""
        slack = SLACK * duration
        return bool(self.times[0] <= slack and self.times[-1] >= duration - slack)


def samples(times: ArrayLike, values: ArrayLike) -> Samples:
    """Return the straight lines between the samples (times, values).

    Parameters
    ----------
    times : strictly increasing [s], shape (n,), n >= 2.
    values : in the input's unit, shape (n,).

    Raises
    ------
    UsageError : an entry is not a finite number, lengths differ, or times do not increase.
    """
    return read_samples(times, values, "samples")


def read_samples(times: object, values: object, where: str) -> Samples:
    """Return `samples(times, values)`; its errors name `where`."""
    t = increasing(vector(times, f"{where}.times"), f"{where}.times")
    x = vector(values, f"{where}.values")
    if t.size != x.size or t.size < 2:
        what = f"{t.size} times and {x.size} values"
        raise UsageError(what, where, "as many values as times, two at least")
    return Samples(t, x)


def samples_from_csv(
    path: str | PathLike[str], column: str | None = None, time_column: str | None = None
) -> Samples:
    """Return the samples in a delimited text file (comma, semicolon or tab) with a header.

    Parameters
    ----------
    path : the file, UTF-8.
    column : header of the values; may be left out when the file has two columns.
    time_column : header of the times [s]; the first column when left out.

    Raises
    ------
    FileError : the file cannot be read, or a cell is not a finite number.
    UsageError : no column has that header, or the times do not increase.
    """
    names, body = table(path)
    t = position(names, names[0] if time_column is None else time_column, f"{path}.time_column")
    x = position(names, other_column(names, t, path) if column is None else column, str(path))
    cells = [(line, row) for line, row in enumerate(body, start=2) if row]
    times = [cell(row, t, f"{path}, line {line}") for line, row in cells]
    values = [cell(row, x, f"{path}, line {line}") for line, row in cells]
    return read_samples(times, values, str(path))


def column_names(path: str | PathLike[str]) -> list[str]:
    """Return the headers of a delimited text file; raise `FileError` if it cannot be read."""
    names, _ = table(path)
    return names


def table(path: str | PathLike[str]) -> tuple[list[str], list[list[str]]]:
    """Return the headers of a delimited text file and its rows; raise `FileError` otherwise."""
    lines = text_lines(Path(path))
    delimiter = max(DELIMITERS, key=lines[0].count)
    header, *body = csv.reader(lines, delimiter=delimiter, skipinitialspace=True)
    return [name.strip() for name in header], body


def text_lines(path: Path) -> list[str]:
    """Return the lines of a text file, at least one; raise `FileError` otherwise."""
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except OSError as cause:
        what = f"cannot be read: {cause.strerror}"
        raise FileError(what, str(path)) from cause
    except UnicodeDecodeError as cause:
        what = "is not text in UTF-8"
        raise FileError(what, str(path), remedy="save it as UTF-8") from cause
    if not lines:
        what = "is empty"
        raise FileError(what, str(path), "a header line, then numbers")
    return lines


def position(names: Sequence[str], wanted: str, where: str) -> int:
    """Return the position of the one column named `wanted`."""
    if names.count(wanted) == 1:
        return names.index(wanted)
    if wanted in names:
        what = f"two columns are named {quote(wanted)}"
        raise UsageError(what, where, "distinct headers")
    what = f"no column {quote(wanted)}"
    raise UsageError(what, where, remedy=nearest(str(wanted), names))


def other_column(names: Sequence[str], t: int, path: object) -> str:
    """Return the only column beside the times."""
    others = [name for i, name in enumerate(names) if i != t]
    if len(others) != 1:
        what = f"{len(others)} columns beside the times: {listing(others)}"
        raise UsageError(what, str(path), "one", "say column=...")
    return others[0]


def cell(row: Sequence[str], at: int, where: str) -> float:
    """Return one cell as a finite float; raise `FileError` otherwise."""
    text = row[at].strip() if at < len(row) else ""
    try:
        value = float(text)
    except ValueError as cause:
        what = f"{quote(text)} is not a number"
        raise FileError(what, where, "a number like 1.5e-3") from cause
    if not np.isfinite(value):
        what = f"{quote(text)} is not finite"
        raise FileError(what, where, "a finite number")
    return value
