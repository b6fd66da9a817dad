"""Letters that the domain bounds by what drives them: no verdict is wrong, by numbers."""

import math
import random
from fractions import Fraction

import pytest

from piezo_sym import derive
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "tied"
[parameters]
M = {{ value = 1.0, unit = "1" }}
K = {{ value = 2.0, unit = "1" }}
w = {{ value = 1.0, unit = "1" }}
T_0 = {{ value = 300.0, unit = "1" }}
c = {{ value = 2.0, unit = "1" }}
[inputs]
V = {{ unit = "1", default = -0.25 }}
[domain]
assume = [{domain}]
[initial]
x = 0.25
[elements]
m1 = {{ kind = "mass", at = "a", mass = "M", state = "x" }}
{drive}
{dampers}
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)" }}
"""
MASS = 'm2 = { kind = "mass", at = "b", mass = "K", state = "y" }\n'
PUSH = 'push = { kind = "force_source", at = "b", input = "V" }'
SPEED = 'push = { kind = "velocity_source", at = "b", input = "V" }'
DAMPER = 'd{n} = {{ kind = "damper", between = {ends}, force = "{law}", heats = "body", \
discontinuous = true }}\n'
#: What drives a damper: elements, its ends, and its letter at a point.
DRIVES = {
    "two masses": (MASS + PUSH, '["a", "b"]', lambda p: p["x"] / p["M"] - p["y"] / p["K"]),
    "turned round": (MASS + PUSH, '["b", "a"]', lambda p: p["y"] / p["K"] - p["x"] / p["M"]),
    "a mass and an input": (SPEED, '["a", "b"]', lambda p: p["x"] / p["M"] - p["V"]),
}
POSITIVE = ["M > 0", "K > 0", "w > 0"]
BOUNDS = {
    "two masses": ["x > 0", "y <= 0", "x**2 < M**2*w**2", "y**2 < K**2*w**2"],
    "turned round": ["x > 0", "y <= 0", "x**2 < M**2*w**2", "y**2 < K**2*w**2"],
    "a mass and an input": ["x > 0", "V < 0", "x**2 < M**2*w**2", "V**2 < w**2"],
}
LAWS = (
    "v*(4 - (v/w)**2)",
    "v*(1 - (v/w)**2)",
    "w*sqrt(v/w)",
    "-w*sqrt(-v/w)",
    "v if v > 0 else -v",
    "-v if v > 2.5*w else v",
    "-w if v < -2*w else v",
    "w*log(1 + v/w)",
    "v/(2.5*w - v)*w",
)
NAMES = {"sqrt": math.sqrt, "log": math.log, "exp": math.exp}


def value(text, point):
    return eval(text, dict(NAMES), point)


def points(domain, count=300):
    """Yield points of a domain, parameters positive, states and inputs of either sign."""
    draw = random.Random(1)
    for _ in range(count):
        point = {name: math.exp(draw.uniform(-3, 3)) for name in "MKw"}
        point |= {name: draw.choice([-1, 1]) * math.exp(draw.uniform(-4, 4)) for name in "xyV"}
        if all(value(condition, point) for condition in domain):
            yield point


def broken(row, law, letter, point):
    """Return whether a row is false at a point of the domain."""
    z = letter(point)
    try:
        force = value(law, {**point, "v": z})
        mirrored = value(law, {**point, "v": -z}) if row.id == "odd" else -force
    except (ValueError, ZeroDivisionError):
        return True
    size = abs(force) + abs(mirrored)
    wrong = abs(force + mirrored) > 1e-9 * size
    return wrong if row.id == "odd" else row.id == "passive" and force * z < -1e-12 * size * abs(z)


def check_witness(row, law, letter, domain):
    """Check that a witness lies in the domain, gives the letter its value, and breaks the row."""
    given = {name: float(Fraction(text)) for name, text in row.witness.items()}
    point = {"M": 1.0, "K": 1.0, "w": 1.0, "x": 0.0, "y": 0.0, "V": 0.0, **given}
    needed = [c for c in domain if all(n in given for n in "xyV" if n in c)]
    assert all(value(condition, point) for condition in needed)
    if {"v", *row.witness} == {*row.witness}:
        assert letter(point) == pytest.approx(given["v"])
        assert broken(row, law, letter, point)


@pytest.mark.some(1)
@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("bounds", [slice(0, 2), slice(2, 4), slice(0, 4), slice(0, 1)], ids=str)
def test_no_verdict_on_a_bounded_letter_is_wrong(drive, bounds):
    elements, ends, letter = DRIVES[drive]
    domain = POSITIVE + BOUNDS[drive][bounds]
    dampers = [DAMPER.format(n=n, ends=ends, law=law) for n, law in enumerate(LAWS)]
    quoted = ", ".join(f'"{condition}"' for condition in domain)
    text = SPEC.format(domain=quoted, drive=elements, dampers="".join(dampers))
    inside, seen = list(points(domain, 3000))[:60], set()
    assert inside
    for row in decide(derive(parse(text))).rows:
        if row.id not in {"welldef", "passive", "odd"} or not row.element.startswith("d"):
            continue
        law = LAWS[int(row.element[1:])]
        seen.add(row.verdict)
        if row.verdict is Verdict.PROVED:
            assert not any(broken(row, law, letter, point) for point in inside), (row, law)
        elif row.verdict is Verdict.REFUTED and row.id != "odd":
            check_witness(row, law, letter, domain)
    assert {Verdict.PROVED, Verdict.REFUTED} <= seen
