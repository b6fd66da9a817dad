"""All that tests of random networks know of a kind of element: one row in `KINDS`.

A function draws the fields of its table, given a `strategy.Draft`, which names parameters, inputs,
nodes and bodies.  The rest of a row is typed by hand from the kind's law, for the reference
solution in `tableau`: nothing of the package is used.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

LINEAR = (
    "{r}*{z}",
    "{z}/{r}",
    "2*{z}*{r}",
    "{r}*{z} + {s}*{z}/3",
    "({r} + {s}*T)*({z} + {z})/2",
    "{r}*{z}*(1 + {s}*(T/{low} - 1))",
    "{r}*exp({s}*({low}/T - 1))*{z}",
)
KINKED = (
    "{r}*deadzone({z}, {w})",
    "{r}/(T - {low})*deadzone({z}, {w})",
    "{r}*deadzone({z}, {w}*T/{low})",
    "{r}*saturate({z}, {w})",
    "{r}*{z}*abs({z})",
    "{r}*max({z}, 0) + {s}*min({z}, 0)",
    "{r}*{z} if {z} >= 0 else {s}*{z}",
    "{r}*sign({z})*sqrt(abs({z}) + {w})",
)
SMOOTH = (
    "{r}*tanh({z}/{w})",
    "{r}*tanh({z}*{low}/({w}*T))",
    "{r}*{z}**3",
    "{r}*{z} + {s}*{z}**3*T/{low}",
    "{r}*{z}*log(1 + {s}*{z}**2)",
    "{r}*{z}/sqrt(1 + {z}**2/{w}**2)",
    "{r}*{z} + {s}*sin({z})",
)


SEEN = ("1 + {x}**2", "1 + abs({x})", "2 + tanh({x})", "1 if {x} > 0 else 1 + {x}**2")


def seeing(draft, text, own=""):
    """Return a law, at times with a factor of another element's state, or a temperature."""
    there = [own] * bool(own) + draft.states()
    if not draft.one_in(3):
        return text
    if there and draft.one_in(2):
        return f"({text})*({draft.pick(SEEN).format(x=draft.pick(there))})"
    body = draft.body()
    return f"({text})*T_{body}/{draft.bodies[body]}"


def law(draft, letter, body, *, linear, own=""):
    """Return the text of a dissipative law in a letter, with parameters of its own."""
    forms = LINEAR if linear else (*KINKED, *SMOOTH)
    form = draft.pick(forms)
    words = {"z": letter, "low": draft.bodies[body]}
    for word, unit, low, high in (("r", "1", 0.5, 4), ("s", "1", 0.2, 2), ("w", "1", 0.1, 1)):
        if f"{{{word}}}" in form:
            words[word] = draft.parameter(word, unit, low, high)
            draft.assume.append(f"{words[word]} > 0")
    return seeing(draft, form.format(**words), own)


def dissipative(draft):
    """Return a resistor's or damper's fields.

    In a tree it gives the across variable, in a chord the other; a linear law may say either.
    """
    kind, body = KINDS[draft.kind], draft.body()
    names = sorted(kind.laws, key=lambda name: kind.laws[name][1])
    name = names[-1 if draft.role == "tree" else 0]
    if draft.one_in(4):
        name = draft.pick(names)
    text = law(draft, kind.laws[name][0], body, linear=draft.linear or draft.one_in(2))
    jumps = {"discontinuous": True} if "sign" in text else {}
    return {"between": draft.pair(kind.domains), name: text, "heats": body, **jumps}


def stiff(draft):
    """Return a spring's fields, of any domain: x is the extension over a unit of it."""
    x, unit, at_rest = KINDS[draft.kind].size
    k = draft.parameter("k", unit)
    forms = (k, k, k, f"{k}*(1 + {x}**2)", f"{k}*(1 + {x}**2/3)**2", f"{k}*exp({x})")
    rest = {"rest": draft.parameter("q_l", at_rest, -1, 1)} if draft.one_in(3) else {}
    form = draft.pick(forms[:5]) if not draft.one_in(30) else forms[5]
    form = k if draft.role == "tied" else form
    ends, law = draft.pair(KINDS[draft.kind].domains), {"stiffness": form, **rest}
    return {"between": ends, **itself(draft, k, law), **draft.state()}


def itself(draft, k, otherwise):
    """Return a store's law of its co-state, or its energy, that rise by k; mostly the other law."""
    if draft.role == "tied" or not draft.one_in(5):
        return otherwise
    x = KINDS[draft.kind].letter
    laws = (f"{k}*{x} if {x} < 0.5 else 4*{k}*{x} - 1.5*{k}", f"{k}*sinh({x})", f"{k}*tanh({x})")
    energies = (f"{k}*{x}**2/2", f"{k}*max({x} - 0.2, 0)**2", f"{k}*cosh({x})")
    field, texts = draft.pick(((KINDS[draft.kind].itself, laws), ("energy", energies)))
    return {field: draft.pick(texts)}


