"""IPHS to program: Definition 1 row by row, in named co-states and laws.

Input: an `IPHS` and the verdict on it.  Output: a `Program`.  Terms are in the order of states,
processes and inputs; laws keep the spelling of the spec.
"""

from dataclasses import replace

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.differences import sharp_program
from piezo_sym.codegen.functions import FUNCTIONS, elements_of, functions_of
from piezo_sym.codegen.jacobian import jacobian_of
from piezo_sym.codegen.program import Described, ModuleFunction, Names, OutputRow, Program
from piezo_sym.codegen.quantities import Quantities, quantities_of
from piezo_sym.iphs import IPHS
from piezo_sym.network import Driven
from piezo_sym.spec.circuit import Placed
from piezo_sym.spec.elements.ports import Source
from piezo_sym.spec.tables import banks


def lower(iphs: IPHS, verdict: str, known: Quantities | None = None) -> Program:
    """Return the program of a system, whose quantities may be known.

    `verdict` is one line on what is proved, for the head of printed modules.
    """
    q = known or quantities_of(iphs)
    functions = functions_of(q)
    rates = next(function for function in functions if function.name == "rhs").rows
    names = Names(q.taken)
    elements, named = elements_of(q, rates, names)
    rows = tuple(OutputRow(Slot(row.name, row.bank), row.value) for row in elements)
    entries, derivatives = jacobian_of(rates, q.states, q.defined, q.lanes, names, q.temperatures)
    program = replace(
        program_of(q),
        verdict=verdict,
        functions=(*functions, ModuleFunction("elements", *FUNCTIONS["elements"], rows)),
        elements=tuple(Described(row.name, row.unit, row.doc, row.bank) for row in elements),
        quantities=(*q.defined, *named, *derivatives),
        jacobian=entries,
        limits=q.limits,
        taken=frozenset(names.taken),
    )
    return sharp_program(program)


def program_of(q: Quantities) -> Program:
    """Return a program without functions, Jacobian, limits and elements."""
    model, owners = q.iphs.model, q.iphs.circuit.lane_parameters
    kinds = {label: element.kind for label, element in model.elements.items()}
    return Program(
        name=model.name,
        title=model.model.title,
        source=model.model.source,
        sha256=model.sha256,
        parameters=tuple(
            Described(n, p.dimension.si, p.doc, owners.get(n)) for n, p in model.parameters.items()
        ),
        inputs=tuple(Described(n, i.dimension.si, i.doc) for n, i in model.inputs.items()),
        states=q.states,
        outputs=tuple(_output(*pair) for pair in q.ports),
        processes=tuple(
            Described(slot.label, "W/K", f"{kinds[slot.label]} '{slot.label}'", slot.bank)
            for slot in q.iphs.system.processes
        ),
        bodies=tuple(Described(n, "K", f"temperature of thermal_mass '{n}'") for n in q.bodies),
        defaults={
            **{name: _printed(entry.si) for name, entry in model.parameters.items()},
            **{name: _printed(entry.si) for name, entry in model.inputs.items()},
        },
        counts=banks(model),
        quantities=q.defined,
        taken=q.taken,
    )


def _printed(value: float | tuple[float, ...]) -> str | tuple[str, ...]:
    return tuple(map(repr, value)) if isinstance(value, tuple) else repr(value)


def _output(placed: Placed, port: Driven) -> Described:
    if isinstance(port, Source):
        return Described(placed.element, port.output_unit, port.doc)
    return Described(placed.element, "K", f"temperature of thermal_mass '{port.body}'")
