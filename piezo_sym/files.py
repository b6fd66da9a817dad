"""Reads and atomic writes of files, which are never half-written.

Input: a path and its content.  Output: the file, or a `FileError`.
"""

import atexit
import os
import shutil
import tempfile
import warnings
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from piezo_sym.errors import FileError, UsageError, legible, quote, similar


def write_text(path: Path, text: str) -> None:
    """Write a text file as UTF-8 atomically: readers see the old file or the new one."""
    write_together({path: text.encode("utf-8")})


def write_bytes(path: Path, data: bytes) -> None:
    """Write a file atomically: readers see the old file or the new one."""
    write_together({path: data})


def write_together(contents: Mapping[Path, bytes]) -> None:
    """Write files that belong together: none is replaced before all are on the disk."""
    staged: dict[Path, Path] = {}
    try:
        for path, data in contents.items():
            staged[path] = _write_beside(path, data)
        for path, temporary in staged.items():
            try:
                temporary.replace(path)
            except OSError as error:
                raise _cannot("written", path, error) from error
    finally:
        for temporary in staged.values():
            with suppress(OSError):
                temporary.unlink()


def _write_beside(path: Path, data: bytes) -> Path:
    """Write data to a temporary file beside `path`, and return its path."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    except OSError as error:
        raise _cannot("written", path, error) from error
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        Path(name).chmod(0o644)
    except OSError as error:
        with suppress(OSError):
            Path(name).unlink()
        raise _cannot("written", path, error) from error
    return Path(name)


def read_text(path: Path) -> str | None:
    """Return a text file's content, or None if there is no such file or folder."""
    try:
        return path.read_text(encoding="utf-8")
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, UnicodeDecodeError) as error:
        raise _cannot("read", path, error) from error


def read_bytes(path: Path) -> bytes | None:
    """Return a file's content, or None if there is no such file or folder."""
    try:
        return path.read_bytes()
    except (FileNotFoundError, NotADirectoryError):
        return None
    except OSError as error:
        raise _cannot("read", path, error) from error


def near_file(path: Path) -> str:
    """Return the remedy for a missing file: a file beside it with a similar name, if any."""
    stems: dict[str, str] = {}
    with suppress(OSError, ValueError):
        for name in sorted(entry.name for entry in path.parent.iterdir()):
            if similar(Path(name).suffix, [path.suffix]) or not path.suffix:
                stems.setdefault(Path(name).stem, name)
    found = similar(path.stem, stems)
    return f"did you mean '{stems[found]}'?" if found else "check the path"


def folder_entries(path: Path) -> list[Path]:
    """Return the entries of a folder, sorted."""
    try:
        return sorted(path.iterdir())
    except OSError as error:
        raise _cannot("read", path, error) from error


@cache
def temporary_folder() -> Path:
    """Return a folder that is removed when the process ends, in place of a cache."""
    try:
        folder, owner = tempfile.mkdtemp(prefix="piezo_sym-"), os.getpid()
    except OSError as error:
        raise _cannot("written", Path(tempfile.gettempdir()), error) from error

    def remove() -> None:
        if os.getpid() == owner:  # not when a child of the process ends
            shutil.rmtree(folder, ignore_errors=True)

    atexit.register(remove)
    return Path(folder)


def user_cache(name: str) -> Path:
    """Return a folder of the user's cache; a temporary one for a user without a home."""
    import platformdirs

    with suppress(RuntimeError):
        folder = Path(platformdirs.user_cache_dir("piezo_sym"))
        if folder.is_absolute():
            return folder / name
    return temporary_folder() / name


def zarr_library(where: str) -> Any:
    """Return zarr; raise `UsageError` if it is not installed."""
    try:
        import zarr
    except ImportError as error:
        remedy = "run `pip install 'piezo_sym[store]'`"
        raise UsageError("zarr is not installed", where, remedy=remedy) from error
    return zarr


def consolidate(path: Path) -> None:
    """Write consolidated metadata, without which xarray warns when it opens the store.

    zarr warns that its format 3 does not define them yet.
    """
    import zarr

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        zarr.consolidate_metadata(path, zarr_format=3)


def path_of(value: object, where: str) -> Path:
    """Return a user's path; raise `UsageError` if it is none."""
    if not isinstance(value, str | os.PathLike):
        raise UsageError(f"{quote(value)} is no path", where, "a path, as text or a Path")
    return Path(value)


def path_text(path: str | Path) -> str:
    """Return a path quoted for a message, printable and not shortened, as its end matters most."""
    return legible(f"'{path}'")


def _cannot(done: str, path: Path, error: Exception) -> FileError:
    reason = getattr(error, "strerror", None) or "not text"
    return FileError(f"cannot be {done} ({reason})", path_text(path), remedy="check the path")
