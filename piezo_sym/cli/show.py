"""``piezo-sym show SPEC``: the derived system, to read."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING, Annotated

import typer

from piezo_sym.cli.output import about, print_table
from piezo_sym.errors import listing

if TYPE_CHECKING:
    from piezo_sym.algebra.lanes import LaneMatrix
    from piezo_sym.iphs import IPHS
    from piezo_sym.spec.elements.base import Element
    from piezo_sym.spec.model import Model


def show(
    spec: Annotated[str, typer.Argument(metavar="SPEC", help="Path or shipped name.")],
    latex: Annotated[bool, typer.Option("--latex", help="Print LaTeX.")] = False,
) -> None:
    """Show a spec's elements and its irreversible port-Hamiltonian system: U, rates, domain, J0."""
    from piezo_sym.derivation import derive
    from piezo_sym.spec.load import load

    with about(spec):
        model = load(spec)
        iphs = derive(model)
    if latex:
        typer.echo(iphs.latex())
        return
    for line in (*_head(model), *_banks(iphs.model), ""):
        typer.echo(line)
    _elements(iphs.model, {m.store.state for joint in iphs.junction.joints for m in joint.members})
    for line in _equations(iphs):
        typer.echo(line)


def _head(model: Model) -> Iterator[str]:
    header = model.model
    yield f"{header.name}: {header.title}" if header.title else header.name
    yield from ([f"source: {header.source}"] if header.source else [])
    for name, part in model.components.items():
        without = f", without {', '.join(part.without)}" if part.without else ""
        yield f"component '{name}': {part.spec.text or part.spec.model.model.name}{without}"


def _banks(model: Model) -> Iterator[str]:
    from piezo_sym.spec.tables import banks

    for bank, count in banks(model).items():
        yield f"bank '{bank}': lanes j = 1..r for any r = {bank}_count; {count} in the spec"


def _elements(model: Model, joined: Collection[str]) -> None:
    """Print elements, inputs and parameters, in SI; `joined` are states of joined stores."""
    from piezo_sym.spec.tables import unused_inputs, unused_parameters

    rows: list[tuple[str, ...]] = []
    for name, element in model.elements.items():
        own = "\n".join(_laws(model, name, element))
        kind = f"{element.kind}, {element.joined} joined" if element.joined > 1 else element.kind
        rows.append((name, kind, _where(element), own, _starts(model, name, element, joined)))
    columns = ("name", "kind", "where", "laws and values (SI)", "state at t = 0")
    print_table("Elements", columns, rows)
    unused, rows = unused_inputs(model), []
    for name, entry in model.inputs.items():
        doc = f"{entry.doc} (no element uses it)".strip() if name in unused else entry.doc
        rows.append((name, entry.dimension.si, f"{entry.si:g}", doc))
    print_table("Inputs", ("name", "unit", "if not given", "what it is"), rows)
    unused, rows = unused_parameters(model), []
    for name, parameter in model.parameters.items():
        values = listing((f"{value:g}" for value in parameter.lanes), 8)
        doc = f"{parameter.doc} (no law uses it)".strip() if name in unused else parameter.doc
        rows.append((name, values, parameter.dimension.si, doc))
    print_table("Parameters", ("name", "value (SI)", "unit", "what it is"), rows)


def _where(element: Element) -> str:
    """Return the nodes, bodies and inputs that an element names."""
    pairs = [*element, *((name, s.between) for name, s in getattr(element, "states", {}).items())]
    nodes = [(field, " - ".join(value)) for field, value in pairs if isinstance(value, tuple)]
    parts = [text if field == "between" else f"{field} {text}" for field, text in nodes]
    parts += [element.at] if hasattr(element, "at") else []
    listed = dict(nodes).keys()
    named = (row for row in element.named("thermal_mass", "input") if row[0] not in listed)
    return ", ".join((*parts, *(f"{field} {name}" for field, name in named)))


