"""The functions of a module: rates, outputs, supply, energy, entropy, heat, production.

Input: the quantities of a system.  Output: `ModuleFunction` records, rows in the order of states,
ports and processes.
"""

from collections.abc import Iterable, Iterator

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.program import ModuleFunction, Names, OutputRow, Quantity, bank_of
from piezo_sym.codegen.quantities import Quantities
from piezo_sym.expressions.calculus import add, div, inserted, mul, neg
from piezo_sym.expressions.text import signed
from piezo_sym.expressions.tree import ONE, Expr, Sym, names
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.elements import ElementRow, element_rows, follower_rates, in_words
from piezo_sym.network import Driven
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    Exchange,
    HeatInput,
    Source,
)

STATE_INPUT, STATE = ("x", "u", "p"), ("x", "p")
#: Docstring and arguments of each function.
FUNCTIONS = {
    "initial_state": ("State at t = 0 [SI], for the inputs u at t = 0", ("u", "p")),
    "rhs": ("Rates dx/dt, the rows of J_ir dU/dx + g u", STATE_INPUT),
    "outputs": (
        "Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient",
        STATE_INPUT,
    ),
    "supply": ("Power supplied through each port [W]; the sum is dU/dt", STATE_INPUT),
    "energy": ("Hamiltonian U [J]", STATE),
    "entropy": ("Total entropy S [J/K]", STATE),
    "temperatures": ("Temperature of each body [K]", STATE),
    "elements": (
        "Effort, flow, power, energy and heat of elements; of a bank, one row per lane",
        STATE_INPUT,
    ),
    "heat": (
        "Power that each process turns into heat [W]; of a bank, one row per lane",
        STATE_INPUT,
    ),
    "entropy_production": (
        "Entropy production of each process [W/K], heat exchange with ambients not included; of a "
        "bank, one row per lane",
        STATE_INPUT,
    ),
}


def functions_of(q: Quantities) -> tuple[ModuleFunction, ...]:
    """Return the functions of the module, except Jacobian, margins and elements."""
    temperatures = (Sym(port.temperature) for port in q.bodies.values())
    S = add(*(Sym(port.state) for port in q.bodies.values()))
    U = add(*(q.total(e.law, e.bank) if e.bank else e.law for e in q.iphs.energies))
    functions = [
        ("initial_state", _initial_rows(q.iphs)),
        ("rhs", rates_of(q)),
        ("outputs", _outputs(q)),
        ("supply", supply_of(q)),
        ("energy", (OutputRow(Slot("U"), U),)),
        ("entropy", (OutputRow(Slot("S"), S),)),
        ("temperatures", _rows(map(Slot, q.bodies), temperatures)),
        ("heat", heats_of(q)),
        ("entropy_production", productions_of(q)),
    ]
    return tuple(
        ModuleFunction(name, *FUNCTIONS[name], rows, name in {"energy", "entropy"})
        for name, rows in functions
    )


def elements_of(
    q: Quantities, rates: tuple[OutputRow, ...], new: Names
) -> tuple[tuple[ElementRow, ...], tuple[Quantity, ...]]:
    """Return the rows of all elements, and the quantities that name rates for them."""
    iphs, named, values = q.iphs, list[Quantity](), list[Expr]()
    for row in rates:
        if not isinstance(row.value, Sym):
            named.append(Quantity(new(f"rate_{row.slot.label}"), row.value, row.slot.bank, "rates"))
        values.append(row.value if isinstance(row.value, Sym) else Sym(named[-1].name))
    words = in_words(
        {
            "rate": values,
            "drive": q.drives,
            "heat": q.heats,
            "input": _definition_inputs(q),
            "output": [row.value for row in _outputs(q)],
            "supply": [row.value for row in supply_of(q)],
        }
    )
    followers = [inserted(rate, words) for rate in follower_rates(iphs)]
    blocks = zip("EWuR", (q.costates, q.outputs, q.inputs, followers), strict=True)
    given = [(iphs.junction.couplings[kind], factors) for kind, factors in blocks]
    answers = [add(*q.terms(n, *given)) for n in range(len(given[0][0].rows))]
    words |= in_words({"answer": answers})
    found = list[ElementRow]()
    for entry in element_rows(iphs):
        spelled = words.keys().isdisjoint(names(entry.value))  # nothing to replace
        found.append(entry if spelled else entry._replace(value=inserted(entry.value, words)))
    return tuple(found), tuple(named)


