"""Each C compiler of this machine: the whole driver has no warning, and its runs are right.

With the address and undefined-behaviour sanitizers built in, runs leave no array: those of NumPy
are of the size that is asked for, and each of them is watched; gaps between parts are nan.
"""

import ctypes
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import load, sine
from piezo_sym.bench.problem import problem_of
from piezo_sym.module_cache import load_module
from piezo_sym.modules import module_of
from piezo_sym.run import simulate
from piezo_sym.run.engine.library import DRIVER, LAWS, STAGES, Sources
from tests.benchmarks.ours import run_in_c
from tests.codegen.c_compilers import COMPILERS, SANITIZING, runtime
from tests.codegen.test_c_text import STRICT, called

ROOT = Path(__file__).parents[2]
SPECS = ROOT / "tests" / "networks" / "specs"
#: The actuator; networks without inputs, banks, exchanges; with conduction; with two banks.
MODELS = [
    "piezo_stack",
    SPECS / "a2_oscillator.toml",
    SPECS / "a1_two_bodies.toml",
    SPECS / "hysteron_alone.toml",
    SPECS / "two_banks_heat_one_body.toml",
]
SANITIZERS = "-fsanitize=address,undefined -fno-sanitize-recover=all"


def name_of(path):
    return Path(path).stem


@pytest.fixture(params=MODELS, ids=name_of, scope="module")
def module(request, tmp_path_factory):
    """A module in a folder of its own, so that no other compiler's library is used."""
    made = Path(module_of(load(request.param)).__file__)
    folder = tmp_path_factory.mktemp("made") / made.stem
    shutil.copytree(made.parent, folder)
    return load_module(folder / made.name)


@pytest.mark.parametrize("compiler", COMPILERS)
def test_the_whole_driver_has_no_warning(module, compiler, tmp_path):
    texts = [Path(module.__file__).with_suffix(ending).read_text() for ending in (".h", ".c")]
    for name, text in Sources(module.NAME, *texts).files().items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    flags = [*STRICT, "-Wno-unused-function"]  # wide.h has functions for laws of other models
    assert called([*COMPILERS[compiler], *flags, "-c", DRIVER], tmp_path) == ""


@pytest.mark.parametrize("compiler", COMPILERS)
def test_stages_in_vectors_have_no_warning(module, compiler, tmp_path):
    texts = [
        Path(module.__file__).with_name(f"{module.NAME}{ending}").read_text()
        for ending in (".h", ".c", "_step.c")
    ]
    for name, text in Sources(module.NAME, *texts, stages=5).files().items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    without = ["-fno-openmp-simd", "-Wno-unknown-pragmas", "-Wno-psabi"]  # as it is compiled
    for plain in ([], ["-DPLAIN"]):
        flags = [*STRICT, *without, *plain, "-c", STAGES]
        assert called([*COMPILERS[compiler], *flags], tmp_path) == ""


@pytest.mark.some(1)
@pytest.mark.parametrize("compiler", COMPILERS)
def test_steps_and_laws_have_no_warning(module, compiler, tmp_path):
    texts = [
        Path(module.__file__).with_name(f"{module.NAME}{ending}").read_text()
        for ending in (".h", ".c", "_step.c")
    ]
    flags = ["-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", "-Wno-unknown-pragmas", "-Wno-psabi"]
    flags += ["-Wno-unused-function", "-Wno-unused-const-variable"]  # of models with more in them
    for layout, stages in (("one", 4), ("many", 6)):
        sources = Sources(module.NAME, *texts, stages=stages, layout=layout)
        for name, text in sources.files().items():
            (tmp_path / name).write_text(text, encoding="utf-8")
        for unit in (LAWS, DRIVER):
            assert called([*COMPILERS[compiler], *flags, "-c", unit], tmp_path) == ""


@pytest.mark.some(1)
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("accuracy", [{"rtol": 1e-6}, {"step": 1e-5}], ids=str)
def test_runs_are_the_same_whoever_compiles(module, compiler, accuracy, monkeypatch):
    monkeypatch.setenv("CC", shlex.join(COMPILERS[compiler]))
    options = {"duration": 5e-3, "times": 11}
    if module.NAME == "piezo_stack":
        options["inputs"] = {"V_in": sine(100, 100)}
    found = simulate(module, method="discrete_gradient", **accuracy, **options)
    wanted = simulate(module, method="Radau", rtol=1e-11, **options)
    for record in module.STATES:
        size = np.abs(wanted[record.name].values).max()
        assert np.abs(found[record.name] - wanted[record.name]).max() <= 1e-3 * size + 1e-12
    energy = np.abs(found.energy.values).max()
    power = sum(np.abs(found[n].values).max() for n in found if n.startswith("supplied_"))
    bound = 1e-12 * (np.ptp(found.energy.values) + power) + 30 * np.spacing(energy)
    assert np.abs(found.energy_residual).max() <= bound


