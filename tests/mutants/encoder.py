"""Faults in how claims are put to solvers: facts, quotients, SMT-LIB, branches."""

from tests.mutants.mutant import mutants_of
from tests.mutants.specs import spec_of

MUTANTS = mutants_of(
    r"""
## proofs/rational
exp: its quadratic bound for all x
  - clause(text, x, y) for text in RECORDS[function].facts
  + clause(text.replace("x < 0 | y >= 1 +", "y >= 1 +"), x, y) for text in RECORDS[function].facts
  = F_1*(v/v_1)*(exp(v/v_1) - 1 - v/v_1 - (v/v_1)**2/2) | F_1 > 0; v_1 > 0
exp: a tangent that is too steep
  - clause(text, x, y) for text in RECORDS[function].facts
  + clause("y >= 1 + x + x" if text == "y >= 1 + x" else text, x, y)
  +             for text in RECORDS[function].facts
  = F_1*(v/v_1)*(exp(v/v_1) - 1 - 2*v/v_1) | F_1 > 0; v_1 > 0
exp: above 1
  - clause(text, x, y) for text in RECORDS[function].facts
  + clause("y > 1" if text == "y > 0" else text, x, y)
  +             for text in RECORDS[function].facts
  = d*v*(exp(v/v_1) - 1/2) | d > 0; v_1 > 0
tanh: below its argument everywhere
  - clause(text, x, y) for text in RECORDS[function].facts
  + clause(text.replace("x < 0 | y <= x", "y <= x") if function == "tanh" else text, x, y)
  +             for text in RECORDS[function].facts
  = F_1*(v/v_1 - tanh(v/v_1)) if v > 0 else F_1*(tanh(v/v_1) - v/v_1) | F_1 > 0; v_1 > 0
tanh: above its argument
  - clause(text, x, y) for text in RECORDS[function].facts
  + clause(text.replace("y*(1 + x) >= x", "y >= x"), x, y) for text in RECORDS[function].facts
  = F_1*(tanh(v/v_1) - v/v_1) if v > 0 else F_1*v/v_1 | F_1 > 0; v_1 > 0
exp: falls
  - yield (*undefined, Cmp(">", x, a), Cmp("<=", y, b))
  + yield (*undefined, Cmp("<", x, a), Cmp("<=", y, b))
  = F_1*(exp(saturate(v, v_1)/v_1) - exp(v/v_1)) if v > 0 else 0*F_1 | F_1 > 0; v_1 > 0
sin: one value wherever it is computed
  - yield (Cmp("!=", x, a), Cmp("=", y, b))
  + yield (Cmp("=", y, b),)
  = F_1*(sin(v/v_1) - sin(v/v_1 - 1)) if v > 0 else 0*F_1 | F_1 > 0; v_1 > 0
sin: positive up to 4
  - clause(text, x, y) for text in RECORDS[function].facts
  + clause(text.replace("x > 3", "x > 4"), x, y) for text in RECORDS[function].facts
  = F_1*sin(min(max(v/v_1, 0), 3.5)) | F_1 > 0; v_1 > 0
sin: a wrong cubic
  - clause(text, x, y) for text in RECORDS[function].facts
  + clause(text.replace("x**3/6", "x**3/7"), x, y) for text in RECORDS[function].facts
  = F_1*(sin(v/v_1) - v/v_1 + (v/v_1)**3/7) | F_1 > 0; v_1 > 0
cos: a parabola that is too high
  - clause(text, x, y) for text in RECORDS[function].facts
  + clause(text.replace("1 - 0.5*x**2", "1 - x**2/3"), x, y) for text in RECORDS[function].facts
  = d*v*(cos(v/v_1) - 1 + (v/v_1)**2/3) | d > 0; v_1 > 0
sin and cos: below zero
  - clause(text, x, y) for text in RECORDS[function].facts
  + clause(text.replace("y <= 1", "y <= 0"), x, y) for text in RECORDS[function].facts
  = d*v*(1/2 - sin(v/v_1)) | d > 0; v_1 > 0
a root is one where it has no value
  - yield (undefined, Cmp("=", *sides))
  + yield (Cmp("=", *sides),)
  = a*v | a_1 > 0; (sqrt(a/a_1) if a > 0 else 1) >= 0
a root is its argument
  - root = power(y, Fraction(exponent.denominator))
  + root = power(y, Fraction(exponent.numerator))
  = d*v*(sqrt(b/a_1) - b/a_1) | d > 0; a_1 > 0; b > 0
a power below zero is one above
  - sides = (root, inside) if exponent > 0 else (mul(root, inside), ONE)
  + sides = (root, inside)
  = d*v*((b/a_1)**(-1/2) - 1) | d > 0; a_1 > 0; b > a_1
log: its tangent from below
  - clause(text, x, y) for text in RECORDS[function].facts
  + clause(text.replace("y*x >= x - 1", "y >= x - 1"), x, y) for text in RECORDS[function].facts
  = d*v*(log(b/a_1) - b/a_1 + 1) | d > 0; a_1 > 0; b > 0

## proofs/rational
a quotient's divisor is never zero
  - undefined = () if _product_of(bottom, nonzero) else (Cmp("=", bottom, ZERO),)
  + undefined = ()
  = d*v*a_1**2/a**2 | d > 0; a_1 > 0; (a_1/a if a > 0 else 1) > 0 | a=1.0
every name is nonzero
  - return name in known
  + return bool(name)
  = d*v*a_1**2/a**2 | d > 0; a_1 > 0; (a_1/a if a > 0 else 1) > 0 | a=1.0
a product is nonzero by one factor
  - _product_of(left, known) and _product_of(right, known)
  + _product_of(left, known) or _product_of(right, known)
  = d*v*a_1**2/a**2 | d > 0; a_1 > 0; b > 0; (a_1**2/(b*a) if a > 0 else 1) > 0 | a=1.0
a comparison cleared of a negative divisor
  - else mul(value.top, value.bottom)
  + else value.top
  = d*v*a_1/a | d > 0; a_1 > 0; a**2 > 0
a sign lost in a quotient
  - return Ratio(neg(inner.top), inner.bottom)
  + return Ratio(inner.top, inner.bottom)
  = -d*v | d > 0
a division by a number multiplies
  - return Ratio(mul(Num(1 / value), a.top), a.bottom)
  + return Ratio(mul(Num(value), a.top), a.bottom)
  = d*v/2 - d*v | d > 0
a divisor dropped
  - return Ratio(mul(a.top, b.bottom), mul(a.bottom, b.top))
  + return Ratio(mul(a.top, b.bottom), mul(a.bottom, b.bottom))
  = d*v*a_1/a | d > 0; a_1 > 0; a**2 > 0
a power of -1 is one of 1
  - return Ratio(top, bottom) if exponent > 0 else Ratio(bottom, top)
  + return Ratio(top, bottom)
  = d*v*((b/a_1)**(-1) - 1) | d > 0; a_1 > 0; b > a_1
a choice's sides swapped as it is cleared
  - If(_top(then), Cmp(op, _top(left), _top(right)), _top(other))
  + If(_top(other), Cmp(op, _top(left), _top(right)), _top(then))
  = a*v | a_1 > 0; (a if b > a_1 else b) > 0; b < a_1/2 | b=0.3
a sum of quotients by each its own divisor
  - add(mul(a.top, b.bottom), mul(b.top, a.bottom))
  + add(mul(a.top, a.bottom), mul(b.top, b.bottom))
  = d*v*(a_1/b - b/a_1) | d > 0; a_1 > 0; b > a_1
a sum of one divisor is its first term
  - add(*(part.top for part in parts))
  + add(*(part.top for part in parts[:1]))
  = d*v - 2*d*v | d > 0
the right side of a quotient's comparison dropped
  - difference = ratio(add(condition.left, neg(condition.right)))
  + difference = ratio(condition.left)
  = d*v if v/v_1 < 1 else 2*d*v | d > 0; v_1 > 0
all values of one function are one symbol
  - symbol = Sym(name(f"{function}_{len(found) + 1}"))
  + symbol = Sym(f"{function}_1")
  = F_1*(exp(v/v_1) - exp(v/v_2)) | F_1 > 0; v_1 > v_2; v_2 > 0 | v_2=0.5
all arguments of one function are one symbol
  - Sym(name(f"{function}_argument_{len(found) + 1}"))
  + Sym(f"{function}_argument_1")
  = F_1*(exp(v/v_1) - exp(v/v_2)) | F_1 > 0; v_1 > v_2; v_2 > 0 | v_2=0.5
an argument is what stands above its divisor
  - simple = isinstance(value.top, Sym | Num) and value.bottom == ONE
  + simple = isinstance(value.top, Sym | Num)
  = F_1*(v/v_1)*(exp(v/v_1) - 1 - 2*v/v_1) | F_1 > 0; v_1 > 0; v_1 > 2 | v_1=3.0
sqrt is a cube root
  - return "root", arg, exponent
  + return "root", arg, exponent * Fraction(2, 3)
  = d*v*(2 - sqrt(b/a_1)) | d > 0; a_1 > 0; b > a_1; b < 8*a_1 | b=6.0

## proofs/query
a claim is asserted, not its opposite
  - f"(assert (not {_comparison(self.claim)}))"
  + f"(assert {_comparison(self.claim)})"
  = a*v | a < 0
a clause says all of its parts
  - f"(or {
  + f"(and {
  = -d*v*log(2 + v**2/v_1**2) | d > 0; v_1 > 0
what is to be above zero may be zero
  - f"(assert (not {_comparison(self.claim)}))"
  + "(assert (not " + _comparison(Cmp(self.claim.op.strip("=") + "=",
  +     self.claim.left, self.claim.right)) + "))"
  = d*v | d > 0; S >= 0 | heat=T_0*(S/c_0)**2
a minus sign is not written
  - return f"(- {_term(arg)})"
  + return _term(arg)
  = -d*v | d > 0
a choice is written the other way round
  - {_term(then)} {_term(other)})
  + {_term(other)} {_term(then)})
  = a*v | a_1 > 0; (a if b > a_1 else b) > 0; b < a_1/2 | b=0.3
the last factor is not written
  - return [*_factors(node.left), *_factors(node.right)]
  + return [*_factors(node.left), *_factors(node.left)]
  = d*v*(a/a_1) | d > 0; a_1 > 0
every power is a square
  - [_term(base)] * exponent.numerator
  + [_term(base)] * 2
  = d*v*(a/a_1)**3 | d > 0; a_1 > 0
a fraction is its numerator
  - else f"(/ {size} {value.denominator})"
  + else size
  = d*v*(0.5 - b/a_1) | d > 0; a_1 > 0; b < a_1; b > 0 | b=0.7

## proofs/branches
abs is its argument
  - rule(record.choices, z, w), Cmp
  + rule(record.choices.replace("else -x", "else x"), z, w), Cmp
  = d*abs(v) | d > 0
sign is never below zero
  - rule(record.choices, z, w), Cmp
  + rule(record.choices.replace("-1", "1"), z, w), Cmp
  = F_1*(v/v_1)*sign(v) | F_1 > 0; v_1 > 0
min is max
  - rule(record.choices, z, w), Cmp
  + rule(record.choices.replace("x if x <= w else w", "w if x <= w else x"), z, w), Cmp
  = min(d, a)*v | d > 0
max is min
  - rule(record.choices, z, w), Cmp
  + rule(record.choices.replace("x if x >= w else w", "w if x >= w else x"), z, w), Cmp
  = -max(d, a)*v | d > 0; a < 0
a dead zone is moved to the wrong side
  - rule(record.choices, z, w), Cmp
  + rule(record.choices.replace("x - w if", "x + w if"), z, w), Cmp
  = d*(deadzone(v, v_1) - v/2) if v > v_1 else d*v | d > 0; v_1 > 0
a choice and its opposite both hold
  - {choice: holds, opposite(choice): not holds}
  + {choice: holds, opposite(choice): holds}
  = d*v if a > 0 else (a*v if a <= 0 else d*v) | d > 0
the opposite of >= is <=
  - ">=": "<"}
  + ">=": "<="}
  = -d*v if a <= 0 else d*v | d > 0; a >= 0 | a=0.0
a choice that the domain makes is taken as not holding
  - dict.fromkeys(holding, True)
  + dict.fromkeys(holding, False)
  = -d*v if b > a_1 else d*v | d > 0; a_1 > 0; b > a_1
divisions have values everywhere
  - yield Cmp("!=", right, ZERO)
  + yield Cmp("=", right, right)
  = d*v*a_1**2/a**2 | d > 0; a_1 > 0
a root of zero has an inverse
  - yield Cmp(">=" if exponent > 0 else ">", base, ZERO)
  + yield Cmp(">=", base, ZERO)
  = d*v*(b/a_1)**(-1/2) | d > 0; a_1 > 0; b >= 0
zero has an inverse
  - case Pow(base, exponent) if exponent < 0:
  + case Pow(base, exponent) if exponent < -1:
  = d*v*(2 + tanh((a/a_1)**(-1))) | d > 0; a_1 > 0
roots have values everywhere
  - clause(RECORDS[function].domain, arg, part)
  + clause(RECORDS[function].domain.replace(">= 0", ">= x"), arg, part)
  = d*v*(1 + sqrt(a/a_1)) | d > 0; a_1 > 0 | a=1.0
zero has a logarithm
  - clause(RECORDS[function].domain, arg, part)
  + clause(RECORDS[function].domain.replace("> 0", ">= 0"), arg, part)
  = d*v*(2 + tanh(log(b/a_1))) | d > 0; a_1 > 0; b >= 0
""",
    spec_of,
)
