import pytest
from stated import PIEZO_STACK, SPECS, mass, refused, run, stated

SOME = {
    "a1_two_bodies",
    "output_resistance_of_a_bank",
    "series_across_a_capacitor",
    "transducer_between_moving_nodes",
    "two_sources_on_one_input",
}


def test_the_shipped_spec_is_confirmed_by_the_program_itself(tmp_path):
    code, out, _ = run(tmp_path, PIEZO_STACK, stated(PIEZO_STACK))
    *lines, last = out.splitlines()
    assert code == 0
    assert [line for line in lines if not line.startswith("confirmed ")] == ["stated program"]
    assert "confirmed passive hysteron" in lines
    count = len(lines) - 1
    assert last == f"{count} of {count} rows confirmed; printed text is not read here"
    assert (code, out) == run(tmp_path, PIEZO_STACK, stated(PIEZO_STACK))[:2]


@pytest.mark.parametrize("path", [p for p in SPECS if p.stem in SOME], ids=lambda p: p.stem)
def test_networks_are_confirmed(path):
    text = path.read_text(encoding="utf-8")
    assert refused(text, stated(text)) == {}


@pytest.mark.long
@pytest.mark.parametrize("path", SPECS, ids=lambda p: p.stem)
def test_every_network_is_confirmed(path):
    text = path.read_text(encoding="utf-8")
    assert refused(text, stated(text)) == {}


@pytest.mark.parametrize(
    "law",
    [
        "a_1*v*(2 + cos(v/v_1))",
        "F_1*(tanh(v/v_1) if v > 0 else exp(v/v_1) - 1)",
        "a_1*v + (sqrt(a/a_1)*a_1*v if a > 0 else 0)",
        "F_1*saturate(v/v_1, 1)*(1 + sin(v/v_1)/2)",
    ],
)
def test_laws_with_functions_and_guards_are_confirmed(law):
    text = mass(law)
    rows = {(row["id"], row["element"]): row["verdict"] for row in stated(text)["obligations"]}
    assert rows["passive", "damper"] == "PROVED"
    assert refused(text, stated(text)) == {}
