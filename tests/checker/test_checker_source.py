import ast
import io
import sys
import tokenize

import pytest
from stated import CHECKER

MOST_LINES = 1880
ALLOWED = {"cvc5", "flint", "pint", *sys.stdlib_module_names}
SOURCES = sorted(CHECKER.glob("*.py"))


def imported(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (name.name.partition(".")[0] for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield "" if node.level == 1 else (node.module or "..").partition(".")[0]


def lines_of_code(text):
    """Return how many lines have code: not blank, no comment, no docstring."""
    idle = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT}
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    found = {n for t in tokens if t.type not in idle for n in range(t.start[0], t.end[0] + 1)}
    for node in ast.walk(ast.parse(text)):
        body = getattr(node, "body", None)
        first = body[0] if isinstance(body, list) and body else None
        if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
            found -= set(range(first.lineno, first.end_lineno + 1))
    return len(found) - 1  # the end of the file is a token


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.stem)
def test_the_checker_shares_nothing_with_the_package(path):
    names = set(imported(ast.parse(path.read_text(encoding="utf-8"))))
    assert names - {""} <= ALLOWED


def test_the_checker_stays_small():
    assert sum(lines_of_code(path.read_text(encoding="utf-8")) for path in SOURCES) <= MOST_LINES


def test_lines_of_code_are_counted():
    text = '"""One\ntwo."""\n\n# three\na = (\n    1,\n)\n\n\n'
    text += 'def f():\n    """Four."""\n    return a\n'
    assert lines_of_code(text) == 5


def test_an_import_of_the_package_would_be_seen():
    tree = ast.parse("from piezo_sym.spec import load\nfrom ..spec import load\nimport os.path")
    assert [*imported(tree)] == ["piezo_sym", "spec", "os"]
