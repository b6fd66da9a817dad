"""``piezo-sym show SPEC``: the derived system, to read."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

from piezo_sym.cli.output import about

if TYPE_CHECKING:
    from piezo_sym.algebra.lanes import LaneMatrix
    from piezo_sym.iphs import IPHS


def show(
    spec: Annotated[str, typer.Argument(metavar="SPEC", help="Path or shipped name.")],
    latex: Annotated[bool, typer.Option("--latex", help="Print LaTeX.")] = False,
) -> None:
    """Show the irreversible port-Hamiltonian system of a spec: U, rates, domain, J0, processes."""
    from piezo_sym.derivation import derive
    from piezo_sym.spec.load import load

    with about(spec):
        iphs = derive(load(spec))
    if latex:
        typer.echo(iphs.latex())
        return
    for line in _lines(iphs):
        typer.echo(line)


def _lines(iphs: IPHS) -> Iterator[str]:
    from piezo_sym.algebra.notation import slot_text
    from piezo_sym.iphs.reading import equations_text
    from piezo_sym.spec.tables import banks

    system, header = iphs.system, iphs.model.model
    yield f"{header.name}: {header.title}" if header.title else header.name
    yield from ([f"source: {header.source}"] if header.source else [])
    for bank, count in banks(iphs.model).items():
        yield f"bank '{bank}': lanes j = 1..r for any r = {bank}_count; {count} in the spec"
    yield "\nEquations"
    pairs = equations_text(iphs.reading)
    width = max(len(left) for left, _ in pairs)
    yield from (f"  {left.ljust(width)} = {right}" for left, right in pairs)
    yield from _domain(iphs)
    yield from _matrix("J0, structure matrix", system.J0)
    for k, process in enumerate(system.processes):
        yield from _process(iphs, k, slot_text(process))
    if system.ports:
        yield from _matrix("g, input map", system.g)


def _domain(iphs: IPHS) -> Iterator[str]:
    """Yield the conditions that all proofs assume; an implied one with the law that needs it."""
    from piezo_sym.spec.tables import condition_text, conditions

    yield "\nDomain"
    for condition in conditions(iphs.model):
        needs = "" if condition.where.startswith("domain.") else f"  ({condition.where})"
        yield f"  {condition_text(condition.tree)}{needs}"


def _matrix(title: str, matrix: LaneMatrix) -> Iterator[str]:
    yield f"\n{title}"
    yield from (f"  {line}" for line in str(matrix).splitlines())


def _process(iphs: IPHS, k: int, name: str) -> Iterator[str]:
    from piezo_sym.algebra.notation import slot_text, text

    system, write = iphs.system, iphs.reading.write
    pairs = " + ".join(
        f"{text(entry)} at ({slot_text(system.states[r])}, {slot_text(system.states[c])})"
        for (r, c), full, own in system.J(k).entries()
        for entry in (full, own)
        if entry != 0
    )
    yield f"\nProcess {name}"
    yield f"  J       {pairs}"
    yield f"  {{S,U}}_J {text(write(system.bracket[k, 0]))}"
    yield f"  R       {text(write(system.R[k, 0]))}"
    yield f"  gamma   {text(iphs.reading.gamma(k))}"
