"""The libraries of a run, compiled before it is known that its module is proved.

Input: a module, the stages of steps.  Output: its engine and its steps in the cache.
"""

from contextlib import suppress
from threading import Thread

from piezo_sym.errors import PiezoError
from piezo_sym.run.collocation import layout_of
from piezo_sym.run.engine.batch import steps_of
from piezo_sym.run.engine.engine import engine_of, functions_of
from piezo_sym.run.engine.library import Sources, library
from piezo_sym.run.module import GeneratedModule, row_count


def compile_ahead(module: GeneratedModule, stages: int) -> None:
    """Compile what one run of a module needs with steps of `stages` stages, if possible."""
    layout = layout_of(1, row_count(module.STATES, module.Parameters()), side_by_side=True)
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
