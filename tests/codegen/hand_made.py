"""Modules of models that no spec can write yet: energies, laws and banks are typed in.

Input: states, an energy, rates in co-states.  Output: a generated module, loaded from a folder.
Co-states are the energy's derivatives, as ``E_<state>``; all else is what a spec goes through:
branches, slopes for Newton's method, printers, the engine.
"""

from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen import printed
from piezo_sym.codegen.collocation import Collocation, Slopes, Stage
from piezo_sym.codegen.differences import sharp_program, sharp_quantity
from piezo_sym.codegen.jacobian import jacobian_of
from piezo_sym.codegen.paths import Path as Stop
from piezo_sym.codegen.program import (
    Described,
    Limit,
    ModuleFunction,
    Names,
    OutputRow,
    Program,
    Quantity,
)
from piezo_sym.codegen.switches import switched_values
from piezo_sym.expressions.calculus import add, compared, derivative, div, is_affine, mul
from piezo_sym.expressions.grammar import parse_rule
from piezo_sym.expressions.tree import ZERO, Call, Cmp, If, LaneSum, Num, Sym, names, rebuild
from piezo_sym.expressions.tree import replace as put
from piezo_sym.module_cache import load_module
from piezo_sym.run.engine.c_sources import standalone_step

DRIVEN, STATE = ("x", "u", "p"), ("x", "p")


