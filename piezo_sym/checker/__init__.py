"""The checker: a second program that shares nothing with the package but the spec's text.

Input: a spec and what was published about it (`proofs.json`).  Output: which rows are confirmed.
Run as ``python -I piezo_sym/checker SPEC.toml PROOFS.json``; its reader and its exact evaluation of
a spec at a point are `read_spec` and `evaluate`.
"""

from .laws import InputError
from .point import CannotTell, NoValue, Point, evaluate, value
from .spec import Spec, read_spec

__all__ = [
    "CannotTell",
    "InputError",
    "NoValue",
    "Point",
    "Spec",
    "evaluate",
    "read_spec",
    "value",
]
