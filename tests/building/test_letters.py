"""Names of a spec that a generated module uses itself: the numbers are those of plain names."""

import re

import numpy as np
import pytest

from piezo_sym import Model

ONE = {
    "states": {"q": "x", "p": "u", "Q_C": "p", "phi": "h", "S": "F"},
    "symbols": {
        "M": "J",
        "k": "out",
        "q_l": "lanes",
        "d": "rhs",
        "C": "BANKS",
        "L": "tuple",
        "rho": "range",
        "i_0": "Record",
        "a": "Parameters",
        "T_0": "Condition",
        "c_0": "dataclass",
        "lam": "jacobian",
        "F_ext": "slice",
        "V_in": "len",
        "T_e": "isinstance",
    },
}
TWO = {
    "states": {"q": "out", "p": "lanes", "Q_C": "rhs", "phi": "BANKS", "S": "tuple"},
    "symbols": {
        "M": "x",
        "k": "u",
        "q_l": "p",
        "d": "h",
        "C": "F",
        "L": "J",
        "rho": "value",
        "i_0": "count",
        "a": "T_minus_T_0",
        "T_0": "v_mass",
        "c_0": "sum_i_hysteron",
        "lam": "V_capacitor",
        "F_ext": "heat",
        "V_in": "i_hysteron",
        "T_e": "NamedTuple",
    },
}
THREE = {
    "states": {"q": "NAME", "p": "range", "Q_C": "Record", "phi": "x", "S": "u"},
    "symbols": {"M": "object", "k": "self", "L": "shape", "i_0": "ndim", "T_e": "F_damper"},
}
KEPT = {"unit", "doc", "title", "source"}


def renamed(data, words):
    """Return spec data with symbols renamed, in keys and laws, not in units and prose."""
    if isinstance(data, str):
        return re.sub(r"[A-Za-z_]\w*", lambda match: words.get(match[0], match[0]), data)
    if isinstance(data, list):
        return [renamed(item, words) for item in data]
    if isinstance(data, dict):
        kept = {key: value for key, value in data.items() if key in KEPT}
        rest = {words.get(k, k): renamed(v, words) for k, v in data.items() if k not in KEPT}
        return kept | rest
    return data


def other_names(spec, states, symbols):
    """Return the model with other names for states and symbols."""
    made = renamed(spec, symbols)
    for element in made["elements"].values():
        element["state"] = states.get(element["state"]) if "state" in element else None
    made["elements"] = {
        name: {key: value for key, value in element.items() if value is not None}
        for name, element in made["elements"].items()
    }
    made["initial"] = {states[name]: law for name, law in made["initial"].items()}
    return Model(**made)


def states_and_inputs(columns):
    """Return states (6, columns) and inputs (3, columns) of the size that they have in a run."""
    draw = np.random.default_rng(1)
    size = np.array([1e-3, 5e-3, 5e-4, 2e-3, 2e-3, 0.05])
    x = size[:, None] * draw.uniform(-1, 1, (6, columns))
    x[5] = np.abs(x[5]) + 1e-3
    u = np.array([[1.0], [100.0], [300.0]]) + draw.uniform(0, 1, (3, columns))
    return x, u


def values(module, x, u):
    """Return what every function of a module gives."""
    p = module.Parameters()
    driven = ("rhs", "jacobian", "outputs", "supply", "heat", "entropy_production", "margins")
    return {
        **{name: getattr(module, name)(x, u, p) for name in driven},
        **{name: getattr(module, name)(x, p) for name in ("energy", "entropy", "temperatures")},
        "initial_state": module.initial_state(u[:, 0], p),
    }


@pytest.mark.some(1)
@pytest.mark.parametrize("names", [ONE, TWO, THREE], ids=["one", "two", "three"])
def test_other_names_give_the_same_numbers(spec, model, module_from, names):
    x, u = states_and_inputs(7)
    plain = values(module_from(model), x, u)
    other = values(module_from(other_names(spec, **names)), x, u)
    for name, expected in plain.items():
        np.testing.assert_allclose(other[name], expected, rtol=1e-13, err_msg=name)


@pytest.mark.long
@pytest.mark.parametrize("names", [ONE, TWO, THREE], ids=["one", "two", "three"])
def test_other_names_give_the_same_rates_of_a_large_batch(spec, model, module_from, names):
    x, u = states_and_inputs(20_001)
    expected = module_from(model).rhs(x, u, module_from(model).Parameters())
    other = module_from(other_names(spec, **names))
    np.testing.assert_allclose(other.rhs(x, u, other.Parameters()), expected, rtol=1e-13)


def test_other_names_are_the_names_of_the_module(spec, module_from):
    module = module_from(other_names(spec, **ONE))
    assert [record.name for record in module.STATES] == ["x", "u", "p", "h", "F"]
    assert [record.name for record in module.INPUTS] == ["slice", "len", "isinstance"]
    assert module.Parameters(tuple=(1e-3, 2e-3)).tuple == (1e-3, 2e-3)
