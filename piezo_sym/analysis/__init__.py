"""Analysis of runs: measures of loops, periodic steady states, a dashboard, the paper's figures.

Input: runs (`xarray.Dataset`), or generated modules to run.  Output: numbers, frozen records,
Matplotlib figures.  Nothing here imports a spec or SymPy.
"""
