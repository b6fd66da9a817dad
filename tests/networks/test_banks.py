"""Banks: `count` on an element and cells of several, against the network written out by hand."""

import re

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from piezo_sym import PiezoError, derive, verify
from piezo_sym.proofs import Verdict
from piezo_sym.spec.load import parse

COUNT = 3
MORE = """
g = { value = 0.3, unit = "1/m**2" }
v_0 = { value = 1, unit = "m/s" }
f_0 = { value = 2.0, unit = "N" }
"""
HEAD = """
[model]
name = "case"
[parameters]
m   = { value = 1.5, unit = "kg" }
k   = { value = 2.0, unit = "N/m" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0, unit = "J/K" }
PARAMETERS
[domain]
assume = ["d_c > 0", "g >= 0", "v_0 > 0", "f_0 > 0"]
[inputs]
F = { unit = "N" }
[elements]
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "q" }
mass   = { kind = "mass", at = "tip", mass = "m", state = "p" }
body   = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
load   = { kind = "force_source", at = "tip", input = "F" }
"""
#: Cells by their elements, `@` the lane; the state of a lane's store is in another's law.
MAXWELL = {
    "spring": 'kind = "spring", between = ["tip", "in@"], stiffness = "k_c@", state = "q_c@"',
    "damper": 'kind = "damper", between = ["in@", "wall"], force = "d_c@*v", heats = "body"',
}
SEEN = {
    "spring": 'kind = "spring", between = ["in@", "tip"], stiffness = "k_c@", state = "q_c@"',
    "damper": 'kind = "damper", between = ["in@", "wall"], heats = "body", '
    'force = "d_c@*(1 + g*q_c@**2)*v"',
}
ABSORBER = {
    "spring": 'kind = "spring", between = ["tip", "in@"], stiffness = "k_c@", state = "q_c@"',
    "damper": 'kind = "damper", between = ["in@", "tip"], heats = "body", '
    'force = "d_c@*v*(1 + g*q_c@**2) + d_c@*v**3/v_0**2"',
    "mass": 'kind = "mass", at = "in@", mass = "m_c@", state = "p_c@"',
}
STOPPED = {
    "mass": ABSORBER["mass"],
    "stop": 'kind = "stop", between = ["tip", "in@"], stiffness = "k_c@", limit = "f_c@", '
    'heats = "body", state = "q_c@"',
    "damper": MAXWELL["damper"],
}
DAMPERS = {
    "damper": 'kind = "damper", between = ["tip", "wall"], force = "d_c@*v", heats = "body"',
}
#: In series behind a spring, which gives the force; the ends of a lane are `<` and `>`.
LINK = 'link = { kind = "spring", between = ["tip", "a"], stiffness = "k", state = "q_l" }\n'
KELVIN = {
    "spring": 'kind = "spring", between = ["<", ">"], stiffness = "k_c@", state = "q_c@"',
    "damper": 'kind = "damper", between = [">", "<"], heats = "body", '
    'velocity = "f/d_c@*(1 + g*q_c@**2)"',
}
CHAINED = {
    "spring": 'kind = "spring", between = ["<", "in@"], stiffness = "k_c@", state = "q_c@"',
    "damper": 'kind = "damper", between = ["<", "in@"], force = "d_c@*v", heats = "body"',
    "more": 'kind = "damper", between = ["in@", ">"], velocity = "f**3/(d_c@*f_0**2)", '
    'heats = "body"',
}
#: What drives the slip is the tip's velocity less the damper's, one per lane.
SLIPPING = {
    "spring": f'{MAXWELL["spring"]}, slip = "abs(v)*f/f_0", heats = "body"',
    "damper": MAXWELL["damper"],
}
CELLS = {"maxwell": MAXWELL, "seen": SEEN, "absorber": ABSORBER, "stop": STOPPED, "damper": DAMPERS}
CELLS |= {"kelvin": KELVIN, "chained": CHAINED, "slipping": SLIPPING}
UNITS = {"k_c": "N/m", "d_c": "N*s/m", "m_c": "kg", "f_c": "N"}


def parameters(values):
    """Return the lines of parameters, lists or one of each lane."""
    rows = [f'{name} = {{ value = {v}, unit = "{UNITS[name[:3]]}" }}' for name, v in values.items()]
    return "\n".join([*rows, MORE])


def banked_text(cell, values):
    """Return the spec with the cell in a bank."""
    chained = "<" in str(cell)
    ends = str.maketrans({"@": "", "<": "a", ">": "wall"})
    rows = [f"{name} = {{ {text.translate(ends)} }}" for name, text in cell.items()]
    text = HEAD.replace("PARAMETERS", parameters(values)) + LINK * chained
    head = ["[banks.cell]", f"count = {COUNT}", *(['series = ["a", "wall"]'] * chained)]
    return "\n".join([text, *head, "[banks.cell.elements]", *rows])


def banked(cell, values):
    """Return the model with the cell in a bank."""
    return parse(banked_text(cell, values))


