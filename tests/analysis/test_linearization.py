"""Linear models: entries by hand, the generated Jacobian, differences of rates and outputs."""

import numpy as np
import pytest
from scipy.signal import StateSpace

from piezo_sym import linearize, load, operating_point, simulate
from piezo_sym.errors import PiezoError, RunError, UsageError
from piezo_sym.modules import module_of
from piezo_sym.spec.load import parse
from tests.networks.test_acceptance import SPECS
from tests.proofs.test_root_laws import TEXT

ALL = ["piezo_stack", *(str(path) for path in sorted(SPECS.glob("*.toml")))]


def test_the_actuator_by_hand() -> None:
    """Equation (13): dp/dt = alpha V_C - k q - d p/M + F, y = (p/M, sum of phi_j/L, T)."""
    linear = linearize("piezo_stack", inputs={"V_in": 100.0})
    at = {name: n for n, name in enumerate((*linear.states, *linear.inputs))}
    T = 298.15
    A, B, C, D = linear
    assert A[at["p"], at["q"]] == -5e5
    assert A[at["p"], at["p"]] == pytest.approx(-4e2 / 3.5e-3, rel=1e-14)
    assert A[at["p"], at["S"]] == pytest.approx(10 / 296.15 * (T / 5.0) * 100.0, rel=1e-12)
    assert A[at["phi_2"], at["Q_C"]] == pytest.approx(-1 / 5e-6, rel=1e-14)
    assert A[at["S"], at["S"]] == pytest.approx(-2.0 * T / T**2 * T / 5.0, rel=1e-12)
    by_hand = [[0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 1, 0], [0, 1, 0], [0, 0, 2.0 / T]]
    assert pytest.approx(np.array(by_hand), rel=1e-14) == B
    assert C[1].tolist() == [0, 0, 0, 1 / 1e-3, 1 / 1e-3, 0]
    assert not np.any(D)
    assert linear.units["phi_2"] == "Wb"
    assert linear.units["y_supply"] == "A"
    assert np.abs(linear.rates).max() < 1e-9
    assert StateSpace(*linear).inputs == 3


@pytest.mark.some(1)
@pytest.mark.parametrize("spec", ALL)
def test_every_network_against_its_module_and_differences(spec: str) -> None:
    """A is the generated Jacobian; B, C and D are what differences of a moved point show."""
    model = load(spec)
    module = module_of(model)
    p = module.Parameters()
    draw = np.random.default_rng(7)
    u = np.array(module.INPUT_DEFAULTS) + draw.uniform(0.3, 0.4, len(module.INPUTS))
    x = module.initial_state(u, p)
    x = x + draw.uniform(0.01, 0.02, x.size) * np.maximum(np.abs(x), 1e-3)
    linear = linearize(
        model, at=_named(module, p, x), inputs=dict(zip(_words(module.INPUTS), u, strict=True))
    )
    assert pytest.approx(module.jacobian(x, u, p), rel=1e-13, abs=1e-300) == linear.A
    step = 1e-4 * np.maximum(np.abs(u), 1e-3)
    moved = [u[:, None] + sign * np.diag(step) for sign in (1, -1)]
    held = np.repeat(x[:, None], u.size, axis=1)
    for matrix, function in ((linear.B, module.rhs), (linear.D, module.outputs)):
        ahead, behind = (function(held, v, p) for v in moved)
        size = np.abs(ahead).max(initial=1.0)
        assert matrix == pytest.approx((ahead - behind) / (2 * step), rel=1e-6, abs=1e-9 * size)
    step = 1e-5 * np.maximum(np.abs(x), 1e-5)
    held = np.repeat(u[:, None], x.size, axis=1)
    ahead, behind = (module.outputs(x[:, None] + sign * np.diag(step), held, p) for sign in (1, -1))
    size = np.abs(linear.C).max(initial=1.0)
    assert pytest.approx((ahead - behind) / (2 * step), rel=1e-5, abs=1e-5 * size) == linear.C


def test_lanes_that_differ_stand_row_by_row() -> None:
    given = {"hysteron_count": 3, "L": [1e-3, 2e-3, 4e-3]}
    linear = linearize("piezo_stack", parameters=given, at={"phi": [1e-3, 2e-2, 3e-2]})
    assert linear.states[3:6] == ("phi_1", "phi_2", "phi_3")
    assert linear.C[1, 3:6].tolist() == [1 / 1e-3, 1 / 2e-3, 1 / 4e-3]
    module = module_of(load("piezo_stack"))
    p = module.Parameters(hysteron_count=3, L=(1e-3, 2e-3, 4e-3))
    assert pytest.approx(module.jacobian(linear.x, linear.u, p), rel=1e-13) == linear.A


def test_an_operating_point_brings_its_inputs_and_parameters() -> None:
    rest = operating_point("piezo_stack", inputs={"V_in": 50.0}, parameters={"d": 200.0})
    linear = linearize("piezo_stack", at=rest)
    assert linear.u.tolist() == [0.0, 50.0, 298.15]
    assert linear.A[1, 1] == pytest.approx(-200.0 / 3.5e-3)
    assert np.sort(np.linalg.eigvals(linear.A).real) == pytest.approx(
        np.sort(rest.eigenvalues.real), rel=1e-9, abs=1e-6
    )
    assert linearize("piezo_stack", at=rest, inputs={"V_in": 60.0}).u[1] == 60.0


