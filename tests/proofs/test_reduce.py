"""Laws with parameters come down to one variable, and mean the same as before."""

from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from piezo_sym.errors import SpecError
from piezo_sym.expressions.exact_eval import evaluate
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Cmp, Div, If, Mul, Neg, Sym, names
from piezo_sym.proofs.signs.cases import balanced, choice_outside, grouped, summands
from piezo_sym.proofs.signs.reduce import Reduction, reductions
from tests.proofs.sign_laws import law, steady

POSITIVE = frozenset({"i_0", "i_1", "R", "T", "T_0", "V_T", "n", "q_e", "k_B", "v_s", "F_c"})


def positive(part):
    """Return what is known of a tree: some names, and those in sums and products of them."""
    return bool(names(part)) and {*names(part)} <= POSITIVE and "-" not in spell(part)


def reduce(tree, letter):
    """Return the first way in which all in front is free of the letter, or None."""
    found = reductions(tree, letter, positive)
    return next((r for r in found if all(letter not in names(p) for p in r.prefactors)), None)


#: law: prefactors, f, scale
CASES = {
    "R*tanh(i/i_1)": ("R", "tanh(i)", "i_1"),
    "rho/(T - T_0)*deadzone(i, i_0)": ("rho; (T - T_0)**(-1); i_0", "deadzone(i, 1)", "i_0"),
    "R*i + R*i_1*sin(i/i_1)": ("R; i_1", "i + sin(i)", "i_1"),
    "R*i_1*(i/i_1 + sin(i/i_1))": ("R; i_1", "i + sin(i)", "i_1"),
    "R*(exp(i/(n*V_T)) - 1)": ("R", "exp(i) - 1", "n*V_T"),
    "R*(exp(q_e*i/(k_B*T)) - 1)": ("R", "exp(i) - 1", "q_e**(-1)*k_B*T"),
    "R*i*(1 + a*(T - T_0))": ("R; 1 + a*(T - T_0)", "i", "1"),
    "R*i + a*i": ("R + a", "i", "1"),
    "R*(i - i_0) if i > i_0 else (R*(i + i_0) if i < -i_0 else 0)": (
        "R; i_0",
        "i - 1 if i > 1 else (i + 1 if i < -1 else 0)",
        "i_0",
    ),
    "a*sqrt(abs(i)/i_1)*sign(i)": ("a; i_1**(-0.5)", "abs(i)**0.5*sign(i)", "1"),
    "R*i/sqrt(i_1**2 + i**2)": ("R", "i/(1 + i**2)**0.5", "i_1"),
    "F_c*(1 + 2*exp(-(i/v_s)**2))*tanh(10*i/v_s)": (
        "F_c",
        "(1 + 2*exp(-i**2))*tanh(10*i)",
        "v_s",
    ),
    "-a*exp(T_0/T)*saturate(2*i, i_0)": ("a; exp(T_0/T); i_0", "-saturate(2*i, 1)", "i_0"),
    "max(R*i, 0)": ("R", "max(i, 0)", "1"),
    "R*sign(-i/i_1)": ("R", "sign(-i)", "1"),
    "tanh((i - i_0)/i_0)": ("", "tanh(i - 1)", "i_0"),
}


@pytest.mark.parametrize("text", CASES)
def test_a_law_is_brought_down_to_one_variable(text):
    found = reduce(law(text), "i")
    prefactors, f, scale = CASES[text]
    assert [spell(part) for part in found.prefactors] == prefactors.split("; ") * bool(prefactors)
    assert (spell(found.f), found.name, spell(found.scale)) == (f, "i", scale)


@pytest.mark.parametrize(
    "text",
    [
        "tanh(i/i_0)*tanh(i/i_1)",
        "tanh(i/a)",  # the sign of a is not known
        "deadzone(i, a)",
        "sign(a*i)",
        "sqrt(a*abs(i))",
        "tanh(i) + R*i",
        "R*i - a",
    ],
)
def test_what_does_not_come_down_is_none(text):
    assert reduce(law(text), "i") is None


PARTS = st.sampled_from(
    """
    i; R*i; i/i_1; -i/i_0; i - i_1; 2*i_1; a*i; R; a; 3; 0*i; T - T_0; tanh(i/i_1); abs(a*i); i**2
    sqrt(abs(i)*i_1); deadzone(i, i_1); min(i, -i_1); sign(R*i); exp(-(i/i_1)**2); i/(1 + abs(i))
    saturate(i, a); (i if i > i_1 else -i_1); (R*i if a*i < 0 else a); i_1**2 + i**2; max(-i, 0)
    """.replace("\n", ";").split(";")
).filter(str.strip)
TEXTS = st.recursive(
    PARTS.map(str.strip),
    lambda part: st.builds(
        "(({}) {} ({}))".format, part, st.sampled_from(["+", "-", "*", "/"]), part
    ) | st.builds("{}({})".format, st.sampled_from(["", "-", "abs", "tanh"]), part),
    max_leaves=5,
)  # fmt: skip
VALUES = st.sampled_from([Fraction(n, 4) for n in (1, 2, 3, 5, 8, 11)])
SIGNED = st.sampled_from([Fraction(n, 4) for n in (-9, -4, -1, 2, 7)])


