"""Modules compute both sides of a choice, and say nothing of what is not chosen."""

import warnings

import numpy as np
import pytest

from piezo_sym.modules import module_of
from piezo_sym.spec.load import parse

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
