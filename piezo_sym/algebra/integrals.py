"""Integrals that SymPy finds: ``python -m piezo_sym.algebra.integrals`` is the process that looks.

Input: a smooth law and a name.  Output: a tree whose derivative is shown to be the law, or None.
The process ends itself after `SECONDS`, whatever SymPy does, and its memory is limited.  The limit
is processor time, so that other work on the machine does not decide which laws have an energy.
"""

import json
import os
import resource
import signal
import subprocess
import sys
from contextlib import suppress
from functools import lru_cache
from typing import Any

import sympy as sp

from piezo_sym.algebra.symbols import to_sympy
from piezo_sym.errors import PiezoError
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Expr, names
from piezo_sym.processes import search_path

#: Seconds of processor time for SymPy, seconds by the clock for the process, bytes of its memory.
SECONDS, WITH_START, MEMORY = 5, 60, 4 << 30
#: Functions that the law language lacks, which are rewritten with logarithms.
BY_LOGARITHMS = (sp.asinh, sp.acosh, sp.atanh, sp.asech, sp.acsch, sp.acoth)
HYPERBOLIC = sp.sinh, sp.cosh, sp.tanh


@lru_cache(256)
def integral(law: Expr, name: str, positive: frozenset[str]) -> Expr | None:
    """Return an integral of a smooth law for `positive` names > 0; None if none is found."""
    request = json.dumps([spell(law), name, sorted(positive)])
    command = (sys.executable, "-P", "-m", "piezo_sym.algebra.integrals")
    how: dict[str, Any] = {"capture_output": True, "text": True, "timeout": WITH_START}
    environment = {**os.environ, "PYTHONPATH": search_path()}
    with suppress(subprocess.SubprocessError, PiezoError):  # it took too long; laws lack a function
        done = subprocess.run(command, input=request, check=True, env=environment, **how)
        return parse_law(done.stdout.strip(), "an integral")
    return None


def vanishes(expr: sp.Expr) -> bool:
    """Return whether a smooth expression is shown to be zero wherever it has a value."""
    if sp.expand(expr) == 0:
        return True
    plain = expr.rewrite(sp.exp) if expr.has(*HYPERBOLIC) else expr
    return bool(sp.expand(sp.numer(sp.together(sp.expand(plain)))) == 0)


def _antiderivative(text: str, name: str, positive: list[str]) -> str | None:
    """Return the text of an integral whose derivative is shown to be the law, or None."""
    tree = parse_law(text, "law")
    known = {n: sp.Symbol(n, positive=n in positive or None, real=True) for n in names(tree)}
    law, x = to_sympy(tree, known), known[name]
    energy = _of_root(law, x) or sp.integrate(law, x, conds="none")
    if isinstance(energy, sp.Piecewise):  # the generic case; in the others a divisor is zero
        energy = energy.args[0][0]
    for function in BY_LOGARITHMS:
        energy = energy.replace(function, lambda arg, f=function: f(arg).rewrite(sp.log))
    if not vanishes(sp.diff(energy, x) - law):
        return None
    four = sp.Mul(4, sp.atan(1, evaluate=False), evaluate=False)  # laws lack pi
    return str(energy.xreplace({sp.pi: four}))


def _of_root(law: sp.Expr, x: sp.Symbol) -> sp.Expr | None:
    """Return an integral of a law whose roots are all of one s = a*x + b; None for other laws.

    The law is integrated over s > 0, where the roots are real: over x, whose sign is unknown, SymPy
    gives cases with abs(x) and the imaginary unit, which no law has.
    """
    powers = (p for p in law.atoms(sp.Pow) if p.exp.is_Rational and not p.exp.is_Integer)
    bases = {p.base for p in powers if p.base.has(x)} - {x}
    if len(bases) != 1:
        return None
    (base,) = bases
    slope, s = sp.diff(base, x), sp.Dummy("s", positive=True)
    if slope.has(x):
        return None
    moved = law.subs(x, (s - base.subs(x, 0)) / slope)
    return sp.integrate(moved / slope, s, conds="none").subs(s, base)


def main() -> None:
    """Answer the one request on stdin; the exit status tells whether there is an answer."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, resource.getrlimit(resource.RLIMIT_AS)[1]))
    request = json.load(sys.stdin)
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    answer = _antiderivative(*request)
    if answer is None:
        sys.exit(1)
    print(answer)  # noqa: T201 - the answer


if __name__ == "__main__":
    main()
