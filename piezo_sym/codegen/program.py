"""The program of a generated module, independent of any language.

Input: nothing; these are the types.  Output: frozen records that lowering fills and printers read.
A program is a list of named quantities in an order in which each can be computed from earlier ones,
and functions whose rows are expressions in them.  A quantity has one value, or one per lane of a
bank; a sum over lanes is always a quantity of its own.  Printers do no algebra.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.expressions.tree import Expr, LaneSum, Node, names
from piezo_sym.spec.names import fresh
from piezo_sym.spec.values import HASH, VERDICT, lane_name, place
from piezo_sym.version import MADE


@final
class Names:
    """The names in use; a call with a word returns a new name that begins with it."""

    def __init__(self, taken: Iterable[str]) -> None:
        self.taken = set(taken)

    def __call__(self, word: str) -> str:
        """Return a new name."""
        name = fresh(word, self.taken)
        self.taken.add(name)
        return name


@final
@dataclass(frozen=True)
class Quantity:
    """A named value: `value` in terms of parameters, states, inputs and earlier quantities."""

    name: str
    value: Expr
    bank: str | None
    note: str


@final
@dataclass(frozen=True)
class Described:
    """A parameter, state, input, output, process or body, as generated modules describe it."""

    name: str
    unit: str
    doc: str
    bank: str | None = None

    @property
    def spread(self) -> str:
        """The names of its rows, those of a bank from the first lane to the last."""
        return f"{self.name}_1 ... {self.name}_{self.bank}_count" if self.bank else self.name

    @property
    def slot(self) -> Slot:
        """Its row, or rows, in a vector."""
        return Slot(self.name, self.bank)


def banks_of(fields: Iterable[Described | Quantity]) -> dict[str, str]:
    """Return the bank of every name that has a value per lane."""
    return {field.name: field.bank for field in fields if field.bank}


@final
@dataclass(frozen=True)
class OutputRow:
    """One row of a result."""

    slot: Slot  # the row, or for a bank one row per lane
    value: Expr  # one, or for a bank one per lane
    listed: tuple[Expr, ...] = ()  # the values of the lanes instead, if the spec lists them


@final
@dataclass(frozen=True)
class Outer:
    """A product over pairs of lanes: `left` in the row's lane times `right` in the column's."""

    left: Expr
    right: Expr


@final
@dataclass(frozen=True)
class Entry:
    """One entry of a Jacobian."""

    #: row, col: places among the states.
    row: int
    col: int
    value: Expr  # of that pair; with two banks, of equal lanes of one bank (the diagonal)
    outer: tuple[Outer, ...] = ()  # further products over all pairs of lanes of the two banks


@final
@dataclass(frozen=True)
class ModuleFunction:
    """A function of a module: a vector with one row per slot, or the one row if `scalar`."""

    name: str
    doc: str
    arguments: tuple[str, ...]
    rows: tuple[OutputRow, ...]
    scalar: bool = False


@final
@dataclass(frozen=True)
class Limit:
    """A condition of the domain: its text and its margin, positive (or zero) inside."""

    text: str
    strict: bool
    margin: Expr


@final
@dataclass(frozen=True, kw_only=True)
class Program:
    """All that a generated module holds."""

    #: name, title, source, sha256, verdict: for the head.
    name: str
    title: str
    source: str
    sha256: str
    verdict: str = ""
    #: parameters, inputs, states, outputs, processes, bodies, elements: fields in their order.
    parameters: tuple[Described, ...]
    inputs: tuple[Described, ...]
    states: tuple[Described, ...]
    outputs: tuple[Described, ...]
    processes: tuple[Described, ...]
    bodies: tuple[Described, ...]
    elements: tuple[Described, ...] = ()
    #: Values of parameters (a tuple: one per lane) and inputs, as they are printed.
    defaults: Mapping[str, str | tuple[str, ...]]
    counts: Mapping[str, int]  # sizes of banks, in order
    quantities: tuple[Quantity, ...]  # in an order in which they can be computed
    functions: tuple[ModuleFunction, ...] = ()  # what the module offers, with `limits`
    #: The derivative of `rhs` with respect to the state; an entry that is not listed is zero.
    jacobian: tuple[Entry, ...] = ()
    limits: tuple[Limit, ...] = ()
    taken: frozenset[str]  # every name in use, so that printers can add their own

    def lane_names(self) -> dict[str, str]:
        """Return the bank of every name that has a value per lane."""
        return banks_of((*self.parameters, *self.states, *self.quantities))


def blank(program: Program) -> Program:
    """Return a program with the places of a template instead of values, hash and verdict."""
    values = {
        name: place(name)
        if isinstance(value, str)
        else tuple(place(lane_name(name, lane)) for lane in range(len(value)))
        for name, value in program.defaults.items()
    }
    return replace(program, defaults=values, sha256=place(HASH), verdict=place(VERDICT))


#: Explanations in the head of each file.
SYSTEM = (
    "System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its",
    "         rows, multiplied out; `piezo-sym show` prints the matrices",
)
PROOFS = (
    "         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and",
    "         parameters in the domain, and for banks of any size)",
)


def head_lines(
    program: Program,
    plain: Callable[[str], str],
    notes: Iterable[str],
    parameters: tuple[str, str],
    counts: str = "",
) -> list[str]:
    """Return the text at the head of a file.

    `plain` makes a text safe; `parameters` are name and type of the parameters in functions.
    """
    p, kind = parameters
    apart = "" if p == "p" else "; the underscore tells it from p, a name of the model"
    u = ", ".join(field.name for field in program.inputs)
    return [
        f"{plain(program.title or program.name)}: irreversible port-Hamiltonian system.",
        "",
        *([f"Source:  {plain(program.source)}"] if program.source else []),
        f"Model:   {program.name}, spec sha256 {program.sha256}",
        *SYSTEM,
        f"Proofs:  {program.verdict}",
        *PROOFS,
        "",
        MADE,
        *notes,
        "",
        f"x = ({', '.join(field.spread for field in program.states)})",
        f"u = ({u})",
        f"{p} = {kind}{apart}",
        *(f"bank {bank}: lanes j = 1 ... {counts}{bank}_count" for bank in program.counts),
    ]


def needed(
    quantities: Iterable[Quantity], roots: Iterable[Node]
) -> tuple[tuple[Quantity, ...], frozenset[str]]:
    """Return the quantities that some expressions need, in order, and all names in use."""
    used = {name for root in roots for name in names(root)}
    kept: list[Quantity] = []
    for quantity in reversed(tuple(quantities)):
        if quantity.name in used:
            kept.append(quantity)
            used.update(names(quantity.value))
    return tuple(reversed(kept)), frozenset(used)


def bank_of(node: Node, lanes: Mapping[str, str]) -> str | None:
    """Return the bank over whose lanes an expression varies; None if none, as for a lane sum."""
    if isinstance(node, LaneSum):
        return None
    return next((lanes[name] for name in names(node) if name in lanes), None)


def jacobian_roots(entries: Iterable[Entry]) -> Iterator[Expr]:
    """Yield every expression in the entries of a Jacobian."""
    for entry in entries:
        yield entry.value
        for outer in entry.outer:
            yield from (outer.left, outer.right)
