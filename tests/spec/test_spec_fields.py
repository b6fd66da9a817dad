"""Keys, kinds and references of a spec that are refused, each at its place."""

import pytest
from spec_tools import SHIPPED, edited_text, refusal, refused_edit

from piezo_sym import Model
from piezo_sym.errors import SpecError
from piezo_sym.spec.load import parse
from piezo_sym.spec.source import data


@pytest.mark.parametrize(
    ("old", "new", "place", "answer"),
    [
        ('unit = "kg",', 'units = "kg",', "parameters.M.units", "did you mean 'unit'?"),
        ("default = 298.15", "defualt = 298.15", "inputs.T_e.defualt", "did you mean 'default'?"),
        ("assume =", "asume =", "domain.asume", "did you mean 'assume'?"),
        ("title  =", "titel  =", "model.titel", "did you mean 'title'?"),
        ("[domain]", "[domian]", "domian", "did you mean 'domain'?"),
        (
            'stiffness = "k"',
            'stifness = "k"',
            "elements.spring.stifness",
            "did you mean 'stiffness'?",
        ),
        ('voltage = "rho', 'volts = "rho', "elements.hysteron.volts", "did you mean 'voltage'?"),
        (
            'S = "c_0*log',
            's = "c_0*log',
            "initial.s",
            "'s' is no state of this spec; did you mean 'S'?",
        ),
        *(
            (
                'S = "c_0*log(T_e/T_0)"',
                f"{word} = 320.0",
                f"initial.{word}",
                "give its entropy 'S' ('c*log(T_start/T_0)' where the temperature is "
                "'T_0*exp(S/c)'), or the temperature to a run: --initial T_body=320, "
                "simulate(initial={'T_body': 320})",
            )
            for word in ("T_body", "T")
        ),
    ],
)
def test_unknown_keys_are_answered_with_the_nearest(old, new, place, answer):
    message = refused_edit((old, new))
    assert message.startswith(f"spec: {place}: ")
    assert answer in message


@pytest.mark.parametrize(
    ("kind", "answer"),
    [
        ('"sprin"', "did you mean 'spring'?"),
        ('"Spring"', "did you mean 'spring'?"),
        ('"zzz"', "known: spring, mass"),
        ("5", "unknown kind 5"),
        ("[]", "unknown kind '[]'"),
        ("{}", "unknown kind '{}'"),
        ("true", "unknown kind 'True'"),
        ('""', "unknown kind ''"),
    ],
)
def test_unknown_kinds(kind, answer):
    message = refused_edit(('kind = "spring"', f"kind = {kind}"))
    assert message.startswith("spec: elements.spring.kind: ")
    assert answer in message


def test_an_element_without_a_kind():
    message = refused_edit(('kind = "spring"', ""))
    assert message.startswith("spec: elements.spring.kind: is missing; expected one of spring, ma")


@pytest.mark.parametrize(
    ("old", "place", "remedy"),
    [
        ('unit = "kg", ', "parameters.M.unit", 'add unit = "N/m", say; unit = "1" where'),
        ("value = 3.5e-3, ", "parameters.M.value", "add value = 1.0, or"),
        ('name   = "piezo_stack"', "model.name", "add it; known keys: name, "),
    ],
)
def test_missing_keys(old, place, remedy):
    assert refused_edit((old, "")).startswith(f"spec: {place}: is missing; {remedy}")


def test_a_parameter_that_is_a_number_alone():
    old = 'd    = { value = 4e2,    unit = "N*s/m", doc = "damping" }'
    said = "parameters.d: 400 does not fit; expected { value = 400, unit = "
    assert said in refused_edit((old, "d = 400"))


@pytest.mark.parametrize(
    ("new", "said"), [("", "neither given"), ('force = "d*v"\nvelocity = "f/d"', "both force and")]
)
def test_a_damper_has_one_law(new, said):
    message = refused_edit(('force = "d*v"', new))
    assert message.startswith("spec: elements.damper: its fields do not go together; expected exa")
    assert said in message


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ('mass = "M"', "mass = 3", "elements.mass.mass"),
        ('between = ["in", "cap"]', 'between = ["in"]', "elements.hysteron.between"),
        ('between = ["in", "cap"]', 'between = ["in", "cap", "x"]', "elements.hysteron.between"),
        ('between = ["in", "cap"]', 'between = "in"', "elements.hysteron.between"),
        ('at = "tip"\nmass', 'at = ["tip"]\nmass', "elements.mass.at"),
        ('force = "d*v"', 'force = "d*v"\ndiscontinuous = "yes"', "elements.damper.discontinuous"),
        ('state = "q"', "state = 1", "elements.spring.state"),
        ('unit = "kg"', "unit = 1", "parameters.M.unit"),
        ('doc = "moving mass"', "doc = 1", "parameters.M.doc"),
        ('doc = "moving mass"', 'doc = "two\\nlines"', "parameters.M.doc"),
        ('doc = "moving mass"', f'doc = "{"x" * 401}"', "parameters.M.doc"),
        ('name   = "piezo_stack"', "name = 1", "model.name"),
        ('"T > T_0", ', "5, ", "domain.assume"),
    ],
)
def test_values_of_the_wrong_kind(old, new, place):
    message = refused_edit((old, new))
    assert message.startswith(f"spec: {place}")
    assert "expected" in message


