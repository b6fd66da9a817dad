"""The row `program`: that printed modules compute the proved system.

Input: an `IPHS`, and the text of its NumPy module, its C file and its step.  Output: a row.  PROVED
if every function, read back, is the proved one for all real numbers of the domain, on every branch
and for every size of every bank, and divides by nothing that the laws do not divide by; in a step
these are the stage and the integrands of its means, see `collocation`.  REFUTED with numbers at
which a row differs; OPEN with what was not understood or not shown.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import final

from piezo_sym.iphs import IPHS
from piezo_sym.report import Row, Verdict
from piezo_sym.translation.c_reader import read_c
from piezo_sym.translation.c_step import read_step
from piezo_sym.translation.change import moved
from piezo_sym.translation.collocation import proved_step
from piezo_sym.translation.field import Need, NotShownError, Value
from piezo_sym.translation.known import Key, Proved
from piezo_sym.translation.numpy_head import numpy_functions
from piezo_sym.translation.numpy_reader import read_numpy
from piezo_sym.translation.reference import proved
from piezo_sym.translation.signs import compare, factors, reading
from piezo_sym.translation.split_roots import has_split_roots
from piezo_sym.translation.witness import witness
from piezo_sym.translation.zero import Edges, edges_of, is_zero

STATEMENT = "the printed NumPy, C and step files are the proved system (real arithmetic)"
MOST_TEXT = 4_000_000
#: The texts that are read back, by the endings of their files.
READ = {".py": "NumPy", ".c": "C", "_step.c": "step"}
#: The most rows, of those not shown to be right, for which a counterexample is looked for.
MOST_TRIED = 4


#: What is said of a condition of the domain that needs more than laws do.
OUTSIDE = (
    ": it is evaluated outside the domain, too; write that condition without division, root or "
    "logarithm, as 'q <= w' for 'q/w <= 1' where w > 0"
)


@final
@dataclass(frozen=True)
class Reference:
    """The normal forms with which the printed texts of a system are compared."""

    iphs: IPHS

    @cached_property
    def system(self) -> Proved:
        """The proved system."""
        return proved(self.iphs)

    @cached_property
    def stage(self) -> Proved:
        """A stage of the system's collocation step."""
        return proved_step(self.iphs)


def program_row(iphs: IPHS, texts: Mapping[str, str], endings: Collection[str] = READ) -> Row:
    """Return the row `program` of a system, from its `printed` texts with the given endings.

    Rows on different endings can be joined by `worst`.
    """
    try:
        known = Reference(iphs)
        found = [row for end in endings for row in different(READ[end], texts[end], known)]
    except (NotShownError, RecursionError) as error:
        found = [_open(str(error))]
    return worst((*found, Row("program", "", STATEMENT, Verdict.PROVED)))


def worst(rows: Iterable[Row]) -> Row:
    """Return the first row that is refuted, or else the first that is open, or else the first."""
    order = Verdict.REFUTED, Verdict.OPEN, Verdict.PROVED
    return min(rows, key=lambda row: order.index(row.verdict))


def _open(reason: str) -> Row:
    return Row("program", "", STATEMENT, Verdict.OPEN, reason=reason)


def different(language: str, text: str, reference: Reference) -> tuple[Row, ...]:
    """Return one row on the worst difference in a NumPy, C or step text; () if there is none."""
    known = reference.stage if language == "step" else reference.system
    try:
        if len(text) > MOST_TEXT:
            raise NotShownError("the text is too long")
        known.field.needs.clear()
        rows = _read(language, text, known)
        needs = tuple(known.field.needs)
        found = list(_differences(language, rows, known))
        found += [_open(f"{language} {text}") for text in _unmet(needs, known)]
    except (NotShownError, RecursionError) as error:
        found = [_open(f"{language}: {error}")]
    return tuple(sorted(found, key=lambda row: row.verdict is not Verdict.REFUTED)[:1])


def _read(language: str, text: str, known: Proved) -> Mapping[Key, Value]:
    if language == "step":
        return read_step(text, known)
    if language == "C":
        return read_c(text, known)
    return read_numpy(numpy_functions(text, known), known)


