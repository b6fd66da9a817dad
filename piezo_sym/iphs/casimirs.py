"""Linear functions of the state that no motion changes, such as n*q_1 - q_2 over a lever.

Input: an `IPHS`.  Output: these functions.  In dx/dt = J0 E - B W + G u, with the heat of bodies, a
function N x keeps its value for any co-states, laws and inputs if N J0, N B and N G are zero, and N
has nothing of an entropy that is heated.
"""

import sympy as sp

from piezo_sym.iphs.iphs import IPHS

#: Of more states none is looked for: elimination with symbols takes long.
MOST_ROWS = 24


def linear_casimirs(iphs: IPHS) -> list[sp.Expr]:
    """Return linear functions of states outside of banks that keep the values of the start.

    Their coefficients depend on parameters alone.
    """
    system, write, named = iphs.system, iphs.reading.write, dict(iphs.reading.named)
    parameters = {iphs.symbols[name] for name in iphs.model.parameters}
    rows: dict[int, dict[tuple[int, int], sp.Expr]] = {
        n: {} for n, slot in enumerate(system.states) if slot.bank is None and n not in system.heats
    }
    for block, matrix in enumerate((system.J0, system.B, system.G)):
        for (row, column), full, own in matrix.entries():
            entry = write((full + own).xreplace(named))
            if row in rows and entry.free_symbols <= parameters:
                rows[row][block, column] = entry
            else:
                rows.pop(row, None)
    columns = sorted({place for entries in rows.values() for place in entries})
    if not columns or len(rows) > MOST_ROWS:
        return []
    flows = sp.Matrix([[entries.get(at, 0) for at in columns] for entries in rows.values()])
    states = [iphs.symbols[system.states[n].label] for n in rows]
    return [_function(null, states) for null in flows.T.nullspace()]


def _function(coefficients: sp.Matrix, states: list[sp.Symbol]) -> sp.Expr:
    """Return a linear function without denominators; its first coefficient has no minus sign."""
    terms = sp.together(sum(c * x for c, x in zip(coefficients, states, strict=True)))
    whole = sp.expand(sp.fraction(terms)[0])
    first = next(whole.coeff(x) for x in states if whole.has(x))
    return -whole if first.could_extract_minus_sign() else whole
