"""The choice of a run's method, and its engine.

Input: a generated module, the user's method and step, or None.  Output: a `ChosenMethod`; before it
is known that the module is proved, its engine and steps in the cache.

The default is the discrete gradient, compiled.  A module without C beside it, such as one written
by hand, runs by LSODA; so does one whose C cannot be compiled here, with one warning.  A method or
a step that the user named is never replaced: without an engine it is an error.
"""

import ctypes
import os
from contextlib import suppress
from dataclasses import dataclass
from threading import Thread
from types import ModuleType
from typing import final

from piezo_sym.errors import EngineError, PiezoError, UsageError, listing, one_line, quote
from piezo_sym.files import path_text
from piezo_sym.run.collocation import METHOD, layout_of
from piezo_sym.run.engine.batch import steps_of
from piezo_sym.run.engine.engine import Engine, engine_of, functions_of
from piezo_sym.run.engine.library import (
    Sources,
    cache_folder,
    library,
    read_source,
    source_path,
    warn_once,
)
from piezo_sym.run.integrate import METHODS
from piezo_sym.run.module import GeneratedModule, row_count

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
    given: object = module
    file = (getattr(given, "__file__", None) or "") if isinstance(given, ModuleType) else ""
    beside = (source_path(module, ending) for ending in (".h", ".c"))
    has_c = file and (not os.path.isfile(file) or any(map(os.path.isfile, beside)))
    free = method is None and step is None
    if free and not has_c:
        return ChosenMethod(FALLBACK, None, "none: the module has no C source beside it")
    try:
        engine = _engine(module, file)
    except EngineError as error:
        if free:
            instead = f"runs by {FALLBACK} in NumPy, not compiled by {METHOD}"
            warn_once(f"model '{module.NAME}' {instead}: {error}", 6)
            return ChosenMethod(FALLBACK, None, f"none: {error}")
        instead = f"leave out step, and take method='{FALLBACK}' for a run in NumPy"
        remedy = f"{error.remedy}; or {instead}" if error.remedy else instead
        raise EngineError(error.what, error.where, remedy=remedy) from None
    text = ctypes.c_char.in_dll(engine.library, f"{module.NAME}_compiler")
    compiler = ctypes.string_at(ctypes.addressof(text)).decode(errors="replace").strip()
    return ChosenMethod(METHOD, engine, f"compiled by {one_line(compiler)}")


def _engine(module: GeneratedModule, file: str) -> Engine:
    """Return the engine of a module that was loaded from a file; "" for none."""
    if not file:
        what = "is no module loaded from a file, so no C source is its own"
        raise EngineError(what, f"model '{module.NAME}'")
    if not os.path.isfile(file):
        remedy = f"check that {path_text(cache_folder())} can be written"
        raise EngineError("its C source was not kept", remedy=remedy)
    read_source(module, "_step.c")
    return engine_of(module)


def compile_ahead(module: GeneratedModule, stages: int) -> None:
    """Compile what one run of a module needs with steps of `stages` stages, if possible."""
    layout = layout_of(1, row_count(module.STATES, module.Parameters()))
    with suppress(PiezoError, OSError):  # the run raises it
        functions = functions_of(module)
        steps = steps_of(module, functions, stages, layout)
        beside = Thread(target=_compiled, args=(steps,), daemon=True)
        beside.start()
        try:
            engine_of(module)
        finally:
            beside.join()


def _compiled(sources: Sources) -> None:
    with suppress(PiezoError, OSError):
        library(sources)
