"""The engine: compiled once, whoever asks; without a compiler one line."""

import ctypes
import os
import re
import shutil
import subprocess
import sys
import threading
import warnings
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import load, simulate
from piezo_sym.errors import EngineError
from piezo_sym.module_cache import load_module
from piezo_sym.run.engine import Engine, EngineWarning, compiler
from piezo_sym.run.engine import library as libraries
from piezo_sym.run.engine.compiler import compilers, processor
from piezo_sym.run.engine.engine import Members, engine_of
from piezo_sym.spec.load import parse
from tests.conftest import full_disk, write_script

ROOT = Path(__file__).parents[2]
FILES = ROOT / "generated" / "piezo_stack"
STATE, INPUTS = np.array([0.0, 1e-3, 1e-5, 1e-3, -2e-3, 0.05]), np.array([1.0, 50.0, 300.0])


pytestmark = pytest.mark.usefixtures("cache")


@pytest.fixture
def module(own_stack):
    return own_stack


def rates(engine, module):
    return engine.rhs(STATE, INPUTS, module.Parameters())


def found(cache):
    """Return the libraries; beside each lies its digest."""
    files = [path for path in cache.rglob("*") if path.is_file()]
    libraries = [path for path in files if path.suffix != ".sha256"]
    assert len(files) == 2 * len(libraries)
    return libraries


def refused(module):
    """Return the one line that says why there is no engine."""
    with pytest.raises(EngineError) as caught:
        engine_of(module)
    message = str(caught.value)
    assert message.isprintable()
    return message


def test_a_module_is_compiled_and_computes_what_it_does(module, cache):
    engine = engine_of(module)
    assert isinstance(engine, Engine)
    assert np.array_equal(rates(engine, module), module.rhs(STATE, INPUTS, module.Parameters()))
    assert [path.stem for path in found(cache)] == ["piezo_stack"]


def test_what_is_compiled_is_used_again(module, tmp_path, cache):
    engine_of(module)
    (first,) = found(cache)
    before = first.stat().st_mtime_ns
    shutil.copytree(FILES, tmp_path / "other")
    assert engine_of(load_module(tmp_path / "other" / "piezo_stack.py")) is not None
    assert [path.stat().st_mtime_ns for path in found(cache)] == [before]


def test_a_source_that_changes_is_compiled_again(module):
    file = Path(module.__file__).with_suffix(".c")
    before = rates(engine_of(module), module)
    file.write_text(file.read_text().replace("out[0] = ", "out[0] = 2.0*"))
    assert rates(engine_of(module), module)[0] == 2 * before[0]


def test_runs_have_the_parameters_that_they_are_given(module):
    engine, state = engine_of(module), STATE[None, None]
    for masses in ([3.5e-3, 7e-3], [1e-3, 2e-3], [1e-3, 4e-3]) * 2:
        parameters = [module.Parameters(M=mass) for mass in masses]
        found = Members(engine, parameters)("rhs", np.repeat(state, 2, 0), INPUTS[None])
        for row, p in zip(found[..., 0].T, parameters, strict=True):
            assert np.array_equal(row, module.rhs(STATE, INPUTS, p))


def steps(law="d*v_mass", stages=1):
    """The sources of steps; `law` is the damper's force."""
    header, source, step = (
        (FILES / f"piezo_stack{e}").read_text() for e in (".h", ".c", "_step.c")
    )
    step = step.replace("F_damper = d*v_mass", f"F_damper = {law}")
    return libraries.Sources("piezo_stack", header, source, step, stages)


def drivers(cache):
    return {path: path.stat().st_mtime_ns for path in cache.rglob("*.o")}


def test_an_edit_of_a_law_leaves_the_compiled_driver(cache):
    made = [libraries.library(steps(law)) for law in ("d*v_mass", "2.0*d*v_mass")]
    assert len({path.parent for path in made}) == 2
    kept = drivers(cache)
    assert len(kept) == 1
    libraries.library(steps("3.0*d*v_mass"))
    assert drivers(cache) == kept
    libraries.library(steps(stages=2))
    assert len(drivers(cache)) == 2


