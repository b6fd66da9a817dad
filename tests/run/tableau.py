"""The numbers of Gauss collocation with s stages, as tables of C.

Input: the number of stages, and of nodes for means over a step.  Output: text.  Everything is found
from Legendre's polynomials in 40 digits and rounded once.  ``python tests/run/tableau.py`` writes
what the engine reads, ``piezo_sym/run/engine/tables``; test_tableau.py compares it.
"""

from functools import cache
from itertools import pairwise
from pathlib import Path
from threading import Lock
from typing import Any

import mpmath

DIGITS = 40
#: Numbers of so many digits; of this file alone, and used by one thread at a time.
mp = mpmath.mp.clone()
mp.dps = DIGITS
_ALONE = Lock()
#: By what an even number of stages sees its error estimates: near the eigenvalues' real parts.
EVEN = {2: "0.15", 4: "0.15", 6: "0.1"}
#: Nodes of means where the nodes of a step are too few, and what these may leave out of a mean.
FINE, LEFT_OUT = 16, "1e-15"
#: Between two places where switching functions are known they are looked at in so many parts.
PARTS = 3


@cache
def tableau(stages: int, nodes: int, *, lossy: bool = False, lanes: int = 0) -> str:
    """Return the tables of a step with so many stages, its means taken at so many nodes.

    Parameters
    ----------
    lanes : of vectors that hold stages or nodes, for which some tables are written once more.
    lossy : a dissipative step: one stage, with the state and the co-states at the step's end, and
        inputs at its middle.
    """
    with _ALONE:
        c, b = _gauss(stages)
        lagrange = [_lagrange(c, i) for i in range(stages)]
        reach = [_integral(part) for part in lagrange]
        a = mp.matrix([[_at(reach[j], c[i]) for j in range(stages)] for i in range(stages)])
        basis, values = _eigen(a)
        tables = {
            "stage_at": c,
            "stage_weight": b,
            "stage_start": [_at(part, mp.mpf(0)) for part in lagrange],
            "stage_end": [_at(part, mp.mpf(1)) for part in lagrange],
            "stage_last": [_last(c, b, 1), _last(c, b, 2)],
            "stage_lead": [part[-1] for part in lagrange],
            "along": [part[1:] for part in reach],
            "stage_reach": a.tolist(),
            "node_last": _two_last(nodes, stages),
            "fine_last": _two_last(FINE, stages),
            **_means("node", nodes, lagrange, b),
            **_means("fine", FINE, lagrange, b),
            "stage_basis": basis.tolist(),
            "basis_inverse": (basis**-1).tolist(),
            "eigenvalue": values,
            **_between([mp.mpf(0), *c, mp.mpf(1)]),
        }
        tables |= _lanes(tables, lanes) if lanes else {}
        if lossy:
            tables |= {name: [[mp.mpf(1)]] for name in ("stage_reach", "node_reach", "node_mean")}
            tables["eigenvalue"] = values = [[mp.mpf(1), mp.mpf(0)]]
        # the real eigenvalue, where there is one: the estimate of errors needs a real factor
        filters = [mp.re(values[0][0]) if stages % 2 else mp.mpf(EVEN[stages])]
        sizes = {"STAGES": stages, "NODES": nodes, "PAIRS": stages // 2, "PARTS": PARTS}
        sizes |= {"FINE": FINE, "LOSSY": int(lossy)}
        head = [f"#define {name} {value}" for name, value in sizes.items()]
        coarse = {"COARSE": nodes, "TOO_COARSE": FINE}
        head += [f"static const double filter = {_numbers(filters)};"]
        head += [f"#define {k} {_numbers([_term(n, n - 1, stages)])}" for k, n in coarse.items()]
        return "\n".join([*head, *(_table(name, rows) for name, rows in tables.items())])


def _means(name: str, nodes: int, lagrange: list[Any], b: list[Any]) -> dict[str, list[Any]]:
    """Return how nodes are reached by rates, and by what of them the mean of a stage is made."""
    t, w = _gauss(nodes)
    reach = [_integral(part) for part in lagrange]
    parts = zip(lagrange, b, strict=True)
    return {
        f"{name}_at": t,
        f"{name}_weight": w,
        f"{name}_reach": [[_at(one, x) for one in reach] for x in t],
        f"{name}_mean": [
            [v * _at(part, x) / own for x, v in zip(t, w, strict=True)] for part, own in parts
        ],
    }


def _lanes(tables: dict[str, Any], lanes: int) -> dict[str, list[list[Any]]]:
    """Return some tables once more, as vectors of so many lanes take them."""
    reach = {
        f"{n}_lanes": _in_lanes(tables[f"{n}_reach"], lanes) for n in ("stage", "node", "fine")
    }
    others = ("node_mean", "fine_mean", "basis_inverse", "stage_basis")
    return reach | {f"{name}_lanes": _in_lanes(tables[name], lanes) for name in others}


def _in_lanes(rows: list[list[Any]], lanes: int) -> list[list[Any]]:
    """Return the columns of some rows at a time, one row per lane; lanes left over have zeros."""
    groups = [rows[n : n + lanes] for n in range(0, len(rows), lanes)]
    rest = [mp.mpf(0)] * lanes
    return [[*column, *rest][:lanes] for rows in groups for column in zip(*rows, strict=True)]


def _between(places: list[Any]) -> dict[str, list[Any]]:
    """Return places between others, and how a function's values at those give it there."""
    parts = [mp.mpf(n) / PARTS for n in range(1, PARTS)]
    at = [a + part * (b - a) for a, b in pairwise(places) for part in parts]
    polynomials = [_lagrange(places, i) for i in range(len(places))]
    return {"between": at, "from_others": [[_at(one, x) for one in polynomials] for x in at]}


def _gauss(n: int) -> tuple[list[Any], list[Any]]:
    """Return nodes and weights of Gauss's rule on [0, 1]."""
    # P_n(2x - 1) by its coefficients, which are whole
    whole = [
        mp.mpf((-1) ** (n + k)) * mp.binomial(n, k) * mp.binomial(n + k, k) for k in range(n + 1)
    ]
    roots = sorted(mp.re(r) for r in mp.polyroots(whole[::-1], maxsteps=500, extraprec=400))
    slope = [k * v for k, v in enumerate(whole)][1:]
    weights = [1 / (x * (1 - x) * _at(slope, x) ** 2) for x in roots]
    return roots, weights


def _term(nodes: int, term: int, stages: int) -> Any:
    """Return how large a term of a series may be, if what nodes leave out of a mean is LEFT_OUT.

    Means are of as many orders more as nodes are more: by the decay of what they are of.
    """
    return mp.mpf(LEFT_OUT) ** (mp.mpf(term) / (2 * nodes + 1 - stages))


def _two_last(nodes: int, stages: int) -> list[list[Any]]:
    """Return what gives the last term, and a hundredth of what the one before makes it expected.

    Of even and odd functions every other term is zero; else the last one is the better judge.
    """
    part = _term(nodes, 1, stages) / 100
    before = [part * value for value in _last(*_gauss(nodes), 2)]
    return [_last(*_gauss(nodes), 1), before]


def _last(nodes: list[Any], weights: list[Any], part: int) -> list[Any]:
    """Return what gives a polynomial's last term, or that before, in Legendre's, at the ends."""
    n = max(len(nodes) - part, 0)
    found = zip(nodes, weights, strict=True)
    return [(2 * n + 1) * w * mp.legendre(n, 2 * x - 1) for x, w in found]


def _lagrange(nodes: list[Any], i: int) -> list[Any]:
    """Return the coefficients of the polynomial that is 1 at node i and 0 at the others."""
    found = [mp.mpf(1)]
    for k, node in enumerate(nodes):
        if k != i:
            scale = nodes[i] - node
            found = [
                ((found[n - 1] if n else 0) - node * (found[n] if n < len(found) else 0)) / scale
                for n in range(len(found) + 1)
            ]
    return found


def _integral(coefficients: list[Any]) -> list[Any]:
    return [mp.mpf(0), *(value / (n + 1) for n, value in enumerate(coefficients))]


def _at(coefficients: list[Any], x: Any) -> Any:
    found = mp.mpf(0)
    for value in reversed(coefficients):
        found = found * x + value
    return found


def _eigen(a: Any) -> tuple[Any, list[list[Any]]]:
    """Return a real basis in which `a` has blocks ((r, i), (-i, r)), and r and i of each.

    The real eigenvalue, which an odd number of stages has, comes first.
    """
    values, vectors = mp.eig(a)
    columns, found = [], []
    for n in sorted(range(len(values)), key=lambda n: (abs(mp.im(values[n])), mp.re(values[n]))):
        value, vector = values[n], vectors[:, n]
        if abs(mp.im(value)) < mp.mpf(10) ** (-DIGITS // 2):
            columns.append([mp.re(v / vector[0]) for v in vector])
            found.append([mp.re(value), mp.mpf(0)])
        elif mp.im(value) > 0:
            columns += [
                [mp.re(v / vector[0]) for v in vector],
                [mp.im(v / vector[0]) for v in vector],
            ]
            found.append([mp.re(value), mp.im(value)])
    return mp.matrix(columns).T, found


def _table(name: str, rows: list[Any]) -> str:
    """Return a vector or a matrix in C."""
    if not isinstance(rows[0], list):
        return f"static const double {name}[{len(rows)}] = {{{_numbers(rows)}}};"
    inner = ",\n    ".join(f"{{{_numbers(row)}}}" for row in rows)
    return f"static const double {name}[{len(rows)}][{len(rows[0])}] = {{\n    {inner}}};"


def _numbers(values: list[Any]) -> str:
    return ", ".join(mp.nstr(value, 17, min_fixed=1, max_fixed=0) for value in values)


def files():
    """Return the arguments of the tables in each file, by its name."""
    found = {}
    for stages in range(1, 7):
        lanes, nodes = 1 << (stages - 1).bit_length(), stages + 2
        found[f"{stages}_{stages}"] = stages, stages, {}
        found[f"{stages}_{nodes}"] = stages, nodes, {}
        if stages > 1:
            found[f"{stages}_{nodes}_lanes"] = stages, nodes, {"lanes": lanes}
    return {**found, "1_1_lossy": (1, 1, {"lossy": True})}


def text(name):
    """Return the text of a file; that of lanes goes behind the one without."""
    stages, nodes, options = files()[name]
    found, alone = tableau(stages, nodes, **options), tableau(stages, nodes)
    return f"{found.removeprefix(alone).lstrip()}\n" if "lanes" in options else f"{found}\n"


if __name__ == "__main__":
    folder = Path(__file__).parents[2] / "piezo_sym" / "run" / "engine" / "tables"
    for name in files():
        (folder / f"{name}.c").write_text(text(name), encoding="utf-8")
