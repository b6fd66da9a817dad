"""Named results: the effort, flow, power, energy and heat of each element, against closed forms."""

import ctypes
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from piezo_sym import load, simulate, sine
from piezo_sym.cli import app
from piezo_sym.errors import UsageError
from piezo_sym.modules import module_of
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.engine.records import at
from piezo_sym.spec.source import shipped

NETWORKS = Path(__file__).parents[1] / "networks"
DRIVE = {"V_in": sine(100, 100), "F_ext": 1.5}


@pytest.fixture(scope="module")
def run():
    given = {"inputs": DRIVE, "duration": 0.01, "rtol": 1e-9, "times": 2001}
    return simulate("piezo_stack", outputs="all", parameters={"hysteron_count": 3}, **given)


def states_near(module, p, number, seed=3):
    """Return states near the start, of sizes that change what is stored."""
    start = module.initial_state(module.INPUT_DEFAULTS, p)
    rng = np.random.default_rng(seed)
    size = np.maximum(np.abs(start), 1e-4)[:, None]
    return start[:, None] + size * rng.uniform(-0.2, 0.4, (start.size, number))


@pytest.mark.some(5)
@pytest.mark.parametrize("name", [*shipped(), NETWORKS / "specs" / "rigid_couplings.toml"], ids=str)
def test_power_is_conserved_and_energies_are_those_of_stores(name, monkeypatch):
    monkeypatch.syspath_prepend(NETWORKS)
    from element_balances import check_elements

    module, model = module_of(name), load(name)
    spec = {"elements": {n: e.model_dump(exclude_none=True) for n, e in model.elements.items()}}
    p = module.Parameters()
    u = np.array(module.INPUT_DEFAULTS) * 1.1 + 0.1
    for x in states_near(module, p, 6).T:
        if np.all(module.margins(x, u, p) >= 0):
            check_elements(module, spec, x, u)


def test_the_stack_is_what_the_paper_says(run):
    p = {name.removeprefix("parameter_"): v for name, v in run.attrs.items()}
    v, V, i = run.p / p["M"], run.Q_C / p["C"], run.phi / p["L"]
    alpha = p["a"] * run.T_body / p["T_0"]
    law = p["rho"] / (run.T_body - p["T_0"]) * np.sign(i) * np.maximum(np.abs(i) - p["i_0"], 0)
    wanted = {
        "spring.effort": p["k"] * (run.q - p["q_l"]),
        "spring.flow": v,
        "mass.flow": v,
        "mass.energy": run.p**2 / (2 * p["M"]),
        "capacitor.flow": i.sum("hysteron") - alpha * v,
        "hysteron.effort": run.V_in - V + 0 * i,
        "hysteron.flow": i,
        "hysteron.energy": run.phi**2 / (2 * p["L"]),
        "hysteron.heat": law * i,
        "damper.effort": p["d"] * v,
        "damper.heat": p["d"] * v**2,
        "damper.power": p["d"] * v**2,
        "transducer.flow_1": alpha * v,
        "transducer.effort_2": -alpha * V,
        "transducer.power": alpha * v * V,
        "body.effort": run.T_body,
        "body.energy": p["c_0"] * run.T_body,
        "ambient.power": -p["lam"] * (run.T_e - run.T_body),
        "load.effort": -run.F_ext,
        "load.power": -run.F_ext * v,
        "supply.effort": run.V_in,
        "supply.flow": -run.y_supply,
        "supply.power": -run.V_in * run.y_supply,
    }
    for name, value in wanted.items():
        size = float(np.abs(value).max())
        assert np.allclose(run[name], value.transpose(*run[name].dims), atol=1e-12 * size), name


def test_powers_integrate_to_energies_and_heats(run):
    for store in ("spring", "mass", "capacitor", "body"):
        grown = run[f"{store}.energy"] - run[f"{store}.energy"][0]
        put_in = run[f"{store}.power"].integrate("time")
        assert float(grown[-1]) == pytest.approx(float(put_in), rel=1e-3, abs=1e-4)
    heats = run["hysteron.heat"].integrate("time")
    assert np.allclose(heats, run.heat_hysteron[-1], rtol=1e-3)
    stored = [run[n] for n in run.data_vars if str(n).endswith(".energy")]
    assert np.allclose(sum(e.sum(set(e.dims) - {"time"}) for e in stored), run.energy, rtol=1e-12)


def test_units_texts_and_lanes(run):
    assert run["spring.effort"].attrs == {"units": "N", "long_name": "force of spring 'spring'"}
    assert run["hysteron.heat"].dims == ("time", "hysteron")
    assert run["body.flow"].attrs["units"] == "W/K"
    assert run["supply.power"].attrs["long_name"] == "power into voltage_source 'supply'"


