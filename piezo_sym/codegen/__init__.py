"""Code generation: IPHS to program, program to text."""

from piezo_sym.codegen.lower import lower
from piezo_sym.codegen.numpy_head import MARK
from piezo_sym.codegen.numpy_printer import numpy_module

__all__ = ["MARK", "lower", "numpy_module"]
