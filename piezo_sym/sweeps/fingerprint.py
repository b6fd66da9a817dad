"""The fingerprint of a sweep: two sweeps have one exactly if they ask for the same runs.

Input: a `Plan` and the hash of its spec.  Output: SHA-256 as text.  Functions count by name, code
and what they hold, so that one that was edited is another.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from types import CodeType
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from piezo_sym.sweeps.plan import Plan

#: How boxes are cut, and how runs go through C, says nothing about what runs.
LEFT_OUT = ("most", "together", "side_by_side")


def fingerprint(plan: Plan, spec_sha256: str) -> str:
    """Return the fingerprint of a sweep."""
    found = hashlib.sha256(spec_sha256.encode())
    for field in fields(plan):
        if field.name not in LEFT_OUT:
            for part in parts(getattr(plan, field.name)):
                found.update(len(part).to_bytes(8, "little") + part)
    return found.hexdigest()


def parts(value: object) -> Iterator[bytes]:
    """Yield what a value consists of."""
    yield type(value).__name__.encode()
    if isinstance(value, float | int | str | bytes | None):
        yield (value.hex() if isinstance(value, float) else repr(value)).encode()
    elif isinstance(value, np.ndarray | np.generic):
        array = np.asarray(value)
        yield f"{array.dtype.str}{array.shape}".encode()
        yield array.tobytes() if array.dtype.kind != "O" else repr(array.tolist()).encode()
    elif isinstance(value, Mapping):
        for key in sorted(value, key=repr):
            yield from parts((key, value[key]))
    elif isinstance(value, tuple | list | frozenset):
        for item in sorted(value, key=repr) if isinstance(value, frozenset) else value:
            yield from parts(item)
    elif is_dataclass(value):
        for field in fields(value):
            yield from parts(getattr(value, field.name))
    elif isinstance(value, CodeType):
        yield from parts((value.co_code, value.co_names, value.co_consts))
    else:
        yield from of_callable(value)


def of_callable(value: object) -> Iterator[bytes]:
    """Yield what a function, or another object of a user's, consists of."""
    yield str(getattr(value, "__qualname__", "")).encode()
    code = getattr(value, "__code__", None)
    if code is None:
        held = getattr(value, "__dict__", None) or {}
        more = [getattr(value, name, None) for name in ("func", "args", "keywords")]
        yield from parts((dict(held), *more))
        return
    yield from parts(code)
    yield from parts((getattr(value, "__defaults__", None), getattr(value, "__kwdefaults__", None)))
    for cell in getattr(value, "__closure__", None) or ():
        yield from parts(cell.cell_contents)
