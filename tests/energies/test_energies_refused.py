"""What is said of an energy that cannot be: one line, with what to write instead."""

import pytest

from piezo_sym import PiezoError, derive
from piezo_sym.spec.load import parse

from .devices import GAS, SPRING

STATES = 'q = { rate = "velocity", between = ["piston", "wall"] }\nS = { rate = "entropy" }'
FAULTS = {
    'q = { rate = "entropy" }\nS = { rate = "entropy" }': "'q' and 'S' are both entropies",
    STATES.replace(', between = ["piston", "wall"]', ""): "states.q: is on no branch",
    STATES.replace('"entropy"', '"heat"'): "'heat' does not fit; expected 'velocity', 'force'",
    STATES + '\nr = { rate = "flow", between = ["a", "tank"] }': "the energy does not depend on it",
}
LAWS = {
    'stiffness = "k*T/T_0"': 'body = { kind = "storage", energy = "',
    'force = "k*q", rest = "g"': "rest is given beside force",
    'force = "k*q", stiffness = "k"': "exactly one of stiffness, force, energy; both stiffness and",
    'force = "k*q if q**2 < g**2 else k_2*q"': "give the energy itself instead: energy = '...'",
}
#: SymPy looks for it as long as it may, in seconds.
UNKNOWN = pytest.param(
    'force = "k*q*exp(sin(q/g)**2)"',
    "give the energy itself instead: energy = '...'",
    marks=pytest.mark.long,
)


def refused(text):
    with pytest.raises(PiezoError) as caught:
        derive(parse(text))
    return str(caught.value)


@pytest.mark.parametrize(("states", "said"), FAULTS.items())
def test_states_that_do_not_fit(states, said):
    assert said in refused(GAS.replace(STATES, states))


@pytest.mark.parametrize(("law", "said"), [*LAWS.items(), UNKNOWN])
def test_laws_that_are_no_energy(law, said):
    assert said in refused(SPRING.format(name="spring", law=law))


@pytest.mark.long  # ten seconds, as SymPy is asked for many integrals
def test_a_sum_that_is_split_at_edges_without_end():
    law = 'force = "k*n*(1 + abs(q)/g)**(n/2) + k*q/g*(max(abs(q) - g, 0)/g)**(n + w)"'
    text = SPRING.format(name="spring", law=law)
    more = 'n = { value = 1.5, unit = "1" }\nw = { value = 1.0, unit = "1" }\n'
    text = text.replace("[domain]\nassume = [", f'{more}[domain]\nassume = ["n >= 1", "w > 0", ')
    assert "give the energy itself instead" in refused(text)
