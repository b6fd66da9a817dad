"""Edits of values: the module is the one that the spec generates, without proofs and compilers."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import Model, derive, load, simulate
from piezo_sym.build import verdict_line
from piezo_sym.codegen import collocation_of, lower, printed, template_of
from piezo_sym.errors import PiezoError, SpecError
from piezo_sym.modules import module_of
from piezo_sym.spec.source import shipped
from piezo_sym.spec.values import shape_hash
from piezo_sym.verification import verify

pytestmark = pytest.mark.usefixtures("cache")


@pytest.fixture(autouse=True)
def _work(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def written(data, path="mine.toml"):
    """Return the path of a spec file."""
    Path(path).write_text(Model(**data).to_toml(), encoding="utf-8")
    return Path(path)


def edited(path, old, new):
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def changed(model, rng):
    """Return the plain data of a spec with every value changed that can be, each on its own."""
    data = model.flatten().model_dump()
    entries = [(e, "value") for e in data["parameters"].values()]
    for entry, key in [*entries, *((e, "default") for e in data["inputs"].values())]:
        value = entry[key]
        factor = rng.uniform(0.9, 1.1)
        entry[key] = value * factor if isinstance(value, float) else [v * factor for v in value]
        try:
            Model(**data)
        except SpecError:  # outside the domain
            entry[key] = value
    return data


@pytest.mark.some(2)
@pytest.mark.parametrize("name", shipped())
def test_a_template_has_every_value(name):
    """Printed with other values, or filled with them: the same texts."""
    model = load(name)
    data = changed(model, np.random.default_rng(1))
    assert data["parameters"] != model.flatten().model_dump()["parameters"]
    assert shape_hash(data) == shape_hash(model.flatten().model_dump())
    template = replace(template_of(derive(model)), verdict="sigma PROVED")
    iphs = derive(Model(**data))
    for ending, text in printed(lower(iphs, "sigma PROVED"), collocation_of(iphs)).items():
        assert template.filled(data)[ending].startswith(text)


def test_an_edit_of_a_value_proves_and_compiles_nothing(spec, cache):
    """Neither SymPy nor the spec's types are loaded, and no library is made."""
    spec["model"]["name"] = "mine"
    path = written(spec)
    first = simulate(path, duration=1e-3)
    libraries = sorted(cache.rglob("*.so"))
    edited(path, "0.0035", "0.0036")
    code = (
        "import sys, piezo_sym\n"
        f"run = piezo_sym.simulate({str(path)!r}, duration=1e-3)\n"
        "print(run.attrs['parameter_M'], run.attrs['proofs'].split()[-1])\n"
        "print({'sympy', 'pydantic', 'pint'} & {*sys.modules})\n"
    )
    said = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    ).stdout
    assert said == "0.0036 PROVED\nset()\n"
    assert sorted(cache.rglob("*.so")) == libraries
    assert first.attrs["parameter_M"] == 0.0035


#: A stop's state starts within its limit, which loading checks: so the spec is read.
RUBBED = """
[model]
name = "mine"
title = "A mass of some grams that rubs"
[parameters]
m   = { value = 5.0, unit = "g" }
k   = { value = 2.0, unit = "N/m" }
F_c = { value = 0.1, unit = "N" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 1.0, unit = "J/K" }
[inputs]
F = { unit = "N" }
[elements]
mass = { kind = "mass", at = "tip", mass = "m", state = "p" }
rub  = { kind = "stop", between = ["tip", "wall"], stiffness = "k", limit = "F_c", heats = "body" }
load = { kind = "force_source", at = "tip", input = "F" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
"""


@pytest.mark.long
def test_an_edit_of_a_value_beside_a_stop_derives_nothing(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(RUBBED)
    module_of(path)
    path.write_text(RUBBED.replace("5.0", "6.0"))
    code = (
        "import sys, piezo_sym\n"
        f"run = piezo_sym.simulate({str(path)!r}, duration=1e-3)\n"
        "print(run.attrs['parameter_m'], {'sympy', 'pint'} & {*sys.modules})\n"
    )
    said = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    ).stdout
    assert said == "0.006 set()\n"
    path.write_text(RUBBED.replace("k   = { value = 2.0", "k   = { value = -2.0"))
    with pytest.raises(SpecError, match="outside the domain"):
        module_of(path)


def test_an_edited_module_is_what_the_edited_spec_generates(spec):
    spec["model"]["name"] = "mine"
    path = written(spec)
    module_of(path)
    edited(path, "500000.0", "510000.0")
    module, model = module_of(path), load(path)
    iphs = derive(model)
    wanted = printed(lower(iphs, verdict_line(verify(iphs))), collocation_of(iphs))
    folder = Path(module.__file__).parent
    for ending, text in wanted.items():
        assert (folder / f"mine{ending}").read_text(encoding="utf-8").startswith(text)


