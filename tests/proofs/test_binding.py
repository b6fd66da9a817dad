"""What a query assumes: as much as binds the names of its claim, and nothing besides."""

from hypothesis import given, settings
from hypothesis import strategies as st

from piezo_sym.expressions.parse import parse_condition
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Cmp, names
from piezo_sym.proofs.query import binding, connected, query
from piezo_sym.proofs.solvers import solver

NAMES = ("a", "b", "c", "d", "e")
TERMS = st.sampled_from([*NAMES, "0", "2", "a + b", "c - d", "b*e", "a*a - c", "e + 1"])
COMPARISONS = st.builds("{} {} {}".format, TERMS, st.sampled_from(["<", "<=", ">", ">="]), TERMS)


def read(*texts):
    """Return conditions from their texts; those without a name say nothing."""
    found = (parse_condition(text, "test") for text in texts)
    return tuple(condition for condition in found if names(condition))


def said(conditions):
    """Return conditions as text."""
    return [f"{spell(c.left)} {c.op} {spell(c.right)}" for c in conditions]


def test_temperatures_of_other_bodies_are_not_in_a_query():
    domain = read("T_1 > T_0", "T_2 > T_0", "T_0 > 0", "T_2 > 0", "T_0 < T_e", "T_1 > 0")
    assert said(binding(domain, ("T_1",))) == ["T_1 > T_0", "T_0 > 0", "T_1 > 0"]


def test_what_bounds_a_name_from_both_sides_stays():
    domain = read("a < b", "b < c", "c < d")
    assert said(binding(domain, ("a", "c"))) == ["a < b", "b < c"]
    assert said(binding(domain, ("a",))) == []


def test_a_name_in_an_equation_or_within_an_expression_stays():
    domain = (*read("b > a", "c + b > a"), Cmp("=", *[c.left for c in read("d > 0", "a > 0")]))
    assert said(binding(domain, ("a",))) == ["b > a", "c + b > a", "d = a"]


@settings(max_examples=60, deadline=None)
@given(st.lists(COMPARISONS, max_size=6), COMPARISONS)
def test_what_is_left_out_decides_nothing(texts, claim):
    domain, asked = read(*texts), read(claim)
    for claimed in asked:
        answers = {
            solver("z3").ask(query("", NAMES, [(c,) for c in given], claimed)).result
            for given in (connected(domain, names(claimed)), binding(domain, names(claimed)))
        }
        assert len(answers - {"unknown"}) <= 1
