"""Rows of many banks stand where they should: the module against the banks written out."""

import inspect
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from piezo_sym import derive, load, simulate, verify
from piezo_sym.modules import module_of
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "banks"
[parameters]
L   = { value = 0.5,   unit = "H" }
C   = { value = 0.2,   unit = "F" }
rho = { value = 2.0,   unit = "V/A**3" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 3.0,   unit = "J/K" }
[inputs]
V = { unit = "V" }
[domain]
assume = ["rho >= 0"]
[elements]
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
h1 = { kind = "hysteron", between = ["in", "n1"], count = 2, LAW }
C1 = { kind = "capacitor", between = ["n1", "gnd"], capacitance = "C" }
h2 = { kind = "hysteron", between = ["n1", "n2"], count = 1, LAW }
C2 = { kind = "capacitor", between = ["n2", "gnd"], capacitance = "C" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
h3 = { kind = "hysteron", between = ["n2", "n3"], count = 3, LAW }
C3 = { kind = "capacitor", between = ["n3", "gnd"], capacitance = "C" }
h4 = { kind = "hysteron", between = ["n3", "gnd"], count = 2, LAW }
""".replace("LAW", 'inductance = "L", voltage = "rho*T/T_0*i**3", heats = "body"')
U = np.array([0.7])


@pytest.fixture(scope="module")
def compared():
    model = parse(SPEC)
    exact = derive(model).expand()
    values = {exact.symbols[n]: p.si for n, p in model.parameters.items()}
    values[exact.symbols["V"]] = U[0]
    return module_of(model), exact, values


def test_ends_of_banks_have_names(compared):
    text = inspect.getsource(compared[0].rhs) + inspect.getsource(compared[0].jacobian)
    assert "    end_phi_h1 = h1_count\n    end_phi_h2 = 1 + end_phi_h1 + h2_count\n" in text
    assert "h1_count + " not in text


def test_rows_of_many_banks(compared):
    module, exact, values = compared
    x = np.random.default_rng(3).uniform(-1, 1, len(exact.x))
    at = {**values, **dict(zip(exact.x, x, strict=True))}
    p = module.Parameters()
    jacobian = sp.Matrix(exact.rhs).jacobian(list(exact.x))
    for found, wanted in (
        (module.rhs(x, U, p), exact.rhs),
        (module.jacobian(x, U, p), jacobian),
        (module.entropy_production(x, U, p).sum(), sp.Matrix([exact.sigma])),
        (module.outputs(x, U, p), exact.y),
    ):
        numbers = np.array(sp.Matrix(wanted).xreplace(at).evalf(), dtype=float)
        assert np.allclose(np.ravel(found), np.ravel(numbers), rtol=1e-12, atol=1e-14)


@pytest.mark.long
def test_banks_of_saturating_coils_run():
    """Their currents are given to stages as means, each lane its own; ends of banks have names."""
    model = load(Path(__file__).with_name("saturating_banks.toml"))
    assert verify(derive(model)).proved
    run = simulate(model, duration=0.5, rtol=1e-8, times=21)
    assert run.engine.startswith("compiled")
    assert np.ptp(run.phi_third.values) > 0.01
    assert np.abs(run.energy_residual).max() <= 1e-12 * run.energy.max()
    fixed = simulate(model, duration=0.5, step=1e-3, order=4, times=21)
    assert np.allclose(fixed.phi_first, run.phi_first, rtol=0, atol=1e-6)
