"""Times against heyoka, CasADi, numba, diffrax and code written by hand: ``python -m``.

`piezo-sym bench` compares a spec with what its users have today; the reports that are kept in
``notebooks/`` compare the paper's actuator with more than that, and are made here.
"""
