"""The rates in Julia give NumPy's numbers: read by a few rules, and by Julia where there is one."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from piezo_sym.codegen.julia import HELPERS
from piezo_sym.modules import module_of

MODELS = ["piezo_stack", "dc_motor", "stack_bouc_wen", "stack_maxwell", "gas_piston", "bimorph"]
SAME = ("exp", "expm1", "log", "sqrt", "sin", "cos", "tanh", "abs", "sign", "ones", "sum")
CALLS = {name: getattr(np, name) for name in SAME}
CALLS |= {"min": np.minimum, "max": np.maximum, "ifelse": np.where, "clamp": np.clip}
#: What Julia writes otherwise than Python: indices, which begin at 1, powers, what is done by lane.
RULES = [
    (r"(\b\w+)\[([^\]:]+) : ([^\]]+)\]", r"\1[(\2) - 1 : \3]"),
    (r"(\b\w+)\[([^\]:]+)\]", r"\1[(\2) - 1]"),
    (r"\^", "**"),
    (r" \.= ", " = "),
    (r" \.\* ", " * "),
    (r"@\. ", ""),
]


def python(text):
    for pattern, instead in RULES:
        text = re.sub(pattern, instead, text)
    return text


def rates(text, x, u, p):
    """Return dx/dt by a text in Julia."""
    known = dict(CALLS)
    for line in HELPERS.splitlines():
        name, arguments, value = re.fullmatch(r"(\w+)\((.*)\) = (.*)", line).groups()
        known[name] = eval(f"lambda {arguments}: {python(value)}", known)
    found = re.search(r"^function \w+!\(([^)]*)\)\n(.*)^    return", text, re.M | re.S)
    head, body = found.groups()
    dx = np.full(x.shape, np.nan)
    known |= dict(zip(head.split(", "), (dx, x, u, p), strict=True))
    with np.errstate(all="ignore"):
        exec("\n".join(line.strip() for line in python(body).splitlines()), known)
    return dx


def point(module):
    """Return a state near the start, inputs and parameters."""
    p, u = module.Parameters(), np.array(module.INPUT_DEFAULTS, dtype=float)
    rest, rng = module.initial_state(u, p), np.random.default_rng(1)
    return rest + 1e-3 * rng.normal(size=rest.size), u + rng.normal(size=u.size), p


def text_of(module):
    return Path(module.__file__.replace(".py", "_rhs.jl")).read_text(encoding="utf-8")


@pytest.mark.parametrize("name", MODELS)
def test_rates_are_those_of_numpy(name):
    module = module_of(name)
    x, u, p = point(module)
    wanted = module.rhs(x, u, p)
    assert np.isfinite(wanted).all()
    np.testing.assert_allclose(rates(text_of(module), x, u, p), wanted, rtol=1e-12)


@pytest.mark.skipif(not shutil.which("julia"), reason="there is no Julia")
@pytest.mark.parametrize("name", MODELS)
def test_julia_gives_the_same(name):
    module = module_of(name)
    x, u, p = point(module)
    lines = f"x, u = {x.tolist()}, {u.tolist()}\n{name}_rhs!(d, x, u, {name}_parameters)"
    code = f"{text_of(module)}\nd = zeros({x.size})\n{lines}\nprint(join(d, ' '))"
    done = subprocess.run(["julia", "-e", code], capture_output=True, text=True, check=True)
    found = [float(number) for number in done.stdout.split()]
    np.testing.assert_allclose(found, module.rhs(x, u, p), rtol=1e-12)
