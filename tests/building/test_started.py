"""Processes that are started look for modules where this one does, and nowhere else."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
STRETCHED = """
[model]
name = "stretched"
[parameters]
m   = { value = 1.0, unit = "kg" }
k   = { value = 1.0, unit = "N/m" }
q_0 = { value = 1.0, unit = "m" }
d   = { value = 1.0, unit = "N*s/m" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0, unit = "J/K" }
[domain]
assume = ["d >= 0", "q_0 > 0"]
[elements]
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k*cosh(q/q_0)", state = "q" }
mass   = { kind = "mass", at = "tip", mass = "m", state = "p" }
damper = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }
body   = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""


def started(words, folder, **environment):
    """Run Python in a folder, which is not where it looks for modules."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    command = [sys.executable, "-P", *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


def test_no_process_runs_files_of_the_working_folder(tmp_path):
    (tmp_path / "stretched.toml").write_text(STRETCHED)
    for name in ("json", "signal", "sympy", "report"):
        (tmp_path / f"{name}.py").write_text(f"open('{name}.ran', 'w')")
    done = started(["-m", "piezo_sym", "show", "stretched.toml"], tmp_path)
    assert [*tmp_path.glob("*.ran")] == []
    assert done.returncode == 0, done.stderr


def test_where_modules_are_looked_for_may_hold_paths(tmp_path):
    """Python passes over them without a word, so they are there."""
    code = (
        "import sys; from pathlib import Path; sys.path.append(Path('.'))\n"
        "from piezo_sym.cli import run; sys.exit(run(['verify', 'oscillator']))"
    )
    done = started(["-c", code], tmp_path)
    assert done.returncode == 0, done.stderr
