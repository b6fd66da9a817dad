"""The search itself: the oracle sees what is there, slices resume, found specs stay found."""

import json
import os
import tomllib
from collections import Counter
from pathlib import Path

import pytest
import tomli_w

from tests.clock import within
from tests.search import __main__ as program
from tests.search.judge import judge
from tests.search.laws import read, text
from tests.search.proving import Prover
from tests.search.shrink import shrunk
from tests.search.slices import BAD, fit, slice_of, verdicts
from tests.search.specs import draw

FOUND = sorted(Path(__file__).with_name("found").glob("*.toml"))

SPEC = """
[model]
name = "m"
[parameters]
M = {{ value = 1.0, unit = "1" }}
p = {{ value = 1.0, unit = "1" }}
w = {{ value = 0.5, unit = "1" }}
a = {{ value = -1.0, unit = "1" }}
b = {{ value = -2.0, unit = "1" }}
T_0 = {{ value = 2.0, unit = "1" }}
[inputs]
F = {{ unit = "1" }}
[domain]
assume = [{domain}]
[elements]
m = {{ kind = "mass", at = "tip", mass = "{mass}" }}
src = {{ kind = "force_source", at = "tip", input = "F" }}
d = {{ kind = "damper", between = ["tip", "wall"], force = "{law}", heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "{temperature}" }}
"""


def spec(law, *domain, mass="M", temperature="T_0*exp(S/p)"):
    assumed = ", ".join(f'"{text}"' for text in ("p > 0", "w >= 0", *domain))
    return SPEC.format(law=law, domain=assumed, mass=mass, temperature=temperature)


def fault(source, id, verdict, element="d", **witness):
    """Return the kind of the fault that one row on a spec is, or nothing."""
    row = {"id": id, "element": element, "verdict": verdict, "reason": "", "witness": witness}
    faults, _ = judge(source, [row])
    return faults[0].kind if faults else ""


FALSE = [
    ("passive", spec("a*v")),
    ("passive", spec("v*(v - 1)**2 - 1e-6*v")),
    ("passive", spec("p*v*(a**2 - 1e-6)")),
    ("passive", spec("v if v < 100*p else -v")),
    ("passive", spec("v*(exp(v/p) - 2.72*v/p)")),
    ("passive", spec("v*(1 - (v/p)**2)", "p_m**2 < 2*M**2*p**2")),
    ("passive", spec("(a - b)*v", "a*b >= 1", "a*b <= 1")),
    ("passive", spec("(a - b)*v", "a < b + 1e-9")),
    ("welldef", spec("v*sqrt(a)")),
    ("welldef", spec("v/(a - b)")),
    ("welldef", spec("v/(T - 2*T_0)")),
    ("welldef", spec("v*(log(a) if a >= 0 else 1)")),
    ("welldef", spec("v*((1 if sqrt(a - 1) > 2 else 2) if a > 0.5 else 3)")),
    ("continuous", spec("v if v < p else v + 1e-3")),
    ("continuous", spec("v if v**2 < 2 else 2*v")),
    ("continuous", spec("p*v if T > 2*T_0 else w*v")),
    ("odd", spec("v + 1e-9*v**2")),
]
TRUE = [
    ("passive", spec("p*v")),
    ("passive", spec("v*(exp(v/p) - 2.7*v/p)")),
    ("passive", spec("v*(1 - (v/p)**2)", "p_m**2 < M**2*p**2")),
    ("passive", spec("v*(v - 1)**2")),
    ("passive", spec("a*v", "(a if a > 0 else -1) > 0")),
    ("welldef", spec("v*(sqrt(a) if a > 0 else 1)")),
    ("welldef", spec("v/(T + T_0)")),
    ("continuous", spec("v if a > 0 else -v")),
    ("continuous", spec("sqrt(abs(v)) if v > 0 else v")),
    ("continuous", spec("(v if v < p else p) + deadzone(v, w)")),
    ("odd", spec("v*abs(v)")),
]


@pytest.mark.parametrize(("id", "source"), FALSE)
def test_the_oracle_sees_what_is_false(id, source):
    assert fault(source, id, "PROVED") == "false PROVED"


@pytest.mark.parametrize(("id", "source"), TRUE)
def test_the_oracle_sees_nothing_in_what_is_true(id, source):
    assert fault(source, id, "PROVED") == ""


COLD = {"T_0*(1 + S/p)": True, "T_0*(1 + (S/p)**2)": True, "T_0*exp(S/p) + p": False}


@pytest.mark.parametrize("law", COLD)
def test_the_oracle_sees_what_a_temperature_does(law):
    found = fault(spec("v", temperature=law), "temperature", "PROVED", "body")
    assert found == ("false PROVED" if COLD[law] else "")


def test_a_condition_without_a_value_is_seen():
    assert fault(spec("v", "sqrt(b + 3) > 0"), "welldef", "PROVED", "") == "false PROVED"
    assert fault(spec("v", "sqrt(b + 3) > 0", "b > -3"), "welldef", "PROVED", "") == ""


