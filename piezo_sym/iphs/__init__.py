"""Irreversible port-Hamiltonian systems: Definition 1 of the paper, and how it is read."""

from piezo_sym.iphs.iphs import IPHS, Process, iphs_of

__all__ = ["IPHS", "Process", "iphs_of"]
