"""Networks that must work, as specs without code of their own: everything holds for each of them.

The reference is SymPy's evaluation of the system with its banks written out.
"""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from piezo_sym import derive, load, simulate
from piezo_sym.codegen import lower, numpy_module
from piezo_sym.modules import module_of
from piezo_sym.spec.load import parse
from piezo_sym.verification import process
from piezo_sym.verification.examine import examine, examined

#: Those who run a model and those who look at its rows need the same report.
pytestmark = pytest.mark.usefixtures("known_reports")

#: Points of the attack on a system written out; its model has had them all.
FEW = 2_000
SPECS = sorted(Path(__file__).with_name("specs").glob("*.toml"))


@pytest.fixture(scope="module", params=SPECS, ids=lambda path: path.stem)
def model(request):
    return load(request.param)


@pytest.fixture(scope="module")
def exact(model):
    return derive(model).expand()


def points(model, exact):
    """Yield (x, u, values of every symbol) at random states; inputs near their defaults."""
    rng = np.random.default_rng(7)
    at = {exact.symbols[name]: entry.si for name, entry in model.parameters.items()}
    sizes = np.array([_size(exact, n, at) for n in range(len(exact.x))])
    for _ in range(3):
        x = sizes * rng.uniform(-0.2, 0.2, len(exact.x))
        u = np.array([entry.si for entry in model.inputs.values()]) * rng.uniform(0.9, 1.1)
        given = dict(zip((exact.symbols[name] for name in model.inputs), u, strict=True))
        yield x, u, {**at, **given, **dict(zip(exact.x, x, strict=True))}


def _size(exact, n, at):
    """Return how far a state moves: an entropy by what changes its temperature by its own size."""
    state, costate = exact.x[n], exact.E[n]
    if exact.system.dS[n, 0] == 0:
        return 1.0
    return float((costate / sp.diff(costate, state)).subs(state, 0).xreplace(at))


def numbers(expression, at):
    return np.array(sp.Matrix(expression).xreplace(at).evalf(), dtype=float)


@pytest.mark.some(1)
def test_it_is_proved_for_every_size_and_written_out(model, exact):
    process.examined(model).raise_if_not_proved()
    report = examined(examine(exact, points=FEW))
    report.raise_if_not_proved()


@pytest.mark.some(2)
def test_its_module_agrees_with_sympy(model, exact):
    module, p = module_of(model), module_of(model).Parameters()
    slopes = sp.Matrix(exact.rhs).jacobian(list(exact.x))
    for x, u, at in points(model, exact):
        for found, wanted in (
            (module.rhs(x, u, p)[:, None], exact.rhs),
            (module.jacobian(x, u, p), slopes),
            (module.energy(x, p)[None, None], [[exact.U]]),
            (module.outputs(x, u, p)[:, None], exact.y),
            (module.entropy_production(x, u, p).sum()[None, None], [[exact.sigma]]),
        ):
            assert np.allclose(found, numbers(wanted, at), rtol=1e-11, atol=1e-12)


@pytest.mark.some(10)
def test_both_balances_close(model, exact):
    module, p = module_of(model), module_of(model).Parameters()
    for x, u, at in points(model, exact):
        rates = module.rhs(x, u, p)
        powers = numbers(exact.E, at).ravel() * rates
        gap = powers.sum() - module.supply(x, u, p).sum()
        assert abs(gap) <= 1e-12 * np.abs(powers).sum()
        assert np.all(module.entropy_production(x, u, p) >= 0)


@pytest.mark.some(10)
def test_its_module_is_the_same_text_again(model):
    text = numpy_module(lower(derive(model), "verdict"))
    assert text == numpy_module(lower(derive(parse(model.to_toml())), "verdict"))


@pytest.mark.some(4)
def test_it_runs(model):
    run = simulate(model, duration=1e-3, rtol=1e-9)
    gross = np.abs(run.energy).max()
    assert np.all(np.abs(run.energy_residual) <= 1e-6 * gross)


def test_a_bank_of_one_is_the_element_without_a_count():
    alone, bank = (load(SPECS[0].with_name(f"hysteron_{n}.toml")) for n in ("alone", "bank_of_one"))
    first, second = module_of(alone), module_of(bank)
    x, u = np.array([0.3, 0.02, 0.1]), np.array([1.2])
    p, q = first.Parameters(), second.Parameters()
    for name in ("rhs", "jacobian", "outputs", "supply", "entropy_production", "heat"):
        assert np.array_equal(getattr(first, name)(x, u, p), getattr(second, name)(x, u, q))
    assert first.energy(x, p) == second.energy(x, q)
