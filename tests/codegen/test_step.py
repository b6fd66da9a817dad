"""A step of order two is the rates at its middle, whatever the network."""

from pathlib import Path

import numpy as np
import pytest

from piezo_sym import Stepper, load
from piezo_sym.modules import module_of

SPECS = sorted((Path(__file__).parents[1] / "networks" / "specs").glob("*.toml"))


@pytest.mark.some(4)
@pytest.mark.parametrize("path", ["piezo_stack", *SPECS], ids=lambda path: Path(path).stem)
def test_a_small_step_follows_the_rates_at_its_middle(path):
    model, h = load(path), 1e-8
    module, steps = module_of(model), Stepper(model, step=h)
    p = module.Parameters()
    banks = [record.bank for record in module.STATES for _ in range(sizes(p, record.bank))]
    x = steps.x + 1e-3 * np.array([bank is not None for bank in banks])
    u = np.array([entry.si for entry in model.inputs.values()])
    if model.name == "piezo_stack":
        u[1] = 60.0
    steps.reset(x)
    steps.step(u)
    rates = module.rhs((x + steps.x) / 2, u, p)
    assert np.allclose((steps.x - x) / h, rates, rtol=1e-6, atol=1e-7 * np.abs(rates).max())


def sizes(p, bank):
    """Return the number of rows of a state."""
    return getattr(p, f"{bank}_count") if bank else 1
