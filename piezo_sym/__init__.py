"""piezo_sym: physical elements to a proved irreversible port-Hamiltonian system and fast modules.

    from piezo_sym import load, derive, verify, generate, simulate, sine

    model  = load("piezo_stack")                  # the paper's actuator, or a path
    iphs   = derive(model)                        # .x .u .U .S .E .J0 .processes .g .y .rhs .sigma
    report = verify(iphs)                         # .rows, .raise_if_not_proved()
    paths  = generate(model, out="generated")
    ds     = simulate("piezo_stack", inputs={"V_in": sine(100, 100)}, duration=0.1)

Every name is loaded when it is first used: importing the package imports none of SymPy, pydantic,
pint, z3, xarray, matplotlib.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from piezo_sym.version import VERSION as __version__

if TYPE_CHECKING:  # "as" makes them public for type checkers
    from piezo_sym.analysis.dashboard import plot as plot
    from piezo_sym.api import Stepper as Stepper
    from piezo_sym.api import operating_point as operating_point
    from piezo_sym.api import periodic_steady_state as periodic_steady_state
    from piezo_sym.api import periodic_steady_states as periodic_steady_states
    from piezo_sym.api import simulate as simulate
    from piezo_sym.api import steady_branches as steady_branches
    from piezo_sym.build import generate as generate
    from piezo_sym.derivation import derive as derive
    from piezo_sym.errors import EngineError as EngineError
    from piezo_sym.errors import FileError as FileError
    from piezo_sym.errors import NetworkError as NetworkError
    from piezo_sym.errors import PiezoError as PiezoError
    from piezo_sym.errors import ProofError as ProofError
    from piezo_sym.errors import RunError as RunError
    from piezo_sym.errors import SpecError as SpecError
    from piezo_sym.errors import UsageError as UsageError
    from piezo_sym.linearization import linearize as linearize
    from piezo_sym.run import chirp as chirp
    from piezo_sym.run import ramp as ramp
    from piezo_sym.run import samples as samples
    from piezo_sym.run import samples_from_csv as samples_from_csv
    from piezo_sym.run import sine as sine
    from piezo_sym.run import square as square
    from piezo_sym.run import step as step
    from piezo_sym.run import triangle as triangle
    from piezo_sym.spec.layered import layered as layered
    from piezo_sym.spec.load import load as load
    from piezo_sym.spec.model import Model as Model
    from piezo_sym.sweeps import sweep as sweep
    from piezo_sym.verification import verify as verify

_STEADY = ("operating_point", "periodic_steady_state", "periodic_steady_states", "steady_branches")
_ERRORS = ("EngineError", "FileError", "NetworkError", "ProofError", "RunError", "SpecError")
#: Where the public names are.
_NAMES: dict[str, tuple[str, ...]] = {
    "analysis.dashboard": ("plot",),
    "api": ("Stepper", "simulate", *_STEADY),
    "build": ("generate",),
    "derivation": ("derive",),
    "errors": ("PiezoError", "UsageError", *_ERRORS),
    "linearization": ("linearize",),
    "run": ("chirp", "ramp", "samples", "samples_from_csv", "sine", "square", "step", "triangle"),
    "spec.layered": ("layered",),
    "spec.load": ("load",),
    "spec.model": ("Model",),
    "sweeps": ("sweep",),
    "verification": ("verify",),
}
_HOME = {name: home for home, names in _NAMES.items() for name in names}

__all__ = ["__version__", *sorted(_HOME)]


def __getattr__(name: str) -> Any:
    """Load a public name from its home when it is first used."""
    if name not in _HOME:
        message = f"module 'piezo_sym' has no attribute '{name}'"
        raise AttributeError(message)
    value = getattr(importlib.import_module(f"piezo_sym.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
