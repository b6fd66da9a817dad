"""NumPy, C and SymPy agree where branches of laws meet, and right above a reference temperature.

Errors are measured against the sum of the absolute terms of a row.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
import sympy as sp
from agreement import close, explicit, values_of
from edges import ABOVE, edges, heated, on_edges, rounded
from precise import DIGITS
from runs import jumps
from strategy import assume, derivable, explore
from test_c_networks import check_twins, twin, twins

from piezo_sym import derive, load
from piezo_sym.build import shipped_models
from piezo_sym.modules import module_of
from piezo_sym.spec.load import parse

SPECS = sorted(Path(__file__).with_name("specs").glob("*.toml"))
#: Without stops, which jump where they yield: see `test_stops`.
SHIPPED = [
    m.name for m in shipped_models() if not any(e.kind == "stop" for e in m.elements.values())
]
MODELS = [*SHIPPED, *SPECS]
#: So far inside their domain networks are tried.
CLEAR = 1e-9
FUNCTIONS = (sp.exp, sp.log, sp.sin, sp.cos, sp.sinh, sp.cosh, sp.tanh)
SIZES = {"q": 1e-3, "p": 5e-3, "Q_C": 1e-4}


class Compared:
    """A model's module, the same compiled, and the mathematics of its banks written out."""

    def __init__(self, model, module=None):
        iphs = derive(model)
        self.model, self.exact = model, iphs.expand()
        with TemporaryDirectory() as folder:
            both = twins(iphs, folder) if module is None else twin(module)
        self.module, self.compiled = both
        self.rows = explicit(self.exact.rhs, {})
        self.names = [symbol.name for symbol in self.exact.x]

    def fixed(self, u):
        """Return numbers for parameters and inputs, by symbol."""
        symbols = {s.name: s for row in self.rows for s in row.free_symbols}
        numbers = {**values_of(self.module), **dict(zip(self.model.inputs, u, strict=True))}
        return {symbols[n]: sp.Float(v, DIGITS) for n, v in numbers.items() if n in symbols}

    def base(self, seed):
        """Return a state and inputs that are nothing special."""
        rng = np.random.default_rng(seed)
        x = [rng.uniform(0.2, 0.9) * SIZES.get(name, 1e-2) for name in self.names]
        heat = [entry.unit == "K" for entry in self.model.inputs.values()]
        return x, np.array([rng.uniform(*((297, 400) if h else (5, 50))) for h in heat])

    def check(self, x, u):
        """Check rates to the terms of their rows, and that all functions of both twins agree."""
        values = {**values_of(self.module), **dict(zip(self.model.inputs, u, strict=True))}
        values |= dict(zip(self.names, x, strict=True))
        wanted = [rounded(row, values) for row in self.rows]
        p = self.module.Parameters()
        for module in (self.module, self.compiled):
            close(module.rhs(x, u, p), wanted, 1e-300, "rhs")
        check_twins(self.module, self.compiled, x, u)


@pytest.fixture(scope="module", params=MODELS, ids=lambda path: Path(path).stem)
def compared(request):
    model = load(request.param)
    return Compared(model, module_of(model))


@pytest.mark.some(2)
@pytest.mark.parametrize("above", ABOVE)
def test_right_above_the_reference_temperature(compared, above):
    for seed in range(3):
        x, u = compared.base(seed)
        compared.check(heated(compared.exact, compared.fixed(u), x, above), u)


@pytest.mark.some(1)
@pytest.mark.parametrize("above", ABOVE)
def test_on_every_edge(compared, above):
    x, u = compared.base(7)
    fixed = compared.fixed(u)
    states = list(on_edges(compared.exact, fixed, heated(compared.exact, fixed, x, above)))
    assert len(states) == 3 * len(edges(compared.exact))
    for state in states:
        compared.check(state, u)


def test_the_actuator_has_an_edge_on_each_side_of_each_lane():
    both = Compared(load("piezo_stack"), module_of("piezo_stack"))
    x, u = both.base(0)
    found = [state[3:5] / 1e-3 for state in on_edges(both.exact, both.fixed(u), x)]
    for lane in (0, 1):
        for side in (-0.5, 0.5):
            assert sum(i[lane] == pytest.approx(side, rel=1e-15) for i in found) == 3


