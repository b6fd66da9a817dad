"""Run generated modules: signals in, `simulate`, an `xarray.Dataset` out.

Input: a generated module and the arguments of a run.  Output: states, outputs, temperatures, and
the ledger of energy and entropy over time.  Neither SymPy nor a spec is needed to run.
"""

from piezo_sym.run import signals
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.sample_files import samples_from_csv
from piezo_sym.run.samples import samples
from piezo_sym.run.signals import *  # noqa: F403
from piezo_sym.run.signals import Signal
from piezo_sym.run.simulate import simulate

__all__ = ["GeneratedModule", "Signal", "samples", "samples_from_csv", "simulate"]
__all__ += signals.__all__