def inert(draft):
    """Return a mass's or an inertia's fields."""
    field, unit = KINDS[draft.kind].size
    m = draft.parameter("m", unit)
    law = itself(draft, m, {field: draft.pick((m, m, f"2*{m}"))})
    return {"at": draft.at(), **law, **draft.state()}


def capacitor(draft):
    capacity = draft.parameter("C", "F")
    form = f"{capacity}/(1 + Q**2)" if draft.one_in(50) else capacity
    law = itself(draft, capacity, {"capacitance": form})
    return {"between": draft.pair("e"), **law, **draft.state()}


def of_fluid(draft):
    """Return an accumulator's or an inertance's fields."""
    field, unit = KINDS[draft.kind].size
    size = draft.parameter("C", unit)
    return {"between": draft.pair("h"), **itself(draft, size, {field: size}), **draft.state()}


def saturating(draft, linear):
    """Return an inductance; some saturate, and in a bank each lane by itself."""
    return f"{linear}/(1 + phi**2)" if draft.one_in(8) else linear


def inductor(draft):
    linear = draft.parameter("L", "H")
    law = itself(draft, linear, {"inductance": saturating(draft, linear)})
    return {"between": draft.pair("e"), **law, **draft.state()}


def hysteron(draft):
    body = draft.body()
    linear = draft.one_in(2)  # row program stays open for a kink of a current that saturates
    state, size = draft.state(), draft.parameter("L", "H")
    own = state.get("state", f"phi_{draft.name}")
    return {
        "between": draft.pair("e"),
        "inductance": saturating(draft, size) if linear else size,
        "voltage": law(draft, "i", body, linear=linear, own=own),
        "heats": body,
        **state,
    }


def stop(draft):
    body = draft.body()
    k, limit = draft.parameter("k", "N/m"), draft.parameter("F_c", "N", 0.1, 1)
    draft.assume.append(f"{limit} >= 0")
    law = {"stiffness": k, "limit": limit, "heats": body}
    return {"between": draft.pair("m"), **law, **draft.state()}


def transducer(draft):
    ratio, body = draft.parameter("a", "C/m", 0.3, 2), draft.body()
    hot = {"ratio": f"{ratio}*T/{draft.bodies[body]}", "temperature": body}
    fixed = {"ratio": seeing(draft, ratio)}
    pairs = {"electrical": draft.pair("e"), draft.pick(MOVES): draft.pair("m")}
    return {**pairs, **draft.pick((hot, fixed))}


def motor(draft):
    there = [d for d in "mr" if len(draft.nodes[d]) > 1]
    moves = draft.ends[0] if draft.ends and draft.ends[0] in "mr" else draft.pick(there)
    field, unit = {"m": ("translation", "V*s/m"), "r": ("rotation", "V*s/rad")}[moves]
    pairs = {"electrical": draft.pair("e"), field: draft.pair(moves)}
    return {**pairs, "constant": positive(draft, unit)}


def converter(draft):
    """Return the fields of a coupling of two domains whose ratio is a parameter."""
    kind = KINDS[draft.kind]
    pairs = {field: draft.pair(d) for field, d in zip(kind.nodes, kind.domains, strict=True)}
    return {**pairs, kind.ratio: positive(draft, kind.size[0])}


def positive(draft, unit):
    """Return a new parameter for a ratio, which the domain says is positive."""
    ratio = draft.parameter("n", unit, 0.5, 2)
    draft.assume.append(f"{ratio} > 0")
    return ratio


def coupled(draft):
    """Return two pairs of nodes, one of them the new one and an earlier one, and a ratio."""
    ratio = draft.parameter("n", "1", 0.5, 2)
    if not draft.one_in(8):
        draft.assume.append(f"{ratio} > 0")
    domain = KINDS[draft.kind].domains
    new = draft.pair(domain)
    draft.ends = ()
    first, second = draft.pick(((new, draft.pair(domain)), (draft.pair(domain), new)))
    return {
        "first": first,
        "second": second,
        "ratio": seeing(draft, draft.pick((ratio, f"2*{ratio}"))),
    }


def thermal_mass(draft):
    low, c = draft.parameter("T_0", "K", 1, 3), draft.parameter("c", "J/K", 1, 3)
    draft.bodies[draft.name] = low
    exponential, polynomial = f"{low}*exp(S/{c})", f"{low} + S/{c}"
    form = draft.pick((exponential, exponential, polynomial, f"{polynomial} + S**2/{c}**2"))
    return {"temperature": form, **draft.state()}


