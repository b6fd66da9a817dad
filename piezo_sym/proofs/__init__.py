"""Proofs: obligations on an `IPHS`, and verdicts on them."""

from __future__ import annotations

from piezo_sym.errors import UsageError, quote
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.exact import casimir, energy, entropy, skew, temperature, welldef
from piezo_sym.proofs.report import UNCHECKED, Report, Row, Verdict
from piezo_sym.proofs.units import units

__all__ = ["UNCHECKED", "Report", "Row", "Verdict", "verify"]


def verify(iphs: IPHS) -> Report:
    """Return the verdict on every property of an irreversible port-Hamiltonian system.

    Parameters
    ----------
    iphs : from `derive`.

    Returns
    -------
    Report
        ``.rows``, one a property, and ``.raise_if_not_proved()``.  A verdict is PROVED only for all
        states, inputs and parameters in the domain and for every size of every bank.
    """
    if not isinstance(iphs, IPHS):
        remedy = "derive it first: verify(derive(load('piezo_stack')))"
        raise UsageError(f"{quote(iphs)} is no IPHS", "verify", remedy=remedy)
    balances = (skew(iphs), casimir(iphs), energy(iphs), entropy(iphs))
    rows = (*balances, *temperature(iphs), *welldef(iphs), *units(iphs))
    return Report(iphs.model.name, rows)
