"""Initial values of stores that are joined, and what may be said of their states."""

import pytest
import sympy as sp
from test_rigid_couplings import CASES, HEAD, meant

from piezo_sym import PiezoError, derive, simulate, verify
from piezo_sym.spec.load import parse

LEVER, SPRINGS = CASES["two masses on a lever"].elements, CASES["springs in series"].elements


def started(elements, start):
    iphs = derive(parse(HEAD.replace("START", start) + elements))
    return dict(zip([s.name for s in iphs.x], iphs.starts, strict=True)), iphs


@pytest.mark.parametrize(
    ("elements", "start", "state", "total"),
    [
        (LEVER, "", "p", "0"),
        (LEVER, 'p = "m_1*l_1/k*d"\np_m2 = "m_2/n*l_1/k*d"', "p", "(m_1 + m_2/n**2)*l_1*d/k"),
        (
            LEVER,
            'p = "m_1"\np_m2 = "0.99999999999*m_2/n"',
            "p",
            "m_1 + 99999999999*m_2/n**2/10**11",
        ),
        (SPRINGS, "", "q", "0"),
        (SPRINGS, 'q = "l_1"\nq_s2 = "l_2"', "q", "l_1 - l_2"),
        (SPRINGS, 'q = "l_1 + l_1/k"\nq_s2 = "l_2 - l_1/k_2"', "q", "l_1 - l_2 + l_1/k + l_1/k_2"),
    ],
)
def test_initial_values_enter_by_the_states_of_all(elements, start, state, total):
    found, iphs = started(elements, start)
    ((law,),) = (found[state],)
    assert (
        sp.nsimplify(sp.simplify(iphs.symbols.law(law, {}) - meant(total, iphs)), tolerance=1e-12)
        == 0
    )


@pytest.mark.parametrize(
    ("elements", "start", "fault"),
    [
        (LEVER, "p = 2.6", "initial.p_m2: 'm2' is joined, and starts with v_m2 = 0; expected"),
        (LEVER, "p_m2 = 1.0", "initial.p_m2: 'm2' is joined, and starts with v_m2 = 1.42857"),
        (SPRINGS, "q = 0.0", "initial.q_s2: 's2' is joined, and starts with F_s2 = 1.8; expected"),
        (
            SPRINGS,
            'q = "l_1"',
            "initial.q_s2: 's2' is joined, and starts with F_s2 = 1.8; expected",
        ),
    ],
)
def test_initial_values_that_disagree_are_refused_and_their_remedy_is_right(elements, start, fault):
    with pytest.raises(PiezoError, match="initial") as caught:
        started(elements, start)
    assert str(caught.value).startswith(fault)
    name, value = caught.value.remedy.removeprefix("give ").split(" = ")
    kept = [line for line in start.splitlines() if not line.startswith(name)]
    started(elements, "\n".join([*kept, f"{name} = {value}"]))


def test_what_uses_the_state_of_a_store_that_is_not_kept_is_refused():
    text = HEAD.replace("START", "").replace('"a > 0"', '"a > 0", "p_m2*d < F_0*m_2"')
    with pytest.raises(PiezoError, match=r"assume.*'p_m2' is joined into 'p'") as caught:
        derive(parse(text + LEVER))
    assert "write it with 'p'" in caught.value.remedy


def test_a_joined_state_takes_a_condition():
    text = HEAD.replace("START", "").replace('"a > 0"', '"a > 0", "p*d < F_0*m_2"')
    iphs = derive(parse(text + LEVER))
    verify(iphs).raise_if_not_proved()


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("elements", "state", "joined"),
    [
        (SPRINGS, "q_s2", "q = (q of s1) - (q_s2 of s2)"),
        (LEVER, "p_m2", "p = (p of m1) + (p_m2 of m2)/n"),
    ],
)
def test_a_run_says_of_a_joined_state_which_one_there_is(elements, state, joined):
    model = parse(HEAD.replace("START", "") + elements)
    with pytest.raises(PiezoError) as caught:
        simulate(model, duration=1e-3, initial={state: 1e-3})
    assert str(caught.value) == (
        f"simulate.initial: unknown name '{state}'; it is joined: {joined}"
    )


def test_a_run_says_of_another_unknown_state_which_ones_there_are():
    model = parse(HEAD.replace("START", "") + SPRINGS)
    with pytest.raises(PiezoError, match="unknown name 'q_s'; known: S, q"):
        simulate(model, duration=1e-3, initial={"q_s": 1e-3})
