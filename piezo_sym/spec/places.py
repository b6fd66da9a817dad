"""The places of a spec that have a unit: laws, inputs, conditions, initial values.

Input: the tables of a spec.  Output: a `Place` for each: its tree, the dimension of every name in
it, and the dimension that it must have.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import final

from piezo_sym.expressions.dimensions import Dimension, Match, matches
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.tree import Cmp, Expr, Node, Sym
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.elements.ports import Exchange, HeatInput, Source
from piezo_sym.spec.fields import Tables
from piezo_sym.spec.tables import heat_names


@final
@dataclass(frozen=True)
class Place:
    """One law, input, condition or initial value of a spec."""

    where: str  # its place in the spec, such as ``elements.damper.force``
    element: str  # the element it belongs to; empty for conditions and initial values
    tree: Node  # the parsed law, condition or value
    #: The dimensions of the parameters and inputs it may use, which a user may change.
    given: Mapping[str, Dimension]
    #: The dimensions of letters, states and temperatures; they take precedence over `given`.
    fixed: Mapping[str, Dimension]
    needed: Dimension | None  # the dimension that a law must have; None for a condition
    unit: str = ""  # the unit text of `needed` in the kind's record; empty if there is none

    @property
    def words(self) -> Mapping[str, Dimension]:
        """The dimension of every name."""
        return {**self.given, **self.fixed}

    def rules(self) -> tuple[Match, ...]:
        """Return the rules that its units must obey, innermost first, that of the law last."""
        inner = tuple(matches(self.tree))
        if self.needed is None or isinstance(self.tree, Cmp):
            return inner
        return (*inner, Match(self.tree, self.tree, None, self.needed))


def places(spec: Tables) -> Iterator[Place]:
    """Yield every place of a spec that has a unit, elements first.

    Conditions that kinds add to the domain are left out: they compare a law with 0, which fits any
    unit.  So are initial values that are plain numbers: they are in the state's SI unit.
    """
    parameters = {name: p.dimension.dimension for name, p in spec.parameters.items()}
    given = parameters | {name: u.dimension.dimension for name, u in spec.inputs.items()}
    states = state_dimensions(spec)
    seen = states | dict.fromkeys(heat_names(spec), _dimension("K"))
    for name, element in spec.elements.items():
        for law in element.laws(name):
            letters = {letter: _dimension(unit) for letter, unit in law.mark.units.items()}
            fixed, unit = {**(seen if law.mark.sees else {}), **letters}, law.mark.unit
            yield Place(law.where, name, law.tree, parameters, fixed, _dimension(unit), unit)
        for port in element.ports(name):
            if isinstance(port, Source | Exchange | HeatInput):
                unit, place = port.input_unit, f"elements.{name}.input"
                yield Place(place, name, Sym(port.input), given, {}, _dimension(unit), unit)
    for n, text in enumerate(spec.domain.assume):
        where = f"domain.assume[{n}]"
        yield Place(where, "", parse_condition(text, where), given, seen, None)
    for symbol, start in spec.initial.items():
        for part in start if isinstance(start, tuple) else (start,):
            if isinstance(part, str):
                tree: Expr = parse_law(part, where := f"initial.{symbol}")
                yield Place(where, "", tree, given, {}, states[symbol])


def state_dimensions(spec: Tables) -> dict[str, Dimension]:
    """Return the dimension of each state."""
    own = (element.own_states(name).items() for name, element in spec.elements.items())
    return {symbol: _dimension(unit) for states in own for symbol, unit in states}


def _dimension(unit: str) -> Dimension:
    return parse_unit(unit).dimension
