"""Which method runs when none is named; what is said, and how often, where C cannot be compiled."""

import os
import shutil
import subprocess
import sys
import warnings
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import piezo_sym
from piezo_sym import sine
from piezo_sym.errors import EngineError
from piezo_sym.run import simulate
from piezo_sym.run.engine import EngineWarning, compiler
from piezo_sym.run.engine.library import CACHE
from tests.conftest import full_disk, write_script

ROOT = Path(__file__).parents[2]
SHORT = {"inputs": {"V_in": sine(100, 100)}, "duration": 1e-3, "times": 11}


@pytest.fixture
def module(own_stack):
    return own_stack


@pytest.fixture
def quick_path(quick_compiler):  # noqa: ARG001  # it sets it
    return os.environ["PATH"]


def warned(module):
    """Return the one line of three runs, and the last run."""
    with pytest.warns(EngineWarning) as caught:
        runs = [simulate(module, **SHORT) for _ in range(3)]
    (warning,) = caught
    message = str(warning.message)
    assert message.isprintable()
    start = "model 'piezo_stack' runs by LSODA in NumPy, not compiled by discrete_gradient: "
    assert message.startswith(start)
    assert {run.attrs["method"] for run in runs} == {"LSODA"}
    assert runs[-1].attrs["engine"] == f"none: {message.removeprefix(start)}"
    return message.removeprefix(start)


def test_the_discrete_gradient_is_the_default(module):
    run = simulate(module, **SHORT)
    named = simulate(module, **SHORT, method="discrete_gradient")
    assert run.attrs == named.attrs
    assert run.equals(named)
    assert run.attrs["method"] == "discrete_gradient"
    assert run.attrs["rtol"] == 1e-5
    assert run.attrs["engine"].startswith(("compiled by gcc ", "compiled by clang "))
    assert run.attrs["newton_iterations"] >= run.attrs["accepted_steps"] > 10
    assert run.attrs["halvings"] == 0


@pytest.mark.parametrize("name", sorted(filter(shutil.which, ("gcc", "clang"))))
def test_the_compiler_that_was_used_is_named(module, monkeypatch, name):
    monkeypatch.setenv("CC", name)
    version = subprocess.run([name, "-dumpversion"], capture_output=True, text=True, check=True)
    engine = simulate(module, **SHORT).attrs["engine"]
    assert engine.startswith(f"compiled by {name} {version.stdout.split('.')[0].strip()}")


def test_a_step_alone_runs_the_discrete_gradient(module):
    run = simulate(module, **SHORT, step=1e-5)
    assert (run.attrs["method"], run.attrs["step"]) == ("discrete_gradient", 1e-5)
    assert "rtol" not in run.attrs


def test_a_method_of_scipy_is_run_and_says_so(module):
    run = simulate(module, **SHORT, method="BDF")
    assert run.attrs["method"] == "BDF"
    assert run.attrs["engine"] == "none: method BDF was asked for"


def test_a_module_without_c_runs_by_lsoda_and_says_nothing(piezo, module):
    assert simulate(piezo, **SHORT).attrs["engine"] == "none: the module has no C source beside it"
    for ending in (".h", ".c"):
        Path(module.__file__).with_suffix(ending).unlink()
    run = simulate(module, **SHORT)
    assert (run.attrs["method"], run.attrs["engine"][:5]) == ("LSODA", "none:")


def test_a_module_whose_step_is_missing_runs_by_lsoda_and_says_so(module):
    path = Path(module.__file__)
    path.with_name(f"{path.stem}_step.c").unlink()
    with pytest.warns(EngineWarning, match=r"_step\.c': is missing; run `piezo-sym generate`"):
        run = simulate(module, **SHORT)
    assert run.attrs["method"] == "LSODA"
    with pytest.raises(EngineError, match=r"_step\.c': is missing"):
        simulate(module, **SHORT, step=1e-5)


