"""The checker: a second program that shares nothing with the package but the spec's text.

Run as ``python -I piezo_sym/checker SPEC.toml PROOFS.json``.
"""

from .laws import InputError
from .rigid import read_spec
from .spec import Spec

__all__ = ["InputError", "Spec", "read_spec"]
