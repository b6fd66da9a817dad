"""What is printed of a system, by the name that the row `program` gives to the text."""

from piezo_sym.codegen import c_collocation, c_source, collocation_of, lower, numpy_module

TEXTS = ("NumPy", "C", "step")


def printed(iphs, program=None):
    """Return each text of a system; the first two of another program, if there is one."""
    program = program or lower(iphs, "")
    step = c_collocation(lower(iphs, ""), collocation_of(iphs))
    return dict(zip(TEXTS, (numpy_module(program), c_source(program), step), strict=True))
