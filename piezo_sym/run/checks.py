"""Checks of numbers from a user.

Input: any object, and the argument it was given for.  Output: a finite float or a vector of them;
or a `UsageError` that names the argument.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import update_wrapper
from inspect import signature
from math import isfinite, nan
from numbers import Integral, Real
from typing import ParamSpec, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from piezo_sym.errors import PiezoError, UnknownNameError, UsageError, nearest, quote

BoolArray: TypeAlias = NDArray[np.bool_]
FloatArray: TypeAlias = NDArray[np.float64]
P = ParamSpec("P")
R = TypeVar("R")

#: The types of truth values, which Python and NumPy take for numbers.
BOOLS = frozenset({bool, np.bool_})
#: Matches the names of functions whose checks of arguments other functions use.
SHARED = re.compile(r"^(simulate|operating_point|periodic_steady_state)\.")
#: Arguments in seconds.
TIMES = frozenset({"duration", "step", "t0"})
#: What to write for arguments that have no default.
EXAMPLES = {
    "duration": "0.1",
    "step": "1e-4",
    "over": "{'d': [300.0, 400.0]}",
    "inputs": "{'V_in': sine(100.0, 50.0)}",
    "frequency": "50.0",
    "frequencies": "(10.0, 100.0)",
}
#: The smallest duration, temperature or frequency: fractions of a smaller one underflow.
LEAST = 1e-100
#: The most lanes or samples: the results of more fit into no memory.
MOST = 100_000_000


def is_number(value: object) -> bool:
    """Return whether `value` is one real number, or an array of one without axes; a bool is not."""
    if getattr(value, "ndim", None) == 0:
        return np.asarray(value).dtype.kind in "iuf"
    return isinstance(value, Real) and type(value) not in BOOLS


def number(value: object, where: str) -> float:
    """Return `value` as a finite float; raise `UsageError` otherwise."""
    try:
        result = float(value) if is_number(value) else nan  # type: ignore[arg-type]  # a Real
    except (OverflowError, TypeError, ValueError):
        result = nan
    if not isfinite(result):
        what, expected = f"{quote(value)} is not a finite number", "a finite real number"
        if isinstance(value, str):
            unit = "of seconds" if where.rpartition(".")[2] in TIMES else "in SI"
            expected = f"a number {unit}, such as 0.005"
        raise UsageError(what, where, expected)
    return result


def positive(value: object, where: str) -> float:
    """Return `value` as a finite float >= `LEAST`; raise `UsageError` otherwise."""
    result = number(value, where)
    if result <= 0:
        what = f"{quote(value)} is not positive"
        raise UsageError(what, where, "a number above 0")
    if result < LEAST:
        raise UsageError(f"{quote(value)} is too small", where, f"at least {LEAST:g}")
    return result


def integer(value: object, where: str, least: int, most: int = MOST) -> int:
    """Return `value` as an int from `least` to `most`; raise `UsageError` otherwise."""
    value = np.asarray(value).item() if getattr(value, "ndim", None) == 0 else value
    if isinstance(value, bool) or not isinstance(value, Integral) or int(value) < least:
        what = f"{quote(value)} is not allowed"
        raise UsageError(what, where, f"a whole number >= {least}")
    if int(value) > most:
        raise UsageError(f"{quote(value)} is too many", where, f"at most {most:,}")
    return int(value)


def is_vector(value: object) -> bool:
    """Return whether `value` looks like a list of values rather than one value."""
    return isinstance(value, list | tuple) or getattr(value, "ndim", 0) > 0


def vector(value: object, where: str) -> FloatArray:
    """Return `value` as a vector of finite floats, shape (n,); raise `UsageError` otherwise."""
    if isinstance(value, list | tuple):
        return np.array([number(item, f"{where}[{i}]") for i, item in enumerate(value)])
    raw = np.asarray(value)
    if raw.ndim != 1 or raw.dtype.kind not in "iuf":
        what = f"{quote(value)} is not a list of numbers"
        raise UsageError(what, where, "a list of numbers")
    if not np.all(np.isfinite(raw)):
        first = int(np.argmin(np.isfinite(raw)))
        what = f"entry {first} is {raw[first]}"
        raise UsageError(what, where, "finite numbers")
    return raw.astype(np.float64)


def positive_range(value: object, where: str, unit: str) -> tuple[float, float]:
    """Return a range 0 < least < greatest; raise `UsageError` otherwise."""
    ends = vector(value, where) if is_vector(value) else np.zeros(0)
    if ends.size != 2 or not 0 < ends[0] < ends[1]:
        expected = f"two numbers above 0 in {unit}, the least and the greatest"
        raise UsageError(f"{quote(value)} is no range", where, expected)
    return float(ends[0]), float(ends[1])


def increasing(times: FloatArray, where: str) -> FloatArray:
    """Return `times` (n,) when they strictly increase; raise `UsageError` otherwise."""
    late = np.diff(times) <= 0
    if np.any(late):
        i = int(np.argmax(late)) + 1
        what = f"time {times[i]:g} at entry {i} follows {times[i - 1]:g}"
        raise UsageError(what, where, "increasing times")
    return times


def known_keys(
    given: object, known: Iterable[str], where: str, others: Mapping[str, str] | None = None
) -> dict[str, object]:
    """Return a user's mapping as a dict; raise `UsageError` at the first key not in `known`.

    `others` maps names that belong to another argument to that argument.
    """
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        what = f"{quote(given)} is not a mapping"
        raise UsageError(what, where, "a mapping of names to values")
    names = tuple(known)
    for name in given:
        if name not in names:
            place = (others or {}).get(name)
            remedy = f"give it in '{place}'" if place else nearest(str(name), names)
            unknown = UnknownNameError(f"unknown name {quote(name)}", where, remedy=remedy)
            unknown.name = str(name)
            raise unknown
    return dict(given)


def checked_call(run: Callable[P, R], name: str = "") -> Callable[P, R]:
    """Return `run` with arguments checked: `UsageError` says which is unknown or missing."""
    made, name = signature(run), name or run.__name__.lower()

    def call(*args: P.args, **given: P.kwargs) -> R:
        try:
            made.bind(*args, **given)
        except TypeError as error:
            known_keys(given, made.parameters, name)
            what, where, words = str(error), name, dict[str, str]()
            for p in made.parameters.values():
                if p.default is p.empty and p.kind is not p.VAR_KEYWORD:
                    words[p.name] = p.name
                    if p.kind is p.KEYWORD_ONLY:
                        words[p.name] += f"={EXAMPLES[p.name]}"
            with suppress(TypeError):
                had = made.bind_partial(*args, **given).arguments
                what, where = "is missing", f"{name}.{next(w for w in words if w not in had)}"
            raise UsageError(what, where, f"{name}({', '.join(words.values())})") from None
        return run(*args, **given)

    call.__name__ = call.__qualname__ = name
    return update_wrapper(call, run, ("__module__", "__doc__", "__annotations__"), ())


@contextmanager
def calling(function: str, initial: str = "initial") -> Iterator[None]:
    """Make errors of shared checks name `function`, which the user called; also a decorator.

    `initial` is the name of its argument for a state.
    """
    try:
        yield
    except PiezoError as error:
        error.where = SHARED.sub(f"{function}.", error.where)
        error.where = error.where.replace(f"{function}.initial", f"{function}.{initial}")
        error.remedy = error.remedy.replace("'initial'", f"'{initial}'")
        raise
