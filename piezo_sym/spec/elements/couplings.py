"""The form of couplings: two pairs of nodes, each in a domain, and a ratio."""

from dataclasses import dataclass
from typing import Any, final

from piezo_sym.spec.elements.base import Form
from piezo_sym.spec.elements.domains import PhysicalDomain
from piezo_sym.spec.elements.marks import Fields, OptionalBody, OptionalPair, Pair, law_field
from piezo_sym.spec.elements.ports import Branch, Coupling


@final
@dataclass(frozen=True)
class PairCoupling(Form):
    """A coupling of two pairs of nodes.

    Attributes
    ----------
    ratio, symbol : the field of its ratio, and a law for it in the example.
    first : the field of its first pair, and the domain.
    second : the same of the second, with the unit of the ratio; of several, one is to be given.
    gyrates : whether through_1 = ratio*across_2, not across_1 = ratio*across_2.
    warm : whether the ratio may depend on the temperature of a body.
    """

    ratio: str
    symbol: str
    first: tuple[str, PhysicalDomain]
    second: tuple[tuple[str, PhysicalDomain, str], ...]
    gyrates: bool = False
    warm: bool = False

    @property
    def one_of(self) -> tuple[str, ...]:
        """The fields of the second pair, if there are several."""
        return tuple(field for field, *_ in self.second) if len(self.second) > 1 else ()

    @property
    def fields(self) -> Fields:
        """Its pairs and its ratio."""
        first, letters = self.second[0][2], {"T": "K"} if self.warm else {}
        instead = {field: unit for field, _, unit in self.second if unit != first}
        ratio = law_field(first, letters, self.symbol, sees=True, **instead)
        body = {"temperature": (OptionalBody, None, "body")} if self.warm else {}
        return {**self._pairs(), self.ratio: ratio, **body}

    def _pairs(self) -> Fields:
        """Return the pairs; in the example there are the first two of them."""
        found: Fields = {}
        for field, domain in (self.first, *(pair[:2] for pair in self.second)):
            sample = [f"{domain.node}_{len(found) + 1}", domain.reference] * (len(found) < 2)
            chosen = field in self.one_of
            found[field] = (OptionalPair if chosen else Pair, None if chosen else ..., sample)
        return found

    @property
    def doc(self) -> str:
        """Its two equations, for each choice of pairs."""
        return "\n\n".join(
            self._equations(field, domain)
            for n, (field, domain, _) in enumerate(self.second)
            if domain not in [known for _, known, _ in self.second[:n]]
        )

    def _equations(self, field: str, domain: PhysicalDomain) -> str:
        one, two = self.first[1], domain
        given, taken = (one.through, one.across) if self.gyrates else (one.across, one.through)
        return (
            f"With the pairs `{self.first[0]}` (1) and `{field}` (2): "
            f"{given.prefix}_1 = {self.ratio}*{two.across.prefix}_2 and "
            f"{two.through.prefix}_2 = -{self.ratio}*{taken.prefix}_1. {one.through.prefix}_1 and "
            f"{two.through.prefix}_2 run from the first to the second node of their pair inside "
            f"the element, so it gives {self.ratio}*{taken.prefix}_1 to the first node of pair 2."
        )

    def port(self, element: Any, name: str, branch: Branch) -> Coupling:
        """Return the coupling; it has two branches of its own."""
        del branch
        pairs = ((getattr(element, field), domain) for field, domain, _ in self.second)
        second, domain = next(pair for pair in pairs if pair[0] is not None)
        return Coupling(
            first=getattr(element, self.first[0]),
            first_domain=self.first[1],
            second=second,
            second_domain=domain,
            ratio=element.law(self.ratio),
            field=self.ratio,
            name=f"{'alpha' if self.gyrates else 'n'}_{name}",
            gyrates=self.gyrates,
        )

    def unit_between(self, *domains: PhysicalDomain) -> str:
        """Return the unit of the ratio if it couples two domains; empty if it does not."""
        units = (unit for _, domain, unit in self.second if {self.first[1], domain} == {*domains})
        return next(units, "")
