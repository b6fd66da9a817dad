"""Names of a spec that C or its printer uses itself: compiled, the numbers are NumPy's."""

import numpy as np
import pytest
from test_letters import ONE, THREE, TWO, other_names, states_and_inputs, values

from piezo_sym.build import render
from piezo_sym.module_cache import load_module
from piezo_sym.run.engine.engine import engine_of

WORDS = {
    "states": {"q": "I", "p": "M_PI", "Q_C": "EOF", "phi": "INFINITY", "S": "NAN"},
    "symbols": {
        "M": "j",
        "k": "l",
        "q_l": "n",
        "d": "left",
        "C": "complex",
        "L": "linux",
        "rho": "fabs",
        "i_0": "copysign",
        "a": "expm1",
        "T_0": "errno",
        "c_0": "HUGE_VAL",
        "lam": "piezo_stack_rhs",
        "F_ext": "power_2",
        "V_in": "pow",
        "T_e": "piezo_stack_parameters",
    },
}
SETS = {"one": ONE, "two": TWO, "three": THREE, "words of C": WORDS}


class Compiled:
    """A module with its functions compiled, as `values` takes it."""

    def __init__(self, module, engine):
        self.Parameters, self.engine = module.Parameters, engine

    def __getattr__(self, name):
        return getattr(self.engine, name)


@pytest.mark.some(1)
@pytest.mark.parametrize("names", SETS.values(), ids=SETS)
def test_other_names_give_the_same_numbers(spec, names, tmp_path):
    for name, text in render(other_names(spec, **names)).items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    module = load_module(tmp_path / "piezo_stack" / "piezo_stack.py")
    x, u = states_and_inputs(5)
    wanted, found = values(module, x, u), values(Compiled(module, engine_of(module)), x, u)
    for name, expected in wanted.items():
        size = 1e-13 * np.abs(expected).max()
        np.testing.assert_allclose(found[name], expected, rtol=1e-13, atol=size, err_msg=name)
