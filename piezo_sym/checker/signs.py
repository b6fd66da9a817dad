"""Signs of a function on a window of its variable, by rules, series and, if rational, by cvc5.

Input: a tree in one symbol t, and a window lo < t <= hi.  Output: the set of signs that it may
have there; `InputError` if it may lack a value.  Rules give the sign of a product or a function
from those of its parts.  A sum with terms of both signs is expanded: FLINT gives the Taylor series
at lo and the remainder on the window; powers of t - lo > 0 are divided out where leading terms are
exactly zero.
"""

from fractions import Fraction
from itertools import product
from math import inf, prod
from typing import Any

from flint import arb, arb_series, ctx, fmpq

from . import laws
from .field import Field
from .functions import KINKS, SMOOTH
from .laws import InputError, Node, build, compare, need, num, subs, sym
from .prover import Prover

BITS, ORDER, T, TANH = 192, 10, sym("s"), "1 - 2/(exp(2*x) + 1)"
ALL, HOLD = frozenset((-1, 0, 1)), {"=": {0}, ">": {1}, ">=": {0, 1}, "<": {-1}, "<=": {-1, 0}}
RULES: dict[str, Any] = {"*": lambda a, b: a * b, "/": lambda a, b: a * b, "neg": lambda a: -a}
RULES |= {"abs": abs, "min": min, "max": max, "sign": lambda a: a}
RULES |= {n: RULES["sign"] if f.sign == "x" else lambda _: 1 for n, f in SMOOTH.items() if f.sign}
Found = frozenset[int]


