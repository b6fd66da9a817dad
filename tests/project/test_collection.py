"""Every test file is collected: no folder has a name that the test runner passes over."""

import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).parents[1]


def test_every_test_file_is_collected():
    words = [
        sys.executable,
        "-m",
        "pytest",
        "--collect-only",
        "-q",
        "-m",
        "long or not long",
        TESTS,
    ]
    listed = subprocess.run(words, capture_output=True, text=True, cwd=TESTS.parent, check=True)
    found = {Path(line.partition("::")[0]).name for line in listed.stdout.splitlines()}
    assert {path.name for path in TESTS.rglob("test_*.py")} <= found
