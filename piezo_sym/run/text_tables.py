"""Delimited text files as instruments write them: encoding, comments, header, units, rows.

Input: the path of a file.  Output: an open `TextTable`: names and units of its columns, its rows.
"""

import csv
import re
from codecs import getincrementaldecoder
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from os import PathLike
from pathlib import Path
from typing import final

from piezo_sym.errors import FileError, PiezoError
from piezo_sym.files import near_file

DELIMITERS, COMMENTS = ",;\t", ("#", "%")
#: Bytes that show an encoding; the most lines down to the second below a header.
START, MOST_ABOVE = 1 << 16, 200
HEADER = re.compile(r"(?P<name>.*?)\s*\[(?P<unit>[^\[\]]*)\]")  # a name and its unit, t [ms]
OTHERWISE = re.compile(  # t (ms), t/ms
    r"(?P<name>.*?)\s*(?:\((?P<unit>[^()]+)\)|/\s*(?P<over>[^/()]+))"
)


def header_of(name: object, unit: str) -> str:
    """Return the header of a column as it is read; unit "1" is left out."""
    return f"{name}" if unit == "1" else f"{name} [{unit}]"


def column_headers(path: str | PathLike[str]) -> list[tuple[str, str]]:
    """Return the names and units in the header of a delimited text file; "" for no unit."""
    with open_table(Path(path)) as table:
        return table.header


@final
@dataclass(frozen=True)
class TextTable:
    """An open table: its header, what is above its rows, and these."""

    header: list[tuple[str, str]]  # the name and the unit of each column, "" for no unit
    delimiter: str
    encoding: str
    above: int  # lines above the first row
    rows: Iterator[list[str]]

    def numbered(self) -> Iterator[tuple[int, list[str]]]:
        """Yield each row that is not empty with the number of its line."""
        return ((line, row) for line, row in enumerate(self.rows, self.above + 1) if row)


@contextmanager
def open_table(path: Path) -> Iterator[TextTable]:
    """Open a delimited text file; raise `FileError` if it is none."""
    try:
        with path.open("rb") as raw:
            encoding = _encoding(raw.read(START))
        with path.open(encoding=encoding, newline="") as file:
            lines = list(islice(file, MOST_ABOVE))
            if not lines:
                raise FileError("is empty", str(path), "a header line, then numbers")
            header, delimiter, above = _header(lines, path)
            file.seek(0)
            rows = csv.reader(file, delimiter=delimiter, skipinitialspace=True)
            yield TextTable(header, delimiter, encoding, above, islice(rows, above, None))
    except OSError as cause:
        what = f"cannot be read: {cause.strerror}"
        raise FileError(what, str(path), remedy=near_file(path)) from cause
    except UnicodeError as cause:
        raise FileError("is not text in UTF-8", str(path), remedy="save it as UTF-8") from cause


def _encoding(start: bytes) -> str:
    """Return the encoding of a file that starts so: UTF-8, or what instruments write on Windows."""
    if start[:2] in {b"\xff\xfe", b"\xfe\xff"}:
        return "utf-16"
    try:
        getincrementaldecoder("utf-8")().decode(start)
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8-sig"


def _header(lines: Sequence[str], path: Path) -> tuple[list[tuple[str, str]], str, int]:
    """Return names and units of columns, the delimiter, and how many lines are above the rows.

    Comments above the header are passed over; above numbers, the last of them is the header.  A
    line of units may follow it.
    """
    above = next((n for n, line in enumerate(lines) if line[0] not in COMMENTS), len(lines))
    left = lines[above:] or [""]
    delimiter = max(DELIMITERS, key=left[0].count)
    names = _cells(left[0], delimiter)
    if above and all(is_number(name.replace(",", ".")) for name in names if name):
        above, left = above - 1, [lines[above - 1].lstrip("".join(COMMENTS)), *left]
        delimiter = max(DELIMITERS, key=left[0].count)
        names = _cells(left[0], delimiter)
    fault, remedy = _header_fault(names, above + 1)
    if fault:
        raise FileError(fault, str(path), "a header line, such as t [s],V_in [V]", remedy)
    header = [name_and_unit(name) for name in names]
    units = [text.strip("[]()") for text in _cells(left[1], delimiter)] if left[1:] else []
    plain = len(units) == len(names) and not any(unit for _, unit in header)
    named = [unit for name, unit in zip(names, units, strict=False) if name]
    if plain and all(_is_unit(unit) and not is_number(unit) for unit in named):
        header = [(name, _ascii(unit)) for name, unit in zip(names, units, strict=True)]
        above += 1
    return header, delimiter, above + 1


def _cells(line: str, delimiter: str) -> list[str]:
    row = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
    return [cell.strip() for cell in row]


def _header_fault(names: Sequence[str], line: int) -> tuple[str, str]:
    """Return why these cells are no header, if they are none, and what to do."""
    if not any(names):
        return f"line {line} is empty", "delete empty lines at the beginning"
    if all(is_number(name) for name in names):
        return f"line {line} has numbers where names are expected", ""
    if len(names) == 1:
        what = f"line {line} has one name"
        return what, "separate times and values by a comma, semicolon or tab"
    return "", ""


def name_and_unit(text: str) -> tuple[str, str]:
    """Return the name and the unit in a header: t [ms]; t (ms) or t/ms, where ms is a unit."""
    if match := HEADER.fullmatch(text):
        return match["name"], _ascii(match["unit"].strip())
    if match := OTHERWISE.fullmatch(text):
        unit = (match["unit"] or match["over"]).strip()
        if _is_unit(unit):
            return match["name"], _ascii(unit)
    return text, ""


def _ascii(unit: str) -> str:
    from piezo_sym.expressions.units import ASCII

    return unit.translate(ASCII)


def _is_unit(text: str) -> bool:
    """Return whether a text is meant as a unit; also degC and non-ASCII units, refused later."""
    from piezo_sym.expressions.units import parse_unit

    try:
        parse_unit(text)
    except PiezoError as error:
        return not text.isascii() or "offset" in error.what
    return True


def is_number(text: str) -> bool:
    """Return whether a cell is a number as Python writes it."""
    try:
        float(text)
    except ValueError:
        return False
    return True
