"""The version of the package, which generated files name as their generator, and its sources."""

import hashlib
from pathlib import Path

VERSION = "0.1.0"
#: How a generated file begins.
MADE = f"Made by piezo_sym {VERSION}; do not edit: change the spec, then run `piezo-sym generate`."
PACKAGE = Path(__file__).parent
#: Endings of the package's sources, and other packages that proofs rest on.
SOURCES = (".py", ".c", ".h")
PROVERS = ("sympy", "z3-solver", "cvc5", "python-flint", "pint", "numpy")


def sources_hash() -> str:
    """Return the hash of the sources that there are now, and of the versions of its provers."""
    import sys
    from importlib.metadata import PackageNotFoundError, version

    digest = hashlib.sha256(f"{VERSION} {sys.version}".encode())
    for name in PROVERS:
        try:
            digest.update(f"{name} {version(name)}".encode())
        except PackageNotFoundError:  # it is not installed, or not under this name
            digest.update(name.encode())
    for path in sorted(PACKAGE.rglob("*.*")):
        compiled = path.suffix == ".pyc" and path.parent.name != "__pycache__"  # without a source
        if (compiled or path.suffix in SOURCES) and PACKAGE / "generated" not in path.parents:
            digest.update(f"{path.relative_to(PACKAGE)}\0".encode() + path.read_bytes())
    return digest.hexdigest()[:16]