@pytest.mark.parametrize("name", ["law", "driver"])
def test_a_model_may_be_called_as_parts_of_the_engine(name):
    text = load("oscillator").to_toml().replace('"oscillator"', f'"{name}"', 1)
    assert simulate(parse(text), duration=0.1).attrs["method"] == "discrete_gradient"


@pytest.mark.parametrize("damage", ["cut", "turned", "a folder", "no folder"])
def test_a_damaged_driver_is_compiled_again(cache, damage):
    libraries.library(steps())
    (path,) = drivers(cache)
    content = path.read_bytes()
    match damage:
        case "cut":
            path.write_bytes(content[:1000])
        case "turned":
            path.write_bytes(bytes(255 - b for b in content))
        case "a folder":
            path.unlink()
            path.mkdir()
        case "no folder":
            shutil.rmtree(path.parent)
            path.parent.write_text("a file")
    with warnings.catch_warnings(action="error"):
        assert ctypes.CDLL(str(libraries.library(steps("2.0*d*v_mass"))))


def test_a_compiler_that_does_not_preprocess_is_not_passed_by(no_compiler, cache):
    says = (
        f'case " $* " in *" -E "*) exit 1;; esac; exec {shutil.which("cc", path=os.defpath)} "$@"'
    )
    write_script(no_compiler / "cc", f"PATH={os.defpath}; export PATH; {says}")
    assert libraries.library(steps()).is_file()
    assert not drivers(cache)


@pytest.mark.parametrize("what", ["source", "flags", "version", "processor"])
def test_whatever_changes_the_code_changes_its_place(monkeypatch, what):
    texts = ["a", "b"]
    first, flags = next(compilers()), ("-O3",)
    place = libraries._key(texts, first, flags)
    assert libraries._key(texts, first, flags) == place
    match what:
        case "source":
            texts = ["a", "c"]
        case "flags":
            flags = ("-O2",)
        case "version":
            first = compiler.Compiler(first.command, first.version + " ")
        case "processor":
            monkeypatch.setattr(libraries, "processor", lambda: processor() + " avx1024")
    assert libraries._key(texts, first, flags) != place


def test_the_processor_is_known_by_its_instructions():
    assert len(processor().splitlines()) >= 3


@pytest.mark.usefixtures("no_compiler")
def test_no_compiler_is_one_line(module):
    message = refused(module)
    assert message == (
        "engine: no C compiler is found; install gcc or clang, set CC, or "
        "`pip install piezo_sym[zig]`"
    )


def test_a_compiler_that_fails_is_one_line(module, no_compiler):
    says = 'test "$1" = --version && echo cc 1 && exit 0; echo "x.c:1: error: no\nmore" >&2; exit 1'
    path = write_script(no_compiler / "cc", says)
    assert refused(module) == (f"{path}: the compiler failed: x.c:1: error: no")


def test_a_compiler_that_writes_nothing_is_one_line(module, no_compiler):
    write_script(no_compiler / "cc", "echo cc 1")
    assert "the compiler failed: it makes no library" in refused(module)


def test_a_compiler_that_writes_no_library_is_one_line(module, no_compiler):
    says = 'for word; do test "$before" = -o && echo text > "$word"; before="$word"; done; echo cc'
    write_script(no_compiler / "cc", says)
    assert "the compiled module cannot be loaded" in refused(module)


@pytest.mark.parametrize("chosen", ["no_such_compiler", "'open", "/dev/null"])
def test_a_compiler_that_is_not_there_is_passed_by(module, monkeypatch, chosen):
    monkeypatch.setenv("CC", chosen)
    with pytest.warns(EngineWarning, match="CC names '.*', but it does not run; .* is taken"):
        assert engine_of(module) is not None


