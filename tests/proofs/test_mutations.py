"""Laws with slips in them: no verdict on any of them is contradicted by looking at the law itself.

Edits come from a fixed grammar with a fixed seed; the oracle is a dense search (`law_oracle`).
"""

import random
from collections import Counter
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from piezo_sym import PiezoError, derive
from piezo_sym.proofs import Verdict, obligations, prove
from piezo_sym.proofs.solvers import opinions
from piezo_sym.spec.load import parse
from tests.proofs import law_oracle as oracle
from tests.proofs.law_edits import BASES, LETTER, VALUES, law, mutant

SPEC = """
[model]
name = "m"
[parameters]
{parameters}
T_1 = {{ value = 300.0, unit = "K" }}
L = {{ value = 1.0, unit = "H" }}
c = {{ value = 1.0, unit = "J/K" }}
[inputs]
V = {{ unit = "V" }}
[domain]
assume = [{domain}]
[elements]
src = {{ kind = "voltage_source", between = ["in", "gnd"], input = "V" }}
h = {{ kind = "hysteron", between = ["in", "gnd"], inductance = "L", voltage = "{law}", \
heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "T_1*exp(S/c)" }}
"""
PARAMETERS = "\n".join(f'{n} = {{ value = {v}, unit = "1" }}' for n, v in VALUES.items())
PROPERTIES = ("welldef", "continuous", "passive", "odd")


@cache
def verdicts(made):
    """Return the rows about the law, or None if the spec is refused."""
    domain = ", ".join(f'"{text}"' for text in made.domain)
    text = SPEC.format(parameters=PARAMETERS, domain=domain, law=made.text)
    try:
        iphs = derive(parse(text))
    except PiezoError:
        return None
    rows = []
    for obligation in obligations(iphs):
        asked = obligation.element == "h" and obligation.id in PROPERTIES
        if asked or obligation.id == "temperature":
            rows.append(prove(obligation, iphs, rows, opinions()))
    return {row.id: row for row in rows if row.element == "h"}


def contradiction(made, row):
    """Return how looking at the law contradicts a verdict on it, or None."""
    seed = np.random.default_rng(list(made.text.encode()))
    witness = {name: Fraction(text) for name, text in (row.witness or {}).items()}
    if row.verdict is Verdict.OPEN:
        return None
    with np.errstate(all="ignore"):
        points = oracle.Points(made.names, made.conditions, seed)
        if row.verdict is Verdict.PROVED:
            return SEARCH[row.id](made, points, seed)
        whole = points.completed(witness)
        broken = (BREAKS[row.id](made, values, seed) for values in whole)
        return None if any(broken) else "the witness breaks nothing"


def breaks_passive(made, witness, _):
    exact = oracle.rational(made.tree, witness)
    if exact is not None and exact * witness[LETTER] >= 0:
        return False
    near = oracle.is_negative(made.tree, LETTER, witness)
    values = {name: np.array([float(value)]) for name, value in witness.items()}
    coarse = oracle.floats(made.tree, values)[0] * float(witness[LETTER])
    return near and (coarse < 0 or not np.isfinite(coarse))


BREAKS = {
    "welldef": lambda made, witness, _: not oracle.has_value(made.tree, witness),
    "continuous": lambda made, witness, seed: (
        not oracle.has_value(made.tree, witness)
        or oracle.jumps_at(made.tree, made.conditions, witness, seed)
    ),
    "passive": breaks_passive,
    "odd": lambda made, witness, _: oracle.is_not_odd(made.tree, LETTER, witness),
}
SEARCH = {
    "welldef": lambda made, points, _: oracle.without_value(made.tree, points),
    "continuous": lambda made, points, seed: oracle.jump(made.tree, points, seed),
    "passive": lambda made, points, _: oracle.most_negative(made.tree, LETTER, points),
    "odd": lambda made, points, _: oracle.not_odd(made.tree, LETTER, points),
}


def looked_at(count, seed):
    """Look at so many mutants; return the count of verdicts, what is open, what is wrong."""
    draw, counts, still_open, wrong, seen = random.Random(seed), Counter(), [], [], set()
    refused = 0
    while len(seen) < count:
        made = mutant(draw)
        if made in seen:
            continue
        rows = verdicts(made)
        if rows is None:
            refused += 1
            continue
        seen.add(made)
        for row in rows.values():
            counts[row.id, row.verdict.value] += 1
            if row.verdict is Verdict.OPEN and "it rests on" not in row.reason:
                still_open.append((made, row.id, row.reason))
            found = contradiction(made, row)
            if found is not None:
                wrong.append((made, row, found))
    return counts, still_open, wrong, refused


def check(count, seed):
    counts, still_open, wrong, refused = looked_at(count, seed)
    print(f"\n{count} mutants, {refused} more were refused as specs")
    for key, number in sorted(counts.items()):
        print(f"  {key[0]:10} {key[1]:8} {number}")
    for made, name, reason in still_open:
        print(f"  open: {name} of {made.text}  [{', '.join(made.domain)}]: {reason}")
    for made, row, found in wrong:
        print(
            f"  WRONG: {row.id} {row.verdict.value} {made.text} [{', '.join(made.domain)}]",
            found,
            row.witness,
        )
    assert wrong == []
    assert len(still_open) <= 0.05 * sum(counts.values())
    for name in PROPERTIES:  # both verdicts were put to the test
        assert counts[name, "PROVED"] > count / 20
        assert counts[name, "REFUTED"] > count / 60


@pytest.mark.long
def test_no_verdict_on_a_slip_is_wrong():
    check(40, "fast")


@pytest.mark.long
def test_no_verdict_on_many_slips_is_wrong():
    check(5000, "long")


SEEN = [  # the oracle is worth something only if it sees what is there
    ("passive", "R*i - 0.001*i**2", "R > 0"),
    ("passive", "R*i if i > -100 else -R*i", "R > 0"),
    ("passive", "R*(i - i_0) if i > i_0 else R*(i + i_0) if i < i_0 else 0", "R > 0, i_0 >= 0"),
    ("continuous", "R*i if i < i_0 else R*i + 0.01", ""),
    ("continuous", "R*i if T > 2*T_0 else a*i", "R > a"),
    ("continuous", "(1 if -2*i < -i_0 else 0) if 2*i > i_0 else 0", ""),
    ("continuous", "1/i if i > 0 else 0", ""),
    ("welldef", "R*i/(T - 2*T_0)", ""),
    ("welldef", "sqrt(i - i_0)", "i_0 > 0"),
    ("odd", "R*i + 0.0001*abs(i)", ""),
]


@pytest.mark.some(3)
@pytest.mark.parametrize(("name", "text", "domain"), SEEN)
def test_the_oracle_sees_what_is_there(name, text, domain):
    made = law(text, domain)
    seed = np.random.default_rng(0)
    points = oracle.Points(made.names, made.conditions, seed)
    with np.errstate(all="ignore"):
        assert SEARCH[name](made, points, seed) is not None
    assert verdicts(made)[name].verdict is Verdict.REFUTED
    assert contradiction(made, verdicts(made)[name]) is None


@pytest.mark.some(6)
@pytest.mark.parametrize("base", BASES, ids=lambda base: base.text)
def test_the_laws_that_slips_are_made_in_are_passive(base):
    rows = verdicts(base)
    assert rows["passive"].verdict is Verdict.PROVED
    assert rows["welldef"].verdict is Verdict.PROVED
    assert contradiction(base, rows["passive"]) is None
