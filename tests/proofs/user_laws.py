"""Laws as users write them, of a velocity v: passive in the domain below, or not."""

from fractions import Fraction

from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.proofs.obligations import SignOf
from piezo_sym.proofs.sign_analysis import whole_sign
from piezo_sym.proofs.solvers import solver


def split(text):
    return [part.strip() for line in text.strip().splitlines() for part in line.split(";")]


DOMAIN = tuple(
    split("""
    d > 0; F_1 > 0; F_2 > 0; v_1 > 0; v_2 > 0; T_0 > 0; T_1 > T_0; w >= 0; E > 0; k > 0; n >= 1
    mu_s >= mu_k; mu_k > 0; F_c >= 0; T > 0; al > 0; al < 1
    """)
)
SIZES = "d; F_1; F_2; v_1; v_2; T_0; T_1; w; E; k; n; mu_s; mu_k; F_c; al; T"
ORDER = tuple(split(f"{SIZES}; a; b; p; v"))
#: Names of either sign.
SIGNED = ("a", "b", "p", "v")
PASSIVE = """
F_1*(log(1 + exp(v/v_1)) - log(2)); v*log(1 + exp(v/v_1)); d*v*log(1 + exp(v/v_1))
d*v_1*log(1 + exp(v/v_1)) - d*v_1*log(2); d*v_1*(log(1 + exp(v/v_1)) - log(1 + exp(-v/v_1)))
F_1*(exp(v/v_1) - 1); F_1*(exp(v/v_1) - 1) - F_2*(exp(-v/v_2) - 1); F_1*exp(v/v_1) - F_1
F_1*(exp(v/v_1) - exp(-v/v_1))/2; F_1*(exp(v/v_1) - exp(-v/v_2))
F_1*(exp(v/v_1) - 1) + F_2*(exp(v/v_2) - 1) + d*v; F_1*(exp(v/(n*v_1)) - 1)
F_1*exp(-E/T)*(exp(v/v_1) - exp(-v/v_1)); F_1*exp(-E/T)*v*abs(v); d*exp(-E/(k*T))*v
d*exp(E*(1/T - 1/T_0))*tanh(v/v_1); F_1*tanh(v/v_1); F_1*tanh(v/v_1) + d*v
F_1*tanh(v/v_1) + F_2*tanh(v/v_2); F_1*tanh(v/v_1) + F_2*(v/v_2)/(1 + abs(v/v_2)) + d*v
F_1*v/(v_1 + abs(v)); F_1*(v/v_1)/(1 + abs(v)/v_1); F_1*v/sqrt(v_1**2 + v**2)
d*v*sqrt(1 + (v/v_1)**2); d*v*sqrt(1 + v**2/v_1**2) + F_2*tanh(v/v_2); d*v/sqrt(1 + (v/v_1)**2)
(F_c + (F_1 - F_c)*exp(-(v/v_1)**2))*tanh(v/v_2) if F_1 > F_c else F_c*tanh(v/v_2)
(F_c + F_2*exp(-(v/v_1)**2))*tanh(v/v_2) + d*v; F_c*(1 + 2*exp(-(v/v_1)**2))*tanh(10*v/v_1) + d*v
F_1*(mu_k + (mu_s - mu_k)*exp(-(v/v_1)**2))*tanh(v/v_2)
F_1*(mu_k + (mu_s - mu_k)/(1 + (v/v_1)**2))*tanh(v/v_2); F_1*sqrt(abs(v)/v_1)*sign(v)
F_1*abs(v/v_1)**1.5*sign(v); F_1*v*abs(v)/v_1**2 + d*v; F_1*sign(v)*log(1 + abs(v)/v_1)
F_1*log((1 + exp(v/v_1))/2); F_1*sin(v/v_1) + 5*F_1*v/v_1; d*v + d*v_1*sin(v/v_1)
d*v + F_1*sin(v/v_1)**2*tanh(v/v_1); d*v*(1 + sin(v/v_1)**2); d*v*(2 + cos(v/v_2))
d*v*(1 + exp(-v/v_1)) if v > 0 else d*v*2; d*v*(1 + exp(-v**2/v_1**2)); d*v*exp(-abs(v)/v_1)
d*v if a > 0 else 2*d*v; d*v if a > 0 else F_1*tanh(v/v_1); a*tanh(v/v_1) if a > 0 else d*v
a*v*exp(-v**2/v_1**2) if a > 0 else -a*tanh(v/v_1)
(a*tanh(v/v_1) if b > 0 else a*v*exp(v/v_1)) if a > 0 else -a*(v + v_1*sin(v/v_1))
F_1*tanh(v/b) if b > 0 else d*v
F_1*tanh(v/b) if b > 0 else F_1*tanh(-v/b) if b < 0 else F_1*sign(v); abs(a)*tanh(v/v_1)
max(a, 0)*tanh(v/v_1) + min(b, 0)*tanh(-v/v_2); a**2*(exp(v/v_1) - 1)
(a**2 + 1)*tanh(v/v_1) + b**2*v; F_1*tanh(v/v_1)*exp(a); F_1*tanh(v/v_1)*(1 + exp(v/v_2))
F_1*tanh(v/v_1)*(1 + tanh(v/v_2)**2); F_1*tanh(v/v_1)*(1 + abs(tanh(v/v_2))); F_1*tanh(v/v_1)*T_0/T
F_1*(1 + a**2*(T - T_0)**2)*tanh(v/v_1); F_1*exp(-a*(T - T_0))*sin(tanh(v/v_1))
F_1*(T/T_0)**1.5*tanh(v/v_1); F_1*log(1 + T/T_0)*tanh(v/v_1); F_1*sqrt(T/T_0)*tanh(v/v_1)
d*v*(1 + a**2*exp(-v**2/v_1**2)); d*v + a**2*tanh(v/v_1); d*v*v/v_1*tanh(v/v_1)
F_1*max(v/v_1, 0)**2 - F_2*(exp(max(-v/v_2, 0)) - 1); F_1*(exp(max(v, 0)/v_1) - 1) + d*min(v, 0)
F_1*(exp(min(v/v_1, 40)) - 1)
F_1*(exp(v/v_1) - 1) if v < 10*v_1 else F_1*(exp(10)*(v/v_1 - 9) - 1); d*v*(1 - exp(-abs(v)/v_1))
d*(v - v_1*tanh(v/v_1)) + F_1*tanh(v/v_1); d*(v - v_1*tanh(v/v_1))
F_1*(v/v_1)**3 + F_2*tanh(v/v_2); F_1*v*exp(T/T_0)/(v_1*(1 + exp(T/T_0)))
F_1*(1/(1 + exp(-v/v_1)) - 1/2); F_1*(2/(1 + exp(-v/v_1)) - 1)
F_1*(1 - exp(-v/v_1))/(1 + exp(-v/v_1)); F_1*(exp(v/v_1) - exp(-v/v_1))/(exp(v/v_1) + exp(-v/v_1))
(F_c + F_1*exp(-abs(v)/v_1))*sign(v) + d*v; (F_c + F_1*exp(-abs(v/v_1)))*saturate(v/v_2, 1)
d*v*(1 if T < T_0 else exp(-(T - T_0)/T_1)); F_1*tanh(v/(v_1*exp(-E/T))); F_1*tanh(v*exp(E/T)/v_1)
F_1*(exp(v/(v_1*T/T_0)) - 1); F_1*tanh(v/(v_1 + v_2)); F_1*tanh(v/sqrt(v_1*v_2))
F_1*tanh(v/v_1*(1 + a**2)); F_1*tanh((v_1 + v_2)*v/(v_1*v_2))
F_1*exp(v/v_1)*sin(v/v_1)**2*tanh(v/v_1); F_1*tanh(v/v_1)/(1 + exp(-v/v_1))
F_1*(exp(al*v/v_1) - exp(-(1 - al)*v/v_1))
F_1*exp(-E/T)*(exp(al*v/(k*T)) - exp(-(1 - al)*v/(k*T)))
F_1*exp(v/v_1) - F_1 - F_2*exp(-v/v_2) + F_2; F_1*exp(v/v_1) - F_1 + d*v
F_1*(exp(v/v_1) - 1) - F_2*(exp(-v/v_2) - 1) + d*v
F_1*(exp(v/(n*v_1)) - 1) - F_2*(exp(-v/(n*v_2)) - 1); d*v + 4*d*v_1*sin(v/v_1) + F_2*tanh(v/v_2)
F_1*(tanh(v/v_1) + a**2*v/v_2); d*v + F_1*tanh(v/v_1) if T > T_0 else F_2*tanh(v/v_2)
F_1*tanh(v/v_1) if v > 0 else F_2*tanh(v/v_2)
d*v*(1 + exp(-v/v_1)) if abs(v) < w else F_1*(exp(v/v_2) - 1); F_1*(exp(v/v_1 - 1) - exp(-1))
F_1*exp(2)*tanh(v/v_1); F_1*(1 + exp(-T/T_0)*sin(v/v_1)**2)*tanh(v/v_2)
"""
ACTIVE = """
F_1*(log(1 + exp(v/v_1)) - 0.69); F_1*log(1 + exp(v/v_1)); v*log(exp(v/v_1))
F_1*(exp(v/v_1) - 1) + F_2*(exp(-v/v_2) - 1); F_1*(exp(v/v_1) - 1) - F_2*(exp(v/v_2) - 1)
F_1*exp(v/v_1) - F_2; F_1*(exp(v/v_1) - exp(v/v_2)); a*F_1*tanh(v/v_1)
a*tanh(v/v_1) if a > 0 else a*v; a*tanh(v/v_1) if a > -1 else d*v
d*v if a > 0 else F_1*(tanh(v/v_1) - v/(2*v_1))
(a*tanh(v/v_1) if b > 0 else a*sin(v/v_1)) if a > 0 else -a*v
(a*tanh(v/v_1) if a > b else d*v) if b > -1 else d*v; F_1*tanh(v/b)
F_1*tanh(v/b) if a > 0 else F_1*tanh(v/v_1); F_1*(exp(v/b) - 1) if b > -1 else d*v
a**3*tanh(v/v_1); (a*b)**3*tanh(v/v_1); (a - b)*tanh(v/v_1); saturate(v, b)*exp(-v**2/v_1**2)
F_1*tanh(v/v_1) + b; F_1*tanh(saturate(v, b)/v_1); F_1*tanh(max(v, b)/v_1)
F_1*tanh(max(v*a, b)/v_1); F_1*tanh(min(v*a, 0)/v_1); max(a*v, b)*exp(-v**2/v_1**2)
F_1*tanh(v/v_1) - F_2*tanh(v/v_2); F_1*tanh(v/v_1) - d*v; F_1*tanh(v/v_1) - d*v_1*tanh(v/v_1)
d*v - F_1*tanh(v/v_1); d*v + 5*d*v_1*sin(v/v_1); d*v + F_1*sin(v/v_1); F_1*sin(v/v_1)
F_1*cos(v/v_1)*tanh(v/v_1); d*v*cos(v/v_1); d*v*(1 - 2*exp(-v**2/v_1**2)); d*v*(1 - exp(v/v_1))
F_1*(exp(-v/v_1) - 1); F_1*(exp(v/v_1 - 1) - 1); F_1*tanh((v - v_1)/v_1)
F_1*tanh(v/v_1)*(T - T_0)/T_0; F_1*exp(-E/T)*(T - T_1)*tanh(v/v_1); F_1*tanh(v/v_1)*log(T/T_0)
F_1*tanh(v/v_1)*cos(T/T_0); F_1*tanh(v/v_1)*sin(a); F_1*(mu_s - 2*mu_k)*tanh(v/v_1)
F_1*(mu_k + (mu_k - mu_s)*exp(-(v/v_1)**2))*tanh(v/v_2); (F_1 - F_c)*tanh(v/v_1)
(F_1 - F_c)*tanh(v/v_1) if F_1 > F_c/2 else d*v; -F_1*tanh(v/v_1) if F_1 > 100 else F_1*tanh(v/v_1)
-F_1*tanh(v/v_1) if a > 1000000 else F_1*tanh(v/v_1)
-F_1*tanh(v/v_1) if a*a < 1e-12 else F_1*tanh(v/v_1); F_1*log(abs(v)/v_1 + 0.5)*sign(v)
F_1*sqrt(abs(v)/v_1)*sign(-v); F_1*abs(tanh(v/v_1)); F_1*(tanh(v/v_1) - 0.001*v/v_1)
F_1*(1/(1 + exp(-v/v_1)) - 0.4); abs(a)*tanh(v/v_1) - abs(b)*tanh(v/v_1); min(a, 0)*tanh(v/v_1)
F_1*(tanh(v/v_1) if v < 50*v_1 else tanh(-v/v_1)); F_1*tanh(v/v_1)*sign(a)
(a*exp(-v**2/v_1**2) + 1)*F_1*tanh(v/v_1); a*(exp(v/v_1) - 1) + b*(exp(v/v_2) - 1)
F_1*(v/v_1)**3 - F_1*v/v_1 + F_1*tanh(v/v_1)/2
"""


def decided(law, domain=DOMAIN):
    """Return what the law as a whole says, with no help from its branches."""
    where = tuple(parse_condition(condition, "test") for condition in domain)
    return whole_sign(SignOf(parse_law(law, "test"), "v", where), ORDER, solver("z3"))


def points(rng, count):
    """Return numbers in the domain."""
    sizes = [Fraction(n) for n in (1, 1, 2, 3, 10)] + [Fraction(1, 2), Fraction(1, 10)]
    for _ in range(count):
        at = {name: rng.choice(sizes) for name in ORDER}
        at |= {name: rng.choice(sizes) * rng.choice((1, 1, 0, -1)) for name in SIGNED}
        at |= {"T_1": at["T_0"] + at["T_1"], "mu_s": at["mu_k"] + at["mu_s"], "n": 1 + at["n"]}
        yield at | {"al": rng.choice((Fraction(1, 3), Fraction(9, 10)))}