def written_out(cell, values):
    """Return the model with each lane's elements written by hand."""
    lanes, joints = range(1, COUNT + 1), ["a", *(f"j{n}" for n in range(1, COUNT)), "wall"]
    ends = [str.maketrans({"@": f"_{n}", "<": joints[n - 1], ">": joints[n]}) for n in lanes]
    rows = [
        f"cell_{name}_{n} = {{ {text.translate(ends[n - 1])} }}"
        for name, text in cell.items()
        for n in lanes
    ]
    single = {f"{name}_{n}": v[n - 1] for name, v in values.items() for n in lanes}
    text = HEAD.replace("PARAMETERS", parameters(single)) + LINK * ("<" in str(cell))
    text = text.replace('"d_c > 0"', ", ".join(f'"d_c_{n} > 0"' for n in lanes))
    return parse("\n".join([text, *rows]))


def numbers(iphs, sizes, point):
    """Return the rates, outputs, brackets, energy and entropy production of a system at a point."""
    lanes = iphs.system.E.lanes
    rows = [part for name in ("x", "rhs", "y") for part in explicit(getattr(iphs, name), sizes)]
    rows += [lanes.expand(part, sizes) for part in (iphs.U, iphs.S, iphs.sigma)]
    names = {s: point(s.name) for row in rows for s in row.free_symbols}
    return [float(sp.N(row.xreplace(names), 15)) for row in rows]


def explicit(matrix, sizes):
    return list(matrix.explicit(sizes) if hasattr(matrix, "explicit") else matrix)


@pytest.mark.some(2)
@pytest.mark.parametrize("cell", CELLS.values(), ids=CELLS)
@given(seed=st.integers(0, 10**6))
@settings(max_examples=5, deadline=None)
def test_a_bank_is_the_network_written_out(cell, seed):
    rng = np.random.default_rng(seed)
    used = [name for name in UNITS if f"{name}@" in str(cell)]
    values = {name: rng.uniform(0.2, 5, COUNT).round(4).tolist() for name in used}
    bank, single = derive(banked(cell, values)), derive(written_out(cell, values))
    states = {s.name: rng.uniform(-1, 1) for s in single.x}
    known = {n: p.si for n, p in single.model.parameters.items()}

    def point(name):
        return sp.Float(known.get(name, states.get(name, 0.7)), 17)

    found, wanted = numbers(bank, {"cell": COUNT}, point), numbers(single, {}, point)
    assert np.allclose(found, wanted, rtol=1e-11, atol=1e-11)
    assert [s.name for s in bank.expand().x] == [s.name for s in single.x]


def values_of(cell):
    return {name: [1.0, 2.0, 4.0] for name in UNITS if f"{name}@" in str(cell)}


@pytest.mark.some(2)
@pytest.mark.parametrize("cell", CELLS.values(), ids=CELLS)
def test_every_row_of_a_bank_is_proved(cell):
    report = verify(derive(banked(cell, values_of(cell))))
    assert {row.verdict for row in report.rows if row.required} == {Verdict.PROVED}


def test_a_bank_reads_as_the_elements_that_it_is_written_out_as():
    model = banked(ABSORBER, values_of(ABSORBER))
    text = model.flatten().to_toml()
    assert '[elements.cell_mass]\nkind = "mass"\nat = "cell.in"\ncount = 3\nbank = "cell"' in text
    assert parse(text) == model.flatten()
    assert parse(model.to_toml()) == model
    assert parse(text).sha256 == model.sha256


FORCE = '[banks.cell.elements]\nload_2 = { kind = "force_source", at = "tip", input = "F" }'
MASS = '{ kind = "mass", at = "tip", mass = "m" }\n[banks.cell]'
ELEMENT = "banks.cell.elements"
#: Edits of a spec with a bank of Maxwell's cells, and how its refusal begins.
REFUSED = [
    ("count = 3", "count = 0", "banks.cell.count: 0 does not fit; expected greater than or"),
    ("count = 3", "count = 2.5", "banks.cell.count: 2.5 does not fit; expected a valid int"),
    ("count = 3", "count = 2000000", "banks.cell.count: 2000000 does not fit; expected less"),
    ("count = 3", "count = 4", "parameters.k_c.value: a list of 3 values is given; expected 4"),
    ("count = 3", "conut = 3", "banks.cell.conut: unknown key 'conut'; did you mean 'count'?"),
    ("[banks.cell.elements]", FORCE, f"{ELEMENT}.load_2: a force_source is in no cell of a bank"),
    ("force =", "count = 3, force =", f"{ELEMENT}.damper.count: count is given in a cell; expec"),
    ("force =", "forse =", f"{ELEMENT}.damper.forse: unknown key 'forse'; did you mean 'force'?"),
    ("[banks.cell", "[banks.body", "banks.body.elements.spring: bank 'body' has the name of an"),
    ("[banks.cell", "[banks.q", "elements.spring: symbol 'q' is the dimension of a bank; rename"),
    ("[banks.cell", "[banks.1x", "banks.1x: '1x' is not a name; expected a letter, then letter"),
    ("[banks.cell]", f"cell_spring = {MASS}", f"{ELEMENT}.spring: would be called 'cell_spring'"),
    ("[banks.cell]", f"cell = {MASS}", f"{ELEMENT}.spring: bank 'cell' has the name of an elem"),
    ('"in"', '"wall"', "banks.cell.elements.damper: both ends are at node 'wall'; expected two"),
    ('"in"', '"gnd"', "banks.cell.elements.spring: 'gnd' is the electrical reference; expected"),
    ('"d_c*v"', '"d_c*v**3"', "network: elements 'cell_spring', 'cell_damper' fix each other's"),
    ('stiffness = "k"', 'force = "k*q_c"', "elements.spring.force: the force depends on 'q_c'"),
    ('stiffness = "k"', 'stiffness = "k_c"', "parameters.k_c.value: a list is given; expected"),
    ("[2.0", "[-2.0", "domain.assume[0]: the values given are outside the domain: d_c = -2"),
    ('"k", st', '"k", bank = "x", st', "elements.spring: bank is given without count; expected"),
]


