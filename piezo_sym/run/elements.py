"""Quantities of elements in a run: effort, flow, power, energy, as `damper.heat`.

Input: what a user asks for, or a run.  Output: their names, in the module's order; their values.
"""

from collections.abc import Iterator

from piezo_sym.errors import UsageError, listing, nearest, quote, similar
from piezo_sym.run.checks import is_vector
from piezo_sym.run.dataset import Named, Trajectory, named_rows
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.system import DrivenModule

#: The argument that selects quantities of elements, and its value for all of them.
OUTPUTS, EVERY = "simulate.outputs", "all"


def read_outputs(module: GeneratedModule, outputs: object) -> tuple[str, ...]:
    """Return the selected quantities of elements, in the module's order."""
    names = tuple(record.name for record in module.ELEMENTS)
    if outputs is None:
        return ()
    if outputs == EVERY:
        return names
    if isinstance(outputs, str):
        outputs = [outputs]
    if not is_vector(outputs):
        expected = f"'{EVERY}', or a list of elements and quantities such as 'damper.heat'"
        raise UsageError(f"{quote(outputs)} is no list of names", OUTPUTS, expected)
    wanted = set[str]()
    for output in outputs:  # type: ignore[attr-defined]  # a vector
        matching = [name for name in names if output in (name, name.rpartition(".")[0])]
        if not matching:
            remedy = element_remedy(str(output), names)
            expected = "elements and their quantities, beside what every run has, as y_<port>"
            raise UsageError(f"unknown name {quote(output)}", OUTPUTS, expected, remedy)
        wanted.update(matching)
    return tuple(name for name in names if name in wanted)


def element_remedy(output: str, names: tuple[str, ...]) -> str:
    """Return what to write for an unknown element or quantity of one: the known `names`."""
    element = output.rpartition(".")[0]
    known = [name.rpartition(".") for name in names]
    if quantities := [quantity for other, _, quantity in known if other == element]:
        return f"'{element}' has {listing(quantities)}"
    elements = [*dict.fromkeys(other for other, _, _ in known)]
    return nearest(output, [*elements, *names] if similar(output, names) else elements)


def element_variables(
    system: DrivenModule, run: Trajectory, names: tuple[str, ...]
) -> Iterator[Named]:
    """Yield the quantities of elements with these names over a run."""
    if names:
        module = system.module
        values = module.elements(run.states, run.inputs, system.parameters)
        for name, variable in named_rows(system, ("time",), module.ELEMENTS, values):
            if name in names:
                yield name, variable
