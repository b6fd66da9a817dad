"""The derivation gives Proposition 3 of the paper, entry by entry, for several r."""

import pytest
import sympy as sp

from .paper import Paper

SIZES = (1, 2, 3, 5)


def normal(expr) -> sp.Expr:
    """Return an expression with each branch as branch times an indicator of its condition."""

    def branches(*pairs) -> sp.Expr:
        *cases, (rest, _) = pairs
        assert rest == 0
        return sum(value * sp.Symbol(f"[{condition}]") for value, condition in cases)

    return sp.expand(sp.sympify(expr).replace(sp.Piecewise, branches))


def equal(left, right) -> bool:
    return all(normal(a - b) == 0 for a, b in zip(left, right, strict=True))


@pytest.fixture(params=SIZES)
def paper(request):
    return Paper(request.param)


@pytest.fixture
def explicit(iphs, paper):
    return iphs.expand({"hysteron": paper.r})


def test_state_input_and_energy(explicit, paper):
    assert list(explicit.x) == list(paper.x)
    assert equal(explicit.u, paper.u)
    assert sp.expand(explicit.U - paper.U) == 0
    assert explicit.S == paper.S


def test_costates_are_the_gradient_of_the_energy(explicit, paper):
    assert equal(explicit.E, [sp.diff(paper.U, x) for x in paper.x])


def test_structure_matrix_of_eq_15(explicit, paper):
    assert equal(explicit.J0, paper.J0)


def test_processes(explicit, paper):
    *hysterons, damper = explicit.processes
    assert len(hysterons) == paper.r
    for j, process in enumerate(hysterons):
        assert paper.J_j(j) == process.J
        assert equal([process.R], [paper.R_j(j)])
        assert process.bracket == paper.phi[j] / paper.L
    assert paper.J_d == damper.J
    assert equal([damper.R], [paper.R_d])
    assert damper.bracket == paper.p / paper.M
    assert sp.expand(damper.gamma - paper.d / paper.T) == 0


def test_structure_matrix_of_eq_14(explicit, paper):
    J_ir = paper.J0 + paper.R_d * paper.J_d
    for j in range(paper.r):
        J_ir += paper.R_j(j) * paper.J_j(j)
    assert equal(explicit.J_ir, J_ir)


def test_input_map_and_outputs(explicit, paper):
    assert equal(explicit.g, paper.g)
    assert equal(explicit.y, paper.y)
    assert equal(explicit.y_s, paper.g.T * sp.Matrix([0] * (paper.n - 1) + [1]))


def test_rates_of_eqs_9_to_13(explicit, paper):
    assert equal(explicit.rhs, paper.rhs)


def test_entropy_production_of_eq_7(explicit, paper):
    produced = paper.rhs[paper.n - 1] - paper.u[2]
    assert normal(explicit.sigma - produced) == 0


@pytest.mark.some(21)
@pytest.mark.parametrize("name", ["x", "u", "E", "J0", "J_ir", "g", "rhs", "y", "y_s"])
def test_symbolic_size_equals_the_written_out_lanes(iphs, explicit, paper, name):
    counts = {"hysteron": paper.r}
    assert equal(getattr(iphs, name).explicit(counts), getattr(explicit, name))


@pytest.mark.parametrize("name", ["U", "sigma"])
def test_symbolic_sums_equal_the_written_out_sums(iphs, explicit, paper, name):
    lanes = iphs.system.E.lanes
    written = lanes.expand(getattr(iphs, name), {"hysteron": paper.r})
    assert normal(written - getattr(explicit, name)) == 0


def test_symbolic_process_stands_for_each_lane(iphs, paper):
    hysteron, damper = iphs.processes
    counts = {"hysteron": paper.r}
    assert hysteron.bank == "hysteron"
    assert damper.J.explicit(counts) == paper.J_d
    for j in range(paper.r):
        assert hysteron.J.explicit(counts, lane=j + 1) == paper.J_j(j)
