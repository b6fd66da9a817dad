"""The fingerprint of a sweep: equal for two sweeps exactly if they request the same runs.

Input: a `Plan` and the hash of its spec.  Output: SHA-256 as text.  A function contributes its
name, its code and all values that it refers to, so that an edited function changes the result.
"""

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from types import CodeType, ModuleType

import numpy as np

from piezo_sym.sweeps.plan import Plan

#: Fields that say how runs are divided and executed, not which runs they are.
LEFT_OUT = ("most", "together", "engine", "side_by_side")


def fingerprint(plan: Plan, spec_sha256: str) -> str:
    """Return the fingerprint of a sweep."""
    found = hashlib.sha256(spec_sha256.encode())
    for field in fields(plan):
        if field.name not in LEFT_OUT:
            for part in parts(getattr(plan, field.name)):
                found.update(len(part).to_bytes(8, "little") + part)
    return found.hexdigest()


def parts(value: object, met: dict[int, object] | None = None) -> Iterator[bytes]:
    """Yield the contents of a value as bytes; an object that was met before adds nothing."""
    met = {} if met is None else met
    yield type(value).__name__.encode()
    if isinstance(value, float | int | str | bytes | None):
        yield (value.hex() if isinstance(value, float) else repr(value)).encode()
        return
    if isinstance(value, np.ndarray | np.generic):
        array = np.asarray(value)
        yield f"{array.dtype.str}{array.shape}".encode()
        yield array.tobytes() if array.dtype.kind != "O" else repr(array.tolist()).encode()
        return
    if id(value) in met:
        return
    met[id(value)] = value  # kept alive, so that no other object gets its id
    for part in held(value):
        yield from parts(part, met)


def held(value: object) -> Iterator[object]:
    """Yield the contents of a container, a record, or a user's object."""
    if isinstance(value, Mapping):
        for key in sorted(value, key=repr):
            yield from (key, value[key])
    elif isinstance(value, frozenset):
        yield from sorted(value, key=repr)
    elif isinstance(value, tuple | list):
        yield from value
    elif is_dataclass(value):
        yield from (getattr(value, field.name) for field in fields(value))
    elif isinstance(value, CodeType):
        yield from (value.co_code, value.co_names, value.co_consts)
    elif not isinstance(value, ModuleType):
        yield from held_by_callable(value)


def held_by_callable(value: object) -> Iterator[object]:
    """Yield the contents of a function or of another object of a user.

    Of a function: its code, the object it is bound to, defaults, closure and globals that it reads.
    """
    yield str(getattr(value, "__qualname__", ""))
    code = getattr(value, "__code__", None)
    if not isinstance(code, CodeType):
        yield dict(getattr(value, "__dict__", None) or {})
        yield from (getattr(value, name, None) for name in ("func", "args", "keywords"))
        return
    yield from (code, getattr(value, "__self__", None))
    yield from (getattr(value, "__defaults__", None), getattr(value, "__kwdefaults__", None))
    yield from (cell.cell_contents for cell in getattr(value, "__closure__", None) or ())
    known = getattr(value, "__globals__", {})
    for one in (known[name] for name in code.co_names if name in known):
        own = getattr(one, "__module__", None) in (None, getattr(value, "__module__", None))
        yield one if own else f"{one.__module__}.{getattr(one, '__qualname__', '')}"
