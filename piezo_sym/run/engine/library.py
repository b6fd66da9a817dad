"""The C beside a module, compiled into a shared library in the user's cache, and loaded.

Input: a module, or the texts of its .c and .h.  Output: its library.  The name of a library is a
hash of all that it depends on (texts, flags, compiler, processor).  It is built in a temporary
folder and moved into place atomically, so any number of processes may compile at once.
"""

import ctypes
import hashlib
import os
import re
import shutil
import sys
import tempfile
import time
import warnings
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from subprocess import TimeoutExpired
from typing import Literal, final

from piezo_sym.errors import EngineError, FileError, one_line
from piezo_sym.files import path_text, read_text, temporary_folder, user_cache
from piezo_sym.run.engine.c_sources import (
    c_source,
    derivatives_source,
    functions_source,
    laws_source,
    stage_lanes,
    stages_source,
    steps_source,
)
from piezo_sym.run.engine.compiler import (
    FLAGS,
    QUICK,
    VECTORS,
    WRITTEN_OUT,
    Compiler,
    build,
    compilers,
    passed_by,
    preprocessed,
    processor,
)
from piezo_sym.run.module import GeneratedModule

Layout = Literal["one", "many", "lanes", "slopes"]
#: The files to compile, which include the others; no model has such a name. The object of a driver
#: of steps is kept, too: an edit of a law changes the others alone.
LAWS, DRIVER, STAGES = "the-laws.c", "the-driver.c", "the-stages.c"
ENDING = ".dylib" if sys.platform == "darwin" else ".so"
#: The ending of the file with a library's digest; the prefix of folders in which one is compiled,
#: and the age [s] at which one is left over from a killed compilation.
DIGEST, BUILD, LEFT_SECONDS = ".sha256", ".build-", 3600.0
#: The parts of C that depend on a spec's values: comments, and the initializer.
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_VALUES = re.compile(r"^#define \w+_DEFAULTS \{ \\\n(?:.*\\\n)*\}$", re.MULTILINE)
#: The macro that is defined for a model that is not proved: see real.h.
NOT_PROVED = "#define NOT_PROVED\n"
#: The environment variable for the folder of caches.
CACHE = "HOME" if sys.platform == "darwin" else "XDG_CACHE_HOME"


class EngineWarning(UserWarning):
    """There is no compiled engine, or not the one asked for, and why."""


@final
@dataclass(frozen=True)
class Sources:
    """The texts of one module, ``<name>.h`` and ``<name>.c``, and the options of its library.

    Without `stages` a library has the module's functions; with them, its steps, from
    ``<name>_step.c``. `layout` says what vectors hold: "many" runs, the "lanes" of banks, or the
    stages of "one" run; with "slopes" the library has the derivatives of a step. `lossy` steps are
    dissipative. `proved` says whether the model is, or is about to be.
    """

    name: str
    header: str
    source: str
    step: str = ""
    stages: int = 0
    layout: Layout = "one"
    lossy: bool = False
    proved: bool = True

    def files(self) -> dict[str, str]:
        """Return the texts to compile by file name, without values, on which no code depends."""
        header = _VALUES.sub("", self.header)
        texts = {f"{self.name}.h": header, f"{self.name}.c": self.source}
        sources = self._sources()
        if self.stages:
            texts |= {f"{self.name}_step.c": self.step, "elimination.c": c_source("elimination.c")}
            head = "" if self.proved else NOT_PROVED
            sources = {name: head + text for name, text in sources.items()}
        return {name: _COMMENT.sub(" ", text) for name, text in (texts | sources).items()}

    def _sources(self) -> dict[str, str]:
        """Return the files to compile, which include the others."""
        name, stages, layout, lossy = self.name, self.stages, self.layout, self.lossy
        if not stages:
            return {DRIVER: functions_source(name)}
        if layout == "slopes":
            return {DRIVER: derivatives_source(name, stages)}
        texts = {DRIVER: steps_source(name, stages, layout, lossy=lossy)}
        texts[LAWS] = laws_source(name, layout)
        if lanes := stage_lanes(stages, layout, lossy=lossy):
            texts[STAGES] = stages_source(name, lanes)
        return texts


def read_source(module: GeneratedModule, ending: str) -> str:
    """Return the text of ``<model><ending>`` beside a module, checked to be of its spec."""
    file, text = source_path(module, ending), None
    with suppress(OSError):  # there is no file; it is read again after a change
        status = file.stat()
        text = _read(file, status.st_mtime_ns, status.st_size)
    if text is None or f"spec sha256 {module.SPEC_SHA256}" not in text:
        what = "is missing" if text is None else "is of another spec than the module"
        raise EngineError(what, path_text(file), remedy="run `piezo-sym generate`")
    return text


def source_path(module: GeneratedModule, ending: str) -> Path:
    """Return the path of ``<model><ending>`` beside a module."""
    file = Path(getattr(module, "__file__", None) or f"{module.NAME}.py")
    return file.with_name(f"{module.NAME}{ending}")


@lru_cache(maxsize=64)
def _read(file: Path, changed: int, size: int) -> str | None:
    del changed, size  # keys of the cache alone
    try:
        return read_text(file)
    except FileError as error:
        raise EngineError(error.what, error.where, remedy=error.remedy) from error


def shared_library(sources: Sources) -> ctypes.CDLL:
    """Return the loaded library of some texts, which are compiled if it is not in the cache."""
    path = library(sources)
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        what = "the compiled module cannot be loaded"
        raise EngineError(what, path_text(path), remedy="delete it") from error


