"""What holds of the derived system beyond the paper's own numbers."""

import numpy as np
import pytest
import sympy as sp

from piezo_sym import derive, load
from piezo_sym.algebra.notation import latex
from piezo_sym.errors import UsageError
from piezo_sym.spec.load import parse
from piezo_sym.spec.source import MODELS

TEXT = (MODELS / "piezo_stack.toml").read_text(encoding="utf-8")


def edited(old: str, new: str):
    assert old in TEXT
    return parse(TEXT.replace(old, new))


def test_a_large_bank_is_derived_like_a_small_one(iphs):
    large = derive(edited("count = 2", "count = 20000"))
    for name in ("U", "sigma"):
        assert getattr(large, name) == getattr(iphs, name)
    assert large.rhs.full == iphs.rhs.full
    assert large.J_ir.full == iphs.J_ir.full


def test_a_bank_of_one_equals_the_element_without_count(iphs):
    single = derive(edited("count = 2", ""))
    bank = iphs.expand({"hysteron": 1})
    names = {sp.Symbol("phi_1", real=True): sp.Symbol("phi", real=True)}
    for name in ("J0", "J_ir", "g", "rhs", "y", "y_s"):
        assert getattr(bank, name).xreplace(names) == getattr(single, name)


def test_the_structure_matrix_is_skew_and_the_rates_are_its_product(iphs):
    explicit = iphs.expand()
    assert explicit.J_ir + explicit.J_ir.T == sp.zeros(6, 6)
    product = explicit.J_ir * explicit.E + explicit.g * explicit.u
    assert (product - explicit.rhs).applyfunc(sp.expand) == sp.zeros(6, 1)


def test_supply_rate_equals_rate_of_energy_at_random_points(iphs):
    explicit = iphs.expand()
    symbols = sorted(explicit.rhs.free_symbols | explicit.U.free_symbols, key=lambda s: s.name)
    rate = (explicit.E.T * explicit.rhs)[0] - (explicit.y.T * explicit.u)[0]
    f = sp.lambdify(symbols, rate)
    rng = np.random.default_rng(1)
    for _ in range(20):
        values = rng.uniform(0.5, 1.5, len(symbols))
        assert abs(f(*values)) < 1e-9


def test_latex_keeps_sums_over_lanes(iphs):
    text = iphs.latex()
    assert r"\sum_{j=1}^{r}" in text
    assert r"\dot{\phi_{j}}" in text
    assert r"\begin{bmatrix}" in text
    assert iphs._repr_latex_().startswith("$")
    assert iphs.J0._repr_latex_().count(r"\cdots") > 0


def test_latex_tells_the_square_of_a_sum_from_the_sum_of_squares(iphs):
    lanes, current = iphs.system.E.lanes, iphs.system.bracket[0, 0]
    squared, squares = lanes.sum(current, "hysteron") ** 2, lanes.sum(current**2, "hysteron")
    total = r"\sum_{j=1}^{r} i_{\mathrm{hysteron},j}"
    assert latex(squared) == rf"\left({total}\right)^{{2}}"
    assert latex(squares) == total + "^{2}"
    assert sp.latex(squared).startswith(r"\left(")  # also where SymPy prints, as in notebooks


def test_text_of_a_matrix_shows_its_labels(iphs):
    lines = str(iphs.system.J0).splitlines()
    assert lines[0].split() == ["q", "p", "Q_C", "phi_j", "S"]
    assert lines[3].split() == ["Q_C", "0", "-alpha_transducer", "0", "1", "0"]


def test_entries_have_names_where_no_bank_has(iphs):
    plain, written = derive(load("oscillator")), iphs.expand({"hysteron": 3})
    assert plain.J0["q", "p"] == plain.J0[0, 1] == 1
    assert plain.rhs["q"] == plain.rhs[0]
    assert plain.processes[0].J["S", "p"] == 1
    assert written.J0["phi_3", "Q_C"] == -1
    assert written.g["p", "load"] == 1
    with pytest.raises(UsageError, match="'phi_4' is no row; did you mean 'phi_3'"):
        written.J0["phi_4", "Q_C"]


def test_expand_refuses_what_is_no_bank(iphs):
    with pytest.raises(Exception, match="'hysteran' is no bank of 'piezo_stack'"):
        iphs.expand({"hysteran": 2})
    with pytest.raises(Exception, match="0 is no size"):
        iphs.expand({"hysteron": 0})


@pytest.mark.parametrize(
    ("old", "new", "culprit"),
    [
        ('at = "tip"\nmass', 'at = "top"\nmass', "'top', which no other element uses"),
        (
            'between = ["cap", "gnd"]\ncap',
            'between = ["cap", "wall"]\ncap',
            "translation reference",
        ),
        (
            'between = ["cap", "gnd"]\ncap',
            'between = ["cap", "tip"]\ncap',
            "translation in elements",
        ),
        ('between = ["cap", "gnd"]\ncap', 'between = ["in", "gnd"]\ncap', "fix each other"),
        ('between = ["cap", "gnd"]\ncap', 'between = ["cap", "cap"]\ncap', "both ends"),
    ],
)
def test_impossible_networks_are_refused_by_name(old, new, culprit):
    with pytest.raises(Exception, match=culprit):
        derive(edited(old, new))


def test_a_product_that_two_lanes_would_have_to_share_is_refused(iphs):
    with pytest.raises(Exception, match=r"depends on both; .* iphs.expand"):
        iphs.J_ir @ iphs.J_ir


def test_entries_by_label_and_by_place(iphs):
    J0 = iphs.J0
    assert J0["phi", "Q_C"] == J0[3, 2] == -1
    assert J0.shape == (5, 5)
    assert iphs.rhs["q"] == iphs.rhs[0]
    with pytest.raises(Exception, match="'Q_c' is no column; did you mean 'Q_C'"):
        J0["phi", "Q_c"]
    with pytest.raises(Exception, match="9 is no row"):
        J0[9, 0]


def test_symbols_are_a_mapping_of_names(iphs):
    found = dict(iphs.symbols)
    assert {"q", "phi", "V_in", "lam"} <= found.keys() == set(iphs.symbols.keys())
    assert found["q"] in iphs.symbols.values()
    assert ("q" in iphs.symbols, "absent" in iphs.symbols) == (True, False)