@steady
@given(TEXTS, st.fixed_dictionaries({n: VALUES for n in sorted(POSITIVE)}), SIGNED, SIGNED)
def test_the_reduced_law_has_the_same_value(text, positive, a, s):
    try:
        tree = law(text)
    except SpecError:  # a constant part without a value
        assume(False)
    found = reduce(tree, "i")
    if found is None:
        return
    assert isinstance(found, Reduction)
    assert set(names(found.f)) <= {"i"}
    assert all("i" not in names(part) for part in found.prefactors)
    values = positive | {"a": a}
    at = values | {"i": found.back(s, values)}
    whole = found.f
    for part in found.prefactors:
        whole = Mul(part, whole)
    try:
        before = evaluate(tree, {name: float(value) for name, value in at.items()})
    except (ArithmeticError, ValueError):
        return
    after = evaluate(whole, {name: float(v) for name, v in (values | {"i": s}).items()})
    assert after == pytest.approx(before, rel=1e-9, abs=1e-9)


def test_the_value_comes_back_in_the_letters_unit():
    found = reduce(law("R*(exp(i/(n*V_T)) - 2)"), "i")
    values = {"n": Fraction(2), "V_T": Fraction(1, 40)}
    assert found.back(Fraction(1, 2), values) == Fraction(1, 40)
    assert found.scale == Mul(Sym("n"), Sym("V_T"))


def test_a_factor_of_another_scale_stands_in_front():
    found = reductions(law("R*tanh(i/i_1)*(a + exp(-(i/i_0)**2))"), "i", positive)[0]
    assert [spell(part) for part in found.prefactors] == ["R", "a + exp(-(i/i_0)**2)"]
    assert (spell(found.f), spell(found.scale)) == ("tanh(i)", "i_1")


def test_a_negative_name_counts_as_minus_a_positive_one():
    found = reductions(law("b*tanh(i/b)"), "i", lambda part: part == Neg(Sym("b")))[0]
    assert [spell(part) for part in found.prefactors] == ["b"]
    assert (spell(found.f), spell(found.scale)) == ("tanh(-i)", "-b")


SUMS = {
    "R*(exp(i/i_1) - 1) - T*(exp(-i/i_0) - 1)": [
        "R*exp(i/i_1) + R*(-1)",
        "-T*exp((-i)/i_0) - T*(-1)",
    ],
    "R*i + R*i_1*sin(i/i_1) + a*tanh(i/i_0)": ["R*i + R*i_1*sin(i/i_1)", "a*tanh(i/i_0)"],
    "R*(tanh(i/i_1) + a*tanh(i/i_0))": ["R*tanh(i/i_1)", "R*(a*tanh(i/i_0))"],
    "R*tanh(i/i_1) + a": None,
}


@pytest.mark.parametrize("text", SUMS)
def test_a_sum_comes_apart_by_scale_and_factor(text):
    found = grouped(summands(law(text)), "i", positive)
    assert (found and [spell(part) for part in found]) == SUMS[text]


def test_constants_that_cancel_go_to_the_terms_that_need_them():
    one, other = balanced([law("R*exp(i/i_1)"), law("-R*exp(-i/i_0)")], "i", positive)
    assert (spell(one), spell(other)) == ("R*exp(i/i_1) + (-1)*R", "(-R)*exp((-i)/i_0) + 1*R")
    for other in ("-T*exp(-i/i_0)", "-R*R*exp(-i/i_0)", "-2*R*exp(-i/i_0)", "-R*exp(a - i/i_0)"):
        assert balanced([law("R*exp(i/i_1)"), law(other)], "i", positive) is None


@steady
@given(TEXTS, TEXTS, st.fixed_dictionaries({n: VALUES for n in sorted(POSITIVE)}), SIGNED, SIGNED)
def test_parts_of_a_sum_add_up_to_it(first, second, known, a, i):
    """Multiplied out, in groups, balanced, or with its choices outside, a law keeps its value."""
    try:
        tree = law(f"R*({first}) - ({second})")
        at = {name: float(value) for name, value in (known | {"a": a, "i": i}).items()}
        before = evaluate(tree, at)
    except (SpecError, ArithmeticError, ValueError):
        return
    groups = grouped(summands(tree), "i", positive)
    even = balanced(groups, "i", positive) if groups else None
    for parts in filter(None, (summands(tree), groups, even)):
        assert sum(evaluate(part, at) for part in parts) == pytest.approx(
            before, rel=1e-9, abs=1e-9
        )
    factor = If(Sym("i"), Cmp(">", Sym("i"), Sym("a")), Sym("R"))
    outside = choice_outside(Neg(Div(Mul(tree, factor), Sym("T"))))
    assert isinstance(outside, If)
    wanted = -before * evaluate(factor, at) / at["T"]
    assert evaluate(outside, at) == pytest.approx(wanted, rel=1e-9, abs=1e-9)
