"""Statements of C: definitions, and loops over lanes.

Input: stages of a function.  Output: lines of C99.  A function defines only what it uses.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.codegen.c.order import LaneLoop, LoopStage, Write
from piezo_sym.codegen.c.style import (
    c_piece,
    c_style,
    is_constant,
    real_style,
    widened,
    with_branches,
)
from piezo_sym.codegen.layout import term_lines
from piezo_sym.codegen.program import Quantity
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.text import Style, piece, write_comparison
from piezo_sym.expressions.tree import Add, Expr, If, LaneSum

WIDTH = 96
#: Calls that compilers do not vectorise; a loop with such a call gets no directive.
_ALONE = "|".join(record.in_c for record in RECORDS.values() if record.transcendental)
LIBRARY = re.compile(rf"\b(?:{_ALONE}|pow)(?:_of)?\(")


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
    if words.number != "double" and is_constant(value):
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


def _definitions(quantities: Iterable[Quantity], words: Words) -> Iterator[str]:
    """Yield definitions, with a comment where the kind of quantity changes."""
    note = ""
    for quantity in quantities:
        if quantity.note != note:
            note = quantity.note
            yield f"/* {note} */"
        yield from define(quantity, words)


def stage_lines(stage: LoopStage, words: Words) -> Iterator[str]:
    """Yield the lines of one stage."""
    yield from _definitions(stage.shared, words)
    for loop in stage.loops:
        yield from loop_lines(loop, words)


def loop_lines(loop: LaneLoop, words: Words) -> Iterator[str]:
    """Yield a loop over the lanes of a bank, after its initial values."""
    sums = [words.names[quantity.name] for quantity in loop.sums]
    parts = [*(["sums over lanes"] if loop.sums else []), *(["result"] if loop.writes else [])]
    yield f"/* each lane of {loop.bank}: {' and '.join(parts)} */"
    zero = "0.0" if words.number == "double" else "zero"
    yield from (f"{words.number} {name} = {zero};" for name in sums)
    most = "HUGE_VAL" if words.number == "double" else "wide(HUGE_VAL)"
    yield from (f"{w.target} = {most};" for w in loop.writes if w.how == "min")
    body = list(_body(loop, words))
    if not any(map(LIBRARY.search, body)):
        yield from _directive(sums, loop.writes)
    yield f"for (long {words.lane} = 0; {words.lane} < {loop.bank}_count; ++{words.lane}) {{"
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


def _body(loop: LaneLoop, words: Words) -> Iterator[str]:
    for quantity in loop.lanes:
        yield from define(quantity, words)
    for quantity in loop.sums:
        value = quantity.value.arg if isinstance(quantity.value, LaneSum) else quantity.value
        yield from statement(f"{words.names[quantity.name]} +=", value, words)
    for write in loop.writes:
        yield from write_lines(write, words)


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
