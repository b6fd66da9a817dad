"""Signs of laws that solvers of polynomials cannot decide: one real variable, rigorous intervals.

stage       from -> to                          in
reduce      law -> prefactors * f(s)            a letter in units of parameters
decide      f -> PROVED | REFUTED | OPEN        windows, Taylor series at zeros, both ends
enclosures  tree, window -> interval and jet    intervals, jets, recentre
"""

from piezo_sym.proofs.signs.decide import Decision, Domain, decide_sign
from piezo_sym.proofs.signs.reduce import Reduction, reduce

__all__ = ["Decision", "Domain", "Reduction", "decide_sign", "reduce"]
