"""Kirchhoff's and Newton's laws of a spec as one sparse tableau, solved in any field.

Input: a `Spec`, the size of each bank, and the algebra of the laws, numbers or rational functions:
`one`, ``law(element, field, lane, letter)`` (field "law" is the dissipative one), ``given(role,
owner, lane)`` of an input "u", a co-state "E" or a temperature "T", and ``weight(slot)``, the
number of lanes that a slot represents.  Output: `Flows`.  Unknowns are the through and the across
variable of each branch and the potential of each node; a law linear in its letter is an equation,
in either causality.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from typing import Any, NamedTuple

from .field import Field
from .kinds import REFERENCES
from .laws import Node, build, need, num, subs, sym
from .spec import Element, Spec

Form = dict[Any, Any]
Slot = tuple[str, int]
#: A rank, and the unknown to solve a row for, or None.
Choice = tuple[tuple[int, ...], Any]
FORMS = ("store", "law", "source", "coupling", "hysteron", "body")
UNKNOWN = ("through", "across", "potential")


class Branch(NamedTuple):
    """A branch: element and lane, role, nodes, and whether it imposes its across variable."""

    element: str
    lane: int
    role: str
    nodes: tuple[Any, Any]
    across: bool

    def variables(self) -> tuple[tuple[str, "Branch"], tuple[str, "Branch"]]:
        """Return the variable that the branch imposes, then the other."""
        across, through = ("across", self), ("through", self)
        return (across, through) if self.across else (through, across)


class SingularError(Exception):
    """The laws have no or more than one solution, or a loop of nonlinear laws."""


class Flows(NamedTuple):
    """A solved network, by (element, lane); `ports` has each port's output and conjugate input."""

    letters: dict[Slot, Any]
    outputs: dict[Slot, Any]
    rates: dict[Slot, Any]
    ports: dict[str, tuple[Any, Any]]
    pivots: list[Any]


def flows(spec: Spec, counts: Mapping[str, int], algebra: Any) -> Flows:
    """Return the solution of a network; raises `SingularError` if there is no single one."""
    branches, zero = _all_branches(spec, counts), algebra.one - algebra.one
    unknowns, pivots, left = solved(_equations(spec, branches, algebra))
    if left:
        raise SingularError("the laws of the network have no single solution")
    found = Flows({}, {}, {}, {}, pivots)

    def answer(branch: Branch) -> Any:
        total = zero
        for (role, *slot), factor in unknowns[branch.variables()[1]].items():
            if role == "R" and branch.role == "store":
                continue  # rates of followers cancel in the rate of the joined state
            if role == "R" or (role == "W" and (*slot,) not in found.outputs):
                raise SingularError("laws that are not linear depend on each other")
            total += factor * (found.outputs[*slot,] if role == "W" else algebra.given(role, *slot))
        return total

    stores = {(b.element, b.lane): b for b in branches if b.role == "store"}
    order = {"law": 0, "linear": 1, "slip": 2}  # later roles may depend on earlier ones
    for branch in sorted(branches, key=lambda b: order.get(b.role, 3)):
        element, slot = spec.elements[branch.element], (branch.element, branch.lane)
        if branch.role in order:
            letters = [answer(branch)]
            if branch.role == "slip":
                found.outputs[slot] = zero  # the rate that drives a slip is without the slip
                letters.append(answer(stores[slot]))
            found.letters[slot] = letters[0]
            found.outputs[slot] = algebra.law(element, "law", branch.lane, *letters)
        elif branch.role in ("store", "body"):
            found.rates[slot] = answer(branch)
        elif branch.role == "source":
            y = -answer(branch) if branch.across else answer(branch)
            found.ports[branch.element] = y, algebra.given("u", branch.element, 0)
    _heat(spec, algebra, found)
    return found


def relations(spec: Spec, counts: Mapping[str, int], algebra: Any) -> list[Form]:
    """Return the combinations of given quantities that the laws of the network force to be zero."""
    return [*filter(None, solved(_equations(spec, _all_branches(spec, counts), algebra))[2])]


def _all_branches(spec: Spec, counts: Mapping[str, int]) -> list[Branch]:
    found, users = list[Branch](), dict[Any, set[Any]]()
    for e in spec.of(*FORMS):
        found += _branches(e, range(1, counts[e.lanes[0]] + 1) if e.lanes else (0,))
        for node in (node for pair in e.pairs for node in pair):
            users.setdefault(node, set()).add(e.lanes)
        for node in e.chain or ():
            users.setdefault(node, set()).add(None)
    own = {node for node, lanes in users.items() if len(lanes) == 1 and None not in lanes}
    own -= {*REFERENCES.values()}  # each lane has its own copy of nodes that one bank alone uses

    def placed(node: Any, branch: Branch) -> Any:
        element = spec.elements[branch.element]
        if element.chain and element.lanes and node in element.chain:
            first = node == element.chain[0]
            return ((element.lanes[0],), branch.lane) if first else REFERENCES["E"]
        need(not element.chain or node in own or isinstance(node, tuple), "a chain has more ends")
        return (node, branch.lane) if node in own else node

    return [b._replace(nodes=(placed(b.nodes[0], b), placed(b.nodes[1], b))) for b in found]