def _differences(language: str, rows: Mapping[Key, Value], known: Proved) -> Iterator[Row]:
    """Yield a verdict on each printed row that is not shown to equal the proved one."""
    tried = 0
    for key in dict.fromkeys((*known.values, *rows)):
        printed, wanted = (table.get(key, known.field.zero) for table in (rows, known.values))
        matrix = key[0] == "jacobian"
        place = f"{language} {key[0]}{[_label(key, n, known) for n in range(1, len(key))]}"
        if not matrix and (key not in rows or key not in known.values):
            yield _open(f"{place} is not written")
        elif found := _doubt(key, printed - wanted, edges_of(wanted) if matrix else frozenset()):
            tried += 1
            if at := witness(printed, wanted, known) if tried <= MOST_TRIED else None:
                yield Row("program", "", STATEMENT, Verdict.REFUTED, at[0], f"{place} {at[1]}")
                return
            yield _open(f"{place} {found}")


def _doubt(key: Key, difference: Value, edges: Edges) -> str:
    """Return why a difference is not shown to be zero, or '' if it is."""
    try:
        with reading(difference.field, str(key[0])):
            shown = is_zero(difference, edges=edges)
        return "" if shown else "is not shown to be the proved one"
    except NotShownError as error:
        return f"is not shown to be the proved one: {error}"


def _label(key: Key, n: int, known: Proved) -> str:
    slots = known.slots[str(key[0])]
    part = key[n]
    is_slot = isinstance(part, int) and (n == 1 or key[0] == "jacobian") and part < len(slots)
    return slots[int(part)].label if is_slot else str(part)


def _unmet(needs: tuple[Need, ...], known: Proved) -> Iterator[str]:
    """Yield a reason for each divisor, or argument of a root, that only printed code has."""
    field, allowed, split = known.field, dict[Value, list[Need]](), has_split_roots(known)
    for given in known.needs:
        if split and given.kind == "nonnegative" and not given.outside:
            continue  # it may be that of a factor alone
        allowed.setdefault(given.value, []).append(given)
        for factor, _ in factors(given.value) if given.kind == "nonzero" else ():
            allowed.setdefault(factor, []).append(given)  # a nonzero product has nonzero factors
    for need in needs:
        value = _in_first_lane(need.value)
        nonzero = [  # values that are nonzero wherever printed code needs `value`
            g.value
            for g in known.needs
            if g.kind in {"nonzero", "positive"} and g.path == field.one and _covers(g, need)
        ]
        op = {"nonzero": "==", "nonnegative": "<"}.get(need.kind, "<=")
        with reading(field, need.outside):
            fails = compare(op, value, field.zero)
            left = _in_first_lane(need.path) * fails
            for given in allowed.get(value, ()):
                if given.kind in (need.kind, "positive") and _covers(given, need):
                    left = left * (field.one - given.path)
            # a derivative divides by the square of a law's divisor
            met = is_zero(left) or any(is_zero(value - d * d) for d in nonzero)
        if not met and not _is_square_sum(value, nonzero):
            where = "jacobian" if need.derived else need.outside or "code"
            why = OUTSIDE * (need.outside == "margins")
            yield f"{where} needs a value to be {need.kind} that is not shown to be so{why}"


def _is_square_sum(value: Value, nonzero: Collection[Value]) -> bool:
    """Return whether a value is positive as a sum of even powers, one of them of nonzero names."""
    field = value.field
    squares = all(
        c > 0 and all(field.gens[g].kind == "name" and e > 0 and e % 2 == 0 for g, e in mono)
        for mono, c in value.terms.items()
    )
    return squares and any(
        all(field.raised(g, 1) in nonzero for g, _ in mono) for mono in value.terms
    )


def _covers(given: Need, need: Need) -> bool:
    """Return whether a need of the laws holds wherever printed code has the same need."""
    return (need.derived or not given.derived) and need.outside in ("", given.outside)


def _in_first_lane(value: Value) -> Value:
    """Return a value that depends on the column's lane of a bank alone, moved to the row's lane."""
    for bank, lane in value.lanes:
        if lane == 1 and (bank, 0) not in value.lanes:
            value = moved(value, bank, 0)
    return value
