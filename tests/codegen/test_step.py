"""The step closes both balances to round-off, whatever the network, and is of second order."""

from pathlib import Path

import numpy as np
import pytest

from piezo_sym import derive, load, verify
from piezo_sym.codegen.newton import step_of
from piezo_sym.modules import module_of
from piezo_sym.proofs import Verdict
from tests.codegen.evaluated import newton, value

SPECS = sorted((Path(__file__).parents[1] / "networks" / "specs").glob("*.toml"))


class Stepped:
    """A model, its module, and its step evaluated term by term."""

    def __init__(self, model):
        self.model = model
        self.iphs = derive(model)
        rows = verify(self.iphs).rows
        odd = {r.element for r in rows if r.id == "odd" and r.verdict is Verdict.PROVED}
        self.step = step_of(self.iphs, frozenset(odd))
        self.module = module_of(model)
        self.p = self.module.Parameters()
        self.counts = {b: getattr(self.p, f"{b}_count") for b in self.module.BANKS}
        self.names = [slot.label for slot in self.iphs.system.states]
        self.banks = [slot.bank for slot in self.iphs.system.states]

    def split(self, x):
        parts, n = [], 0
        for bank in self.banks:
            size = self.counts[bank] if bank else 1
            parts.append(x[n : n + size] if bank else float(x[n]))
            n += size
        return parts

    def __call__(self, x, u, h):
        constants = {f.name: np.asarray(getattr(self.p, f.name)) for f in self.module.PARAMETERS}
        constants |= {f"{bank}_count": size for bank, size in self.counts.items()}
        given = dict(zip(self.model.inputs, u, strict=True))
        new, at = newton(self.step, self.names, self.counts, self.split(x), given, h, constants)
        return np.concatenate([np.atleast_1d(part) for part in new]), at


@pytest.fixture(
    scope="module",
    params=["piezo_stack", *map(str, SPECS)],
    ids=["piezo_stack", *(path.stem for path in SPECS)],
)
def stepped(request):
    return Stepped(load(request.param))


def start(stepped):
    u = np.array([entry.si for entry in stepped.model.inputs.values()])
    if stepped.model.name == "piezo_stack":
        u[1] = 60.0
    x = stepped.module.initial_state(u, stepped.p)
    return x, u


def test_both_balances_close_to_round_off(stepped):
    x, u = start(stepped)
    h = 1e-7 if stepped.model.name in {"thermistor", "maxwell_slip"} else 2e-5
    module, p = stepped.module, stepped.p
    for _ in range(5):
        new, at = stepped(x, u, h)
        energy = module.energy(new, p) - module.energy(x, p)
        supplied = h * sum(np.sum(value(row.value, at)) for row in stepped.step.supplies)
        produced = h * sum(np.sum(value(row.value, at)) for row in stepped.step.productions)
        crossed = h * sum(np.sum(value(row.value, at)) for row in stepped.step.entropies)
        scale = abs(module.energy(x, p)) + abs(module.energy(new, p))
        assert abs(energy - supplied) <= 4e-16 * scale + 1e-15 * abs(supplied)
        gained = module.entropy(new, p) - module.entropy(x, p)
        assert abs(gained - produced - crossed) <= 1e-15 * (1e-3 + abs(module.entropy(new, p)))
        assert all(np.all(value(row.value, at) >= 0) for row in stepped.step.productions)
        x = new


def test_a_small_step_follows_the_rates_at_its_middle(stepped):
    x, u = start(stepped)
    lanes = [bank for bank in stepped.banks for _ in range(stepped.counts[bank] if bank else 1)]
    x = x + 1e-3 * np.array([bank is not None for bank in lanes])
    h = 1e-8
    new, _ = stepped(x, u, h)
    rates = stepped.module.rhs((x + new) / 2, u, stepped.p)
    assert np.allclose((new - x) / h, rates, rtol=1e-6, atol=1e-7 * np.abs(rates).max())