def test_a_compiler_that_fails_is_passed_by(module, tmp_path, monkeypatch):
    monkeypatch.setenv("CC", str(write_script(tmp_path / "bad", "echo bad; test $1 = --version")))
    assert next(compilers()).version == "bad\n"
    with pytest.warns(EngineWarning, match="bad', but the compiler failed: exit status 1; .* is"):
        assert engine_of(module) is not None


def test_the_chosen_compiler_is_asked_first(tmp_path, monkeypatch):
    real = shutil.which("cc")
    path = write_script(tmp_path / "mine", f'exec {real} "$@"')
    monkeypatch.setenv("CC", f"{path} -pipe")
    assert next(compilers()).command == (str(path), "-pipe")


def test_flags_that_a_compiler_refuses_are_left_out(module, no_compiler, cache):
    real = shutil.which("cc", path=os.defpath)
    says = f'case "$*" in *native*|*fopenmp*) echo error >&2; exit 1;; esac; exec {real} "$@"'
    write_script(no_compiler / "cc", f"PATH={os.defpath}; export PATH; {says}")
    assert rates(engine_of(module), module).shape == STATE.shape
    assert len(found(cache)) == 1


def test_a_cache_that_cannot_be_written_is_one_line(module, tmp_path):
    (tmp_path / "cache").write_text("a file where the folder should be")
    with pytest.warns(EngineWarning, match=r"cannot be written \(Not a directory\); what"):
        assert rates(engine_of(module), module).shape == STATE.shape


def test_no_folder_at_all_is_one_line(module, tmp_path):
    (tmp_path / "cache").write_text("a file where the folder should be")
    with full_disk():
        assert "the cache cannot be written (Not a directory); set " in refused(module)


@pytest.mark.parametrize("content", [b"", b"no library", b"\x7fELF"])
def test_a_damaged_library_is_compiled_again(module, content):
    path = libraries.library(libraries.Sources("piezo_stack", *texts()))
    path.write_bytes(content)
    assert rates(engine_of(module), module).shape == STATE.shape
    ctypes.CDLL(str(path))


RUN = """
from piezo_sym import simulate
print(simulate("piezo_stack", duration=1e-4, times=2, inputs={"V_in": 1.0}).q.values.tolist())
"""


