"""Energies with kinks, looked at branch by branch by the second program."""

import pytest

from tests.checker.stated import forged, refused, stated
from tests.energies.kinked import BAD_ENERGIES, TEXT

CONFIRMED = (
    "k*(q - s)/(1 + abs((q - s)/r))",
    "k*deadzone(q, r)/(1 + abs(deadzone(q, r))/r)",
    "F_0*sign(q)*abs(q/r)**(3/2)",
    "F_0*abs((q - s)/r)**n*sign(q - s)",
    "k*q*abs(q/r)**n",
    "k*saturate(q, r)",
)
#: The energy found, a part of it, and what is put in its place.
WRONG = (
    ("F_0*sign(q)*abs(q/r)**(3/2)", "0.4", "0.5"),
    ("F_0*abs(q/r)**n*sign(q)", "(n + 1)", "(n + 2)"),
    ("F_0*abs(q/r)**n*sign(q)", "abs(q/r)", "(q/r)"),
    ("k*(q - s)/(1 + abs(q - s)/r)", "abs(q - s)", "abs(q)"),
    ("k*deadzone(q, r)/(1 + abs(deadzone(q, r))/r)", "log(-q)", "log(r - q)"),
    ("k*deadzone(q, r)/(1 + abs(deadzone(q, r))/r)", "k*r*r*log(r)", "k*r*r*log(2*r)"),
    ("k*deadzone(q, r)/(1 + abs(deadzone(q, r))/r)", "if q < -r", "if q < r"),
)


@pytest.mark.some(2)
@pytest.mark.parametrize("law", CONFIRMED)
def test_energies_are_confirmed_on_each_branch(law):
    text = TEXT.replace("LAW", law)
    rows = refused(text, stated(text))
    assert not rows


def test_a_spec_with_an_energy_of_saturate_is_read():
    """It is a kink inside a kink."""
    text = TEXT.replace('force = "LAW"', 'energy = "k*(q - saturate(q, r)/2)*saturate(q, r)"')
    rows = refused(text, stated(text))
    assert ("welldef", "spring") not in rows


@pytest.mark.some(1)
@pytest.mark.parametrize(("law", "old", "new"), WRONG)
def test_an_energy_changed_on_one_side_is_not_confirmed(law, old, new):
    text = TEXT.replace("LAW", law)
    proofs = stated(text)
    energy = proofs["system"]["energy"]
    assert old in energy, energy
    proofs["system"]["energy"] = energy.replace(old, new, 1)
    assert ("energy", "") in refused(text, proofs)


@pytest.mark.parametrize("pinned", ["q >= s", "q >= p", "q*M >= s*M"])
def test_a_domain_that_holds_a_state_has_no_edges(pinned):
    """There each branch is a single value of the state, and none may go without a look."""
    domain = f'"n > 0", "{pinned}", "{pinned.replace(">", "<")}"]'
    text = TEXT.replace("LAW", "k*q").replace('"n > 0"]', domain).replace("0.2", "0.0")
    proofs = stated(text)
    assert ("energy", "") not in refused(text, proofs)
    at = "p" if "p" in pinned else "s"
    proofs["system"]["energy"] += f" + (k*(q - {at}) if q >= {at} else 2*k*(q - {at}))"
    assert ("energy", "") in refused(text, proofs)


@pytest.mark.some(2)
@pytest.mark.parametrize("energy", BAD_ENERGIES[::2])
def test_energies_that_jump_or_lack_a_value_are_not_confirmed(energy):
    text = TEXT.replace('force = "LAW"', f'energy = "{energy}"')
    rows = {name for name, _ in refused(text, forged(text))}
    assert rows & {"energy", "continuous", "welldef"}
