"""Code generation: IPHS to program, program to text."""

from piezo_sym.codegen.c_collocation import c_collocation
from piezo_sym.codegen.c_head import c_header
from piezo_sym.codegen.c_printer import c_source
from piezo_sym.codegen.c_step_head import c_step_header
from piezo_sym.codegen.collocation import collocation_of
from piezo_sym.codegen.lower import lower
from piezo_sym.codegen.numpy_head import MARK
from piezo_sym.codegen.numpy_printer import numpy_module

__all__ = [
    "MARK",
    "c_collocation",
    "c_header",
    "c_source",
    "c_step_header",
    "collocation_of",
    "lower",
    "numpy_module",
]
