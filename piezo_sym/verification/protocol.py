"""What the process that examines systems is asked, and what it answers besides texts and rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, final

if TYPE_CHECKING:
    from piezo_sym.iphs import IPHS
    from piezo_sym.report import Row
    from piezo_sym.spec.model import Model


@final
@dataclass(frozen=True)
class Request:
    """A request to the process: the system to examine, the time, and what is known already."""

    subject: IPHS | Model  # the system, or a model of it
    seconds: float  # after which the process is stopped
    #: How often each row, by its number, took more than its share of the time: after once it comes
    #: last, after twice it is left out.
    late: Mapping[int, int] = field(default_factory=dict)
    #: Rows that were decided before; of these, proved ones may not have been attacked yet.
    known: Mapping[int, Row] = field(default_factory=dict)


@final
@dataclass(frozen=True)
class Progress:
    """The rows decided since the last message, and the row that is examined next."""

    #: Verdicts by their number in the report; those beyond its rows are added to it.
    rows: Mapping[int, Row]
    next: int | None = None  # the number of the row that is looked at next, or None
    part: float = 1.0  # of the time that is left, which that row may take
    #: Rows that are proved but not attacked yet: their verdicts are not final.
    proved: Mapping[int, Row] = field(default_factory=dict)


@final
@dataclass(frozen=True)
class Stop:
    """Why there are no more messages."""

    reason: str  # in words, with {limit} for the seconds that there were in all
    last: bool = False  # whether the system is not to be examined again


#: The time is over; a row has taken more than its share of it; a process ended.
OVERDUE = Stop("not decided in {limit:g} s", last=True)
LATE = Stop("not decided in its share of {limit:g} s")
ENDED = Stop("not decided: the process ended, for want of memory or by a fault")
KILLED = Stop(ENDED.reason, last=True)
TOO_LARGE = Stop("needs more memory than it is given")
