"""The shipped spec's text, edits of it, and what every refusal must be like."""

import pint  # noqa: F401  # it loads slowly, and first here: no refusal is timed with that
import pytest

from piezo_sym import PiezoError
from piezo_sym.expressions.parse import parse_law
from piezo_sym.spec.load import parse
from piezo_sym.spec.source import MODELS
from tests.clock import within

SHIPPED = (MODELS / "piezo_stack.toml").read_text(encoding="utf-8")
SLOW = 2.0  # of processor time


def edited_text(*pairs):
    """Return the shipped text with each old part, which must be there once, replaced."""
    text = SHIPPED
    for old, new in pairs:
        assert text.count(old) == 1, f"{old!r} occurs {text.count(old)} times"
        text = text.replace(old, new)
    return text


def edited(*pairs):
    return parse(edited_text(*pairs))


def refusal(call, *args):
    """Return the error with which a call is refused, after checking that it is a good one."""
    with within(SLOW), pytest.raises(PiezoError) as caught:
        call(*args)
    check_message(caught.value)
    return caught.value


def check_message(error, place=""):
    message = str(error)
    assert message.startswith(place)
    assert message.isprintable()
    assert len(message) < 800
    assert error.where
    assert error.expected or error.remedy


def refused_law(text):
    error = refusal(parse_law, text, "elements.damper.force")
    assert str(error).startswith("elements.damper.force: ")
    return str(error)


def refused_edit(*pairs):
    return str(refusal(edited, *pairs))


MINIMAL = """
[model]
name = "slider"

[parameters]
m = { value = 2, unit = "kg" }

[elements.body]
kind = "mass"
at = "tip"
mass = "m"
"""
