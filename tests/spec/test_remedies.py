"""Remedies are followed by a machine: what a message says to do leads to a spec that loads.

Each mistake is an edit of the shipped actuator. Its message is read, its remedy done to the text,
word by word, until the spec loads, derives, and has units.
"""

import re

import pytest

from piezo_sym import PiezoError, derive
from piezo_sym.proofs.units import units
from piezo_sym.report import Verdict
from piezo_sym.spec.load import parse
from piezo_sym.spec.source import find

TEXT = find("piezo_stack").read_text(encoding="utf-8")
SECOND = (
    '[elements.mount]\nkind = "thermal_mass"\ntemperature = "T_0*exp(S/c_0)"\n\n[elements.load]'
)
PART = '[elements.extra]\nkind = "{}"\n{}\n\n[elements.load]'
BRANCH = 'between = ["tip", "wall"]\n'

MISTAKES = {
    "an input that is not declared, of an ambient": ('input = "T_e"', 'input = "T_room"'),
    "of a force": ('input = "F_ext"', 'input = "push"'),
    "of a voltage": ('input = "V_in"', 'input = "drive"'),
    "an input almost as declared": ('input = "V_in"', 'input = "V_inn"'),
    "a temperature in Celsius": ('value = 296.15, unit = "K"', 'value = 23, unit = "degC"'),
    "a temperature with its sign": ('value = 296.15, unit = "K"', 'value = 23, unit = "°C"'),
    "micro": ('value = 5e-6,   unit = "F"', 'value = 5.0, unit = "µF"'),
    "another micro": ('value = 5e-6,   unit = "F"', 'value = 5.0, unit = "μF"'),
    "ohm by its sign": ('"ohm*K"', '"Ω*K"'),
    "a square by its sign": ('unit = "N/m"', 'unit = "N*m/m²"'),
    "a point for a product": ('unit = "N*s/m"', 'unit = "N·s/m"'),
    "a unit in other letters": ('unit = "kg"', 'unit = "Kg"'),
    "a function almost right": ("deadzone(i, i_0)", "deadzon(i, i_0)"),
    "a function in capitals": ("exp(S/c_0)", "EXP(S/c_0)"),
    "a parameter almost right": ('force = "d*v"', 'force = "D*v"'),
    "a kind almost right": ('kind = "spring"', 'kind = "springs"'),
    "a key almost right": ('stiffness = "k"', 'stifness = "k"'),
    "a body almost right": ('heats = "body"', 'heats = "bodi"'),
    "a node for two": ('between = ["tip", "wall"]\nforce', 'at = "tip"\nforce'),
    "two nodes for one": ('at = "tip"\nmass', 'between = ["tip", "wall"]\nmass'),
    "the reference in capitals": ('between = ["cap", "gnd"]', 'between = ["cap", "GND"]'),
    "the reference in full": ('between = ["in", "gnd"]', 'between = ["in", "ground"]'),
    "the wall in capitals": ('between = ["tip", "wall"]', 'between = ["tip", "Wall"]'),
    "T of two bodies": ("[elements.load]", SECOND),
    "a number that needs a unit": ('stiffness = "k"', 'stiffness = "k*(1 + 1e6*q**2)"'),
    "another one": ('force = "d*v"', 'force = "d*v*(1 + 3*v**2)"'),
    "a ratio of another unit": ('unit = "C/m"', 'unit = "N/A"'),
    "a heat capacity upside down": ('unit = "J/K",   doc = "heat', 'unit = "K/J",   doc = "heat'),
    "a conductance per area": ('unit = "W/K"', 'unit = "W/m**2/K"'),
    "a resistance law without unit": ('unit = "ohm*K"', 'unit = "1"'),
    "a half width in volts": ('value = 0.5,    unit = "A"', 'value = 0.5,    unit = "V"'),
    "a state's symbol in a condition": ('"d >= 0"', '"d >= 0", "Q**2 >= 0"'),
    "a state's symbol in its own law": (
        'stiffness = "k"\nrest = "q_l"\nstate = "q"',
        'stiffness = "k*(1 + (s/s_0)**2)"\nrest = "q_l"\nstate = "s"',
    ),
    "an initial state by its element": ('S = "c_0', 'body = "c_0'),
    "an initial state almost right": ('S = "c_0', 's = "c_0'),
    "the letter of a law in the other case": (
        'stiffness = "k"',
        'stiffness = "k*(1 + (Q/s_0)**2)"',
    ),
    "a letter of a resistance in the other case": ("deadzone(i, i_0)", "deadzone(I, i_0)"),
    "a state that moves as its own": (
        "[elements.load]",
        PART.format("spring", f'{BRANCH}force = "k*(q_2 - q_l)"')
        .replace(
            "[elements.load]", PART.format("spring", f'{BRANCH}stiffness = "k"\nstate = "q_2"')
        )
        .replace("extra", "other", 1),
    ),
    "a limit that is warm": (
        "[elements.load]",
        PART.format("stop", f'{BRANCH}stiffness = "k"\nlimit = "k*q_l*T/T_0"\nheats = "body"'),
    ),
    "kilo in a capital": ('unit = "ohm*K"', 'unit = "KOhm*K"'),
    "a lost bracket": ('ratio = "a*T/T_0"', 'ratio = "a*(1 + 1/T_0*T - T_0)"'),
    "a product for a quotient": ('"c_0*log(T_e/T_0)"', '"c_0*log(T_e*T_0)"'),
    "a table almost right": ("[elements.spring]", "[element.spring]"),
    "a key twice": ('stiffness = "k"', 'stiffness = "k"\nstiffness = "k"'),
    "a quoted key twice": ('stiffness = "k"', '"stiffness" = "k"\n"stiffness" = "k"'),
    "a key with a long value twice": (
        'between = ["tip", "wall"]\nforce',
        'between = ["tip", "wall"]\nbetween = [\n    "tip",\n    "wall",\n]\nforce',
    ),
    "a table twice": ("[inputs]", "[inputs]\n[inputs]"),
}


