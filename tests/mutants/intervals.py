"""Faults in intervals, jets, windows, and in how laws are reduced to one variable."""

from tests.mutants.mutant import mutants_of
from tests.mutants.specs import spec_of

MUTANTS = mutants_of(
    r"""
## proofs/signs/intervals
exp is at least what it is at the right end
  - _at(min(a.lo, most), record)
  + _at(min(a.hi if record.name == "exp" else a.lo, most), record)
  = F_1*(v/v_1)*(exp(v/v_1) - 7.4) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
exp does not grow to infinity
  - return low, high
  + return low, high if a.hi <= most or record.name != "exp" else _up(_at(a.lo, record))
  = F_1*v/v_1*(3 - exp(v/(1000000*v_1))) | F_1 > 0; v_1 > 0
log is at least what it is at the right end
  - _at(min(a.lo, most), record)
  + _at(min(a.hi, 1e9) if record.name == "log" else min(a.lo, most), record)
  = F_1*(v/v_1)*(log(v/v_1) - 0.7) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
tanh is at least what it is at the right end
  - _at(min(a.lo, most), record)
  + _at(min(a.hi, 9.0) if record.name == "tanh" else min(a.lo, most), record)
  = F_1*(v/v_1)*(tanh(v/v_1) - 0.965) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
log is at most what it is at the left end
  - _at(max(a.hi, -most), record)
  + _at(max(a.lo, 1e-9) if record.name == "log" else max(a.hi, -most), record)
  = F_1*(v/v_1)*(5.5 - log(1 + (v/v_1)**2)) if abs(v) <= 16*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
one trough alone is not seen
  - return math.ceil(first) <= math.floor(last)
  + return math.ceil(first) < math.floor(last)
  = F_1*(v/v_1)*(0.99 + sin(abs(v/v_1))) if abs(v) < 5.5*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
a product lies between two of its corners
  - corners = [(x, y) for x in (a.lo, a.hi) for y in (b.lo, b.hi)]
  + corners = [(a.lo, b.lo), (a.hi, b.hi)]
  = F_1*(v/v_1)*(exp(v/v_1) - 9.025)*(exp(v/v_1) - 11.02) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0;
  = v_1 > 0
a sum is at least one left and one right end
  - interval(_sum(a.lo, b.lo, -INF), _sum(a.hi, b.hi, INF), apart)
  + interval(_sum(a.lo, min(b.hi, 1e3), -INF), _sum(a.hi, b.hi, INF), apart)
  = F_1*(v/v_1)*(exp(v/v_1) + v/v_1 - 9.4) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
an inverse is at least that of the left end
  - max(0.0, math.nextafter(1 / a.hi, -INF))
  + max(0.0, math.nextafter(1 / max(a.lo, 1e-9), -INF))
  = F_1*(v/v_1)*(1/(1 + exp(v/(8*v_1))) - 0.12) if v <= 16*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
abs reaches zero nowhere
  - interval(0.0, max(-a.lo, a.hi), a.nonzero)
  + interval(min(-a.lo, a.hi), max(-a.lo, a.hi), a.nonzero)
  = F_1*(v/v_1)*(abs(exp(v/v_1) - 9) - 0.01) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
a root is at least that of the right end
  - low = a.lo if a.lo in (0, -INF) else _down(function(arb(a.lo)))
  + low = a.lo if a.lo in (0, -INF) else _down(function(arb(min(a.hi, 1e9))))
  = F_1*(v/v_1)*(sqrt(1 + exp(v/v_1)) - 2.9) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
## proofs/signs/jets
tanh rises everywhere as at zero
  - for m, s in enumerate(slopes, start=1)
  + for m, s in enumerate((iv.ONE, *slopes[1:]) if function == "tanh" else slopes, start=1)
  = F_1*(tanh(v/v_1) - 0.9*v/v_1) if abs(v) <= 0.625*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
## proofs/signs/enclosures
what rises is above its right end
  - return iv.narrowed(part, first.lo, last.hi, nonzero=above)
  + return iv.narrowed(part, last.lo, last.hi, nonzero=above)
  = F_1*(v/v_1)*(exp(v/v_1) - 7.4) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
what falls is above its left end
  - return iv.narrowed(part, last.lo, first.hi, nonzero=below)
  + return iv.narrowed(part, first.lo, first.hi, nonzero=below)
  = F_1*(v/v_1)*(8800000 - exp(v/v_1)) if v <= 16*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
what may rise rises
  - if slope.lo >= 0:
  + if slope.hi >= 0:
  = F_1*(v/v_1)*(exp(v/v_1 - 0.37) - 2.7184*(v/v_1 - 0.37)) | F_1 > 0; v_1 > 0
an end at infinity is the other end
  - () if window.hi == INF else _variable(iv.rational(Fraction(window.hi)), order),
  + _variable(iv.rational(Fraction(window.lo if window.hi == INF else window.hi)), order),
  = F_1*(v/v_1)*(16.2 - log(v/v_1)) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
what may be above zero is
  - if a.lo >= 0 and a.nonzero:
  + if a.hi > 0:
  = F_1*(v/v_1)*(5 if v > 1.26*v_1 else exp(v/v_1 - 0.255) - 2.71829*(v/v_1 - 0.255)) | F_1 > 0;
  = v_1 > 0
the smaller of two is the first if it may be
  - if difference[0].lo >= 0:
  -         return a
  + if difference[0].hi >= 0:
  +         return a
  = F_1*(v/v_1)*min(1, exp(v/v_1) - 7.4) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
the smaller of two is at least the larger of their least
  - return iv.interval(max(a.lo, b.lo), max(a.hi, b.hi))
  + return iv.interval(min(a.lo, b.lo), min(a.hi, b.hi))
  = F_1*(v/v_1)*min(1, exp(v/v_1) - 7.4) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
abs of what may be below zero is below
  - if z.inner[0].hi <= 0:
  -         return _minus(z)
  + if z.inner[0].lo <= 0:
  +         return _minus(z)
  = F_1*(v/v_1)*(8800000 - abs(exp(v/v_1) - 9000)) if v <= 16*v_1 else F_1*v/v_1 | F_1 > 0;
  = v_1 > 0
sign is never below zero
  - return Enclosure((iv.interval(0.0 if at.lo >= 0 else -1.0,
  + return Enclosure((iv.interval(0.0,
  = F_1*(v/v_1)*(sign(exp(v/v_1) - 9) + 0.5) if v > 2*v_1 else F_1*v/v_1 | F_1 > 0; v_1 > 0
## proofs/signs/decide
only one side of zero is looked at
  - for side in (-1, 1):
  -         decision, budget
  + for side in (-1, -1):
  +         decision, budget
  = F_1*(v/v_1)*(exp(v/v_1 - 0.37) - 2.7184*(v/v_1 - 0.37)) | F_1 > 0; v_1 > 0
what may be above zero is shown to be
  - if found and found[0].lo >= 0:
  + if found and found[0].hi >= 0:
  = F_1*(v/v_1)*(exp(v/v_1 - 0.37) - 2.7184*(v/v_1 - 0.37)) | F_1 > 0; v_1 > 0
the right half of a window is not covered
  - pieces += [(middle, b), (a, middle)]
  -         elif
  + pieces += [(a, middle)]
  +         elif
  = F_1*(v/v_1)*(exp(v/v_1 - 0.37) - 2.7184*(v/v_1 - 0.37)) | F_1 > 0; v_1 > 0
a window that is not decided is shown
  - if undecided:
  + if not shown:
  = F_1*(v/v_1)*(exp((v/v_1)**2/2) - 2.71828182846*(v/v_1)**2/2) | F_1 > 0; v_1 > 0
a ray left open is shown
  - reasons += [decision.reason] if decision.verdict is Verdict.OPEN else []
  + reasons += []
  = F_1*(v/v_1)*(exp((v/v_1)**2/2) - 2.71828182846*(v/v_1)**2/2) | F_1 > 0; v_1 > 0
one side of a point where a law touches zero
  - return both if len(both) == len(shown) else None
  + return both
  = F_1*(v/v_1)*(exp((v/v_1)**2/2) - 2.71828182846*(v/v_1)**2/2) | F_1 > 0; v_1 > 0
## proofs/signs/shift
both sides of a point are the right one
  - return _written((centre, Fraction(side)))
  + return _written((centre, Fraction(1)))
  = F_1*(v/v_1)*(exp(-v/v_1 - 0.37) - 2.7184*(-v/v_1 - 0.37)) | F_1 > 0; v_1 > 0
a threshold is on the other side of zero
  - difference = recentred(Add((left, Neg(right))), centre, side)
  + difference = recentred(Add((left, right)), centre, side)
  = F_1*(v/v_1)*(5 if v < -2*v_1 else exp(v/v_1 - 0.37) - 2.7184*(v/v_1 - 0.37)) | F_1 > 0;
  = v_1 > 0
## proofs/signs/reduce
what a letter is divided by keeps its sign
  - if found.bound == Sym(letter) and found.free and plain.is_positive(found.free):
  + if found.bound == Sym(letter) and found.free and found.free:
  = F_2*(v*a_1*a/F_1**2*(exp(v*a_1*a/F_1**2) - 7.38*(v*a_1*a/F_1**2 - 1))) | F_1 > 0;
  = F_2 > 0; a_1 > 0
what a letter is divided by is positive
  - if found.bound == Sym(letter) and found.free and plain.is_positive(found.free):
  + if found.bound == Sym(letter) and found.free:
  = F_1*(v*a/F_1*(exp(v*a/F_1) - 7.38*(v*a/F_1 - 1))) | F_1 > 0
every name is a unit
  - for name in free if positive(name)]
  + for name in free]
  = F_1*(v/v_2*(exp(v/v_2) - 7.38*(v/v_2 - 1))) | F_1 > 0; v_2**2 > 0 | v_2=-1.0
a product is positive by one factor
  - return all(map(self.positive, powers))
  + return any(map(self.positive, powers))
  = F_1*(v*a_1/(v_1*a)*(exp(v*a_1/(v_1*a)) - 7.38*(v*a_1/(v_1*a) - 1))) | F_1 > 0; v_1 > 0; a_1
  = > 0; a**2 > 0
factors in front are dropped
  - prefactors = (*front, *free, *outside)
  + prefactors = (*free, *outside)
  = (1000*a_1 - a)*v_1*(v/v_1*(exp(v/v_1) - 7.38*(v/v_1 - 1))) | a_1 > 0; v_1 > 0 | a=2000.0
## proofs/signs/cases
what is in no group is dropped
  - return None if left else groups
  + return groups
  = F_1*(v/v_1*(exp(v/v_1) - 7.38*(v/v_1 - 1))) + d*v - F_2/1000*tanh(v/v_1 + v/v_2) | F_1 > 0;
  = d > 0;
  = F_2 > 0; v_1 > 0; v_2 > 0 | F_2=9000.0
a product's choice is taken the other way round
  - If(_product(left, inner.then), inner.condition, _product(left, inner.other))
  + If(_product(left, inner.other), inner.condition, _product(left, inner.then))
  = F_1*(v/v_1)*(1 if v > 2*v_1 else exp(v/v_1 - 0.37) - 2.7184*(v/v_1 - 0.37)) | F_1 > 0; v_1 > 0
## proofs/signs/shift
what has a value at a point is zero there
  - return _value(tree, at) == 0
  + return _value(tree, at) is not None
  = F_1*(log(1 + exp(v/v_1)) - log(2) - 1e-40) | F_1 > 0; v_1 > 0
## proofs/signs/cases
only where a choice holds
  - for holds in (True, False):
  -         guard
  + for holds in (True,):
  +         guard
  = F_1*(log(1 + exp(v/v_1)) - log(2)) if a > 0 else
  = F_1*(v/v_1)*(exp(v/v_1 - 0.37) - 2.7184*(v/v_1 - 0.37)) | F_1 > 0; v_1 > 0
a guard holds on both sides
  - guard = choice if holds else opposite(choice)
  + guard = choice
  = F_1*(v/v_1*(exp(v/v_1) - 7.38*(v/v_1 - 1))) if a > 0 else
  = (a + 1000*a_1)*v_1*(v/v_1*(exp(v/v_1) - 7.38*(v/v_1 - 1))) | F_1 > 0; v_1 > 0; a_1 > 0 |
  = a=-2000.0
the sides of a choice are swapped
  - decided(law, {choice: holds})
  + decided(law, {choice: not holds})
  = (1000*a_1 + a)*v_1*(v/v_1*(exp(v/v_1) - 7.38*(v/v_1 - 1))) if a <= 0 else
  = F_1*(v/v_1*(exp(v/v_1) - 7.38*(v/v_1 - 1))) | F_1 > 0; v_1 > 0; a_1 > 0 | a=-2000.0
""",
    spec_of,
)