def library(sources: Sources) -> Path:
    """Return the path of the library of some texts, compiled if it is not in the cache."""
    first: EngineError | None = None
    for compiler in compilers():
        for options in FLAGS:
            try:
                path = _cached(sources, compiler, _flags(sources, options))
            except EngineError as error:
                first = first or error
                if isinstance(error.__cause__, TimeoutExpired):
                    break  # it hangs with other flags, too
                continue
            if wanted := passed_by(compiler):
                why = first.what if first else "it does not run"
                taken = one_line(" ".join(compiler.command))
                warn_once(f"CC names {path_text(wanted)}, but {why}; {taken} is taken", 2)
            return path
    if first:
        raise first
    remedy = "install gcc or clang, set CC, or `pip install piezo_sym[zig]`"
    raise EngineError("no C compiler is found", "engine", remedy=remedy)


def cache_folder() -> Path:
    """Return the folder of all compiled modules."""
    return user_cache("compiled")


def _flags(sources: Sources, flags: tuple[str, ...]) -> tuple[str, ...]:
    """Return the flags for some texts.

    Automatic vectorization may change rounding, but steps of many runs in vectors, and of one run,
    must give equal numbers.
    """
    if not sources.stages:
        return tuple(part for flag in flags for part in (VECTORS if flag == "-O3" else [flag]))
    if sources.layout == "lanes":
        return flags
    if sources.layout == "one" and {*WRITTEN_OUT} <= {*flags}:
        flags = (*QUICK, *(flag for flag in flags if flag != "-O3"))
    return (*flags, "-fno-tree-vectorize", "-fno-openmp-simd")


def _key(texts: Iterable[str], compiler: Compiler, flags: tuple[str, ...]) -> str:
    """Return the name of what is compiled of some texts, whatever their files are called."""
    digest = hashlib.sha256()
    for part in (*texts, *compiler.command, compiler.version, *flags, processor()):
        digest.update(part.encode() + b"\0")
    return digest.hexdigest()[:32]


def _cached(sources: Sources, compiler: Compiler, flags: tuple[str, ...]) -> Path:
    """Return a compiled library in the cache, or else in a temporary folder of this process."""
    place = Path(_key(sources.files().values(), compiler, flags)) / f"{sources.name}{ENDING}"
    path = cache_folder() / place
    if _intact(path):
        return path
    try:
        _build(sources, compiler, flags, path)
    except OSError as error:
        why = f"the cache cannot be written ({error.strerror})"
        where, remedy = path_text(cache_folder()), f"set {CACHE} to a folder that can be written"
        try:
            path = temporary_folder() / place
            if not _intact(path):
                _build(sources, compiler, flags, path)
        except (OSError, FileError) as both:
            raise EngineError(why, where, remedy=remedy) from both
        warn_once(f"{where}: {why}; what is compiled is kept for this process alone; {remedy}", 2)
    return path


def _intact(path: Path) -> bool:
    """Return whether a library exists and has its digest: a damaged one would crash Python."""
    try:
        return _digest(path) == path.with_suffix(DIGEST).read_text(encoding="ascii")
    except (OSError, ValueError):
        return False


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _build(sources: Sources, compiler: Compiler, flags: tuple[str, ...], path: Path) -> None:
    """Compile in a folder beside the library's path, then move the result there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    for left in path.parent.glob(f"{BUILD}*"):  # by compilations that were killed an hour ago
        with suppress(OSError):
            if time.time() - left.stat().st_mtime > LEFT_SECONDS:
                shutil.rmtree(left, ignore_errors=True)
    with tempfile.TemporaryDirectory(prefix=BUILD, dir=path.parent) as temporary:
        folder, texts = Path(temporary), sources.files()
        for name, text in texts.items():
            (folder / name).write_text(text, encoding="utf-8")
        built, driver = folder / path.name, folder / DRIVER
        units = [folder / name for name in (LAWS, DRIVER, STAGES) if name in texts]
        kept = _kept_driver(sources, compiler, flags, driver, path) if len(units) > 1 else None
        known = {driver: kept} if kept and _intact(kept) else {}
        build(compiler, flags, units, built, known)
        _keep(built, path)
        if kept and not known:
            with suppress(OSError):
                kept.parent.mkdir(exist_ok=True)
                _keep(driver.with_suffix(".o").rename(folder / kept.name), kept)


def _kept_driver(
    sources: Sources, compiler: Compiler, flags: tuple[str, ...], driver: Path, path: Path
) -> Path | None:
    """Return where the object of a driver is kept, beside a library's folder; None if nowhere.

    Its name is a hash of the preprocessed text, so that what it does not see may change.
    """
    try:
        text = preprocessed(compiler, flags, driver)
    except EngineError:  # some compilers do not preprocess
        return None
    return path.parent.parent / _key([text], compiler, flags) / f"{sources.name}.o"


def _keep(file: Path, path: Path) -> None:
    """Move a compiled file to its path, with its digest beside it."""
    mark = file.with_suffix(DIGEST)
    mark.write_text(_digest(file), encoding="ascii")
    for one in (file, mark):
        with one.open("rb+") as opened:
            os.fsync(opened.fileno())
        one.replace(path.with_name(one.name))


@lru_cache(maxsize=256)
def warn_once(text: str, level: int) -> None:
    """Warn in one line, once in a process."""
    warnings.warn(text, EngineWarning, stacklevel=level)
