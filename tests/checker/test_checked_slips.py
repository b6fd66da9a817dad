"""The second program on slips: it confirms what is true of them, and nothing that is forged."""

import pytest
from stated import SPECS, forged, refused, stated

(TEXT,) = (p.read_text(encoding="utf-8") for p in SPECS if p.stem == "slips")
WEN = "(beta*abs(v)*sign(f) + gam*v)*abs(f/f_0)**n"


def test_slips_are_confirmed():
    assert refused(TEXT, stated(TEXT)) == {}


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("old", "new", "row"),
    [
        ("beta >= abs(gam)", "beta >= gam", "passive"),
        ("n > 0", "n >= 0", "welldef"),
        ("n > 0", "n**2 > 0", "welldef"),
        ("abs(f/f_0)**n", "abs(f/f_0)**(n - 1)", "welldef"),
        ("abs(f/f_0)**n", "(abs(f)/gam)**n", "welldef"),
        ("abs(f/f_0)**n", "(abs(f/f_0)**n - abs(f/f_0)**(2*n))", "passive"),
        ("abs(f/f_0)**n", "abs(v/v_0)**n", "rate-independent"),
        (WEN, "v*f/f_0", "passive"),
        (WEN, "v*abs(v)*f/(f_0*V_0)", "rate-independent"),
        (WEN, "f/m", "rate-independent"),
    ],
)
def test_what_is_false_of_a_slip_is_not_confirmed(old, new, row):
    speed = 'v_0 = { value = 1.0, unit = "m/s" }\n[inputs]'
    text = TEXT.replace(old, new).replace("[inputs]", speed).replace('"n', '"v_0 > 0", "n')
    proofs = forged(text)
    claimed = {"id": "rate-independent", "element": "wen", "verdict": "PROVED", "required": False}
    proofs["obligations"].append(claimed)
    found = refused(text, proofs)
    assert "does not follow" in found[row, "wen"]


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("name", "law"),
    [("v_wen", "-v_mass"), ("i_stack", "-alpha_transducer*v_mass"), ("slip_dahl", "0")],
)
def test_a_published_system_with_another_slip_is_not_confirmed(name, law):
    proofs = stated(TEXT)
    proofs["system"]["names"][name]["law"] = law
    assert "is not that of the network" in refused(TEXT, proofs)["system", ""]
