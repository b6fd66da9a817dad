"""Tables in the second program: confirmed where they are proved, and by no one's word alone."""

import pytest
from stated import forged, mass, refused, stated

from piezo_sym.checker import InputError, read_spec

LAW = "table(v, -v_1, -F_1, 0, 0, v_1, F_1, 2*v_1, 2*F_1)"
OPEN_ORDER = "table(v, -v_1, -F_1, 0, 0, v_1, F_1, k*v_1/k + a*v_1/a_1, 2*F_1)"


@pytest.mark.parametrize("law", [LAW, f"({LAW})*T_0/T", "a_1*table(v, 0, 0, v_1, v_1)"])
def test_a_table_is_confirmed(law):
    text = mass(law)
    assert refused(text, stated(text)) == {}


def test_an_order_that_the_domain_leaves_open_is_not_confirmed():
    text = mass(OPEN_ORDER).replace("a   = { value = -1.0", "a   = { value = 1.0")
    found = refused(text, forged(text))
    assert found["welldef", "damper"] == "a comparison (<) of v_1, k, a, a_1 does not follow"
    assert {("continuous", "damper"), ("passive", "damper"), ("sigma", "")} <= found.keys()
    assert refused(mass(LAW), forged(mass(LAW))) == {}


def test_a_table_whose_order_is_not_stated_is_not_confirmed():
    proofs = forged(mass(LAW))
    proofs["obligations"] = [row for row in proofs["obligations"] if row["id"] != "welldef"]
    assert refused(mass(LAW), proofs)["welldef", "damper"] == "missing"


@pytest.mark.parametrize("law", ["-" + LAW, "table(v, 0, F_1, v_1, 2*F_1)"])
def test_a_table_that_gives_power_is_not_confirmed(law):
    found = refused(mass(law), forged(mass(law)))
    assert {("passive", "damper"), ("sigma", "")} == found.keys()


@pytest.mark.parametrize("count", [1, 2, 3, 4, 6, 131])
def test_other_numbers_of_arguments_are_no_law(count):
    with pytest.raises(InputError):
        read_spec(mass(f"table({', '.join(['v_1'] * count)})"))


@pytest.mark.parametrize("law", ["table(v, 0, 0, F_1, F_1)", "table(v, 0, 0, v_1, v_1)"])
def test_units_of_knots_are_looked_at(law):
    assert ("units", "") in refused(mass(law), forged(mass(law)))