WITNESSES = [
    ("passive", spec("a*v"), {"a": "-1", "v": "1"}, ""),
    ("passive", spec("a*v"), {"a": "1", "v": "1"}, "false REFUTED"),
    ("passive", spec("a*v"), {"a": "0", "v": "1"}, "false REFUTED"),
    ("passive", spec("a*v", "a < b"), {"a": "-1", "v": "1"}, ""),
    ("passive", spec("a*v", "a > b"), {"a": "-1", "b": "0", "v": "1"}, "false REFUTED"),
    ("passive", spec("p*v"), {"p": "-1", "v": "1"}, "false REFUTED"),
    (
        "passive",
        spec("-v", "p_m > 0", mass="M/(1 + w*p**2)"),
        {"p_m": "1", "v": "9"},
        "loose REFUTED",
    ),
    ("welldef", spec("v/a"), {"a": "0"}, ""),
    ("welldef", spec("v/a if a > 0 else v"), {"a": "0", "v": "0"}, "false REFUTED"),
    ("continuous", spec("v if a > 0 else -v"), {"a": "0", "v": "1"}, "false REFUTED"),
    ("continuous", spec("v if v > 1 else -v"), {"v": "1"}, ""),
    ("continuous", spec("v if v > 1 else -v"), {"v": "2"}, "false REFUTED"),
    ("odd", spec("v + v**2"), {"v": "1"}, ""),
    ("odd", spec("v"), {"v": "1"}, "false REFUTED"),
]


@pytest.mark.parametrize(("id", "source", "witness", "kind"), WITNESSES)
def test_a_witness_has_to_break_the_law_inside_the_domain(id, source, witness, kind):
    assert fault(source, id, "REFUTED", **witness) == kind


def test_laws_are_written_as_they_are_read():
    for seed in range(20):
        made = draw(seed, lambda _: True)
        for element in made.data["elements"].values():
            for law in (v for k, v in element.items() if k in {"force", "voltage", "current"}):
                assert text(read(text(read(law)))) == text(read(law))


def test_the_same_seed_gives_the_same_spec():
    assert draw("7.1", fit).text == draw("7.1", fit).text != draw("7.2", fit).text


class Silent:
    """A prover that says nothing, and counts how often it is asked."""

    asked = 0

    def __init__(self, *_):
        pass

    def rows(self, text):
        Silent.asked += 1
        return {"rows": [], "text": text}

    def close(self):
        pass


def test_a_slice_that_is_there_is_not_run_again(tmp_path, capsys):
    out = tmp_path / "out.jsonl"
    for slices in ("0:2", "1:3"):
        program.main(["--slices", slices, "--out", str(out), "--specs", "1"], Silent)
    assert [json.loads(line)["slice"] for line in out.read_text().splitlines()] == [0, 1, 2]
    assert Silent.asked == 3
    assert "60 laws" in capsys.readouterr().out


@pytest.fixture(scope="module")
def prover():
    made = Prover(60)
    yield made
    made.close()


def test_a_process_that_hangs_is_ended_and_counted(prover):
    assert prover.rows(spec("v"))["rows"]
    process, limit = prover.process, prover.limit
    os.kill(process.pid, 19)  # it stands still
    prover.limit = 0.5
    answer, counts = prover.rows(spec("v")), Counter()
    prover.limit = limit
    assert process.poll() is not None
    assert [fault.kind for fault in verdicts(spec("v"), answer, counts)] == ["time"]
    assert counts == {"time": 1}


def test_a_spec_is_made_small():
    data = tomllib.loads(spec("v*(1 + b**2) - p*v + sqrt(T/T_0)*w", "a < 1", "b < 1"))

    def still(made):
        laws = [e.get("force", "") for e in made["elements"].values()]
        return any("sqrt" in law for law in laws) and "b < 1" in made["domain"]["assume"]

    small = shrunk(data, still, 20)
    assert list(small["elements"]) == ["d"]
    assert small["elements"]["d"]["force"] in {
        "sqrt(T)",
        "sqrt(T_0)",
        "sqrt(1)",
        "sqrt(0)",
        "sqrt(w)",
    }
    assert small["domain"]["assume"] == ["b < 1"]


@pytest.mark.long
def test_no_verdict_of_a_small_slice_is_false(prover):
    with within(10):
        record = slice_of(0, prover, specs=2, laws=5)
    assert [f for f in record["faults"] if f["kind"] in BAD] == []
    assert sum(n for name, n in record["counts"].items() if name.endswith("PROVED")) > 10
    assert sum(n for name, n in record["counts"].items() if name.endswith("REFUTED")) > 2


@pytest.mark.some(2)
@pytest.mark.parametrize("path", FOUND, ids=lambda path: path.stem)
def test_what_was_found_once_stays_right(path, prover):
    source = path.read_text()
    answer = prover.rows(source)
    assert answer.get("stage") in {None, "load"}  # the values may now be refused
    assert [f for f in verdicts(source, answer, Counter()) if f.kind in BAD] == []


@pytest.mark.parametrize("name", ["difference_of_bounded_speeds", "input_in_the_domain"])
def test_a_law_is_passive_where_the_domain_bounds_what_drives_it(name, prover):
    answer = prover.rows(next(path for path in FOUND if path.stem == name).read_text())
    rows = {(row["id"], row["element"]): row["verdict"] for row in answer["rows"]}
    assert rows["welldef", "damper"] == rows["passive", "damper"] == "PROVED"


@pytest.mark.long
@pytest.mark.parametrize("number", range(1000, 1010))
def test_no_verdict_of_a_slice_is_false(number, prover):
    record = slice_of(number, prover)
    assert [
        (f["kind"], f["seed"], f["id"], f["element"]) for f in record["faults"] if f["kind"] in BAD
    ] == []


def test_the_data_of_a_spec_are_its_text():
    made = draw("1.2", fit)
    assert tomllib.loads(tomli_w.dumps(made.data)) == made.data
