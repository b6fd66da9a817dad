"""What has to be shown of a spec, listed from the spec itself, and whether it is so.

Input: a `Spec` and the parsed ``proofs.json``.  Output: one (id, element, reason) per row, the
reason empty where it is confirmed.  skew and casimir follow from the balances: the power of the
co-states vanishes for all of them, and nothing but processes and inputs is in an entropy's rate.
`program` is about printed text, which is not read here: it has to be stated.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from . import laws
from .certificate import check_certificate
from .field import Field
from .laws import KINKS, InputError, Node, compare, made, need, negated, num, put, sym, symbols
from .prover import Claim, Prover, needed, partial
from .spec import Element, Spec
from .system import check_system

Row = tuple[str, str, str]
MOVING, OWN = ("z", "x", "T"), ("domain", "system")  # rows that are not stated by the package


def audit(spec: Spec, proofs: Mapping[str, Any]) -> Iterator[Row]:
    """Yield every row of a spec, and whether it is confirmed."""
    return _Audit(spec, proofs).rows()


class _Audit:
    def __init__(self, spec: Spec, proofs: Mapping[str, Any]) -> None:
        self.spec, self.done = spec, dict[tuple[str, str], str]()
        self.stated: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
        need(isinstance(proofs, dict), "the proofs are no table")
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
        reasons, system = self.found.reasons, [("system", "")]
        divisors = [_true(tree, "!=") for tree in self.found.divisors]
        yield self._row("domain", "", self._own_values())
        yield self._row("system", "", divisors, why=reasons.get("system", ""))
        for body in self.spec.of("body"):
            law = body.laws["temperature"]
            slope = laws.derivative(law, ("x", body.name))
            claims = [*partial(law), *partial(slope), _true(law, ">"), _true(slope, ">")]
            yield self._row("temperature", body.name, claims)
        if not any(self.done[key] for key in self.done if key[0] == "temperature"):
            warm = tuple(compare(sym(("T", b.name)), ">") for b in self.spec.of("body"))
            self.prover = Prover((*self.conditions, *warm), self.ties)
        for name in ("skew", "casimir", "energy", "entropy"):
            why = reasons.get("energy", "") if name in ("skew", "energy") else ""
            yield self._row(name, "", (), system, why)
        domain = [claim for tree in self.conditions for claim in partial(tree)]
        if domain or ("welldef", "") in self.stated:
            yield self._row("welldef", "", domain, system)
        for element in self.spec.elements.values():
            yield from self._element(element)
        heat = [key for key in self.done if key[0] in ("domain", "temperature", "passive")]
        yield self._row("sigma", "", (), heat)
        cooled = [claim for e in self.spec.of("ambient") for claim in _cooling(e)]
        for name in ("exergy", "environment") if cooled else ():
            yield self._row(name, "", cooled, [("sigma", ""), ("energy", "")])
        yield self._row("units", why=next(iter(self.spec.faults), ""))
        yield self._row("program")
        for key, entries in self.stated.items():
            claimed = any(e.get("verdict") == "PROVED" or e.get("required", True) for e in entries)
            if claimed and key not in self.done:
                yield self._information(*key)

    def _row(
        self, name: str, element: str = "", claims: Any = (), rests: Any = (), why: str = ""
    ) -> Row:
        """Return a row: stated as PROVED, its claims follow, and what it rests on is confirmed."""
        stated, listed = self.stated.get((name, element), []), name not in OWN
        verdicts = {str(entry.get("verdict")) for entry in stated} - {"PROVED"}
        prover = self.prover if name != "domain" else Prover(())
        try:
            need(not listed or bool(stated), "missing")
            need(not listed or not verdicts, f"stated as {min(verdicts, default='')}")
            need(not why, why)
            for key in rests:
                need(not self.done[key], f"it rests on {' '.join(key)}, which is not confirmed")
            for path, claim in dict.fromkeys(claims):
                names = ", ".join(str(name[1]) for name in symbols(claim))
                need(
                    prover.proves(claim, path),
                    f"a comparison ({claim.value}) of {names[:80]} does not follow",
                )
            reason = ""
        except (InputError, ArithmeticError, RuntimeError) as error:
            reason = str(error) or type(error).__name__
        self.done[name, element] = reason
        return name, element, reason

    def _own_values(self) -> Iterator[Claim]:
        """Yield that the spec's own values, in each lane, are in its domain."""
        spec = self.spec
        own = {("u", name): [num(value)] for name, value in spec.inputs.items()}
        own |= {("p", n): [num(value) for value in v] for n, v in spec.parameters.items()}
        own |= {("x", n): [*spec.initial.get(n, [num(0)])] for n in spec.states.values()}
        own |= {("T", b.name): [b.laws["temperature"]] for b in spec.of("body")}
        for lane in range(max(map(len, own.values()))):
            here = [compare(sym(n), "=", found[lane % len(found)]) for n, found in own.items()]
            yield from (Claim(tuple(here), tree) for tree in self.conditions)

    def _element(self, element: Element) -> Iterator[Row]:
        own, name = tuple(tree for tree in (element.costate, element.law) if tree), element.name
        trees = own or tuple(element.laws.values())
        claims = [claim for tree in trees for claim in partial(tree)]
        if claims or element.law:
            yield self._row("welldef", name, claims)
        moving = [tree for tree in trees if _moves(tree)]
        if moving and not element.jumps:
            yield self._row("continuous", name, _continuous(moving))
        if element.law:
            yield self._row("passive", name, self._passive(element), [("welldef", name)])
        elif element.kind.form == "conduction":
            yield self._row("passive", name, [*claims, _true(trees[0], ">=")])

    def _passive(self, element: Element) -> Iterator[Claim]:
        """Yield that a law takes power in, after its certificate if it has one."""
        law, z = element.law or num(0), sym(("z", element.name))
        given = [entry.get("certificate") for entry in self.stated["passive", element.name]]
        for certificate in filter(None, given):
            check_certificate(self.spec, element, certificate, self.prover)
        for side in "<>" if not any(given) else "":
            yield Claim((compare(z, side),), compare(law, side + "="))

    def _information(self, name: str, owner: str) -> Row:
        """Return a row that is looked at where it is claimed."""
        element = self.spec.elements.get(owner)
        if name == "odd" and element and element.law:
            turned = put(element.law, {("z", owner): made("-z", z=sym(("z", owner)))})
            claim = Claim((), compare(turned, "=", made("-x", x=element.law)))
            return self._row(name, owner, [claim], [("welldef", owner)])
        if name == "invariant" and element and element.kind.form == "body":
            return self._row(name, owner, self._invariant(element), [("sigma", "")])
        return self._row(name, owner, why="the checker knows no such row")

    def _invariant(self, body: Element) -> Iterator[Claim]:
        """Yield that a body does not cool below its floor: T > floor, T <= m < T_e."""
        T, m = sym(("T", body.name)), sym(("m", ""))
        around = [e for e in self.spec.of("ambient", "conduction") if body.name in e.bodies]
        for e in around:
            lam, others = e.laws["conductance"], [b for b in e.bodies if b != body.name]
            hot = sym(("T", others[0]) if others else ("u", e.input))
            gains = [made("lam*(a/T - 1)", lam=lam, a=hot, T=x) for x in (T, m)]
            between = (compare(T, "<=", m), compare(m, "<", hot))
            if others:
                yield Claim((compare(T, "<=", hot),), compare(gains[0], ">="))
            else:
                yield Claim(between, compare(gains[0], ">=", gains[1]))
                yield Claim(between, compare(gains[1], ">="))
        floors = [c for c in self.conditions if T in (c.args[:1] if c.value == ">" else c.args[1:])]
        strict = any(c.value in "<>" for c in floors) and any(e.input for e in around)
        need(strict, "no floor of T, or no environment")


