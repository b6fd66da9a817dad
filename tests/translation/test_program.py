"""The row `program`: PROVED for what is printed, and for nothing else."""

import random
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from piezo_sym import derive, load
from piezo_sym.codegen import lower
from piezo_sym.expressions.calculus import add, mul
from piezo_sym.expressions.tree import LaneSum, Num
from piezo_sym.report import Verdict
from piezo_sym.spec.load import parse
from piezo_sym.translation.program import Reference, different
from tests.mutants.specs import spec_of
from tests.translation.mutants import mutants
from tests.translation.printed import TEXTS, printed, rows

SPECS = Path(__file__).parents[1] / "networks" / "specs"
ALL = ["piezo_stack", *sorted(path.name for path in SPECS.glob("*.toml"))]
#: Seconds; `tests/run/test_run_outputs.py` has it proved in the fast tier, too.
SLOW = {"rigid_couplings.toml": pytest.mark.long}
#: A lever, several bodies, conduction, a resistive loop with a bank, two banks.
MUTATED = [
    "piezo_stack",
    "a1_two_bodies.toml",
    "output_resistance_of_a_bank.toml",
    "transducer_between_moving_nodes.toml",
    "two_banks_heat_one_body.toml",
]


def iphs_of(name):
    return derive(load(str(SPECS / name) if name.endswith(".toml") else name))


def verdict(known, language, text):
    """Return the verdict on one text of a system."""
    found = different(language, text, known)
    return found[0].verdict if found else Verdict.PROVED


@pytest.mark.some(2)
@pytest.mark.parametrize("name", [pytest.param(name, marks=SLOW.get(name, ())) for name in ALL])
def test_what_is_printed_is_proved(name):
    iphs = iphs_of(name)
    (row,) = rows(iphs, printed(iphs))
    assert (row.id, row.verdict) == ("program", Verdict.PROVED), row.reason


def test_a_derivative_divides_by_the_square_of_what_laws_divide_by():
    """The square has 67 terms, too many to factor."""
    iphs = derive(load(str(Path(__file__).with_name("resistors_of_one_loop.toml"))))
    (row,) = rows(iphs, printed(iphs))
    assert row.verdict is Verdict.PROVED, row.reason


KINK_AT_SUMS = """
[model]
name = "kink_at_sums"
[parameters]
r = { value = 2.0, unit = "ohm" }
s = { value = 3.0, unit = "ohm" }
L = { value = 1.5, unit = "H" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[domain]
assume = ["r > 0", "s > 0"]
[elements]
bent = { kind = "resistor", between = ["gnd", "e"], voltage = "LAW", heats = "b" }
b = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S_b" }
[elements.one]
kind = "hysteron"
count = 2
between = ["e", "gnd"]
inductance = "L"
voltage = "r*i"
heats = "b"
[elements.two]
kind = "hysteron"
count = 3
between = ["gnd", "e"]
inductance = "L"
voltage = "s*i"
heats = "b"
"""


def test_a_kink_where_the_currents_of_two_banks_are_equal():
    """At the kink neither sum over lanes is zero, but their difference is."""
    law = "(r*i if i >= 0 else s*i)*(1 + abs(S_b/c))"
    iphs = derive(parse(KINK_AT_SUMS.replace("LAW", law)))
    (row,) = rows(iphs, printed(iphs))
    assert row.verdict is Verdict.PROVED, row.reason


def survivors(name, language, sample=None):
    """Return the mutants that are proved, and how many are not, by verdict."""
    iphs = iphs_of(name)
    made = list(mutants(printed(iphs)[language]))
    made = random.Random(name).sample(made, sample) if sample else made
    known, counts, alive = Reference(iphs), Counter(), []
    for n, (what, text) in enumerate(made):
        known = Reference(iphs) if n % 100 == 99 else known  # it grows by what is read
        counts[found := verdict(known, language, text)] += 1
        alive += [what] if found is Verdict.PROVED else []
    return alive, counts


@pytest.mark.some(2)
@pytest.mark.parametrize("language", TEXTS)
@pytest.mark.parametrize("name", MUTATED[:3])
def test_no_mutant_of_a_sample_is_proved(name, language):
    alive, counts = survivors(name, language, sample=10)
    assert alive == []
    assert counts[Verdict.REFUTED] > 0


@pytest.mark.long
@pytest.mark.parametrize("language", TEXTS)
@pytest.mark.parametrize("name", MUTATED)
def test_no_mutant_is_proved(name, language):
    alive, _ = survivors(name, language)
    assert alive == []


@pytest.mark.some(1)
@pytest.mark.parametrize("language", TEXTS[:2])
def test_a_change_of_a_quantity_before_it_is_printed_is_refuted(language):
    iphs = iphs_of("piezo_stack")
    program, known = lower(iphs, ""), Reference(iphs)
    for n in range(TEXTS.index(language), len(program.quantities), 4):
        quantity = program.quantities[n]
        value = quantity.value
        inner = value.arg if isinstance(value, LaneSum) else value
        inner = add(mul(Num(Fraction(-1)), inner), Num(Fraction(n % 3)))
        changed = LaneSum(inner, value.bank) if isinstance(value, LaneSum) else inner
        others = list(program.quantities)
        others[n] = replace(quantity, value=changed)
        text = printed(iphs, replace(program, quantities=tuple(others)))[language]
        assert verdict(known, language, text) is Verdict.REFUTED, quantity.name


