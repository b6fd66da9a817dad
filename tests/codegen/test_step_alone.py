"""The step that a program in C calls is the one that Python takes, and closes both balances."""

import ctypes
import subprocess
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import Stepper, load
from piezo_sym.modules import module_of
from piezo_sym.run.engine.compiler import build, compilers
from piezo_sym.run.engine.records import ParameterRecords, at

SPECS = sorted((Path(__file__).parents[1] / "networks" / "specs").glob("*.toml"))


class Alone:
    """``<model>_step.c`` compiled by itself, and what a step in C is given."""

    def __init__(self, module, folder, *flags):
        source = Path(module.__file__)
        build(
            next(compilers()),
            ("-O2", "-shared", "-fPIC", *flags),
            [source.with_name(f"{module.NAME}_step.c")],
            folder / "step.so",
        )
        library = ctypes.CDLL(str(folder / "step.so"))
        self.structure = ParameterRecords(module)(module.Parameters())
        self.function = getattr(library, f"{module.NAME}_step")
        size = getattr(library, f"{module.NAME}_step_size")
        size.restype = ctypes.c_long
        self.space = np.zeros(size(ctypes.byref(self.structure.value)))
        self.booked = np.full(100, np.nan)

    def __call__(self, x, u, h):
        given = at(x), at(u), ctypes.c_double(h), ctypes.byref(self.structure.value)
        return self.function(*given, at(self.booked), at(self.space))


@pytest.mark.some(2)
@pytest.mark.parametrize("path", ["piezo_stack", *SPECS[::4]], ids=lambda path: Path(path).stem)
def test_it_takes_the_steps_of_a_stepper(path, tmp_path):
    model, h = load(path), 1e-6
    module = module_of(model)
    steps, step = Stepper(model, step=h), Alone(module, tmp_path)
    u, x = np.array([entry.si for entry in model.inputs.values()]), steps.x
    u = u if model.name != "piezo_stack" else np.array([1.0, 60.0, 298.15])
    booked = np.zeros(100)
    p, start = module.Parameters(), x.copy()
    for _ in range(200):
        steps.step(u)
        assert step(x, u, h)
        booked += step.booked
    size = np.abs(x).max()
    assert np.allclose(x, steps.x, rtol=1e-11, atol=1e-14 * size)
    ports = len(module.OUTPUTS)
    gained = float(module.energy(x, p) - module.energy(start, p))
    gross = float(np.abs(module.energy(x, p))) + np.abs(booked[:ports]).sum()
    assert abs(gained - booked[:ports].sum()) <= 1e-13 * gross


def test_numbers_may_be_floats(tmp_path):
    """For processors without doubles: a run of 5 ms as far off as floats are."""
    model, h = load("piezo_stack"), 2e-6
    module = module_of(model)
    steps, step = Stepper(model, step=h), Alone(module, tmp_path, "-DREAL=float")
    u, x = np.array([1.0, 60.0, 298.15]), steps.x
    for _ in range(2500):
        steps.step(u)
        assert step(x, u, h)
    size = np.array([1e-3, 1e-2, 1e-3, 1e-2, 1e-2, 1e-1])
    error = np.abs(x - steps.x) / np.maximum(np.abs(steps.x), size)
    assert 1e-9 < error.max() < 1e-3


def test_a_step_that_leaves_the_domain_leaves_the_state(tmp_path):
    module = module_of(load("piezo_stack"))
    step, p = Alone(module, tmp_path), module.Parameters()
    x = module.initial_state(np.array([0.0, 0.0, 296.15 + 1e-9]), p)
    before, u = x.copy(), np.array([0.0, 0.0, 200.0])
    assert not step(x, u, 10.0)
    assert np.array_equal(x, before)
    assert step(x, np.array([0.0, 1.0, 298.15]), 1e-6)
    assert not np.array_equal(x, before)


@pytest.mark.some(1)
@pytest.mark.parametrize("path", ["piezo_stack", *SPECS], ids=lambda path: Path(path).stem)
def test_the_example_of_the_header_is_a_program(path, tmp_path):
    """It compiles as it stands, and ends where a Stepper of the same steps does."""
    module = module_of(load(path))
    source = Path(module.__file__)
    header = source.with_name(f"{module.NAME}_step.h").read_text()
    lines = header.split("Example: cc")[1].split("*/")[0].splitlines()[1:]
    example = tmp_path / "example.c"
    example.write_text("\n".join(line.removeprefix(" *").removeprefix("     ") for line in lines))
    files = [example, source.with_suffix(".c"), source.with_name(f"{module.NAME}_step.c")]
    flags = [
        "-std=c99",
        "-O3",
        "-fopenmp-simd",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-pedantic",
        f"-I{source.parent}",
    ]
    program = tmp_path / "example"
    words = [next(compilers()).command[0], *flags, *map(str, files), "-o", str(program), "-lm"]
    subprocess.run(words, check=True)
    said = subprocess.run([str(program)], capture_output=True, text=True, check=True).stdout
    steps = Stepper(path, step=1e-6)
    for _ in range(1000):
        steps.step(module.INPUT_DEFAULTS or [])
    energy = float(module.energy(steps.x, module.Parameters()))
    assert float(said.removeprefix("U = ").removesuffix(" J\n")) == pytest.approx(energy, rel=1e-12)
