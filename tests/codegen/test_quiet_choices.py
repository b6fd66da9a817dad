"""Modules compute both sides of a choice, and say nothing of what is not chosen."""

import warnings

import numpy as np
import pytest

from piezo_sym.modules import module_of
from piezo_sym.spec.load import parse
from piezo_sym.verification import process

SPEC = """
[model]
name = "contact"
[parameters]
m   = {{ value = 1.0, unit = "kg" }}
F_0 = {{ value = 2.0, unit = "N" }}
r   = {{ value = 0.5, unit = "m" }}
[domain]
assume = ["r > 0", "F_0 >= 0"]
[elements]
mass   = {{ kind = "mass", at = "tip", mass = "m", state = "p" }}
spring = {{ kind = "spring", between = ["tip", "wall"], force = "{law}", state = "q" }}
"""
FORCES = {
    "F_0*max(q/r, 0)**(3/2)": lambda z: np.maximum(z, 0) ** 1.5,
    "F_0*(log(1 + q/r) if q > 0 else q/r)": lambda z: np.where(z > 0, np.log1p(abs(z)), z),
}


@pytest.mark.parametrize("law", FORCES)
@pytest.mark.parametrize("z", [[-2.0, -1.0, 0.3, 1.0], -1.0, -3.0])
def test_no_warning_where_a_side_that_is_not_chosen_has_no_value(law, z):
    module, z = module_of(parse(SPEC.format(law=law))), np.array(z)
    p, x = module.Parameters(), np.array([0.1 + 0 * z, 0.5 * z])
    u = np.zeros((0, *z.shape))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rates, energy = module.rhs(x, u, p), module.energy(x, p)
        elements, jacobian = module.elements(x, u, p), module.jacobian(x, u, p)
    assert np.allclose(rates, [-2 * FORCES[law](z), x[0]], rtol=1e-14)
    assert np.isfinite(energy).all()
    assert np.isfinite(elements).all()
    assert jacobian.shape == (2, 2, *z.shape)


ZEROS = {
    "F_0/b*q if b > 0 else F_0*q/r": -2.0,
    "(q*F_0/(r*(1 + r/b)) if b > 0 else F_0*q/r)": -2.0,
    "F_0*q/(b + r)*(b/r)**(-1) if b > 0 else F_0*q/r": -2.0,
    "F_0*q/r*((-1 - b)**(3/2) if b < -1 else 1)": -2.0,
}


@pytest.mark.some(4)
@pytest.mark.parametrize("law", ZEROS)
@pytest.mark.parametrize("z", [[-2.0, 0.3, 1.0], 0.5])
def test_a_parameter_that_is_zero_is_divided_by_only_where_that_is_chosen(law, z):
    """Python's floats raise an error where they divide by zero, though the other side is taken."""
    text = SPEC.replace("[domain]", 'b = {{ value = 0.0, unit = "BUNIT" }}\n[domain]')
    unit = "1" if "-1" in law and "b <" in law else "m"
    model = parse(text.replace("BUNIT", unit).format(law=law))
    (row,) = (row for row in process.examined(model).rows if row.id == "program")
    assert row.verdict.value == "PROVED"  # what is read back of the module
    module, z = module_of(model), np.array(z)
    p, x, u = module.Parameters(), np.array([0.1 + 0 * z, 0.5 * z]), np.zeros((0, *z.shape))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rates, jacobian = module.rhs(x, u, p), module.jacobian(x, u, p)
        elements = module.elements(x, u, p)
    assert np.allclose(rates, [-2 * z, x[0]], rtol=1e-14)
    assert np.allclose(jacobian[0, 1], ZEROS[law] / 0.5, rtol=1e-14)
    assert np.isfinite(elements).all()
    changed = module.Parameters(b=np.full(z.shape, 0.0))  # one value per run
    assert np.array_equal(module.rhs(x, u, changed), rates)


@pytest.mark.parametrize(
    "law",
    ["F_0*q/(b - r) if b > r else F_0*q/r", "F_0*q/r*(1/(b/r - 1) if b > r else 1)"],
)
def test_a_difference_of_positive_parameters_may_be_zero(law):
    text = SPEC.replace('["r > 0"', '["b > 0", "r > 0"')
    text = text.replace("[domain]", 'b = {{ value = 0.5, unit = "m" }}\n[domain]')
    module = module_of(parse(text.format(law=law)))
    p, x, u = module.Parameters(), np.array([0.1, -0.3]), np.zeros(0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rates, jacobian = module.rhs(x, u, p), module.jacobian(x, u, p)
    assert np.allclose(rates, [1.2, 0.1], rtol=1e-14)
    assert np.allclose(jacobian, [[0, -4], [1, 0]], rtol=1e-14)
