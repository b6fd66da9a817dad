"""The rows that a spec needs, listed from the spec itself, and whether each is confirmed.

Input: a `Spec` and the parsed ``proofs.json``.  Output: one (id, element, reason) per row, the
reason empty where it is confirmed.  skew and casimir follow from the balances; `program` is about
printed text, which is not read here: it must be stated, and is reported as stated.
"""

from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from typing import Any

from . import laws
from .certificate import check_certificate
from .field import ZERO, Field
from .functions import KINKS
from .laws import InputError, Node, build, compare, need, negated, num, subs, sym, symbols
from .parts import stem
from .prover import Claim, Prover, guarded, needed, partial, true
from .slopes import equal, vanishes
from .spec import Element, Spec
from .system import Finding

Key = tuple[str, str]
#: STATED: the row that is read but not checked; `UNSTATED` rows are checked though never stated.
STATED, MOST_PIECES, MOVING, UNSTATED = "program", 400, ("z", "r", "x", "T"), ("domain", "system")


def audit(spec: Spec, proofs: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Return every row of a spec, and why it is not confirmed."""
    return [(*key, why) for key, why in _Audit(spec, proofs).look().items()]


class _Audit:
    def __init__(self, spec: Spec, proofs: Mapping[str, Any]) -> None:
        self.spec, self.done, self.stated = spec, dict[Key, str](), dict[Key, list[Any]]()
        need(isinstance(proofs, dict), "the proofs are no table")
        entries = proofs.get("obligations")
        listed = isinstance(entries, list) and all(isinstance(e, dict) for e in entries)
        need(listed, "the proofs have no list of obligations")
        for entry in entries or ():
            key = str(entry.get("id")), str(entry.get("element") or "")
            self.stated.setdefault(key, []).append(entry)
        self.found = Finding(spec, proofs.get("system"))
        known = {("T", body.name): body.laws["temperature"] for body in spec.of("body")}
        known |= {("z", name): tree for name, tree in self.found.letters.items()}
        self.ties = tuple(compare(sym(name), "=", law) for name, law in known.items())
        self.prover = Prover(spec.conditions, self.ties)

    def look(self) -> dict[Key, str]:
        """Check the rows, each after those it rests on; return why each is not confirmed, or ''."""
        spec, system = self.spec, [("system", "")]
        self._row("domain", "", self._own_values())
        divisors = [true(tree, "!=") for tree in self.found.divisors]
        self._row("system", "", divisors, why=self._unlike("system"))
        for body in spec.of("body"):
            law, name = body.laws["temperature"], body.name
            slope = laws.derivative(law, ("x", name))
            claims = [*partial(law), *partial(slope), true(law, ">"), true(slope, ">")]
            self._row("temperature", name, claims)
        if not any(why for key, why in self.done.items() if key[0] == "temperature"):
            warm = (compare(sym(("T", body.name)), ">") for body in spec.of("body"))
            self.prover = Prover((*spec.conditions, *warm), self.ties)
        wrong = self._unlike("energy")
        for name in ("skew", "casimir", "energy", "entropy"):
            why = wrong if name in ("skew", "energy") else ""
            claims = [*self.found.values] if name in ("skew", "energy") else []
            claims += _continuous(self._bent(self.found.terms)) if name == "energy" else []
            self._row(name, "", claims, system, why)
        domain = [claim for tree in spec.conditions for claim in partial(tree)]
        if domain or ("welldef", "") in self.stated:
            self._row("welldef", "", domain, system)
        for name in dict.fromkeys(map(stem, spec.elements)):
            self._element(*(e for e in spec.elements.values() if stem(e.name) == name))
        heat = [key for key in self.done if key[0] in ("domain", "temperature", "passive")]
        self._row("sigma", "", (), heat)
        cooled = list[Claim]()
        for e in spec.of("ambient"):
            law, hot = e.laws["conductance"], sym(("u", e.input))
            cooled += [*partial(law), true(law, ">="), true(hot, ">")]
        for name in ("exergy", "environment") if cooled else ():
            self._row(name, "", cooled, [("sigma", ""), ("energy", "")])
        self._row("units", why=next(iter(spec.faults), ""))
        self._row(STATED)
        for key, entries in self.stated.items():
            claimed = any(e.get("verdict") == "PROVED" or e.get("required", True) for e in entries)
            if claimed and key not in self.done:
                self._information(*key)
        return self.done

    def _row(
        self, name: str, owner: str = "", claims: Any = (), rests: Iterable[Key] = (), why: str = ""
    ) -> None:
        """Check a row: it is stated as PROVED, its claims follow, the rows it rests on hold."""
        verdicts = [str(entry.get("verdict")) for entry in self.stated.get((name, owner), ())]
        prover, reason = self.prover if name != "domain" else Prover(()), ""
        try:
            need(name in UNSTATED or bool(verdicts), "missing")
            for verdict in () if name in UNSTATED else verdicts:
                need(verdict == "PROVED", f"stated as {verdict}")
            need(not why, why)
            for key in rests:
                need(not self.done[key], f"it rests on {' '.join(key)}, which is not confirmed")
            for claim, path in dict.fromkeys(claims):
                names = ", ".join(str(name[1]) for name in symbols(claim))[:80]
                shown = prover.proves(claim, path)
                shown = shown or (claim.value == "=" and equal(claim, path, prover))
                need(shown, f"a comparison ({claim.value}) of {names} does not follow")
        except (InputError, ArithmeticError, RuntimeError) as error:
            reason = str(error) or type(error).__name__
        self.done[name, owner] = reason

    def _unlike(self, subject: str) -> str:
        """Return the first difference between the published system and the network, or ''."""
        found = self.found.reasons.get(subject, "")
        for (about, what), own in self.found.branched.items():
            if not found and about == subject and not vanishes(*own, self.prover):
                found = f"{what} is not that of the network"
        return found

    def _own_values(self) -> Iterator[Claim]:
        """Yield the claims that the spec's own values, in each lane, are in its domain."""
        spec = self.spec
        own = {("u", name): [*map(num, values)] for name, values in spec.inputs.items()}
        own |= {("p", name): [*map(num, values)] for name, values in spec.parameters.items()}
        own |= {("x", n): [*spec.initial.get(n, [num(0)])] for n in spec.states.values()}
        own |= {("T", b.name): [b.laws["temperature"]] for b in spec.of("body")}
        for lane in range(max(map(len, own.values()))):
            here = [compare(sym(n), "=", found[lane % len(found)]) for n, found in own.items()]
            yield from (Claim(tree, tuple(here)) for tree in spec.conditions)

    @staticmethod
    def _bent(trees: list[Node]) -> list[Node]:
        """Return the trees in which a choice depends on states, letters, rates or temperatures."""
        kinks = [(t, n) for t in trees for n in laws.walk(t) if n.op in ("if", *KINKS)]
        # a table of two knots, with 5 arguments, is a line
        kinks = [(t, n) for t, n in kinks if n.op != "table" or len(n.args) > 5]
        choosers = [(t, n.args[0] if n.op in ("if", "table") else n) for t, n in kinks]
        return [t for t, n in choosers if any(s[0] in MOVING for s in symbols(n))]

    def _element(self, *parts: Element) -> None:
        element, name = parts[0], stem(parts[0].name)
        own = [tree for e in parts for tree in (e.costate, e.law, e.laws.get("energy")) if tree]
        trees, z = own or list(element.laws.values()), ("z", name)
        claims = [claim for tree in trees for claim in partial(tree)]
        if claims or element.law or ("welldef", name) in self.stated:
            terms = [t for t in self.found.terms if any(("x", e.name) in symbols(t) for e in parts)]
            self._row("welldef", name, [*claims, *(c for t in terms for c in partial(t))])
        if self._bent(joined := [t for t in trees if not (element.jumps and t == element.law)]):
            self._row("continuous", name, _continuous(joined))
        if element.law:
            self._row("passive", name, self._passive(element, z), [("welldef", name)])
        elif element.kind.form == "conduction":
            self._row("passive", name, [*claims, true(trees[0], ">=")])

    def _passive(self, element: Element, z: Key) -> Iterator[Claim]:
        """Yield the claims that a law takes power in, or check its certificate instead."""
        given = [entry.get("certificate") for entry in self.stated["passive", element.name]]
        for certificate in filter(None, given):
            check_certificate(self.spec, element, certificate, self.prover)
        found = laws.on_pieces(element.law or num(0)) if not any(given) else iter(())
        pieces = [*islice(found, MOST_PIECES + 1)]
        need(len(pieces) <= MOST_PIECES, "its tables have too many pieces to look at each")
        for law, path in pieces:
            for side in "<>":
                yield true(law, side + "=", path=(compare(sym(z), side), *path))

    def _information(self, name: str, owner: str) -> None:
        """Check a stated row that the spec does not need."""
        element, z = self.spec.elements.get(owner), sym(("z", owner))
        if name == "odd" and element and element.law:
            turned = subs(element.law, {("z", owner): build("-z", z=z)})
            claims = [*partial(turned), true(turned, "=", build("-x", x=element.law))]
            self._row(name, owner, claims, [("welldef", owner)])
        elif name == "rate-independent" and element and element.law:
            c, v = sym(("c", "")), ("r", owner)
            faster = subs(element.law, {v: build("c*v", c=c, v=sym(v))})
            same = true(faster, "=", build("c*x", c=c, x=element.law), (compare(c, ">"),))
            self._row(name, owner, [same], [("welldef", owner)])
        elif name == "invariant" and element and element.kind.form == "body":
            self._row(name, owner, self._invariant(owner), [("sigma", "")])
        else:
            self._row(name, owner, why="the checker knows no such row")

    def _invariant(self, body: str) -> Iterator[Claim]:
        """Yield the claims that a body does not cool below its floor: T > floor, T <= m < T_e."""
        T, m = sym(("T", body)), sym(("m", ""))
        contacts = [e for e in self.spec.of("ambient", "conduction") if body in e.bodies]
        for e in contacts:
            lam, others = e.laws["conductance"], [b for b in e.bodies if b != body]
            hot = sym(("T", others[0]) if others else ("u", e.input))
            gains = [build("lam*(a/T - 1)", lam=lam, a=hot, T=x) for x in (T, m)]
            between = (compare(T, "<=", m), compare(m, "<", hot))
            if others:
                yield true(gains[0], ">=", path=(compare(T, "<=", hot),))
            else:
                yield true(gains[0], ">=", gains[1], between)
                yield true(gains[1], ">=", path=between)
        floors = [c for c in self.spec.conditions if c.args[0 if c.value == ">" else 1] == T]
        strict = any(c.value in "<>" for c in floors) and any(e.input for e in contacts)
        strict = strict and all(body not in e.bodies for e in self.spec.of("heat"))
        ends = [end for e in self.spec.of("coupling") for pair in e.pairs for end in pair]
        strict = strict and ("T", body) not in ends  # a current may take entropy out of it
        need(strict, "no floor of T, or no environment")


def _continuous(trees: list[Node]) -> Iterator[Claim]:
    for tree in trees:
        closed = _Closed()
        relaxed = closed.tree(tree, ())
        yield from closed.claims
        if relaxed != tree:
            yield true(relaxed, "=", tree, tuple(closed.where))


class _Closed:
    """A law on the closed cells of its choices: if it equals its branch on each, it is continuous.

    Each comparison of moving symbols is replaced by the sign of a new symbol b, which is free where
    both sides are equal, so that either branch is taken there.  Conditions are used only after
    their parts are shown to have values.
    """

    def __init__(self) -> None:
        self.where, self.claims = list[Node](), list[Claim]()
        self.field = Field(scales=True)

    def tree(self, node: Node, path: tuple[Node, ...], kinks: Iterable[str] = ("sign",)) -> Node:
        """Return a law in choices of sides; append the claims under which it has a value."""
        if node.op in kinks:
            return self.tree(laws.unkinked(node), path, kinks)
        if node.op != "if":
            here = Node(node.op, tuple(self.tree(a, path, kinks) for a in node.args), node.value)
            self.claims += [Claim(c, (*self.where, *path)) for c in needed(here)]
            return here
        sides = tuple(self.tree(arg, path, KINKS) for arg in node.args[0].args)
        side = Node("cmp", sides, node.args[0].value)
        if any(role in MOVING for role, _ in symbols(node.args[0])):
            side = self._side(side, path)
        then = self.tree(node.args[1], (*path, side), kinks)
        return Node("if", (side, then, self.tree(node.args[2], (*path, negated(side)), kinks)))

    def _side(self, condition: Node, path: tuple[Node, ...]) -> Node:
        """Return the comparison b > 0 (or b <= 0) that stands for left above (below) right."""
        difference = build("x - z", x=condition.args[0], z=condition.args[1])
        key = self.field.scaled(self.field.of(difference))
        turned = key != ZERO and key.top.leading_coefficient() < 0
        key, difference = (-key, Node("neg", (difference,))) if turned else (key, difference)
        chosen = compare(sym(("side", f"{key.top}/{key.bottom}")), ">")
        side = chosen if (condition.value in (">", ">=")) != turned else negated(chosen)
        moved = {s: sym(("elsewhere", s)) for s in symbols(condition) if s[0] in MOVING}
        edge = build("b*d", b=Node("if", (chosen, num(1), num(-1))), d=difference)
        there = [Node("if", (subs(condition, moved), *map(num, n))) for n in ((0, -1), (-1, 0))]
        for tree in (edge, Node("if", (side, *there))):
            self.where.append(compare(guarded(path, tree), ">="))
        return side
