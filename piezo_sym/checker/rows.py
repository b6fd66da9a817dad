"""What has to be shown of a spec, listed from the spec itself, and whether it is so.

Input: a `Spec` and the parsed ``proofs.json``.  Output: one (id, element, reason) per row, the
reason empty where it is confirmed.  skew and casimir follow from the balances: the power of the
co-states vanishes for all of them, and nothing but processes and inputs is in an entropy's rate.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from .certificate import check_certificate
from .field import Field
from .laws import KINKS, InputError, Node, compare, derivative, made, need, negated, num, put
from .laws import sym, symbols, unkinked, walk
from .numbers import CannotTell, NoValue, compute, exact, holds
from .prover import Claim, Prover, partial
from .spec import Element, Spec
from .system import check_system

Row = tuple[str, str, str]
MOVING = ("z", "x", "T")


def audit(spec: Spec, proofs: Mapping[str, Any]) -> Iterator[Row]:
    """Yield every row of a spec, and whether it is confirmed."""
    return _Audit(spec, proofs).rows()


class _Audit:
    def __init__(self, spec: Spec, proofs: Mapping[str, Any]) -> None:
        self.spec, self.done = spec, dict[tuple[str, str], str]()
        self.stated: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
        entries, system = proofs.get("obligations"), proofs.get("system")
        listed = isinstance(entries, list) and all(isinstance(e, dict) for e in entries)
        need(listed, "the proofs have no list of obligations")
        for entry in entries or ():
            key = str(entry.get("id")), str(entry.get("element") or "")
            self.stated.setdefault(key, []).append(entry)
        self.found = check_system(spec, system if isinstance(system, dict) else {})
        self.conditions = tuple(tree for _, tree in spec.conditions)
        heat = [(("T", b.name), b.laws["temperature"]) for b in spec.of("body")]
        letters = [(("z", name), tree) for name, tree in self.found.letters.items()]
        self.ties = tuple(compare(sym(name), "=", law) for name, law in (*heat, *letters))
        self.prover = Prover(self.conditions, self.ties)

    def rows(self) -> Iterator[Row]:
        """Yield the rows, each after those that it rests on."""
        reasons = self.found.reasons
        yield self._row("domain", "", self._domain, listed=False)
        yield self._row("system", "", self._system, listed=False)
        for body in self.spec.of("body"):
            yield self._row("temperature", body.name, lambda body=body: self._temperature(body))
        if self._good("temperature"):
            warm = tuple(compare(sym(("T", b.name)), ">") for b in self.spec.of("body"))
            self.prover = Prover((*self.conditions, *warm), self.ties)
        for name in ("skew", "energy"):
            yield self._row(name, "", lambda: reasons.get("energy", "") or self._of("system"))
        for name in ("casimir", "entropy"):
            yield self._row(name, "", lambda: self._of("system"))
        domain = [claim for tree in self.conditions for claim in partial(tree)]
        if domain or ("welldef", "") in self.stated:
            yield self._row("welldef", "", lambda: self._all(domain) or self._of("system"))
        for element in self.spec.elements.values():
            yield from self._element(element)
        yield from self._balances()
        yield self._row("units", "", lambda: next(iter(self.spec.faults), ""))
        yield self._row("program", "", lambda: "")
        yield from self._others()

    def _row(self, name: str, element: str, check: Callable[[], str], listed: bool = True) -> Row:
        """Return a row: stated as PROVED, and found to be so."""
        stated = self.stated.get((name, element), [])
        verdicts = {str(entry.get("verdict")) for entry in stated} - {"PROVED"}
        reason = f"stated as {min(verdicts)}" if listed and verdicts else ""
        reason = "missing" if listed and not stated else reason
        try:
            reason = reason or check()
        except (InputError, ArithmeticError, RecursionError) as error:
            reason = str(error) or type(error).__name__
        self.done[name, element] = reason
        return name, element, reason

    def _of(self, name: str, element: str = "") -> str:
        """Return why a row that another rests on is not confirmed."""
        reason = self.done.get((name, element), "")
        return f"it rests on {name} {element}: {reason}" if reason else ""

    def _good(self, *names: str) -> bool:
        return not any(reason for (name, _), reason in self.done.items() if name in names)

    def _all(self, claims: Iterable[Claim]) -> str:
        """Return the first claim that does not follow."""
        for path, claim in dict.fromkeys(claims):
            if not self.prover.proves(claim, path):
                text = f"{_spelled(claim.args[0])} {claim.value} {_spelled(claim.args[1])}"
                return f"{text[:100]} does not follow"
        return ""

    # The rows

    def _domain(self) -> str:
        """Return why the spec's own values may be outside of its domain."""
        words = {("u", name): [value] for name, value in self.spec.inputs.items()}
        words |= {("p", name): list(values) for name, values in self.spec.parameters.items()}

        def at(lane: int) -> dict[Any, Any]:
            return {name: exact(values[lane % len(values)]) for name, values in words.items()}

        for name in self.spec.states.values():
            starts = self.spec.initial.get(name, (num(0),))
            lanes = max(len(starts), *(len(words[s]) for tree in starts for s in symbols(tree)), 1)
            words["x", name] = [compute(starts[n % len(starts)], at(n)) for n in range(lanes)]
        for body in self.spec.of("body"):
            words["T", body.name] = [compute(body.laws["temperature"], at(0))]
        for text, tree in self.spec.conditions:
            lanes = max((len(words[s]) for s in symbols(tree)), default=1)
            if not all(holds(tree, at(lane)) for lane in range(lanes)):
                return f"the spec's own values are not in {text!r}"
        return ""

    def _system(self) -> str:
        divisors = [Claim((), compare(tree, "!=")) for tree in self.found.divisors]
        return self.found.reasons.get("system", "") or self._all(divisors)

    def _temperature(self, body: Element) -> str:
        law = body.laws["temperature"]
        slope = derivative(law, ("x", body.name))
        claims = [*partial(law), *partial(slope)]
        return self._all([*claims, *(Claim((), compare(tree, ">")) for tree in (law, slope))])

    def _element(self, element: Element) -> Iterator[Row]:
        trees = [tree for tree in (element.costate, element.law) if tree] or [*element.laws.values()]
        claims = [claim for tree in trees for claim in partial(tree)]
        moving = [tree for tree in trees if _moves(tree)]
        if claims or element.law:
            yield self._row("welldef", element.name, lambda: self._all(claims))
        if moving and not element.jumps:
            yield self._row("continuous", element.name, lambda: self._continuous(moving))
        if element.law:
            yield self._row("passive", element.name, lambda: self._passive(element))
        elif element.kind.form == "conduction":
            flows = [*claims, Claim((), compare(trees[0], ">="))]
            yield self._row("passive", element.name, lambda: self._all(flows))

    def _continuous(self, trees: list[Node]) -> str:
        for tree in trees:
            closed = _Closed()
            relaxed = closed.tree(tree, ())
            same = [Claim(tuple(closed.where), compare(relaxed, "=", tree))] * (relaxed != tree)
            if reason := self._all([*closed.claims, *same]):
                return reason
        return ""

    def _passive(self, element: Element) -> str:
        """Return why a law may give power: its certificate, if it has one, else cvc5."""
        law, z = element.law or num(0), sym(("z", element.name))
        given = [e["certificate"] for e in self.stated["passive", element.name] if e.get("certificate")]
        if given:
            reason = check_certificate(self.spec, element, given[0], self.prover)
        else:
            sides = ((">", ">="), ("<", "<="))
            reason = self._all([Claim((compare(z, s),), compare(law, op)) for s, op in sides])
        return reason or self._of("welldef", element.name)

    def _balances(self) -> Iterator[Row]:
        good = self._good("temperature", "passive", "domain")
        yield self._row("sigma", "", lambda: "" if good else "a row it rests on is not confirmed")
        claims = []
        for element in self.spec.of("ambient"):
            law, hot = element.laws["conductance"], sym(("u", element.input))
            claims += [*partial(law), *(Claim((), compare(*c)) for c in ((law, ">="), (hot, ">")))]
        for name in ("exergy", "environment") if claims else ():
            rests = self._of("sigma") or self._of("energy")
            yield self._row(name, "", lambda rests=rests: rests or self._all(claims))

    # Information, where it is claimed

    def _others(self) -> Iterator[Row]:
        for (name, owner), entries in self.stated.items():
            claimed = any(e.get("verdict") == "PROVED" or e.get("required", True) for e in entries)
            element = self.spec.elements.get(owner)
            if (name, owner) in self.done or not claimed:
                continue
            check: Callable[[], str] = lambda: "the checker knows no such row"  # noqa: E731
            if name == "odd" and element and element.law:
                check = lambda element=element: self._odd(element)  # noqa: E731
            elif name == "invariant" and element and element.kind.form == "body":
                check = lambda element=element: self._invariant(element)  # noqa: E731
            yield self._row(name, owner, check)

    def _odd(self, element: Element) -> str:
        law, z = element.law or num(0), ("z", element.name)
        turned, minus = put(law, {z: Node("neg", (sym(z),))}), Node("neg", (law,))
        if not Field().same(turned, minus):
            return self._all([Claim((), compare(turned, "=", minus))])
        return self._of("welldef", element.name)

    def _invariant(self, body: Element) -> str:
        """Return why a body may cool below its floor: T > floor, T <= m < T_e."""
        T, m, claims, cold = sym(("T", body.name)), sym(("m", "")), list[Claim](), False
        for element in self.spec.of("ambient", "conduction"):
            if body.name not in element.bodies:
                continue
            lam = element.laws["conductance"]
            if element.kind.form == "conduction":
                other = next(sym(("T", b)) for b in element.bodies if b != body.name)
                gain = made("lam*(a/T - 1)", lam=lam, a=other, T=T)
                claims.append(Claim((compare(T, "<=", other),), compare(gain, ">=")))
                continue
            hot, cold = sym(("u", element.input)), True
            gains = [made("lam*(a/T - 1)", lam=lam, a=hot, T=x) for x in (T, m)]
            between = (compare(T, "<=", m), compare(m, "<", hot))
            wanted = (compare(gains[0], ">=", gains[1]), compare(gains[1], ">="))
            claims += [Claim(between, claim) for claim in wanted]
        above = {">": 0, "<": 1}
        floors = [c for c in self.conditions if c.value in above and c.args[above[c.value]] == T]
        need(cold and bool(floors), "no floor of T, or no environment")
        return self._all(claims) or self._of("sigma")


