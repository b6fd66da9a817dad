"""IPHS to program: Definition 1 row by row, each co-state and law by its name.

Input: an `IPHS` and the verdict on it.  Output: a `Program`.  Terms stand in the order of the
states, then the processes, then the inputs; laws keep the spelling of the spec.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from piezo_sym.codegen.differences import sharp_program
from piezo_sym.codegen.functions import functions_of, limits_of
from piezo_sym.codegen.jacobian import jacobian_of
from piezo_sym.codegen.program import Field, Function, Jacobian, Limit, Program
from piezo_sym.codegen.quantities import Quantities
from piezo_sym.iphs import IPHS
from piezo_sym.spec.circuit import Placed
from piezo_sym.spec.elements.ports import Body, Exchange, Source, Storage
from piezo_sym.spec.fields import Input, Parameter
from piezo_sym.spec.model import Model
from piezo_sym.spec.tables import banks, lane_parameters

NO_JACOBIAN = Jacobian("", ())


def lower(iphs: IPHS, verdict: str) -> Program:
    """Return the program of a system.

    Parameters
    ----------
    iphs : from `derive`.
    verdict : one line on what is proved, for the head of printed modules.
    """
    model, q = iphs.model, Quantities(iphs)
    functions = functions_of(iphs, q)
    limits = limits_of(model, q)
    states = tuple(_state(placed, port) for placed, port in q.stores)
    lanes = {**lane_parameters(model), **{s.name: s.bank for s in states if s.bank}}
    rates = next(function for function in functions if function.name == "rhs").rows
    jacobian = jacobian_of(rates, states, lanes, q)
    return program_of(iphs, q, functions, jacobian, limits, verdict)


def program_of(
    iphs: IPHS,
    q: Quantities,
    functions: tuple[Function, ...],
    jacobian: Jacobian = NO_JACOBIAN,
    limits: tuple[Limit, ...] = (),
    verdict: str = "",
) -> Program:
    """Return a program of some functions of a system's quantities, which are all defined by now."""
    model = iphs.model
    program = Program(
        name=model.name,
        title=model.model.title,
        source=model.model.source,
        sha256=model.sha256,
        verdict=verdict,
        parameters=tuple(_parameters(model)),
        inputs=tuple(Field(n, i.dimension.si, i.doc) for n, i in model.inputs.items()),
        states=tuple(_state(placed, port) for placed, port in q.stores),
        outputs=tuple(_output(placed) for placed in q.ports),
        processes=tuple(_processes(iphs)),
        bodies=tuple(Field(n, "K", f"temperature of thermal_mass '{n}'") for n in q.bodies),
        defaults={**_values(model.parameters), **_values(model.inputs)},
        counts=banks(model),
        quantities=tuple(q.defined),
        functions=functions,
        jacobian=jacobian,
        limits=limits,
        taken=frozenset(q.taken),
    )
    return sharp_program(program)


def _values(
    table: Mapping[str, Parameter] | Mapping[str, Input],
) -> dict[str, float | tuple[float, ...]]:
    return {name: entry.si for name, entry in table.items()}


def _state(placed: Placed, port: Storage | Body) -> Field:
    unit = port.units[0] if isinstance(port, Storage) else "J/K"
    return Field(port.state, unit, port.doc, placed.bank)


def _parameters(model: Model) -> Iterator[Field]:
    owners = lane_parameters(model)
    for name, entry in model.parameters.items():
        yield Field(name, entry.dimension.si, entry.doc, owners.get(name))


def _output(placed: Placed) -> Field:
    match placed.port:
        case Source() as port:
            return Field(placed.element, port.units[1], port.doc)
        case Exchange() as port:
            return Field(placed.element, "K", f"temperature of thermal_mass '{port.body}'")
    msg = f"{placed.element} is no port of an input"
    raise TypeError(msg)


def _processes(iphs: IPHS) -> Iterator[Field]:
    for process in iphs.system.processes:
        kind = iphs.model.elements[process.label].kind
        yield Field(process.label, "W/K", f"{kind} '{process.label}'", process.bank)
