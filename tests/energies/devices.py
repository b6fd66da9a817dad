"""Devices whose stores are no ratios, each with its right-hand side by hand: `rates(t, x)`.

An electromagnet whose coil and drag heat a body; a gas chamber under a piston that exchanges heat
with its shell; a mass that meets an end stop; one on springs that harden and soften.
"""

from math import erf, exp, sin, sinh, tanh

MAGNET = """
[model]
name = "magnet"
[parameters]
mu = { value = 1.25663706e-6, unit = "H/m" }
A = { value = 1e-4, unit = "m**2" }
N = { value = 200.0, unit = "1" }
g = { value = 2e-3, unit = "m" }
m = { value = 0.05, unit = "kg" }
k = { value = 5000.0, unit = "N/m" }
R = { value = 2.0, unit = "ohm" }
d = { value = 1.0, unit = "N*s/m" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 0.5, unit = "J/K" }
[inputs]
V_in = { unit = "V" }
[domain]
assume = ["mu > 0", "A > 0", "N > 0", "R >= 0", "d >= 0"]
[elements.magnet]
kind = "storage"
energy = "phi**2*(g + x)/(2*mu*A*N**2)"
[elements.magnet.states]
phi = { rate = "voltage", between = ["coil", "gnd"] }
x = { rate = "velocity", between = ["armature", "wall"] }
[elements]
spring = { kind = "spring", between = ["armature", "wall"], stiffness = "k", state = "q" }
armature = { kind = "mass", at = "armature", mass = "m", state = "p" }
wire = { kind = "resistor", between = ["in", "coil"], voltage = "R*i", heats = "body" }
drag = { kind = "damper", between = ["armature", "wall"], force = "d*v", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V_in" }
"""


def magnet(t, state):
    phi, x, q, p, S = state
    turns = 1.25663706e-6 * 1e-4 * 200.0**2
    i, v, T = phi * (2e-3 + x) / turns, p / 0.05, 300.0 * exp(S / 0.5)
    pull = phi**2 / (2 * turns)
    return [voltage(t) - 2.0 * i, v, v, -pull - 5000.0 * q - v, (2.0 * i * i + v * v) / T]


def voltage(t):
    return 2.0 + sin(60 * t)


GAS = """
[model]
name = "chamber"
[parameters]
U_0 = { value = 300.0, unit = "J" }
N = { value = 0.04, unit = "mol" }
c_v = { value = 20.8, unit = "J/mol/K" }
A = { value = 2e-3, unit = "m**2" }
V_0 = { value = 1e-3, unit = "m**3" }
p_0 = { value = 1e5, unit = "Pa" }
m = { value = 0.5, unit = "kg" }
d = { value = 3.0, unit = "N*s/m" }
lam = { value = 0.3, unit = "W/K" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 50.0, unit = "J/K" }
[inputs]
F = { unit = "N" }
T_e = { unit = "K", default = 320.0 }
[domain]
assume = ["U_0 > 0", "N > 0", "c_v > 0", "V_0 > 0", "1 + A*q/V_0 > 0", "d >= 0", "lam >= 0",
          "T_e > 0"]
[initial]
q = 0.05
[elements.gas]
kind = "storage"
energy = "U_0*exp(S/(N*c_v))*(1 + A*q/V_0)**(-2/5) + p_0*A*q"
[elements.gas.states]
q = { rate = "velocity", between = ["piston", "wall"] }
S = { rate = "entropy" }
[elements]
piston = { kind = "mass", at = "piston", mass = "m", state = "p" }
seal = { kind = "damper", between = ["piston", "wall"], force = "d*v", heats = "gas" }
shell = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S_s" }
walls = { kind = "conduction", between = ["gas", "shell"], conductance = "lam" }
air = { kind = "ambient", body = "shell", conductance = "lam", input = "T_e" }
push = { kind = "force_source", at = "piston", input = "F" }
"""


