"""Statements of C: definitions, loops over the lanes of banks, and what they write.

Input: quantities and `Write`s.  Output: lines of C99.  A function defines only what it uses.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.codegen.c.style import (
    c_piece,
    c_style,
    real_style,
    widened,
    with_branches,
)
from piezo_sym.codegen.layout import term_lines
from piezo_sym.codegen.program import Limit, Quantity, bank_of, needed
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.text import Style, piece, write_comparison
from piezo_sym.expressions.tree import Add, Expr, If, LaneSum, names

WIDTH = 96
#: Calls that compilers do not vectorise; a loop with such a call gets no directive.
_ALONE = "|".join(record.in_c for record in RECORDS.values() if record.transcendental)
LIBRARY = re.compile(rf"\b(?:{_ALONE}|pow)(?:_of)?\(")


@final
@dataclass(frozen=True)
class Write:
    """A value and its target, a text; `bank` if there is one per lane.

    `how` is "=", "+=", or "min" for the minimum over the lanes.
    """

    target: str
    value: Expr
    bank: str | None = None
    how: str = "="


def least_over_lanes(
    array: str, limits: Iterable[Limit], lanes: Mapping[str, str]
) -> Iterator[Write]:
    """Yield the writes of the margins of some conditions."""
    for n, limit in enumerate(limits):
        bank = bank_of(limit.margin, lanes)
        yield Write(f"{array}[{n}]", limit.margin, bank, "min" if bank else "=")


@final
@dataclass(frozen=True)
class Words:
    """The identifiers of a text."""

    names: Mapping[str, str]  # the C name of each name of the program
    arrays: Mapping[str, str]  # the bank of each parameter and state that is an array over lanes
    lane: str  # the index of a loop over lanes
    number: str = "double"  # the type of numbers; ``real`` in a text for all vector widths

    def style(self, lane: str | None = None) -> Style:
        """Return the spelling of expressions in a lane, the loop's if none is given."""
        style = c_style(self.names, self.arrays, lane or self.lane)
        return style if self.number == "double" else real_style(style)

    def text(self, value: Expr, lane: str | None = None) -> str:
        """Return an expression as C."""
        return c_piece(value, self.style(lane))[0]


def indented(lines: Iterable[str], depth: int = 1) -> Iterator[str]:
    """Yield indented lines; directives stay at the left."""
    for line in lines:
        yield line if line.startswith("#") or not line else f"{'    ' * depth}{line}"


def statement(target: str, value: Expr, words: Words, lane: str | None = None) -> list[str]:
    """Return ``target value;``; a long value gets one line per term or case.

    `target` ends with an operator, such as ``=``.
    """
    parts, style = with_branches(value), words.style(lane)
    text = piece(parts, style)[0]
    if words.number != "double" and not names(value):
        text = f"wide({text})"
    if len(target) + len(text) + 10 <= WIDTH or not isinstance(parts, Add | If):
        return [f"{target} {text};"]
    if isinstance(parts, If):
        return _pick(target, parts, style, wide=words.number != "double")
    lines = list(term_lines(parts, lambda part: c_piece(part, style)))
    return [f"{target} {lines[0]}", *(f"    {line}" for line in lines[1:-1]), f"    {lines[-1]};"]


def _pick(target: str, value: If, style: Style, *, wide: bool) -> list[str]:
    """Return a call of ``pick``, or of ``chosen`` for every width, with a line per argument."""
    condition = write_comparison(value.condition, style)
    parts = [c_piece(part, style) for part in (value.then, value.other)]
    then, other = (widened(part) if wide else part[0] for part in parts)
    word = "chosen" if wide else "pick"
    return [f"{target} {word}(", f"    {condition},", f"    {then},", f"    {other});"]


def define(quantity: Quantity, words: Words, lane: str | None = None) -> list[str]:
    """Return the definition of a quantity, shared or of one lane."""
    return statement(
        f"const {words.number} {words.names[quantity.name]} =", quantity.value, words, lane
    )