def test_functions_changed_in_python_are_those_that_run(module, variant):
    """The C beside the module is not of them."""
    changed = variant(module, rhs=lambda x, u, p, /: 0 * module.rhs(x, u, p))
    run = simulate(changed, **SHORT, initial={"q": 1e-3})
    assert run.attrs["method"] == "LSODA"
    assert np.all(run.q == 1e-3)
    with pytest.raises(EngineError, match="is no module loaded from a file"):
        simulate(changed, **SHORT, step=1e-5)


@pytest.mark.parametrize("more", [{"method": "discrete_gradient"}, {"step": 1e-5}])
def test_what_was_asked_for_is_not_replaced(piezo, module, no_compiler, more):
    with pytest.raises(EngineError) as error:
        simulate(module, **SHORT, **more)
    assert str(error.value) == (
        "engine: no C compiler is found; install gcc or clang, set CC, or `pip install "
        "piezo_sym[zig]`; or leave out step, and take method='LSODA' for a run in NumPy"
    )
    with pytest.raises(EngineError, match="is missing; run `piezo-sym generate`"):
        simulate(piezo, **SHORT, **more)
    assert list(no_compiler.iterdir()) == []


@pytest.mark.usefixtures("no_compiler")
def test_no_compiler_is_one_line(module):
    assert warned(module) == (
        "engine: no C compiler is found; install gcc or clang, set CC, or "
        "`pip install piezo_sym[zig]`"
    )


GARBAGE = r"printf 'x\377\000\033[31m\r\n\n'; printf '\377\000\033[2J\n\n' >&2; exit 1"
BROKEN = [
    ("exit 1", "no C compiler is found"),
    (f'test "$1" = --version && echo 1 && exit; {GARBAGE}', "the compiler failed: \\ufffd\\x00"),
    ("echo cc 1", "the compiler failed: it makes no library"),
    (GARBAGE.replace("exit 1", "exit 0"), "the compiler failed: \\ufffd\\x00"),
    ("kill -9 $$", "no C compiler is found"),
]


@pytest.mark.some(2)
@pytest.mark.parametrize(("text", "words"), BROKEN)
def test_a_broken_compiler_is_one_line(module, no_compiler, monkeypatch, text, words):
    monkeypatch.setenv("CC", str(write_script(no_compiler / "mine", text)))
    assert words in warned(module)


@pytest.mark.some(2)
@pytest.mark.parametrize("chosen", ["/bin/false", "no-such-compiler", "'", "/"])
@pytest.mark.usefixtures("no_compiler")
def test_a_choice_that_is_no_compiler_is_one_line(module, monkeypatch, chosen):
    monkeypatch.setenv("CC", chosen)
    assert "no C compiler is found" in warned(module)


def test_a_compiler_that_hangs_is_waited_for_once(module, no_compiler, monkeypatch):
    monkeypatch.setattr(compiler, "MOST_SECONDS", 0.5)
    sleep, log = shutil.which("sleep", path=os.defpath), no_compiler / "log"
    says = f'test "$1" = --version && echo 1 && exit; echo >> {log}; exec {sleep} 60'
    write_script(no_compiler / "cc", says)
    assert "the compiler takes more than 0.5 s" in warned(module)
    assert log.read_text() == "\n"  # not with other flags, nor for every run


def test_a_compiler_that_does_not_say_what_it_is_is_passed_by(module, no_compiler, monkeypatch):
    monkeypatch.setattr(compiler, "VERSION_SECONDS", 0.5)
    sleep = shutil.which("sleep", path=os.defpath)
    write_script(no_compiler / "cc", f"exec {sleep} 60")
    assert "no C compiler is found" in warned(module)


UNWRITTEN = (
    "the cache cannot be written (Not a directory); what is compiled is kept for this process "
    f"alone; set {CACHE} to a folder that can be written"
)


def test_a_cache_that_cannot_be_written_is_one_line(module, tmp_path, cache):
    (tmp_path / "cache").write_text("a file where the folder should be")
    with pytest.warns(EngineWarning) as caught:
        runs = [simulate(module, **SHORT) for _ in range(3)]
    assert [str(warning.message) for warning in caught] == [f"'{cache / 'compiled'}': {UNWRITTEN}"]
    assert {run.attrs["method"] for run in runs} == {"discrete_gradient"}


