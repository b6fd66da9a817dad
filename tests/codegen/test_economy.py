"""A step with fewer operations: the same values, and what is known before it by name."""

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from piezo_sym.codegen.economy import BEFORE, economical, with_products
from piezo_sym.codegen.program import Quantity
from piezo_sym.codegen.step import Step
from piezo_sym.expressions.calculus import add, mul, neg
from piezo_sym.expressions.tree import ONE, Call, Div, Mul, Sym, evaluate, names

LETTERS = ("a", "b", "c", "d")
EMPTY = Step("h", (), (), (), (), (), (), (), (), frozenset())


def product(factors, *, negative=False):
    value = Sym(factors[0])
    for factor in factors[1:]:
        value = mul(value, Sym(factor))
    return neg(value) if negative else value


def step(*values):
    quantities = tuple(Quantity(f"q{n}", value, None, "test") for n, value in enumerate(values))
    return replace(EMPTY, quantities=quantities)


def values_of(found):
    known = {letter: 1.5 + n for n, letter in enumerate(LETTERS)}
    for quantity in found.quantities:
        known[quantity.name] = evaluate(quantity.value, known)
    return known


PRODUCTS = st.tuples(st.lists(st.sampled_from(LETTERS), min_size=1, max_size=6), st.booleans())


@given(st.lists(PRODUCTS, min_size=1, max_size=5))
def test_products_keep_their_values(drawn):
    given_ = step(*(product(factors, negative=sign) for factors, sign in drawn))
    before, after = values_of(given_), values_of(with_products(given_))
    assert all(abs(after[name] / before[name] - 1) < 1e-14 for name in before)


def test_a_product_is_written_by_the_name_of_one_in_it():
    found = with_products(step(product("abc"), product("acbbd", negative=True), product("ab")))
    law, slope, short = (quantity.value for quantity in found.quantities)
    assert law == product("abc")
    assert slope == neg(mul(mul(Sym("q0"), Sym("b")), Sym("d")))
    assert short == product("ab")


def test_a_lane_s_product_is_no_part_of_a_shared_one():
    shared, own = product("abcd"), product("abc")
    given_ = replace(
        EMPTY,
        quantities=(Quantity("own", own, "bank", "test"), Quantity("all", shared, None, "test")),
    )
    assert with_products(given_) == given_


def test_functions_of_what_is_known_before_a_step_come_first():
    known = Call("exp", (mul(Sym("S"), Sym("c")),))
    found = economical(
        step(mul(Sym("a"), known), mul(Call("exp", (Sym("S_new"),)), known)), {}, ("a", "c", "S")
    )
    before, *others = found.quantities
    assert (before.name, before.value, before.note) == ("exp_S", known, BEFORE)
    assert others[0].value == mul(Sym("a"), Sym("exp_S"))
    assert set(names(others[1].value)) == {"S_new", "exp_S"}


def test_a_reciprocal_of_what_is_not_known_is_no_part_of_what_is():
    """An input divides twice here; the function of its reciprocal stays where it is."""
    given_ = step(Div(Sym("a"), Sym("u")), Call("exp", (Div(Sym("b"), Sym("u")),)))
    found = economical(given_, {}, ("a", "b"))
    assert [(q.name, q.note) for q in found.quantities] == [
        ("per_u", "reciprocals"),
        ("q0", "test"),
        ("q1", "test"),
    ]


def test_a_lane_s_function_stays_where_it_is():
    value = mul(Sym("a"), Call("exp", (Sym("phi"),)))
    given_ = replace(EMPTY, quantities=(Quantity("law", value, "bank", "test"),))
    assert economical(given_, {"phi": "bank"}, ("a", "phi")) == given_


def test_a_quotient_less_one_is_nothing_where_both_are_equal():
    """By a reciprocal, 49/49 - 1 would leave what the rounding of 1/49 does to it."""
    less = add(Div(Sym("a"), Sym("b")), neg(ONE))
    found = economical(step(mul(Sym("c"), less), Div(Sym("c"), Sym("b"))), {}, {*LETTERS})
    by_name = {quantity.name: quantity.value for quantity in found.quantities}
    difference = add(Sym("a"), neg(Sym("b")))
    assert by_name["q0"] == Mul(Sym("c"), Mul(difference, Sym("per_b")))
    known = {"a": 49.0, "b": 49.0, "c": 2.0, "per_b": 1 / 49.0}
    assert evaluate(by_name["q0"], known) == 0.0


def test_a_quotient_less_one_stays_where_nothing_else_is_divided():
    less = add(Div(Sym("a"), Sym("b")), neg(ONE))
    assert economical(step(less), {}, {*LETTERS}).quantities[-1].value == less
