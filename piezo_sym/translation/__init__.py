"""From proof to code: printed modules read back, and proved to be the proved system.

stage        from -> to                                 in
reference    IPHS -> rows in normal form                system_reader, reference, collocation
reading      NumPy and C text -> rows in normal form    numpy_head, numpy_reader, c_reader, c_step
comparison   rows -> the row `program`                  program, zero, witness

Readers are not printers: they know a written grammar and refuse all else.  Nothing is executed.
"""

from piezo_sym.translation.program import program_row, worst

__all__ = ["program_row", "worst"]
