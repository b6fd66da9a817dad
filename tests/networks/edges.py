"""States on the edges of laws' branches, as exactly as floating-point numbers can be, and beside.

Input: a derived system, its banks written out, and numbers for its parameters and inputs.  Output:
states.  Edges are those of the SymPy system's own branches; each is solved for a state.
"""

import mpmath as mp
import numpy as np
import sympy as sp
from precise import DIGITS, measured

#: How far temperatures are above those at zero entropy [K].
ABOVE = (1e-3, 1.0, 50.0)


def edges(exact):
    """Return what is zero where a branch of some rate ends, in an order of its own."""
    found = {}
    for row in exact.rhs:
        for piece in sorted(row.atoms(sp.Piecewise), key=str):
            for _, condition in piece.args:
                for test in sorted(sp.sympify(condition).atoms(sp.core.relational.Rel), key=str):
                    found[sp.expand(test.lhs - test.rhs)] = None
    return tuple(found)


def on_edges(exact, fixed, base):
    """Yield states on each edge, and one number above and below; `base` (n,) but for one state."""
    at = dict(zip(exact.x, (sp.Float(v, DIGITS) for v in base), strict=True))
    for edge in edges(exact):
        for n, state in enumerate(exact.x):
            slope = sp.diff(edge, state)
            if slope == 0 or slope.has(state):
                continue
            rest = {s: v for s, v in at.items() if s is not state}
            place = -edge.subs(state, 0) / slope
            value = float(sp.N(place.xreplace(fixed).xreplace(rest), DIGITS))
            for number in (np.nextafter(value, -np.inf), value, np.nextafter(value, np.inf)):
                x = np.array(base, dtype=float)
                x[n] = number
                yield x
            break


def heated(exact, fixed, x, above):
    """Return a state whose temperatures are so much above those at zero entropy."""
    x = np.array(x, dtype=float)
    for n, state in enumerate(exact.x):
        if exact.system.dS[n, 0] == 0:
            continue
        others = {other: sp.Float(x[k]) for k, other in enumerate(exact.x) if k != n}
        law = exact.E[n].xreplace(fixed).xreplace(others)
        hot, slope = (sp.lambdify(state, f, "mpmath") for f in (law, sp.diff(law, state)))
        with mp.workdps(DIGITS):
            s = mp.mpf(0)
            for _ in range(20):
                s -= (hot(s) - hot(mp.mpf(0)) - above) / slope(s)
            x[n] = float(s)
    return x


def rounded(row, values):
    """Return (value, size) of a row: the size is the sum of the absolute terms.

    Of a law with branches, terms of all its branches count: on an edge a rounding decides.
    """
    parts = sp.Add.make_args(sp.expand(row))
    with mp.workdps(DIGITS):
        value = mp.fsum(measured(part, values)[0] for part in parts)
        size = mp.fsum(_size(part, values) for part in parts)
    return value, size


def _size(term, values):
    """Return the size of a term, the parts of its branches counted one by one."""
    sizes, names = {}, {}
    for n, piece in enumerate(sorted(term.atoms(sp.Piecewise), key=str)):
        names[piece] = sp.Symbol(f"piece_{n}")
        branches = [branch for branch, _ in piece.args]
        sizes[f"piece_{n}"] = mp.fsum(
            abs(measured(part, values)[0])
            for branch in branches
            for part in sp.Add.make_args(sp.expand(branch))
        )
    # branches in a divisor make a term less, not more
    return max(abs(measured(t, {**values, **sizes})[0]) for t in (term, term.xreplace(names)))
