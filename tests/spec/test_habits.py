"""What other languages write in a spec is told how it is written here, and that then loads."""

import pytest

from piezo_sym import PiezoError
from piezo_sym.cli import run
from piezo_sym.spec.load import load, parse
from piezo_sym.spec.source import find

TEXT = find("piezo_stack").read_text(encoding="utf-8")
FORCE, STIFFNESS = 'force = "d*v"', 'stiffness = "k"'
MASS = 'M    = { value = 3.5e-3, unit = "kg",    doc = "moving mass" }'
ASSUME = 'assume = ["T > T_0", "T_e > T_0", "d >= 0", "rho >= 0", "i_0 >= 0", "lam >= 0"]'
BOTH = 'assume = ["T > T_0", "T_e > T_0", "rho >= 0", "i_0 >= 0", "lam >= 0", "d >= 0", "d < 9e9"]'
CELL = "[banks.creep]\ncount = 3\n"
LINE = 'ms = { kind = "spring", between = ["tip", "wall"], stiffness = "k" }'
#: The right text, another language's, and what is said of it; in the last two $ is this table.
HABITS = [
    (FORCE, 'force = "3.141592653589793*d*v"', 'force = "pi*d*v"', "write 3.141592653589793"),
    (FORCE, 'force = "d*v*exp(-T/T_0)"', 'force = "d*v*e**(-T/T_0)"', "write exp(x) for e**x"),
    (FORCE, 'force = "exp(1)*d*v"', 'force = "d*v*e"', "exp(1) for e"),
    (FORCE, FORCE, 'force = "min(d, inf)*v"', "leave out the limit that is none"),
    (FORCE, FORCE, 'force = "d*v + 0*eps"', "[parameters] with a small value and its unit"),
    (FORCE, 'force = "2*1000*d*v"', 'force = "2*kN*d*v"', "if the unit is meant, write 1000 for"),
    (FORCE, FORCE, 'force = "d*v\'"', "there is no transpose, and a rate is a letter"),
    (FORCE, 'force = "d*v*T_body/T_0"', 'force = "d*i"', "temperatures: q, p, Q_C, S, T_body"),
    (ASSUME, BOTH, 'assume = "d >= 0 && d < 9e9"', 'such as ["d >= 0", "d < 9e9"]'),
    (ASSUME, BOTH, 'assume = ["d >= 0 and d < 9e9"]', 'its own: "d >= 0", "d < 9e9"'),
    (ASSUME, BOTH, 'assume = ["0 <= d < 9e9"]', 'its own: "0 <= d", "d < 9e9"'),
    (ASSUME, BOTH, 'assume = ["min(d, rho) >= 0, d < 9e9"]', 'own: "min(d, rho) >= 0", "d < 9e9"'),
    (ASSUME, ASSUME, 'assume = ["d >= 0 or rho >= 0"]', "write 'max(a, b) > 0' for"),
    (
        FORCE,
        f"{FORCE}\ndiscontinuous = true",
        f"{FORCE}\ndiscontinuous = True",
        "write true or false",
    ),
    (MASS, MASS, f"% mass\n{MASS}", "a comment begins with #"),
    (MASS, MASS, f"{MASS} % mass", "a comment begins with #"),
    (MASS, 'M = { value = 3, unit = "kg" }', "M = { value = 3, unit = kg }", 'quotes: "kg"'),
    (MASS, 'M = { value = 3, unit = "kg" }', "M = 3 kg", 'write { value = 3, unit = "kg" }'),
    (MASS, 'M = { value = 8.5, unit = "kg" }', 'M = { value = 8,5, unit = "kg" }', "write 8.5, "),
    (MASS, 'M = { value = 0.5, unit = "kg" }', 'M = { value = .5, unit = "kg" }', "write 0.5, "),
    (MASS, 'M = { value = 1.0, unit = "kg" }', 'M = { value = 1., unit = "kg" }', "as in 1.0"),
    (MASS, f'{MASS}\nmu = {{ value = 1, unit = "1" }}', "\u03bc = 3", "in Latin letters"),
    (MASS, MASS, 'M = { value = 3 unit = "kg" }', "one is missing before 'unit'"),
    (MASS, MASS, 'M = { value = 3; unit = "kg" }', "separate entries by commas"),
    (MASS, MASS, 'M = { value = 1/3, unit = "kg" }', "a value as one number"),
    (MASS, MASS, 'M = { value = 3, unit = "kg"', "close the braces on the same line"),
    (MASS, MASS, 'M : { value = 3, unit = "kg" }', "write = between a key and its value"),
    (STIFFNESS, STIFFNESS, "stiffness = k", 'write texts in quotes: "k"'),
    (STIFFNESS, STIFFNESS, 'stiffness = "k', "close the quotes"),
    (STIFFNESS, STIFFNESS, "stiffness = \u201ck\u201d", "write straight quotes"),
    ("[elements.load]", "[elements.load]", "[elements load]", "close the name of a table with ]"),
    (
        "[elements.load]",
        f"{CELL}[banks.creep.elements]\n{LINE}\n[elements.load]",
        f'{CELL}elements = ["ms", "md"]\n[elements.load]',
        f"below [banks.creep.elements] the lines of its elements, which stand there alone, such as "
        f"{LINE}",
    ),
]


@pytest.mark.parametrize(("old", "right", "wrong", "said"), HABITS)
def test_what_is_said_of_a_habit_leads_to_a_spec(old, right, wrong, said):
    with pytest.raises(PiezoError) as error:
        parse(TEXT.replace(old, wrong))
    assert said in str(error.value)
    parse(TEXT.replace(old, right))


def test_a_component_without_its_ending_is_found(tmp_path):
    (tmp_path / "cell.toml").write_text(TEXT, encoding="utf-8")
    made = tmp_path / "made.toml"
    part = '[model]\nname = "made"\n[components.one]\nspec = "{}"\n'
    made.write_text(part.format("cell"), encoding="utf-8")
    with pytest.raises(PiezoError, match=r"did you mean 'cell.toml'\?"):
        load(made)
    made.write_text(part.format("cell.toml"), encoding="utf-8")
    load(made)


def test_the_list_of_kinds_shows_a_bank_of_cells(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["new", "made"]) == run(["kinds"]) == 0
    said, head = capsys.readouterr().out, "[banks.creep]"
    cells = said[said.index(head) :].partition("\n\n")[0]
    text = (tmp_path / "made.toml").read_text(encoding="utf-8")
    assert parse(text + cells).banks["creep"].count == 3


def test_a_choice_in_a_condition_has_a_comparison_of_its_own():
    parse(TEXT.replace(ASSUME, 'assume = ["(d if rho > 0 else 1) >= 0"]'))
