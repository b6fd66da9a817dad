"""The version of the package, which generated files name as their generator, and its sources."""

import hashlib
import os
import stat
from contextlib import suppress
from functools import cache
from pathlib import Path

VERSION = "0.1.0"
#: How a generated file begins.
MADE = f"Made by piezo_sym {VERSION}; do not edit: change the spec, then run `piezo-sym generate`."
PACKAGE = Path(__file__).parent
#: Endings of the package's sources, and other packages that proofs rest on.
SOURCES = (".py", ".c", ".h")
PROVERS = ("sympy", "z3-solver", "cvc5", "python-flint", "pint", "numpy")


def _sources() -> dict[str, tuple[int, int, int]]:
    """Return the paths of all sources, each with what no edit leaves as it is."""
    found = {}
    for folder, folders, names in os.walk(PACKAGE):
        if folder == str(PACKAGE) and "generated" in folders:
            folders.remove("generated")
        for name in names:
            ending = os.path.splitext(name)[1]
            compiled = ending == ".pyc" and not folder.endswith("__pycache__")  # without a source
            if compiled or ending in SOURCES:
                path = os.path.join(folder, name)
                with suppress(OSError):  # an editor's lock is a link to nowhere
                    status = os.stat(path)
                    if stat.S_ISREG(status.st_mode):
                        found[path] = status.st_ctime_ns, status.st_size, status.st_ino
    return found


#: The sources when the package was imported; nothing else of it is imported before.
_BEGUN = _sources()


def unchanged() -> bool:
    """Return whether the sources are those that this process has imported, or will import."""
    return _sources() == _BEGUN


@cache
def own_sources() -> str:
    """Return the hash of the sources that this process runs; "" if they were changed meanwhile."""
    found = sources_hash()
    return found if unchanged() else ""


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
    for path in sorted(_sources()):
        with suppress(OSError):  # removed meanwhile
            digest.update(f"{os.path.relpath(path, PACKAGE)}\0".encode() + Path(path).read_bytes())
    return digest.hexdigest()[:16]