@pytest.mark.long
def test_joined_stores_have_theirs():
    run = simulate(NETWORKS / "specs" / "rigid_couplings.toml", duration=1.0, outputs=["second"])
    v = run["second.flow"]
    assert np.allclose(run["second.energy"], 0.7 * v**2 / 2)
    assert np.allclose(np.gradient(0.7 * v, run.time)[1:-1], run["second.effort"][1:-1], atol=1e-2)
    assert not [n for n in run.data_vars if str(n).startswith("first.")]


def test_a_list_takes_elements_and_single_quantities():
    given = {"duration": 1e-3, "times": 3}
    names = {*simulate("piezo_stack", **given).data_vars}
    run = simulate("piezo_stack", outputs=["spring", "damper.heat"], **given)
    more = ["spring.effort", "spring.flow", "spring.power", "spring.energy", "damper.heat"]
    assert [n for n in run.data_vars if n not in names] == more
    for one in (("damper.heat",), "damper.heat"):
        partly = simulate("piezo_stack", outputs=one, method="LSODA", **given)
        assert [n for n in partly.data_vars if n not in names] == ["damper.heat"]


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (["sprin"], "unknown name 'sprin'; expected elements and their quantities"),
        (["sprin"], "did you mean 'spring'?"),
        (["y_load"], "elements and their quantities, beside what every run has, as y_<port>"),
        (["damper.heta"], "'damper' has effort, flow, power, heat"),
        (["springs.flow"], "did you mean 'spring.flow'?"),
        (["foo"], "known: spring, mass, capacitor, hysteron, damper, transducer, body, ambient, l"),
        (["supply", "foo"], "load, supply"),
        (["spring.q"], "'spring' has effort, flow, power, energy"),
        ("sprin", "did you mean 'spring'?"),
        (3, "3 is no list of names"),
    ],
)
def test_a_wrong_name_is_refused_in_one_line(asked, said):
    with pytest.raises(UsageError, match=re.escape(said)):
        simulate("piezo_stack", duration=1e-3, outputs=asked)


def test_the_command(tmp_path):
    out = tmp_path / "run.csv"
    command = ["simulate", "piezo_stack", "--duration", "1e-3", "--out", str(out)]
    result = CliRunner().invoke(app, [*command, "--outputs", "spring, hysteron.heat"])
    assert result.exit_code == 0
    assert "force of spring 'spring'" in result.stdout
    head = out.read_text().splitlines()[0]
    assert "spring.effort [N]" in head
    assert "hysteron.heat_2 [W]" in head


def test_stores_have_them_too(tmp_path, monkeypatch):
    pytest.importorskip("zarr")
    streaming = sys.modules["piezo_sym.run.streaming"]
    monkeypatch.setattr(streaming, "WINDOW", 40_000)
    given = {"duration": 0.02, "inputs": DRIVE, "outputs": ["damper"], "rtol": 1e-9}
    kept = simulate("piezo_stack", store=tmp_path / "run.zarr", **given)
    whole = simulate("piezo_stack", **given)
    size = float(whole["damper.heat"].max())
    assert np.allclose(kept["damper.heat"], whole["damper.heat"], atol=1e-4 * size)


def test_c_says_the_same():
    module = module_of("piezo_stack")
    p, engine = module.Parameters(hysteron_count=3), engine_of(module)
    u, record = np.array([1.0, 50.0, 300.0]), engine.structure(p)
    for x in states_near(module, p, 3).T:
        wanted = module.elements(x, u, p)
        found = np.empty_like(wanted)
        x = np.ascontiguousarray(x)
        engine.function("elements")(at(x), at(u), ctypes.byref(record.value), at(found))
        assert np.allclose(found, wanted, rtol=1e-12, atol=1e-12 * np.abs(wanted).max())


def test_the_command_tells_when_events_were_and_why_a_run_stopped():
    command = ["simulate", "piezo_stack", "--duration", "1e-3", "--input", "V_in=100"]
    result = CliRunner().invoke(app, [*command, "--event", "hit=q - 1e-5", "--stop", "q > 2e-5"])
    assert result.exit_code == 0
    assert re.search(r"^event hit, 1 in all: t = \d\.\d+", result.stdout, re.MULTILINE)
    assert re.search(r"^stopped: q > 2e-5 at t = ", result.stdout, re.MULTILINE)


def test_parameters_among_the_attributes_are_shown_as_numbers():
    run = simulate("oscillator", duration=1e-2, times=2, parameters={"k": np.float64(2.5)})
    assert run.attrs["parameter_k"] == 2.5
    assert "np.float64" not in repr({k: v for k, v in run.attrs.items() if "parameter" in k})
