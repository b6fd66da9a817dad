"""IPHS to program: Definition 1 row by row, in named co-states and laws.

Input: an `IPHS` and the verdict on it.  Output: a `Program`.  Terms are in the order of states,
processes and inputs; laws keep the spelling of the spec.
"""

from collections.abc import Iterator
from dataclasses import replace

from piezo_sym.codegen.differences import sharp_program
from piezo_sym.codegen.functions import element_function, elements_of, functions_of
from piezo_sym.codegen.jacobian import jacobian_of
from piezo_sym.codegen.program import Described, ModuleFunction, Names, Program
from piezo_sym.codegen.quantities import Quantities, quantities_of
from piezo_sym.iphs import IPHS
from piezo_sym.spec.circuit import Circuit, Placed
from piezo_sym.spec.elements.ports import Exchange, HeatInput, Source
from piezo_sym.spec.tables import banks


def lower(iphs: IPHS, verdict: str, known: Quantities | None = None) -> Program:
    """Return the program of a system.

    Parameters
    ----------
    iphs : from `derive`.
    verdict : one line on what is proved, for the head of printed modules.
    known : its quantities, if they have been found.
    """
    q = known or quantities_of(iphs)
    functions = functions_of(q)
    rates = next(function for function in functions if function.name == "rhs").rows
    names = Names(q.taken)
    elements, named = elements_of(q, rates, names)
    entries, derivatives = jacobian_of(rates, q.states, q.defined, q.lanes, names, q.temperatures)
    program = replace(
        program_of(q, functions),
        verdict=verdict,
        functions=(*functions, element_function(elements)),
        elements=tuple(Described(*row[:4]) for row in elements),
        quantities=(*q.defined, *named, *derivatives),
        jacobian=entries,
        limits=q.limits,
        taken=frozenset(names.taken),
    )
    return sharp_program(program)


def program_of(q: Quantities, functions: tuple[ModuleFunction, ...]) -> Program:
    """Return a program of some functions, without Jacobian, limits and elements."""
    model = q.iphs.model
    return Program(
        name=model.name,
        title=model.model.title,
        source=model.model.source,
        sha256=model.sha256,
        verdict="",
        parameters=tuple(_parameters(q.iphs.circuit)),
        inputs=tuple(Described(n, i.dimension.si, i.doc) for n, i in model.inputs.items()),
        states=q.states,
        outputs=tuple(_output(placed) for placed in q.ports),
        processes=tuple(_processes(q.iphs)),
        bodies=tuple(Described(n, "K", f"temperature of thermal_mass '{n}'") for n in q.bodies),
        defaults={
            **{name: _printed(entry.si) for name, entry in model.parameters.items()},
            **{name: _printed(entry.si) for name, entry in model.inputs.items()},
        },
        elements=(),
        counts=banks(model),
        quantities=q.defined,
        functions=functions,
        jacobian=(),
        limits=(),
        taken=q.taken,
    )


def _printed(value: float | tuple[float, ...]) -> str | tuple[str, ...]:
    return tuple(map(repr, value)) if isinstance(value, tuple) else repr(value)


def _parameters(circuit: Circuit) -> Iterator[Described]:
    owners = circuit.lane_parameters
    for name, entry in circuit.model.parameters.items():
        yield Described(name, entry.dimension.si, entry.doc, owners.get(name))


def _output(placed: Placed) -> Described:
    match placed.port:
        case Source() as port:
            return Described(placed.element, port.units[1], port.doc)
        case Exchange() | HeatInput() as port:
            return Described(placed.element, "K", f"temperature of thermal_mass '{port.body}'")
    raise TypeError(f"{placed.element} is no port of an input")


def _processes(iphs: IPHS) -> Iterator[Described]:
    for process in iphs.system.processes:
        kind = iphs.model.elements[process.label].kind
        yield Described(process.label, "W/K", f"{kind} '{process.label}'", process.bank)