@dataclass
class HandMade:
    """A model, law by law; texts are of the law language, `(text, bank)` where lanes differ.

    Attributes
    ----------
    parameters : name -> value; of a bank, a tuple of values.
    inputs : name -> value.
    states : name -> (where it starts, its bank).
    energies : terms of the Hamiltonian; a bank's is summed over its lanes.
    laws : further names, in order, in parameters, states, inputs, co-states and each other.
    rates : state -> its rate.
    supply : port -> the power that it puts in.
    heats : process -> (power turned into heat, the entropy that takes it).
    counts : bank -> lanes.
    limits : what must be positive, in states and laws.
    paths : name -> (rate of the coordinate, inner state, stiffness, limit of the inner state),
        stops; what one gives are `<name>_effort`, `_slip`, `_heat`.
    """

    name: str
    parameters: dict
    states: dict
    energies: list
    rates: dict
    inputs: dict = field(default_factory=dict)
    laws: dict = field(default_factory=dict)
    supply: dict = field(default_factory=dict)
    heats: dict = field(default_factory=dict)
    counts: dict = field(default_factory=dict)
    limits: tuple = ()
    paths: dict = field(default_factory=dict)

    def module(self, folder):
        """Write the module's files into a folder; return the module."""
        texts = printed(sharp_program(self.program()), self.collocation())
        texts["_step.c"] += standalone_step(self.name, texts["_step.c"])
        for ending, text in texts.items():
            (Path(folder) / f"{self.name}{ending}").write_text(text, encoding="utf-8")
        return load_module(Path(folder) / f"{self.name}.py")

    def program(self):
        """Return what the module computes."""
        q = _Quantities(self, [*self.costates(), *self._standing()])
        rates = self._rows(self.rates, q)
        heated = self._heated(q)
        total = [
            q.total(e, bank, f"energy_{n}") if bank else e for n, (e, bank) in self._energies()
        ]
        entries, derivatives = self._jacobian(rates, q.defined, q.lanes(), q.new)
        entropies = dict.fromkeys(body for _, body in self.heats.values())
        produced = [OutputRow(r.slot, div(r.value, Sym(f"E_{s}"))) for r, s in heated]
        ports = tuple(OutputRow(Slot(name), read(text)) for name, text in self.supply.items())
        starts = tuple(OutputRow(Slot(s, b), _number(v)) for s, (v, b) in self.states.items())
        temperatures = tuple(OutputRow(Slot(s), Sym(f"E_{s}")) for s in entropies)
        functions = (
            ModuleFunction("initial_state", "State at t = 0", ("u", "p"), starts),
            ModuleFunction("rhs", "Rates", DRIVEN, rates),
            ModuleFunction("outputs", "Power put in", DRIVEN, ports),
            ModuleFunction("supply", "Power put in [W], one per port", DRIVEN, ports),
            ModuleFunction("elements", "Quantities of elements", DRIVEN, ()),
            ModuleFunction(
                "energy", "Hamiltonian U [J]", STATE, (OutputRow(Slot("U"), add(*total)),), True
            ),
            ModuleFunction("entropy", "Entropy", STATE, (_sum("S", entropies),), True),
            ModuleFunction("temperatures", "Temperatures [K]", STATE, temperatures),
            ModuleFunction("heat", "Heat [W]", DRIVEN, tuple(row for row, _ in heated)),
            ModuleFunction("entropy_production", "Production [W/K]", DRIVEN, tuple(produced)),
        )
        defaults = {n: v for n, (v, _) in self._parameters()} | self.inputs
        return Program(
            name=self.name,
            title="",
            source="",
            sha256="0" * 64,
            verdict="",
            parameters=tuple(Described(n, "1", "", b) for n, (_, b) in self._parameters()),
            inputs=tuple(Described(name, "1", "") for name in self.inputs),
            states=self.fields(),
            outputs=tuple(Described(name, "W", "") for name in self.supply),
            processes=tuple(Described(r.slot.label, "W/K", "", r.slot.bank) for r, _ in heated),
            elements=(),
            bodies=tuple(Described(name, "K", "") for name in entropies),
            defaults={name: as_printed(value) for name, value in defaults.items()},
            counts=self.counts,
            quantities=(*q.defined, *derivatives),
            functions=functions,
            jacobian=entries,
            limits=self._limits(),
            taken=frozenset(q.new.taken),
        )

    def collocation(self):
        """Return the model's step."""
        means = tuple(c for c in self.costates() if not self._affine(c))
        q = _Quantities(self, [c for c in self.costates() if self._affine(c)])
        q.new.taken |= {mean.name for mean in means}
        rates, heats = self._rows(self.rates, q), self._heated(q)
        produced = (OutputRow(row.slot, div(row.value, Sym(f"E_{s}"))) for row, s in heats)
        ports = (OutputRow(Slot(name), read(text)) for name, text in self.supply.items())
        rows = (*rates, *ports, *(row for row, _ in heats), *produced)
        lanes = q.lanes() | {mean.name: mean.bank for mean in means if mean.bank}
        found = switched_values(q.defined, rows, lanes, q.new, means=means)
        stage = Stage(
            tuple(map(sharp_quantity, found.quantities)),
            found.rows[: len(rates)],
            found.rows[len(rates) :],
            found.switches,
            self._limits(),
            frozenset(q.new.taken),
            found.bends,
        )
        means = tuple(sharp_quantity(replace(m, value=compared(m.value))) for m in means)
        first = next((body for _, body in self.heats.values()), None)
        heated = list(self.states).index(first) if first else -1
        return Collocation(means, stage, self._slopes(), heated, False, self._paths())

    def _slopes(self):
        q = _Quantities(self, self.costates())
        free = {c.name for c in self.costates() if not self._affine(c)}
        rates = self._rows(self.rates, q)
        found = switched_values(q.defined, rates, q.lanes(), q.new, compared_names=free)
        mean = {}
        for path in self._paths():
            force, slip = mul(path.stiffness, Sym(path.inner)), path.mean_slip
            mean |= {path.effort: force, path.slip: slip, path.heat: mul(force, slip)}
        rates = tuple(replace(row, value=put(row.value, mean)) for row in found.rows)
        defined = tuple(replace(d, value=put(d.value, mean)) for d in found.quantities)
        entries, derivatives = self._jacobian(rates, defined, found.lanes, q.new)
        quantities = tuple(map(sharp_quantity, (*defined, *derivatives)))
        return Slopes(quantities, entries, frozenset(q.new.taken))

    def _jacobian(self, rates, quantities, lanes, new):
        return jacobian_of(rates, self.fields(), tuple(quantities), lanes, new, {})

    def costates(self):
        """Return the energy's derivatives, each one per lane if its state is."""
        found = []
        for state, (_, bank) in self.states.items():
            terms = []
            for _, (energy, own) in self._energies():
                slope = derivative(energy, state)
                summed = own and not bank and slope != ZERO
                terms.append(LaneSum(slope, own) if summed else slope)
            found.append(Quantity(f"E_{state}", add(*terms), bank, "co-states"))
        return found

    def fields(self):
        """Return the states."""
        return tuple(Described(name, "1", "", bank) for name, (_, bank) in self.states.items())

    def lanes(self):
        """Return the bank of each name that has a value per lane."""
        found = {name: bank for name, (_, bank) in self._parameters() if bank}
        found |= {f.name: f.bank for path in self._paths() for f in path.given() if f.bank}
        return found | {name: bank for name, (_, bank) in self.states.items() if bank}

    def _paths(self):
        found = []
        for name, (drive, inner, stiffness, limit) in self.paths.items():
            drive, bank = read(drive), self.states[inner][1]
            own = any(word in names(drive) for word, (_, b) in self._parameters() if b)
            own |= any(f"E_{word}" in names(drive) for word, (_, b) in self.states.items() if b)
            taken = read(stiffness), compared(read(limit))
            given = (f"{name}_{what}" for what in ("effort", "slip", "heat", "share"))
            found.append(Stop(inner, bank, drive, own, inner in names(drive), *taken, *given))
        return tuple(found)

    def _standing(self):
        """Yield what paths are at a point: a stop yields where it would leave its limit."""
        for path in self._paths():
            force, effort = mul(path.stiffness, Sym(path.inner)), Sym(path.effort)
            slips = If(path.drive, Cmp(">", mul(Sym(path.inner), path.drive), ZERO), ZERO)
            slip = If(ZERO, Cmp("<", Call("abs", (Sym(path.inner),)), path.limit), slips)
            found = {path.effort: force, path.slip: slip, path.heat: mul(effort, Sym(path.slip))}
            for name, value in found.items():
                yield Quantity(name, value, path.bank, "paths")

    def _affine(self, costate):
        return is_affine(costate.value, set(self.states))

    def _energies(self):
        return enumerate((read(text), bank) for text, bank in map(_with_bank, self.energies))

    def _parameters(self):
        for name, value in self.parameters.items():
            yield name, value if isinstance(value, tuple) else (value, None)

    def _rows(self, given, q):
        return tuple(
            OutputRow(Slot(n, self.states[n][1]), q.settled(read(t))) for n, t in given.items()
        )

    def _heated(self, q):
        found = []
        for name, (text, body) in self.heats.items():
            text, bank = _with_bank(text)
            found.append((OutputRow(Slot(name, bank), q.settled(read(text))), body))
        return found

    def _limits(self):
        return tuple(Limit(f"{text} > 0", True, read(text)) for text in self.limits)


