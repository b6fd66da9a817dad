"""`simulate`, `Stepper` and the searches for steady states, for specs instead of modules.

Input: the name of a shipped spec, a path or a `Model`, and the other arguments of a function of
generated modules.  Output: its result for the spec's module.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import update_wrapper
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeAlias, TypeVar

from piezo_sym.analysis import branches, steady
from piezo_sym.analysis import operating_point as rest
from piezo_sym.errors import UnknownNameError
from piezo_sym.modules import module_of
from piezo_sym.progress import progress_of
from piezo_sym.run import simulate as run
from piezo_sym.run.checks import checked_call
from piezo_sym.run.inputs import warn_given
from piezo_sym.run.simulate import stages_of
from piezo_sym.run.stepper import Stepper as Steps
from piezo_sym.spec.starts import warn_parted

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model

Spec: TypeAlias = "str | Path | Model"
P = ParamSpec("P")
R = TypeVar("R")


def of_spec(
    run: Callable[Concatenate[Any, P], R],
    stages: Callable[[Mapping[str, Any]], int | None] = lambda _: None,
) -> Callable[Concatenate[Spec, P], R]:
    """Return a function of a generated module as a function of a spec.

    `stages` returns the stages of its steps from its options, so that they are compiled ahead.
    """

    def call(model: Spec, *args: P.args, **given: P.kwargs) -> R:
        module = module_of(model, stages(given))
        warn_parted(model, module, given.get("initial"))
        warn_given(module, given.get("inputs"))
        try:
            return run(module, *args, **given)
        except UnknownNameError as error:
            if error.where.endswith(".initial"):
                _say_joined(error, model)
            raise

    wrapper: Any = update_wrapper(call, run, updated=())
    first, *others = signature(run).parameters.values()
    first = first.replace(name="model", annotation=Spec)
    made = signature(run).replace(parameters=[first, *others])
    if isinstance(run, type):  # it returns what it makes
        made = made.replace(return_annotation=run)
    wrapper.__signature__ = made
    return checked_call(wrapper, run.__name__)


def _say_joined(error: UnknownNameError, model: Spec) -> None:
    """Say of an initial state that is unknown, as its store is joined, which state there is."""
    from piezo_sym.derivation import derive
    from piezo_sym.spec.load import load

    iphs = derive(load(model) if isinstance(model, str | Path) else model)
    for joint in iphs.junction.joints:
        if error.name in {member.store.state for member in joint.followers}:
            error.remedy = f"it is joined: {', '.join(joint.state_texts())}"


operating_point = of_spec(rest.operating_point)
periodic_steady_state = of_spec(steady.periodic_steady_state)
periodic_steady_states = of_spec(steady.periodic_steady_states)
steady_branches = of_spec(branches.steady_branches)


def _with_bar(run: Callable[P, R]) -> Callable[P, R]:
    """Return `simulate` with a bar if `progress` is True, and none if it is False."""

    def call(*args: P.args, **given: P.kwargs) -> R:
        options: dict[str, Any] = given
        wanted = options.get("progress")
        wanted = False if wanted is None else wanted
        if callable(wanted):
            return run(*args, **given)
        last: Any = getattr(options.get("initial"), "time", None)
        length = options.get("duration")
        start = options.get("t0") or (float(last.max()) if getattr(last, "size", 0) else 0.0)
        total = length if isinstance(length, int | float) else 0.0  # the run refuses others
        with progress_of(wanted, total, "simulated [s]", "simulate.progress") as tell:
            watch = (lambda t: tell(t - start)) if wanted else None
            return run(*args, **{**options, "progress": watch})

    return update_wrapper(call, run)


simulate = of_spec(_with_bar(run), stages_of)

Stepper = of_spec(Steps, stages_of)
