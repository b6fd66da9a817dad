"""A table between plain numbers: nothing asks whether it has a value, and it is continuous."""

from pathlib import Path

from piezo_sym import derive
from piezo_sym.proofs import decide
from piezo_sym.spec.load import parse

SPEC = Path(__file__).parents[1] / "networks" / "specs" / "transducer_between_moving_nodes.toml"


def test_a_ratio_by_a_table_of_plain_numbers_is_continuous():
    text = SPEC.read_text(encoding="utf-8")
    text = text.replace('ratio = "a*T/T_0"', 'ratio = "a*table(T*bb, 0, 0, 1, 1, 2, 3)"')
    text = text.replace("[parameters]", '[parameters]\nbb = { value = 0.003, unit = "1/K" }')
    rows = {(row.id, row.element): row.verdict.value for row in decide(derive(parse(text))).rows}
    assert rows["continuous", "stack"] == "PROVED"