@pytest.mark.parametrize(
    "table", ["model", "parameters", "inputs", "domain", "initial", "elements"]
)
@pytest.mark.parametrize("value", [5, [], [[1]], "x", None, True, {"x": 5}, {"": {}}, {"a\nb": {}}])
def test_tables_of_the_wrong_kind(table, value):
    assert table in str(refusal(lambda: Model(**(data(SHIPPED) | {table: value}))))


def test_heat_for_a_body_that_is_not_there():
    message = refused_edit(('force = "d*v"\nheats = "body"', 'force = "d*v"\nheats = "bodi"'))
    assert message == (
        "spec: elements.damper.heats: 'bodi' is no thermal_mass of this spec; did you mean 'body'?"
    )


def test_heat_for_no_body_is_answered_with_one_of_the_spec():
    damper = 'force = "d*v"\nheats = "body"', 'force = "d*v"'
    said = "spec: elements.damper.heats: is missing; add heats = "
    assert refused_edit(damper).startswith(f'{said}"body", the thermal_mass')
    extra = '[elements.plate]\nkind = "thermal_mass"\ntemperature = "T_0*exp(S/c_0)"\n\n'
    more = damper, ("[elements.spring]", f"{extra}[elements.spring]")
    assert refused_edit(*more).startswith(f'{said}"plate", or another thermal_mass')


def test_heat_for_no_body_in_a_spec_without_any_says_to_add_one():
    spring = '{ kind = "spring", between = ["tip", "wall"], stiffness = "k" }'
    damper = '{ kind = "damper", between = ["tip", "wall"], force = "d*v" }'
    text = f'[model]\nname = "cold"\n[elements]\nspring = {spring}\ndamper = {damper}\n'
    message = str(refusal(parse, text))
    assert 'add heats = "body", and an element body of kind thermal_mass' in message


def test_heat_without_any_body_is_answered_with_one():
    text = edited_text(("[inputs]", "[inputs]"))
    start, end = text.index("[elements.transducer]"), text.index("[elements.load]")
    message = str(refusal(parse, text[:start] + text[end:]))
    assert (
        "'body' is no thermal_mass of this spec; expected a body for the heat; add one" in message
    )


def test_an_input_that_is_not_declared():
    message = refused_edit(('input = "V_in"', 'input = "Vin"'))
    assert message == (
        "spec: elements.supply.input: 'Vin' is no input of this spec; did you mean 'V_in'?"
        '; or declare it in [inputs]: Vin = { unit = "V" }'
    )


def test_a_condition_on_an_unknown_name():
    message = refused_edit(('"T > T_0"', '"T_x > T_0"'))
    assert message.startswith(
        "spec: domain.assume[0]: 'T_x > T_0': unknown name 'T_x'; did you mean 'T_"
    )


def test_a_condition_on_a_letter():
    message = refused_edit(('"T > T_0"', '"v > 0"'))
    assert message.startswith("spec: domain.assume[0]: 'v > 0': 'v' has no meaning here")


GEAR = """[elements.gear]
kind = "gear"
first = ["x", "frame"]
second = ["y", "frame"]
ratio = "omega"

"""
PAIR = """[elements.pair]
kind = "thermoelectric"
between = ["in", "gnd"]
bodies = [PAIR]
seebeck = "a"

"""


def test_the_temperature_needs_a_body_in_a_transducer():
    message = refused_edit(('ratio = "a*T/T_0"', 'ratio = "a*i/T_0"'))
    where = "spec: elements.transducer.ratio: 'i' has no meaning here"
    assert message.startswith(f"{where}; expected ")
    gear = refused_edit(("[elements.load]", f"{GEAR}[elements.load]"))
    assert "'omega' has no meaning here; expected parameters, states and temperatures" in gear
    assert "inputs" not in gear


def test_of_two_names_one_is_not_enough():
    hot = PAIR.replace("PAIR", '"body"')
    message = refused_edit(("[elements.load]", f"{hot}[elements.load]"))
    assert "elements.pair.bodies: 1 entry is given; expected two names" in message
    message = refused_edit(("[elements.load]", f"{PAIR.replace('PAIR', '')}[elements.load]"))
    assert message.endswith(
        "elements.pair.bodies: no entry is given; expected two names, such as ['a', 'b']"
    )


