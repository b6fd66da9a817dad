"""Spec to a loaded module: the package's own, or one generated into the user's cache.

Input: a shipped name, a path, or a `Model`.  Output: its generated module, loaded.  What lies in
``generated/`` of the working folder is compared with it and never executed; where it differs, a
`ModuleWarning` says so.
"""

from __future__ import annotations

import filecmp
import warnings
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from threading import Thread
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from piezo_sym.errors import UsageError, quote
from piezo_sym.files import path_text, read_text, temporary_folder
from piezo_sym.module_cache import (
    REFUTED,
    SHAPE,
    UNPROVED_MODULE,
    cache_module,
    cached_module,
    kept,
    load_module,
    remember,
    was_loaded,
    write_module,
)
from piezo_sym.run.module import UNPROVED, held, verdict_of
from piezo_sym.spec.source import MODELS, data, find, read, shipped
from piezo_sym.spec.values import Template, shape_hash, without_values
from piezo_sym.spec.write import spec_hash
from piezo_sym.version import PACKAGE, own_sources

if TYPE_CHECKING:
    from piezo_sym.report import Report
    from piezo_sym.spec.model import Model

GENERATED = Path("generated")  # of the working folder


class ModuleWarning(UserWarning):
    """A generated module in the working folder that is not used, or one that is not proved."""


def module_of(spec: str | Path | Model, stages: int | None = None) -> ModuleType:
    """Return the generated module of a spec, derived and proved if it is not known yet.

    Raises `FileError`, `SpecError`, `NetworkError` or `ProofError` if the spec cannot be read,
    derived or proved; one that is not proved runs all the same if `generate --allow-unproved` wrote
    its module to the working folder.  Raises `UsageError` if `spec` is none of these.

    Parameters
    ----------
    spec : the name of a shipped spec, the path of a spec file, or a `Model`.
    stages : per step of the run that follows; steps are compiled while the module is proved.
    """
    if isinstance(spec, str | Path):
        file = find(spec)
        module = _of_file(file, read(file), stages)
    else:
        module = _of_model(spec, stages)
    verdict = verdict_of(module)
    if verdict.startswith(UNPROVED):
        text = f"model '{module.NAME}' is {verdict}: its runs may break a law of thermodynamics"
        warnings.warn(text, ModuleWarning, stacklevel=4)
    elif not _matches_folder(module):
        path, again = path_text(GENERATED / module.NAME), _command(spec)
        text = (
            f"{path} is not what the spec generates and is not used; replace it by `{again}`, "
            "or give the spec another name"
        )
        warnings.warn(text, ModuleWarning, stacklevel=4)
    return module


def _of_file(path: Path, text: str, stages: int | None) -> ModuleType:
    """Return the module of a spec file; the spec's types are loaded only in doubt."""
    content = _data(text)
    if module := _known(path, content, text):
        return module
    from piezo_sym.verification.process import started

    started()
    from piezo_sym.spec.load import of_file

    model = of_file(path, text)
    module = _of_model(model, stages)
    if not model.components and not model.banks:
        remember(content)
    return module


def _of_model(model: Model, stages: int | None) -> ModuleType:
    from piezo_sym.spec.model import Model  # loaded already if `model` is one

    if not isinstance(model, Model):
        expected = "the name of a shipped spec, the path of a spec file, or a Model"
        remedy = "give iphs.model" * isinstance(getattr(model, "model", None), Model)
        raise UsageError(f"{quote(model)} is no model", "model", expected, remedy)
    if found := _available(model.name, model.sha256):
        if 0.0 in model.flatten().initial.values():  # the hash leaves out what is 0
            _check_derivation(model)
        return found
    return _derived(model, stages)


@lru_cache(maxsize=64)
def _check_derivation(model: Model) -> None:
    """Refuse values that contradict each other, as initial values of joined stores may."""
    from piezo_sym.derivation import derive

    derive(model)


#: The data of specs read before; it must not be changed.
_data = lru_cache(maxsize=64)(data)
_hash = lru_cache(maxsize=64)(lambda text: spec_hash(_data(text)))


def _known(path: Path, content: dict[str, Any], text: str) -> ModuleType | None:
    """Return the module of a spec, if loading would not refuse what it says: see `remember`."""
    tables = all(isinstance(table, dict) for table in content.values())
    if (tables and path.parent == MODELS) or was_loaded(content):  # a shipped spec is valid
        name = str(content.get("model", {}).get("name"))
        if module := _available(name, _hash(text)):
            return module
    return _refilled(content) if was_loaded(without_values(content)) else None


def _command(spec: str | Path | Model) -> str:
    if not isinstance(spec, str | Path):
        return "piezo_sym.generate(model)"
    return f"piezo-sym generate {spec if str(spec) in shipped() else find(spec)}"


