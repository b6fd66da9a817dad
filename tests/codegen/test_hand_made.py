"""The step holds for models that no spec can write yet: each closes its balances to round-off."""

import numpy as np
import pytest

from piezo_sym.run.simulate import simulate

from .hand_made import HandMade

#: A gas under a piston on a spring: volume and entropy share one energy.
GAS = HandMade(
    name="gas",
    parameters={"m": 0.05, "k": 800.0, "d": 0.6, "T_0": 300.0, "c": 0.8, "R": 0.3, "l": 0.1},
    states={"q": (0.02, None), "p": (0.0, None), "S": (0.01, None)},
    energies=["p**2/(2*m)", "k*q**2/2", "c*T_0*exp((S - R*log(1 + q/l))/c)"],
    rates={"q": "E_p", "p": "F - E_q - d*E_p", "S": "d*E_p*E_p/E_S"},
    inputs={"F": 0.0},
    supply={"pull": "F*E_p"},
    heats={"damper": ("d*E_p*E_p", "S")},
    limits=("1 + q/l",),
)


@pytest.fixture(scope="module")
def gas(tmp_path_factory):
    return GAS.module(tmp_path_factory.mktemp("gas"))


@pytest.mark.parametrize(
    "way", [{"rtol": 1e-4}, {"rtol": 1e-9}, {"step": 2e-3}, {"step": 2e-3, "order": 6}]
)
def test_a_store_of_several_states_closes_its_balances(gas, way):
    run = simulate(gas, duration=0.2, inputs={"F": 20.0}, times=50, **way)
    p = gas.Parameters()
    x = np.array([run[name].values for name in ("q", "p", "S")])
    energy = gas.energy(x, p)
    supplied = 20.0 * (x[0] - x[0, 0])
    assert np.ptp(x[0]) > 0.005
    assert np.abs(energy - energy[0] - supplied).max() <= 1e-12 * energy.max()
    assert np.abs(run.entropy_residual).max() <= 1e-12 * abs(x[2]).max()
    assert np.all(np.diff(run.produced_damper) >= 0)