def _laws(model: Model, name: str, element: Element) -> Iterator[str]:
    """Yield each law, and its value if it depends on parameters alone."""
    from piezo_sym.expressions.exact_eval import evaluate
    from piezo_sym.expressions.tree import Num, names

    numbers = {word: entry.si for word, entry in model.parameters.items()}
    for law in element.laws(name):
        used = {word: numbers.get(word) for word in names(law.tree)}
        text = f"{law.field} = {law.text}"
        plain = {word: value for word, value in used.items() if isinstance(value, float)}
        if len(plain) == len(used) and not isinstance(law.tree, Num):
            with suppress(ArithmeticError, ValueError):  # it has no value, which proofs report
                text += f" = {evaluate(law.tree, plain):g} {law.mark.unit}".removesuffix(" 1")
        yield text


def _starts(model: Model, name: str, element: Element, joined: Collection[str]) -> str:
    symbols = [*element.own_states(name)]
    starts = {one: str(model.initial.get(one, "0 (not said)")) for one in symbols}
    given = [one for one in starts if one in model.joined and one in model.initial]
    sums = {one: f"{model.joined[one]}*({starts[one]})" for one in given}
    free = {one: f"{one} (joined, not said)" for one in joined if one not in model.initial}
    return "\n".join(free.get(one, f"{one} = {start}") for one, start in (starts | sums).items())


def _equations(iphs: IPHS) -> Iterator[str]:
    from piezo_sym.algebra.notation import slot_text
    from piezo_sym.iphs.reading import equations_text

    system = iphs.system
    yield "Equations"
    pairs = equations_text(iphs.reading)
    width = max(len(left) for left, _ in pairs)
    yield from (f"  {left.ljust(width)} = {right}" for left, right in pairs)
    yield from _joined(iphs)
    yield from _casimirs(iphs)
    yield from _domain(iphs)
    yield from _matrix("J0, structure matrix", system.J0)
    for k, process in enumerate(system.processes):
        yield from _process(iphs, k, slot_text(process))
    if system.ports:
        direct = "" if system.D.is_zero else "; it depends on u: inputs drive processes, see z"
        yield from _matrix(f"g, input map{direct}", system.g)


def _joined(iphs: IPHS) -> Iterator[str]:
    """Yield the joined stores: each state, and the co-state and energy of each store in it."""
    from piezo_sym.expressions.text import spell

    for joint in iphs.junction.joints:
        yield from (f"\nJoined: {text}" for text in joint.state_texts())
        for m in joint.members:
            law = f"{m.store.costate} = {spell(joint.costate(m))}, " if m in joint.followers else ""
            yield f"  {m.element}: {law}energy {spell(m.energy)}"


def _casimirs(iphs: IPHS) -> Iterator[str]:
    """Yield the linear functions that keep the values which the initial state gives them."""
    from piezo_sym.algebra.notation import text
    from piezo_sym.iphs.casimirs import linear_casimirs

    functions = linear_casimirs(iphs)
    yield from ["\nKept as at t = 0, whatever moves"] if functions else []
    yield from (f"  {text(function)}" for function in functions)


def _domain(iphs: IPHS) -> Iterator[str]:
    """Yield the conditions of the domain, with the place of those that kinds imply."""
    from piezo_sym.spec.tables import condition_text

    yield "\nDomain"
    for condition in iphs.circuit.conditions:
        where = iphs.model.origins.written(condition.where)
        needs = "" if condition.where.startswith("domain.") else f"  ({where})"
        yield f"  {condition_text(condition.tree)}{needs}"


def _matrix(title: str, matrix: LaneMatrix) -> Iterator[str]:
    yield f"\n{title}"
    yield from (f"  {line}" for line in str(matrix).splitlines())


def _process(iphs: IPHS, k: int, name: str) -> Iterator[str]:
    from piezo_sym.algebra.notation import joined, slot_text, text

    system, write = iphs.system, iphs.reading.write
    pairs = joined(
        f"{text(entry)} at ({slot_text(system.states[r])}, {slot_text(system.states[c])})"
        for (r, c), full, own in system.J(k).entries()
        for entry in (full, own)
        if entry != 0
    )
    yield f"\nProcess {name}"
    yield f"  J       {pairs}"
    yield f"  {{S,U}}_J {text(write(system.bracket[k, 0]))}"
    if system.z[k, 0] != system.bracket[k, 0]:
        yield f"  z       {text(write(system.z[k, 0]))}, the driving force: with what inputs add"
    yield f"  R       {text(write(system.R[k, 0]))}"
    yield f"  gamma   {text(iphs.reading.gamma(k))}"