@pytest.mark.parametrize(
    ("law", "slope"),
    [
        ("d*v*sqrt(abs(v)/v_0)", 0.0),
        ("d*v*(1 + sqrt(abs(v)/v_0))", -0.4),
        ("d*v_0*sign(v)*sqrt(abs(v)/v_0)", None),
        ("d*v*(1 + (abs(v - v_0)/v_0)**(1/3))", None),
    ],
)
def test_a_root_has_a_slope_at_a_kink_or_says_that_it_has_none(
    law: str, slope: float | None
) -> None:
    model = parse(TEXT.format(law=law, unit="N*s/m"))
    at = {"p": 0.1 if "v - v_0" in law else 0.0, "q": 0.0}
    if slope is None:
        with pytest.raises(RunError, match="no derivative there"):
            linearize(model, at=at)
    else:
        linear = linearize(model, at=at)
        p = linear.states.index("p")
        assert linear.A[p, p] == slope


def test_a_slope_without_bound_is_seen_beside_large_forces() -> None:
    model = parse(TEXT.format(law="d*v*(1 + (abs(v - v_0)/v_0)**(1/3))", unit="N*s/m"))
    with pytest.raises(RunError, match="no derivative there"):
        linearize(model, at={"p": 0.1, "q": 1e6})


def test_what_has_no_linear_model_says_so() -> None:
    with pytest.raises(UsageError, match="is no state"):
        linearize("piezo_stack", at=3)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="V_im"):
        linearize("piezo_stack", inputs={"V_im": 3.0})
    with pytest.raises(RunError, match="no derivative there"):
        linearize("piezo_stack", at={"S": 0.0})


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"at": {"F_ext": 1.0}}, "linearize.at: unknown name 'F_ext'; give it in 'inputs'"),
        ({"at": {"phi": [1.0, 2.0, 3.0]}}, "linearize.at.phi: 3 values for 2 lanes"),
        ({"inputs": {"q": 1.0}}, "linearize.inputs: unknown name 'q'; give it in 'at'"),
        ({"parameters": {"q": 1.0}}, "linearize.parameters: unknown name 'q'; give it in 'at'"),
        ({"parameters": {"T_0": -1.0}}, "condition 'T_0 > 0' has margin -1 (T_0 = -1 K)"),
    ],
)
def test_messages_name_its_own_arguments(given, said) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(PiezoError) as error:
        linearize("piezo_stack", **given)
    assert said in str(error.value)
    assert "initial'" not in str(error.value)


def _words(records: tuple) -> list[str]:  # type: ignore[type-arg]
    return [record.name for record in records]


def _named(module, p, x: np.ndarray) -> dict[str, object]:  # type: ignore[no-untyped-def, type-arg]
    found, start = {}, 0
    for record in module.STATES:
        size = getattr(p, f"{record.bank}_count") if record.bank else 1
        found[record.name] = x[start : start + size] if record.bank else float(x[start])
        start += size
    return found


SHARED_NODE = """
[model]
name = "eddy"
[parameters]
m = { value = 80, unit = "g" }
k = { value = 3e7, unit = "N/m" }
ep = { value = 6e-3, unit = "m/Wb**2" }
L = { value = 8.0, unit = "mH" }
R = { value = 3.0, unit = "ohm" }
g = { value = 0.02, unit = "S" }
d = { value = 200.0, unit = "N*s/m" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 300.0, unit = "J/K" }
h = { value = 0.8, unit = "W/K" }
[inputs]
V = { unit = "V" }
T_e = { unit = "K", default = 300.0 }
[domain]
assume = ["d >= 0", "R >= 0", "g >= 0", "h >= 0", "T_e > 0", "L > 0"]
[elements]
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
copper = { kind = "resistor", between = ["in", "a"], voltage = "R*i", heats = "rod" }
iron = { kind = "resistor", between = ["a", "gnd"], current = "g*v*T_0/T", heats = "rod" }
core.kind = "storage"
core.energy = "k/2*(x - ep*phi**2)**2 + phi**2/(2*L)"
core.states.phi = { rate = "voltage", between = ["a", "gnd"] }
core.states.x = { rate = "velocity", between = ["tip", "wall"] }
head = { kind = "mass", at = "tip", mass = "m", state = "p" }
oil = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "rod" }
rod = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
loss = { kind = "ambient", body = "rod", conductance = "h", input = "T_e" }
"""


def test_a_derivative_that_is_round_off_is_not_without_bound() -> None:
    """At rest the two currents cancel in the slope of the flux over the temperature."""
    model = parse(SHARED_NODE)
    at = operating_point(model, inputs={"V": 6.0}).initial
    for T in np.random.default_rng(1).uniform(290.0, 420.0, 100).tolist():
        given = {name: value for name, value in at.items() if name != "S"} | {"T_rod": T}
        assert np.isfinite(linearize(model, at=given, inputs={"V": 6.0}).A).all()


def test_a_run_is_a_point_at_its_end() -> None:
    run = simulate("piezo_stack", inputs={"V_in": 50.0}, duration=0.002, parameters={"d": 300.0})
    linear = linearize("piezo_stack", at=run)
    assert linear.x[0] == run.q.values[-1]
    assert linear.u[1] == 50.0
    assert linear.A[1, 1] == pytest.approx(-300.0 / 3.5e-3)
    assert linearize("piezo_stack", at=run.isel(time=3)).x[0] == run.q.values[3]
    with pytest.raises(UsageError, match=r"linearize\.at: this Dataset has no 'p', 'Q_C'"):
        linearize("piezo_stack", at=run[["q", "S"]])
    with pytest.raises(UsageError, match=r"linearize\.at: this Dataset has no 'V_in', 'T_e'"):
        linearize("piezo_stack", at=run.drop_vars(["V_in", "T_e"]))
    given = {"V_in": 60.0, "T_e": 300.0}
    assert linearize("piezo_stack", at=run.drop_vars([*given]), inputs=given).u[1] == 60.0
    rest = operating_point("piezo_stack", inputs={"V_in": 50.0}, initial=run)
    assert rest.parameters["d"] == 300.0
