"""The slopes of a printed step against numeric derivatives of its rates, on any branches.

Row `program` of the proofs says nothing of them: they only drive Newton's method.
"""

import ctypes
from itertools import pairwise

import numpy as np
import pytest

from piezo_sym import derive, load
from piezo_sym.codegen import collocation_of, lower
from piezo_sym.codegen.coupling import coupling_of
from piezo_sym.modules import module_of
from tests.codegen.test_collocation_widths import SPECS, Reals, aligned, library

NAMES = [
    "piezo_stack",
    "output_resistance_of_a_bank",
    "two_banks_heat_one_body",
    "two_sources_on_one_input",
]


def assembled(found, coupling, rows):
    """Return the matrix that slopes are the entries of, sums between lanes multiplied out.

    Parameters
    ----------
    rows : of each state, the rows of its lanes.
    """
    n, shared = sum(map(len, rows)), [rows[state][0] for state in coupling.states]
    border = [*range(n, n + coupling.borders)]
    index, whole = [*shared, *border], np.zeros((n + coupling.borders,) * 2)
    for value, (r, c) in zip(found, coupling.entries, strict=False):
        whole[index[r], index[c]] = value
    at = len(coupling.entries)
    for bank in coupling.banks:
        own = [rows[state] for state in bank.states]
        places = [(a, b) for a in own for b in own]
        places += [(a, [index[c]] * len(a)) for a in own for c in bank.columns]
        places += [([index[r]] * len(b), b) for r in bank.rows for b in own]
        for r, c in places:
            whole[r, c] = found[at : at + len(r)]
            at += len(r)
    return whole[:n, :n] + whole[:n, n:] @ whole[n:, :n], at


@pytest.mark.some(2)
@pytest.mark.parametrize("name", NAMES)
def test_slopes_are_the_derivative_of_the_rates_on_kept_branches(name, tmp_path):
    model = load(name if name == "piezo_stack" else str(SPECS / f"{name}.toml"))
    iphs, module = derive(model), module_of(model)
    coupling = coupling_of(lower(iphs, ""), collocation_of(iphs).slopes)
    rng, p = np.random.default_rng(3), module.Parameters()
    counts = [getattr(p, f"{s.bank}_count") if s.bank else 1 for s in module.STATES]
    ends = np.cumsum([0, *counts])
    rows = [[*range(a, b)] for a, b in pairwise(ends)]
    u = aligned(np.asarray(module.INPUT_DEFAULTS) + rng.uniform(0, 1, len(module.INPUTS)))
    b = aligned(rng.integers(0, 2, 64).astype(float))
    reals = Reals(module, 1, np.ones(1))
    run = library(module, tmp_path, 1).all_of

    def found(x, g):
        results = [aligned(np.zeros(256)) for _ in range(6)]
        given = [aligned(x), aligned(g), b, u]
        run(*(ctypes.c_void_p(part.ctypes.data) for part in (*given, reals.record, *results)))
        mean, rates, *_, slopes = results
        return mean[:8], rates[: ends[-1]], slopes

    x = module.initial_state(np.asarray(module.INPUT_DEFAULTS), p) + rng.uniform(
        1e-2, 2e-2, ends[-1]
    )
    slopes, used = assembled(found(x, found(x, np.ones(8))[0])[2], coupling, rows)
    assert used == len(coupling.entries) + sum(r * counts[state] for r, state in _lanes(coupling))
    for k in range(ends[-1]):
        h = 1e-5 * abs(x[k])
        sides = [x + turn * h * np.eye(ends[-1])[k] for turn in (1, -1)]
        one, other = (found(side, found(side, np.ones(8))[0])[1] for side in sides)
        rounding = 1e-15 * np.abs(one).max() / h
        assert slopes[:, k] == pytest.approx((one - other) / (2 * h), rel=1e-6, abs=rounding)


def _lanes(coupling):
    """Yield how many rows of slopes the lanes of each bank have, and a state of the bank."""
    for bank in coupling.banks:
        yield len(bank.slopes), bank.states[0]
