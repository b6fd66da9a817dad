"""The exact checks prove what holds, and refuse what was broken by hand, with numbers."""

from dataclasses import replace

import pytest
import sympy as sp

from piezo_sym import PiezoError, derive, load
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse


@pytest.fixture(scope="module")
def iphs():
    return derive(load("piezo_stack"))


def with_system(iphs, **changes):
    return replace(iphs, system=replace(iphs.system, **changes))


def verdicts(iphs):
    return {row.id: row.verdict for row in decide(iphs).rows}


def changed(matrix, row, col, factor):
    """Return a matrix with one entry multiplied, rows and columns by label."""
    place = tuple(
        next(n for n, slot in enumerate(slots) if slot.label == label)
        for slots, label in ((matrix.rows, row), (matrix.cols, col))
    )
    assert place in matrix.full
    return replace(matrix, full={**matrix.full, place: factor * matrix.full[place]})


def test_the_paper_is_proved(iphs):
    report = decide(iphs)
    assert {row.id for row in report.rows} == {
        "skew",
        "casimir",
        "energy",
        "entropy",
        "temperature",
        "welldef",
        "continuous",
        "passive",
        "odd",
        "sigma",
        "exergy",
        "environment",
        "invariant",
        "units",
    }
    assert all(row.verdict is Verdict.PROVED for row in report.rows)
    report.raise_if_not_proved()


@pytest.mark.parametrize("r", [1, 2, 4])
def test_the_written_out_lanes_are_proved_too(iphs, r):
    assert set(verdicts(iphs.expand({"hysteron": r})).values()) == {Verdict.PROVED}


def test_a_transducer_with_two_ratios_is_no_skew_structure(iphs):
    broken = with_system(iphs, J0=changed(iphs.system.J0, "p", "Q_C", 2))
    report = decide(broken)
    skew, energy = report.rows[0], next(row for row in report.rows if row.id == "energy")
    assert skew.verdict is Verdict.REFUTED
    assert "(J0 + J0^T)[p, Q_C]" in skew.reason
    assert energy.verdict is Verdict.REFUTED
    with pytest.raises(PiezoError, match="piezo_stack: skew is REFUTED"):
        report.raise_if_not_proved()


def test_the_witness_of_a_refutation_makes_the_residual_nonzero(iphs):
    broken = with_system(iphs, J0=changed(iphs.system.J0, "Q_C", "phi", 3))
    row = next(row for row in decide(broken).rows if row.id == "energy")
    values = {sp.Symbol(name): sp.Rational(value) for name, value in row.witness.items()}
    system = broken.system
    balance = (system.E.T @ system.rhs - system.y.T @ system.u)[0, 0]
    lanes = {bank: int(row.witness[f"{bank}_count"]) for bank in system.E.lanes.counts}
    written = system.E.lanes.expand(balance, lanes)
    named = {s: values[sp.Symbol(s.name)] for s in written.free_symbols}
    assert sp.expand(written.xreplace(named)) != 0


def test_a_coupling_of_two_lanes_is_found_though_one_lane_hides_it(iphs):
    """Entries +1 for all pairs and -1 for equal lanes cancel at r = 1 alone."""
    J0 = iphs.system.J0
    phi = next(n for n, slot in enumerate(J0.rows) if slot.label == "phi")
    full = {**J0.full, (phi, phi): sp.S.One}
    own = {**J0.own, (phi, phi): -sp.S.One}
    broken = with_system(iphs, J0=replace(J0, full=full, own=own))
    assert broken.system.J0.explicit({"hysteron": 1}) == J0.explicit({"hysteron": 1})
    found = verdicts(broken)
    assert found["skew"] is Verdict.REFUTED
    assert found["energy"] is Verdict.REFUTED


def test_an_entropy_that_drives_the_mechanics_is_no_casimir(iphs):
    J0 = iphs.system.J0
    p, s = (next(n for n, slot in enumerate(J0.rows) if slot.label == x) for x in "pS")
    full = {**J0.full, (p, s): sp.S.One, (s, p): -sp.S.One}
    found = verdicts(with_system(iphs, J0=replace(J0, full=full)))
    assert found["skew"] is Verdict.PROVED
    assert found["casimir"] is Verdict.REFUTED
    assert found["energy"] is Verdict.PROVED
    assert found["entropy"] is Verdict.REFUTED


def test_a_wrong_energy_is_no_hamiltonian(iphs):
    wrong = (iphs.energies[1], *iphs.energies[1:])
    assert verdicts(replace(iphs, energies=wrong))["energy"] is not Verdict.PROVED


@pytest.mark.parametrize("times", [-1, 2])
@pytest.mark.parametrize("row", range(5))
def test_a_costate_other_than_the_energy_s_slope_is_noticed(iphs, row, times):
    """Also where the law that the spec gives the store is the slope."""
    symbol, law = iphs.costates[row]
    wrong = (*iphs.costates[:row], (symbol, times * law), *iphs.costates[row + 1 :])
    assert verdicts(replace(iphs, costates=wrong))["energy"] is not Verdict.PROVED


def test_the_paper_s_y_s_with_dU_dx_breaks_the_entropy_balance(iphs):
    """The paper prints y_s = g^T dU/dx; with it the balance does not close."""
    system = iphs.system
    printed = system.R.T @ system.bracket + (system.g.T @ system.E).T @ system.u
    assert sp.expand((system.dS.T @ system.rhs - printed)[0, 0]) != 0


def test_a_temperature_that_falls_below_zero_is_refuted():
    text = """
    [model]
    name = "odd"
    [parameters]
    T_0 = { value = 300, unit = "K" }
    b = { value = 1, unit = "K**2/J" }
    [elements.body]
    kind = "thermal_mass"
    temperature = "T_0 + b*S"
    """
    row = next(row for row in decide(derive(parse(text))).rows if row.id == "temperature")
    assert row.verdict is Verdict.REFUTED
    mended = "; the condition 'T_0 + b*S_body > 0' in [domain] mends it"
    assert row.reason == "T_0 + b*S_body = 0" + mended
    assert row.witness == {"T_0": "1", "b": "1", "S_body": "-1"}


def test_rows_as_data(iphs):
    rows = [row.as_dict("piezo_stack") for row in decide(iphs).rows]
    assert set(rows[0]) == {"model", "id", "element", "verdict", "witness", "reason"}
    assert [row["element"] for row in rows if row["id"] == "temperature"] == ["body"]
