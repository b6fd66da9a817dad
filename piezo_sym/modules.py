"""Spec to a loaded module: from ``generated/``, from the installed package, or from the cache.

Input: a shipped name, a path, or a `Model`.  Output: its generated module, loaded.  A module found
for a name or path must be of that very spec; if not, the command that regenerates it is named.
What is not found is generated into the user's cache, keyed by spec and generator.
"""

from __future__ import annotations

import hashlib
import importlib.util
import sys
from collections.abc import Iterator
from contextlib import suppress
from functools import cache, lru_cache
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from piezo_sym.errors import DriftError, FileError, UsageError, quote
from piezo_sym.files import path_text, read_text, temporary_folder, write_together
from piezo_sym.spec.source import data, find, read, shipped
from piezo_sym.spec.write import spec_hash
from piezo_sym.version import VERSION

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model

PACKAGE = Path(__file__).parent


def module_of(spec: str | Path | Model) -> ModuleType:
    """Return the generated module of a spec.

    Parameters
    ----------
    spec : the name of a shipped spec, the path of a spec file, or a `Model`.

    Raises
    ------
    DriftError
        If ``generated/`` holds a module of another version of a named spec.
    FileError, SpecError, NetworkError, ProofError
        If the spec cannot be read, derived or proved.
    UsageError
        If `spec` is none of these.
    """
    if not isinstance(spec, str | Path):
        refuse_no_model(spec)
        ready = _ready(spec.name, spec.sha256)
        return ready if ready else _cached(spec)
    path = find(spec)
    content = data(read(path))
    header = content.get("model")
    name = header.get("name") if isinstance(header, dict) else None
    if isinstance(name, str) and name.isidentifier():
        present = tuple(_present(name))
        for module in present:
            if _is_of(module, path, content):
                return module
        if present:
            again = str(spec) if str(spec) in shipped() else str(path)
            what = "was generated from another version of its spec"
            remedy = f"run `piezo-sym generate {again}`, or give the model another name"
            raise DriftError(what, path_text(str(present[0].__file__)), remedy=remedy)
    from piezo_sym.spec.load import load

    return _cached(load(spec))


def refuse_no_model(spec: object) -> None:
    """Raise `UsageError` if this is no `Model`; whoever has one has loaded its type."""
    from piezo_sym.spec.model import Model

    if not isinstance(spec, Model):
        expected = "the name of a shipped spec, the path of a spec file, or a Model"
        raise UsageError(f"{quote(spec)} is no model", "model", expected)


def _is_of(module: ModuleType, path: Path, content: dict[str, object]) -> bool:
    """Return whether a module is of a spec; the spec's types are loaded only in doubt."""
    if spec_hash_of(content) == module.SPEC_SHA256:
        return True
    from piezo_sym.spec.load import load

    return bool(load(path).sha256 == module.SPEC_SHA256)


def spec_hash_of(content: dict[str, object]) -> str:
    """Return the hash of plain spec data, or nothing if it is not even of a spec's shape."""
    tables = all(isinstance(table, dict) for table in content.values())
    return spec_hash(content) if tables else ""


def _places(name: str) -> Iterator[Path]:
    """Yield where a generated module may be: the working folder, a checkout, the package."""
    for folder in (Path("generated"), PACKAGE.parent / "generated", PACKAGE / "generated"):
        yield folder / name / f"{name}.py"


def _present(name: str) -> Iterator[ModuleType]:
    for path in _places(name):
        if path.is_file():
            yield load_module(path)


def _ready(name: str, sha256: str) -> ModuleType | None:
    """Return a present module of exactly this spec."""
    return next((m for m in _present(name) if sha256 == m.SPEC_SHA256), None)


def _cached(model: Model) -> ModuleType:
    """Return the module from the user's cache, generating it if it is not there."""
    import platformdirs

    folder = Path(platformdirs.user_cache_dir("piezo_sym")) / "modules"
    path = folder / f"{model.sha256}-{_generator()}" / f"{model.name}.py"
    with suppress(FileError):  # what cannot be read or loaded is made again
        if read_text(path) is not None:
            return load_module(path)
    from piezo_sym.build import render

    files = {Path(name).name: text.encode() for name, text in render(model).items()}
    try:
        write_together({path.parent / name: text for name, text in files.items()})
        return load_module(path)
    except FileError:  # a read-only cache: the module and its C live as long as the process
        other = temporary_folder() / path.parent.name
        write_together({other / name: text for name, text in files.items()})
        return load_module(other / path.name)


@cache
def _generator() -> str:
    """Return the hash of the package's own sources: another generator, another cached module."""
    found = hashlib.sha256(VERSION.encode())
    for path in sorted(PACKAGE.rglob("*.py")):
        if PACKAGE / "generated" not in path.parents:
            found.update(path.read_bytes())
    return found.hexdigest()[:16]


def load_module(path: Path) -> ModuleType:
    """Return the module in a file, loaded again when the file has changed.

    Raises
    ------
    FileError
        If the file is no generated module.
    """
    return _loaded(path.resolve(), read_text(path))


@lru_cache(maxsize=64)
def _loaded(path: Path, text: str | None) -> ModuleType:
    del text  # it tells one content of the file from another
    name = f"piezo_sym_generated_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise FileError("is no Python module", path_text(path))
    module = importlib.util.module_from_spec(spec)
    before = sys.dont_write_bytecode
    sys.dont_write_bytecode = True  # a generated folder holds nothing but what is committed
    try:
        spec.loader.exec_module(module)
    except (SyntaxError, ImportError, NameError) as error:
        remedy = "regenerate it with `piezo-sym generate`"
        raise FileError("cannot be loaded", path_text(path), remedy=remedy) from error
    finally:
        sys.dont_write_bytecode = before
    if not hasattr(module, "SPEC_SHA256"):
        raise FileError("is no generated module", path_text(path), remedy="move it elsewhere")
    return module
