"""The tables of Gauss collocation: its simplifying assumptions, and the blocks of its matrix."""

import math
import re
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from sympy.integrals.quadrature import gauss_legendre
from tableau import files, tableau, text


def tables(stages, nodes):
    """Return the tables in C as arrays."""
    found, printed = {}, tableau(stages, nodes)
    for name, body in re.findall(r"double (\w+)\[[^=]*= (\{.*?\});", printed, re.DOTALL):
        rows = re.findall(r"\{([^{}]+)\}", body)
        values = [[float(part) for part in row.split(",")] for row in rows]
        found[name] = np.array(values if len(values) > 1 or "{\n" in body else values[0])
    return found


@pytest.mark.some(1)
@pytest.mark.parametrize("stages", [1, 2, 3, 4, 5])
def test_simplifying_assumptions(stages):
    """B(2s): the weights integrate degree 2s - 1.  C(s): each stage degree s - 1 (Butcher)."""
    t = tables(stages, stages + 2)
    c, b, a = (t[name].reshape(-1) for name in ("stage_at", "stage_weight", "stage_reach"))
    a = a.reshape(stages, stages)
    for k in range(1, 2 * stages + 1):
        assert b @ c ** (k - 1) == pytest.approx(1 / k, rel=1e-15)
    for k in range(1, stages + 1):
        assert a @ c ** (k - 1) == pytest.approx(c**k / k, rel=1e-14)


@pytest.mark.some(2)
@pytest.mark.parametrize("stages", [1, 2, 3, 4, 5])
def test_means_are_exact_for_polynomials(stages):
    """int_0^1 (l_i/b_i) X^2 dtau for a path X of degree s needs nodes for degree 3s - 1."""
    nodes = 2 * stages + 1
    t = tables(stages, nodes)
    c, b = t["stage_at"].reshape(-1), t["stage_weight"].reshape(-1)
    mean, reach = t["node_mean"].reshape(stages, nodes), t["node_reach"].reshape(nodes, stages)
    rates = np.random.default_rng(1).uniform(-1, 1, stages)
    polynomials = []
    for i, at in enumerate(c):
        product = np.poly1d(np.delete(c, i), r=True)
        polynomials.append(product / product(at))
    path = sum((rate * part.integ() for rate, part in zip(rates, polynomials, strict=True)), 0)
    for i, part in enumerate(polynomials):
        whole = np.poly1d(part * path * path).integ()
        assert mean[i] @ (reach @ rates) ** 2 == pytest.approx(whole(1) / b[i], abs=1e-9)


@pytest.mark.some(2)
@pytest.mark.parametrize("stages", [1, 2, 3, 4, 5])
def test_blocks_are_those_of_the_matrix(stages):
    t = tables(stages, stages + 2)
    a = t["stage_reach"].reshape(stages, stages)
    basis, inverse = (t[n].reshape(stages, stages) for n in ("stage_basis", "basis_inverse"))
    values = t["eigenvalue"].reshape(-1, 2)
    blocks, n = np.zeros((stages, stages)), 0
    for real, imaginary in values:
        size = 2 if imaginary else 1
        part = np.array([[real, imaginary], [-imaginary, real]])[:size, :size]
        blocks[n : n + size, n : n + size] = part
        n += size
    assert basis @ blocks @ inverse == pytest.approx(a, abs=1e-13)
    assert basis @ inverse == pytest.approx(np.eye(stages), abs=1e-12)


def integrals(nodes, upto):
    """Return the integral from 0 to `upto` of each Lagrange polynomial on some nodes, exactly."""
    found = []
    for i, node in enumerate(nodes):
        part = [mp.mpf(1)]  # coefficients, the constant first
        for k, other in enumerate(nodes):
            if k != i:
                shifted = [mp.mpf(0), *part]
                part = [
                    (a - other * b) / (node - other)
                    for a, b in zip(shifted, [*part, 0], strict=True)
                ]
        found.append(sum(c * upto ** (n + 1) / (n + 1) for n, c in enumerate(part)))
    return found


@pytest.mark.some(2)
@pytest.mark.parametrize("stages", [1, 2, 3, 4, 5])
def test_printed_numbers_are_those_of_gauss_to_the_last_digit(stages):
    """Nodes and weights by SymPy, in 40 digits; the others from their definitions."""
    nodes, exact = stages + 2, {}
    t = {name: table.reshape(-1).tolist() for name, table in tables(stages, nodes).items()}
    with mp.workdps(40):
        for count, name in ((stages, "stage"), (nodes, "node")):
            at, weights = gauss_legendre(count, 40)
            exact[f"{name}_at"] = sorted((mp.mpf(str(x)) + 1) / 2 for x in at)
            order = sorted(range(count), key=lambda n: at[n])
            exact[f"{name}_weight"] = [mp.mpf(str(weights[n])) / 2 for n in order]
        c, b = exact["stage_at"], exact["stage_weight"]
        exact["stage_reach"] = [a for x in c for a in integrals(c, x)]
        exact["node_reach"] = [a for x in exact["node_at"] for a in integrals(c, x)]
        basis = [
            [mp.fprod((x - o) / (n - o) for o in c if o != n) for x in exact["node_at"]] for n in c
        ]
        exact["node_mean"] = [
            w * part / b[i]
            for i in range(stages)
            for w, part in zip(exact["node_weight"], basis[i], strict=True)
        ]
        for name in ("stage_at", "stage_weight", "stage_reach", "node_reach", "node_mean"):
            for printed, wanted in zip(t[name], exact[name], strict=True):
                assert abs(mp.mpf(printed) - wanted) <= math.ulp(wanted) + 1e-30, name
        assert min(t["stage_weight"]) > 0
        assert abs(mp.fsum(t["stage_weight"]) - 1) <= mp.mpf("2e-16")
        for i in range(stages):  # the mean of a constant is the constant
            assert abs(mp.fsum(t["node_mean"][i * nodes : (i + 1) * nodes]) - 1) <= mp.mpf("1e-15")


TABLES = Path(__file__).parents[2] / "piezo_sym" / "run" / "engine" / "tables"


@pytest.mark.some(2)
@pytest.mark.parametrize("name", files())
def test_the_engine_has_these_numbers(name):
    assert (TABLES / f"{name}.c").read_text(encoding="utf-8") == text(name)


def test_the_engine_has_no_others():
    assert {path.stem for path in TABLES.iterdir()} == {*files()}