def rates_of(q: Quantities) -> tuple[OutputRow, ...]:
    """Return dx/dt row by row: structure, then processes, then inputs."""
    rows = []
    for n, slot in enumerate(q.iphs.system.states):
        if isinstance(q.stores[n][1], Body):
            value = _entropy_rate(n, q)
        else:
            terms = [*_structure_terms(n, q), *q.terms(n, (q.iphs.system.G, q.inputs))]
            value = add(*_shared_first(terms, q))
        rows.append(OutputRow(slot, value))
    return tuple(rows)


def _structure_terms(n: int, q: Quantities) -> Iterator[Expr]:
    """Yield the terms of a rate from co-states and from outputs of processes."""
    yield from q.terms(n, (q.iphs.system.J0, q.costates))
    yield from map(neg, q.terms(n, (q.iphs.system.B, q.outputs)))


def _shared_first(terms: list[Expr], q: Quantities) -> list[Expr]:
    """Return terms, those that all lanes share first, and a positive one in front of all.

    In array code, the shared part of a bank's row is then computed once, and no array is negated.
    """
    ordered = sorted(terms, key=lambda term: bank_of(term, q.lanes) is not None)
    front = next((n for n, term in enumerate(ordered) if signed(term)[0] == "+"), 0)
    return [*ordered[front : front + 1], *ordered[:front], *ordered[front + 1 :]]


def _entropy_rate(n: int, q: Quantities) -> Expr:
    """Return the entropy rate of a body: heats over temperature, conduction, currents, inputs."""
    slots = q.iphs.system.processes
    heats = [
        q.total(q.heats[k], slots[k].bank) for k, row in enumerate(q.iphs.system.heats) if row == n
    ]
    terms = [div(add(*heats), q.costates[n])] if heats else []
    terms += _structure_terms(n, q)
    return add(*terms, *q.terms(n, (q.iphs.system.G, _definition_inputs(q))))


def exchanges_of(q: Quantities) -> Iterator[OutputRow]:
    """Yield the entropy rate into a body from each heat exchange or heat source."""
    for _, port in q.ports:
        if isinstance(port, Exchange | HeatInput):
            yield OutputRow(Slot(port.body), _definition_input(port, q))


def _definition_inputs(q: Quantities) -> list[Expr]:
    """Return the inputs u of Definition 1, one per port."""
    return [_definition_input(port, q) for _, port in q.ports]


def _definition_input(port: Driven, q: Quantities) -> Expr:
    """Return the input of Definition 1 for a port: its input itself, P/T or lam*(T_e/T - 1)."""
    if isinstance(port, Source):
        return Sym(port.input)
    ratio = div(Sym(port.input), Sym(q.bodies[port.body].temperature))
    return mul(port.conductance, add(ratio, neg(ONE))) if isinstance(port, Exchange) else ratio


def _outputs(q: Quantities) -> tuple[OutputRow, ...]:
    rows, system = [], q.iphs.system
    blocks = (system.G.T, q.costates), (system.D, q.outputs), (system.N, q.inputs)
    for n, (placed, port) in enumerate(q.ports):
        if isinstance(port, Source):
            value = add(*q.terms(n, *blocks))
        else:
            value = Sym(q.bodies[port.body].temperature)
        rows.append(OutputRow(Slot(placed.element), value))
    return tuple(rows)


def supply_of(q: Quantities) -> tuple[OutputRow, ...]:
    """Return the power supplied through each port."""
    rows = []
    for y, (_, port), u in zip(_outputs(q), q.ports, q.inputs, strict=True):
        power: Expr = u if isinstance(port, HeatInput) else mul(y.value, u)
        if isinstance(port, Exchange):
            power = mul(port.conductance, add(u, neg(y.value)))
        rows.append(OutputRow(y.slot, power))
    return tuple(rows)


def heats_of(q: Quantities) -> tuple[OutputRow, ...]:
    """Return the power that each process turns into heat."""
    return _rows(q.iphs.system.processes, q.heats)


def productions_of(q: Quantities) -> tuple[OutputRow, ...]:
    """Return the entropy that each process produces."""
    parts = zip(q.processes, q.outputs, q.forces, q.heats, q.iphs.system.heats, strict=True)
    produced = (
        div(mul(output, force) if isinstance(port, Conductor) else heat, q.costates[n])
        for (_, port), output, force, heat, n in parts
    )
    return _rows(q.iphs.system.processes, produced)


def _rows(slots: Iterable[Slot], values: Iterable[Expr]) -> tuple[OutputRow, ...]:
    return tuple(OutputRow(slot, value) for slot, value in zip(slots, values, strict=True))


def _initial_rows(iphs: IPHS) -> tuple[OutputRow, ...]:
    """Return the initial state; the row of a bank lists its lanes if they differ."""
    rows = zip(iphs.system.states, iphs.starts, strict=True)
    return tuple(OutputRow(slot, one, (one, *more) if more else ()) for slot, (one, *more) in rows)
