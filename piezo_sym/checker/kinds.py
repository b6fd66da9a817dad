"""The checker's own table of kinds: fields, letters, units, branches.

Input: nothing; this is data.  A store's co-state is imposed on its branch (across or through), a
law's letter is the variable it is given.  Fields that end in ``?`` may be left out.
"""

from __future__ import annotations

from typing import NamedTuple

REFERENCES = {"gnd": "E", "wall": "M"}
STATES = {"capacitor": "Q", "mass": "p", "inductor": "phi", "hysteron": "phi", "spring": "q"}
STATES |= {"thermal_mass": "S"}
LETTERS = {"q": "m", "p": "kg*m/s", "Q": "C", "phi": "Wb", "S": "J/K", "i": "A", "f": "N", "T": "K"}


class Kind(NamedTuple):
    """A kind of element.

    Attributes
    ----------
    form : store, law, hysteron (a store and a law in series), coupling, source, body, conduction
        or ambient.
    domains : of its branches, E or M; v is in `across`.
    nodes : fields that name nodes or pairs of nodes.
    laws : law fields: unit, and the letters allowed (beside parameters).
    others : fields that name inputs and bodies.
    across : whether its state or input gives the across variable; a coupling gyrates if not.
    """

    form: str
    domains: str
    nodes: tuple[str, ...]
    laws: dict[str, tuple[str, str]]
    others: tuple[str, ...] = ()
    across: bool = True


PAIR, AT, PAIRS = ("between",), ("at",), ("first", "second")
NAMED, HEATS, INPUT = ("state?",), ("heats", "discontinuous?"), ("input",)
VOLTAGE, CONDUCTANCE = ("V", "i T"), {"conductance": ("W/K", "")}
RESISTOR = {"voltage?": VOLTAGE, "current?": ("A", "v T")}
DAMPER = {"velocity?": ("m/s", "f T"), "force?": ("N", "v T")}
SPRING = {"stiffness": ("N/m", "q"), "rest?": ("m", "")}
HYSTERON = {"inductance": ("H", "phi"), "voltage": VOLTAGE}
KINDS = {
    "capacitor": Kind("store", "E", PAIR, {"capacitance": ("F", "Q")}, NAMED),
    "mass": Kind("store", "M", AT, {"mass": ("kg", "p")}, NAMED),
    "inductor": Kind("store", "E", PAIR, {"inductance": ("H", "phi")}, NAMED, False),
    "spring": Kind("store", "M", PAIR, SPRING, NAMED, False),
    "hysteron": Kind("hysteron", "E", PAIR, HYSTERON, ("count?", *NAMED, *HEATS), False),
    "resistor": Kind("law", "E", PAIR, RESISTOR, HEATS),
    "damper": Kind("law", "M", PAIR, DAMPER, HEATS),
    "transducer": Kind(
        "coupling", "EM", ("electrical", "mechanical"), {"ratio": ("C/m", "T")}, ("temperature?",), False
    ),
    "transformer": Kind("coupling", "EE", PAIRS, {"ratio": ("1", "")}),
    "lever": Kind("coupling", "MM", PAIRS, {"ratio": ("1", "")}),
    "voltage_source": Kind("source", "E", PAIR, {}, INPUT),
    "current_source": Kind("source", "E", PAIR, {}, INPUT, False),
    "velocity_source": Kind("source", "M", AT, {}, INPUT),
    "force_source": Kind("source", "M", AT, {}, INPUT, False),
    "thermal_mass": Kind("body", "", (), {"temperature": ("K", "S")}, NAMED),
    "conduction": Kind("conduction", "", (), CONDUCTANCE, ("between",)),
    "ambient": Kind("ambient", "", (), CONDUCTANCE, ("body", *INPUT)),
}
#: The units of what a source gives, by its domain and whether it is across.
GIVES = {("E", True): "V", ("E", False): "A", ("M", True): "m/s", ("M", False): "N"}
