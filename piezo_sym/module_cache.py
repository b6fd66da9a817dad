"""The user's cache: generated modules, templates, and all files of proved specs; and a loader.

Input: the hash of a spec or of its shape, and a module's name.  Output: a loaded module, a
`Template`, or texts.  What was made by other sources of the package, or proved with other
libraries, is not found.
"""

import hashlib
import importlib.util
import json
import sys
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict
from functools import cache, lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

from piezo_sym.errors import FileError
from piezo_sym.files import path_text, read_text, temporary_folder, write_text, write_together
from piezo_sym.spec.values import Template
from piezo_sym.version import sources_hash

#: Endings of folders of modules that are not proved, of templates, and of files of what is proved.
UNPROVED_FOLDER, SHAPE_FOLDER, PROVED_FOLDER = "-unproved", "-shape", "-proved"
RECORD = "record.json"  # of plain data, after its digest


def cached_module(name: str, sha256: str, kind: str = "") -> ModuleType | None:
    """Return a module from the cache; None if it is missing or cannot be loaded."""
    path = _path(name, sha256, kind)
    with suppress(FileError):
        return None if read_text(path) is None else load_module(path)
    return None


def cache_module(name: str, sha256: str, texts: Mapping[str, str], kind: str = "") -> ModuleType:
    """Write a module's texts to the cache, and return the module."""
    folder = _path(name, sha256, kind).parent
    try:
        return write_module(folder, name, texts)
    except FileError:  # the cache is read-only
        return write_module(temporary_folder() / folder.name, name, texts)


def write_module(folder: Path, name: str, texts: Mapping[str, str]) -> ModuleType:
    """Write a module's texts to a folder, and return the module."""
    write_together({folder / f"{name}{ending}": text.encode() for ending, text in texts.items()})
    return load_module(folder / f"{name}.py")


def kept_template(shape: str) -> Template | None:
    """Return the proved texts of a spec's shape, if they are in the cache."""
    found = _record(_folder(shape, SHAPE_FOLDER))
    return None if found is None else Template(**found)


def keep_template(shape: str, template: Template) -> None:
    """Write the proved texts of a spec's shape to the cache, if possible."""
    _write_record(_folder(shape, SHAPE_FOLDER), asdict(template))


def kept_files(key: str) -> Mapping[str, str] | None:
    """Return the texts of all files generated from a proved model, None if they are not cached.

    `key` is that of the model: see `Model.key`.
    """
    found: Mapping[str, str] | None = _record(_folder(key, PROVED_FOLDER))
    return found


def keep_files(key: str, files: Mapping[str, str]) -> None:
    """Write the texts of all files generated from a proved model to the cache, if possible."""
    _write_record(_folder(key, PROVED_FOLDER), dict(files))


def _record(folder: Path) -> Any:
    """Return the plain data of a folder; None if it is missing, or not what was written there."""
    with suppress(FileError):
        digest, _, text = (read_text(folder / RECORD) or "").partition("\n")
        return json.loads(text) if digest == _digest(folder, text) else None
    return None


def _write_record(folder: Path, content: Any) -> None:
    """Write plain data into a folder, after its digest, if possible."""
    text = json.dumps(content)
    with suppress(FileError):
        write_text(folder / RECORD, f"{_digest(folder, text)}\n{text}")


def _digest(folder: Path, text: str) -> str:
    """Return the digest of a record, which is that of no other folder's."""
    return hashlib.sha256(f"{folder.name}\n{text}".encode()).hexdigest()


def _path(name: str, sha256: str, kind: str = "") -> Path:
    return _folder(sha256, kind) / f"{name}.py"


def _folder(sha256: str, kind: str) -> Path:
    import platformdirs

    folder = Path(platformdirs.user_cache_dir("piezo_sym")) / "modules"
    return folder / f"{sha256}-{own_sources()}{kind}"


@cache
def own_sources() -> str:
    """Return the hash of the sources of this package as they were when it was first asked for."""
    return sources_hash()


def load_module(path: Path) -> ModuleType:
    """Return the module in a file, which is loaded again after a change."""
    return _loaded(path.resolve(), read_text(path))


@lru_cache(maxsize=64)
def _loaded(path: Path, text: str | None) -> ModuleType:
    del text  # a key of the cache alone
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
