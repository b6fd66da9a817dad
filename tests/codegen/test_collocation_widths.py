"""The text of a collocation step holds for one number and for vectors: rates, slopes, ledger."""

import ctypes
import subprocess
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import load
from piezo_sym.modules import module_of
from piezo_sym.run.engine.c_sources import numbers_source
from piezo_sym.run.engine.compiler import compilers

SPECS = Path(__file__).parents[1] / "networks" / "specs"
#: Vectors of two numbers, which every processor has.
WIDTH = 2
HARNESS = """
#include "{name}_step.c"
void all_of(const real *x, const real *g, const real *b, const real *u, const {name}_reals *p,
            real *mean, real *out, real *rows, real *s, real *m, real *slopes);
void all_of(const real *x, const real *g, const real *b, const real *u, const {name}_reals *p,
            real *mean, real *out, real *rows, real *s, real *m, real *slopes)
{{
    {name}_integrands(x, p, mean);
    {name}_stage(x, g, b, u, p, out, rows, s, m);
    {name}_slopes(x, g, b, u, p, slopes);
}}
"""


def library(module, folder, width):
    """Compile the step of a module for numbers, or for vectors of them."""
    head = f"#define REAL_WIDTH {width}\n{numbers_source('real.h')}" if width > 1 else ""
    path = folder / f"width_{width}.c"
    path.write_text(head + HARNESS.format(name=module.NAME), encoding="utf-8")
    source = Path(module.__file__).parent
    command = [*next(iter(compilers())).command, "-std=gnu99", "-O1", "-shared", "-fPIC"]
    command += [f"-I{source}", str(path), "-o", str(path.with_suffix(".so")), "-lm"]
    subprocess.run(command, check=True, capture_output=True)
    return ctypes.CDLL(str(path.with_suffix(".so")))


def aligned(array):
    """Return a copy whose vectors lie where they may be read at once."""
    space = np.zeros(array.size + 8)
    first = -space.ctypes.data % 64 // 8
    found = space[first : first + array.size].reshape(array.shape)
    found[...] = array
    return found


class Reals:
    """The record of parameters of one run, or of several that differ."""

    def __init__(self, module, width, scale):
        p, self.kept, record = module.Parameters(), [], bytearray()
        for field in module.PARAMETERS:
            value = np.asarray(getattr(p, field.name), dtype=float)
            if field.bank:
                lanes = np.broadcast_to(value, getattr(p, f"{field.bank}_count"))
                self.kept.append(aligned(lanes[:, None] * scale))
                record += np.int64(self.kept[-1].ctypes.data).tobytes()
            else:
                record += bytes(-len(record) % (8 * width))
                record += np.asarray(value * scale).tobytes()
        for bank in module.BANKS:
            record += np.int64(getattr(p, f"{bank}_count")).tobytes()
        record += bytes(64 + -len(record) % 8)
        self.record = aligned(np.frombuffer(bytes(record), dtype=float))


@pytest.mark.some(1)
@pytest.mark.parametrize("spec", ["piezo_stack", SPECS / "output_resistance_of_a_bank.toml"])
def test_vectors_hold_what_numbers_hold(spec, tmp_path):
    module = module_of(load(str(spec)))
    rng, p = np.random.default_rng(5), module.Parameters()
    n = sum(getattr(p, f"{s.bank}_count") if s.bank else 1 for s in module.STATES)
    sizes = {"mean": 8, "out": n, "rows": 64, "s": 64, "m": 16, "slopes": 256}
    start = module.initial_state(np.asarray(module.INPUT_DEFAULTS), p)
    x = start[:, None] + rng.uniform(1e-3, 2e-3, (n, WIDTH))
    g, b = rng.uniform(5.0, 6.0, (8, WIDTH)), rng.integers(0, 2, (64, WIDTH)).astype(float)
    u = np.asarray(module.INPUT_DEFAULTS)[:, None] + rng.uniform(0, 1, (len(module.INPUTS), WIDTH))
    scale = rng.uniform(0.9, 1.1, WIDTH)

    def found(width, columns):
        reals = Reals(module, width, scale[columns])
        given = [aligned(part[:, columns]) for part in (x, g, b, u)]
        results = [aligned(np.zeros((size, width))) for size in sizes.values()]
        address = [ctypes.c_void_p(part.ctypes.data) for part in (*given, reals.record, *results)]
        library(module, tmp_path, width).all_of(*address)
        return np.concatenate(results)

    vectors = found(WIDTH, slice(None))
    numbers = np.hstack([found(1, slice(k, k + 1)) for k in range(WIDTH)])
    assert np.count_nonzero(numbers) > 10 * WIDTH
    assert np.allclose(vectors, numbers, rtol=1e-14, atol=0)
