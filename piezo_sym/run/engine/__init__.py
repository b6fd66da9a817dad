"""The compiled engine: a generated module's C source, compiled once, called from NumPy.

Input: a generated module with its .c and .h beside it.  Output: an `Engine` with the module's
functions, or one line that says why there is none; runs then use the module's NumPy.
"""

from piezo_sym.run.engine.engine import Engine, compiled
from piezo_sym.run.engine.library import EngineWarning

__all__ = ["Engine", "EngineWarning", "compiled"]