def conduction(draft):
    hot = draft.body()
    cold = draft.pick([name for name in draft.bodies if name != hot])
    lam = draft.parameter("lam", "W/K")
    forms = (lam, f"{lam}*(T_1**2 + T_2**2)*(T_1 + T_2)", seeing(draft, lam))
    return {"between": [hot, cold], "conductance": draft.pick(forms)}


def ambient(draft):
    lam = draft.parameter("lam", "W/K")
    forms = (lam, f"{lam}*(T**2 + T_e**2)*(T + T_e)", seeing(draft, lam))
    conductance, given = draft.pick(forms), draft.input("K", 4.0)
    return {"body": draft.body(), "conductance": conductance, "input": given}


def heat_source(draft):
    return {"into": draft.body(), "input": draft.input("W")}


def thermoelectric(draft):
    cold = draft.body()
    hot = draft.pick([name for name in draft.bodies if name != cold])
    s = draft.parameter("s", "V/K", 0.3, 2)
    seebeck = draft.pick((s, f"{s}*(T_1 + T_2)/{draft.bodies[hot]}", seeing(draft, s)))
    return {"between": draft.pair("e"), "bodies": [cold, hot], "seebeck": seebeck}


def storage(draft):
    """Return an energy of a flux and an extension, at times of an entropy, too: a body then."""
    L, k = draft.parameter("L", "H"), draft.parameter("k", "N/m")
    draft.assume.append(f"{L} > 0")
    phi, x = f"phi_{draft.name}", f"x_{draft.name}"
    coupled = (f"{phi}**2*(2 + {x}**2)/{L}", f"{phi}**2/{L}*exp({x}/3)", f"{phi}**2/{L}")
    alone = (f"{k}*{x}**2/2", f"{k}*{x}*abs({x})**2", f"{k}/2*max({x} - 0.3, 0)**2 + {k}*{x}")
    states = {phi: {"rate": "voltage", "between": draft.pair("e")}}
    states[x] = {"rate": "velocity", "between": draft.pair("m")}
    energy = f"{draft.pick(coupled)} + {draft.pick(alone)}"
    if draft.one_in(3):
        low, c, S = (
            draft.parameter("T_0", "K", 1, 3),
            draft.parameter("c", "J/K", 1, 3),
            "S_" + draft.name,
        )
        hot = (f"(1 + {x}**2/2)", f"(1 + {phi}**2/3)", f"(1 + exp({x})/4)")
        heated = f"{low}*{c}*exp({S}/{c})*{draft.pick(hot)}"
        energy = f"{heated} + {draft.pick((energy, f'{phi}**2/{L}'))}"
        draft.bodies[draft.name] = low
        draft.assume += [f"{low} > 0", f"{c} > 0"]
        states[S] = {"rate": "entropy"}
    return {"energy": energy, "states": states}


def source(draft):
    """Return a source's fields, whatever it gives."""
    kind = KINDS[draft.kind]
    place = {"at": draft.at()} if kind.nodes == AT else {"between": draft.pair(kind.domains)}
    return {**place, "input": draft.input(kind.size[0])}


AT = ("at",)
MOVES = ("translation", "mechanical")


@dataclass(frozen=True)
class Kind:
    """One kind of element, by hand: how it is drawn, and what the reference solution knows of it.

    Attributes
    ----------
    draw : draws the fields of its table.
    domains : letters of the domains of its pairs of nodes; "" for the thermal kinds.
    form : a "store", "storage" (of several states), "law" (of dissipation), "store, law" (in
        series), "stop", "source" or "coupling".
    across : whether it gives an across variable, and so may be in a tree of the network; a coupling
        that does not, gyrates.
    nodes : the fields that name nodes.
    letter, costate : of a store; the co-state is found from the words of a law and from its laws.
    itself : the field in which a store says its co-state.
    size : what `draw` asks for: units, a letter, the field of a store.
    ratio : the field of a coupling's ratio.
    laws : field -> (the letter of what it is given, whether it gives the across variable).
    weight : how often it is drawn, beside others.
    """

    draw: Callable
    domains: str = ""
    form: str = ""
    across: bool = True
    nodes: tuple[str, ...] = ("between",)
    size: tuple[str, ...] = ()
    ratio: str = "ratio"
    letter: str = ""
    costate: Callable | None = None
    itself: str = ""
    laws: Mapping[str, tuple[str, bool]] = field(default_factory=dict)
    weight: int = 1

    @property
    def in_tree(self):
        """Whether it may give the across variable between two nodes."""
        return True in self._gives

    @property
    def is_chord(self):
        """Whether it may give a through variable."""
        return False in self._gives

    @property
    def _gives(self):
        if self.form == "law":
            return {gives for _, gives in self.laws.values()}
        return {self.across} if self.form else set()


def over(size):
    """Return the co-state of a store: its state over a law."""
    return lambda state, law: state / law(size)


def of_spring(q, law):
    return law("stiffness") * (q - law("rest", "0"))


