"""The checker: a second program that shares nothing with the package but the spec's text.

Run as ``python -I piezo_sym/checker SPEC.toml PROOFS.json``.
"""

from .laws import InputError
from .spec import Spec, read_spec

__all__ = ["InputError", "Spec", "read_spec"]
