"""What has to be shown of a spec, listed from the spec itself, and whether it is so.

Input: a `Spec` and the parsed ``proofs.json``.  Output: one (id, element, reason) per row, the
reason empty where it is confirmed.  skew and casimir follow from the balances: the power of the
co-states vanishes for all of them, and nothing but processes and inputs is in an entropy's rate.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from .certificate import check_certificate
from .field import Field, TooLargeError
from .laws import InputError, Node, compare, negated, num, parse, put, replaced, sym, symbols, walk
from .point import derivative, evaluate, unkinked
from .prover import KINKED, Claim, Prover, partial
from .spec import Element, Spec
from .system import Finding, check_system

Row = tuple[str, str, str]
Check = Callable[[], str]
MOVING = ("z", "x", "T")


def audit(spec: Spec, proofs: Mapping[str, Any]) -> Iterator[Row]:
    """Yield every row of a spec, and whether it is confirmed."""
    return _Audit(spec, proofs).rows()


class _Audit:
    def __init__(self, spec: Spec, proofs: Mapping[str, Any]) -> None:
        self.spec, self.done = spec, dict[tuple[str, str], str]()
        self.stated: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
        entries, system = proofs.get("obligations"), proofs.get("system")
        if not isinstance(entries, list) or not all(isinstance(e, dict) for e in entries):
            raise InputError("the proofs have no list of obligations")
        for entry in entries:
            key = str(entry.get("id")), str(entry.get("element") or "")
            self.stated.setdefault(key, []).append(entry)
        self.found: Finding = check_system(spec, system if isinstance(system, dict) else {})
        self.conditions = tuple(tree for _, tree in spec.conditions)
        self.prover = Prover(self.conditions, self._ties())

    def _ties(self) -> tuple[Node, ...]:
        """Return what temperatures and letters are as functions of states."""
        heat = [(("T", b.name), b.laws["temperature"]) for b in self.spec.of("body")]
        letters = [(("z", name), tree) for name, tree in self.found.letters.items()]
        return tuple(compare(sym(name), "=", law) for name, law in (*heat, *letters))

    def rows(self) -> Iterator[Row]:
        """Yield the rows, each after those that it rests on."""
        yield self._row("domain", "", self._domain, listed=False)
        yield self._row("system", "", self._system, listed=False)
        for body in self.spec.of("body"):
            yield self._row("temperature", body.name, lambda body=body: self._temperature(body))
        if self._good("temperature"):
            warm = tuple(compare(sym(("T", b.name)), ">", 0) for b in self.spec.of("body"))
            self.prover = Prover((*self.conditions, *warm), self._ties())
        for name in ("skew", "energy"):
            yield self._row(name, "", lambda: self.found.reasons.get("energy", "") or self._of("system"))
        for name in ("casimir", "entropy"):
            yield self._row(name, "", lambda: self._of("system"))
        domain = [c for n in range(len(self.conditions)) for c in self._domain_claims(n)]
        if domain or ("welldef", "") in self.stated:
            yield self._row("welldef", "", lambda: self._all(domain) or self._of("system"))
        for element in self.spec.elements.values():
            yield from self._element(element)
        yield from self._balances()
        yield self._row("units", "", lambda: next(iter(self.spec.faults), ""))
        yield self._row("program", "", lambda: "")
        yield from self._others()

    def _row(self, name: str, element: str, check: Check, listed: bool = True) -> Row:
        """Return a row: stated as PROVED, and found to be so."""
        stated = self.stated.get((name, element), [])
        verdicts = {str(entry.get("verdict")) for entry in stated} - {"PROVED"}
        reason = ""
        if listed and (not stated or verdicts):
            reason = f"stated as {min(verdicts)}" if verdicts else "missing"
        try:
            reason = reason or check()
        except (InputError, TooLargeError, ArithmeticError, RecursionError) as error:
            reason = str(error) or type(error).__name__
        self.done[name, element] = reason
        return name, element, reason

    def _of(self, name: str, element: str = "") -> str:
        """Return why a row that another rests on is not confirmed."""
        if name == "system" and "system" in self.found.reasons:
            return self.found.reasons["system"]
        reason = self.done.get((name, element), "")
        return f"it rests on {name} {element}: {reason}".rstrip() if reason else ""

    def _good(self, *names: str) -> bool:
        return not any(reason for (name, _), reason in self.done.items() if name in names)

    def _all(self, claims: Iterable[Claim]) -> str:
        """Return the first claim that does not follow."""
        for path, claim in dict.fromkeys(claims):
            if not self.prover.proves(claim, path):
                return f"{spelled(claim)} does not follow"
        return ""

    # The rows

    def _domain(self) -> str:
        outside = [text for text, holds in evaluate(self.spec).conditions if not holds]
        return f"the spec's own values are not shown to be in {outside[0]!r}" if outside else ""

    def _domain_claims(self, n: int) -> Iterator[Claim]:
        """Yield that a condition has a value where the others hold."""
        yield from partial(self.conditions[n])

    def _system(self) -> str:
        divisors = [Claim((), compare(tree, "!=", 0)) for tree in self.found.divisors]
        return self.found.reasons.get("system", "") or self._all(divisors)

    def _temperature(self, body: Element) -> str:
        law = body.laws["temperature"]
        slope = derivative(law, ("x", body.name))
        claims = [*partial(law), *partial(slope)]
        return self._all([*claims, *(Claim((), compare(tree, ">", 0)) for tree in (law, slope))])

    def _element(self, element: Element) -> Iterator[Row]:
        trees = [tree for tree in (element.costate, element.law) if tree]
        if element.kind.form in ("coupling", "ambient", "conduction"):
            trees = list(element.laws.values())
        claims = [claim for tree in trees for claim in partial(tree)]
        if claims or element.law:
            yield self._row("welldef", element.name, lambda: self._all(claims))
        moving = [tree for tree in trees if moves(tree)]
        if moving and not element.jumps:
            yield self._row("continuous", element.name, lambda: self._continuous(moving))
        if element.law:
            yield self._row("passive", element.name, lambda: self._passive(element))
        elif element.kind.form == "conduction":
            law = element.laws["conductance"]
            flows = [*claims, Claim((), compare(law, ">=", 0))]
            yield self._row("passive", element.name, lambda: self._all(flows))

    def _continuous(self, trees: list[Node]) -> str:
        for tree in trees:
            closed = _Closed()
            relaxed = closed.tree(tree, ())
            same = Claim(tuple(closed.where), compare(relaxed, "=", tree))
            if reason := self._all([*closed.claims, *([same] if relaxed != tree else [])]):
                return reason
        return ""

    def _passive(self, element: Element) -> str:
        """Return why a law may give power: its certificate, if it has one, else cvc5."""
        law, z = element.law or num(0), sym(("z", element.name))
        certificates = [e.get("certificate") for e in self.stated["passive", element.name]]
        if given := next((c for c in certificates if c), None):
            reason = check_certificate(self.spec, element, given, self.prover)
        else:
            sides = [(">", ">="), ("<", "<=")]
            claims = [Claim((compare(z, s, 0),), compare(law, op, 0)) for s, op in sides]
            reason = self._all(claims)
        return reason or self._of("welldef", element.name)

    def _balances(self) -> Iterator[Row]:
        self.done["heat", ""] = "" if self._good("temperature", "passive") else "a row is not confirmed"
        yield self._row("sigma", "", lambda: self._of("heat"))
        claims = []
        for element in self.spec.of("ambient"):
            law = element.laws["conductance"]
            claims += [*partial(law), Claim((), compare(law, ">=", 0))]
            claims.append(Claim((), compare(sym(("u", element.input)), ">", 0)))
        for name in ("exergy", "environment") if claims else ():
            yield self._row(name, "", lambda: self._all(claims) or self._of("sigma") or self._of("energy"))

    # Information, where it is claimed

    def _others(self) -> Iterator[Row]:
        for (name, owner), entries in self.stated.items():
            claimed = any(e.get("verdict") == "PROVED" or e.get("required", True) for e in entries)
            element = self.spec.elements.get(owner)
            if (name, owner) in self.done or not claimed:
                continue
            if name == "odd" and element and element.law:
                yield self._row(name, owner, lambda element=element: self._odd(element))
            elif name == "invariant" and element and element.kind.form == "body":
                yield self._row(name, owner, lambda element=element: self._invariant(element))
            else:
                yield self._row(name, owner, lambda: "the checker knows no such row")

    def _odd(self, element: Element) -> str:
        law, z = element.law or num(0), ("z", element.name)
        turned = put(law, {z: Node("neg", (sym(z),))})
        field = Field()
        if field.is_zero(field.of(law, field.symbol) + field.of(turned, field.symbol)):
            return self._of("welldef", element.name)
        return self._all([Claim((), compare(turned, "=", Node("neg", (law,))))])

    def _invariant(self, body: Element) -> str:
        """Return why a body may cool below its floor: T > floor, T <= m < T_e."""
        T, m = sym(("T", body.name)), sym(("m", ""))
        floors = [c for c in self.conditions if _above(c) == T]
        cold = [e for e in self.spec.of("ambient") if body.name in e.bodies]
        claims = []
        for element in self.spec.of("ambient", "conduction"):
            if body.name not in element.bodies:
                continue
            lam, one = element.laws["conductance"], num(-1)
            if element.kind.form == "conduction":
                other = sym(("T", next(b for b in element.bodies if b != body.name)))
                gain = Node("*", (lam, Node("+", (Node("/", (other, T)), one))))
                claims.append(Claim((compare(T, "<=", other),), compare(gain, ">=", 0)))
                continue
            hot = sym(("u", element.input))
            at_T, at_m = (Node("*", (lam, Node("+", (Node("/", (hot, x)), one)))) for x in (T, m))
            between = (compare(T, "<=", m), compare(m, "<", hot))
            claims += [Claim(between, compare(at_T, ">=", at_m)), Claim(between, compare(at_m, ">=", 0))]
        if not floors or not cold:
            return "no floor of T, or no environment"
        return self._all(claims) or self._of("sigma")


def _above(condition: Node) -> Node | None:
    """Return what a comparison puts strictly above something."""
    return {">": condition.args[0], "<": condition.args[1]}.get(condition.value)


def moves(tree: Node) -> bool:
    """Return whether a law has a choice or kink in its letter, a state or a temperature."""
    for node in walk(tree):
        chooser = node.args[0] if node.op == "if" else node if node.op in KINKED else None
        if chooser and any(role in MOVING for role, _ in symbols(chooser)):
            return True
    return False


class _Closed:
    """A law on the closed cells of its choices, which cover the domain.

    Each comparison that moves becomes a choice b of a side, free where both sides are equal.  On
    each cell the law's branch has values up to the edge; if it is there what the law is, the law
    is continuous: the pasting lemma.  A condition's parts have values before it is relied on.
    """

    def __init__(self) -> None:
        self.where: list[Node] = []
        self.claims: list[Claim] = []
        self.sides: dict[Any, Node] = {}
        self.field = Field()

    def tree(self, node: Node, path: tuple[Node, ...]) -> Node:
        """Return a law in choices of sides; book what is needed for it to have a value."""
        if node.op == "sign" and moves(node):
            return self.tree(unkinked(node), path)
        if node.op != "if":
            made = Node(node.op, tuple(self.tree(arg, path) for arg in node.args), node.value)
            own = [c for c in partial(made) if not c.path and made.args and c.claim.args[0] in made.args]
            self.claims += [Claim((*self.where, *path), c.claim) for c in own]
            return made
        condition = node.args[0]
        left, right = (self.tree(arg, path) for arg in condition.args)
        side = Node("cmp", (left, right), condition.value)
        if any(role in MOVING for role, _ in symbols(condition)):
            side = self.side(left, right, condition.value in (">", ">="), path)
        then = self.tree(node.args[1], (*path, side))
        other = self.tree(node.args[2], (*path, negated(side)))
        return Node("if", (side, then, other))

    def side(self, left: Node, right: Node, above: bool, path: tuple[Node, ...]) -> Node:
        """Return the comparison b > 0 (or b <= 0) that stands for left above (below) right."""
        difference = Node("+", (left, Node("neg", (right,))))
        key = self.field.scaled([self.field.of(difference, self.field.symbol)])[1][0]
        turned = key != 0 and key.top.leading_coefficient() < 0
        if turned:
            key, above = -key, not above
            difference = Node("neg", (difference,))
        b = sym(("side", str((str(key.top), str(key.bottom)))))
        chosen = compare(b, ">", 0)
        edge = Node("if", (chosen, difference, Node("neg", (difference,))))
        for step in reversed(path):
            edge = Node("if", (step, edge, num(0)))
        self.where.append(compare(edge, ">=", 0))
        return chosen if above else negated(chosen)


def spelled(condition: Node, limit: int = 80) -> str:
    """Return a comparison in short, for a reason."""
    text = f"{_text(condition.args[0])} {condition.value} {_text(condition.args[1])}"
    return text if len(text) <= limit else f"{text[:limit]}..."


def _text(node: Node) -> str:
    if node.op in ("num", "sym"):
        return str(node.value if node.op == "num" else ".".join(node.value))
    return f"{node.op}({', '.join(_text(arg) for arg in node.args)})"
