"""Two actuators on one tip as components: against equations typed by hand, and in the commands."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from piezo_sym import load, simulate, sine
from piezo_sym.cli import run
from piezo_sym.modules import ModuleWarning, module_of
from piezo_sym.spec.source import MODELS

SPEC = """
[model]
name = "two_actuators"
[parameters]
M = { value = 7e-3, unit = "kg" }
k_r = { value = 3e5, unit = "N/m" }
[inputs]
F = { unit = "N", default = 2.0 }
V = { unit = "V" }
T_room = { unit = "K", default = 300.0 }
[components.left]
spec = "piezo_stack"
nodes = { tip = "beam", in = "amplifier" }
inputs = { T_e = "T_room" }
without = ["load", "supply", "mass"]
[components.right]
spec = "stack.toml"
nodes = { tip = "beam", in = "amplifier" }
parameters = { k = "k_r", rho = 20, lam = 1.5 }
inputs = { T_e = "T_room" }
without = ["load", "supply", "mass"]
[elements]
mass = { kind = "mass", at = "beam", mass = "M", state = "p" }
load = { kind = "force_source", at = "beam", input = "F" }
supply = { kind = "voltage_source", between = ["amplifier", "gnd"], input = "V" }
"""
STATES = [
    "left_q",
    "left_Q_C",
    "left_phi",
    "left_S",
    "right_q",
    "right_Q_C",
    "right_phi",
    "right_S",
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder with the spec, and the shipped stack as a file beside it."""
    made = tmp_path_factory.mktemp("actuators")
    shutil.copy(MODELS / "piezo_stack.toml", made / "stack.toml")
    (made / "two.toml").write_text(SPEC)
    return made


def by_hand(t, x):
    """Return the rates of q, Q, phi_1, phi_2, S of both stacks, and of p."""
    C, L, i_0, a, T_0, c_0, T_room, F = 5e-6, 1e-3, 0.5, 10.0, 296.15, 5.0, 300.0, 2.0
    v, rates, force = x[10] / 7e-3, [], F
    for q, Q, *phi, S, k, rho, lam in ((*x[:5], 5e5, 10, 2.0), (*x[5:10], 3e5, 20, 1.5)):
        T, d = T_0 * np.exp(S / c_0), 400.0
        i, alpha = np.array(phi) / L, a * T / T_0
        drop = rho / (T - T_0) * (np.maximum(i - i_0, 0) + np.minimum(i + i_0, 0))
        force += alpha * Q / C - k * q - d * v
        heat = drop @ i + d * v * v
        supply = 60 * np.sin(2 * np.pi * 250 * t)
        rates += [
            v,
            i.sum() - alpha * v,
            *(supply - Q / C - drop),
            heat / T + lam * (T_room / T - 1),
        ]
    return np.array([*rates, force])


def test_a_run_is_that_of_equations_typed_by_hand(folder):
    start = [0, 0, 0, 0, 5 * np.log(300 / 296.15)] * 2 + [0]
    kept = {"rtol": 1e-10, "atol": 1e-14, "method": "Radau"}
    reference = solve_ivp(by_hand, (0, 0.002), start, **kept).y[:, -1]
    ds = simulate(folder / "two.toml", inputs={"V": sine(60, 250)}, duration=0.002, rtol=1e-9)
    last = ds.isel(time=-1)
    found = np.concatenate([np.atleast_1d(last[name]) for name in (*STATES, "p")])
    scale = np.abs(reference).clip(1e-6)
    assert np.abs(found - reference).max(where=scale > 0, initial=0) < 1e-6
    assert (np.abs(found - reference) / scale).max() < 1e-6
    assert float(abs(ds.energy_residual).max()) < 1e-9


@pytest.mark.long
def test_the_file_of_a_component_belongs_to_the_spec(folder, tmp_path, monkeypatch):
    for path in folder.iterdir():
        shutil.copy(path, tmp_path)
    monkeypatch.chdir(tmp_path)
    assert run(["generate", "two.toml"]) == 0
    assert load("two.toml").sha256 == module_of("two.toml").SPEC_SHA256
    text = Path("stack.toml").read_text()
    Path("stack.toml").write_text(
        text.replace('value = 10.0,   unit = "C/m"', 'value = 9.0, unit = "C/m"')
    )
    assert run(["generate", "--check", "two.toml"]) == 1
    with pytest.warns(ModuleWarning, match="is not what the spec generates"):
        assert module_of("two.toml").Parameters().right_a == 9


@pytest.mark.long
def test_the_second_program_reads_a_model_written_out(folder, capfd):
    assert run(["verify", str(folder / "two.toml"), "--recheck", "--json"]) == 0
    said, heard = capfd.readouterr()
    rows = json.loads(said)
    verdicts = {row["verdict"] for row in rows if row["id"] != "invariant"}
    assert verdicts == {"PROVED"}
    assert "not confirmed" not in heard


def test_show_names_components_and_their_elements(folder, capfd):
    assert run(["show", str(folder / "two.toml")]) == 0
    said = capfd.readouterr().out
    assert "component 'left': piezo_stack, without load, supply, mass" in said
    assert "component 'right': stack.toml, without load, supply, mass" in said
    assert "right_transducer" in said


def test_what_is_wrong_with_a_component_names_it(folder, capfd):
    wrong = SPEC.replace("rho = 20", "rho = -20")
    (folder / "wrong.toml").write_text(wrong)
    assert run(["verify", str(folder / "wrong.toml")]) == 2
    said = capfd.readouterr().err
    assert "wrong.toml: components.right: domain.assume[3]: the values given are outside" in said
    assert said.count("\n") == 1
