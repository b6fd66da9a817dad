"""The checker's own table of kinds.

The columns of `_TABLE` are: name; form (a hysteron is a store and a law in series); the domain of
each field that names nodes; these fields; + if the imposed variable (co-state, input) is an across
variable (a coupling without + is a gyrator); law fields with unit and letters, a state first; other
fields; the co-state of a store as a law of its state x.  A state of a `storage` has the kind ``=``
plus its rate.  ``?`` marks optional fields; a coupling has one of its second node pairs, and its
ratio the unit of the two domains.  The columns of `_DOMAINS` are: domain; reference; node field of
inertia and sources; across and through variable with letter and unit; entries of `_WITHIN`, the
kinds that every domain has.
"""

from typing import NamedTuple

_DOMAINS = """
E, gnd, between, voltage, v, V, current, i, A, capacitor, capacitance, F Q:C, inductor, inductance H phi:Wb, x/inductance, resistor
M, wall, at, velocity, v, m/s, force, f, N, mass, mass, kg p:kg*m/s, spring, stiffness N/m q:m; rest? m, stiffness*x, damper
R, frame, at, angular_velocity, omega, rad/s, torque, tau, N*m, inertia, inertia, kg*m**2 L:N*m*s, torsion_spring, stiffness N*m/rad theta:rad; rest? rad, stiffness*x, rotational_damper
H, tank, between, pressure, dp, Pa, flow, flow, m**3/s, accumulator, capacitance, m**3/Pa V:m**3, inertance, inertance kg/m**4 G:Pa*s, x/inertance, orifice
"""  # noqa: E501
_WITHIN = """
{9}        | store  | {0} | {2}     | + | {10} {11}{16} | state? count? bank? series?{17} | x/{10}
{12}       | store  | {0} | between | - | {13}{18}      | state? count? bank? series?{19} | {14}
{15}       | law    | {0} | between | + | {3}? {5} {7}:{8} T:K; {6}? {8} {4}:{5} T:K | heats discontinuous? count? bank? series? |
{3}_source | source | {0} | {2}     | + | | input |
{6}_source | source | {0} | {2}     | - | | input |
={3}       | store  | {0} | between | - | energy J @:{5}*s | state | energy
={6}       | store  | {0} | between | + | energy J @:{8}*s | state | energy
"""  # noqa: E501
_TABLE = """
hysteron       | hysteron | E   | between             | - | inductance H phi:Wb; voltage V i:A T:K | state? count? bank? series? heats discontinuous? | x/inductance
transformer    | coupling | EE  | first second        | + | ratio 1                                | |
lever          | coupling | MM  | first second        | + | ratio 1                                | |
gear           | coupling | RR  | first second        | + | ratio 1                                | |
transducer     | coupling | EMM | electrical translation? mechanical? | - | ratio 1 T:K            | temperature? |
motor          | coupling | EMR | electrical translation? rotation?   | + | constant 1             | |
rack           | coupling | MR  | translation rotation                | + | radius 1               | |
cylinder       | coupling | HM  | hydraulic translation               | - | area 1                 | |
pump           | coupling | RH  | rotation hydraulic                  | - | displacement 1         | |
thermal_mass   | body       | | | + | temperature K S:J/K | state? | temperature
=entropy       | body       | | | + | energy J @:J/K      | state  | energy
conduction     | conduction | | | + | conductance W/K T_1:K T_2:K | between |
ambient        | ambient    | | | + | conductance W/K T:K T_e:K   | body input |
thermoelectric | coupling   | E | between | + | seebeck V/K T_1:K T_2:K | bodies |
heat_source    | heat       | | | + |                             | into input |
"""  # noqa: E501


class Kind(NamedTuple):
    """A kind: `ends` are node fields with domains, `laws` law fields with unit and letters.

    `fields` has all fields, and whether each is required; x in `costate` is the state minus `rest`.
    """

    form: str
    ends: list[tuple[str, str]]
    across: bool
    laws: dict[str, tuple[str, dict[str, str]]]
    fields: dict[str, bool]
    costate: str


def _kind(row: str) -> tuple[str, Kind]:
    name, form, domains, nodes, across, laws, others, costate = map(str.strip, row.split("|"))
    table = [text.split() for text in laws.split(";") if text]
    words = ["kind", *nodes.split(), *others.split(), *(field for field, *_ in table)]
    ends = [*zip(nodes.replace("?", "").split(), domains, strict=True)]
    units = {f.rstrip("?"): (u, dict(x.split(":") for x in own)) for f, u, *own in table}
    fields = {word.rstrip("?"): word[-1] != "?" for word in words}
    if form == "store" and name[0] != "=":  # its co-state or energy may be given instead
        first, (_, own) = next(iter(units.items()))
        also = {_COSTATES[domains + across]: own, ("energy", "J"): own}
        units = {first: units[first]} | {f: (u, x) for (f, u), x in also.items()} | units
        fields |= dict.fromkeys((first, *(f for f, _ in also)), False)
    return name, Kind(form, ends, across == "+", units, fields, costate)


#: The field for the slip law of capacitors and springs, in the co-state and the driving rate.
_SLIPS = {"E": ("; slip? A v:V i:A T:K", ""), "M": ("", "; slip? m/s f:N v:m/s T:K")}
_MORE = {text: " heats? discontinuous?" * bool(text) for own in _SLIPS.values() for text in own}
_ROWS = [row.split(", ") for row in _DOMAINS.strip().splitlines()]
for _row in _ROWS:
    for _text in _SLIPS.get(_row[0], ("", "")):
        _row += [_text, _MORE[_text]]
_COSTATES = {r[0] + "+": (r[3], r[5]) for r in _ROWS} | {r[0] + "-": (r[6], r[8]) for r in _ROWS}
#: The reference of each domain, and the units of its through and across variables.
REFERENCES, UNITS = {r[0]: r[1] for r in _ROWS}, {r[0]: (r[8], r[5]) for r in _ROWS}
_TEXT = "".join(_WITHIN.format(*row) for row in _ROWS) + _TABLE
KINDS = dict(map(_kind, filter(None, _TEXT.splitlines())))
