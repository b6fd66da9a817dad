"""Sweeps: one model run over a grid of parameters, inputs and initial values, on all cores.

Input: a model and the values to sweep.  Output: an `xarray.Dataset` with the swept dimensions, in
memory or in a Zarr store from which an interrupted sweep continues.
"""

from piezo_sym.sweeps.sweep import SweepWarning, sweep

__all__ = ["SweepWarning", "sweep"]
