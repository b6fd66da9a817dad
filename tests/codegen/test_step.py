"""The step closes both balances to round-off, whatever the network, and is of second order."""

from pathlib import Path

import numpy as np
import pytest

from piezo_sym import derive, load
from piezo_sym.codegen.newton import start_of, step_of
from piezo_sym.modules import module_of
from piezo_sym.proofs import Verdict, decide
from tests.codegen.evaluated import newton, value

STORES = {"spring", "mass", "capacitor", "inductor", "hysteron"}
SPECS = sorted((Path(__file__).parents[1] / "networks" / "specs").glob("*.toml"))


class Stepped:
    """A model, its module, and its step evaluated term by term."""

    def __init__(self, model):
        self.model = model
        self.iphs = derive(model)
        rows = decide(self.iphs).rows
        odd = {r.element for r in rows if r.id == "odd" and r.verdict is Verdict.PROVED}
        self.step = step_of(self.iphs, frozenset(odd))
        self.start = start_of(self.iphs)
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

    def __call__(self, x, u, h, step=None):
        constants = {f.name: np.asarray(getattr(self.p, f.name)) for f in self.module.PARAMETERS}
        constants |= {f"{bank}_count": size for bank, size in self.counts.items()}
        given = dict(zip(self.model.inputs, u, strict=True))
        new, at = newton(
            step or self.step, self.names, self.counts, self.split(x), given, h, constants
        )
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


@pytest.fixture(params=["step", "start"])
def step(request, stepped):
    """The ordinary step, or the dissipative one; the first where there is no second."""
    found = getattr(stepped, request.param)
    kinds = {element.kind for element in stepped.model.elements.values()}
    assert (found is None) <= (kinds.isdisjoint(STORES) or "thermal_mass" not in kinds)
    return found or stepped.step


def test_both_balances_close_to_round_off(stepped, step):
    x, u = start(stepped)
    h = 1e-7 if stepped.model.name in {"thermistor", "maxwell_slip"} else 2e-5
    module, p = stepped.module, stepped.p
    for _ in range(5):
        new, at = stepped(x, u, h, step)
        energy = module.energy(new, p) - module.energy(x, p)
        supplied = h * sum(np.sum(value(row.value, at)) for row in step.supplies)
        produced = h * sum(np.sum(value(row.value, at)) for row in step.productions)
        produced += h * sum(value(row.value, at) for row in step.numerical[1:])
        crossed = h * sum(np.sum(value(row.value, at)) for row in step.entropies)
        scale = abs(module.energy(x, p)) + abs(module.energy(new, p))
        assert abs(energy - supplied) <= 4e-16 * scale + 1e-15 * abs(supplied)
        gained = module.entropy(new, p) - module.entropy(x, p)
        assert abs(gained - produced - crossed) <= 1e-15 * (1e-3 + abs(module.entropy(new, p)))
        assert all(np.all(value(row.value, at) >= 0) for row in step.productions)
        assert all(value(row.value, at) >= 0 for row in step.numerical)
        x = new


def test_a_small_step_follows_the_rates_at_its_middle(stepped):
    x, u = start(stepped)
    lanes = [bank for bank in stepped.banks for _ in range(stepped.counts[bank] if bank else 1)]
    x = x + 1e-3 * np.array([bank is not None for bank in lanes])
    h = 1e-8
    new, _ = stepped(x, u, h)
    rates = stepped.module.rhs((x + new) / 2, u, stepped.p)
    assert np.allclose((new - x) / h, rates, rtol=1e-6, atol=1e-7 * np.abs(rates).max())


def test_stores_follow_the_rates_at_the_end_of_a_dissipative_step():
    stepped = Stepped(load("piezo_stack"))
    x, u = start(stepped)
    new, _ = stepped(x, u, 1e-5, stepped.start)
    moved = (new - x) / 1e-5
    early, late = (stepped.module.rhs(at, u, stepped.p) for at in (x, new))
    stores = [0, 2, 3, 4]  # the rate of p has alpha(T) in it, and T is a mean
    assert np.allclose(moved[stores[0]], late[stores[0]], rtol=1e-12)
    assert np.abs(moved - late)[stores].max() < 1e-3 * np.abs(late - early)[stores].max()
