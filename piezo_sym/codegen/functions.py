"""The functions of a module: rates, outputs, supply, energy, entropy, heat, production.

Input: the quantities of a system.  Output: `Function` records, rows in the order of states, ports
and processes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.program import Function, Limit, Row, bank_of
from piezo_sym.codegen.quantities import Quantities
from piezo_sym.expressions.calculus import add, div, mul, neg
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.text import signed
from piezo_sym.expressions.tree import ONE, Expr, Num, Sym
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.definitions import costate_name
from piezo_sym.spec.elements.ports import Body, Exchange
from piezo_sym.spec.model import Model
from piezo_sym.spec.tables import condition_text, conditions

STATE_INPUT = ("x", "u", "p")
STATE = ("x", "p")


def functions_of(iphs: IPHS, q: Quantities) -> tuple[Function, ...]:
    """Return every function of the module but the Jacobian and the margins."""
    doc = "State at t = 0 [SI], for the inputs u at t = 0"
    return (
        Function("initial_state", doc, ("u", "p"), tuple(_starts(iphs))),
        Function("rhs", "Rates dx/dt = J_ir dU/dx + g u", STATE_INPUT, rates_of(iphs, q)),
        *ports_of(q),
        *_of_stores(iphs, q),
        *_of_processes(iphs, q),
    )


def rates_of(iphs: IPHS, q: Quantities) -> tuple[Row, ...]:
    """Return dx/dt row by row: structure, then processes, then inputs."""
    system = iphs.system
    rows = []
    for n, slot in enumerate(system.states):
        if isinstance(q.stores[n][1], Body):
            value = _entropy_rate(n, q)
        else:
            terms = [*q.row(system.J0, n, q.costate)]
            terms += [neg(term) for term in q.row(system.B, n, lambda k: q.outputs[k])]
            terms += [*q.row(system.G, n, q.input)]
            value = add(*_arranged(terms, q))
        rows.append(Row(slot, value))
    return tuple(rows)


def _arranged(terms: list[Expr], q: Quantities) -> list[Expr]:
    """Return terms with those all lanes share first, and a positive one in front if there is one.

    In array code the shared part of a bank's row is then computed once, and no array is negated.
    """
    lanes = {quantity.name: quantity.bank for quantity in q.defined if quantity.bank}
    ordered = sorted(terms, key=lambda term: bank_of(term, lanes) is not None)
    front = next((term for term in ordered if signed(term)[0] == "+"), None)
    if front is None:
        return ordered
    ordered.remove(front)
    return [front, *ordered]


def _entropy_rate(n: int, q: Quantities) -> Expr:
    """Return a body's heats over its temperature, and what its environments bring."""
    placed, port = q.stores[n]
    temperature = Sym(costate_name(port))
    heats = [q.heat(k) for k, row in enumerate(q.system.heats) if row == n]
    terms = [div(add(*heats), temperature)] if heats else []
    terms += [neg(term) for term in q.row(q.system.B, n, lambda k: q.outputs[k])]
    terms += [brought for body, brought in exchanges_of(q) if body == placed.element]
    return add(*terms)


def exchanges_of(q: Quantities) -> Iterator[tuple[str, Expr]]:
    """Yield the entropy rate that each heat exchange brings, and the body that gets it."""
    for entry in q.ports:
        if isinstance(entry.port, Exchange):
            temperature = Sym(q.bodies[entry.port.body].temperature)
            drive = add(div(Sym(entry.port.input), temperature), neg(ONE))
            yield entry.port.body, mul(entry.port.conductance, drive)


def ports_of(q: Quantities) -> Iterator[Function]:
    """Yield the outputs and the power put in, a row per port."""
    slots = [Slot(placed.element) for placed in q.ports]
    outputs = [_output(n, q) for n in range(len(slots))]
    powers = [_power(n, q, y) for n, y in enumerate(outputs)]
    doc = "Outputs y, one per port, conjugate to its input"
    yield Function("outputs", doc, STATE_INPUT, _rows(slots, outputs))
    doc = "Power put in [W], one per port; the sum is dU/dt"
    yield Function("supply", doc, STATE_INPUT, _rows(slots, powers))


def _output(n: int, q: Quantities) -> Expr:
    port = q.ports[n].port
    if isinstance(port, Exchange):
        return Sym(q.bodies[port.body].temperature)
    return add(
        *q.row(q.system.G.T, n, q.costate),
        *q.row(q.system.D, n, lambda k: q.outputs[k]),
        *q.row(q.system.N, n, q.input),
    )


def _power(n: int, q: Quantities, y: Expr) -> Expr:
    port = q.ports[n].port
    if isinstance(port, Exchange):
        return mul(port.conductance, add(Sym(port.input), neg(y)))
    return mul(y, q.input(n))


def _of_stores(iphs: IPHS, q: Quantities) -> Iterator[Function]:
    terms = []
    for energy, slot in zip(iphs.energies, iphs.system.states, strict=True):
        base = f"energy_{slot.label}"
        terms.append(q.total(energy, slot.bank, base) if slot.bank else energy)
    yield Function("energy", "Hamiltonian U [J]", STATE, _rows([Slot("U")], [add(*terms)]), True)
    entropy = add(*(Sym(port.state) for port in q.bodies.values()))
    doc = "Total entropy S [J/K]"
    yield Function("entropy", doc, STATE, _rows([Slot("S")], [entropy]), True)
    slots = [Slot(name) for name in q.bodies]
    values: list[Expr] = [Sym(port.temperature) for port in q.bodies.values()]
    yield Function("temperatures", "Temperature of each body [K]", STATE, _rows(slots, values))


def _of_processes(iphs: IPHS, q: Quantities) -> Iterator[Function]:
    slots = iphs.system.processes
    doc = "Power that each process turns into heat [W]; of a bank, one row per lane"
    yield Function("heat", doc, STATE_INPUT, _rows(slots, q.heats))
    parts = zip(q.outputs, q.forces, q.system.heats, strict=True)
    produced = [div(mul(output, force), q.costate(n)) for output, force, n in parts]
    doc = "Entropy that each process produces [W/K]; of a bank, one row per lane"
    yield Function("entropy_production", doc, STATE_INPUT, _rows(slots, produced))


def _rows(slots: Iterable[Slot], values: Iterable[Expr]) -> tuple[Row, ...]:
    return tuple(Row(slot, value) for slot, value in zip(slots, values, strict=True))


def _starts(iphs: IPHS) -> Iterator[Row]:
    model = iphs.model
    for slot in iphs.system.states:
        start = model.initial.get(slot.label, 0.0)
        parts = start if isinstance(start, tuple) else (start,)
        trees = tuple(_start(part) for part in parts)
        yield Row(slot, trees[0], trees if len(trees) > 1 else ())


def _start(part: str | float) -> Expr:
    return parse_law(part, "initial") if isinstance(part, str) else Num(Fraction(repr(part)))


def limits_of(model: Model, q: Quantities) -> tuple[Limit, ...]:
    """Return the conditions of the domain as margins: left minus right side, or the reverse."""
    limits = []
    for condition in conditions(model):
        tree = condition.tree
        sides = (tree.left, tree.right) if tree.op.startswith(">") else (tree.right, tree.left)
        margin = q.sharp(add(sides[0], neg(sides[1])))
        limits.append(Limit(condition_text(tree), "=" not in tree.op, margin))
    return tuple(limits)