class _Quantities:
    """Definitions in order; a sum over lanes that occurs in a row becomes one, once."""

    def __init__(self, model, costates):
        self.model, self.defined, self.sums = model, [], {}
        self.new = Names([*model.parameters, *model.states, *model.inputs, *model.laws])
        self.new.taken |= {*model.counts, *(f"E_{state}" for state in model.states)}
        self.new.taken |= {field.name for path in model._paths() for field in path.given()}
        for costate in costates:
            self.defined.append(replace(costate, value=self.settled(costate.value)))
        for name, given in model.laws.items():
            text, bank = _with_bank(given)
            self.defined.append(Quantity(name, self.settled(read(text)), bank, "laws"))

    def lanes(self):
        """Return the bank of each name that has a value per lane."""
        return self.model.lanes() | {item.name: item.bank for item in self.defined if item.bank}

    def total(self, arg, bank, base):
        key = LaneSum(arg, bank)
        if key not in self.sums:
            self.sums[key] = Sym(self.new(base))
            self.defined.append(Quantity(self.sums[key].name, key, None, "sums over lanes"))
        return self.sums[key]

    def settled(self, expr):
        """Return an expression in which each sum over lanes is a name."""
        if isinstance(expr, LaneSum):
            return self.total(expr.arg, expr.bank, "total")
        return rebuild(expr, self.settled)


def read(text):
    """Return a text of the law language as a tree; trees pass."""
    return parse_rule(text) if isinstance(text, str) else text


def as_printed(value):
    """Return a value, or one for each lane, as programs have them."""
    return tuple(map(repr, value)) if isinstance(value, tuple) else repr(value)


def _with_bank(given):
    return given if isinstance(given, tuple) else (given, None)


def _number(value):
    return Num(Fraction(repr(float(value))))


def _sum(name, states):
    return OutputRow(Slot(name), add(*map(Sym, states)))