def computing(
    quantities: Sequence[Quantity], writes: Sequence[Write], banks: Iterable[str], words: Words
) -> Iterator[str]:
    """Yield the lines that compute quantities, and write the rows of banks, stage after stage.

    A value that needs no sum over lanes is of stage 0; one that needs such a sum is of a later
    stage.  A bank has one loop per stage, which computes the quantities of each lane, adds up the
    sums and writes the rows of the lane, so that nothing is stored per lane; a quantity that a
    later loop needs is computed again.
    """
    totals = {q.name: q.value for q in quantities if isinstance(q.value, LaneSum)}
    level: dict[str, int] = {}  # the first stage in which the value of each quantity is available
    for quantity in quantities:
        level[quantity.name] = _level(quantity.value, level) + (quantity.name in totals)
    for n in range(max([0, *(_level(w.value, level) for w in writes), *level.values()]) + 1):
        shared = (q for q in quantities if not q.bank and q.name not in totals)
        yield from _definitions((q for q in shared if level[q.name] == n), words)
        for bank in banks:
            there = {name: total for name, total in totals.items() if total.bank == bank}
            sums = {name: total.arg for name, total in there.items() if level[name] == n + 1}
            rows = [w for w in writes if w.bank == bank and _level(w.value, level) == n]
            if sums or rows:
                roots = [*sums.values(), *(w.value for w in rows)]
                lanes = lane_quantities(quantities, bank, roots)
                yield from _loop(bank, lanes, sums, rows, words)


def _level(value: Expr, level: Mapping[str, int]) -> int:
    return max((level.get(name, 0) for name in names(value)), default=0)


def lane_quantities(
    quantities: Sequence[Quantity], bank: str, roots: Iterable[Expr]
) -> tuple[Quantity, ...]:
    """Return the quantities of one lane that some expressions need, in order."""
    return needed([q for q in quantities if q.bank == bank], roots)[0]


def _definitions(quantities: Iterable[Quantity], words: Words) -> Iterator[str]:
    """Yield definitions, with a comment where the kind of quantity changes."""
    note = ""
    for quantity in quantities:
        if quantity.note != note:
            note = quantity.note
            yield f"/* {note} */"
        yield from define(quantity, words)


def _loop(
    bank: str,
    lanes: Iterable[Quantity],
    sums: Mapping[str, Expr],
    writes: Sequence[Write],
    words: Words,
) -> Iterator[str]:
    """Yield a loop over the lanes of a bank, after its initial values."""
    totals = [words.names[name] for name in sums]
    parts = [*(["sums over lanes"] if sums else []), *(["result"] if writes else [])]
    yield f"/* each lane of {bank}: {' and '.join(parts)} */"
    zero = "0.0" if words.number == "double" else "zero"
    yield from (f"{words.number} {name} = {zero};" for name in totals)
    most = "HUGE_VAL" if words.number == "double" else "wide(HUGE_VAL)"
    yield from (f"{w.target} = {most};" for w in writes if w.how == "min")
    body = [line for quantity in lanes for line in define(quantity, words)]
    for name, value in sums.items():
        body += statement(f"{words.names[name]} +=", value, words)
    body += [line for write in writes for line in write_lines(write, words)]
    if not any(map(LIBRARY.search, body)):
        yield from _directive(totals, writes)
    yield f"for (long {words.lane} = 0; {words.lane} < {bank}_count; ++{words.lane}) {{"
    yield from indented(body)
    yield "}"


def _directive(sums: Sequence[str], writes: Sequence[Write]) -> Iterator[str]:
    """Yield the directive that lets a compiler vectorise over lanes and reorder sums.

    A loop with a minimum over lanes gets none: it is no sum reduction, and would be wrong.
    """
    if not sums or any(write.how == "min" for write in writes):
        yield from ["#pragma omp simd"] if all(write.how == "=" for write in writes) else []
        return
    line = "#pragma omp simd reduction(+:"
    for name in sums[:-1]:
        if len(line) + len(name) + 4 > WIDTH:
            yield f"{line} \\"
            line = "   "
        line += f" {name}," if not line.endswith(":") else f"{name},"
    joint = "" if line.endswith(":") else " "
    yield f"{line}{joint}{sums[-1]})"


def write_lines(write: Write, words: Words) -> list[str]:
    """Return the lines that write a value to its target."""
    if write.how == "min":
        least = "min" if words.number == "double" else "least"
        return [f"{write.target} = {least}({write.target}, {words.text(write.value)});"]
    return statement(f"{write.target} {write.how}", write.value, words)


def used_only(
    body: Sequence[str], definitions: Sequence[tuple[str, str]], arguments: Iterable[str]
) -> list[str]:
    """Return the definitions that `body` needs, after a ``(void)`` for each unused argument."""
    seen = _identifiers(body)
    kept: list[str] = []
    for name, line in reversed(definitions):
        if name in seen:
            kept.append(line)
            seen |= _identifiers([line])
    idle = [f"(void){name};" for name in arguments if name not in seen]
    return [*idle, *reversed(kept)]


def _identifiers(lines: Iterable[str]) -> set[str]:
    text = re.sub(r"/\*.*?\*/", "", "\n".join(lines))
    return set(re.findall(r"(?<![\w.>])[A-Za-z_]\w*", text)) | set(re.findall(r"\b(\w+)->", text))
