"""The records that march.c works on, and the room that members have for their numbers.

Input: sizes.  Output: `Model`, `Path`, `Member`, `Intervals` as C has them, and `Room`: one row of
numbers a member, and which part of it each pointer of its record points to.
"""

import ctypes
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate
from math import prod
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray

POINTER, LONG, DOUBLE = ctypes.c_void_p, ctypes.c_long, ctypes.c_double
NUMBER, WORD = ctypes.sizeof(DOUBLE), ctypes.sizeof(POINTER)
#: Numbers between two arrays of a row, no numbers themselves: tests see there who leaves an array.
GAP = 0


class Model(ctypes.Structure):
    """MODEL(model): parameters, sizes, and room for one step."""

    _fields_ = [
        ("p", POINTER),
        *((name, LONG) for name in ("n", "rows", "ports", "processes", "inputs")),
        *((name, POINTER) for name in ("space", "largest")),
        *((name, LONG) for name in ("iterations", "halvings", "begun", "start")),
    ]


class Path(ctypes.Structure):
    """MODEL(path): a state, its last two changes, its ledger."""

    _fields_ = [
        *((name, POINTER) for name in ("x", "last", "prior")),
        *((name, DOUBLE) for name in ("h", "h_prior")),
        *((name, POINTER) for name in ("sums", "lost")),
    ]


class Member(ctypes.Structure):
    """MODEL(member): a run among others."""

    _fields_ = [
        ("model", Model),
        ("path", Path),
        *((name, POINTER) for name in ("out_x", "out_sums")),
        *((name, LONG) for name in ("done", "steps", "failed")),
    ]


class Intervals(ctypes.Structure):
    """MODEL(block): the intervals that members go through, and the inputs in them."""

    _fields_ = [
        ("intervals", LONG),
        *((name, POINTER) for name in ("h", "u", "sample", "first")),
    ]


@final
@dataclass(frozen=True)
class Room:
    """Where the numbers of a member lie in a row of its own.

    Attributes
    ----------
    size : of a row.
    parts : of each array: its first number, and its shape.
    gap : numbers after each array.
    words, places : of a member's record, the words that are pointers; of each, how many bytes after
        the begin of the row it points.
    """

    size: int
    parts: Mapping[str, tuple[int, tuple[int, ...]]]
    gap: int
    words: NDArray[np.intp]
    places: NDArray[np.uintp]

    def rows(self, members: int) -> FloatArray:
        """Return the rows of members: zeros, and nan in the gaps."""
        numbers = np.zeros((members, self.size))
        for gap in self.gaps(numbers):
            gap[:] = np.nan
        return numbers

    def gaps(self, numbers: FloatArray) -> Iterator[FloatArray]:
        """Yield what lies between arrays (members, gap)."""
        for first, shape in self.parts.values() if self.gap else ():
            stop = first + prod(shape)
            yield numbers[:, stop : stop + self.gap]

    def part(self, numbers: FloatArray, name: str) -> FloatArray:
        """Return one array of all members (members, *shape), a view of their rows."""
        first, shape = self.parts[name]
        return numbers[:, first : first + prod(shape)].reshape(len(numbers), *shape)

    def point(self, members: Any, numbers: FloatArray) -> None:
        """Let the pointers of members point into their rows."""
        words = np.frombuffer(memoryview(members), np.uintp).reshape(len(numbers), -1)
        row = numbers.strides[0] * np.arange(len(numbers), dtype=np.uintp)
        words[:, self.words] = self.places + (row + np.uintp(numbers.ctypes.data))[:, None]


def room_of(n: int, ledger: int, samples: int, space: int) -> Room:
    """Return the room of members with n states, rows of a ledger, samples, and room for a step."""
    return _room(n, ledger, samples, space, GAP)


@lru_cache(maxsize=256)
def _room(n: int, ledger: int, samples: int, space: int, gap: int) -> Room:
    shapes = {
        "x": (n,),
        "changes": (2, n),
        "ledgers": (2, ledger),
        "largest": (n,),
        "space": (space,),
        "states": (samples, n),
        "sums": (samples, ledger),
    }
    ends = list(accumulate((prod(shape) + gap for shape in shapes.values()), initial=0))
    parts = dict(zip(shapes, zip(ends, shapes.values(), strict=False), strict=True))
    first = {name: place for name, (place, _) in parts.items()}
    path = Member.path.offset
    pointers = {
        Member.model.offset + Model.space.offset: first["space"],
        Member.model.offset + Model.largest.offset: first["largest"],
        path + Path.x.offset: first["x"],
        path + Path.last.offset: first["changes"],
        path + Path.prior.offset: first["changes"] + n,
        path + Path.sums.offset: first["ledgers"],
        path + Path.lost.offset: first["ledgers"] + ledger,
        Member.out_x.offset: first["states"],
        Member.out_sums.offset: first["sums"],
    }
    words = np.array(list(pointers)) // WORD
    return Room(
        ends[-1], parts, gap, words, NUMBER * np.array(list(pointers.values()), dtype=np.uintp)
    )


def at(array: NDArray[Any]) -> ctypes.c_void_p:
    """Return the address of an array's numbers."""
    return ctypes.c_void_p(array.ctypes.data)
