"""Functions of many states at once give what NumPy does, and the functions of vectors are exact."""

import ctypes
import json
import re
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest

from piezo_sym import Model, load
from piezo_sym.codegen.c.style import KEPT
from piezo_sym.modules import module_of
from piezo_sym.run.engine.c_sources import c_source, numbers_source
from piezo_sym.run.engine.compiler import FLAGS, build, compilers
from piezo_sym.run.engine.engine import OFFERED, engine_of
from piezo_sym.run.parameters import read_parameters

SPECS = sorted((Path(__file__).parents[1] / "networks" / "specs").glob("*.toml"))
BATCHES = [(), (1,), (7,), (16,), (17,), (1000,), (0,), (3, 11), (1, 5, 50)]
MOST_ULPS = 2
#: Functions of many states that give rows.
FUNCTIONS = [n for n in OFFERED if n not in ("initial_state", "jacobian", "margins")]


def states(module, batch, seed=0):
    """Return states and inputs of usual size, bodies warmer than at the start, and parameters."""
    draw = np.random.default_rng(seed)
    p = read_parameters(module, None)
    beside = (-1, *(1,) * len(batch))
    u = np.array([300.0 if record.unit == "K" else 1.5 for record in module.INPUTS])
    sizes = np.array(list(state_sizes(module, p))).reshape(beside)
    x = sizes * draw.uniform(-1, 1, (sizes.size, *batch))
    x = np.where(sizes < 0, np.abs(x), x)
    return x, u.reshape(beside) * draw.uniform(0.9, 1.1, (u.size, *batch)), p


def state_sizes(module, p):
    """Yield the size of each row of a state; entropies, which are positive, have a negative one."""
    capacities = [getattr(p, r.name) for r in module.PARAMETERS if r.unit == "J/K"]
    for record in module.STATES:
        size = -0.5 * float(np.min(capacities)) if record.unit == "J/K" else 0.5
        yield from [size] * (getattr(p, f"{record.bank}_count") if record.bank else 1)


def arguments(name, x, u, p):
    return (x, p) if name in ("temperatures", "energy", "entropy") else (x, u, p)


def same(found, wanted):
    assert found.shape == wanted.shape
    size = np.abs(wanted).max(initial=0.0)
    assert np.isfinite(size)
    assert np.allclose(found, wanted, rtol=1e-11, atol=1e-12 * size)


@pytest.mark.some(6)
@pytest.mark.parametrize(
    "path",
    ["piezo_stack", *SPECS],
    ids=lambda path: Path(path).stem,
)
def test_many_states_give_what_numpy_does(path):
    compare(module_of(load(path)))


def compare(module):
    engine = engine_of(module)
    for seed, batch in enumerate(BATCHES):
        x, own, p = states(module, batch, seed)
        for u in (own, states(module, (), seed)[1]):
            lifted = u if u.ndim == x.ndim else u.reshape(-1, *(1,) * len(batch))
            for name in FUNCTIONS:
                found = getattr(engine, name)(*arguments(name, x, u, p))
                same(found, np.asarray(getattr(module, name)(*arguments(name, x, lifted, p))))


@pytest.mark.parametrize("lanes", [1, 3, 64])
def test_a_state_has_the_same_rates_wherever_it_stands(lanes):
    """In any place of a tile, of a strided array, of one that ends within a tile."""
    module = module_of("piezo_stack")
    engine = engine_of(module)
    p = module.Parameters(hysteron_count=lanes)
    draw = np.random.default_rng(lanes)
    x = draw.uniform(-1, 1, (4 + lanes, 3001)) * 5e-3
    x[-1] = draw.uniform(0.01, 0.1, 3001)
    u = np.array([10.0, 100.0, 300.0])
    whole = engine.rhs(x, u, p)
    for first, last, step in [(0, 130, 1), (5, 21, 1), (1, 3001, 2), (2990, 100, -3)]:
        part = slice(first, last, step)
        assert np.array_equal(engine.rhs(x[:, part], u, p), whole[:, part])


