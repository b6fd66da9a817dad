"""diffrax: JAX, compiled by XLA, in double precision; Tsit5 with its step-size controller.

Input: a problem.  Output: `DIFFRAX`.  States are scaled, for all share one
absolute tolerance.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp

from piezo_sym.bench.problem import INSTANT, TIME
from tests.benchmarks.peers.peer import Peer, scaled

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from piezo_sym.bench.problem import Problem
    from tests.benchmarks.peers.peer import Rates, Solver

MOST_STEPS = 20_000_000


def field(problem: Problem, rates: Iterable[sp.Expr]) -> Callable[..., Any]:
    """Return rates as a JAX function of t and x."""
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    parts = sp.lambdify([TIME, list(problem.states)], list(rates), "jax", cse=True)
    return lambda t, x: jnp.stack(jnp.broadcast_arrays(*parts(t, x)))


def solver(problem: Problem) -> Solver:
    """Return Tsit5 over the whole run, compiled for all tolerances at once."""
    import diffrax
    import jax

    rates = field(problem, scaled(problem))
    term = diffrax.ODETerm(lambda t, z, _: rates(t, z))
    start = jax.numpy.asarray(problem.start / problem.scale)

    def run(tolerance: Any) -> Any:
        found = diffrax.diffeqsolve(
            term,
            diffrax.Tsit5(),
            0.0,
            problem.duration,
            None,
            start,
            saveat=diffrax.SaveAt(t1=True),
            stepsize_controller=diffrax.PIDController(rtol=tolerance, atol=tolerance),
            max_steps=MOST_STEPS,
            throw=False,
        )
        return jax.numpy.where(found.result == diffrax.RESULTS.successful, found.ys[-1], np.nan)

    compiled = jax.jit(run)
    return lambda tolerance: np.asarray(compiled(tolerance)) * problem.scale


def batch(problem: Problem) -> Rates:
    """Return the rates of many states, compiled for arrays."""
    import jax

    rates = field(problem, problem.rates)
    run = jax.jit(lambda x: rates(INSTANT, x))
    return lambda x: np.asarray(run(x))


DIFFRAX = Peer("diffrax Tsit5", "diffrax", solver, batch)
