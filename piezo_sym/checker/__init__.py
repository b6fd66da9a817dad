"""The checker: a second program, which has only the spec's text in common with the package.

Run as ``python -I piezo_sym/checker SPEC.toml PROOFS.json``.
"""

from .laws import InputError
from .rigid import read_spec
from .spec import Spec

__all__ = ["InputError", "Spec", "read_spec"]
