"""A stack layer by layer: the shipped spec, its equations typed by hand, and the whole stack."""

from time import process_time

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from piezo_sym import derive, layered, load, operating_point, simulate, sine
from piezo_sym.errors import UsageError
from piezo_sym.modules import module_of
from piezo_sym.proofs import Verdict
from piezo_sym.verification.examine import ATTACKED, examine, examined


def by_hand(x, u, n):
    """Return the rates of q, p, Q, phi, S of each layer, from the paper's values."""
    q, p, Q, phi, S = np.reshape(x, (n, 5)).T
    F, V, T_e = u
    M, c, T_0 = 3.5e-3 * 6 * n / ((n + 1) * (2 * n + 1)), 5 / n, 296.15
    v, T, i = p / M, T_0 * np.exp(S / c), phi / (n * 5e-4)
    drop = n * 5 / (T - T_0) * (np.maximum(i - 1 / n, 0) + np.minimum(i + 1 / n, 0))
    stretch, alpha = v - np.append(0, v[:-1]), 10 * T / T_0
    force = alpha * Q * n / 5e-6 - n * 5e5 * q - n * 400 * stretch
    flow = 2 * n * (T[:-1] - T[1:])
    heat = drop * i + n * 400 * stretch**2 + np.append(0, flow) - np.append(flow, 0)
    heat[[0, -1]] += 1.0 * (T_e - T[[0, -1]])
    rates = (stretch, force - np.append(force[1:], -F), i - alpha * stretch)
    return np.transpose([*rates, V - Q * n / 5e-6 - drop, heat / T]).ravel()


def test_three_layers_are_the_shipped_spec_and_its_equations():
    assert layered(3) == load("layered_stack")
    module, rng = module_of("layered_stack"), np.random.default_rng(3)
    for _ in range(20):
        x = (rng.normal(size=(3, 5)) * [1e-4, 1e-2, 1e-4, 1e-3, 0]).ravel()
        x[4::5] = rng.uniform(0.02, 0.4, 3)
        u = (rng.normal(), 100 * rng.normal(), 300.0)
        expected = by_hand(x, u, 3)
        scale = np.abs(expected).clip(1e-9)
        assert (np.abs(module.rhs(x, u, module.Parameters()) - expected) / scale).max() < 1e-9


def test_at_rest_it_is_as_long_as_the_whole_stack():
    given = {"V_in": 80.0, "F_ext": -3.0, "T_e": 310.0}
    one, other = (operating_point(name, inputs=given) for name in ("piezo_stack", "layered_stack"))
    assert sum(other.x[:15:5]) == pytest.approx(one.x[0], rel=1e-9)


def test_it_is_hottest_inside():
    ds = simulate("layered_stack", inputs={"V_in": sine(100, 100)}, duration=0.05, step=1e-4)
    T = [float(ds[f"T_body_{j}"][-1]) for j in (1, 2, 3)]
    assert T[1] > max(T[0], T[2]) > 298.15


@pytest.mark.long
def test_a_stack_of_200_layers_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where no module of its name is
    n = 200
    model, x = layered(n), np.tile([0, 0, 0, 0, 5 / n * np.log(298.15 / 296.15)], n)
    ds = simulate(model, inputs={"V_in": 80.0}, duration=2e-4, times=3, rtol=1e-8)
    given = {"method": "LSODA", "rtol": 1e-10, "atol": 1e-13, "args": ((0.0, 80.0, 298.15), n)}
    end = solve_ivp(lambda _, *rest: by_hand(*rest), (0, 2e-4), x, **given).y[:, -1]
    scale = np.tile(np.abs(end.reshape(n, 5)).max(axis=0), n)
    names = [f"{name}_{j}" for j in range(1, n + 1) for name in ("q", "p", "Q", "phi", "S")]
    found = [float(ds[name][-1]) for name in names]
    assert (np.abs(found - end) / scale).max() < 1e-6
    supplied = sum(ds[name] for name in ds.data_vars if str(name).startswith("supplied_"))
    balance = ds["energy"] - ds["energy"][0] - supplied
    assert np.abs(balance).max() < 1e-12 * np.abs(ds["energy"]).max()


@pytest.mark.long
@pytest.mark.parametrize("n", [1, pytest.param(100, marks=pytest.mark.long)])
def test_time_to_prove_it_grows_with_its_layers(n):
    """The time per layer grows, though not by as much as their number."""
    one, two = (proving(layers) for layers in (n, 2 * n))
    assert two < 4 * one


def proving(layers):
    """Return the time that it takes to prove a stack [s]."""
    model, begun = layered(layers), process_time()
    report = examined(examine(derive(model)))
    assert {row.verdict for row in report.rows} == {Verdict.PROVED}
    assert {row.points > 0 for row in report.rows if row.id in ATTACKED} == {True}
    return process_time() - begun


@pytest.mark.parametrize("n", [0, -1, 2.0, True, "3", None])
def test_a_number_of_layers_is_a_whole_one(n):
    with pytest.raises(UsageError, match="is no number of layers; expected 1, 2, 3"):
        layered(n)