@pytest.mark.parametrize(("old", "new", "message"), REFUSED)
def test_what_is_no_bank_is_refused_in_one_line(old, new, message):
    text = banked_text(MAXWELL, {"k_c": [1.0, 2.0, 3.0], "d_c": [2.0, 3.0, 4.0]})
    assert old in text
    with pytest.raises(PiezoError) as caught:
        derive(parse(text.replace(old, new)))
    found = str(caught.value).removeprefix("spec: ")
    assert found.startswith(message)
    assert found.isprintable()
    assert caught.value.exit_code == 2


def test_a_chain_behind_a_bank_is_proved():
    text = banked_text(KELVIN, values_of(KELVIN))
    many = LINK.replace('"q_l"', '"q_l", count = 2')
    report = verify(derive(parse(text.replace(LINK, many))))
    assert {row.verdict for row in report.rows if row.required} == {Verdict.PROVED}


def test_kinks_of_a_bank_stay_in_sums_over_its_lanes():
    text = banked_text(CHAINED, values_of(CHAINED)).replace(
        "f**3/(d_c*f_0**2)", "saturate(f, f_0)/d_c"
    )
    many = LINK.replace('stiffness = "k"', 'count = 2, force = "k*max(q - 0.1, 0)"')
    iphs = derive(parse(text.replace(LINK, many)))
    sizes = {"cell": COUNT, "link": 2}
    free = {s.name for row in iphs.rhs.explicit(sizes) for s in row.free_symbols}
    assert not {name for name in free if name.endswith("_j")}
    assert {"q_l_1", "q_l_2"} <= free


#: Laws of a damper that gives energy away somewhere, in some lane, and what is assumed of it.
FALSE = [
    ("d_c*v", []),
    ("-d_c*v", ["d_c > 0"]),
    ("d_c*v*(q_c/x_0)", ["d_c > 0"]),
    ("d_c*v*(1 + q_c/x_0)", ["d_c > 0"]),
    ("d_c*v*(1 + q/x_0)", ["d_c > 0"]),
    ("d_c*v*(0.9 + sin(q_c/x_0))", ["d_c > 0"]),
    ("d_c*v*(T - T_0)/T_0", ["d_c > 0"]),
    ("d_c*abs(v)", ["d_c > 0"]),
    ("d_c*v - d_c*saturate(2*v, v_0)", ["d_c > 0", "v_0 > 0"]),
    ("d_c*v - d_c*v_0/x_0*q_c", ["d_c > 0"]),
    ("d_c*v*p_c/(m_c*v_0)", ["d_c > 0", "v_0 > 0"]),
]


@pytest.mark.some(1)
@pytest.mark.parametrize("cell", [ABSORBER, KELVIN], ids=["parallel", "series"])
@pytest.mark.parametrize(("law", "assume"), FALSE)
def test_no_false_claim_of_a_bank_is_proved(law, assume, cell):
    cell = dict(cell)
    chained = cell is not ABSORBER and "mass" not in cell
    if chained:
        law = law.replace("p_c/(m_c*v_0)", "q_l/x_0").replace("v_0", "f_0")
        law = re.sub(r"\bv\b", "f", law).replace("d_c", "1/d_c")
    head, _, _ = cell["damper"].rpartition(", ")
    field = "velocity" if chained else "force"
    cell["damper"] = f'{head}, {field} = "{law}"'
    lists = {name: [1.0, 2.0, 4.0] for name in ("k_c", "d_c", "m_c") if f"{name}@" in str(cell)}
    text = banked_text(cell, {**lists, "d_c": [1.0, 2.0, 4.0]})
    assumed = [line.replace("v_0", "f_0" if chained else "v_0") for line in [*assume, "x_0 > 0"]]
    text = re.sub(r"assume = .*", f"assume = {assumed}", text)
    text = text.replace(MORE, MORE + 'x_0 = { value = 1.0, unit = "m" }\n')
    verdicts = {r.id: r.verdict for r in verify(derive(parse(text))).rows if r.id in CLAIMS}
    assert set(verdicts) == CLAIMS
    assert verdicts["sigma"] is not Verdict.PROVED
    assert verdicts["passive"] is Verdict.REFUTED or "sin" in law
    assert verdicts["passive"] is not Verdict.PROVED


CLAIMS = {"passive", "sigma"}
