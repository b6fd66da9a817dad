"""Runs mutants: ``python -m tests.mutants.driver [--every N] [--only NAME] [LIST ...]``.

Input: mutants, each one edit of one source file and a spec that shows the harm it does.  Output: a
line each: what it wrongly proves or derives, and which of the net, the checker and the row
`program` notice.  Every mutant runs in a process of its own, forked before its module is imported;
the checker runs in another, which has imported nothing of the package.
"""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Iterator, Sequence
from typing import Any

from tests.mutants.mutant import Mutant
from tests.mutants.outcome import outcome
from tests.mutants.runs import checked, decided, forked, mutated
from tests.mutants.specs import spec_of

LISTS = ("encoder", "claims", "intervals", "network")
HEAVY = (
    *("sympy", "z3", "cvc5", "numpy", "scipy.special", "flint", "pydantic", "pint", "tomli_w"),
    *("sympy.polys.fields", "sympy.polys.matrices", "sympy.printing.latex", "tomllib", "zoneinfo"),
)
#: What is imported before the forks: nothing that mutants are in, or that needs it.
FIRST = ("spec.load", "spec.circuit", "algebra.symbols", "algebra.lanes")
MORE = ("derivation", "falsify", "codegen")


def main(arguments: list[str]) -> None:
    """Print the outcome of each mutant of some lists."""
    options = argparse.ArgumentParser()
    options.add_argument("lists", nargs="*", default=LISTS)
    options.add_argument("--every", type=int, default=1)
    options.add_argument("--only", default="")
    options.add_argument("--why", action="store_true")
    given = options.parse_args(arguments)
    for module in HEAVY:
        importlib.import_module(module)
    for name in given.lists:
        mutants = importlib.import_module(f"tests.mutants.{name}").MUTANTS
        picked = chosen(mutants, given.every, given.only)
        for mutant, was, now in _said(name, picked):
            print(f"{name} | {outcome(mutant, was, now)}", flush=True)
            if given.why:
                _print(was, now)


def chosen(mutants: Sequence[Mutant], every: int, only: str) -> list[Mutant]:
    """Return one mutant of each `every`, if its name has `only` in it."""
    return [mutant for mutant in mutants[::every] if only in mutant.name]


def _said(name: str, mutants: list[Mutant]) -> Iterator[tuple[Mutant, Any, Any]]:
    """Yield each mutant with what is said of its spec, without it and with it."""
    specs = list(dict.fromkeys(mutant.spec for mutant in mutants))
    before, after = forked(_in_package, name, specs, mutants, seconds=3600)
    known = dict(zip(specs, before, strict=True))
    for mutant, now in zip(mutants, after, strict=True):
        if "crash" not in now:
            now["checked"] = forked(checked, mutant.spec, now["proofs"])
        yield mutant, known[mutant.spec], now


def _in_package(name: str, specs: list[str], mutants: list[Mutant]) -> tuple[list[Any], list[Any]]:
    """Return what the package says of specs, and what each mutant says of its own."""
    _warm(name)
    before = [forked(decided, text) for text in specs]
    return before, [forked(mutated, mutant.spec, mutant) for mutant in mutants]


def _warm(name: str) -> None:
    """Import and use once what no mutant of a list is in: forks then start with it."""
    for module in (*FIRST, *(MORE if name != "network" else ())):
        importlib.import_module(f"piezo_sym.{module}")
    model = sys.modules["piezo_sym.spec.load"].parse(spec_of("d*v*tanh(v/v_1)**2 | d > 0"))
    if name != "network":
        sys.modules["piezo_sym.derivation"].derive(model)


def _print(was: Any, now: Any) -> None:
    for key in {**was["rows"], **now.get("rows", {})}:
        print("   ", *key, was["rows"].get(key), "->", now.get("rows", {}).get(key))
    for key, found in (("net", now.get("net")), *now.get("checked", {}).get("refused", {}).items()):
        print("   ", key, ":", found)


if __name__ == "__main__":
    main(sys.argv[1:])