def _moves(tree: Node) -> bool:
    """Return whether a law has a choice or kink in its letter, a state or a temperature."""
    choosers = (n.args[0] if n.op == "if" else n for n in walk(tree) if n.op in ("if", *KINKS))
    return any(role in MOVING for chooser in choosers for role, _ in symbols(chooser))


class _Closed:
    """A law on the closed cells of its choices, which cover the domain.

    Each comparison that moves becomes a choice b of a side, free where both sides are equal.  On
    each cell the law's branch has values up to the edge; if it is there what the law is, the law
    is continuous: the pasting lemma.  A condition's parts have values before it is relied on.
    """

    def __init__(self) -> None:
        self.where, self.claims, self.field = list[Node](), list[Claim](), Field()

    def tree(self, node: Node, path: tuple[Node, ...]) -> Node:
        """Return a law in choices of sides; book what is needed for it to have a value."""
        if node.op == "sign":
            return self.tree(unkinked(node), path)
        if node.op != "if":
            made = Node(node.op, tuple(self.tree(arg, path) for arg in node.args), node.value)
            bare = Node(node.op, tuple(sym(("part", str(n))) for n in range(len(made.args))), node.value)
            inner = {("part", str(n)): arg for n, arg in enumerate(made.args)}
            if node.op != "/" or made.args[1].op != "num" or not made.args[1].value:
                own = [put(claim, inner) for _, claim in partial(bare)]
                self.claims += [Claim((*self.where, *path), claim) for claim in own]
            return made
        left, right = (self.tree(arg, path) for arg in node.args[0].args)
        side = Node("cmp", (left, right), node.args[0].value)
        if any(role in MOVING for role, _ in symbols(node.args[0])):
            side = self._side(side, path)
        then = self.tree(node.args[1], (*path, side))
        return Node("if", (side, then, self.tree(node.args[2], (*path, negated(side)))))

    def _side(self, condition: Node, path: tuple[Node, ...]) -> Node:
        """Return the comparison b > 0 (or b <= 0) that stands for left above (below) right."""
        difference = made("x - z", x=condition.args[0], z=condition.args[1])
        key = self.field.scaled([self.field.of(difference)])[1][0]
        turned, above = key.negative, condition.value in (">", ">=")
        key, difference = (-key, Node("neg", (difference,))) if turned else (key, difference)
        chosen = compare(sym(("side", f"{key.top}/{key.bottom}")), ">")
        edge = Node("if", (chosen, difference, Node("neg", (difference,))))
        for step in reversed(path):
            edge = Node("if", (step, edge, num(0)))
        self.where.append(compare(edge, ">="))
        return chosen if above != turned else negated(chosen)


def _spelled(node: Node) -> str:
    if node.op in ("num", "sym"):
        return str(node.value if node.op == "num" else ".".join(map(str, node.value)))
    return f"{node.op}({', '.join(map(_spelled, node.args))})"