def gas(t, state):
    q, S, p, S_s = state
    volume, stored = 1 + 2 * q, 300.0 * exp(S / (0.04 * 20.8))
    T, T_s, v = stored * volume**-0.4 / (0.04 * 20.8), 300.0 * exp(S_s / 50.0), p / 0.5
    back = -0.8 * stored * volume**-1.4 + 200.0
    heat = 0.3 * (T - T_s)
    inward = heat / T_s + 0.3 * (320.0 / T_s - 1)
    return [v, (3.0 * v * v - heat) / T, force(t) - back - 3.0 * v, inward]


def force(t):
    return 50.0 * sin(20 * t)


SPRING = """
[model]
name = "{name}"
[parameters]
k = {{ value = 100.0, unit = "N/m" }}
k_2 = {{ value = 5e4, unit = "N/m" }}
g = {{ value = 0.01, unit = "m" }}
m = {{ value = 0.2, unit = "kg" }}
d = {{ value = 0.3, unit = "N*s/m" }}
T_0 = {{ value = 300.0, unit = "K" }}
c = {{ value = 5.0, unit = "J/K" }}
[domain]
assume = ["k > 0", "k_2 >= 0", "d >= 0", "g > 0"]
[initial]
q = -0.02
[elements]
spring = {{ kind = "spring", between = ["tip", "wall"], {law}, state = "q" }}
tip = {{ kind = "mass", at = "tip", mass = "m", state = "p" }}
drag = {{ kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }}
"""
#: Laws of the spring as a spec gives them, and by hand.
SPRINGS = {
    "stop": ('force = "k*q if q < g else k*q + k_2*(q - g)"', lambda q: stop(q)),
    "stop_by_energy": ('energy = "k*q**2/2 + k_2*max(q - g, 0)**2/2"', lambda q: stop(q)),
    "play": ('force = "k_2*deadzone(q, g)"', lambda q: 5e4 * (max(q - 0.01, 0) + min(q + 0.01, 0))),
    "hard": ('stiffness = "k*sinh(q/g)/(q/g)"', lambda q: sinh(q / 0.01)),
    "hard_by_force": (
        'force = "k*q + k*g*(q/g)*sinh(q/g)/(q/g)"',
        lambda q: 100.0 * q + sinh(q / 0.01),
    ),
    "part_hard": (
        'stiffness = "k*(1 + sinh(q/g)/(q/g))"',
        lambda q: 100.0 * q + sinh(q / 0.01),
    ),
    "part_waved": (
        'stiffness = "k*(sin(q/g)/(q/g) + 2)"',
        lambda q: 200.0 * q + sin(q / 0.01),
    ),
    "part_soft": (
        'stiffness = "k*(2 + tanh(q/g)*g/q)"',
        lambda q: 200.0 * q + tanh(q / 0.01),
    ),
    "soft": ('force = "k*g*tanh(q/g)"', lambda q: tanh(q / 0.01)),
    "error": ('force = "k*g*erf(q/g)"', lambda q: erf(q / 0.01)),
    "bump": ('force = "k*q*exp(-(q/g)**2)"', lambda q: 100.0 * q * exp(-((q / 0.01) ** 2))),
    "cable": ('energy = "k*g**2*cosh(q/g)"', lambda q: sinh(q / 0.01)),
}


def stop(q):
    return 100.0 * q + (5e4 * (q - 0.01) if q > 0.01 else 0.0)


def on_spring(law):
    def rates(t, state):
        del t
        q, p, S = state
        v = p / 0.2
        return [v, -law(q) - 0.3 * v, 0.3 * v * v / (300.0 * exp(S / 5.0))]

    return rates


#: By name: spec, rates by hand, inputs, states.
DEVICES = {
    "magnet": (MAGNET, magnet, {"V_in": voltage}, ("phi", "x", "q", "p", "S")),
    "gas": (GAS, gas, {"F": force}, ("q", "S", "p", "S_s")),
}
DEVICES |= {
    name: (SPRING.format(name=name, law=text), on_spring(law), {}, ("q", "p", "S"))
    for name, (text, law) in SPRINGS.items()
}
