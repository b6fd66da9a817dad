"""The version of the package, which generated files name as their generator, and its sources."""

import hashlib
import os
import stat
from contextlib import suppress
from functools import cache
from pathlib import Path

VERSION = "0.1.0"
#: The first line of a generated file, without comment marks.
MADE = f"Made by piezo_sym {VERSION}; do not edit: change the spec, then run `piezo-sym generate`."
PACKAGE = Path(__file__).parent
#: Endings of the package's sources, and the other packages on which proofs rest.
SOURCES = (".py", ".c", ".h")
PROVERS = ("sympy", "z3-solver", "cvc5", "python-flint", "pint", "numpy")


def _sources() -> dict[str, tuple[int, int, int]]:
    """Return the path of every source, with the file's attributes that any edit changes."""
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


#: The sources when the package was imported: this file is imported before all others.
_BEGUN = _sources()


def unchanged() -> bool:
    """Return whether no source has changed since this process imported the package."""
    return _sources() == _BEGUN


@cache
def own_sources() -> str:
    """Return the hash of the sources that this process runs; "" if they have changed since."""
    found = sources_hash()
    return found if unchanged() else ""


def sources_hash() -> str:
    """Return the hash of the present sources and of the versions of the provers."""
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
