"""Names: which words may be one, and which are taken."""

import keyword

import pytest
from hypothesis import given
from hypothesis import strategies as st
from spec_laws import steady
from spec_tools import SHIPPED, edited, edited_text, refusal, refused_edit

from piezo_sym import derive, verify
from piezo_sym.errors import SpecError
from piezo_sym.spec.load import parse
from piezo_sym.spec.names import check_name, check_symbol, fresh

SHAPE = "expected a letter, then letters, digits or '_' (not last), at most 40 in all; rename it"


@pytest.mark.parametrize(
    ("word", "answer"),
    [
        ("lambda", "call it 'lambda_0'"),
        ("in", "call it 'in_0'"),
        ("end", "call it 'tip'"),
        ("time", "call it 't'"),
        ("der", "call it 'd'"),
        ("None", "call it 'None_0'"),
        ("double", "call it 'double_0'"),
        ("restrict", "call it 'restrict_0'"),
        ("parfor", "call it 'parfor_0'"),
        ("flow", "call it 'flow_0'"),
        ("match", "call it 'match_0'"),
    ],
)
def test_keywords_are_refused_with_another_name(word, answer):
    message = str(refusal(check_symbol, word, "parameters.x"))
    assert message.startswith(f"parameters.x: '{word}' is a keyword of Python, C, MATLAB or Model")
    assert message.endswith(answer)


@pytest.mark.parametrize("word", keyword.kwlist)
def test_every_keyword_of_python_is_refused(word):
    answer = str(refusal(check_symbol, word, "parameters.x")).rpartition("'")[0].rpartition("'")[2]
    assert check_symbol(answer, "parameters.x") == answer


def test_the_import_of_modules_is_kept():
    message = str(refusal(check_symbol, "np", "parameters.x"))
    assert "'np' is kept for modules; call it 'np_0'" in message


@pytest.mark.parametrize("word", ["exp", "deadzone", "min", "abs", "tanh"])
def test_functions_of_laws_are_kept(word):
    message = str(refusal(check_symbol, word, "parameters.x"))
    assert f"'{word}' is a function of laws; call it '{word}_0'" in message


NOT_NAMES = [
    "a;b",
    "x y",
    "1x",
    "",
    " ",
    "x" * 99,
    "x" * 41,
    "x_",
    "_x",
    "__x__",
    "x-y",
    "x.y",
    "x\n",
    "../up",
    "..",
    "/etc/passwd",
    "a/b",
    "a\\b",
    "x\x00",
    "\u03bb",
    "\u0391",
    "\u0410",
    "q\u0323",
    "x\u200b",
    "\uff34",
    "ph\u0131",
    "a'b",
    'a"b',
    "$x",
    "x(1)",
    "a,b",
]


@pytest.mark.parametrize("check", [check_name, check_symbol])
@pytest.mark.parametrize("word", NOT_NAMES, ids=ascii)
def test_words_that_are_no_names(check, word):
    assert f"is not a name; {SHAPE}" in str(refusal(check, word, "model.name"))


@pytest.mark.parametrize("word", ["con", "NUL", "Com1", "lpt9"])
def test_names_of_devices_are_refused(word):
    assert str(refusal(check_name, word, "model.name")).endswith(f"call it '{word}1'")


@pytest.mark.parametrize(
    "word", ["M", "q_l", "i_0", "T_0", "lam", "x" * 40, "F_ext", "Lambda", "a1", "e", "pi", "np_0"]
)
def test_good_symbols_pass(word):
    assert check_symbol(word, "parameters.x") == word


@pytest.mark.parametrize("word", ["class", "piezo_stack", "lambda", "spring"])
def test_good_names_pass(word):
    assert check_name(word, "elements.x") == word


@steady
@given(st.text(max_size=45) | st.from_regex(r"[A-Za-z_0-9]{1,45}", fullmatch=True))
def test_a_name_is_an_identifier_or_refused(word):
    try:
        assert check_symbol(word, "parameters.x").isidentifier()
    except SpecError:
        refusal(check_symbol, word, "parameters.x")


@steady
@given(st.from_regex(r"[A-Za-z][A-Za-z0-9]{0,9}", fullmatch=True), st.lists(st.text(max_size=5)))
def test_fresh_names_are_fresh(base, taken):
    taken = {base, *taken, base + "_"}
    assert fresh(base, taken) not in taken
    assert fresh(base, taken).rstrip("_") == base


