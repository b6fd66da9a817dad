"""The user's cache of plain data, one record per key, and a loader of generated modules.

Input: a hash of a spec, with or without its values, and the data to keep.  Output: the data as it
was kept, or a loaded module.  Records of other versions of the package, or of other versions of the
libraries that prove, are not found.
"""

import ast
import hashlib
import importlib.util
import json
import sys
from collections.abc import Mapping
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

from piezo_sym.errors import FileError
from piezo_sym.files import (
    path_text,
    read_bytes,
    read_text,
    temporary_folder,
    user_cache,
    write_text,
    write_together,
)
from piezo_sym.spec.values import without_values
from piezo_sym.version import own_sources, unchanged

#: Endings of the folders of records: texts of proved modules; texts of modules that are not proved;
#: templates; all generated files of proved models; specs that were loaded; verdicts that refute.
MODULE, UNPROVED_MODULE, SHAPE, PROVED, LOADED = "", "-unproved", "-shape", "-proved", "-loaded"
REFUTED = "-refuted"
RECORD = "record.json"  # of plain data, after its digest


def kept(key: str, kind: str) -> Any:
    """Return the plain data kept under a key; None if it is missing or damaged."""
    folder = _folder(key, kind)
    with suppress(FileError):
        digest, _, text = (read_text(folder / RECORD) or "").partition("\n")
        return json.loads(text) if digest == _digest(folder, text) else None
    return None


def keep(key: str, kind: str, content: Any, sources: str) -> bool:
    """Keep plain data under a key, if possible, and return whether it is kept.

    It is kept only if `sources`, the hash of the sources that made it, are those of this process.
    """
    if not sources or sources != own_sources() or not unchanged():
        return False
    folder, text = _folder(key, kind), json.dumps(content)
    with suppress(FileError):
        write_text(folder / RECORD, f"{_digest(folder, text)}\n{text}")
        return True
    return False


def _folder(key: str, kind: str) -> Path:
    return user_cache("modules") / f"{key}-{own_sources()}{kind}"


def _digest(folder: Path, text: str) -> str:
    """Return the digest of a record; it depends on the folder, so that no record can be moved."""
    return hashlib.sha256(f"{folder.name}\n{text}".encode()).hexdigest()


def remember(content: dict[str, Any]) -> None:
    """Remember that a spec with exactly this data was loaded, and one that differs in values only.

    The spec's own hash is not enough: it leaves out entries without effect, such as `count = 0`,
    that loading may refuse.
    """
    for one in (content, without_values(content)):
        keep(_digest_of_data(one), LOADED, True, own_sources())


def was_loaded(content: dict[str, Any]) -> bool:
    """Return whether a spec with exactly this data is remembered."""
    return kept(_digest_of_data(content), LOADED) is True


def _digest_of_data(content: dict[str, Any]) -> str:
    return hashlib.sha256(repr(content).encode()).hexdigest()


def cached_module(name: str, sha256: str, kind: str = MODULE) -> ModuleType | None:
    """Return a module from the cache, or None; files that differ from its record are rewritten."""
    if (texts := kept(sha256, kind)) is None:
        return None
    folder = _folder(sha256, kind)
    try:
        return write_module(folder, name, texts)
    except FileError:  # the cache is read-only
        return write_module(temporary_folder() / folder.name, name, texts)


def cache_module(
    name: str, sha256: str, texts: Mapping[str, str], sources: str, kind: str = MODULE
) -> ModuleType:
    """Return the module of some texts, which are kept if possible; `sources` as in `keep`."""
    found = cached_module(name, sha256, kind) if keep(sha256, kind, texts, sources) else None
    return found or write_module(temporary_folder() / f"{sha256}{kind}", name, texts)


def write_module(folder: Path, name: str, texts: Mapping[str, str]) -> ModuleType:
    """Write those texts of a module that a folder does not have yet, and return the module."""
    contents = {folder / f"{name}{ending}": text.encode() for ending, text in texts.items()}
    write_together({path: data for path, data in contents.items() if read_bytes(path) != data})
    return load_module(folder / f"{name}.py")


def load_module(path: Path) -> ModuleType:
    """Return the module in a file, which is loaded again after a change."""
    return _loaded(path.resolve(), read_text(path))


@lru_cache(maxsize=64)
def _loaded(path: Path, text: str | None) -> ModuleType:
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
    if module.__doc__ is None:  # with -OO; it says what is proved
        module.__doc__ = ast.get_docstring(ast.parse(text or ""), clean=False)
    if not hasattr(module, "SPEC_SHA256"):
        raise FileError("is no generated module", path_text(path), remedy="move it elsewhere")
    return module
