"""A model with its inputs as an initial value problem, and its usual solution with SciPy.

Input: a `Model` and its inputs.  Output: a `Problem`

    dx/dt = f(t, x),  x(0) given

in SymPy, with banks expanded into their lanes, and the values of parameters and inputs substituted;
and its solution without this package: lambdified, integrated by SciPy's solve_ivp.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from math import pi
from typing import Any, final

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from piezo_sym.derivation import derive
from piezo_sym.errors import UsageError, quote
from piezo_sym.modules import module_of
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.inputs import InputValue, read_inputs
from piezo_sym.run.module import GeneratedModule, lanes
from piezo_sym.run.parameters import read_initial, read_parameters
from piezo_sym.run.signals import Constant, Signal, Sine
from piezo_sym.run.system import DrivenModule
from piezo_sym.spec.load import load
from piezo_sym.spec.model import Model

TIME = sp.Symbol("t", real=True)
#: Time [s] at which the rates of many states are compared.
INSTANT = 1.25e-3
#: The shipped actuator, and its input where none is given: without a voltage it stays at rest.
SHIPPED, DRIVEN = "piezo_stack", {"V_in": Sine(100.0, 100.0, 0.0, 0.0)}


@final
@dataclass(frozen=True)
class Problem:
    """A model with its inputs and the length of a run."""

    model: Model
    module: GeneratedModule
    inputs: Mapping[str, InputValue]
    duration: float  # [s]
    counts: Mapping[str, int]  # sizes of banks that differ from the spec, as parameters
    states: tuple[sp.Symbol, ...]
    rates: tuple[sp.Expr, ...]  # dx/dt as functions of `TIME` and x
    start: FloatArray  # x(0) (n,)
    scale: FloatArray  # the unit of each state's error (n,)

    @cached_property
    def system(self) -> DrivenModule:
        """The module with its parameters and inputs, as a run takes it."""
        inputs = read_inputs(self.module, self.inputs, self.duration)
        return DrivenModule(self.module, read_parameters(self.module, self.counts), inputs)

    @cached_property
    def at_instant(self) -> tuple[sp.Expr, ...]:
        """The rates at `INSTANT`."""
        return tuple(rate.xreplace({TIME: sp.Float(INSTANT)}) for rate in self.rates)

    def error(self, x: FloatArray, exact: FloatArray) -> float:
        """Return the largest error of a state in units of its scale; infinite where not finite."""
        worst = float(np.max(np.abs(np.asarray(x) - exact) / self.scale))
        return worst if np.isfinite(worst) else np.inf


def problem_of(
    model: Model,
    inputs: Mapping[str, InputValue],
    duration: float,
    sizes: Mapping[str, int] | None = None,
) -> Problem:
    """Return a model as a problem with scale 1; `sizes` are those of banks, else as in the spec."""
    shipped = not inputs and model.sha256 == load(SHIPPED).sha256
    given: Mapping[str, InputValue] = DRIVEN if shipped else inputs
    counts = {f"{bank}_count": size for bank, size in (sizes or {}).items()}
    module: Any = module_of(model)
    values = read_parameters(module, counts)
    signals = read_inputs(module, given, duration)
    start = read_initial(module, values, signals.segments[0].at(0.0), None)
    banks = {bank: lanes(values, bank) for bank in module.BANKS}
    names = [record.name for record in module.INPUTS]
    states, rates = explicit(model, dict(zip(names, signals.signals, strict=True)), banks)
    ones = np.ones(start.size)
    return Problem(model, module, given, duration, counts, states, rates, start, ones)


def explicit(
    model: Model, signals: Mapping[str, Signal], sizes: Mapping[str, int], free: str = ""
) -> tuple[tuple[sp.Symbol, ...], tuple[sp.Expr, ...]]:
    """Return the states and their rates, with the values of parameters and inputs substituted.

    The parameter `free` stays a symbol, with its own name.
    """
    iphs = derive(model).expand(sizes)
    known = {iphs.symbols[n]: sp.Float(p.si) for n, p in iphs.model.parameters.items() if n != free}
    known |= {iphs.symbols[free]: sp.Symbol(free, real=True)} if free else {}
    known |= {iphs.symbols[n]: as_expression(s, n) for n, s in signals.items()}
    return tuple(iphs.x), tuple(rate.xreplace(known) for rate in iphs.rhs)


def as_expression(signal: Signal, name: str) -> sp.Expr:
    """Return a constant or a sine as an expression of `TIME`."""
    match signal:
        case Constant(value):
            return sp.Float(value)
        case Sine(amplitude, frequency, offset, phase):
            angle = sp.Float(2 * pi * frequency) * TIME + sp.Float(phase)
            return sp.Float(amplitude) * sp.sin(angle) + sp.Float(offset)
    what = f"input {quote(name)} is neither"
    raise UsageError(what, "bench", "a number or sine(amplitude, frequency)")


def field(problem: Problem, modules: str = "numpy", cse: bool = False) -> Callable[..., Any]:
    """Return dx/dt as a function of t and x, lambdified."""
    arguments, rates = [TIME, list(problem.states)], list(problem.rates)
    function: Callable[..., Any] = sp.lambdify(arguments, rates, modules, cse=cse)
    return function


def solver(method: str, modules: str, cse: bool, problem: Problem) -> Callable[[float], FloatArray]:
    """Return solve_ivp over the run as a function of rtol, its error bound rtol (|x| + scale)."""
    return partial(integrated, field(problem, modules, cse), problem, method)


def integrated(rates: Callable[..., Any], problem: Problem, method: Any, rtol: float) -> FloatArray:
    """Return the state at the end, by solve_ivp; raise `RuntimeError` if it fails."""
    end, how = problem.duration, {"method": method, "rtol": rtol, "atol": rtol * problem.scale}
    solution = solve_ivp(rates, (0.0, end), problem.start, t_eval=(end,), **how)
    if not solution.success:
        raise RuntimeError(solution.message)
    state: FloatArray = solution.y[:, -1]
    return state


def batch(problem: Problem) -> Callable[[FloatArray], FloatArray]:
    """Return the rates of many states at once, as an array (n, columns)."""
    rates = sp.lambdify([list(problem.states)], list(problem.at_instant), "numpy")

    def rates_of(x: FloatArray) -> FloatArray:
        out = np.empty_like(x)
        with np.errstate(all="ignore"):  # select computes every branch
            for row, rate in zip(out, rates(x), strict=True):
                row[:] = rate
        return out

    return rates_of
