"""Irreversible port-Hamiltonian systems: Definition 1 of the paper, and its display."""

from piezo_sym.iphs.iphs import IPHS, Process, iphs_of

__all__ = ["IPHS", "Process", "iphs_of"]
