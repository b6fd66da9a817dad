"""Samples from a delimited text file: its columns, units and cells.

Input: a file whose header may name units, ``t [ms]``.  Output: a frozen `Samples`, in SI.
"""

import re
import warnings
from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import islice
from math import isfinite
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from piezo_sym.errors import FileError, PiezoError, UsageError, listing, nearest, quote
from piezo_sym.files import path_of
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.samples import ZERO_CELSIUS, Samples, read_samples
from piezo_sym.run.text_tables import (
    COMMENTS,
    TextTable,
    column_headers,
    is_number,
    name_and_unit,
    open_table,
)

#: The unit of temperature with an offset in headers.
CELSIUS = "degC", "\N{DEGREE SIGN}C"
#: What stands between groups of digits: 1'000.
GROUPS = re.compile(r"(?<=\d)[\s'_\N{RIGHT SINGLE QUOTATION MARK}](?=\d{3})")
#: A number with a comma in place of the point; one that may be meant as thousands, 12,345.
DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d*([eE][-+]?\d+)?")
THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2},\d{3}")
DOTTED = re.compile(r"[-+]?\d{1,3}(\.\d{3})+,\d+")  # 1.234,5
LEAVE_OUT = "delete the line: samples are joined by straight lines"
AT_ENTRY = re.compile(r"at entry (\d+)")
#: Endings of names that are meant as units.
TIMES, VALUES = ("ns", "us", "ms", "min"), ("mV", "kV", "uA", "mA", "um", "mm", "mN", "kN", "degC")


def samples_from_csv(
    path: str | PathLike[str], column: str | None = None, time_column: str | None = None
) -> Samples:
    """Return the samples in a delimited text file (comma, semicolon or tab) with a header.

    A header such as ``t [ms],V_in [V]``, ``t (ms)`` or ``t/ms`` gives the units: times and values
    are converted to SI, and a run refuses values whose dimension is not that of its input. Without
    units, times are in s, and values in the SI unit of the input. A time given twice is a jump.
    Between semicolons or tabs numbers may have decimal commas, though not 1,234 alone, which may be
    meant as a thousand.

    Parameters
    ----------
    path : the file, in UTF-8, UTF-16 with its mark, or Windows-1252. Lines that begin with # or %
        are passed over above the header; where none follows, the last of them is the header. Units
        may have a line of their own below it.
    column : header of the values, with or without its unit; may be left out when the file has two
        columns.
    time_column : header of the times; the first column when left out.

    Raises
    ------
    FileError : the file cannot be read, or a cell is not a finite number.
    UsageError : no column has that header, a unit is unknown or no unit of time, or the times do
        not increase.
    """
    path = path_of(path, "samples_from_csv.path")
    headers = column_headers(path)
    t = 0 if time_column is None else _index_of(headers, time_column, f"{path}.time_column")
    x = _other_column(headers, t, path) if column is None else _index_of(headers, column, str(path))
    if x == t:
        what = f"column {quote(column)} has the times"
        remedy = f"others: {listing([name for n, (name, _) in enumerate(headers) if n != t])}"
        raise UsageError(what, str(path), "a column of values", remedy)
    times, values = _columns(path, t, x)
    seconds, _ = _factor(headers[t], f"{path}, header", "s")
    factor, unit = _factor(headers[x], f"{path}, header")
    values = values * factor + (ZERO_CELSIUS if headers[x][1] in CELSIUS else 0.0)
    for n, ends in ((t, TIMES), (x, VALUES)):
        _refuse_suffix(*headers[n], ends, f"{path}, header")
    defaults = (t, "s"), (x, "the input's SI unit")
    assumed = [f"{headers[n][0]} in {default}" for n, default in defaults if not headers[n][1]]
    try:
        signal = read_samples(times * seconds, values, str(path))
    except UsageError as error:
        error.what = AT_ENTRY.sub(lambda at: f"in line {_lines(path)[int(at[1])]}", error.what)
        raise
    source = f"{path}, column {quote(headers[x][0])}"
    return replace(signal, unit=unit, assumed=" and ".join(assumed), source=source)


def _lines(path: Path) -> list[int]:
    """Return the line of each row below the header; empty lines are none."""
    with open_table(path) as table:
        return [line for line, _ in table.numbered()]


def _columns(path: Path, t: int, x: int) -> tuple[FloatArray, FloatArray]:
    """Return two columns as numbers; raise `FileError` at the first cell that is not a number."""
    import pandas

    with open_table(path) as table, warnings.catch_warnings():
        warnings.simplefilter("error")
        sign = _decimal_sign(path, table, (t, x))
        with suppress(ValueError, Warning):  # the loop below finds the place of the error
            with path.open(encoding=table.encoding) as lines:  # pandas drops cells without header
                below = islice(lines, table.above, None)
                if any(line.count(table.delimiter) >= len(table.header) for line in below):
                    raise ValueError("cells without header")
            how: Any = {"index_col": False, "dtype": float, "na_filter": False, "usecols": [t, x]}
            how |= {"sep": table.delimiter, "skipinitialspace": True, "encoding": table.encoding}
            how |= {"decimal": sign, "skiprows": table.above, "header": None}
            both = pandas.read_csv(path, **how).to_numpy()[:, [0, 1] if t < x else [1, 0]]
            if np.isfinite(both).all():
                return both[:, 0], both[:, 1]
        found = table.numbered()
        cells = (_cell(row, n, path, line, table, sign) for line, row in found for n in (t, x))
        both = np.fromiter(cells, dtype=float).reshape(-1, 2)
        return both[:, 0], both[:, 1]


