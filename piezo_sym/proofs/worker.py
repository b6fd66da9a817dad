"""The process in which a solver runs: ``python -m piezo_sym.proofs.worker z3``.

Input: one request per line on stdin, ``{"text": ..., "order": [...]}``, a query in SMT-LIB.
Output: one answer per line on stdout, ``{"result": ..., "model": {...}, "reason": ...}``, the
result one of ``unsat``, ``sat``, ``unknown``.  A solver that hangs or crashes takes this process
with it, and nothing else.
"""

import json
import os
import signal
import sys
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

#: Limits on a query in the solver's own units of work, which give the same answer on every machine.
Z3_LIMIT = 20_000_000
SIMPLER_LIMIT = 300_000
CVC5_LIMIT = 2_000_000
#: Values that a person would try first.
SIMPLE = (
    *(Fraction(sign * n) for n in (1, 2) for sign in (1, -1)),
    Fraction(0),
    *(Fraction(sign * n) for n in (3, Fraction(1, 2), 4, 5, 10, 100) for sign in (1, -1)),
    *(Fraction(sign, 10) for sign in (1, -1)),
)

Answer = dict[str, Any]


def ask_z3(text: str, order: Sequence[str]) -> Answer:
    """Return z3's answer; a model has the names in `order`, each value as simple as possible."""
    import z3

    context = z3.Context()  # a new one: earlier queries cannot change an answer
    solver = z3.Solver(ctx=context)
    solver.set("rlimit", Z3_LIMIT)
    solver.from_string(text)
    result = str(solver.check())
    if result == "unknown":
        return {"result": result, "reason": f"z3: {solver.reason_unknown()}"}
    if result == "unsat":
        return {"result": result}
    model = solver.model()
    known = [z3.And(*solver.assertions())]  # one conjunction is solved faster
    for name in order:
        model = _simplify(z3, known, model, z3.Real(name, context))
    values = {name: _exact(z3, model, z3.Real(name, context)) for name in order}
    return {"result": "sat", "model": values}


def _simplify(z3: Any, known: list[Any], model: Any, symbol: Any) -> Any:
    """Fix one variable to the first simple value that still gives a model; return that model.

    Each value gets a new solver: incremental solving (push and pop) is slower by minutes.
    """
    own = model.evaluate(symbol, model_completion=True)
    for value in SIMPLE:
        if z3.is_rational_value(own) and own.as_fraction() == value:
            known.append(symbol == own)
            return model
        fixed = symbol == z3.Q(value.numerator, value.denominator, symbol.ctx)
        solver = z3.Solver(ctx=symbol.ctx)
        solver.set("rlimit", SIMPLER_LIMIT)
        solver.add(*known, fixed)
        if str(solver.check()) == "sat":
            known.append(fixed)
            return solver.model()
    return model


def _exact(z3: Any, model: Any, symbol: Any) -> str:
    value = model.evaluate(symbol, model_completion=True)
    if z3.is_algebraic_value(value):
        value = value.approx(20)
    return str(value.as_fraction())


def ask_cvc5(text: str, order: Sequence[str]) -> Answer:
    """Return cvc5's answer, without a model."""
    import cvc5

    del order
    solver = cvc5.Solver(cvc5.TermManager())
    solver.setOption("rlimit-per", str(CVC5_LIMIT))
    parser = cvc5.InputParser(solver)
    parser.setStringInput(cvc5.InputLanguage.SMT_LIB_2_6, f"(set-logic QF_NRA)\n{text}", "query")
    symbols = parser.getSymbolManager()
    while not (command := parser.nextCommand()).isNull():
        command.invoke(solver, symbols)
    result = str(solver.checkSat())
    kind = result if result in {"sat", "unsat"} else "unknown"
    return {"result": kind, "reason": "" if kind == result else f"cvc5: {result}"}


SOLVERS = {"z3": ask_z3, "cvc5": ask_cvc5}


def answered(name: str, line: str) -> str:
    """Return the answer line to a request line; an exception is answered as ``unknown``."""
    request = json.loads(line)
    try:
        answer = SOLVERS[name](request["text"], request["order"])
    except Exception as error:  # the claim is left open
        answer = {"result": "unknown", "reason": f"{name} failed: {type(error).__name__}"}
    return json.dumps(answer)


def main() -> None:
    """Answer requests until stdin ends; Ctrl-C is left to the parent process, which ends stdin."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    name = sys.argv[1]
    answered(name, '{"text": "", "order": []}')  # imports the solver before it is asked
    for line in sys.stdin:
        try:
            print(answered(name, line), flush=True)  # noqa: T201 - the answer
        except BrokenPipeError:  # the parent is gone: end without a traceback
            os._exit(0)


if __name__ == "__main__":
    main()
