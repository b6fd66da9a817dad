"""Which method runs a module, and its engine: the discrete gradient in C wherever there is one.

Input: a generated module, the method and the step that a user named, or none.  Output: a
`ChosenMethod`: its name, its engine, and a note that says why it was chosen.

A user who names no method gets the discrete gradient.  A module without C beside it, written by
hand or changed in Python, is run by LSODA; so is one whose C cannot be compiled here, with one
warning.  A method or a step that was named is never replaced: without an engine it is refused.
"""

import ctypes
import os
import warnings
from dataclasses import dataclass
from functools import lru_cache
from types import ModuleType
from typing import final

from piezo_sym.errors import EngineError, UsageError, listing, one_line, quote
from piezo_sym.files import path_text
from piezo_sym.run.collocation import METHOD
from piezo_sym.run.engine.engine import Engine, engine_of
from piezo_sym.run.engine.library import EngineWarning, cache_folder, read_source, source_path
from piezo_sym.run.integrate import METHODS
from piezo_sym.run.module import GeneratedModule

OFFERED = (METHOD, *METHODS)
FALLBACK = "LSODA"


@final
@dataclass(frozen=True)
class ChosenMethod:
    """The method of a run; only the discrete gradient has an `engine`."""

    method: str
    engine: Engine | None
    note: str


def checked_method(method: object) -> str | None:
    """Return a method's name, or None where none is named; raise `UsageError` otherwise."""
    if method is not None and (not isinstance(method, str) or method not in OFFERED):
        what = f"unknown method {quote(method)}"
        raise UsageError(what, "simulate.method", listing(OFFERED))
    return method


def choose_method(module: GeneratedModule, method: str | None, step: object) -> ChosenMethod:
    """Return the method that runs a module; `method` and `step` are the user's, or None."""
    if method not in (None, METHOD):
        return ChosenMethod(method, None, f"none: method {method} was asked for")
    free = method is None and step is None
    if free and not _has_source(module):
        return ChosenMethod(FALLBACK, None, "none: the module has no C source beside it")
    found = _found(module)
    if isinstance(found, Engine):
        return ChosenMethod(METHOD, found, f"compiled by {_compiler(found)}")
    if free:
        _warn(module.NAME, str(found))
        return ChosenMethod(FALLBACK, None, f"none: {found}")
    instead = f"leave out step, and take method='{FALLBACK}' for a run in NumPy"
    remedy = f"{found.remedy}; or {instead}" if found.remedy else instead
    raise EngineError(found.what, found.where, remedy=remedy)


def _found(module: GeneratedModule) -> Engine | EngineError:
    if not _own(module):
        what = "is no module loaded from a file, so no C source is its own"
        return EngineError(what, f"model '{module.NAME}'")
    if not os.path.isfile(_own(module)):
        remedy = f"check that {path_text(cache_folder())} can be written"
        return EngineError("its C source was not kept", remedy=remedy)
    try:
        read_source(module, "_step.c")
        return engine_of(module)
    except EngineError as error:
        return error


def _compiler(engine: Engine) -> str:
    text = ctypes.c_char.in_dll(engine.library, f"{engine.module.NAME}_compiler")
    return one_line(ctypes.string_at(ctypes.addressof(text)).decode(errors="replace").strip())


def _own(module: object) -> str:
    """Return the file that a module was loaded from, beside which its C is; or nothing."""
    return (getattr(module, "__file__", None) or "") if isinstance(module, ModuleType) else ""


def _has_source(module: GeneratedModule) -> bool:
    """Return whether a module came with C: there is some, or not even its own file is left."""
    own, beside = _own(module), (source_path(module, ending) for ending in (".h", ".c"))
    return bool(own) and (not os.path.isfile(own) or any(map(os.path.isfile, beside)))


@lru_cache(maxsize=256)
def _warn(name: str, why: str) -> None:
    """Warn that a model runs in NumPy, once in a process."""
    text = f"model '{name}' runs by {FALLBACK} in NumPy, not compiled by {METHOD}: {why}"
    warnings.warn(text, EngineWarning, stacklevel=5)
