"""Passive laws, and edits of their text drawn from a fixed grammar: what a hand might slip into.

A law is its text and the assumptions of its domain; an edit gives another law.  Python's own tree
of the text is changed, so that nothing of the package is needed.
"""

import ast
import copy
from typing import NamedTuple

from tests.proofs.law_oracle import names_of, tree_of, widths

LETTER = "i"
#: Values for the specs; they lie in every domain below.
VALUES = {"R": 2.0, "a": 0.5, "b": 3.0, "i_0": 0.25, "i_1": 1.5, "T_0": 200.0}


class Law(NamedTuple):
    """A law and its domain, as text."""

    text: str
    domain: tuple[str, ...]

    @property
    def tree(self):
        return tree_of(self.text)

    @property
    def conditions(self):
        """What holds in the domain, as trees: what is assumed, half widths, T > 0."""
        assumed = [tree_of(text) for text in self.domain]
        return [*assumed, *widths(self.tree), tree_of("T > 0")]

    @property
    def names(self):
        found = names_of(self.tree, *self.conditions)
        return (LETTER, *(name for name in found if name != LETTER))


def law(text, domain):
    return Law(text, tuple(part.strip() for part in domain.split(",") if part.strip()))


BASES = [
    law("R/(T - T_0)*deadzone(i, i_0)", "T > T_0, R >= 0, i_0 >= 0"),
    law("R*i", "R >= 0"),
    law("R*i + a*i**3", "R >= 0, a >= 0"),
    law("R*i*abs(i) + a*i", "R >= 0, a >= 0"),
    law("R*tanh(i/i_0)", "R >= 0, i_0 > 0"),
    law("R*(exp(i/i_0) - 1)", "R >= 0, i_0 > 0"),
    law("R*saturate(i, i_0)", "R >= 0, i_0 >= 0"),
    law("R*i/(1 + (i/i_0)**2)", "R >= 0, i_0 > 0"),
    law("R*i/sqrt(i_0**2 + i**2)", "R >= 0, i_0 > 0"),
    law("R*i if abs(i) < i_0 else R*(2*i - i_0*sign(i))", "R >= 0, i_0 > 0"),
    law("R*i*(1 + a*(T - T_0))", "T > T_0, R >= 0, a >= 0"),
    law("R*i*exp(a*(1/T - 1/T_0))", "R >= 0, T_0 > 0"),
    law("R*i if i > 0 else a*i", "R >= 0, a >= 0"),
    law("R*sign(i)*log(1 + abs(i)/i_0)", "R >= 0, i_0 > 0"),
    law("R*(i/i_0 + sin(i/i_0))", "R >= 0, i_0 > 0"),
    law("R*i*T/(T + T_0)", "R >= 0, T_0 >= 0"),
    law("max(R*i, 0) + min(a*i, 0)", "R >= 0, a >= 0"),
    law("R*sign(i) + a*i", "R >= 0, a >= 0"),
    law("R*i*(2 + cos(i/i_0))", "R >= 0, i_0 > 0"),
    law(
        "R*(i - i_0) if i > i_0 else R*(i + i_0) if i < -i_0 else 0*i",
        "R >= 0, i_0 >= 0",
    ),
    law("R*i**3/(T - T_0)**2", "T > T_0, R >= 0"),
    law("R*i*sqrt(T/T_0)", "R >= 0, T_0 > 0"),
    law("R*sqrt(abs(i)/i_0)*sign(i)", "R >= 0, i_0 > 0"),
    law("a*i*exp(-(i/i_0)**2) + R*i", "R >= 0, a >= 0, i_0 > 0"),
    law("R*(deadzone(i, i_0) + deadzone(i, i_1))", "R >= 0, i_0 >= 0, i_1 > i_0"),
    law("(R + a*T/T_0)*i**3/(b + i**2)", "R >= 0, a >= 0, b > 0, T_0 > 0"),
]

ONE = ("exp", "log", "sqrt", "sin", "cos", "tanh", "abs", "sign")
TWO = ("min", "max", "deadzone", "saturate")
COMPARISONS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)


def numeric(tree):
    """Return the parts of a law that are numbers, exponents aside."""
    exponents = {id(n.right) for n in ast.walk(tree) if _is_power(n)}
    kinds = (ast.Name, ast.BinOp, ast.UnaryOp, ast.Call, ast.IfExp, ast.Constant)
    called = {id(n.func) for n in ast.walk(tree) if isinstance(n, ast.Call)}
    skipped = exponents | called
    return [n for n in ast.walk(tree) if isinstance(n, kinds) and id(n) not in skipped]


