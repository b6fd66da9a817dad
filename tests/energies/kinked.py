"""Springs with kinks: a spec, good laws with their values, and bad laws and energies."""

from math import exp, log, tanh

TEXT = """
[model]
name = "kinked"
[parameters]
M = { value = 2.0, unit = "kg" }
k = { value = 5.0, unit = "N/m" }
r = { value = 0.7, unit = "m" }
s = { value = 0.2, unit = "m" }
s_2 = { value = -0.1, unit = "m" }
F_0 = { value = 0.7, unit = "N" }
n = { value = 1.5, unit = "1" }
[domain]
assume = ["M > 0", "k > 0", "r > 0", "F_0 > 0", "n > 0"]
[elements]
spring = { kind = "spring", between = ["a", "wall"], force = "LAW", state = "q" }
mass = { kind = "mass", at = "a", mass = "M", state = "p" }
"""
VALUES = {"M": 2.0, "k": 5.0, "r": 0.7, "s": 0.2, "s_2": -0.1, "F_0": 0.7, "n": 1.5}


def deadzone(z, w):
    return max(z - w, 0.0) + min(z + w, 0.0)


def sign(z):
    return (z > 0) - (z < 0)


#: What Python's own reading of a law needs.
WORDS = {
    **VALUES,
    "exp": exp,
    "log": log,
    "tanh": tanh,
    "deadzone": deadzone,
    "sign": sign,
    "abs": abs,
    "max": max,
    "min": min,
}
GOOD = (
    "k*(q - s)/(1 + abs(q - s)/r)",
    "k*(q - s)/(1 + abs((q - s)/r))",
    "k*(s - q)/(-1 - abs(s - q)/r)",
    "k*(q - s)/(1 + abs(q - s)/r) + k*(q - s_2)/(1 + abs(q - s_2)/r)",
    "k*q + k*(q - s)*exp(-abs(q - s)/r)",
    "k*max(q - s, 0)/(1 + max(q - s, 0)/r)",
    "k*deadzone(q, r)/(1 + abs(deadzone(q, r))/r)",
    "k*max(q, 2*q - s)/(1 + abs(q)/r)",
    "k*q/(1 + q/r) if q > 0 else k*r*tanh(q/r)",
    "F_0*sign(q)*abs(q/r)**(3/2)",
    "F_0*abs(q/r)**n*sign(q)",
    "F_0*abs((q - s)/r)**n*sign(q - s)",
    "k*q*abs(q/r)**n",
)
#: Energies that jump, bend or lack a value.
BAD_ENERGIES = (
    "k*r*(abs(q - s) - r*log(abs(q - s) + r)) if q >= s else k*r*(s - q - r*log(s - q + 2*r))",
    "k*r*(abs(q - s) - r*log(abs(q - s) + r)) if q >= s else k*r*abs(q - s)",
    "k*r*(abs(q - s) - r*log(q - s + r))",
    "k*r*(q - s - r*log(q - s + r)) if q >= s_2 else k*r*(s - q - r*log(s - q + r))",
    "k*(q - s)**2/2 if q > s_2 else k*(q-s_2)**2/2",
    "k*(q - s)**2/2 if q > s_2 else k*(q-s)**2/2 + k*s*s_2",
    "k*r*(abs(q) - r*log(abs(q) - r))",
    "F_0*r*(q/r)**(5/2)",
    "F_0*r*abs(q/r)**(5/2) if q > s else F_0*r*abs(q/r)**2",
    "F_0*r*abs(q/r)**n if q > 0 else F_0*r*abs(q/r)**n + F_0*r",
    "F_0*r*abs(q/r)**n if q > s else 2*F_0*r*abs(q/r)**n",
    "F_0*r*sign(q)*abs(q/r)**n + F_0*r*sign(q)",
    "k*r**2*sign(q - s)",
    "k*deadzone(q, s)**2/2 + k*s**2*sign(q)",
    "k*max(q - s, 0)**2/2 if q > s_2 else k*(q-s)**2/2",
    "k*saturate(q, r)*q/2 if q < r else k*q*r",
    "k*q*abs(q) + (k*r**2 if q >= s else 0)",
    "k*min(q, s)**2 + k*max(q, s)**2/2 + (k*r*q if q > s else k*r*s_2)",
)
#: Laws that jump or lack a value.
BAD_LAWS = (
    "k*(q - s)/(1 + abs(q - s)/r) if q >= s_2 else k*(q - s_2)/(1 + abs(q - s_2)/r)",
    "k*(q - s)/(1 + (q - s)/r)",
    "k*(q - s)/(1 - abs(q - s)/r)",
    "k*(q - s)/(1 + abs(q - s)/s)",
    "k*(q - s)/(s + abs(q - s))*r",
    "k*(q - s)/(r*s/s + abs(q - s))*r",
    "F_0*sign(q - s)",
    "F_0*sign(q)*abs(q/s)**n",
    "F_0*sign(q - s)*abs(q/r)**n",
    "F_0*sign(q)*abs(q/r)**(n - 2)",
    "F_0*sign(q)*abs(q/r)**(-1/2)",
    "F_0*sign(q)*sqrt(q/r)",
    "F_0*(q/r)**(3/2)",
    "F_0*abs(q/r)**n*sign(q - s) + F_0",
    "F_0*log(abs(q)/r)",
    "F_0*log(1 + (q - s)/r) if q > s_2 else 0*F_0",
    "k*(q-s) if q > s_2 else k*(q - s_2)",
    "k*max(q - s, 0) + F_0*sign(max(q - s, 0))",
    "k*deadzone(q, s) + F_0*sign(q)",
    "k*deadzone(q, r)/(1 - abs(deadzone(q,r))/r)",
    "k*q/(1 + q/r)",
    "k*q*sqrt(1 + q/r)",
    "k*q*log(abs(q)/r)",
    "k*q/abs(q)*r",
    "k*max(q, s)/(abs(q)/r)",
    "k*q if q > s else 2*k*q",
    "k*r*tanh(q/r) if q > s else k*r*tanh(q/(2*r))",
    "k*r/(1 + abs(q)/r) if q > 0 else -k*r/(1 + abs(q)/r)",
    "k*r*exp(-abs(q - s)/r) if q > s else -k*r*exp(-abs(q - s)/r)",
    "k*(q - s)*exp(abs(q - s)/r) if q > s_2 else 0*F_0",
    "k*(q-s)/(1 + abs(q-s_2)/s_2)",
    "k*q/(s + abs(q - s_2))*r + k*q/(s_2 + abs(q - s))*r",
    "k*(q - s)*abs((q - s)/s_2)",
    "k*q*abs(q/s)**n",
    "F_0*abs(q/r)**s*sign(q)",
    "F_0*abs(q/r)**(n*s)*sign(q)",
    "k*max(q-s,0)/(1 + min(q - s, 0)/r)",
    "k*max(q - s, 0)/(1 + max(q-s_2,0)/s)",
    "k*(s*q - r)/(1+abs(s*q - r)/r) if q > 0 else 0*F_0",
    "F_0/(1 + abs(s*q/r - 1)) if s*q > r else 2*F_0/(1 + abs(s*q/r - 1))",
    "k*q/(1+abs(q)/r) + k*max(q - s, 0)/(1 - max(q-s, 0)/r)",
    "k*min(q, s)/(1 + min(q, s)/r)",
    "sqrt(max(q, s)/r)*F_0",
    "F_0*max(q/r, s/r)**(3/2)",
    "F_0*max(q/r, 0)**(3/2) + (F_0 if q > s else 0)",
)