@pytest.mark.some(1)
@pytest.mark.parametrize("damage", ["cut", "flip"])
def test_a_damaged_library_does_not_end_python(damage, tmp_path):
    """Its digest is looked at before it is loaded: a page that is missing would end the process."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(tmp_path)}

    def run():
        words = [sys.executable, "-W", "error", "-c", RUN]
        return subprocess.run(words, env=environment, capture_output=True, text=True)

    first = run()
    for path in (path for path in tmp_path.rglob("*.so")):
        content = bytearray(path.read_bytes())
        half = len(content) // 2
        content[half:] = b"" if damage == "cut" else bytes(255 - b for b in content[half:])
        path.write_bytes(content)
    again = run()
    assert (again.returncode, again.stderr, again.stdout) == (0, "", first.stdout)


def test_what_a_killed_compilation_left_is_removed(module, cache):
    engine_of(module)
    (path,) = found(cache)
    old, new = (path.parent / f".build-{name}" for name in ("old", "new"))
    for folder in (old, new):
        folder.mkdir()
        (folder / "driver.c").write_text("half a file")
    os.utime(old, (0, 0))
    path.unlink()  # it is loaded: cut short where it lies, it would end this process with SIGBUS
    libraries.library(libraries.Sources("piezo_stack", *texts()))
    assert (old.exists(), new.exists()) == (False, True)


def test_a_compiler_that_hangs_ends_with_its_children(module, no_compiler, monkeypatch, tmp_path):
    child = tmp_path / "child"
    version = 'case "$*" in *--version*) echo cc 1; exit;; esac'
    write_script(no_compiler / "cc", f"{version}\n/bin/sleep 1000 & echo $! > {child}; wait")
    monkeypatch.setattr(compiler, "MOST_SECONDS", 1.0)
    assert "the compiler takes more than 1 s" in refused(module)
    words = ["/bin/ps", "-o", "stat=", "-p", child.read_text().strip()]
    state = subprocess.run(words, capture_output=True, text=True).stdout.strip()
    assert state[:1] in {"", "Z"}  # gone, or on its way


def texts():
    return [(FILES / f"piezo_stack{ending}").read_text() for ending in (".h", ".c")]


@pytest.mark.parametrize("ending", [".h", ".c"])
def test_a_source_that_is_missing_is_one_line(module, ending):
    path = Path(module.__file__).with_suffix(ending)
    path.unlink()
    line = f"'{path}': is missing; run `piezo-sym generate`"
    assert refused(module) == line


@pytest.mark.parametrize("ending", [".h", ".c"])
def test_a_source_of_another_spec_is_not_compiled(module, ending, cache):
    path = Path(module.__file__).with_suffix(ending)
    path.write_text(path.read_text().replace(module.SPEC_SHA256, "0" * 64))
    assert "is of another spec than the module" in refused(module)
    assert found(cache) == []


ASK = """
import sys
from piezo_sym.module_cache import load_module
from piezo_sym.run.engine.engine import engine_of
module = load_module(__import__("pathlib").Path(sys.argv[1]))
engine = engine_of(module)
print(engine.rhs([0, 1e-3, 1e-5, 1e-3, -2e-3, 0.05], [1, 50, 300], module.Parameters()).tolist())
"""


def test_processes_at_once_get_one_library(module, tmp_path):
    words = [sys.executable, "-W", "error", "-c", ASK, module.__file__]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(tmp_path / "many")}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    running = [subprocess.Popen(words, env=environment, **pipes) for _ in range(4)]
    answers = [process.communicate() for process in running]
    assert {said for _, said in answers} == {""}
    expected = module.rhs(STATE, INPUTS, module.Parameters()).tolist()
    assert {said for said, _ in answers} == {f"{expected}\n"}
    assert [path.stem for path in found(tmp_path / "many")] == ["piezo_stack"]


def test_threads_share_an_engine(module):
    engine, wrong = engine_of(module), []
    draw = np.random.default_rng(0)
    batches = [np.abs(draw.normal(size=(6, 500))) * 1e-2 for _ in range(8)]
    wanted = [module.rhs(x, INPUTS, module.Parameters()) for x in batches]

    def work(n):
        for _ in range(20):
            p = module.Parameters(hysteron_count=2)
            close = np.allclose(engine.rhs(batches[n], INPUTS, p), wanted[n], rtol=1e-12)
            wrong.extend([] if close else [n])

    threads = [threading.Thread(target=work, args=(n,)) for n in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_an_engine_loads_nothing_of_the_derivation():
    code = ASK + "print(sorted({'sympy', 'pydantic', 'pint', 'z3'} & {*sys.modules}))"
    words = [sys.executable, "-c", code, str(FILES / "piezo_stack.py")]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_no_model_is_called_what_makes_a_word_of_the_engine_its_own() -> None:
    """Model `stage` with MODEL(reach) would be the table stage_reach, and would not compile."""
    folder = Path(libraries.__file__).parent
    text = "\n".join(path.read_text() for path in sorted(folder.rglob("*.[ch]")))
    header = "\n".join(path.read_text() for path in sorted(FILES.glob("*.[ch]")))
    own = {*re.findall(r"MODEL\((\w+)\)", text), *re.findall(r"\bpiezo_stack_(\w+)", header)}
    words = re.findall(r"^static [^;(=]*?\b(?!MODEL\b)(\w+)(?=[\[(])", text, re.MULTILINE)
    assert {"stage_reach", "node_mean"} <= set(words)
    taken = {(word, end) for word in words for end in own if word.endswith(f"_{end}")}
    assert taken == set()