def test_a_full_disk_is_one_line(module):
    with full_disk():
        assert "the cache cannot be written (File too large)" in warned(module)


def test_a_model_of_a_cache_that_cannot_be_written_runs(tmp_path, cache):
    (tmp_path / "cache").write_text("a file where the folder should be")
    model = piezo_sym.load(ROOT / "tests" / "networks" / "specs" / "a2_oscillator.toml")
    with pytest.warns(EngineWarning, match="the cache cannot be written") as said:
        runs = [piezo_sym.simulate(model, duration=1.0, times=2) for _ in range(2)]
    assert len(said) == 1
    assert {run.attrs["method"] for run in runs} == {"discrete_gradient"}
    assert cache.parent.is_file()


FAILS = 'test "$1" = --version && echo 1 && exit; echo "error: no\tgood" >&2; exit 1'


@pytest.mark.parametrize(
    ("name", "why"), [("missing", "it does not run"), ("bad", "the compiler failed: error: no")]
)
def test_a_choice_that_is_passed_by_is_one_line(module, tmp_path, monkeypatch, name, why):
    """It is not there, or it fails: another compiler is taken, and named."""
    write_script(tmp_path / "bad", FAILS)
    monkeypatch.setenv("CC", str(tmp_path / name))
    with pytest.warns(EngineWarning) as caught:
        runs = [simulate(module, **SHORT) for _ in range(2)]
    (message,) = (str(warning.message) for warning in caught)
    assert message.startswith(f"CC names '{tmp_path / name}', but {why}")
    assert message.endswith("cc is taken")
    assert message.isprintable()
    assert {run.attrs["method"] for run in runs} == {"discrete_gradient"}


@pytest.mark.some(1)
@pytest.mark.parametrize("chosen", ["", " ", "cc", "gcc -pipe"])
def test_a_choice_that_is_taken_says_nothing(module, monkeypatch, chosen):
    monkeypatch.setenv("CC", chosen)
    assert simulate(module, **SHORT).attrs["method"] == "discrete_gradient"


def test_what_was_mended_is_tried_again(module, quick_path, no_compiler, monkeypatch):
    warned(module)
    monkeypatch.setenv("PATH", quick_path)
    assert simulate(module, **SHORT).attrs["method"] == "discrete_gradient"
    assert list(no_compiler.iterdir()) == []


def test_nothing_is_compiled_twice_for_one_process(module, cache):
    simulate(module, **SHORT)
    shutil.rmtree(cache)
    assert simulate(module, **SHORT).attrs["method"] == "discrete_gradient"
    assert not cache.exists()


SCRIPT = """
from piezo_sym import simulate
for _ in range(3):
    simulate("piezo_stack", duration=1e-3, times=2)
"""


def test_a_program_is_told_once_and_what_is_kept_for_its_process_goes_with_it(tmp_path):
    (tmp_path / "file").write_text("")
    (tmp_path / "temporary").mkdir()
    environment = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "XDG_CACHE_HOME": str(tmp_path / "file"),
        "HOME": str(tmp_path / "file"),
        "TMPDIR": str(tmp_path / "temporary"),
    }
    code = f"{SCRIPT}\nimport os; print(os.listdir(os.environ['TMPDIR']))"
    words = [sys.executable, "-c", code]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    assert done.stderr.count("EngineWarning: ") == 1
    assert "compiled: the cache cannot be written" in done.stderr.replace("'", "")
    assert "piezo_sym-" in done.stdout
    assert list((tmp_path / "temporary").iterdir()) == []


def test_a_finer_tolerance_than_round_off_is_not_paid_for(module):
    run = simulate(module, inputs={"V_in": 50.0}, duration=1e-3, times=5, rtol=1e-13)
    assert run.attrs["rtol"] == 1e-12


def test_no_warning_is_left_over(module):
    assert isinstance(module, ModuleType)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(module, **SHORT)