def test_a_refuted_row_has_numbers():
    iphs = iphs_of("piezo_stack")
    texts = printed(iphs)
    wrong = texts["NumPy"].replace("V_in - V_capacitor - V_hys", "V_in + V_capacitor - V_hys")
    (row,) = rows(iphs, {**texts, "NumPy": wrong})
    assert row.verdict is Verdict.REFUTED
    assert "rhs['phi']" in row.reason
    assert {*row.witness} >= {"q", "p", "Q_C", "phi", "S", "V_in", "C"}


@pytest.mark.parametrize(
    "law", ["d*(deadzone(v, a) + saturate(v, 2*a))", "d*v*(1 if v > a else 2)"]
)
def test_laws_whose_slopes_choose_between_whole_numbers_are_proved(law):
    iphs = derive(parse(spec_of(f"{law} | d > 0; a > 0 | a=1.0")))
    (row,) = rows(iphs, printed(iphs))
    assert row.verdict is Verdict.PROVED, row.reason


def test_a_long_condition_of_a_bank_is_printed_as_its_least_lane():
    words = load("piezo_stack").to_toml()
    sizes = " + ".join(f"{n}*L*i_0" for n in range(10, 20))
    model = parse(words.replace('"lam >= 0"', f'"lam >= 0", "phi < {sizes}"'))
    iphs = derive(model)
    (row,) = rows(iphs, printed(iphs))
    assert row.verdict is Verdict.PROVED, row.reason


STORE = """
[model]
name = "store"
[parameters]
a = {{ value = 0.3, unit = "{unit}" }}
b = {{ value = 0.1, unit = "{unit}" }}
F = {{ value = 0.3, unit = "{output}" }}
M = {{ value = 2.0, unit = "{inert}" }}
n = {{ value = 1.4, unit = "1" }}
[domain]
assume = ["M > 0", "a > 0", "b > 0", "x < a", "x > -a", "n > 1"]
[elements]
store = {{ kind = "{kind}", between = ["p", "{ground}"], {output_of} = "{law}", state = "x" }}
other = {{ {other}, state = "y" }}
"""
STORES = [
    ("spring", "m", "N", "kg", "wall", "force", "q", 'kind = "mass", at = "p", mass = "M"'),
    (
        *("accumulator", "m**3", "Pa", "Pa*s**2/m**3", "tank", "pressure", "V"),
        'kind = "inertance", between = ["p", "tank"], inertance = "M"',
    ),
    (
        *("capacitor", "C", "V", "H", "gnd", "voltage", "Q"),
        'kind = "inductor", between = ["p", "gnd"], inductance = "M"',
    ),
]


def stored(store, law):
    kind, unit, output, inert, ground, output_of, letter, other = store
    law = law.replace("z", letter)
    words = {"unit": unit, "output": output, "inert": inert, "ground": ground, "other": other}
    return derive(parse(STORE.format(kind=kind, output_of=output_of, law=law, **words)))


@pytest.mark.parametrize("store", STORES, ids=lambda store: store[0])
@pytest.mark.parametrize(
    ("law", "near"),
    [
        ("F*((a/(a - z))**n)", "F*((a/(a + z))**n)"),
        ("F*((a + b)/(a - z))**n", "F*((a + 2*b)/(a - z))**n"),
        ("F*((a/(a - z))**n - (a/(a + z))**n)", "F*((a/(a - z))**n + (a/(a + z))**n)"),
        ("F*(a/(a - z))**(7/5)", "F*(a/(a - z))**(8/5)"),
    ],
)
def test_a_store_of_powers_of_quotients_is_proved_and_another_is_not(store, law, near):
    iphs = stored(store, law)
    (found,) = rows(iphs, printed(iphs))
    assert found.verdict is Verdict.PROVED
    (found,) = rows(iphs, printed(stored(store, near)))
    assert found.verdict is not Verdict.PROVED


def test_a_store_whose_exponents_add_up_to_minus_one_has_a_logarithm():
    law = "F*exp((1/3)*log(a/(a - z)))*exp((2/3)*log(a/(a - z)))"  # F*a/(a - z)
    iphs = stored(STORES[0], law).expand()
    at = {"a": 0.3, "b": 0.1, "F": 0.3, "M": 2.0, "n": 1.4, "x": 0.1, "y": 0.0}
    slope = iphs.U.diff(iphs.symbols["x"]).subs({iphs.symbols[k]: v for k, v in at.items()})
    assert float(slope) == pytest.approx(0.3 * 0.3 / (0.3 - 0.1), rel=1e-12)
