"""Verification: proofs, and what stands between a proof and the word PROVED.

stage         from -> to                                              in
proofs        IPHS -> Report                                          proofs
translation   printed NumPy and C, IPHS -> row ``program``            translation
falsify       generated module, rows -> points that attack each row   falsify
examine       all of them joined, verdict by verdict                  examine
process       all of them in a process that can be stopped            process, worker, protocol
record        verdicts -> Report; rows that take too long come last   record
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from piezo_sym.errors import UsageError, quote
from piezo_sym.verification.process import examined

if TYPE_CHECKING:
    from piezo_sym.iphs import IPHS
    from piezo_sym.report import Report


def verify(iphs: IPHS) -> Report:
    """Return the verdict on every property of an irreversible port-Hamiltonian system.

    Parameters
    ----------
    iphs : from `derive`.

    Returns
    -------
    Report
        ``.rows``, one per property, and ``.raise_if_not_proved()``.  A verdict is PROVED only for
        all states, inputs and parameters in the domain and for every size of every bank, and only
        after an attack by numbers on the generated module found no contradiction; REFUTED comes
        with a witness; all else is OPEN, and says why.  It ends within 30 s for ten elements: what
        is not decided then is OPEN.  A row that takes an eighth of the time that is left comes
        after all others.

    Raises
    ------
    UsageError
        If `iphs` is no `IPHS`.
    ContradictionError
        If a number contradicts a proof, which is a fault of this package; both are shown.
    """
    from piezo_sym.iphs import IPHS

    if not isinstance(iphs, IPHS):
        remedy = "derive it first: verify(derive(load('piezo_stack')))"
        raise UsageError(f"{quote(iphs)} is no IPHS", "verify", remedy=remedy)
    return examined(iphs)
