"""Source to a shared library in the user's cache.

Input: the texts of a module's .c and .h.  Output: the path of its library.  A library is named by
all that it depends on (texts, flags, compiler, processor), is built aside and moved into place in
one step: any number of processes may ask at once, and none ever sees half a file.
"""

import hashlib
import os
import sys
import tempfile
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from subprocess import TimeoutExpired
from typing import Literal, final

from piezo_sym.errors import EngineError, FileError, one_line
from piezo_sym.files import path_text, temporary_folder
from piezo_sym.run.engine.compiler import FLAGS, Compiler, build, compilers, passed_by
from piezo_sym.run.engine.driver import at_once, collocation, driver, lanes_of
from piezo_sym.run.engine.processor import processor
from piezo_sym.run.engine.texts import texts as texts_of

Layout = Literal["one", "many", "lanes", "slopes"]
#: What is compiled; the other files are included there.
UNITS = ("driver.c", "stages.c")
ENDINGS = {"win32": ".dll", "darwin": ".dylib"}


#: Which variable says where caches are.
CACHE = {"win32": "LOCALAPPDATA", "darwin": "HOME"}.get(sys.platform, "XDG_CACHE_HOME")


class EngineWarning(UserWarning):
    """There is no compiled engine, or not the one asked for, and why."""


@final
@dataclass(frozen=True)
class Sources:
    """The texts of one module: its name, ``<name>.h``, ``<name>.c``; and what is made of them.

    A library has the module's functions; or, if it is one of steps, those of so many stages. For
    steps there is also ``<name>_step.c``, and what lies in vectors: numbers of "one" run do not,
    "many" runs side by side, or the "lanes" of its banks; and whether they are dissipative. With
    "slopes" it has no steps, but the derivatives of one.
    """

    name: str
    header: str
    source: str
    step: str = ""
    stages: int = 0
    layout: Layout = "one"
    lossy: bool = False

    def files(self) -> dict[str, str]:
        """Return what to compile, by file name."""
        texts = {f"{self.name}.h": self.header, f"{self.name}.c": self.source}
        if self.stages:
            texts[f"{self.name}_step.c"] = self.step
            texts["elimination.c"] = texts_of("elimination.c")
        if lanes := lanes_of(self.stages, self.layout, lossy=self.lossy):
            texts["stages.c"] = at_once(self.name, lanes)
        return {**texts, "driver.c": self._driver()}

    def _driver(self) -> str:
        if not self.stages:
            return driver(self.name)
        return collocation(self.name, self.stages, self.layout, lossy=self.lossy)


def library(sources: Sources, *, again: bool = False) -> Path:
    """Return the library of a module; it is compiled if it is not in the cache.

    Parameters
    ----------
    sources : the texts.
    again : compile even if there is a library, since that one cannot be loaded.

    Raises
    ------
    EngineError
        If there is no compiler, none of them can compile it, or no folder can be written.
    """
    first: EngineError | None = None
    hung: set[Compiler] = set()
    for compiler, flags in _ways(sources):
        if compiler in hung:
            continue
        try:
            path = _kept(sources, compiler, flags, again=again)
        except EngineError as error:
            first = first or error
            if isinstance(error.__cause__, TimeoutExpired):  # other flags will not wake it
                hung.add(compiler)
            continue
        if wanted := passed_by(compiler):
            why = first.what if first else "it does not run"
            taken = one_line(" ".join(compiler.command))
            _warn(f"CC names {path_text(wanted)}, but {why}; {taken} is taken")
        return path
    if first:
        raise first
    remedy = "install gcc or clang, set CC, or `pip install piezo_sym[zig]`"
    raise EngineError("no C compiler is found", "engine", remedy=remedy)


def _ways(sources: Sources) -> Iterator[tuple[Compiler, tuple[str, ...]]]:
    for compiler in compilers():
        for flags in FLAGS:
            yield compiler, _flags(sources, flags)


def cache_folder() -> Path:
    """Return the folder of all compiled modules."""
    import platformdirs

    return Path(platformdirs.user_cache_dir("piezo_sym")) / "compiled"


def _ending() -> str:
    return ENDINGS.get(sys.platform, ".so")


def _flags(sources: Sources, flags: tuple[str, ...]) -> tuple[str, ...]:
    """Return the flags for some texts.

    What a compiler makes vectors of it may round otherwise: steps of many runs side by side, and of
    one alone, shall give the same numbers.
    """
    alike = sources.stages and sources.layout != "lanes"
    return (*flags, "-fno-tree-vectorize", "-fno-openmp-simd") if alike else flags


def _key(sources: Sources, compiler: Compiler, flags: tuple[str, ...]) -> str:
    found = hashlib.sha256()
    parts = (*compiler.command, compiler.version, *flags, processor())
    for part in (*sources.files().values(), *parts):
        found.update(part.encode() + b"\0")
    return found.hexdigest()[:32]


def _kept(sources: Sources, compiler: Compiler, flags: tuple[str, ...], *, again: bool) -> Path:
    """Return a compiled library, in the cache or else in a folder of this process alone."""
    place = Path(_key(sources, compiler, flags)) / f"{sources.name}{_ending()}"
    path = cache_folder() / place
    if os.path.isfile(path) and not again:  # a folder that cannot be read holds none
        return path
    try:
        _build(sources, compiler, flags, path)
    except OSError as error:
        why = f"the cache cannot be written ({error.strerror or type(error).__name__})"
        where, remedy = path_text(cache_folder()), f"set {CACHE} to a folder that can be written"
        try:
            path = temporary_folder() / place
            if not os.path.isfile(path) or again:
                _build(sources, compiler, flags, path)
        except (OSError, FileError) as both:
            raise EngineError(why, where, remedy=remedy) from both
        _warn(f"{where}: {why}; what is compiled is kept for this process alone; {remedy}")
    return path


def _build(sources: Sources, compiler: Compiler, flags: tuple[str, ...], path: Path) -> None:
    """Compile beside the library's place, then move the result there.

    Raises
    ------
    OSError : the place cannot be written.
    EngineError : the compiler fails.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=".build-", dir=path.parent) as temporary:
            folder = Path(temporary)
            for name, text in sources.files().items():
                (folder / name).write_text(text, encoding="utf-8")
            built = folder / path.name
            units = [folder / name for name in UNITS if (folder / name).is_file()]
            build(compiler, flags, units, built)
            built.replace(path)
    except OSError:
        if os.path.isfile(path) and sys.platform == "win32":  # another process has it, and uses it
            return
        raise


@cache
def _warn(text: str) -> None:
    """Warn in one line, once in a process."""
    warnings.warn(text, EngineWarning, stacklevel=2)