def test_rates_go_where_they_are_wanted():
    module = module_of("piezo_stack")
    engine = engine_of(module)
    for batch in [(), (40,), (4, 10)]:
        x, u, p = states(module, batch)
        out = np.full(x.shape, np.nan)
        assert engine.rhs(x, u, p, out=out) is out
        same(out, module.rhs(x, u, p))
    for wrong in (np.empty((3, 4, 10)), np.empty((10, 4, 6)).T, np.empty(x.shape, "f4")):
        with pytest.raises(ValueError, match="out has to be a C-contiguous array"):
            engine.rhs(x, u, p, out=wrong)


def test_what_is_no_number_stays_in_its_state():
    module = module_of("piezo_stack")
    x, u, p = states(module, (100,))
    x[2, 37] = np.nan
    found = engine_of(module).rhs(x, u, p)
    assert np.array_equal(np.isnan(found), np.isnan(module.rhs(x, u, p)))
    assert np.isnan(found).any(axis=0).nonzero()[0].tolist() == [37]


def test_functions_are_those_of_the_engine():
    loops = r"^(?:OF_INPUTS|OF_STATES|SCALAR)\((\w+)\)"
    assert {*re.findall(loops, c_source("columns.c"), re.M)} == {*OFFERED} - {"initial_state"}


EXACT = """
#include "real.h"
void each(const double *x, double *out, long count);
void each(const double *x, double *out, long count)
{
    for (long n = 0; n + REAL_WIDTH <= count; n += REAL_WIDTH) {
        real v;
        memcpy(&v, x + n, sizeof v);
        const real found[] = {exp_of(v), expm1_of(v), sin_of(v), cos_of(v), sqrt_of(v), log_of(v)};
        for (long k = 0; k < 6; ++k)
            memcpy(out + k * count + n, found + k, sizeof v);
    }
}
"""


@pytest.fixture(scope="module")
def in_vectors(tmp_path_factory):
    """Return a function for exp, expm1, sin, cos, sqrt and log of x as vectors compute them."""
    folder = tmp_path_factory.mktemp("built")
    (folder / "real.h").write_text(numbers_source("real.h"))
    (folder / "each.c").write_text(EXACT)
    build(next(compilers()), FLAGS[0], [folder / "each.c"], folder / "each.so")
    library = ctypes.CDLL(str(folder / "each.so"))

    def call(x):
        x = np.ascontiguousarray(x)
        out = np.full((6, x.size), np.nan)
        at = [ctypes.c_void_p(array.ctypes.data) for array in (x, out)]
        library.each(*at, ctypes.c_long(x.size))
        return out

    return call


def points():
    """Return arguments of every size: tiny, around steps of the reduction, and to the ends."""
    draw = np.random.default_rng(0)
    tiny = 10.0 ** draw.uniform(-320, 0, 1000)
    steps = np.log(2) * np.arange(-60, 60, 0.5)[:, None] + draw.uniform(-1e-9, 1e-9, (240, 8))
    ends = [*np.linspace(-708, 708.9, 800), -0.0, 0.0, 709.0, -708.0, -40.0, 5e-324]
    x = np.concatenate([tiny, -tiny, draw.uniform(-45, 45, 2000), steps.ravel(), ends])
    return np.resize(x, x.size - x.size % -8)


def ulps(found, exact):
    """Return errors in units of the last place."""
    with mp.workdps(40):
        errors = [abs(mp.mpf(float(a)) - b) for a, b in zip(found, exact, strict=True)]
        return max(
            e / mp.mpf(float(np.spacing(abs(float(b))))) for e, b in zip(errors, exact, strict=True)
        )


def test_exponentials_of_vectors_are_exact_to_two_units_of_the_last_place(in_vectors):
    x = points()
    found = in_vectors(x)[:2]
    with mp.workdps(40):
        exact = [[f(mp.mpf(float(value))) for value in x] for f in (mp.exp, mp.expm1)]
    for one, other in zip(found, exact, strict=True):
        assert ulps(one, other) <= MOST_ULPS


def test_exponentials_of_vectors_end_as_those_of_numbers_do(in_vectors):
    x = np.array([np.inf, -np.inf, np.nan, 800.0, -800.0, -50.0, 0.0, -0.0])
    with np.errstate(over="ignore"):
        assert np.array_equal(in_vectors(x)[0], np.exp(x), equal_nan=True)
        assert np.array_equal(in_vectors(x)[1], np.expm1(x), equal_nan=True)


