"""Every test file is collected: no folder has a name that the test runner passes over."""

from fnmatch import fnmatch
from pathlib import Path

TESTS = Path(__file__).parents[1]


def test_every_test_file_is_collected(pytestconfig):
    passed_over = pytestconfig.getini("norecursedirs")
    assert "build" in passed_over
    assert pytestconfig.getini("python_files") == ["test_*.py", "*_test.py"]
    files = list(TESTS.rglob("test_*.py"))
    assert Path(__file__) in files
    for path in files:
        for part in path.relative_to(TESTS).parts[:-1]:
            assert not any(fnmatch(part, pattern) for pattern in passed_over), path


def test_no_two_modules_have_one_name():
    """Folders that are no packages stand side by side on the path: of two the first is found."""
    loose = (p for p in TESTS.rglob("*.py") if not p.with_name("__init__.py").exists())
    names = [p.name for p in loose if p.name != "conftest.py"]
    assert sorted(names) == sorted(set(names))
