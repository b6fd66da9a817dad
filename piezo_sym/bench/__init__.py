"""``piezo-sym bench``: this package against what its users would otherwise use.

Input: a model.  Output: a `Report` of ratios, each with its spread and the error of both sides.
No speed stands without its error, and no time without what it is compared with.
"""

from piezo_sym.bench.groups import GROUPS, bench
from piezo_sym.bench.output import as_json, markdown
from piezo_sym.bench.rows import Part, Report, Row, Spread
from piezo_sym.bench.settings import QUICK, THOROUGH, Settings

__all__ = [
    "GROUPS",
    "QUICK",
    "THOROUGH",
    "Part",
    "Report",
    "Row",
    "Settings",
    "Spread",
    "as_json",
    "bench",
    "markdown",
]