def _packaged(name: str, sha256: str) -> ModuleType | None:
    """Return the module of exactly this spec that came with the package, or with its checkout."""
    checkout = PACKAGE.parent / GENERATED
    for folder in (PACKAGE / GENERATED, checkout):
        path = folder / name / f"{name}.py"
        if path.is_file() and (folder != checkout or (PACKAGE.parent / "pyproject.toml").is_file()):
            module = load_module(path)
            if sha256 == module.SPEC_SHA256:
                return module
    return None


def _available(name: str, sha256: str) -> ModuleType | None:
    """Return the module of exactly this spec: the package's own, or from the user's cache.

    A module that is not proved is returned only if the working folder has the same one.
    """
    if found := _packaged(name, sha256) or cached_module(name, sha256):
        return found
    found = cached_module(name, sha256, UNPROVED_MODULE) if (GENERATED / name).is_dir() else None
    return found if found and _matches_folder(found) else None


def _kept_template(shape: str) -> Template | None:
    """Return the proved texts of a spec's shape, if they are in the cache."""
    found = kept(shape, SHAPE)
    return None if found is None else Template(**found)


def _refilled(content: dict[str, Any]) -> ModuleType | None:
    """Return the module of a spec that differs in values from a loaded one, or None in doubt.

    The module's own conditions replace the checks of values that loading would make.
    """
    found, name = _kept_template(shape_hash(content)), content["model"]["name"]
    if found is None or not found.quick:
        return None
    try:
        texts = found.filled(content)
    except OverflowError:
        return None
    sha256 = spec_hash(content)
    if not _starts_inside(write_module(temporary_folder() / sha256, name, texts)):
        return None
    remember(content)
    return cache_module(name, sha256, texts, own_sources())


def _starts_inside(module: Any) -> bool:
    """Return whether the values of a module's spec lie surely inside its domain."""
    p, u = module.Parameters(), np.array(module.INPUT_DEFAULTS)
    try:
        with np.errstate(all="ignore"):
            x = module.initial_state(u, p)
            found = [x, module.temperatures(x, p), module.margins(x, u, p)]
    except ArithmeticError:
        return False
    return all(np.isfinite(one).all() for one in found) and bool(held(module, found[-1]).all())


def _derived(model: Model, stages: int | None) -> ModuleType:
    """Return the module of a model, generated into the user's cache, with its template."""
    data = model.flatten().model_dump()
    shape = shape_hash(data)
    if found := _kept_template(shape):
        if found.joined:
            _check_derivation(model)
        return cache_module(model.name, model.sha256, found.filled(data), own_sources())

    from piezo_sym.build import keep_results, kept_results, refuse_unproved, report_and_texts

    def meanwhile(template: Template) -> AbstractContextManager[None]:
        return _compiling_ahead(model.name, shape, template.filled(data), stages)

    written = read_text(GENERATED / model.name / f"{model.name}.py") or ""
    if model.sha256 not in written and (refuted := kept_results(model, REFUTED)):
        refuse_unproved(refuted[0])
    report, found = report_and_texts(model, meanwhile)
    if found and report.failures and (module := _unproved(model, report, found.filled(data))):
        return module
    keep_results(model, report, found)
    refuse_unproved(report)
    assert found is not None  # a report that proves a module has its texts
    kept_module = cached_module(model.name, model.sha256)
    return kept_module or write_module(temporary_folder() / shape, model.name, found.filled(data))


@contextmanager
def _compiling_ahead(
    name: str, shape: str, texts: Mapping[str, str], stages: int | None
) -> Iterator[None]:
    """Compile the steps of a run, and import what its result needs, while a module is proved.

    If the proof fails, the compiler is not waited for.
    """
    if stages is None:
        yield
        return
    from piezo_sym.run.method import compile_ahead

    module = write_module(temporary_folder() / f"{shape}-ahead", name, texts)
    compiling = Thread(target=compile_ahead, args=(module, stages), daemon=True)
    threads = compiling, Thread(target=_import_results, daemon=True)
    for thread in threads:
        thread.start()
    yield
    for thread in threads:
        thread.join()


def _import_results() -> None:
    with suppress(ImportError):  # the run says so
        import scipy.io  # noqa: F401 - of a file in NetCDF
        import xarray  # noqa: F401


def _unproved(model: Model, report: Report, texts: Mapping[str, str]) -> ModuleType | None:
    """Return a module that is not proved, if the working folder has the same."""
    if not (GENERATED / model.name).is_dir():
        return None
    module = cache_module(model.name, model.sha256, texts, report.sources, UNPROVED_MODULE)
    return module if _matches_folder(module) else None


def _matches_folder(module: ModuleType) -> bool:
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
