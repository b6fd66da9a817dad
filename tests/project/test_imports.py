"""What is loaded when: the package costs nothing, a run needs no SymPy, a module needs NumPy."""

import importlib
import json
import os
import re
import shutil
import subprocess
import sys
from inspect import signature
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MODULE = ROOT / "generated" / "piezo_stack" / "piezo_stack.py"
HEAVY = {"sympy", "pydantic", "pint", "z3", "matplotlib"}
LOADED = "import json, sys; print(json.dumps(sorted({n.split('.')[0] for n in sys.modules})))"


def run(code: str, folder: Path, path: str = "") -> str:
    """Return what a fresh interpreter prints, started in `folder`; warnings are errors."""
    environment = {**os.environ, "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": "1"}
    words = [sys.executable, "-W", "error", "-c", code]
    done = subprocess.run(
        words, cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def loaded(code: str, folder: Path, path: str = str(ROOT)) -> set[str]:
    """Return the top-level names of the modules that some code loads."""
    return set(json.loads(run(f"{code}\n{LOADED}", folder, path).splitlines()[-1]))


def test_importing_the_package_loads_no_library(tmp_path):
    found = loaded("import piezo_sym; dir(piezo_sym)", tmp_path)
    assert "piezo_sym" in found
    assert found.isdisjoint({*HEAVY, "xarray", "numpy", "scipy", "pandas", "typer", "rich"})


def test_errors_that_functions_name_are_had_from_the_package(tmp_path):
    """So are the measures of loops, a module, once their package is imported."""
    code = """
import piezo_sym, piezo_sym.analysis
names = "EngineError FileError NetworkError ProofError RunError SpecError UsageError"
assert all(issubclass(getattr(piezo_sym, n), piezo_sym.PiezoError) for n in names.split())
assert {*names.split()} < {*dir(piezo_sym)}
print(piezo_sym.analysis.loops.area([0, 1, 2, 2, 2, 1, 0, 0], [0, 0, 0, 1, 2, 2, 2, 1]))
"""
    assert abs(float(run(code, tmp_path, str(ROOT)))) == 4.0


def test_loading_a_spec_loads_no_sympy(tmp_path):
    found = loaded("import piezo_sym; piezo_sym.load('piezo_stack')", tmp_path)
    assert "pydantic" in found
    assert found.isdisjoint({"sympy", "z3", "xarray", "matplotlib"})


def test_shipped_specs_load_no_pint(tmp_path):
    """Units with everyday prefixes are known without it: N/um, mm, kV."""
    code = "from piezo_sym.build import shipped_models; shipped_models()"
    assert "pint" not in loaded(code, tmp_path)


def test_types_of_elements_are_built_where_a_spec_is_read_alone(tmp_path):
    """A process that is sent a model reads no spec: it needs none of pydantic's validators."""
    code = """
import pickle, subprocess, sys, piezo_sym
ask = "import pickle, sys; print(type(pickle.load(sys.stdin.buffer)).__pydantic_complete__)"
sent = pickle.dumps(piezo_sym.load("piezo_stack"))
print(subprocess.run([sys.executable, "-c", ask], input=sent, capture_output=True).stdout.decode())
"""
    assert run(code, tmp_path, str(ROOT)).strip() == "False"


def test_a_run_and_a_sweep_load_nothing_of_the_derivation(tmp_path):
    code = """
import piezo_sym
piezo_sym.simulate('piezo_stack', duration=1e-4)
piezo_sym.sweep('piezo_stack', over={'L': [1e-3]}, duration=1e-4)
"""
    found = loaded(code, tmp_path)
    assert "xarray" in found
    assert found.isdisjoint({*HEAVY, "zarr", "distributed", "rich"})


def test_the_command_loads_no_sympy_before_it_is_needed(tmp_path):
    found = loaded("from piezo_sym.cli import run; run(['--version'])", tmp_path)
    assert found.isdisjoint({"sympy", "z3", "xarray", "matplotlib"})


RATES = "m.rhs(m.initial_state(m.INPUT_DEFAULTS, m.Parameters()), (0, 1, 298.15), m.Parameters())"
BY_NAME = "import piezo_stack as m"
BY_FILE = """
from importlib.util import module_from_spec, spec_from_file_location
spec = spec_from_file_location("anything", "piezo_stack.py")
m = module_from_spec(spec)
spec.loader.exec_module(m)
"""


@pytest.mark.parametrize("way", [BY_NAME, BY_FILE], ids=["by name", "by file"])
def test_a_generated_module_works_alone(tmp_path, way):
    shutil.copy(MODULE, tmp_path)
    assert json.loads(run(f"{way}\nprint({RATES}.tolist())", tmp_path)) == [0, 0, 0, 1, 1, 0]


@pytest.mark.parametrize("way", [BY_NAME, BY_FILE], ids=["by name", "by file"])
def test_a_generated_module_loads_numpy_alone(tmp_path, way):
    shutil.copy(MODULE, tmp_path)
    with_it = loaded(way, tmp_path, path="")
    without = loaded("import dataclasses, typing, importlib.util, numpy", tmp_path, path="")
    assert with_it - without <= {"piezo_stack"}
    assert with_it.isdisjoint({*HEAVY, "piezo_sym", "scipy"})


ORDERS = """
import sys
steps = (
    "from piezo_sym import generate",
    "import piezo_sym.derivation, piezo_sym.build, piezo_sym.spec.load, piezo_sym.run",
    "from piezo_sym import derive, simulate, load, verify, step",
)
for n in range(3):  # of any two each is once before the other
    order = steps[n:] + steps[:n]
    for name in [name for name in sys.modules if name.startswith("piezo_sym")]:
        del sys.modules[name]
    for statement in order:
        exec(statement)
    import piezo_sym
    for name in set(piezo_sym.__all__) - {"__version__"}:
        assert callable(getattr(piezo_sym, name)), (name, order)
    assert all(map(callable, (generate, derive, simulate, load, verify, step)))
print("good")
"""


@pytest.mark.long
def test_public_names_are_functions_whatever_was_imported_before(tmp_path):
    assert run(ORDERS, tmp_path, str(ROOT)) == "good\n"


def test_an_unknown_public_name_is_an_attribute_error():
    import piezo_sym

    with pytest.raises(AttributeError, match="module 'piezo_sym' has no attribute 'derivee'"):
        piezo_sym.derivee  # noqa: B018


@pytest.mark.parametrize(
    ("name", "home"),
    [
        ("simulate", "piezo_sym.run.simulate"),
        ("Stepper", "piezo_sym.run.stepper"),
        ("operating_point", "piezo_sym.analysis.operating_point"),
        ("periodic_steady_state", "piezo_sym.analysis.steady"),
        ("periodic_steady_states", "piezo_sym.analysis.steady"),
        ("steady_branches", "piezo_sym.analysis.branches"),
    ],
)
def test_public_functions_take_what_their_homes_take(name, home):
    """All but the first argument, a model there and a module here: names, defaults, types.

    A bar is shown to those who ask for one there, not here.
    """
    public = getattr(importlib.import_module("piezo_sym"), name)
    own = getattr(sys.modules[home], name)
    (first, *taken), (_, *wanted) = (signature(f).parameters.values() for f in (public, own))
    assert first.name == "model"
    for n, parameter in enumerate(wanted):
        if parameter.name == "progress":
            wanted[n] = parameter.replace(annotation=taken[n].annotation)
    assert taken == wanted
    assert "\n    module :" not in public.__doc__
    for parameter in (first, *taken):
        assert re.search(rf"\b{parameter.name}\b", public.__doc__) or "as for" in public.__doc__
