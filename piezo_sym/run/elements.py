"""Quantities of single elements, on demand: `outputs` of `simulate`.

Input: names, of elements (``"spring"``) or of their quantities (``"damper.heat"``).  Output: the
names in the module's ELEMENTS; and their variables of a run, as its function `elements` gives them.
"""

from __future__ import annotations

from collections.abc import Iterator

from piezo_sym.errors import UsageError, listing, nearest, quote
from piezo_sym.run.checks import is_vector
from piezo_sym.run.dataset import Named, spread
from piezo_sym.run.ledger import Trajectory
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.system import DrivenModule

WHERE, ALL = "simulate.outputs", "all"


def read_outputs(module: GeneratedModule, outputs: object) -> tuple[str, ...]:
    """Return the quantities that are asked for, in the module's order; raise `UsageError`."""
    names = tuple(record.name for record in module.ELEMENTS)
    if outputs is None:
        return ()
    if outputs == ALL:
        return names
    if not is_vector(outputs):
        expected = f"'{ALL}', or a list of elements and quantities such as 'damper.heat'"
        raise UsageError(f"{quote(outputs)} is no list of names", WHERE, expected)
    wanted = set[str]()
    for asked in outputs:  # type: ignore[attr-defined]  # a vector
        found = [name for name in names if asked in (name, name.rpartition(".")[0])]
        if not found:
            raise UsageError(f"unknown name {quote(asked)}", WHERE, remedy=_remedy(asked, names))
        wanted.update(found)
    return tuple(name for name in names if name in wanted)


def _remedy(asked: object, names: tuple[str, ...]) -> str:
    element = str(asked).rpartition(".")[0]
    own = [name.rpartition(".")[2] for name in names if name.rpartition(".")[0] == element]
    if own:
        return f"'{element}' has {listing(own)}"
    return nearest(str(asked), (*dict.fromkeys(name.rpartition(".")[0] for name in names), *names))


def element_variables(
    system: DrivenModule, run: Trajectory, names: tuple[str, ...]
) -> Iterator[Named]:
    """Yield the quantities of elements over a run that have these names."""
    if names:
        module = system.module
        values = module.elements(run.states, run.inputs, system.parameters)
        for name, variable in spread(system, ("time",), module.ELEMENTS, values):
            if name in names:
                yield name, variable