#: If asked, a call with one row too few; runs of all kinds, with banks of several sizes.
WATCHED = """
import ctypes
import sys
from pathlib import Path

import numpy as np
import platformdirs

platformdirs.user_cache_dir = lambda name: sys.argv[2]
from piezo_sym.module_cache import load_module
from piezo_sym.run import simulate
from piezo_sym.run.engine import library, records
from piezo_sym.run.engine.engine import OFFERED, engine_of
from piezo_sym.run.stepper import Stepper

library.FLAGS = [["-O1", *flags[1:]] for flags in library.FLAGS]  # sanitized, -O3 takes minutes
records.GAP = 4
module = load_module(Path(sys.argv[1]))
inputs = {"V_in": lambda t: 100 * np.sin(628 * t)} if module.NAME == "piezo_stack" else {}
options = {"duration": 1e-3, "method": "discrete_gradient", "inputs": inputs}
u = np.array(module.INPUT_DEFAULTS)
if "short" in sys.argv:
    engine, p = engine_of(module), module.Parameters()
    x, structure = engine.initial_state(u, p), engine.structure(p)
    out = np.empty(x.size - 1)
    arrays = (ctypes.c_void_p(array.ctypes.data) for array in (x, u))
    function = getattr(engine.library, f"{module.NAME}_rhs")
    function(*arrays, ctypes.byref(structure.value), ctypes.c_void_p(out.ctypes.data))
for size in (1, 2, 17) if module.BANKS else (1,):
    parameters = {f"{bank}_count": size for bank in module.BANKS}
    for choice in (
        {"rtol": 1e-7},
        {"rtol": 1e-11, "duration": 1e-4},  # finer on the way than any level that is sampled
        {"step": 1e-5},
        {"rtol": 1e-4, "times": [0.0, 3e-4]},
    ):
        found = simulate(module, parameters=parameters, **options | choice)
        assert found.method == "discrete_gradient"
        assert np.all(np.isfinite(found.energy))
    stepper = Stepper(module, step=1e-5, parameters=parameters)
    for _ in range(20):
        assert np.all(np.isfinite(stepper.step(u)))
    engine, p = engine_of(module), module.Parameters(**parameters)
    x = engine.initial_state(u, p)
    for name in set(OFFERED) - {"initial_state", "temperatures", "energy", "entropy"}:
        assert np.all(np.isfinite(getattr(engine, name)(x, u, p)))
print("good")
"""


def python(compiler, *words):
    """Run Python with a compiler's sanitizers in what it builds; return what became of it."""
    environment = {
        **os.environ,
        "CC": f"{shlex.join(COMPILERS[compiler])} {SANITIZERS}",
        "LD_PRELOAD": str(runtime(compiler)),
        "ASAN_OPTIONS": "detect_leaks=0",
        "PYTHONMALLOC": "malloc",
        "PYTHONPATH": str(ROOT),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    command = [sys.executable, "-W", "error", "-c", WATCHED, *map(str, words)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.long
@pytest.mark.parametrize(
    ("module", "compiler"),
    [
        pytest.param(model, name, marks=[pytest.mark.long] if model in MODELS[1:] else [])
        for name in SANITIZING
        for model in (MODELS if name == SANITIZING[0] else MODELS[:1])
    ],
    indirect=["module"],
    ids=lambda value: value if isinstance(value, str) else name_of(value),
)
def test_no_run_leaves_its_arrays(module, compiler, tmp_path):
    done = python(compiler, module.__file__, tmp_path / "cache")
    assert (done.returncode, done.stdout) == (0, "good\n"), done.stderr


@pytest.mark.long
@pytest.mark.parametrize("compiler", SANITIZING)
def test_an_array_that_is_left_is_seen(compiler, tmp_path):
    """The test above can fail: with one row too few it does."""
    done = python(compiler, module_of("piezo_stack").__file__, tmp_path / "cache", "short")
    assert "heap-buffer-overflow" in done.stderr
    assert done.stdout == ""


IN_USE = """
unsigned in_use(void)
{
    unsigned low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(1));
    return low;
}

void clear(void)
{
    __asm__ volatile("vzeroupper");
}
"""
#: Of the states that a processor saves: upper halves of registers of 256 and of 512 bits.
UPPER = 1 << 2 | 1 << 6
CPU = Path("/proc/cpuinfo")


@pytest.mark.long  # it compiles as for a user
@pytest.mark.skipif(
    not CPU.exists() or " xgetbv1 " not in CPU.read_text(), reason="processors of x86-64 tell"
)
def test_a_run_leaves_no_upper_halves_of_registers_in_use(tmp_path, monkeypatch):
    """They make what other libraries do afterwards three times as slow."""
    monkeypatch.setenv("CC", "gcc")
    source, made = tmp_path / "in_use.c", tmp_path / "in_use.so"
    source.write_text(IN_USE)
    subprocess.run(["gcc", "-O1", "-shared", "-fPIC", source, "-o", made], check=True)
    processor = ctypes.CDLL(str(made))
    run = run_in_c(problem_of(load("piezo_stack"), {"V_in": sine(100, 100)}, 5e-3))
    for rtol in (1e-3, 1e-6):
        run(rtol)
        processor.clear()
        run(rtol)
        assert not processor.in_use() & UPPER
