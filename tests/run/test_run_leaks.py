"""Runs keep no memory; measured in a process of its own, whose heap no other test has used."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ALONE = Path(__file__).with_name("leaks_alone.py")


@pytest.mark.long
def test_runs_keep_no_memory():
    options = ["-q", "-p", "no:cacheprovider", "--noconftest"]  # with the libraries of this run
    command = [sys.executable, "-m", "pytest", *options, str(ALONE)]
    done = subprocess.run(
        command, cwd=ALONE.parents[2], capture_output=True, text=True, check=False, timeout=600
    )
    assert done.returncode == 0, done.stdout
    assert re.search(r"^10 passed", done.stdout, re.MULTILINE), done.stdout
