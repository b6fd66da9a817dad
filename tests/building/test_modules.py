"""From a spec to its module: the checkout's, the working folder's, or the user's cache."""

import tempfile
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import (
    Model,
    Stepper,
    derive,
    generate,
    load,
    periodic_steady_state,
    simulate,
    steady_branches,
    sweep,
)
from piezo_sym.cli import run
from piezo_sym.codegen import PRINTERS
from piezo_sym.errors import ProofError, RunError, SpecError, UsageError
from piezo_sym.modules import ModuleWarning, module_of
from piezo_sym.run.engine.engine import engine_of

ROOT = Path(__file__).parents[2]
COMMITTED = ROOT / "generated" / "piezo_stack" / "piezo_stack.py"


pytestmark = pytest.mark.usefixtures("cache")


@pytest.fixture(autouse=True)
def _work(tmp_path, monkeypatch):
    """A working folder without modules."""
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")


@pytest.fixture
def mine(spec):
    """A spec file of the user's, with a heavier mass."""
    spec["model"]["name"] = "mine"
    spec["parameters"]["M"]["value"] = 4e-3
    path = Path("mine.toml")
    path.write_text(Model(**spec).to_toml(), encoding="utf-8")
    return path


def files(folder):
    return [path for path in folder.rglob("*") if path.is_file()]


@pytest.mark.parametrize("kind", ["name", "path", "model"])
def test_the_shipped_spec_has_the_module_of_the_checkout(kind, model, cache):
    path = ROOT / "piezo_sym" / "models" / "piezo_stack.toml"
    module = module_of({"name": "piezo_stack", "path": path, "model": model}[kind])
    assert Path(module.__file__) == COMMITTED
    assert files(cache) == []


def test_code_in_the_working_folder_is_never_executed(model):
    """Opening somebody's folder is safe: not even a module with the right hash is loaded."""
    path, *_ = generate(model)
    path.write_text(f"{path.read_text()}\nopen('executed', 'w')\n")
    with pytest.warns(ModuleWarning, match="is not what the spec generates and is not used"):
        module = module_of("piezo_stack")
    assert Path(module.__file__) == COMMITTED
    assert not Path("executed").exists()


@pytest.mark.some(1)
@pytest.mark.parametrize("ending", [".c", ".h", "_step.c", "_step.h"])
def test_an_edited_text_of_c_is_not_compiled(model, ending):
    path, *_ = generate(model)
    edited = path.with_name(f"piezo_stack{ending}")
    edited.write_text(f"{edited.read_text()}\n/* edited */\n")
    with pytest.warns(ModuleWarning, match=r"replace it by `piezo_sym.generate\(model\)`, or"):
        module_of(model)
    with pytest.warns(ModuleWarning, match="replace it by `piezo-sym generate piezo_stack`"):
        module = module_of("piezo_stack")
    assert Path(module.__file__) == COMMITTED


def test_a_current_module_in_the_working_folder_needs_no_word(model):
    generate(model)
    module_of("piezo_stack")
    assert len(files(Path("generated"))) == 7


def test_an_edit_runs_without_generate_and_says_what_is_out_of_date(mine, cache):
    generate(load(mine))
    mine.write_text(mine.read_text().replace("0.004", "0.005"))
    with pytest.warns(ModuleWarning) as caught:
        module = module_of(mine)
    assert module.Parameters().M == 0.005
    assert Path(module.__file__).is_relative_to(cache)
    assert [str(one.message) for one in caught] == [
        "'generated/mine' is not what the spec generates and is not used; "
        "replace it by `piezo-sym generate mine.toml`, or give the spec another name"
    ]


@pytest.mark.long
def test_the_command_that_is_named_mends_it(mine):
    generate(load(mine))
    mine.write_text(mine.read_text().replace("0.004", "0.005"))
    with pytest.warns(ModuleWarning):
        module_of(mine)
    assert run(["generate", "mine.toml"]) == 0
    assert module_of(mine).Parameters().M == 0.005


def test_an_edited_copy_of_the_shipped_spec_is_a_model_of_its_own(mine):
    mine.write_text(mine.read_text().replace('"mine"', '"piezo_stack"'))
    assert module_of(mine).Parameters().M == 4e-3


@pytest.fixture
def unproved(mine):
    """The actuator with a damping of any sign, which its proofs refute."""
    mine.write_text(mine.read_text().replace('"d >= 0", ', ""))
    return mine


def test_what_is_not_proved_does_not_run(unproved):
    with pytest.raises(ProofError, match="passive is REFUTED"):
        module_of(unproved)


def test_what_is_generated_all_the_same_runs_and_says_so(unproved):
    generate(load(unproved), allow_unproved=True)
    for _ in range(2):  # the second time from the cache
        with pytest.warns(ModuleWarning, match=r"model 'mine' is NOT PROVED \(passive REFUTED"):
            result = simulate(unproved, duration=1e-4, times=2)
    assert result.attrs["proofs"].startswith("NOT PROVED (passive REFUTED")


@pytest.mark.long
def test_what_consumes_entropy_is_run_by_scipy_alone(unproved):
    generate(load(unproved), allow_unproved=True)
    run = {"parameters": {"d": -1.0}, "inputs": {"V_in": 1.0}, "duration": 1e-4, "times": 2}
    with pytest.warns(ModuleWarning), pytest.raises(RunError) as stopped:
        simulate(unproved, **run)
    said = str(stopped.value)
    assert "each step leaves the domain or consumes entropy, and the model is NOT PROVED" in said
    assert "or take method LSODA, which goes on" in said
    with pytest.warns(ModuleWarning):
        assert simulate(unproved, **run, method="LSODA").heat_damper[-1] < 0


