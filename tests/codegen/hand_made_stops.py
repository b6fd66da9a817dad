"""Models with stops, which no spec can write yet."""

from piezo_sym.expressions.tree import LaneSum

from .hand_made import HandMade, read

BODY = {"T_0": 300.0, "c": 0.8}
HEAT = "c*T_0*exp(S/c)"
STIFF, LIMIT = 3000.0, 1e-3


def total(text, bank):
    return LaneSum(read(text), bank)


#: A mass on a spring and a stop, driven by a force; damper and stop heat a body.
MASS = HandMade(
    name="stopped",
    parameters={"m": 0.5, "k": 800.0, "d": 0.6, "k_s": STIFF, "r": LIMIT, **BODY},
    states={"q": (0.0, None), "p": (0.0, None), "z": (0.0, None), "S": (0.01, None)},
    energies=["p**2/(2*m)", "k*q**2/2", "k_s*z**2/2", HEAT],
    rates={
        "q": "E_p",
        "p": "F - E_q - d*E_p - stop_effort",
        "z": "E_p - stop_slip",
        "S": "(d*E_p*E_p + stop_heat)/E_S",
    },
    inputs={"F": 0.0},
    supply={"pull": "F*E_p"},
    heats={"damper": ("d*E_p*E_p", "S"), "stop": ("stop_heat", "S")},
    paths={"stop": ("E_p", "z", "k_s", "r")},
)
#: The same on Maxwell's slips: stops side by side, with limits that fall as the body becomes warm.
SLIPS = tuple(2e-4 * (1 + n) for n in range(8))
MAXWELL = HandMade(
    name="maxwell",
    parameters={
        **{"m": 0.5, "k": 100.0, "a": 20.0, **BODY},
        **{"k_s": ((400.0,) * 8, "slip"), "r": (SLIPS, "slip")},
    },
    states={"q": (0.0, None), "p": (0.0, None), "z": (0.0, "slip"), "S": (0.01, None)},
    energies=["p**2/(2*m)", "k*q**2/2", ("k_s*z**2/2", "slip"), HEAT],
    laws={"force": total("slips_effort", "slip"), "lost": total("slips_heat", "slip")},
    rates={"q": "E_p", "p": "F - E_q - force", "z": "E_p - slips_slip", "S": "lost/E_S"},
    inputs={"F": 0.0},
    supply={"pull": "F*E_p"},
    heats={"slips": (("slips_heat", "slip"), "S")},
    counts={"slip": 8},
    paths={"slips": ("E_p", "z", "k_s", "r/(1 + a*abs(S - 0.01))")},
)
#: Stops whose coordinates move as they are told, each in a ratio of its own.
RATIOS = (1.0, -0.4, 2.0)
LED = HandMade(
    name="led",
    parameters={"w": (RATIOS, "leaf"), "k_s": STIFF, "r": LIMIT, **BODY},
    states={"q": (0.0, "leaf"), "z": (0.0, "leaf"), "S": (0.01, None)},
    energies=[("k_s*z**2/2", "leaf"), HEAT],
    laws={"pulled": total("w*stop_effort", "leaf"), "lost": total("stop_heat", "leaf")},
    rates={"q": "w*v", "z": "w*v - stop_slip", "S": "lost/E_S"},
    inputs={"v": 0.0},
    supply={"drive": "pulled*v"},
    heats={"stop": (("stop_heat", "leaf"), "S")},
    counts={"leaf": 3},
    paths={"stop": ("w*v", "z", "k_s", "r")},
)
#: Rubbing of Coulomb's kind, rounded off, with a factor that reads another co-state.
RUBBING = HandMade(
    name="rubbing",
    parameters={"m": 0.5, "k": 800.0, "F_c": 2.0, "v_0": 1e-2, "a": 0.05, **BODY},
    states={"q": (0.02, None), "p": (0.0, None), "S": (0.01, None)},
    energies=["p**2/(2*m)", "k*q**2/2", HEAT],
    laws={"rub": "F_c*(E_p/v_0)/sqrt(1 + (E_p/v_0)**2)*(1 + a*E_q**2)"},
    rates={"q": "E_p", "p": "F - E_q - rub", "S": "rub*E_p/E_S"},
    inputs={"F": 0.0},
    supply={"pull": "F*E_p"},
    heats={"rub": ("rub*E_p", "S")},
)
