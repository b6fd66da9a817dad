"""How the source looks: documented, in small pieces, and without the calls that run text."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "piezo_sym"
SOURCES = sorted(PACKAGE.rglob("*.py"))
#: Each of them evaluates text, or is too slow for what the derivation does.
FORBIDDEN = {"sympify", "parse_expr", "simplify", "nsimplify", "eval", "exec", "__import__"}
MOST_LINES_OF_A_FILE = 300
MOST_LINES_OF_A_FUNCTION = 40


def forbidden(text: str) -> set[str]:
    """Return the forbidden words that a source uses, and ``except:`` if it catches everything."""
    nodes = list(ast.walk(ast.parse(text)))
    words = {node.id for node in nodes if isinstance(node, ast.Name)}
    words |= {node.attr for node in nodes if isinstance(node, ast.Attribute)}
    words |= {node.name for node in nodes if isinstance(node, ast.alias)}
    bare = any(isinstance(node, ast.ExceptHandler) and node.type is None for node in nodes)
    return (words & FORBIDDEN) | ({"except:"} if bare else set())


def long_functions(text: str, most: int) -> list[str]:
    """Return the functions that have more lines than `most`, docstrings aside."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            doc = node.body[0] if ast.get_docstring(node) is not None else None
            lines = node.end_lineno - node.lineno + 1
            lines -= doc.end_lineno - doc.lineno + 1 if doc else 0
            found += [node.name] if lines > most else []
    return found


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_a_module_is_documented_small_and_safe(path):
    text = path.read_text(encoding="utf-8")
    assert ast.get_docstring(ast.parse(text))
    assert len(text.splitlines()) <= MOST_LINES_OF_A_FILE
    assert long_functions(text, MOST_LINES_OF_A_FUNCTION) == []
    assert forbidden(text) == set()


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("import sympy\nsympy.sympify(x)", "sympify"),
        ("from sympy.parsing.sympy_parser import parse_expr as p", "parse_expr"),
        ("x.simplify()", "simplify"),
        ("f = eval", "eval"),
        ("exec('1')", "exec"),
        ("try:\n    f()\nexcept:\n    pass", "except:"),
    ],
)
def test_a_forbidden_word_is_seen(text, word):
    assert forbidden(text) == {word}


def test_a_long_function_is_seen_without_its_docstring():
    text = 'def f():\n    """One.\n\n    Two.\n    """\n    a = 1\n    return a'
    assert long_functions(text, 2) == ["f"]
    assert long_functions(text, 3) == []
