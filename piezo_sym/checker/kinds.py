"""The checker's own table of kinds: fields, letters, units, branches, what each kind requires.

Input: nothing; this is data.  A store's co-state is imposed on its branch (across or through), a
law's letter is the variable it is given.
"""

from __future__ import annotations

from typing import NamedTuple

REFERENCES = {"gnd": "electrical", "wall": "mechanical"}
UNITS = {"q": "m", "p": "kg*m/s", "Q": "C", "phi": "Wb", "S": "J/K", "i": "A", "f": "N", "T": "K"}


class Kind(NamedTuple):
    """A kind of element.

    Attributes
    ----------
    form : store, resistor, hysteron, coupling, source, body, conduction or ambient.
    domain : of its branches; a coupling's two.
    nodes : fields that name nodes or pairs of nodes.
    laws : law fields: unit, and the letters allowed (beside parameters).
    others : fields that name inputs and bodies; those that end in ``?`` may be left out.
    across : whether its state or input gives the across variable; a coupling gyrates if not.
    """

    form: str
    domain: tuple[str, ...]
    nodes: tuple[str, ...]
    laws: dict[str, tuple[str, str]]
    others: tuple[str, ...] = ()
    across: bool = True


E, M = ("electrical",), ("mechanical",)
BETWEEN = ("between",)
HEATS = ("heats", "discontinuous?")
KINDS = {
    "capacitor": Kind("store", E, BETWEEN, {"capacitance": ("F", "Q")}, ("state?",)),
    "mass": Kind("store", M, ("at",), {"mass": ("kg", "p")}, ("state?",)),
    "inductor": Kind("store", E, BETWEEN, {"inductance": ("H", "phi")}, ("state?",), False),
    "spring": Kind(
        "store", M, BETWEEN, {"stiffness": ("N/m", "q"), "rest?": ("m", "")}, ("state?",), False
    ),
    "hysteron": Kind(
        "hysteron",
        E,
        BETWEEN,
        {"inductance": ("H", "phi"), "voltage": ("V", "i T")},
        ("state?", "count?", *HEATS),
        False,
    ),
    "resistor": Kind(
        "resistor", E, BETWEEN, {"voltage?": ("V", "i T"), "current?": ("A", "v T")}, HEATS
    ),
    "damper": Kind(
        "resistor", M, BETWEEN, {"velocity?": ("m/s", "f T"), "force?": ("N", "v T")}, HEATS
    ),
    "transducer": Kind(
        "coupling",
        (*E, *M),
        ("electrical", "mechanical"),
        {"ratio": ("C/m", "T")},
        ("temperature?",),
        False,
    ),
    "transformer": Kind("coupling", (*E, *E), ("first", "second"), {"ratio": ("1", "")}),
    "lever": Kind("coupling", (*M, *M), ("first", "second"), {"ratio": ("1", "")}),
    "voltage_source": Kind("source", E, BETWEEN, {}, ("input",)),
    "current_source": Kind("source", E, BETWEEN, {}, ("input",), False),
    "velocity_source": Kind("source", M, ("at",), {}, ("input",)),
    "force_source": Kind("source", M, ("at",), {}, ("input",), False),
    "thermal_mass": Kind("body", (), (), {"temperature": ("K", "S")}, ("state?",)),
    "conduction": Kind("conduction", (), (), {"conductance": ("W/K", "")}, ("between",)),
    "ambient": Kind("ambient", (), (), {"conductance": ("W/K", "")}, ("body", "input")),
}
#: The units of what a source gives, by its domain and whether it is across.
GIVES = {
    ("electrical", True): "V",
    ("electrical", False): "A",
    ("mechanical", True): "m/s",
    ("mechanical", False): "N",
}
#: The letter of each kind's state.
STATES = {
    "capacitor": "Q",
    "mass": "p",
    "inductor": "phi",
    "hysteron": "phi",
    "spring": "q",
    "thermal_mass": "S",
}