def _decimal_sign(path: Path, table: TextTable, columns: Collection[int]) -> str:
    """Return the decimal sign of columns: a comma if a cell has one that groups no thousands."""
    if table.delimiter == ",":
        return "."
    with path.open(encoding=table.encoding) as lines:
        for line in islice(lines, table.above, None):
            cells = line.split(table.delimiter) if "," in line else ()
            for cell in (cells[n].strip(' "\n') for n in columns if n < len(cells)):
                if DECIMAL_COMMA.fullmatch(cell) and not THOUSANDS.fullmatch(cell):
                    return ","
    return "."


def _factor(header: tuple[str, str], where: str, expected: str = "") -> tuple[float, str]:
    """Return the factor of a column's unit to SI, and its SI unit; `expected` is a like unit."""
    from piezo_sym.expressions.units import parse_unit

    name, text = header
    if not text:
        return 1.0, ""
    if text in CELSIUS and not expected:
        return 1.0, "K"
    try:
        unit = parse_unit(text, where)
    except PiezoError as error:
        raise UsageError(error.what, where, error.expected, error.remedy) from error
    if expected and unit.dimension != parse_unit(expected).dimension:
        what = f"{quote(name)} is in {text}"
        raise UsageError(what, where, f"a time, such as in {expected}")
    return float(unit.factor), unit.si


def _refuse_suffix(name: str, unit: str, ends: Collection[str], where: str) -> None:
    """Raise `UsageError` for a header without unit whose name ends in one: t_ms, t in ms."""
    start, _, end = re.sub(r"( in)?\s+", "_", name).rpartition("_")
    if start and not unit and end in ends:
        what = f"{quote(name)} is a name without a unit that ends in one"
        raise UsageError(what, where, remedy=f"write {quote(f'{start} [{end}]')}, or another name")


def _index_of(headers: Sequence[tuple[str, str]], wanted: str, where: str) -> int:
    if not isinstance(wanted, str):
        raise UsageError(f"{quote(wanted)} is no header", where, "the text over a column")
    name, wanted_unit = name_and_unit(wanted.strip())
    names = [f"{name} [{unit}]" if wanted_unit and unit else name for name, unit in headers]
    wanted = f"{name} [{wanted_unit}]" if wanted_unit else wanted
    if wanted not in names:
        raise UsageError(f"no column {quote(wanted)}", where, remedy=nearest(wanted, names))
    if names.count(wanted) > 1:
        raise UsageError(f"two columns are named {quote(wanted)}", where, "distinct headers")
    return names.index(wanted)


def _other_column(headers: Sequence[tuple[str, str]], t: int, path: object) -> int:
    others = [n for n, (name, _) in enumerate(headers) if n != t and name]
    if len(others) != 1:
        names = [headers[n][0] for n in others]
        what = f"{len(others)} columns beside the times: {listing(names)}"
        first = f"column={quote(names[0])}" if names else "column=..."
        remedy = f"in Python say which, {first}; on a command line name one like the input"
        raise UsageError(what, str(path), "one", remedy)
    return others[0]


def _cell(row: Sequence[str], n: int, path: Path, line: int, table: TextTable, sign: str) -> float:
    """Return cell n of a row as a number; raise `FileError` otherwise."""
    text, header = row[n].strip() if n < len(row) else "", table.header
    where = f"{path}, line {line}"
    if any(cell.strip() for cell in row[len(header) :]):
        remedy = "write decimals with a point, and a name for each column into line 1; "
        remedy += "delete what stands above the names"
        raise FileError(f"has {len(row)} cells", where, f"{len(header)}", remedy)
    column = f" (column {quote(header[n][0])})"
    try:
        plain = text.replace(".", "x").replace(",", ".") if sign == "," else text
        value = float(plain.replace("_", "x"))  # 1_0 is a number only in Python
    except ValueError as cause:
        what = f"{quote(text)} is not a number{column}"
        remedy = (
            "units go into the header: t [ms]"
            if line == table.above + 1 and text[:1].isalpha()
            else ""
        )
        remedy = "write decimals with a point" if is_number(text.replace(",", ".")) else remedy
        remedy = "write all decimals with one sign" * (sign == "," and is_number(text)) or remedy
        remedy = f"delete lines that begin with '{text[0]}'" if text[:1] in COMMENTS else remedy
        plain = GROUPS.sub("", text)
        plain = text.replace(".", "").replace(",", ".") if DOTTED.fullmatch(text) else plain
        remedy = f"write {plain}" if plain != text and is_number(plain) else remedy
        remedy = remedy if text else LEAVE_OUT
        raise FileError(what, where, "a number like 1.5e-3", remedy) from cause
    if not isfinite(value):
        raise FileError(f"{quote(text)} is not finite{column}", where, "a finite number", LEAVE_OUT)
    return value
