"""The form of an element that yields: a spring or capacitor whose effort never exceeds a limit.

It is a store with a slip that is set-valued: below the limit nothing slips, at the limit all that
would go beyond it does.  As a law of effort and rate, this is the rate projected on |effort| <=
limit.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, final

from piezo_sym.expressions.calculus import neg
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Div, Expr, If, Mul, Sym
from piezo_sym.spec.elements import slips
from piezo_sym.spec.elements.base import Form, State, positive, state_symbol
from piezo_sym.spec.elements.domains import PowerVariable
from piezo_sym.spec.elements.forms import Store
from piezo_sym.spec.elements.marks import BodyName, Fields, Pair, law_field
from piezo_sym.spec.elements.ports import Branch, Port


@final
@dataclass(frozen=True)
class Yielding(Form):
    """A spring or capacitor, one of `stores`, that yields at a limit of its effort."""

    has_lanes: ClassVar[bool] = True

    stores: tuple[Store, ...]

    @property
    def one_of(self) -> tuple[str, ...]:
        """The size of its store, which says what it is."""
        return tuple(store.size for store in self.stores)

    @property
    def letter(self) -> str:
        """The letter of its state."""
        return "z"

    @property
    def fields(self) -> Fields:
        """Its nodes, its store's size, the limit of the effort and the body it heats."""
        first = self.stores[0]
        between = [first.domain.node, first.domain.reference]
        sizes = {
            store.size: law_field(store.unit, {}, store.symbol if store is first else "", None)
            for store in self.stores
        }
        others: dict[str, Any] = {s.size: s.costate.unit for s in self.stores[1:]}
        limit = law_field(first.costate.unit, {}, "F_c", **others)
        return {
            **{"between": (Pair, ..., between), **sizes, "limit": limit},
            "heats": (BodyName, ..., "body"),
        }

    @property
    def doc(self) -> str:
        """What each of its choices stores, and the slip."""
        kinds = ", or ".join(
            f"with `{store.size}` a store of the co-state {store.costate.prefix} = "
            f"{f'{store.size}*z' if store.stiff else f'z/{store.size}'} [{store.costate.unit}]"
            for store in self.stores
        )
        return (
            f"{kinds[0].upper()}{kinds[1:]}, whose magnitude never exceeds `limit`: what would go "
            "beyond it slips, and co-state times slip `heats` a body. Steps are exact along their "
            "own path; `rhs` at the limit is the projected rate. The Jenkins element, the stop "
            "operator, a cell of Maxwell-slip. It is no end stop: that is a spring with "
            'force = "k_c*max(q - gap, 0)".'
        )

    def _store(self, element: Any) -> Store:
        return next(s for s in self.stores if getattr(element, s.size) is not None)

    def _costate(self, element: Any, state: str) -> Expr:
        store = self._store(element)
        size = element.law(store.size)
        return Mul(size, Sym(state)) if store.stiff else Div(Sym(state), size)

    def port(self, element: Any, name: str, branch: Branch) -> Port:
        """Return the store."""
        return self.ports(element, name, branch)[0]

    def ports(self, element: Any, name: str, branch: Branch) -> tuple[Port, ...]:
        """Return the store and its slip."""
        store, limit, state = (
            self._store(element),
            element.law("limit"),
            state_symbol(element, name),
        )
        f, v = Sym(store.costate.letter), Sym(store.domain.variable(store.imposes.other).letter)
        forth = If(v, Cmp(">=", f, limit), ZERO)
        back = If(v, Cmp("<=", f, neg(limit)), ZERO)
        law = If(forth, Cmp(">", v, ZERO), back)
        given = store.domain, store.imposes, element, name, branch
        own, slip = slips.beside(*given, (law, limit))
        return store.storage(element, name, own, state, self._costate(element, state)), slip

    def states(self, element: Any, name: str) -> tuple[State, ...]:
        """Return its state."""
        return (State(state_symbol(element, name), self._store(element).costate.state_unit),)

    def in_series(self, element: Any) -> bool:
        """Return whether lanes are in series: those of capacitors."""
        return self._store(element).imposes is PowerVariable.ACROSS

    def requires(self, element: Any) -> tuple[Cmp, ...]:
        """Return that its size is positive, and its limit not negative."""
        size, limit = element.law(self._store(element).size), element.law("limit")
        return positive(size), Cmp(">=", limit, ZERO)

    def starts(self, element: Any, name: str) -> tuple[Cmp, ...]:
        """Return that it starts within its limit."""
        costate = self._costate(element, state_symbol(element, name))
        return (Cmp("<=", Call("abs", (costate,)), element.law("limit")),)
