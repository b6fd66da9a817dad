"""One fault: an edit of one source file, made as the module is loaded; no file is changed.

Input: a `Mutant`, or many as text.  Output: a finder of modules that gives the edited one.  An edit
must fit exactly once, so that a stale mutant fails and says so.  As text a mutant is its name, the
lines replaced after ``-``, those that stand there then after ``+``, and a spec after ``=``; a file
stands after ``##``.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType
from typing import Any, final

PACKAGE = "piezo_sym"


@final
@dataclass(frozen=True)
class Mutant:
    """An edit, and a spec that shows the harm it does.

    Attributes
    ----------
    name : what is wrong, in a few words.
    file : below the package, without its ending: ``proofs/query``.
    old, new : the text replaced, and what stands there then.
    spec : the text of a spec.
    """

    name: str
    file: str
    old: str
    new: str
    spec: str

    @property
    def module(self) -> str:
        """The module that the file is."""
        return f"{PACKAGE}.{self.file.replace('/', '.')}".removesuffix(".__init__")

    def apply(self, source: str) -> str:
        """Return the edited source."""
        count = source.count(self.old)
        if count != 1 or self.old == self.new:
            raise StaleError(f"{self.name}: the text to replace is {count} times in {self.file}.py")
        return source.replace(self.old, self.new)


@final
class StaleError(Exception):
    """An edit does not fit the source any more."""


@final
class _Loader(SourceFileLoader):
    """Loads a module from its edited source."""

    def __init__(self, mutant: Mutant, path: str) -> None:
        super().__init__(mutant.module, path)
        self.mutant = mutant

    def get_code(self, fullname: str) -> CodeType:
        """Return the code of the edited source, which no cache knows."""
        del fullname
        text = self.get_data(self.path).decode("utf-8")
        return self.source_to_code(self.mutant.apply(text).encode("utf-8"), self.path)


@final
class _Finder:
    """Finds one module, and its edited source."""

    def __init__(self, mutant: Mutant) -> None:
        self.mutant = mutant

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        """Return where the edited module is loaded from; None for all others."""
        if name != self.mutant.module:
            return None
        found = PathFinder.find_spec(name, path, target)
        if found is None or found.origin is None:
            raise StaleError(f"{self.mutant.name}: there is no {name}")
        found.loader = _Loader(self.mutant, found.origin)
        return found


def install(mutant: Mutant) -> None:
    """Make an edit in this process; its module must not be imported yet."""
    if mutant.module in sys.modules:
        raise StaleError(f"{mutant.name}: {mutant.module} is imported already")
    if mutant.file.startswith(("checker/", "falsify/", "translation/")):
        raise StaleError(f"{mutant.name}: {mutant.file} is what should notice, not what is wrong")
    sys.meta_path.insert(0, _Finder(mutant))  # type: ignore[arg-type]


def mutants_of(text: str, spec_of: Callable[[str], str]) -> tuple[Mutant, ...]:
    """Return the mutants in a text; `spec_of` makes a spec of what is written of it."""
    found: list[Mutant] = []
    file, name, parts = "", "", dict[str, list[str]]()
    for line in [*text.strip("\n").splitlines(), "##"]:
        if line.startswith("  "):
            parts.setdefault(line[2], []).append(line[4:])
        elif line:
            if parts:
                old, new = ("\n".join(parts.get(sign, [])) for sign in "-+")
                found.append(Mutant(name, file, old, new, spec_of(" ".join(parts["="]))))
            parts = {}
            file, name = (line[3:], "") if line.startswith("##") else (file, line)
    return tuple(found)
