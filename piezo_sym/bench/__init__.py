"""``piezo-sym bench``: this package compared with SciPy on lambdified SymPy.

Input: a model.  Output: rows, each a ratio of times with its spread, and the errors of both sides.
"""

from piezo_sym.bench.measure import GROUPS, bench

__all__ = ["GROUPS", "bench"]
