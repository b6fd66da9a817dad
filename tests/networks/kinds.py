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


def law(draft, letter, body, *, linear, lanes=None):
    """Return the text of a dissipative law in a letter, with parameters of its own."""
    forms = LINEAR if linear else (*KINKED, *SMOOTH)
    form = draft.pick(forms)
    words = {"z": letter, "low": draft.bodies[body]}
    for word, unit, low, high in (("r", "1", 0.5, 4), ("s", "1", 0.2, 2), ("w", "1", 0.1, 1)):
        if f"{{{word}}}" in form:
            words[word] = draft.parameter(word, unit, low, high, lanes=lanes)
            draft.assume.append(f"{words[word]} > 0")
    return form.format(**words)


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


def spring(draft):
    k = draft.parameter("k", "N/m")
    forms = (k, k, k, f"{k}*(1 + q**2)", f"{k}*(1 + q**2/3)**2", f"{k}*exp(q)")
    rest = {"rest": draft.parameter("q_l", "m", -1, 1)} if draft.one_in(3) else {}
    form = draft.pick(forms[:5]) if not draft.one_in(30) else forms[5]
    return {"between": draft.pair("m"), "stiffness": form, **rest, **draft.state()}


def mass(draft):
    m = draft.parameter("m", "kg")
    return {"at": draft.at(), "mass": draft.pick((m, m, f"2*{m}")), **draft.state()}


def capacitor(draft):
    capacity = draft.parameter("C", "F")
    form = f"{capacity}/(1 + Q**2)" if draft.one_in(50) else capacity
    return {"between": draft.pair("e"), "capacitance": form, **draft.state()}


def inductance(draft, lanes=None, *, saturates=True):
    """Return an inductance; some saturate, and in a bank each lane by itself."""
    linear = draft.parameter("L", "H", lanes=lanes)
    return f"{linear}/(1 + phi**2)" if saturates and draft.one_in(8) else linear


def inductor(draft):
    return {
        "between": draft.pair("e"),
        "inductance": inductance(draft),
        **draft.state(),
    }


def hysteron(draft):
    body = draft.body()
    count = None if draft.one_in(4) else draft.pick((1, 2, 3, 4))
    bank = {} if count is None else {"count": count}
    linear = draft.one_in(2)  # row program stays open for a kink of a current that saturates
    return {
        "between": draft.pair("e"),
        **bank,
        "inductance": inductance(draft, count, saturates=linear),
        "voltage": law(draft, "i", body, linear=linear, lanes=count),
        "heats": body,
        **draft.state(),
    }


def transducer(draft):
    ratio, body = draft.parameter("a", "C/m", 0.3, 2), draft.body()
    hot = {"ratio": f"{ratio}*T/{draft.bodies[body]}", "temperature": body}
    fixed = {"ratio": ratio}
    pairs = {"electrical": draft.pair("e"), "mechanical": draft.pair("m")}
    return {**pairs, **draft.pick((hot, fixed))}


def coupled(draft):
    """Return two pairs of nodes, one of them the new one and an earlier one, and a ratio."""
    ratio = draft.parameter("n", "1", 0.5, 2)
    if not draft.one_in(8):
        draft.assume.append(f"{ratio} > 0")
    domain = KINDS[draft.kind].domains
    new = draft.pair(domain)
    draft.ends = ()
    first, second = draft.pick(((new, draft.pair(domain)), (draft.pair(domain), new)))
    return {"first": first, "second": second, "ratio": draft.pick((ratio, f"2*{ratio}"))}


def thermal_mass(draft):
    low, c = draft.parameter("T_0", "K", 1, 3), draft.parameter("c", "J/K", 1, 3)
    draft.bodies[draft.name] = low
    exponential, polynomial = f"{low}*exp(S/{c})", f"{low} + S/{c}"
    form = draft.pick((exponential, exponential, polynomial, f"{polynomial} + S**2/{c}**2"))
    return {"temperature": form, **draft.state()}


def conduction(draft):
    hot = draft.body()
    cold = draft.pick([name for name in draft.bodies if name != hot])
    return {"between": [hot, cold], "conductance": draft.parameter("lam", "W/K")}


def ambient(draft):
    lam = draft.parameter("lam", "W/K")
    return {"body": draft.body(), "conductance": lam, "input": draft.input("K", 4.0)}


def voltage_source(draft):
    return {"between": draft.pair("e"), "input": draft.input("V")}


def current_source(draft):
    return {"between": draft.pair("e"), "input": draft.input("A")}


def force_source(draft):
    return {"at": draft.at(), "input": draft.input("N")}


def velocity_source(draft):
    return {"at": draft.at(), "input": draft.input("m/s")}


@dataclass(frozen=True)
class Kind:
    """One kind of element, by hand: how it is drawn, and what the reference solution knows of it.

    Attributes
    ----------
    draw : draws the fields of its table.
    domains : "e", "m" or both; "" for the thermal kinds.
    form : a "store", "law" (of dissipation), "store, law" (in series), "source" or "coupling".
    across : whether it gives an across variable, and so may be in a tree of the network; a coupling
        that does not, gyrates.
    nodes : the fields that name nodes.
    letter, costate : of a store; the co-state is found from the words of a law and from its laws.
    laws : field -> (the letter of what it is given, whether it gives the across variable).
    weight : how often it is drawn, beside others.
    """

    draw: Callable
    domains: str = ""
    form: str = ""
    across: bool = True
    nodes: tuple[str, ...] = ("between",)
    letter: str = ""
    costate: Callable | None = None
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
BOTH = ("electrical", "mechanical")
KINDS = {
    "capacitor": Kind(capacitor, "e", "store", letter="Q", costate=over("capacitance"), weight=2),
    "mass": Kind(mass, "m", "store", nodes=("at",), letter="p", costate=over("mass"), weight=3),
    "inductor": Kind(
        inductor, "e", "store", across=False, letter="phi", costate=over("inductance")
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
    "spring": Kind(spring, "m", "store", across=False, letter="q", costate=of_spring, weight=2),
    "voltage_source": Kind(voltage_source, "e", "source"),
    "velocity_source": Kind(velocity_source, "m", "source", nodes=("at",)),
    "resistor": Kind(
        dissipative, "e", "law", laws={"voltage": ("i", True), "current": ("v", False)}
    ),
    "damper": Kind(dissipative, "m", "law", laws={"velocity": ("f", True), "force": ("v", False)}),
    "current_source": Kind(current_source, "e", "source", across=False),
    "force_source": Kind(force_source, "m", "source", across=False, nodes=("at",)),
    "transformer": Kind(coupled, "e", "coupling", nodes=PAIRS),
    "lever": Kind(coupled, "m", "coupling", nodes=PAIRS, weight=2),
    "transducer": Kind(transducer, "em", "coupling", across=False, nodes=BOTH),
    "thermal_mass": Kind(thermal_mass, letter="S"),
    "conduction": Kind(conduction),
    "ambient": Kind(ambient),
}
