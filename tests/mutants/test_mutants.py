"""Each fault in the prover or in the derivation is noticed by the net, the checker or `program`.

``killed.txt`` says by what; ``python -m tests.mutants.driver > tests/mutants/killed.txt`` makes it.
"""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.mutants import claims, encoder, intervals, network
from tests.mutants.driver import LISTS, chosen

KILLED = Path(__file__).with_name("killed.txt")
ROOT = Path(__file__).parents[2]
MUTANTS = {
    name: module.MUTANTS
    for name, module in zip(LISTS, (encoder, claims, intervals, network), strict=True)
}
NOTICE = {"net", "checker", "program"}
#: Of so many mutants of a list one is run each time.
EVERY = 50


def rows():
    return [line.split(" | ") for line in KILLED.read_text(encoding="utf-8").splitlines()]


def run(every, *names):
    command = (sys.executable, "-m", "tests.mutants.driver", *names, "--every", str(every))
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def recorded(every, *names):
    found = []
    for name in names:
        known = [line for line in lines() if line.startswith(f"{name} | ")]
        by_mutant = dict(zip(MUTANTS[name], known, strict=True))
        found += [by_mutant[mutant] for mutant in chosen(MUTANTS[name], every, "")]
    return found


def lines():
    return KILLED.read_text(encoding="utf-8").splitlines()


def test_every_mutant_does_harm_and_is_killed():
    found = rows()
    assert [(row[0], row[2]) for row in found] == [
        (name, mutant.name) for name, mutants in MUTANTS.items() for mutant in mutants
    ]
    for *_, harm, killers in found:
        assert harm != "-"
        assert NOTICE & set(killers.split(", "))


def test_there_are_forty_of_each_kind():
    assert len(MUTANTS["encoder"]) + len(MUTANTS["claims"]) >= 40
    assert len(MUTANTS["intervals"]) >= 40
    assert len(MUTANTS["network"]) >= 40


def test_every_edit_fits_once():
    for mutants in MUTANTS.values():
        for mutant in mutants:
            path = ROOT / "piezo_sym" / f"{mutant.file}.py"
            mutant.apply(path.read_text(encoding="utf-8"))


@pytest.mark.long
def test_some_mutants_are_killed_as_recorded():
    assert run(EVERY, *LISTS) == recorded(EVERY, *LISTS)


@pytest.mark.long
@pytest.mark.parametrize("name", LISTS)
def test_all_mutants_are_killed_as_recorded(name):
    assert run(1, name) == recorded(1, name)