@pytest.mark.parametrize("word", ["lambda", "exp"])
def test_fresh_names_avoid_keywords_and_functions(word):
    assert fresh(word, ()) == word + "_"


def test_fresh_keeps_a_free_name():
    assert fresh("v_mass", {"v"}) == "v_mass"


@pytest.mark.parametrize("name", ["", "a/b", "../up", "x y", "con", "x" * 99, "\\u03bb"])
def test_a_models_name_cannot_leave_its_folder(name):
    message = refused_edit(('name   = "piezo_stack"', f'name   = "{name}"'))
    assert message.startswith("spec: model.name: ")


@pytest.mark.parametrize("name", ["lambda", "exp", "np", "while", "a;b", "x y", "1x"])
def test_a_parameters_name_is_checked(name):
    message = refused_edit(("[inputs]", f'"{name}" = {{ value = 1, unit = "1" }}\n[inputs]'))
    assert message.startswith(f"spec: parameters.{name}: ")


def test_an_inputs_name_is_checked():
    message = refused_edit(("[domain]", 'time = { unit = "s" }\n[domain]'))
    assert message.startswith("spec: inputs.time: 'time' is a keyword")


def test_a_states_name_is_checked():
    message = refused_edit(('state = "phi"', 'state = "lambda"'))
    assert message.startswith("spec: elements.hysteron: 'lambda' is a keyword")
    assert message.endswith("call it 'lambda_0'")


def test_a_greek_look_alike_in_a_spec_is_refused():
    message = refused_edit(("[inputs]", '"\u039c" = { value = 1, unit = "kg" }\n[inputs]'))
    assert "'\u039c' is not a name; " in message
    assert message.endswith("rename it in plain ASCII")


def test_a_name_is_shown_as_it_is_written_but_for_what_does_not_print():
    message = refused_edit(('"piezo_stack"', '"Gr\u00f6\u00dfe\\u202e\\u0007"'))
    assert "model.name: 'Größe\\u202e\\x07' is not a name" in message


def test_an_elements_name_is_checked():
    message = refused_edit(("[elements.damper]", '[elements."da mper"]'))
    assert message.startswith("spec: elements.da mper: 'da mper' is not a name")


def test_a_very_long_name_gives_a_short_message():
    word = "x" * 100_000
    message = refused_edit(("[inputs]", f'{word} = {{ value = 1, unit = "1" }}\n[inputs]'))
    assert "is not a name" in message


@pytest.mark.parametrize(
    ("name", "use"),
    [
        ("T_body", "the temperature of 'body'"),
        ("hysteron_count", "the size of bank 'hysteron'"),
        ("spring_count", "the size of bank 'spring'"),
        ("energy", "a variable of every result"),
        ("entropy", "a variable of every result"),
        ("energy_residual", "a variable of every result"),
        ("entropy_residual", "a variable of every result"),
        ("y_load", "a variable of every result"),
        ("supplied_supply", "a variable of every result"),
        ("heat_damper", "a variable of every result"),
        ("produced_hysteron", "a variable of every result"),
        ("entropy_exchanged_ambient", "a variable of every result"),
    ],
)
@pytest.mark.parametrize("table", ["inputs", "domain"])
def test_names_that_results_use_are_taken(table, name, use):
    value = "value = 1, " if table == "inputs" else ""
    message = refused_edit((f"[{table}]", f'{name} = {{ {value}unit = "1" }}\n[{table}]'))
    assert f"symbol '{name}' is {use}; rename it" in message


@pytest.mark.parametrize(
    ("name", "lane", "offer"),
    [
        ("phi_1", "bank state 'phi'", "phi1"),
        ("phi_12", "bank state 'phi'", "phi12"),
        ("phi_j", "bank state 'phi'", "phij"),
        ("i_hysteron_j", "bank 'hysteron'", "i_hysteronj"),
        ("V_hysteron_2", "bank 'hysteron'", "V_hysteron2"),
    ],
)
def test_lanes_are_taken_and_another_name_is_offered(name, lane, offer):
    entry = '{ value = 1, unit = "1" }'
    base = name.rpartition("_")[0]
    message = refused_edit(("[inputs]", f"{name} = {entry}\n[inputs]"))
    use = f"a lane of {lane}, called {base}_1, {base}_2 ... in results and equations"
    assert f"symbol '{name}' is {use}; call it '{offer}'" in message
    assert edited(("[inputs]", f"{offer} = {entry}\n[inputs]")).parameters[offer].value == 1.0
    both = refused_edit(("[inputs]", f"{offer} = {entry}\n{name} = {entry}\n[inputs]"))
    assert f"call it '{offer}a'" in both