@pytest.mark.long
def test_the_command_says_that_a_run_is_not_proved(unproved, capsys):
    generate(load(unproved), allow_unproved=True)
    assert run(["simulate", "mine.toml", "--duration", "1e-4"]) == 0
    said = capsys.readouterr().err.splitlines()
    assert [line for line in said if "NOT PROVED" in line] == [
        line for line in said if line.startswith("piezo-sym: model 'mine' is NOT PROVED")
    ]
    assert len(said) == 1


def test_a_run_says_what_is_proved(model):
    run = simulate(model, duration=1e-4, times=2)
    assert run.attrs["proofs"].endswith("program PROVED")


def test_a_spec_written_otherwise_is_the_same_spec(model):
    """Comments, order of keys and entries that say nothing do not count."""
    path = Path("copy.toml")
    path.write_text(f"# a copy\n{model.to_toml()}", encoding="utf-8")
    assert Path(module_of(path).__file__) == COMMITTED


def test_a_spec_not_generated_yet_goes_to_the_cache(mine, cache):
    module = module_of(mine)
    assert module.Parameters().M == 4e-3
    names = sorted(f"mine{ending}" for ending in PRINTERS)
    texts = [path for path in sorted(files(cache)) if path.name != "record.json"]
    assert texts == [Path(module.__file__).with_name(name) for name in names]
    assert not Path("generated").exists()


def test_what_is_generated_into_the_cache_can_be_compiled(mine):
    module = module_of(mine)
    x, u = module.initial_state(module.INPUT_DEFAULTS, module.Parameters()), [1.0, 2.0, 300.0]
    wanted = module.rhs(x, u, module.Parameters())
    assert np.array_equal(engine_of(module).rhs(x, u, module.Parameters()), wanted)


def test_the_cache_is_used_again(mine, cache):
    first = module_of(mine)
    written = {path: path.stat().st_mtime_ns for path in files(cache)}
    assert module_of(mine).SPEC_SHA256 == first.SPEC_SHA256
    assert {path: path.stat().st_mtime_ns for path in files(cache)} == written


def test_a_changed_spec_is_not_answered_from_the_cache(mine):
    module_of(mine)
    mine.write_text(mine.read_text().replace("0.004", "0.005"))
    assert module_of(mine).Parameters().M == 0.005


def test_a_damaged_file_in_the_cache_is_made_again(mine, cache):
    module_of(mine)
    (path,) = (path for path in files(cache) if path.suffix == ".py")
    path.write_text("def (")
    assert module_of(mine).Parameters().M == 4e-3


def test_a_cache_that_cannot_be_written_does_not_matter(mine, tmp_path):
    (tmp_path / "cache").write_text("a file where the folder should be")
    module = module_of(mine)
    assert module.Parameters().M == 4e-3
    folder = Path(module.__file__).parent
    assert {".py", ".h", ".c"} <= {path.suffix for path in files(folder)}
    assert folder.is_relative_to(tempfile.gettempdir())


def test_a_model_edited_in_python_runs_as_edited(spec, cache):
    spec["parameters"]["M"]["value"] = 7e-3
    module = module_of(Model(**spec))
    assert module.Parameters().M == 7e-3
    assert Path(module.__file__).is_relative_to(cache)


def test_a_model_edited_in_python_is_simulated_as_edited(spec):
    spec["inputs"]["V_in"]["default"] = 50.0
    spec["elements"]["hysteron"]["count"] = 3
    result = simulate(Model(**spec), duration=1e-4)
    assert result.V_in.values[-1] == 50.0
    assert result.sizes["hysteron"] == 3


@pytest.mark.some(1)
@pytest.mark.parametrize("text", ["def (", "import no_such_library", "x = y", "x = 1"])
def test_a_broken_module_in_the_working_folder_does_not_matter(model, text):
    path, *_ = generate(model)
    path.write_text(text)
    with pytest.warns(ModuleWarning, match="is not used"):
        assert Path(module_of("piezo_stack").__file__) == COMMITTED


def test_a_spec_whose_name_is_no_name_is_refused_as_a_spec(mine):
    mine.write_text(mine.read_text().replace('"mine"', '"../mine"'))
    with pytest.raises(SpecError, match="is not a name"):
        module_of(mine)


@pytest.mark.parametrize("call", [simulate, Stepper, sweep, periodic_steady_state, steady_branches])
@pytest.mark.parametrize("nothing", [None, 3, ["piezo_stack"], derive(load("piezo_stack"))])
def test_what_is_no_model_is_refused_by_all_that_run_one(call, nothing):
    options = {
        simulate: {"duration": 1.0},
        Stepper: {"step": 1e-5},
        sweep: {"over": {"L": [1e-3]}, "duration": 1.0},
        periodic_steady_state: {"inputs": {}, "frequency": 1.0},
        steady_branches: {"inputs": lambda _: {}, "frequencies": (1.0, 2.0)},
    }
    with pytest.raises(UsageError, match=r"^model: .* is no model; expected the name of") as error:
        call(nothing, **options[call])
    assert str(error.value).isprintable()


def test_a_folder_that_is_no_path_is_refused():
    with pytest.raises(UsageError, match=r"^generate\.out: 3 is no path; expected a path"):
        generate(load("piezo_stack"), out=3)
