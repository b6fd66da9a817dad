"""The checker's own table of kinds, and the units of their letters.

Input: nothing; this is data.  A row has the form (a hysteron is a store and a law in series), the
domains of its branches, the fields that name nodes, + if what it imposes (co-state, input) is an
across variable (a coupling gyrates if not), law fields with unit and letters, other fields, and the
co-state of a store as a law of its state x.  ``?`` marks what may be left out.
"""

from typing import NamedTuple

REFERENCES = {"gnd": "E", "wall": "M"}
LETTERS = {"q": "m", "p": "kg*m/s", "Q": "C", "phi": "Wb", "S": "J/K", "i": "A", "f": "N", "T": "K"}
STATES = ("q", "p", "Q", "phi", "S")
#: The units of what a source gives, by its domain and whether it is across; v has that of across.
GIVES = {("E", True): "V", ("E", False): "A", ("M", True): "m/s", ("M", False): "N"}
_TABLE = """
capacitor      | store      | E  | between               | + | capacitance F Q            | state? | x/capacitance
mass           | store      | M  | at                    | + | mass kg p                  | state? | x/mass
inductor       | store      | E  | between               | - | inductance H phi           | state? | x/inductance
spring         | store      | M  | between               | - | stiffness N/m q; rest? m   | state? | stiffness*(x - rest)
hysteron       | hysteron   | E  | between               | - | inductance H phi; voltage V i T | state? count? heats discontinuous? | x/inductance
resistor       | law        | E  | between               | + | voltage? V i T; current? A v T  | heats discontinuous? |
damper         | law        | M  | between               | + | velocity? m/s f T; force? N v T | heats discontinuous? |
transducer     | coupling   | EM | electrical mechanical | - | ratio C/m T                | temperature? |
transformer    | coupling   | EE | first second          | + | ratio 1                    | |
lever          | coupling   | MM | first second          | + | ratio 1                    | |
voltage_source | source     | E  | between               | + |                            | input |
current_source | source     | E  | between               | - |                            | input |
velocity_source | source    | M  | at                    | + |                            | input |
force_source   | source     | M  | at                    | - |                            | input |
thermal_mass   | body       |    |                       | + | temperature K S            | state? | temperature
conduction     | conduction |    |                       | + | conductance W/K T_1 T_2    | between |
ambient        | ambient    |    |                       | + | conductance W/K T T_e      | body input |
"""  # noqa: E501


class Kind(NamedTuple):
    """A kind of element; `laws` is by field: unit, and the letters allowed beside parameters."""

    form: str
    domains: str
    nodes: list[str]
    across: bool
    laws: dict[str, tuple[str, list[str]]]
    fields: set[str]
    needed: set[str]
    costate: str


def _kind(row: str) -> tuple[str, Kind]:
    name, form, domains, nodes, across, laws, others, costate = map(str.strip, row.split("|"))
    table = [text.split() for text in laws.split(";") if text]
    fields = {"kind", *nodes.split(), *others.split(), *(field for field, *_ in table)}
    needed = {field for field in fields if not field.endswith("?")}
    known = {field.rstrip("?") for field in fields}
    units = {field.rstrip("?"): (unit, letters) for field, unit, *letters in table}
    return name, Kind(form, domains, nodes.split(), across == "+", units, known, needed, costate)


KINDS = dict(map(_kind, _TABLE.strip().splitlines()))
