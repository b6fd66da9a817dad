"""The user's cache of generated modules and of templates, and the loader of modules.

Input: a model's name, and the hash of its spec or of its shape.  Output: a loaded module, or a
`Template`.  Each version of the package has its own cache.
"""

import hashlib
import importlib.util
import sys
from collections.abc import Mapping
from contextlib import suppress
from functools import cache, lru_cache
from pathlib import Path
from types import ModuleType

from piezo_sym.errors import FileError
from piezo_sym.files import path_text, read_text, temporary_folder, write_text, write_together
from piezo_sym.spec.values import Template, from_text
from piezo_sym.version import VERSION

PACKAGE = Path(__file__).parent
#: Endings of the package's sources.
SOURCES = (".py", ".c", ".h")
#: Endings of folders of modules that are not proved, and of templates.
UNPROVED_FOLDER, SHAPE_FOLDER = "-unproved", "-shape"


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


def cached_template(name: str, shape: str) -> Template | None:
    """Return the proved texts of a spec's shape, if they are in the cache."""
    with suppress(FileError):
        text = read_text(_path(name, shape, SHAPE_FOLDER).with_suffix(".json"))
        return None if text is None else from_text(text)
    return None


def cache_template(name: str, shape: str, template: Template) -> None:
    """Write the proved texts of a spec's shape to the cache, if possible."""
    with suppress(FileError):
        write_text(_path(name, shape, SHAPE_FOLDER).with_suffix(".json"), template.to_text())


def _path(name: str, sha256: str, kind: str = "") -> Path:
    import platformdirs

    folder = Path(platformdirs.user_cache_dir("piezo_sym")) / "modules"
    return folder / f"{sha256}-{_generator()}{kind}" / f"{name}.py"


@cache
def _generator() -> str:
    """Return the hash of the package's own sources, so that an edit invalidates the cache."""
    digest = hashlib.sha256(VERSION.encode())
    for path in sorted(PACKAGE.rglob("*.[pch]*")):
        if path.suffix in SOURCES and PACKAGE / "generated" not in path.parents:
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


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
