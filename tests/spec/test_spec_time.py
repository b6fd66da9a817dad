"""Time: hostile laws are answered at once, and what is accepted does not hang later."""

from contextlib import suppress

import pytest
from spec_tools import edited_text, refusal
from test_spec_parse import HOSTILE

from piezo_sym import PiezoError, derive, load, verify
from piezo_sym.build import files_of, render
from piezo_sym.codegen import template_of
from piezo_sym.expressions import parse as parse_module
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.load import parse
from piezo_sym.verification import process
from tests.clock import seconds, slowness, within

QUICK = 0.1
HURRIED = 1.5
LATER = 30.0  # two to nine seconds on a quiet machine, at most; a hang takes minutes


def nest(form, times, inner="v"):
    for _ in range(times):
        inner = form.format(inner)
    return inner


def long(joint, form, count):
    return joint.join(form.format(n) for n in range(1, count))


#: Laws of v and T that are short to write, and long in one stage or another.
LAWS = {
    "a power of sums": "((1+v)**16)**16",
    "a power of a sum": "(v+T+d+c_0+T_0+rho+k+M)**16",
    "a product of sums": long("*", "(v+{0}*T+d)", 32),
    "quotients of sums": long("/", "(v+{0}*T+d)", 32),
    "a sum of quotients": long("+", "v/(T+{0})", 90),
    "a tower of quotients": nest("1/(1+{0})", 18),
    "a tower of quotients of v": nest("v/(T+{0})", 15),
    "a tower of exp": nest("exp({0}/d)", 18),
    "a tower of tanh": nest("tanh({0}/d+T)", 18),
    "a tower of sin": nest("sin({0}*v)", 18),
    "a tower of roots": nest("(1+{0})**(1/3)", 12),
    "a tower of roots of numbers": "v*" + nest("(2+{0})**(1/3)", 15, "3"),
    "a tower of logs": nest("log(2+{0})", 18),
    "a log of a product to a power": "log(v*T*d*M*k*c_0*T_0*rho*v*T)**16",
    "abs in abs": nest("abs({0}-1)", 4),
    "min a hundred deep": "min(" * 100 + "v" + ",1)" * 100,
    "min in min on both sides": "min(min(min(v,T),min(d,M)),min(min(v,d),k))",
    "min under another min": nest("min(d*T, {0}*v)", 4),
    "abs of a sum of kinks": "abs(" + long("+", "abs(v-{0})", 30) + ")",
    "a choice by a sum of kinks": "v if " + long("+", "abs(v-{0})", 30) + " < T else d",
    "choices in conditions": nest("(v if v < {0} else T)", 18),
    "choices in a row": "v if v < 1 else " * 38 + "T",
    "products of choices": long("*", "(v if v<{0} else T)", 16),
    "dead zones in dead zones": "deadzone(deadzone(deadzone(v, d), d), d)",
    "a product of dead zones": long("*", "deadzone(v, {0})", 32),
    "a sum of dead zones of dead zones": long("+", "deadzone(deadzone(v,{0}),d)", 30),
    "a product of kinks": long("*", "abs(v-{0})", 30),
    "a min of products of mins": "min(v*min(T,v*min(d,v)),T)*min(v*min(T,v*min(d,v)),M)",
    "kinks that compare sums": "min(d - v, v - M) + max(v - T, T - v)",
    "an angle of kinks": "abs(abs(v) - 1)",
    "large numbers": "v*1e300*1e300*1e300",
    "a power of a large number": "(1e300*v)**16",
    "a power of a small number": "(v+1e-300)**16",
    "powers of long numbers": "(v+1234567890.12345678901234567890123456789)**16",
    "quotients of long numbers": long("+", "v/1.23456789012345678901234567890123456{0}", 22),
    "sine of a large number": "v*sin(1e300)",
    "roots of products": long("*", "sqrt(v*v+{0})", 16),
    "a polynomial of nested sums": nest("(T+v*({0}))", 12),
    "squares of sums of squares": nest("(T+({0})**2)", 5),
    "fractions of fractions": nest("({0}+T)/({0}+d)", 3),
    "long sums": "v" + "+v" * 499,
    "products of a long sum": "(" + "+".join(["v*T"] * 60) + ")*(" + "+".join(["d"] * 60) + ")",
    "log of a sign": "abs(log(sign(v)))",
    "signs in a row": "-" * 8 + "v",
    "parentheses": "(" * 40 + "v" + ")" * 40,
    "a law at the limit of length": ("d*v + " + "+".join(["tanh(v)*T/T_0"] * 70))[:997] + "*T",
}


def best(call, *args):
    """Return the least processor time of three calls, refused or not, none of them remembered."""

    def answered():
        with suppress(PiezoError):
            call(*args)

    times = []
    for _ in range(3):
        parse_module._law.cache_clear()
        times.append(seconds(answered))
    return min(times)


