"""The compiled engine: a generated module's C source, compiled once, called from NumPy.

Input: a generated module with its .c and .h beside it.  Output: an `Engine` with the module's
functions, or an error that says in one line why there is none.
"""

from piezo_sym.run.engine.engine import Engine
from piezo_sym.run.engine.library import EngineWarning

__all__ = ["Engine", "EngineWarning"]
