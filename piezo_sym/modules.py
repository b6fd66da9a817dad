"""Spec to a loaded module: the package's own, or one generated into the user's cache.

Input: a shipped name, a path, or a `Model`.  Output: its generated module, loaded.  What lies in
``generated/`` of the working folder is compared with it and never executed; where it differs, a
`ModuleWarning` says so.
"""

from __future__ import annotations

import filecmp
import hashlib
import importlib.util
import sys
import warnings
from collections.abc import Mapping
from contextlib import suppress
from functools import cache, lru_cache
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from piezo_sym.errors import FileError, ProofError, UsageError, quote
from piezo_sym.files import path_text, read_text, temporary_folder, write_together
from piezo_sym.run.module import UNPROVED, verdict_of
from piezo_sym.spec.names import MAX_NAME
from piezo_sym.spec.source import data, find, read, shipped
from piezo_sym.spec.write import spec_hash
from piezo_sym.version import VERSION

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model

PACKAGE = Path(__file__).parent
GENERATED = Path("generated")  # of the working folder
ALL_THE_SAME = "-unproved"  # of a module that was generated without being proved


class ModuleWarning(UserWarning):
    """A generated module in the working folder that is not used, or one that is not proved."""


def module_of(spec: str | Path | Model) -> ModuleType:
    """Return the generated module of a spec, derived and proved if it is not known yet.

    Parameters
    ----------
    spec : the name of a shipped spec, the path of a spec file, or a `Model`.

    Raises
    ------
    FileError, SpecError, NetworkError, ProofError
        If the spec cannot be read, derived or proved; one that is not proved runs if it was
        generated all the same, by `generate --allow-unproved`, in the working folder.
    UsageError
        If `spec` is none of these.
    """
    name, sha256, model = _identified(spec)
    module = _known(name, sha256)
    if module is None:
        from piezo_sym.spec.load import load

        model = model or load(spec)  # type: ignore[arg-type]  # a Model is known already
        module = _known(model.name, model.sha256) or _generated(model)
    verdict = verdict_of(module)
    if verdict.startswith(UNPROVED):
        text = f"model '{module.NAME}' is {verdict}: its runs may break a law of thermodynamics"
        warnings.warn(text, ModuleWarning, stacklevel=3)
    elif not _is_current(module):
        path, again = path_text(GENERATED / module.NAME), _command(spec)
        text = (
            f"{path} is not what the spec generates and is not used; replace it by `{again}`, "
            "or give the spec another name"
        )
        warnings.warn(text, ModuleWarning, stacklevel=3)
    return module


def _identified(spec: str | Path | Model) -> tuple[str, str, Model | None]:
    """Return the name and the hash of a spec; the spec's types are loaded only in doubt."""
    if not isinstance(spec, str | Path):
        from piezo_sym.spec.model import Model  # whoever has one has loaded its type

        if not isinstance(spec, Model):
            expected = "the name of a shipped spec, the path of a spec file, or a Model"
            raise UsageError(f"{quote(spec)} is no model", "model", expected)
        return spec.name, spec.sha256, spec
    content = data(read(find(spec)))
    if {"components", "banks"} & content.keys():  # as they are written out
        from piezo_sym.spec.load import load

        return _identified(load(spec))
    header = content.get("model")
    name = header.get("name") if isinstance(header, dict) else None
    known = isinstance(name, str) and name.isidentifier() and len(name) <= MAX_NAME
    tables = all(isinstance(table, dict) for table in content.values())  # of a spec's shape
    return (str(name) if known else ""), spec_hash(content) if tables else "", None


def _command(spec: str | Path | Model) -> str:
    """Return what generates a spec's module in the working folder."""
    if not isinstance(spec, str | Path):
        return f"piezo_sym.generate(model) for '{spec.name}'"
    return f"piezo-sym generate {spec if str(spec) in shipped() else find(spec)}"


def _own(name: str, sha256: str) -> ModuleType | None:
    """Return the module of exactly this spec that came with the package, or with its checkout."""
    checkout = PACKAGE.parent / GENERATED
    for folder in (PACKAGE / GENERATED, checkout):
        path = folder / name / f"{name}.py"
        if path.is_file() and (folder != checkout or (PACKAGE.parent / "pyproject.toml").is_file()):
            module = load_module(path)
            if sha256 == module.SPEC_SHA256:
                return module
    return None


def _cache_path(name: str, sha256: str, kind: str = "") -> Path:
    import platformdirs

    folder = Path(platformdirs.user_cache_dir("piezo_sym")) / "modules"
    return folder / f"{sha256}-{_generator()}{kind}" / f"{name}.py"


def _known(name: str, sha256: str) -> ModuleType | None:
    """Return the module of exactly this spec: the package's own, or from the user's cache.

    One that is not proved only if the working folder has the same.
    """
    if not name:
        return None
    own = _own(name, sha256)
    return own or _cached(name, sha256) or _cached(name, sha256, ALL_THE_SAME)


def _cached(name: str, sha256: str, kind: str = "") -> ModuleType | None:
    path = _cache_path(name, sha256, kind)
    with suppress(FileError):  # what cannot be read or loaded is made again
        if read_text(path) is not None:
            module = load_module(path)
            if not kind or ((GENERATED / name).is_dir() and _is_current(module)):
                return module
    return None


def _generated(model: Model) -> ModuleType:
    """Return the module of a model, generated into the user's cache."""
    from piezo_sym.build import render

    try:
        return _kept(model, render(model))
    except ProofError:
        if not (GENERATED / model.name).is_dir():
            raise
        module = _kept(model, render(model, allow_unproved=True), ALL_THE_SAME)
        if not _is_current(module):
            raise
        return module


def _kept(model: Model, texts: Mapping[str, str], kind: str = "") -> ModuleType:
    """Return a module from its texts, which go to the cache."""
    path = _cache_path(model.name, model.sha256, kind)
    files = {Path(name).name: text.encode() for name, text in texts.items()}
    try:
        write_together({path.parent / name: text for name, text in files.items()})
        return load_module(path)
    except FileError:  # a read-only cache: the module and its C live as long as the process
        other = temporary_folder() / path.parent.name
        write_together({other / name: text for name, text in files.items()})
        return load_module(other / path.name)


def _is_current(module: ModuleType) -> bool:
    """Return whether ``generated/`` of the working folder has this very module, or none."""
    folder, own = GENERATED / module.NAME, Path(str(module.__file__)).parent
    names = [f"{module.NAME}{ending}" for ending in (".py", ".h", ".c", "_step.h", "_step.c")]
    return not folder.is_dir() or all(_same(folder / n, own / n) for n in names)


def _same(one: Path, other: Path) -> bool:
    """Return whether two files are equal, or both missing; read again only if one has changed."""
    try:
        return filecmp.cmp(one, other, shallow=False)
    except OSError:
        return not one.is_file() and not other.is_file()


@cache
def _generator() -> str:
    """Return the hash of the package's own sources: another generator, another cached module."""
    found = hashlib.sha256(VERSION.encode())
    for path in sorted(PACKAGE.rglob("*.py")):
        if PACKAGE / "generated" not in path.parents:
            found.update(path.read_bytes())
    return found.hexdigest()[:16]


def load_module(path: Path) -> ModuleType:
    """Return the module in a file, loaded again when the file has changed."""
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