#: A law that jumps at v = 0, one with a kink there, and one whose branches meet at v = 1.
RUBBING = """
[model]
name = "rubbing"
[parameters]
m   = { value = 2.0,   unit = "kg" }
F_c = { value = 3.0,   unit = "N" }
d   = { value = 0.5,   unit = "N*s/m" }
w   = { value = 1.0,   unit = "m/s" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0,   unit = "J/K" }
[inputs]
F = { unit = "N" }
[domain]
assume = ["F_c >= 0", "d >= 0", "w > 0"]
[elements]
push  = { kind = "force_source", at = "a", input = "F" }
block = { kind = "mass", at = "a", mass = "m", state = "p" }
dry   = { kind = "damper", force = "F_c*sign(v)", discontinuous = true, ENDS }
air   = { kind = "damper", force = "d*v*abs(v)/w", ENDS }
soft  = { kind = "damper", force = "d*v if v < w else d*w", ENDS }
body  = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
""".replace("ENDS", 'between = ["a", "wall"], heats = "body"')


@pytest.fixture(scope="module")
def rubbing():
    return Compared(parse(RUBBING))


@pytest.mark.some(4)
@pytest.mark.parametrize("p", [-2.0, -1e-300, -0.0, 0.0, 1e-300, 1.9999999999999998, 2.0, 2.1])
def test_where_laws_jump_and_bend(rubbing, p):
    x = np.array([p, 2.0 * np.log1p(1e-3 / 300.0)])
    rubbing.check(x, np.array([7.0]))
    friction = 3.0 * np.sign(p)
    found = rubbing.compiled.rhs(x, np.array([7.0]), rubbing.module.Parameters())[0]
    v = p / 2
    assert found == pytest.approx(7.0 - friction - 0.5 * v * abs(v) - 0.5 * min(v, 1.0), rel=1e-15)


def inside(both, seed):
    """Return inputs, and states on edges that are inside the domain."""
    _, u = both.base(seed)
    u = np.where(u > 200, 4.0, u / 10)
    x = np.random.default_rng(seed).uniform(0.2, 0.9, len(both.names))
    margins, p = both.module.margins, both.module.Parameters()
    # at S = 0 a body is at its T_0, where laws divide by T - T_0
    found = on_edges(both.exact, both.fixed(u), x)
    return u, [state for state in found if (margins(state, u, p) > CLEAR).all()]


def check(spec, seed):
    """Check a network on the edges of its laws; return at how many states."""
    kinds = {element["kind"] for element in spec["elements"].values()}
    assume(not jumps(spec) and "stop" not in kinds)  # a stop yields at once
    iphs = derivable(spec)
    found = edges(iphs.expand())
    # NumPy and C round functions differently, and so may take two sides of an edge with one
    assume(found and not any(edge.has(*FUNCTIONS) for edge in found))
    both = Compared(iphs.model)
    u, states = inside(both, seed)
    assume(states)
    for state in states:
        both.check(state, u)
    return len(states)


def test_edges_of_networks():
    assert sum(explore(1, check)) >= 3


AT_ITS_REFERENCE = """
[model]
name = "network"
[parameters]
r   = { value = 2.0, unit = "ohm*K" }
w   = { value = 0.3, unit = "A" }
d   = { value = 1.0, unit = "N*s/m" }
m   = { value = 1.0, unit = "kg" }
L   = { value = 1.0, unit = "H" }
T_0 = { value = 1.5, unit = "K" }
c   = { value = 1.2, unit = "J/K" }
[domain]
assume = ["T > T_0", "r > 0", "w > 0", "d > 0"]
[initial]
S = 0.1
[elements]
body   = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
mass   = { kind = "mass", at = "a", mass = "m" }
coil   = { kind = "inductor", between = ["b", "gnd"], inductance = "L" }
losses = { kind = "resistor", between = ["b", "gnd"], voltage = "r/(T - T_0)*deadzone(i, w)", heats = "body" }
damper = { kind = "damper", between = ["a", "wall"], force = "d*v*(1 if S > 0 else 2)", heats = "body" }
"""  # noqa: E501


def test_an_edge_at_a_reference_temperature_is_outside_of_the_domain():
    both = Compared(parse(AT_ITS_REFERENCE))
    u, states = inside(both, 5)
    assert len(edges(both.exact)) == 3
    assert len(states) == 6  # of the dead zone, not of S = 0
    for state in states:
        both.check(state, u)


@pytest.mark.long
def test_edges_of_many_networks():
    assert sum(explore(100, check)) >= 300