@pytest.mark.parametrize("name", ["L_1", "L_j"])
def test_lanes_of_a_list_are_taken(name):
    message = refused_edit(
        ("value = 1e-3,", "value = [1e-3, 2e-3],"),
        ("[inputs]", f'{name} = {{ value = 1, unit = "1" }}\n[inputs]'),
    )
    assert f"symbol '{name}' is a lane of 'L'" in message


FREE = ["phi_0", "phi_01", "phi_0x", "phi_jj", "L_1", "T_spring", "y_wall", "count", "U"]


@pytest.mark.parametrize("name", FREE)
def test_names_beside_the_taken_ones_are_free(name):
    model = edited(("[inputs]", f'{name} = {{ value = 1, unit = "1" }}\n[inputs]'))
    assert model.parameters[name].value == 1.0


def test_a_number_0_is_no_lane_as_lanes_are_counted_from_1():
    law = 'voltage = "rho/(T - T_0)*deadzone(i, i_0)*(1 + (phi/phi_0)**2)"'
    model = edited(
        ('voltage = "rho/(T - T_0)*deadzone(i, i_0)"', law),
        ("[inputs]", 'phi_0 = { value = 1, unit = "Wb" }\n[inputs]'),
        ('"d >= 0"', '"d >= 0", "phi_0 > 0"'),
    )
    assert verify(derive(model)).proved


@pytest.mark.parametrize("name", ["Spring", "SPRING", "Body"])
def test_elements_whose_names_differ_only_by_case(name):
    message = refused_edit(("[elements.load]", f"[elements.{name}]"))
    assert f"elements.{name}: '{name}' and '{name.lower()}' differ only by case" in message


def test_symbols_are_case_sensitive():
    model = edited(("[inputs]", 'm = { value = 1, unit = "1" }\n[inputs]'))
    assert model.parameters["m"].value != model.parameters["M"].value


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ('state = "q"', 'state = "p"', "elements.spring"),
        ('state = "q"', 'state = "M"', "parameters.M"),
        ('state = "q"', 'state = "V_in"', "inputs.V_in"),
    ],
)
def test_symbols_are_given_once(old, new, place):
    message = refused_edit((old, new))
    assert f"is already that of {place}" in message
    assert "set 'state' in elements." in message


def test_a_state_of_a_storage_is_renamed_where_it_stands():
    gas = """
[elements.gas]
kind = "storage"
energy = "k*z**2/2 + T_0*c_0*exp(S/c_0)"
[elements.gas.states]
z = { rate = "velocity", between = ["tip", "wall"] }
S = { rate = "entropy" }
"""
    message = str(refusal(parse, edited_text() + gas))
    assert "symbol 'S' is already that of elements.body" in message
    assert "call it otherwise in elements.gas.states and energy" in message


def test_a_parameter_and_an_input_of_one_name():
    message = refused_edit(("[domain]", 'M = { unit = "N" }\n[domain]'))
    assert message == (
        "spec: inputs.M: symbol 'M' is already that of parameters.M; give one of them another name"
    )


def test_a_default_state_is_a_symbol_too():
    text = edited_text(
        ('state = "q"\n', "\n"), ("[inputs]", 'q_spring = { value = 1, unit = "1" }\n[inputs]')
    )
    assert "'q_spring' is already that of parameters.q_spring" in str(refusal(parse, text))


def test_nodes_are_labels_and_may_be_keywords():
    assert parse(SHIPPED).elements["supply"].between == ("in", "gnd")


@pytest.mark.parametrize("node", ["", "a b", "x" * 41, "a;b", "\\u03b1", "tip\\n"])
def test_labels_of_nodes(node):
    message = refused_edit(('at = "tip"\nmass', f'at = "{node}"\nmass'))
    assert message.startswith("spec: elements.mass.at: ")
    assert "is not a label; expected up to 40 letters, digits or . _ + -" in message


def test_a_state_without_a_name_is_refused():
    message = refused_edit(('state = "q"', 'state = ""'))
    assert f"elements.spring: '' is not a name; {SHAPE}" in message
