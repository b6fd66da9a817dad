"""Large systems: what is printed of them is proved, with work in proportion to their text."""

import pytest

from piezo_sym import derive
from piezo_sym.report import Verdict
from piezo_sym.spec.load import parse
from piezo_sym.translation.program import Reference, different
from tests.benchmarks.test_chain import HEAD, chain
from tests.translation.printed import TEXTS, printed

BUNDLE = """
R = { kind = "resistor", between = ["m", "gnd"], voltage = "rho*i*(1 + (i/i_0)**4)", heats = "b" }
b = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
"""
COIL = 'l{n} = {{ kind = "inductor", between = ["in", "m"], inductance = "L" }}\n'


def bundle(coils):
    """Return inductors that feed one resistor; its law has a power of the sum of all currents."""
    head = HEAD.replace('"d >= 0"', '"d >= 0", "i_0 > 0"')
    return head + BUNDLE + "".join(COIL.format(n=n) for n in range(coils))


def examined(text):
    """Return the texts of a system by language, and it in normal form."""
    iphs = derive(parse(text))
    return printed(iphs), Reference(iphs)


@pytest.fixture(scope="module")
def long_chain():
    return examined(chain(24))


@pytest.mark.long
@pytest.mark.parametrize("language", TEXTS)
def test_a_chain_of_24_is_proved_and_a_mutant_of_it_is_refuted(long_chain, language):
    texts, known = long_chain
    assert different(language, texts[language], known) == ()
    old, new = "alpha_t11*v_m10 - alpha_t11*v_m11", "alpha_t11*v_m10 + alpha_t11*v_m11"
    assert old in texts[language]
    (row,) = different(language, texts[language].replace(old, new, 1), known)
    assert (row.verdict, "rhs['Q_c11']" in row.reason) == (Verdict.REFUTED, True)


@pytest.mark.long
@pytest.mark.parametrize(("family", "sizes"), [(chain, (3, 9)), (bundle, (12, 24))])
def test_work_grows_with_the_text(family, sizes):
    """Work is counted in products of terms and in generators, so that no clock is asked."""
    found = []
    for size in sizes:
        texts, known = examined(family(size))
        assert [different(language, texts[language], known) for language in texts] == [()] * 3
        length = sum(map(len, texts.values()))
        fields = known.system.field, known.stage.field
        work = (sum(f.work for f in fields), sum(len(f.gens) for f in fields))
        found.append([part / length for part in work])
    for short, long in zip(*found, strict=True):
        assert long < 1.6 * short