def _heat(spec: Spec, algebra: Any, found: Flows) -> None:
    """Add to entropy rates the heats of laws over T, and the inflows lam*(T_e/T - 1) or P/T."""
    T = {body.name: algebra.given("T", body.name, 0) for body in spec.of("body")}
    for slot, W in found.outputs.items():
        (body,) = spec.elements[slot[0]].bodies
        found.rates[body, 0] += algebra.weight(slot) * W * found.letters[slot] / T[body]
    for e in spec.of("ambient", "conduction", "heat"):
        lam, ends = algebra.law(e, "conductance", 0), [T[body] for body in e.bodies]
        ends += [algebra.given("u", e.name, 0)] if e.input else []
        for body, own, other in zip(e.bodies, ends, reversed(ends), strict=False):
            flow = other / own if e.kind.form == "heat" else lam * (other / own - algebra.one)
            found.rates[body, 0] += flow
            if e.input:
                found.ports[e.name] = own, flow


def _branches(e: Element, lanes: Iterable[int]) -> Iterator[Branch]:
    law = "linear" if e.law and is_linear(e.law, ("z", e.name)) else "law"
    store = "follower" if e.follows else "store"
    for lane in lanes:
        if e.kind.form == "hysteron":
            (a, b), inner = e.pairs[0], (e.name, lane)
            yield Branch(e.name, lane, store, (a, inner), e.follows)
            yield Branch(e.name, lane, law, (inner, b), True)
        elif e.kind.form == "store" and e.law:
            (a, b), inner = e.pairs[0], (e.name, lane)
            yield Branch(e.name, lane, store, (a, b) if e.across else (a, inner), e.across)
            yield Branch(e.name, lane, "slip", (a, b) if e.across else (inner, b), not e.across)
        else:
            roles = {"coupling": ("first", "second"), "law": (law,), "store": (store,)}
            for role, pair in zip(roles.get(e.kind.form, (e.kind.form,)), e.pairs, strict=True):
                yield Branch(e.name, lane, role, pair, (e.across and role != "second") != e.follows)


def _equations(spec: Spec, branches: list[Branch], algebra: Any) -> Iterator[Form]:
    balances, one = dict[Any, Form](), algebra.one
    for branch in branches:
        fall: Form = {("across", branch): one}
        for node, sign in zip(branch.nodes, (one, -one), strict=True):
            if node not in REFERENCES.values():
                shared = isinstance(node, str)  # a lane's own node is a tuple
                many = algebra.weight((branch.element, branch.lane)) if shared else one
                balances.setdefault(node, {})["through", branch] = sign * many
                fall["potential", node] = -sign
        yield fall
        yield _law(spec.elements[branch.element], branch, algebra)
    for bank, ends in {e.lanes[0]: e.chain for e in spec.of(*FORMS) if e.lanes and e.chain}.items():
        flow, fall = ("through", (bank,)), dict[Any, Any]()
        for node, sign in zip(ends, (one, -one), strict=True):
            if node not in REFERENCES.values():
                balances.setdefault(node, {})[flow] = fall["potential", node] = sign
        for node in [node for node in balances if node[0] == (bank,)]:
            balances[node][flow], fall["potential", node] = -one, -algebra.weight((bank, node[1]))
        yield fall
    yield from balances.values()


def _law(element: Element, branch: Branch, algebra: Any) -> Form:
    """Return the equation (a form that is zero) of the law of a branch."""
    (imposed, answer), one = branch.variables(), algebra.one
    if branch.role in ("first", "second"):
        first, second = _branches(element, (0,))
        ratio = algebra.law(element, next(iter(element.laws)), 0)
        # first: across or through = ratio*across of the second; second: through = -ratio*answer
        other = ("across", second) if branch == first else first.variables()[1]
        return {imposed: one, other: -ratio if branch == first else ratio}
    if branch.role == "linear":
        return {imposed: one, answer: -algebra.law(element, "law", branch.lane, one)}
    roles = {"store": "E", "follower": "R", "law": "W", "slip": "W", "source": "u", "body": "T"}
    given = roles[branch.role], element.name, branch.lane
    return {imposed: one, given: one if branch.role == "source" and not branch.across else -one}


def _choice(n: int, row: Form) -> Choice:
    """Return the best unknown to solve a row for: factor 1 or -1 first, then across variables."""
    known = [(x, factor) for x, factor in row.items() if x[0] in UNKNOWN and factor != 0]
    size = len(row), n
    ranks = [((int(f not in (1, -1)), int(x[0] != "across"), *size), x) for x, f in known]
    return min(ranks, key=lambda choice: choice[0], default=((2, 0, *size), None))


def solved(
    left: Iterable[Form], choose: Callable[[int, Form], Choice] = _choice
) -> tuple[dict[Any, Form], list[Any], list[Form]]:
    """Return each unknown in terms of givens, the pivots, and the rows without unknowns.

    The row with the least rank by `choose` is solved first.
    """
    rows, found, pivots = dict(enumerate(left)), dict[Any, Form](), list[Any]()
    choices = {n: choose(n, row) for n, row in rows.items()}
    while rows:
        (*_, n), label = min(choices.values(), key=lambda choice: choice[0])
        if label is None:
            break
        row = rows.pop(n)
        del choices[n]
        pivots.append(pivot := row.pop(label))
        found[label] = {key: -factor / pivot for key, factor in row.items()}
        for name, form in (*rows.items(), *found.items()):
            if label in form:
                factor = form.pop(label)
                for key, value in found[label].items():
                    form[key] = form[key] + factor * value if key in form else factor * value
                    if (form[key] == 0) is True:  # an enclosure compares as no bool
                        del form[key]
                if name in rows:
                    choices[name] = choose(name, form)
    return found, pivots, [*rows.values()]


@cache
def is_linear(law: Node, letter: Any) -> bool:
    """Return whether a law is proportional to its letter: f(z) = z*f(1), by its form."""
    return Field().same(law, build("z*x", z=sym(letter), x=subs(law, {letter: num(1)})))
