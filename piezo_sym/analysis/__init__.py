"""Analysis: measures of loops, states of rest and periodic ones, a dashboard, the paper's figures.

Input: runs (`xarray.Dataset`), or generated modules to run.  Output: numbers, frozen records,
Matplotlib figures.  Nothing here imports a spec or SymPy.
"""

from piezo_sym.analysis import loops

__all__ = ["loops"]
