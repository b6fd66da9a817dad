"""Random and damaged texts of laws: a tree, or one refusal."""

from hypothesis import given
from hypothesis import strategies as st
from spec_laws import laws, steady
from spec_tools import refusal

from piezo_sym.errors import SpecError
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Expr

PIECES = st.sampled_from(
    [
        "i",
        "T",
        "v_1",
        "1",
        "0.5",
        "1e3",
        "+",
        "-",
        "*",
        "/",
        "**",
        "(",
        ")",
        ",",
        " ",
        "<",
        ">=",
        "if",
        "else",
        "exp",
        "deadzone",
        "sqrt",
        "lambda",
        ":",
        "=",
        ".",
        "[",
        "]",
        "'",
        "@",
        "0",
        "not",
        "and",
        "for",
        "in",
        "None",
        "\n",
        "\u03b1",
        "_",
        "e",
        "(i)",
        "exp(",
        "1 if i<1 else ",
    ]
)


def only_refused_as_a_spec_error(text):
    try:
        tree = parse_law(text, "law")
    except SpecError:
        assert str(refusal(parse_law, text, "law")).startswith("law: ")
    else:
        assert isinstance(tree, Expr)


@steady
@given(st.text(max_size=60))
def test_any_text_is_a_law_or_refused(text):
    only_refused_as_a_spec_error(text)


@steady
@given(st.lists(PIECES, max_size=14).map("".join))
def test_any_pieces_are_a_law_or_refused(text):
    only_refused_as_a_spec_error(text)


@steady
@given(st.lists(PIECES, max_size=14).map(" ".join))
def test_any_words_are_a_law_or_refused(text):
    only_refused_as_a_spec_error(text)


@steady
@given(laws(), st.data())
def test_a_damaged_law_is_a_law_or_refused(tree, data):
    text = spell(tree)
    at = data.draw(st.integers(0, len(text)))
    drop = data.draw(st.integers(0, 3))
    only_refused_as_a_spec_error(text[:at] + data.draw(PIECES) + text[at + drop :])
