"""The process in which systems are examined ends in time, and says what was not decided."""

import pickle

import pytest

from piezo_sym import PiezoError, derive, load, verify
from piezo_sym.errors import SpecError
from piezo_sym.processes import Worker
from piezo_sym.proofs import Report, Verdict
from piezo_sym.spec.load import parse
from piezo_sym.verification import process
from piezo_sym.verification.process import examined_model, messages
from tests.proofs.test_false_proofs import MASS


@pytest.fixture
def examiner():
    made = Worker("-m", "piezo_sym.verification.worker", group=True)
    yield made
    made.close()


def test_a_report_is_that_of_the_system():
    """The system itself is sent, not its spec: an edited one is seen as it is."""
    iphs = derive(load("piezo_stack"))
    report = verify(iphs)
    assert report.proved
    assert {row.points >= 100_000 for row in report.rows if row.id == "passive"} == {True}
    assert pickle.loads(pickle.dumps(iphs)).system.rhs == iphs.system.rhs


def test_what_takes_too_long_is_stopped_and_the_next_one_is_answered(examiner):
    model = load("piezo_stack")
    assert list(messages(examiner, model, 0.01)) == ["not decided in 0.01 s"]
    assert {type(message) for message in messages(examiner, model, 60.0)} == {Report}


def test_what_is_not_decided_in_time_is_open(monkeypatch):
    monkeypatch.setattr(process, "PATIENCE", 0.01)
    report = examined_model(load("piezo_stack"))
    assert not report.proved
    assert {row.verdict for row in report.rows} == {Verdict.OPEN}
    assert "not decided in 0.01 s" in report.rows[0].reason


def test_an_error_of_the_derivation_comes_back_as_it_is(examiner):
    broken = parse(
        MASS.format(parameters="", domain="", elements="", force="m*v*0").replace(
            'at = "tip"', 'at = "tap"'
        )
    )
    with pytest.raises(PiezoError) as wanted:
        derive(broken)
    (error,) = messages(examiner, broken, 60.0)
    assert isinstance(error, PiezoError)
    assert str(error) == str(wanted.value)


def test_errors_with_all_their_parts_can_be_sent():
    error = SpecError("what", "where", expected="this", remedy="that")
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


SLOW = {
    "a tower of exponentials": "m*v*exp(exp(exp(exp(exp(v/v_1)))))",
    "an exponential of one": "-F_1*v/v_1*exp(exp(1e9*v/v_1))",
}


@pytest.mark.some(1)
@pytest.mark.parametrize("name", SLOW)
def test_laws_that_once_hung_end(name):
    parameters = 'v_1 = { value = 1.0, unit = "m/s" }\nF_1 = { value = 1.0, unit = "N" }'
    force = SLOW[name].replace("m*v", "F_1*v/v_1")
    text = MASS.format(
        parameters=parameters, domain='"v_1 > 0", "F_1 > 0"', elements="", force=force
    )
    report = examined_model(parse(text))
    verdicts = {(row.id, row.element): row.verdict for row in report.rows}
    if force.startswith("-"):
        assert verdicts["passive", "damper"] is not Verdict.PROVED