def _continuous(trees: list[Node]) -> Iterator[Claim]:
    """Yield that laws do not jump where their choices meet."""
    for tree in trees:
        closed = _Closed()
        relaxed = closed.tree(tree, ())
        yield from closed.claims
        if relaxed != tree:
            yield Claim(tuple(closed.where), compare(relaxed, "=", tree))


def _cooling(element: Element) -> list[Claim]:
    """Return what heat exchange needs: a conductance that is not negative, T_e above zero."""
    law = element.laws["conductance"]
    return [*partial(law), _true(law, ">="), _true(sym(("u", element.input)), ">")]


def _true(left: Node, operator: str) -> Claim:
    return Claim((), compare(left, operator))


def _moves(tree: Node) -> bool:
    """Return whether a law has a choice or kink in its letter, a state or a temperature."""
    choosers = (n.args[0] if n.op == "if" else n for n in laws.walk(tree) if n.op in ("if", *KINKS))
    return any(role in MOVING for chooser in choosers for role, _ in symbols(chooser))


class _Closed:
    """A law on the closed cells of its choices, which cover the domain.

    Each comparison that moves becomes a choice b of a side, free where both sides are equal.  On
    each cell the law's branch has values up to the edge; if it is there what the law is, the law
    is continuous: the pasting lemma.  A condition's parts have values before it is relied on.
    Cells that are empty do not count: `where` says that the choices are those of some point, too.
    """

    def __init__(self) -> None:
        self.where, self.claims, self.field = list[Node](), list[Claim](), Field(lambda _: False)

    def tree(self, node: Node, path: tuple[Node, ...]) -> Node:
        """Return a law in choices of sides; book what is needed for it to have a value."""
        if node.op == "sign":
            return self.tree(laws.unkinked(node), path)
        if node.op != "if":
            here = Node(node.op, tuple(self.tree(arg, path) for arg in node.args), node.value)
            self.claims += [Claim((*self.where, *path), c) for c in needed(here)]
            return here
        left, right = (self.tree(laws.plain(arg), path) for arg in node.args[0].args)
        side = Node("cmp", (left, right), node.args[0].value)
        if any(role in MOVING for role, _ in symbols(node.args[0])):
            side = self._side(side, path)
        then = self.tree(node.args[1], (*path, side))
        return Node("if", (side, then, self.tree(node.args[2], (*path, negated(side)))))

    def _side(self, condition: Node, path: tuple[Node, ...]) -> Node:
        """Return the comparison b > 0 (or b <= 0) that stands for left above (below) right."""
        difference = made("x - z", x=condition.args[0], z=condition.args[1])
        key = self.field.scaled(self.field.of(difference))
        turned = key != 0 and key.top.leading_coefficient() < 0
        above = condition.value in (">", ">=")
        key, difference = (-key, Node("neg", (difference,))) if turned else (key, difference)
        chosen = compare(sym(("side", f"{key.top}/{key.bottom}")), ">")
        side = chosen if above != turned else negated(chosen)
        elsewhere = {name: sym(("elsewhere", name)) for name in symbols(condition)}
        moved = put(condition, {name: own for name, own in elsewhere.items() if name[0] in MOVING})
        edge = Node("if", (chosen, difference, Node("neg", (difference,))))
        point = Node("if", (side, *(Node("if", (moved, *map(num, n))) for n in ((0, -1), (-1, 0)))))
        for step in reversed(path):
            edge, point = (Node("if", (step, tree, num(0))) for tree in (edge, point))
        self.where += [compare(edge, ">="), compare(point, ">=")]
        return side
