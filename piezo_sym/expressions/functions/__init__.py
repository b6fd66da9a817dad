"""The functions of laws, one record each with all that any stage has to know of it.

Input: nothing.  Output: the records, by name.  To add a function, add its record to `smooth` or
`kinked`, and a test.
"""

from collections.abc import Mapping

from piezo_sym.expressions.functions.kinked import KINKED
from piezo_sym.expressions.functions.record import INF, LawFunction
from piezo_sym.expressions.functions.smooth import SMOOTH

__all__ = ["FUNCTIONS", "INF", "RECORDS", "LawFunction"]

#: Every function, including those that no spec can write.
RECORDS: Mapping[str, LawFunction] = {record.name: record for record in (*SMOOTH, *KINKED)}
#: The functions of the law language.
FUNCTIONS: Mapping[str, LawFunction] = {
    n: record for n, record in RECORDS.items() if record.written
}
