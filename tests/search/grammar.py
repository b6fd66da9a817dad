"""Laws drawn at random, with what is known of them by construction.

Input: a random source and the names of a spec by what its domain says of them.  Output: `Drawn`:
text, and whether it has a value everywhere, jumps nowhere, and has its letter's sign; None where
that is not known.
"""

from dataclasses import dataclass, replace
from fractions import Fraction
from random import Random

from tests.search.forms import (
    FALSE,
    GUARDS,
    JUMPING,
    LACKING,
    LEAST,
    ODD,
    PARTIAL,
    PARTIAL_LEAST,
    PASSIVE,
    VALUES,
)
from tests.search.laws import ZERO, changed, paths, read, text

SWAPS = {"<": ">", ">": "<", "<=": "<", ">=": ">", "min": "max", "max": "min", "exp": "tanh"}
SWAPS |= {"tanh": "sin", "sqrt": "abs", "abs": "sign", "saturate": "deadzone", "+": "-", "-": "+"}
SMALL = ("0.5", "2", "1", "3", "0.1", "0.01", "1e-6")


@dataclass(frozen=True)
class Drawn:
    """A law's text and what is known of it."""

    text: str
    defined: bool | None = True
    continuous: bool | None = True
    passive: bool | None = None


@dataclass
class Grammar:
    """Draws laws.

    Attributes
    ----------
    letter : the law's letter, or empty for a law of parameters alone.
    above, least, any : names that the domain has > 0, >= 0, and of unknown sign.
    hot : ``T``, if the law may use it.
    """

    random: Random
    letter: str
    above: list
    least: list
    any: list
    hot: str = "T"

    def one(self, *items):
        """Return one of some things."""
        return self.random.choice(items)

    def chance(self, part):
        """Return whether a thing happens that happens in a part of all cases."""
        return self.random.random() < part

    def name(self):
        """Return a name."""
        return self.one(*self.above, *self.least, *self.any, *self.any)

    def leaf(self):
        """Return a value without parts."""
        z = [self.letter, self.letter, f"{self.letter}/{self.one(*self.above)}"]
        heat = [f"{self.hot}/{self.one(*self.above)}"] if self.hot and self.chance(0.3) else []
        return Drawn(self.one(*(z if self.letter else []), self.name(), self.one(*SMALL), *heat))

    def value(self, depth):
        """Return anything that has a value everywhere."""
        if depth <= 0:
            return self.leaf()
        a, b = self.value(depth - 1), self.value(self.random.randrange(depth))
        p, w = self.one(*self.above), self.one(*self.above, *self.least)
        form = self.one(*VALUES)
        if form == "guarded":
            return self.guarded(depth)
        made = form.format(a=f"({a.text})", b=f"({b.text})", p=p, w=w, k=self.one(*SMALL))
        bends = "sign" not in form or None
        return known(made, a, *([b] if "{b}" in form else []), continuous=bends)

    def guarded(self, depth, least=False):
        """Return a choice whose one side is partial, taken where it has a value."""
        x = self.guard(depth)
        p, k = self.one(*self.above), self.one(*SMALL)
        forms = PARTIAL_LEAST if least else PARTIAL
        if self.chance(0.25):  # a choice whose own condition is partial
            one, two = self.side(depth, least), self.side(depth, least)
            partial = self.one(*PARTIAL).format(x=f"({x})", p=p, k=k)
            inside = f"({one.text} if {partial} > {k} else {two.text})"
        else:
            inside = self.one(*forms).format(x=f"({x})", p=p, k=k)
            one = two = Drawn("")
        other = self.side(depth, least)
        made = self.one(*GUARDS).format(x=x, inside=inside, other=other.text, p=p)
        return known(made, one, two, other, continuous=None if self.moves(x) else True)

    def moves(self, made):
        """Return whether a text has the letter or the temperature in it."""
        return bool({self.letter, self.hot} & set(words(made)))

    def guard(self, depth):
        """Return what is compared with zero: of parameters alone more often than not."""
        a, b = self.one(*self.any), self.name()
        if self.letter and self.chance(0.3):
            z = self.letter
            return self.one(z, f"{z} - {a}", f"{z}**2 - {b}", f"{z}*{a}", f"{self.hot or z} - {b}")
        if depth > 1 and self.chance(0.2):
            return self.least_of(1).text.join(("", f" - {b}"))
        return self.one(a, a, f"{a} - {b}", f"{a}*{b}", f"{a} + {b}", f"{a}**2 - {b}", f"-{a}")

    def side(self, depth, least):
        """Return the other side of a choice."""
        if self.chance(0.6):
            return Drawn(self.one(*SMALL, *self.above, *self.least))
        return self.least_of(depth - 1) if least else self.value(depth - 1)

    def least_of(self, depth):
        """Return something that is >= 0 everywhere."""
        if depth <= 0:
            return Drawn(self.one(*self.above, *self.least, *SMALL))
        form = self.one(*LEAST)
        if form == "guarded":
            return self.guarded(depth, least=True)
        a, g = self.value(depth - 1), self.least_of(depth - 1)
        made = form.format(a=f"({a.text})", g=f"({g.text})", p=self.one(*self.above))
        return known(made, *([a] if "{a}" in form else []), *([g] if "{g}" in form else []))

    def passive(self, depth):
        """Return a law that has its letter's sign."""
        z, p = self.letter, self.one(*self.above)
        w = self.one(*self.above, *self.least)
        if depth <= 0:
            form = self.one(*ODD)
            return Drawn(form.format(z=z, p=p, w=w), passive=True)
        a, g = self.passive(depth - 1), self.least_of(depth)
        b = self.passive(self.random.randrange(depth))
        form = self.one(*PASSIVE)
        guard, jumps = "", True
        if "{c}" in form:
            guard = f"{self.guard(depth)} {self.one('>', '>=', '<', '<=')} 0"
            jumps = None if self.moves(guard) else True
        if form == "{a} if {c} else {b}":  # a choice of parameters alone is no jump
            made = f"({a.text}) if {guard} else ({b.text})"
            return known(made, a, b, continuous=jumps, passive=True)
        if "{h}" in form:
            w = replace(self, letter="", hot="").least_of(1).text
        made = form.format(
            a=f"({a.text})", b=f"({b.text})", g=f"({g.text})", h=w, p=p, w=w, c=guard
        )
        parts = [x for x, mark in ((a, "{a}"), (b, "{b}"), (g, "{g}")) if mark in form]
        return known(made, *parts, continuous=None if "sign" in form else jumps, passive=True)

    def strict(self):
        """Return a law that has its letter's sign and is zero with it alone."""
        z, p = self.letter, self.one(*self.above)
        return self.one(f"{p}*{z}", f"{z}**3", f"tanh({z}/{p})", f"{z}*(1 + {z}**2)", f"{z}")

    def false(self, depth):
        """Return a law that breaks its letter's sign, mostly on a thin set."""
        z, p, a = self.letter, self.one(*self.above), self.one(*self.any)
        k = self.one("1e-2", "1e-4", "1e-6", "0.5", "1")
        s, b = self.strict(), self.passive(depth)
        form, g = self.one(*FALSE), self.value(depth - 1)
        made = form.format(z=z, p=p, a=a, k=k, s=f"({s})", b=f"({b.text})", g=f"({g.text})")
        parts = [x for x, mark in ((b, "{b}"), (g, "{g}")) if mark in form]
        found = known(made, *parts, passive=False)
        jumps = "sign" in form or any(map(self.moves, made.split(" if ")[1:]))
        return replace(found, continuous=None) if jumps else found

    def partial(self, depth):
        """Return a law that has the right sign but lacks a value somewhere."""
        z, p, a = self.letter, self.one(*self.above), self.one(*self.any)
        form = self.one(*LACKING)
        return Drawn(form.format(z=z, p=p, a=a, g=self.least_of(depth).text), False, None, None)

    def jumping(self):
        """Return a law that jumps."""
        z, p, a = self.letter, self.one(*self.above), self.one(*self.any)
        return Drawn(self.one(*JUMPING).format(z=z, p=p, a=a), True, False, None)

    def mutant(self, depth):
        """Return a law with its letter's sign, changed in one or two places."""
        tree = read(self.passive(depth).text)
        for _ in range(self.one(1, 1, 2)):
            tree = self._edited(tree)
        return Drawn(text(tree), None, None, None)

    def _edited(self, tree):
        path, part = self.one(*paths(tree))
        name = ("name", self.one(self.letter, self.name()))
        if part[0] in {"num", "name"}:
            new = self.one(name, ("neg", part), ("*", ("num", Fraction(2)), part), ("neg", name))
        elif part[0] == "if":
            new = self.one(("if", part[3], part[2], part[1]), part[1], part[3])
        elif part[0] == "**":
            new = self.one(part[1], ("**", part[1], Fraction(3)), ("**", part[1], Fraction(1, 2)))
        else:
            new = (SWAPS.get(part[0], part[0]), *part[1:])
            if part[0] not in {"<", "<=", ">", ">="}:
                new = self.one(new, new, ("neg", part), part[1])
            elif self.chance(0.3):
                new = (part[0], part[1], ZERO)
        return changed(tree, path, new)

    def law(self, depth):
        """Return a law of any sort."""
        draw = self.random.random()
        for part, make in (
            (0.42, self.passive),
            (0.62, self.false),
            (0.70, self.partial),
            (0.75, lambda _: self.jumping()),
            (0.90, self.mutant),
        ):
            if draw < part:
                return make(depth)
        return self.value(depth)


def words(made):
    """Return the names of a text."""
    return [w for w in "".join(c if c.isalnum() or c == "_" else " " for c in made).split()]


def known(made, *parts, continuous=True, passive=None):
    """Return a law with what is known of all its parts."""
    defined = all(part.defined for part in parts) or None
    smooth = all(part.continuous for part in parts) or None
    return Drawn(made, defined, smooth and continuous, passive)