@pytest.mark.long
def test_a_damaged_template_is_made_again(spec, cache):
    spec["model"]["name"] = "mine"
    path = written(spec)
    module_of(path)
    (template,) = cache.rglob("*-shape/record.json")
    template.write_text(template.read_text().replace("mine", "mime", 3))
    edited(path, "0.0035", "0.0036")
    assert module_of(path).Parameters().M == 0.0036


def test_a_list_of_values_is_edited_lane_by_lane(spec):
    spec["model"]["name"] = "mine"
    spec["parameters"]["L"]["value"] = [1e-3, 2e-3]
    path = written(spec)
    module_of(path)
    edited(path, "0.002", "0.003")
    assert module_of(path).Parameters().L == (1e-3, 3e-3)


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("value = 400.0", "value = -400.0"),
        ("value = 0.0035", "value = 0.0"),
        ("value = 5.0", "value = nan"),
        ("default = 298.15", "default = 290.0"),
        ("value = 296.15", "value = 0.0"),
        ("value = 400.0, ", ""),
        ("value = 400.0", "value = " + "9" * 400),
        ('value = 400.0, unit = "N*s/m"', 'value = 1e299, unit = "GN*s/m"'),
        ("value = 0.0035", "value = true"),
        ("value = 0.0035", 'value = "3e-3"'),
        ("value = 0.0035", "value = 1e301"),
        ("value = 0.0035", "value = [3e-3, 4e-3]"),
    ],
)
def test_values_that_loading_refuses_are_refused(spec, old, new):
    """With the message of `load`, however often it is tried."""
    spec["model"]["name"] = "mine"
    path = written(spec)
    module_of(path)
    edited(path, old, new)
    with pytest.raises(SpecError) as wanted:
        load(path)
    for _ in range(2):
        with pytest.raises(SpecError) as found:
            module_of(path)
        assert str(found.value) == str(wanted.value)


SPRINGS = """
[model]
name = "mine"
[parameters]
m = { value = 1.0, unit = "kg" }
k_1 = { value = 100.0, unit = "N/m" }
k_2 = { value = 200.0, unit = "N/m" }
d = { value = 1.0, unit = "N*s/m" }
F_c = { value = 10.0, unit = "N" }
X = { value = 0.02, unit = "m" }
X_2 = { value = 0.01, unit = "m" }
c = { value = 10.0, unit = "J/K" }
T_0 = { value = 300.0, unit = "K" }
[domain]
assume = ["d >= 0"]
[inputs]
F = { unit = "N" }
[elements.mass]
kind = "mass"
at = "tip"
mass = "m"
[elements.source]
kind = "force_source"
at = "tip"
input = "F"
[elements.damper]
kind = "damper"
between = ["tip", "wall"]
force = "d*v"
heats = "body"
[elements.body]
kind = "thermal_mass"
temperature = "T_0*exp(S/c)"
state = "S"
"""
JOINED = """
[initial]
q_1 = "X"
q_2 = "X_2"
[elements.one]
kind = "spring"
between = ["tip", "middle"]
stiffness = "k_1"
state = "q_1"
[elements.two]
kind = "spring"
between = ["middle", "wall"]
stiffness = "k_2"
state = "q_2"
"""
STOPPED = """
[initial]
z = "X"
[elements.stop]
kind = "stop"
between = ["tip", "wall"]
stiffness = "k_1"
limit = "F_c"
state = "z"
heats = "body"
"""


@pytest.mark.parametrize(
    ("elements", "old", "new"),
    [
        (JOINED, "value = 0.02", "value = 0.03"),
        (STOPPED, "value = 0.02", "value = 0.2"),
    ],
)
def test_values_are_checked_that_no_condition_of_the_domain_holds(elements, old, new):
    """Starts of joined stores and of stops."""
    path = Path("mine.toml")
    path.write_text(SPRINGS + elements, encoding="utf-8")
    module_of(path)
    edited(path, 'value = 1.0, unit = "kg"', 'value = 1.5, unit = "kg"')
    assert module_of(path).Parameters().m == 1.5
    edited(path, old, new)
    with pytest.raises(PiezoError) as wanted:
        derive(load(path))
    with pytest.raises(PiezoError) as found:
        module_of(path)
    assert str(found.value) == str(wanted.value)


def test_runs_of_edited_specs_are_those_of_parameters(spec):
    spec["model"]["name"] = "mine"
    path = written(spec)
    wanted = simulate(path, duration=1e-2, inputs={"V_in": 100.0}, parameters={"d": 500.0})
    edited(path, "400.0", "500.0")
    found = simulate(path, duration=1e-2, inputs={"V_in": 100.0})
    assert np.array_equal(found.q, wanted.q)
