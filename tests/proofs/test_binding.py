"""What a query assumes: as much as binds the names of its claim, and nothing besides."""

from hypothesis import given, settings
from hypothesis import strategies as st

from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Cmp, Sym, names
from piezo_sym.proofs.binding import binding, connected
from piezo_sym.proofs.query import query
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


def sides_of(name, condition):
    """Return from which sides a comparison bounds a name: both, unless it stands alone."""
    left, right = condition.left, condition.right
    if (left == Sym(name)) == (right == Sym(name)) or name in {*names(left)} & {*names(right)}:
        return {"above", "below"}
    if name not in (spell(left), spell(right)) or condition.op not in {"<", "<=", ">", ">="}:
        return {"above", "below"}
    return {"above" if (condition.op[0] == ">") == (left == Sym(name)) else "below"}


def by_definition(domain, words):
    """Return what binds some words, left out one after the other until nothing can be."""
    left = connected(domain, words)
    while free := [
        n
        for n in {n for c in left for n in names(c)} - {*words}
        if len(set().union(*(sides_of(n, c) for c in left if n in names(c)))) == 1
    ]:
        left = tuple(c for c in left if free[0] not in names(c))
    return tuple(dict.fromkeys(left))


OPS = st.sampled_from(["<", "<=", ">", ">=", "=", "!="])
ANY = st.builds(
    lambda op, left, right: Cmp(op, parse_law(left, "test"), parse_law(right, "test")),
    *(OPS, TERMS, TERMS),
)
MORE = st.lists(st.tuples(st.lists(ANY, max_size=4), st.sets(st.sampled_from(NAMES), max_size=3)))


@settings(max_examples=100, deadline=None)
@given(st.lists(ANY, max_size=40), MORE)
def test_questions_with_one_beginning_need_what_each_alone_needs(domain, questions):
    """Whatever was asked before, and however much the domain has that they do not need."""
    for more, words in questions:
        given = (*domain, *more)
        assert binding(given, words) == by_definition(given, words)
        assert binding(given[::2], words) == by_definition(given[::2], words)
