"""``piezo-sym bench``: this package against what its users would otherwise use.

Input: a model.  Output: rows, each a ratio of times with its spread and the error of both sides.
No speed stands without its error, and no time without what it is compared with.
"""

from piezo_sym.bench.measure import GROUPS, bench

__all__ = ["GROUPS", "bench"]