def _is_power(node):
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow)


def _replaced(tree, old, new):
    """Return a tree with one node, by identity, replaced."""

    class Swap(ast.NodeTransformer):
        def visit(self, node):
            return new if node is old else self.generic_visit(node)

    return Swap().visit(tree)


def _minus(node):
    return ast.UnaryOp(ast.USub(), copy.deepcopy(node))


def _times(factor, node):
    return ast.BinOp(ast.Constant(factor), ast.Mult(), copy.deepcopy(node))


def flip_sign(tree, random):
    node = random.choice(numeric(tree))
    return _replaced(tree, node, _minus(node))


def move_threshold(tree, random):
    """Change the right side of a comparison, or a half width."""
    sides = [(n.comparators, 0) for n in ast.walk(tree) if isinstance(n, ast.Compare)]
    sides += [(n.args, 1) for n in ast.walk(tree) if isinstance(n, ast.Call) and len(n.args) == 2]
    if not sides:
        return None
    parts, n = random.choice(sides)
    more = random.choice([_times(2, parts[n]), _times(0, parts[n]), ast.Name("i_0")])
    parts[n] = more
    return tree


def change_exponent(tree, random):
    powers = [n for n in ast.walk(tree) if _is_power(n)]
    exponent = ast.Constant(random.choice([2, 3, 4, 0.5]))
    if powers and random.random() < 0.7:
        random.choice(powers).right = exponent
        return tree
    node = random.choice(numeric(tree))
    return _replaced(tree, node, ast.BinOp(copy.deepcopy(node), ast.Pow(), exponent))


def swap_branches(tree, random):
    choices = [n for n in ast.walk(tree) if isinstance(n, ast.IfExp)]
    if not choices:
        return None
    node = random.choice(choices)
    node.body, node.orelse = node.orelse, node.body
    return tree


def replace_function(tree, random):
    """Put one function for another; a law without one gets one."""
    calls = [n for n in ast.walk(tree) if isinstance(n, ast.Call)]
    if calls:
        call = random.choice(calls)
        call.func = ast.Name(random.choice(ONE if len(call.args) == 1 else TWO))
        return tree
    node = random.choice(numeric(tree))
    return _replaced(tree, node, ast.Call(ast.Name(random.choice(ONE)), [copy.deepcopy(node)], []))


def scale_term(tree, random):
    node = random.choice(numeric(tree))
    return _replaced(tree, node, _times(random.choice([-1, 2, 0]), node))


def exchange_names(tree, random):
    found = list(names_of(tree))
    if len(found) < 2:
        return None
    one, other = random.sample(found, 2)
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and node.id in {one, other}:
            node.id = other if node.id == one else one
    return tree


def turn_comparison(tree, random):
    found = [n for n in ast.walk(tree) if isinstance(n, ast.Compare)]
    if not found:
        return None
    random.choice(found).ops = [random.choice(COMPARISONS)()]
    return tree


def remove_term(tree, random):
    sums = [n for n in ast.walk(tree) if isinstance(n, ast.BinOp)]
    sums = [n for n in sums if isinstance(n.op, ast.Add | ast.Sub)]
    if not sums:
        return None
    node = random.choice(sums)
    return _replaced(tree, node, random.choice([node.left, node.right]))


EDITS = (
    flip_sign,
    move_threshold,
    change_exponent,
    swap_branches,
    replace_function,
    scale_term,
    exchange_names,
    turn_comparison,
    remove_term,
)


def mutant(random):
    """Return a law after one or two edits; each edit is drawn anew until one applies."""
    made = random.choice(BASES)
    for _ in range(random.choice([1, 1, 2])):
        made = _edited(made, random)
    return made


def _edited(made, random):
    while True:
        edit = random.choice([*EDITS, None])
        if edit is None:
            return _other_domain(made, random)
        tree = edit(made.tree, random)
        if tree is not None:
            return Law(ast.unparse(ast.fix_missing_locations(tree)), made.domain)


def _other_domain(made, random):
    """Drop an assumption, or let it include its end."""
    n = random.randrange(len(made.domain)) if made.domain else 0
    if made.domain and random.random() < 0.3:
        weaker = made.domain[n].replace(" > ", " >= ")
        return Law(made.text, (*made.domain[:n], weaker, *made.domain[n + 1 :]))
    return Law(made.text, (*made.domain[:n], *made.domain[n + 1 :]))