def mend(text: str, message: str) -> str:
    """Return the text with what a message says done to it."""
    if found := re.search(r"declare it in \[inputs\]: (.*)$", message):
        return text.replace("[inputs]\n", f"[inputs]\n{found[1]}\n")
    if found := re.search(r"'([^']+)' is not ASCII; expected a unit; write '([^']+)'", message):
        return text.replace(found[1], found[2])
    if found := re.search(r"parameters\.(\w+)\.unit: .*; give it in K: ([\d.]+)", message):
        line = rf"(?m)^{found[1]} .*?= \{{ value = [^,]+, +unit = \"[^\"]+\""
        return re.sub(line, f'{found[1]} = {{ value = {found[2]}, unit = "K"', text)
    if found := re.search(r"check the unit of (\w+): (\S+) would fit", message):
        line = rf"(?m)^({found[1]} .*?unit = )\"[^\"]+\""
        return re.sub(line, rf'\1"{found[2]}"', text)
    if found := re.search(r"make ([\d.]+) a parameter in (\S+)$", message):
        number = re.search(r"(?<![\w.])(1e6|3)\*", text)[1]
        text = text.replace(f"{number}*", "made*")
        return text.replace(
            "[inputs]", f'made = {{ value = {number}, unit = "{found[2]}" }}\n[inputs]', 1
        )
    if found := re.search(r"temperatures go by their bodies: (\w+)", message):
        return re.sub(r"\bT > T_0", f"{found[1]} > T_0", text)
    if found := re.search(r"states go by their own symbols: (\w+)", message):
        return text.replace("Q**2", f"{found[1]}**2")
    if found := re.search(r"the state of element '(\w+)' is '(\w+)'", message):
        return re.sub(rf"(?m)^{found[1]} = ", f"{found[2]} = ", text, count=1)
    if found := re.search(r"writes the state of its element as its letter, '(\w+)'", message):
        return text.replace("(s/s_0)", f"({found[1]}/s_0)")
    if found := re.search(r"'([^']+)' is (?:in its table|given) twice \(line (\d+)\)", message):
        lines = text.split("\n")
        first = lines.pop(int(found[2]) - 1)
        assert first.startswith(found[1])
        while first.endswith("[") and lines.pop(int(found[2]) - 1) != "]":
            pass
        return "\n".join(lines)
    if found := re.search(r"(\w+)\.\w+: unknown key '(at|between)'; did you mean '(\w+)'", message):
        nodes = {"at": '"tip"', "between": '["tip", "wall"]'}
        before, table, own = text.partition(f"[elements.{found[1]}]")
        old, new = (f"{key} = {nodes[key]}" for key in found.groups()[1:])
        return before + table + own.replace(old, new, 1)
    if found := re.search(r"write (\w+) for (\w+): it has the same rate", message):
        return text.replace(f"({found[2]} - q_l)", f"({found[1]} - q_l)")
    if found := re.search(r"write (limit = )'a', a parameter in N$", message):
        text = re.sub(rf'{found[1]}".*"', f'{found[1]}"F_c"', text)
        return text.replace("[inputs]", 'F_c = { value = 1.0, unit = "N" }\n[inputs]', 1)
    if found := re.search(r"unknown unit '(\w+)'; write '(\w+)", message):
        return text.replace(found[1], found[2])
    if found := re.search(r"; write (.*) for (.*)$", message):
        assert found[2] in text
        return text.replace(found[2], found[1])
    if found := re.search(r"calls '(\w+)', .*did you mean '(\w+)'", message):
        return text.replace(found[1], found[2])
    if found := re.search(r"'([\w ]+)'[^;]*(?:;.*)?; did you mean '(\w+)'\?", message):
        return re.sub(rf"\b{found[1]}\b", found[2], text)
    msg = f"no remedy in: {message}"
    raise AssertionError(msg)


def fault_of(text: str) -> str:
    """Return the message of the first fault; nothing where there is none."""
    try:
        iphs = derive(parse(text))
    except PiezoError as error:
        return str(error)
    wrong = [row for row in units(iphs) if row.verdict is not Verdict.PROVED]
    return wrong[0].reason if wrong else ""


@pytest.mark.some(25)
@pytest.mark.parametrize("mistake", MISTAKES)
def test_the_remedy_of_a_mistake_mends_it(mistake):
    old, new = MISTAKES[mistake]
    assert old in TEXT
    text = TEXT.replace(old, new, 1)
    if "s_0)" in new:
        text = text.replace("[inputs]", 's_0 = { value = 1.0, unit = "m" }\n[inputs]', 1)
    said = [message := fault_of(text)]
    assert message
    while message and len(said) < 4:
        text = mend(text, message)
        said.append(message := fault_of(text))
    assert message == "", said


HEATED = """
[model]
name = "heated"
[parameters]
m = { value = 1.0, unit = "kg" }
T_0 = { value = 300.0, unit = "K" }
c_0 = { value = 2.0, unit = "J/K" }
[inputs]
P = { unit = "W" }
[elements]
mass = { kind = "mass", at = "tip", mass = "m" }
body = { kind = "mass", at = "tip", mass = "m" }
heater = { kind = "heat_source", into = "mass", input = "P" }
"""


def test_a_body_is_offered_under_a_free_name():
    found = re.search(r"add one to \[elements\]: (.*), and name '(\w+)' here", fault_of(HEATED))
    assert fault_of(HEATED.replace('into = "mass"', f'into = "{found[2]}"') + found[1]) == ""