def test_sines_and_roots_of_vectors_are_exact_to_two_units_of_the_last_place(in_vectors):
    draw = np.random.default_rng(1)
    near = np.arange(-60, 60)[:, None] * np.pi / 4 + draw.uniform(-1e-9, 1e-9, (120, 8))
    far = [draw.uniform(-size, size, 400) for size in (1.0, 7.0, 1e3, 1e6, 1e9, 1e300)]
    tiny = 10.0 ** draw.uniform(-320, 0, 400)
    x = np.concatenate([near.ravel(), *far, tiny, -tiny])
    found, roots = in_vectors(x)[2:4], in_vectors(x)[4]
    with mp.workdps(400):
        exact = [[f(mp.mpf(float(value))) for value in x] for f in (mp.sin, mp.cos)]
    for one, other in zip(found, exact, strict=True):
        assert ulps(one, other) <= MOST_ULPS
    assert np.array_equal(roots, np.copysign(np.sqrt(np.abs(x)), x))  # odd: see real.h
    ends = in_vectors(np.array([np.inf, -np.inf, np.nan, 0.0, -0.0, 1e308, -1e308, 5e-324]))
    with np.errstate(invalid="ignore"):
        ends_by_numpy = np.sin([np.inf, -np.inf, np.nan, 0.0, -0.0, 1e308, -1e308, 5e-324])
    assert np.allclose(ends[2], ends_by_numpy, rtol=1e-15, atol=0, equal_nan=True)


def test_logarithms_of_vectors_are_exact_to_two_units_of_the_last_place(in_vectors):
    draw = np.random.default_rng(2)
    near = (
        np.sqrt(0.5) * 2.0 ** np.arange(-40, 40)[:, None] * (1 + draw.uniform(-1e-9, 1e-9, (80, 8)))
    )
    wide = [10.0 ** draw.uniform(-size, size, 800) for size in (1e-9, 1e-3, 1.0, 300.0)]
    ends = [5e-324, 2.0**-1022, np.finfo(float).max, 1.0, np.inf, 0.0, -1.0, np.nan]
    x = np.concatenate([near.ravel(), *wide, ends])
    found = in_vectors(x)[5]
    with mp.workdps(40):
        exact = [mp.log(mp.mpf(float(value))) for value in x[:-4]]
    assert ulps(found[:-4], exact) <= MOST_ULPS
    assert np.array_equal(found[-4:], [np.inf, -np.inf, np.nan, np.nan], equal_nan=True)


def test_no_name_of_a_spec_is_one_of_the_vectors():
    """A parameter called `zero` is another name in C, so that it hides nothing."""
    text = re.sub(r"/\*.*?\*/", "", numbers_source("real.h"), flags=re.DOTALL)
    defined = re.findall(r"static (?:inline|const) \w+ (\w+)", text)
    defined += re.findall(r"#define (\w+)|enum \{ (\w+)|\b(\w+) __attribute__", text)
    words = {word for found in defined for word in ([found] if isinstance(found, str) else found)}
    words |= {f"{name}_of" for name in re.findall(r"^FUNCTION\((\w+)", text, re.MULTILINE)}
    assert {"zero", "wide", "real", "mask", "REAL_WIDTH", "sqrt_of", "exp_of", "any"} <= words
    assert words - {"", "function"} <= KEPT
    assert {"PLAIN", "MODEL", "OF", "LANE"} <= KEPT  # macros of the engine


def test_parameters_may_be_called_like_parts_of_the_vectors():
    data = load("piezo_stack").model_dump()
    text = json.dumps(data)
    for old, new in (("M", "zero"), ("k", "wide"), ("q_l", "real"), ("d", "any"), ("C", "mask")):
        text = re.sub(rf"(?<![\w]){old}(?![\w/])", new, text)
    model = Model(**{**json.loads(text), "model": {**data["model"], "name": "crowded"}})
    module = module_of(model)
    x, u, p = states(module, (50,))
    same(engine_of(module).rhs(x, u, p), module.rhs(x, u, p))
