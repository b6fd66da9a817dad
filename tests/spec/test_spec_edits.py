"""Random damage to the shipped spec: a model, or one line that says what is wrong."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from spec_laws import steady
from spec_tools import SHIPPED, SLOW, check_message

from piezo_sym import Model, PiezoError
from piezo_sym.spec.load import parse
from tests.clock import within

TOKENS = re.findall(r"\w+|\s+|.", SHIPPED)
WORDS = st.sampled_from(sorted({token for token in TOKENS if token.strip()})) | st.sampled_from(
    [
        "nan",
        "inf",
        "true",
        "-1",
        "0",
        "1e999",
        "[1, 2]",
        "{}",
        '"',
        "'",
        '"""',
        "\n",
        "\x00",
        "#",
        "\u03bb",
        "lambda",
        "self",
        "1/0",
        "degC",
        "T_body",
        "phi_1",
        "elements",
        "[[",
        "]]",
        ".",
    ]
)
PLACES = st.integers(0, len(TOKENS) - 1)


def load_or_one_line(text):
    with within(2 * SLOW):
        try:
            model = parse(text)
        except PiezoError as error:
            check_message(error, place="spec")
        else:
            assert isinstance(model, Model)
            assert parse(model.to_toml()) == model


@steady
@given(PLACES, st.integers(1, 5))
def test_tokens_left_out(at, count):
    load_or_one_line("".join(TOKENS[:at] + TOKENS[at + count :]))


@steady
@given(PLACES, st.integers(1, 30))
def test_tokens_doubled(at, count):
    load_or_one_line("".join(TOKENS[: at + count] + TOKENS[at:]))


@steady
@given(st.lists(st.tuples(PLACES, WORDS), min_size=1, max_size=3))
def test_tokens_replaced(changes):
    tokens = list(TOKENS)
    for at, word in changes:
        tokens[at] = word
    load_or_one_line("".join(tokens))


@steady
@given(PLACES, PLACES)
def test_tokens_exchanged(one, other):
    tokens = list(TOKENS)
    tokens[one], tokens[other] = tokens[other], tokens[one]
    load_or_one_line("".join(tokens))


@pytest.mark.long
@steady
@given(st.integers(0, len(SHIPPED)), st.text(max_size=5))
def test_letters_inserted(at, letters):
    load_or_one_line(SHIPPED[:at] + letters + SHIPPED[at:])


@pytest.mark.long
@steady
@given(st.permutations(SHIPPED.split("\n\n")))
def test_blocks_in_any_order(blocks):
    load_or_one_line("\n\n".join(blocks))


@steady
@given(st.integers(0, len(SHIPPED)))
def test_a_text_cut_short(at):
    load_or_one_line(SHIPPED[:at])


@steady
@given(st.text(max_size=80))
def test_any_text(text):
    load_or_one_line(text)
