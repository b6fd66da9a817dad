"""The choice of a run's method, and its engine.

Input: a generated module, the user's method and step, or None.  Output: a `ChosenMethod`.

The default is the discrete gradient, compiled.  A module without C beside it, such as one written
by hand, runs by LSODA; so does one whose C cannot be compiled here, with one warning.  A method or
a step that the user named is never replaced: without an engine it is an error.
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
    """The method of a run, its engine (of the discrete gradient alone), and why it was chosen."""

    method: str
    engine: Engine | None
    note: str


def checked_method(method: object) -> str | None:
    """Return a method's name, or None if the user named none; raise `UsageError` otherwise."""
    if method is not None and (not isinstance(method, str) or method not in OFFERED):
        what = f"unknown method {quote(method)}"
        raise UsageError(what, "simulate.method", listing(OFFERED))
    return method


def choose_method(module: GeneratedModule, method: str | None, step: object) -> ChosenMethod:
    """Return the method that runs a module; `method` and `step` are the user's, or None."""
    if method not in (None, METHOD):
        return ChosenMethod(method, None, f"none: method {method} was asked for")
    free = method is None and step is None
    if free and not _has_c(module):
        return ChosenMethod(FALLBACK, None, "none: the module has no C source beside it")
    engine = _engine_or_error(module)
    if isinstance(engine, Engine):
        return ChosenMethod(METHOD, engine, f"compiled by {_compiler(engine)}")
    if free:
        _warn(module.NAME, str(engine))
        return ChosenMethod(FALLBACK, None, f"none: {engine}")
    instead = f"leave out step, and take method='{FALLBACK}' for a run in NumPy"
    remedy = f"{engine.remedy}; or {instead}" if engine.remedy else instead
    raise EngineError(engine.what, engine.where, remedy=remedy)


def _engine_or_error(module: GeneratedModule) -> Engine | EngineError:
    if not _module_file(module):
        what = "is no module loaded from a file, so no C source is its own"
        return EngineError(what, f"model '{module.NAME}'")
    if not os.path.isfile(_module_file(module)):
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


def _module_file(module: object) -> str:
    """Return the file that a module was loaded from, with its C beside it; "" if there is none."""
    return (getattr(module, "__file__", None) or "") if isinstance(module, ModuleType) else ""


def _has_c(module: GeneratedModule) -> bool:
    """Return whether C is beside a module, or the module's file was deleted, too."""
    file, beside = _module_file(module), (source_path(module, ending) for ending in (".h", ".c"))
    return bool(file) and (not os.path.isfile(file) or any(map(os.path.isfile, beside)))


@lru_cache(maxsize=256)
def _warn(name: str, why: str) -> None:
    """Warn that a model runs in NumPy, once in a process."""
    text = f"model '{name}' runs by {FALLBACK} in NumPy, not compiled by {METHOD}: {why}"
    warnings.warn(text, EngineWarning, stacklevel=6)