class Signs:
    """Signs of trees for lo < t <= hi; if lo = hi, at one point, trees do not contain t."""

    def __init__(self, lo: Fraction, hi: Any, prover: Prover) -> None:
        self.lo, self.hi, self.prover, self.known = lo, hi, prover, dict[Node, Found]()
        ends = compare(T, ">", lo), *(() if hi == inf else (compare(T, "<=", hi),))
        self.where = ends if lo != hi else ()

    def of(self, node: Node) -> Found:
        """Return the signs that a tree may have."""
        if node not in self.known:
            self.known[node] = self._of(node)
        return self.known[node]

    def _of(self, node: Node) -> Found:
        if node.op in ("num", "sym"):
            return frozenset([1 if node.op == "sym" else (node.value > 0) - (node.value < 0)])
        if node.op in ("deadzone", "saturate", "table"):
            return self.of(laws.unkinked(node))
        if node.op == "if":
            return frozenset().union(*map(self.of, self._branches(node)))
        parts = [self.of(arg) for arg in node.args]
        power = Fraction(node.value if node.op == "**" else -1 if node.op == "/" else 1)
        defined = power >= 0 or 0 not in parts[-1]
        defined &= power.denominator == 1 or -1 not in parts[0]
        need(defined and node.op != "pow" and (node.op != "log" or parts == [{1}]), "no value")
        if node.op == "**":
            found = frozenset(sign ** abs(power.numerator) for sign in parts[0])
        elif node.op == "+":
            sums = [set(signs) - {0} or {0} for signs in product(*parts)]
            found = frozenset().union(*(ALL if len(signs) > 1 else signs for signs in sums))
        else:
            rule = RULES.get(node.op)
            found = frozenset(rule(*signs) for signs in product(*parts)) if rule else ALL
        decided = node.op in KINKS or not {-1, 1} <= found
        return found if decided else self._as_a_whole(node)

    def _branches(self, node: Node) -> tuple[Node, ...]:
        """Return the branch of a choice that is taken, or both if that is open."""
        condition, then, other = node.args
        signs = self.of(build("x - z", x=condition.args[0], z=condition.args[1]))
        hold = HOLD[condition.value]
        return (then,) if signs <= hold else (then, other) if signs & hold else (other,)

    def _as_a_whole(self, node: Node) -> Found:
        """Return the signs of a tree by its series, or by cvc5."""
        tree = Node(node.op, tuple(map(self._settled, node.args)), node.value)
        found = self._by_series(tree) if self.hi != inf else ALL
        rational = not any(part.op in SMOOTH for part in laws.walk(tree))
        if found == ALL and (self.hi == inf or rational):
            for side in ("=", ">=", "<="):
                if self.prover.proves(compare(tree, side), self.where):
                    return frozenset(HOLD[side])
        return found

    def _settled(self, node: Node) -> Node:
        """Return a tree with decided choices replaced by their branch, and zeros by 0."""
        if self.of(node) == {0}:
            return num(0)
        if node.op in KINKS:
            return self._settled(laws.unkinked(node))
        branches = self._branches(node) if node.op == "if" else ()
        if len(branches) == 1:
            return self._settled(branches[0])
        args = (self._settled(arg) if arg.op != "cmp" else arg for arg in node.args)
        return Node(node.op, tuple(args), node.value)

    def _by_series(self, node: Node) -> Found:
        radius = arb(_exact((self.hi - self.lo) / 2))
        step, field = arb(radius, radius), Field()
        try:
            both = [arb_series([_exact(self.lo) + more, 1]) for more in (arb(0), step)]
            left, whole = (self._series(node, t) for t in both)
            if field.is_zero(field.of(subs(node, {"s": num(self.lo)}))):
                left = arb_series([0, *list(left)[1:]], prec=left.prec)
        except (ValueError, ZeroDivisionError, InputError):
            return ALL
        if self.lo == self.hi:
            return _sign(left[0])
        first = next((k for k in range(left.prec) if (left[k] == 0) is not True), left.prec)
        for order in range(min(whole.prec, left.prec + 1)):
            total, skipped = whole[order], min(first, order)
            for k in reversed(range(skipped, order)):
                total = left[k] + step * total
            if (found := _sign(total)) != ALL:
                return found
        return ALL

    def _series(self, node: Node, t: Any) -> Any:
        """Return the series of a tree as long as it is finite; an open choice has one term."""
        if node.op in ("num", "sym"):
            return t if node.op == "sym" else arb_series([_exact(node.value)])
        if node.op == "tanh":
            return self._series(build(TANH, x=node.args[0]), t)
        parts = self._branches(node) if node.op == "if" else node.args
        args, power = [self._series(part, t) for part in parts], Fraction(node.value or 0)
        if node.op == "if":
            value = args[0][0].union(args[-1][0])
            found = args[0] if len(args) == 1 else arb_series([value], prec=1)
        elif node.op == "**" and power.denominator == 1:
            found = prod([args[0]] * abs(power.numerator), start=arb_series([1]))
            found = found if power >= 0 else 1 / found
        elif node.op == "**":
            found = (args[0].log() * arb(_exact(power))).exp()
        elif node.op in laws.ARITHMETIC:
            found = laws.ARITHMETIC[node.op](*args)
        else:
            found = getattr(args[0], node.op)()
        kept = next((k for k in range(found.prec) if not found[k].is_finite()), found.prec)
        need(kept > 0, "it has no value")
        return arb_series(list(found)[:kept], prec=kept)


def _sign(ball: Any) -> Found:
    if ball == 0:
        return frozenset([0])
    tests = {">": ball > 0, "<": ball < 0, ">=": ball >= 0, "<=": ball <= 0}
    return frozenset(next((HOLD[side] for side, good in tests.items() if good), ALL))


def _exact(number: Fraction) -> Any:
    return fmpq(number.numerator, number.denominator)


def shown(f: Node, centre: Fraction, side: int, ends: tuple[Fraction, Any], prover: Prover) -> bool:
    """Return whether f(s)*s >= 0 for s = centre + side*t, lo < t <= hi, or at a point lo = hi."""
    before, ctx.prec, ctx.cap = (ctx.prec, ctx.cap), BITS, ORDER + 1
    s = build("c + k*s", c=num(centre), k=num(side))
    s = num(centre + side * ends[0]) if ends[0] == ends[1] else s
    try:
        return Signs(*ends, prover).of(Node("*", (subs(f, {"s": s}), s))) <= {0, 1}
    except InputError:
        return False
    finally:
        ctx.prec, ctx.cap = before
