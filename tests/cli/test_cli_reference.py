"""``piezo-sym kinds``, ``functions``, ``units``, and the tables of ``show``."""

import re
import tomllib

import pytest

from piezo_sym import PiezoError, derive, verify
from piezo_sym.expressions.functions import FUNCTIONS
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import Call, walk
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.elements import KINDS
from piezo_sym.spec.load import parse


def test_every_kind_is_listed(call):
    answer = call("kinds")
    assert (answer.code, answer.err) == (0, "")
    table = answer.out.partition("Several alike")[0]
    assert [line.split()[0] for line in table.splitlines()[4:-1]] == list(KINDS)


@pytest.mark.some(19)
@pytest.mark.parametrize("kind", KINDS)
def test_the_example_of_a_kind_is_an_element_of_it(kind, call):
    out = call("kinds", kind).out
    (element,) = tomllib.loads(out[out.index("[elements]") :])["elements"].values()
    assert KINDS[kind](**element).kind == kind
    for field in KINDS[kind].model_fields:
        assert field in out


def test_what_numbers_equations_is_named(call):
    paper = "Caballeria, Ramirez, Le Gorrec (2021)"
    assert paper in call("kinds").out
    assert paper in call("kinds", "transducer").out
    assert paper not in call("kinds", "gear").out
    assert "`mechanical` is another name of `translation`" in call("kinds", "transducer").out


def test_a_kind_that_is_none_is_refused(call):
    answer = call("kinds", "sprin")
    assert (answer.code, answer.out) == (2, "")
    assert answer.err == "piezo-sym: KIND: 'sprin' is no kind; did you mean 'spring'?\n"


@pytest.mark.parametrize(
    ("kind", "meant"),
    [("displacement_source", "velocity_source"), ("LuGre", "slip"), ("bank", "count = 3")],
)
def test_a_kind_that_goes_by_another_name_is_told_in_command_and_spec(kind, meant, call):
    assert meant in call("kinds", kind).err
    spec = f"[elements]\na = {{ kind = '{kind}', between = ['tip', 'wall'] }}\n"
    with pytest.raises(PiezoError) as error:
        parse(f"[model]\nname = 'm'\n{spec}")
    assert meant in error.value.remedy


def test_every_function_has_an_example_with_it(call):
    out = call("functions").out
    for name, record in FUNCTIONS.items():
        calls = {n.function for n in walk(parse_law(record.example, name)) if isinstance(n, Call)}
        assert name in calls
        assert record.about
        assert f"\n  {name} " in out


def test_every_unit_that_is_listed_may_be_written(call):
    lines = call("units").out.splitlines()
    cells = [re.split(" {2,}", line.strip()) for line in lines]
    listed = [cell for cell in cells if len(cell) == 3][1:]
    assert {"m", "s", "A", "K", "N", "V", "ohm", "t", "rpm"} <= {symbol for symbol, *_ in listed}
    for symbol, _, value in listed:
        factor, _, base = value.rpartition(" ")
        unit = parse_unit(symbol)
        assert float(unit.factor) == pytest.approx(float(factor or 1))
        assert parse_unit(base).dimension == unit.dimension


def test_show_lists_elements_with_values_states_and_what_was_assumed(call):
    out = call("show", "piezo_stack").out
    lines = [" ".join(line.split()) for line in out.splitlines()]
    assert "spring spring tip - wall stiffness = k = 500000 N/m q = 0 (not said)" in lines
    assert "ambient ambient body body, input T_e conductance = lam = 2 W/K" in lines
    assert "T_e K 298.15 temperature of the environment" in lines


CHAINED = """
[model]
name = "creeping"
[parameters]
k_0 = { value = 1e6, unit = "N/m" }
m = { value = 1.0, unit = "kg" }
k = { value = [1e5, 2e5, 3e5], unit = "N/m" }
d = { value = [1e3, 1e4, 1e5], unit = "N*s/m" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[inputs]
F = { unit = "N" }
[domain]
assume = ["d > 0"]
[elements]
stiff = { kind = "spring", between = ["tip", "base"], stiffness = "k_0" }
push = { kind = "force_source", at = "tip", input = "F" }
mass = { kind = "mass", at = "tip", mass = "m" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
"""
ENDS = '["base", "wall"]'


def test_the_chain_that_kinds_shows_is_proved_and_others_are_told_what_to_write(call):
    chain = CHAINED + call("kinds").out.partition("in series, a chain:\n")[2]
    assert verify(derive(parse(chain))).proved
    inside = chain.replace(f"series = {ENDS}\n", "")
    inside = inside.replace('stiffness = "k" }', f'stiffness = "k", series = {ENDS} }}')
    with pytest.raises(PiezoError, match="series is given in a cell") as caught:
        parse(inside)
    assert f"write series = {ENDS} there, and between = {ENDS} in a cell's" in str(caught.value)
    apart = chain.replace(f"between = {ENDS}", 'between = ["x", "y"]')
    with pytest.raises(PiezoError, match="no cell connects to 'base'") as caught:
        derive(parse(apart))
    assert f"write between = {ENDS} in an element that spans its cell" in str(caught.value)