def spec_with(law, name):
    return edited_text(('"d*v"', f'"{law}"'), ('"piezo_stack"', f'"{name}"'))


@pytest.fixture(scope="module", autouse=True)
def _warm():
    render(load("piezo_stack"))


@pytest.fixture
def _hurried(monkeypatch):
    """An examination that is stopped early: that it ends in time has tests of its own."""
    monkeypatch.setattr(process, "PATIENCE", HURRIED)


@pytest.mark.some(20)
@pytest.mark.parametrize("text", [*LAWS.values(), *HOSTILE], ids=lambda text: ascii(text)[:25])
def test_a_hostile_law_is_answered_at_once(text, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(spec_with(text.replace("\\", "\\\\").replace('"', '\\"'), "mine"), "utf-8")
    assert best(load, path) < QUICK * slowness()


PLACES = {
    "damper": ('"d*v"', "{}", "v", "T"),
    "bank": ('"rho/(T - T_0)*deadzone(i, i_0)"', "{}", "i", "T"),
    "spring": ('"k"', "k*(2 + ({})**2)", "q", "M"),
    "capacitor": ('"C"', "C*(2 + abs({}))", "Q", "M"),
    "body": ('"T_0*exp(S/c_0)"', "T_0*(2 + ({})**2)", "S", "M"),
    "transducer": ('"a*T/T_0"', "a*T/T_0*({})", "T", "T_0"),
}


def words(law, v, T):
    return (
        law.replace("tanh", "#")
        .replace("v", v)
        .replace("T_0", "@")
        .replace("T", T)
        .replace("@", "T_0")
        .replace("#", "tanh")
    )


def stages(text):
    """Take a spec through all stages: what it is, what is proved of it, and its module."""
    model = parse(text)
    files = files_of(model, verify(derive(model)), template_of(derive(model)))
    compile(files[f"{model.name}/{model.name}.py"], "module", "exec")


def placed():
    """Each law at each place; in the fast tier at a damper, and at a quarter of the others."""
    for n, law in enumerate(LAWS):
        for k, place in enumerate(PLACES):
            marks = [pytest.mark.long] if k and (n + k) % 4 else []
            yield pytest.param(LAWS[law], PLACES[place], id=f"{law}-{place}", marks=marks)


@pytest.mark.some(1)
@pytest.mark.usefixtures("_hurried")
@pytest.mark.parametrize(("law", "place"), list(placed()))
def test_what_is_accepted_does_not_hang_later(law, place):
    old, form, v, T = place
    text = edited_text((old, f'"{form.format(words(law, v, T))}"'))
    with within(LATER), suppress(PiezoError):
        stages(text)


MILLION = 1_000_000
LARGE = {
    "a law": edited_text(('"d*v"', '"' + "d*v+" * (MILLION // 4) + '1"')),
    "a comment": "# " + "a" * MILLION,
    "a title": edited_text(('"Piezoelectric stack actuator with hysterons"', f'"{"a" * MILLION}"')),
    "a unit": edited_text(('unit = "kg"', f'unit = "{"m*" * (MILLION // 2)}m"')),
    "elements": "".join(f'[elements.m{n}]\nkind = "mass"\n' for n in range(MILLION // 30)),
    "arrays": "x = " + "[" * (MILLION // 2) + "]" * (MILLION // 2),
    "keys": ".".join("a" * (MILLION // 2)) + " = 1",
    "numbers": "x = [" + "1," * (MILLION // 2) + "]",
    "empty lines": "\n" * MILLION,
}


@pytest.mark.parametrize("text", LARGE.values(), ids=LARGE)
def test_a_million_characters_are_refused_at_once(text, tmp_path):
    path = tmp_path / "large.toml"
    path.write_text(text)
    assert "is too large; expected at most 500000" in str(refusal(load, path))
    assert "is too large; expected at most 500000" in str(refusal(parse, text))
    assert best(load, path) < QUICK * slowness()
    assert best(parse, text) < QUICK * slowness()


@pytest.mark.parametrize(
    "unit",
    [
        "m**9**9**9",
        "m" * 10_000,
        "m*" * 5_000 + "m",
        "m**" * 3_000 + "2",
        "(" * 10_000,
        "9" * 10_000,
        "m**" + "9" * 10_000,
        "\u03a9" * 10_000,
        "__import__('os').system('id')",
        "m if m else s",
        "m\n" * 100,
    ],
    ids=lambda unit: ascii(unit)[:20],
)
def test_hostile_units_are_refused_at_once(unit):
    assert "is not a unit; expected names joined by" in str(refusal(parse_unit, unit, "unit"))
    assert best(parse_unit, unit, "unit") < QUICK / 10 * slowness()