def test_every_fault_is_shown_unknown_and_missing_keys_first():
    text = edited_text(
        ("value = 3.5e-3", "value = nan"),
        ('between = ["cap", "gnd"]\ncapacitance', "capacitance"),
        ('stiffness = "k"', 'stifness = "k"'),
    )
    first, second, third = refusal(parse, text).lines()
    assert first.startswith("spec: elements.spring.stifness: unknown key 'stifness'; did you")
    assert second.startswith("spec: elements.capacitor.between: is missing; ")
    assert third.startswith("spec: parameters.M.value: nan does not fit; ")


def test_of_very_many_faults_the_rest_are_counted():
    text = edited_text(("[model]", "[model]\n" + "\n".join(f"x{n} = 1" for n in range(50))))
    lines = refusal(parse, text).lines()
    assert len(lines) == 21
    assert lines[-1] == "spec: 30 more faults in this spec"


def test_a_unit_that_is_a_number_is_not_told_to_be_a_parameter():
    assert "[parameters] has" not in refused_edit(('unit = "kg"', "unit = 3"))


def test_a_misspelled_key_is_one_fault():
    message = refused_edit(('stiffness = "k"', 'stifness = "k"'))
    assert message.endswith("unknown key 'stifness'; did you mean 'stiffness'?")


HINTS = [
    (
        ('stiffness = "k"', 'stiffness = "k*Q_C"'),
        'add to assume in [domain]: "k*Q_C > 0", "C > 0"',
    ),
    (('"T > T_0"', '"Q > 0"'), "states go by their own symbols: Q_C"),
    (('"T_0*exp(S/c_0)"', '"T_0*exp(s/c_0)"'), "unknown name 's'; did you mean 'S'?"),
    (('state = "S"', 'state = "S_b"'), "states go by their own symbols: S_b"),
    (('S = "c_0', 'body = "c_0'), "the state of element 'body' is 'S'"),
    (('S = "c_0', 'L = "c_0'), "its value is given in [parameters]; states: q, p"),
    (('S = "c_0', 'T_e = "c_0'), "its value is given in [inputs]; states: q, p"),
]


@pytest.mark.parametrize(("edit", "hint"), HINTS, ids=[edit[1] for edit, _ in HINTS])
def test_a_state_where_a_letter_belongs_and_the_reverse_is_told_what_to_write(edit, hint):
    assert refused_edit(edit).endswith(hint) or f"{hint}, " in refused_edit(edit)


def test_a_state_in_its_own_law_goes_by_its_letter():
    renamed = ('state = "q"', 'state = "x"')
    message = refused_edit(renamed, ('"k"', '"k*exp(x/q_l)"'))
    assert message.endswith("a law writes the state of its element as its letter, 'q'")


def test_a_misspelled_key_is_not_taken_for_one_that_the_element_has():
    more = 'electrical = ["a", "b"]\nmechnical = ["c", "d"]\nconstant = "k"\n'
    text = SHIPPED + f'\n[elements.motor]\nkind = "motor"\n{more}'
    message = refusal(parse, text).lines()[0]
    assert message.endswith("unknown key 'mechnical'; known: translation, rotation")


FAULTS = {
    "units": ({'unit = "kg"': 'unit = "kgg"', 'unit = "F"': 'unit = "Farads"'}, ["M", "C"]),
    "texts": ({'"d*v"': '"d v"', '"k"': '"k +"'}, ["spring", "damper"]),
    "references": (
        {'heats = "body"': 'heats = "boy"', 'input = "V_in"': 'input = "V"'},
        ["boy", "'V'"],
    ),
    "laws": ({'"d*v"': '"D_1*v"', '"k"': '"K_1"', '"c_0*log': '"C_2*log'}, ["K_1", "D_1", "C_2"]),
    "a name twice": ({'"d*v"': '"K_1*v"', '"k"': '"K_1"'}, ["K_1"]),
}


@pytest.mark.parametrize(("edits", "words"), FAULTS.values(), ids=FAULTS)
def test_all_faults_of_one_sort_are_said_at_once(edits, words):
    text = SHIPPED
    for old, new in edits.items():
        assert old in text
        text = text.replace(old, new)
    with pytest.raises(SpecError) as caught:
        parse(text, "mine.toml")
    lines = caught.value.lines()
    assert len(lines) == len(words)
    for line, word in zip(lines, words, strict=True):
        assert line.startswith("mine.toml: ")
        assert word in line


CELLS = """
[banks.creep]
count = 2
[banks.creep.elements]
slow = { kind = "spring", between = ["tip", "inside"], stiffness = "k_1" }
loss = { kind = "damper", between = ["inside", "wall"], force = "d_1*v", heats = "body" }
"""


def test_faults_in_cells_have_their_own_places():
    with pytest.raises(SpecError) as caught:
        parse(SHIPPED + CELLS)
    places = [line.partition(": unknown name")[0] for line in caught.value.lines()]
    start = "spec: banks.creep.elements"
    assert places == [f"{start}.slow.stiffness", f"{start}.loss.force"]