PAIRS = ("first", "second")
BOTH = ("electrical", "mechanical", "translation")
KINDS = {
    "stop": Kind(stop, "m", "stop", across=False, letter="z"),
    "capacitor": Kind(
        capacitor,
        "e",
        "store",
        letter="Q",
        costate=over("capacitance"),
        itself="voltage",
        weight=2,
    ),
    "mass": Kind(
        inert,
        "m",
        "store",
        nodes=AT,
        size=("mass", "kg"),
        letter="p",
        costate=over("mass"),
        itself="velocity",
        weight=3,
    ),
    "inertia": Kind(
        inert,
        "r",
        "store",
        nodes=AT,
        size=("inertia", "kg*m**2"),
        letter="L",
        costate=over("inertia"),
        itself="angular_velocity",
        weight=3,
    ),
    "accumulator": Kind(
        of_fluid,
        "h",
        "store",
        size=("capacitance", "m**3/Pa"),
        letter="V",
        costate=over("capacitance"),
        itself="pressure",
        weight=2,
    ),
    "inductor": Kind(
        inductor,
        "e",
        "store",
        across=False,
        letter="phi",
        costate=over("inductance"),
        itself="current",
    ),
    "inertance": Kind(
        of_fluid,
        "h",
        "store",
        across=False,
        size=("inertance", "Pa*s**2/m**3"),
        letter="G",
        costate=over("inertance"),
        itself="flow",
    ),
    "hysteron": Kind(
        hysteron,
        "e",
        "store, law",
        across=False,
        letter="phi",
        costate=over("inductance"),
        laws={"voltage": ("i", True)},
        weight=2,
    ),
    "spring": Kind(
        stiff,
        "m",
        "store",
        across=False,
        size=("q", "N/m", "m"),
        letter="q",
        costate=of_spring,
        itself="force",
        weight=2,
    ),
    "torsion_spring": Kind(
        stiff,
        "r",
        "store",
        across=False,
        size=("theta", "N*m/rad", "rad"),
        letter="theta",
        costate=of_spring,
        itself="torque",
        weight=2,
    ),
    "storage": Kind(storage, "em", "storage", across=False, nodes=(), weight=2),
    "voltage_source": Kind(source, "e", "source", size=("V",)),
    "velocity_source": Kind(source, "m", "source", nodes=AT, size=("m/s",)),
    "angular_velocity_source": Kind(source, "r", "source", nodes=AT, size=("rad/s",)),
    "pressure_source": Kind(source, "h", "source", size=("Pa",)),
    "resistor": Kind(
        dissipative, "e", "law", laws={"voltage": ("i", True), "current": ("v", False)}
    ),
    "damper": Kind(dissipative, "m", "law", laws={"velocity": ("f", True), "force": ("v", False)}),
    "rotational_damper": Kind(
        dissipative,
        "r",
        "law",
        laws={"angular_velocity": ("tau", True), "torque": ("omega", False)},
    ),
    "orifice": Kind(
        dissipative, "h", "law", laws={"pressure": ("flow", True), "flow": ("dp", False)}
    ),
    "current_source": Kind(source, "e", "source", across=False, size=("A",)),
    "force_source": Kind(source, "m", "source", across=False, nodes=AT, size=("N",)),
    "torque_source": Kind(source, "r", "source", across=False, nodes=AT, size=("N*m",)),
    "flow_source": Kind(source, "h", "source", across=False, size=("m**3/s",)),
    "transformer": Kind(coupled, "e", "coupling", nodes=PAIRS),
    "lever": Kind(coupled, "m", "coupling", nodes=PAIRS, weight=2),
    "gear": Kind(coupled, "r", "coupling", nodes=PAIRS, weight=2),
    "transducer": Kind(transducer, "em", "coupling", across=False, nodes=BOTH, weight=2),
    "motor": Kind(
        motor,
        "emr",
        "coupling",
        nodes=("electrical", "translation", "rotation"),
        ratio="constant",
        weight=3,
    ),
    "rack": Kind(
        converter,
        "mr",
        "coupling",
        nodes=("translation", "rotation"),
        size=("m",),
        ratio="radius",
        weight=3,
    ),
    "cylinder": Kind(
        converter,
        "hm",
        "coupling",
        across=False,
        nodes=("hydraulic", "translation"),
        size=("m**2",),
        ratio="area",
        weight=3,
    ),
    "pump": Kind(
        converter,
        "rh",
        "coupling",
        across=False,
        nodes=("rotation", "hydraulic"),
        size=("m**3/rad",),
        ratio="displacement",
        weight=3,
    ),
    "thermal_mass": Kind(thermal_mass, letter="S"),
    "conduction": Kind(conduction),
    "ambient": Kind(ambient),
    "heat_source": Kind(heat_source),
    "thermoelectric": Kind(thermoelectric, "e", "coupling", ratio="seebeck"),
}
