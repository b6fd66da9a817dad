"""Large specs: time grows with their size, and beyond what can be derived a line says so."""

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy.polys.matrices import DomainMatrix

from piezo_sym import derive
from piezo_sym.algebra.linear import Equation, LongError, SingularError, solve
from piezo_sym.algebra.symbols import symbol_table
from piezo_sym.errors import NetworkError
from piezo_sym.network import causality, junction_of, kirchhoff
from piezo_sym.spec.circuit import circuit_of
from piezo_sym.spec.load import parse
from tests.clock import seconds, within

HEAD = """
[model]
name = "large"
[parameters]
k = { value = 2, unit = "N/m" }
m = { value = 2, unit = "kg" }
n = { value = 2, unit = "1" }
R = { value = 1, unit = "ohm" }
C = { value = 1, unit = "F" }
T_0 = { value = 300, unit = "K" }
c = { value = 1, unit = "J/K" }
"""
REST = """
[domain]
assume = ["n > 0", "R >= 0"]
[elements]
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
"""
MASS = 'm{0} = {{ kind = "mass", at = "x{0}", mass = "m" }}\n'
SPRING = 's{0} = {{ kind = "spring", between = ["x{0}", "{1}"], stiffness = "k" }}\n'
LEVER = (
    'l{0} = {{ kind = "lever", first = ["x{0}", "wall"], second = ["x{1}", "wall"], '
    'ratio = "n" }}\n'
)
CAPACITOR = 'C = { kind = "capacitor", between = ["a", "gnd"], capacitance = "C" }\n'
RESISTOR = (
    'r{} = {{ kind = "resistor", between = ["a", "gnd"], voltage = "R*i", heats = "body" }}\n'
)


def spec(*parts, parameters=""):
    return HEAD + parameters + REST + "".join(parts)


def chain(count):
    """Return masses in a row, each held by a spring to the one before."""
    parts = [MASS.format(n) + SPRING.format(n, f"x{n - 1}" if n else "wall") for n in range(count)]
    return spec(*parts)


def springs(count):
    """Return springs in parallel on one mass."""
    parts = (SPRING.format(n, "wall").replace(f"x{n}", "x0") for n in range(count))
    return spec(MASS.format(0), *parts)


def test_parameters_that_nothing_uses_cost_little():
    unused = "".join(f'p{n} = {{ value = 1, unit = "1" }}\n' for n in range(8000))
    text = spec(MASS.format(0), SPRING.format(0, "wall"), parameters=unused)
    parse(chain(1))  # units are read once in a process
    with within(8):
        derive(parse(text))


def test_springs_on_one_mass_cost_little():
    parse(chain(1))
    with within(6):
        derive(parse(springs(1000)))


@pytest.mark.long
def test_five_thousand_springs():
    with within(24):
        derive(parse(springs(5000)))


def test_a_long_chain_is_solved_link_by_link():
    iphs = derive(parse(chain(400)))
    labels = [slot.label for slot in iphs.system.states]
    entries = {(labels[r], labels[c]): e for (r, c), e, _ in iphs.system.J0.entries()}
    wanted = {(f"q_s{n}", f"p_m{n}"): 1 for n in range(400)}
    wanted |= {(f"q_s{n}", f"p_m{n - 1}"): -1 for n in range(1, 400)}
    assert entries == wanted | {(column, row): -e for (row, column), e in wanted.items()}


@pytest.mark.long
def test_the_time_to_solve_a_chain_grows_with_its_length():
    circuits = [circuit_of(parse(chain(count))) for count in (300, 1200)]
    tables = [symbol_table(circuit) for circuit in circuits]
    short, long = (
        min(seconds(junction_of, *given) for _ in range(3))
        for given in zip(circuits, tables, strict=True)
    )
    assert long < 8 * short


def test_couplings_that_take_too_long_are_refused(monkeypatch):
    parts = [LEVER.format(n, n + 1) + SPRING.format(n + 1, "wall") for n in range(10)]
    text = spec(MASS.format(0), *parts)
    derive(parse(text))
    monkeypatch.setattr(kirchhoff, "MOST_WORK", 1000)
    with pytest.raises(NetworkError) as caught:
        derive(parse(text))
    assert str(caught.value) == (
        "network: the laws of 11 branches and 10 couplings take too long to solve; "
        "leave elements out, or put masses and capacitors between levers and the like"
    )
    assert caught.value.exit_code == 2


def test_laws_to_turn_round_beyond_counting_are_refused(monkeypatch):
    text = spec(CAPACITOR, *map(RESISTOR.format, range(10)))
    derive(parse(text))
    monkeypatch.setattr(causality, "MOST_WORK", 50)
    with pytest.raises(NetworkError) as caught:
        derive(parse(text))
    assert str(caught.value) == (
        "network: more than 4 laws have to be turned round, one after the other; "
        "give current = '...' of v for 'r4' and those like it"
    )


SIZE, GIVEN = 6, "abc"
numbers = st.integers(-3, 3).map(sp.QQ)
lefts = st.dictionaries(st.integers(0, SIZE - 1), numbers, max_size=2)
rights = st.dictionaries(st.sampled_from(GIVEN), numbers, max_size=2)
systems = st.tuples(
    st.lists(st.tuples(lefts, rights), min_size=SIZE, max_size=SIZE),
    st.lists(st.tuples(lefts, rights), max_size=1),
)


def matrix(forms, columns):
    """Return the coefficients of forms, a row each, as a matrix of rationals."""
    rows = [[form.get(column, sp.QQ(0)) for column in columns] for form in forms]
    return DomainMatrix(rows, (len(rows), len(columns)), sp.QQ)


@settings(max_examples=200, deadline=None)
@given(systems)
def test_elimination_gives_the_one_solution_or_says_that_there_is_none(system):
    square, more = system
    rows = [({n: sp.QQ(1)} | left, right) for n, (left, right) in enumerate(square)] + more
    forms = [[{k: v for k, v in form.items() if v} for form in row] for row in rows]
    A = matrix([left for left, _ in forms], range(SIZE))
    B = matrix([right for _, right in forms], GIVEN)
    equations = [Equation(left, right) for left, right in forms]
    if A.rank() < SIZE or A.hstack(B).rank() > SIZE:
        with pytest.raises(SingularError):
            solve(equations, range(SIZE), [], 10**6)
    else:
        found = solve(equations, range(SIZE), [], 10**6)
        assert A * matrix([found[n] for n in range(SIZE)], GIVEN) == B


def test_elimination_stops_where_it_takes_too_long():
    equations = [Equation({n: sp.QQ(1), n + 1: sp.QQ(1)}, {"a": sp.QQ(1)}) for n in range(50)]
    with pytest.raises(LongError):
        solve([*equations, Equation({50: sp.QQ(1)}, {})], range(51), [], 100)
