"""Right-hand sides written by hand for the paper's actuator, in NumPy and C.

Input: a `Problem`.  Output: `Hand`, or nothing where there is no compiler, or the problem is of
another model.
"""

from __future__ import annotations

import ctypes
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, final

import numpy as np

from piezo_sym import load
from piezo_sym.bench.contest import Contestant
from piezo_sym.bench.problem import SHIPPED
from piezo_sym.errors import EngineError
from piezo_sym.run.engine.compiler import FLAGS, build, compilers
from piezo_sym.run.engine.records import ParameterRecords
from tests.benchmarks import hand_written
from tests.benchmarks.ours import inputs_at_instant

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.checks import FloatArray

FOLDER = Path(__file__).parent
LANE_CALLS = 400_000  # lanes computed in one call of a loop


@final
@dataclass(frozen=True)
class Hand:
    """Rates written by hand, of one problem: NumPy, and libraries built from C."""

    problem: Problem
    module: ModuleType
    loop: ctypes.CDLL
    batch: ctypes.CDLL

    def numpy(self, x: Any) -> Any:
        """Return the rates of states x (n, *batch)."""
        u = inputs_at_instant(self.problem)
        return self.module.rhs(x, u.reshape(-1, *(1,) * (x.ndim - 1)))

    def c_loops(self, lanes: int) -> tuple[Contestant, Contestant]:
        """Return one state again and again in C, by hand and generated, and how far they differ."""
        hand, made = (self._loop(name, lanes) for name in ("by_hand", "generated"))
        calls = LANE_CALLS // (lanes + 10)
        found = [out() for _, out in (hand, made)]
        gap = float(np.max(np.abs(found[1] - found[0]) / np.maximum(np.abs(found[0]), 1.0)))
        note = f"distance to ours {gap:.0e}"
        first = Contestant(f"hand-written C, r = {lanes}", hand[0], calls, note=note)
        return first, Contestant(f"generated C, r = {lanes}", made[0], calls)

    def _loop(self, name: str, lanes: int) -> tuple[Callable[[], object], Callable[[], FloatArray]]:
        draw = np.random.default_rng(lanes)
        x = np.array([1e-3, 5e-3, 5e-4, *[2e-3] * lanes, 0.1]) * draw.uniform(-1, 1, 4 + lanes)
        x[-1] = 0.1
        call, out = self._caller(getattr(self.loop, f"loop_{name}"), x, lanes)
        size = ctypes.c_long(LANE_CALLS // (lanes + 10))

        def once() -> FloatArray:
            call(ctypes.c_long(1))
            return out

        return partial(call, size), once

    def c_batch(self, x: FloatArray, error: Callable[[Any], float]) -> Contestant:
        """Return the rates of many states x (n, columns), in blocks."""
        call, out = self._caller(self.batch.batch_by_hand, x, x.shape[0] - 4)
        columns = ctypes.c_long(x.shape[1])
        call(columns)
        return Contestant(
            "hand-written C, in blocks", partial(call, columns), x.shape[1], error(out)
        )

    def _caller(
        self, function: Any, x: FloatArray, lanes: int
    ) -> tuple[Callable[[Any], object], FloatArray]:
        """Return a call of a C function with a last argument, and where its rates go."""
        generated: Any = self.problem.module
        structure = ParameterRecords(generated)(generated.Parameters(hysteron_count=lanes))
        u, out = inputs_at_instant(self.problem), np.empty_like(x)

        def call(last: Any) -> object:
            at = [ctypes.c_void_p(array.ctypes.data) for array in (x, u, out)]
            function(at[0], at[1], ctypes.byref(structure.value), at[2], last)
            return None

        return call, out


def hand_of(problem: Problem) -> Hand | None:
    """Return what is written by hand for a problem, if there is anything."""
    if problem.model.sha256 != load(SHIPPED).sha256:
        return None
    try:
        loop, batch = _libraries(Path(str(problem.module.__file__)).parent)
    except EngineError:
        return None
    return Hand(problem, hand_written, loop, batch)


@lru_cache(maxsize=4)
def _libraries(generated: Path) -> tuple[ctypes.CDLL, ctypes.CDLL]:
    compiler = next(compilers(), None)
    if compiler is None:
        raise EngineError("there is no compiler")
    flags = [*FLAGS[0], f"-I{generated}", f"-I{FOLDER}"]
    with tempfile.TemporaryDirectory(prefix="piezo_sym-") as folder:
        paths = [Path(folder) / f"{name}.so" for name in ("loop", "batch")]
        for path in paths:
            build(compiler, flags, [FOLDER / f"{path.stem}.c"], path)
        loop, batch = (ctypes.CDLL(str(path)) for path in paths)
    return loop, batch
