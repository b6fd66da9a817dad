"""The C compilers of this machine, calls of them, and the processor for which they compile.

Input: the environment.  Output: `Compiler` records in the order in which they are tried: ``$CC``,
cc, gcc, clang, then that of the `zig` extra; and shared libraries.
"""

import os
import platform
import shlex
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType
from typing import Any, final

from piezo_sym.errors import EngineError, one_line

#: No contraction: products and sums are rounded separately, as in NumPy, so that a residual and the
#: ledger are the same number, and a state at rest stays there.  It costs 5 % more time.
COMMON = ("-std=c99", "-fPIC", "-ffp-contract=off")
#: The flag of the call that links the library.
SHARED = "-shared"
#: Functions of one library call each other directly, as nothing replaces them.
DIRECT = "-fno-semantic-interposition"
#: For gcc: unrolls short loops of known length, such as those over stages; 8 % less time.  What a
#: function leaves in registers is not used by its callers: gcc 12 then forgets to clear the upper
#: halves of vector registers (vzeroupper), which makes other libraries slow.
WRITTEN_OUT = (
    *("--param", "max-completely-peeled-insns=1000"),
    *("--param", "max-completely-peel-times=32"),
    "-fno-ipa-ra",
)
#: In place of -O3 for steps of one run, as a user waits for them after each edit of a law: the rest
#: of -O3 would take two fifths of gcc's time, for two percent of a run's.
QUICK = (
    *("-O1", "-fpeel-loops", "-finline-functions", "-fgcse", "-fstrict-aliasing", "-ftree-vrp"),
    *("-fexpensive-optimizations", "-freorder-blocks-and-partition", "-fcaller-saves"),
    "-foptimize-sibling-calls",
)
#: In place of -O3 for functions of many states: as fast, in half of gcc's time.
VECTORS = ("-O2", "-ftree-vectorize")
#: Nobody looks at the processor's flags of exceptions: both sides of a choice may be computed, so
#: that loops with choices become vectors. No number changes.
FASTEST = ("-O3", "-march=native", "-fopenmp-simd", "-fno-math-errno", "-fno-trapping-math")
#: Without vector types, which not every compiler has.
PLAIN = "-DPLAIN"
#: Flags, best first; a compiler that refuses some is tried with the next.
FLAGS: tuple[tuple[str, ...], ...] = (
    (*FASTEST, DIRECT, *WRITTEN_OUT, *COMMON),
    (*FASTEST, DIRECT, *COMMON),
    ("-O3", "-fopenmp-simd", "-fno-math-errno", *COMMON),
    ("-O2", PLAIN, *COMMON),
)
#: The most time of a compiler, for its version and to compile.
VERSION_SECONDS, MOST_SECONDS = 10.0, 120.0
#: Characters of a compiler's message in an error: a path and the reason after it.
MOST_SAID = 400
#: How a compiler is started: without input, in a group of its own.
_ALONE: dict[str, Any] = {"stdin": subprocess.DEVNULL, "text": True, "errors": "replace"}
_ALONE |= {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "start_new_session": True}
#: Lines of /proc/cpuinfo that name instructions, on x86, ARM, RISC-V and POWER.
_INSTRUCTIONS = ("flags", "features", "isa", "cpu", "cpu part", "model name")


@final
@dataclass(frozen=True)
class Compiler:
    """A command that compiles C, and its version."""

    command: tuple[str, ...]
    version: str


def compilers() -> Iterator[Compiler]:
    """Yield the installed compilers that work, best first."""
    commands = [*map(_command, (os.environ.get("CC", ""), "cc", "gcc", "clang"))]
    if find_spec("ziglang") is not None:
        commands.append((sys.executable, "-P", "-m", "ziglang", "cc"))
    for command in filter(None, dict.fromkeys(commands)):
        if version := _version(command):
            yield Compiler(command, version)


def passed_by(taken: Compiler) -> str:
    """Return ``$CC`` if it names another compiler than the one taken, else ""."""
    wanted = os.environ.get("CC", "").strip()
    return wanted if wanted and _command(wanted) != taken.command else ""


def _command(text: str) -> tuple[str, ...]:
    """Return a command with the path of its program, () if there is none."""
    try:
        program, *options = shlex.split(text)
    except ValueError:  # an empty text, or a quote that is not closed
        return ()
    path = shutil.which(program)
    return (path, *options) if path else ()


@lru_cache(maxsize=16)
def _version(command: tuple[str, ...]) -> str:
    try:
        (done,) = _call(VERSION_SECONDS, [*command, "--version"])
    except EngineError:
        return ""
    return done.stdout if done.returncode == 0 else ""


def build(
    compiler: Compiler,
    flags: Sequence[str],
    sources: Sequence[Path],
    library: Path,
    known: Mapping[Path, Path] = MappingProxyType({}),
) -> None:
    """Compile source files into a shared library: several at the same time, then linked.

    `known` are objects of some of these files, compiled before.
    """
    command = [*compiler.command, *flags]
    parts = list(sources)
    if len(sources) > 1:
        parts = [known.get(source, source.with_suffix(".o")) for source in sources]
        pairs = [pair for pair in zip(sources, parts, strict=True) if pair[0] not in known]
        _compile(*([*command, "-c", str(source), "-o", str(part)] for source, part in pairs))
    _compile([*command, SHARED, *map(str, parts), "-o", str(library), "-lm"])
    if not library.is_file():
        raise EngineError("the compiler failed: it makes no library", compiler.command[0])


def preprocessed(compiler: Compiler, flags: Sequence[str], source: Path) -> str:
    """Return a source file with all that it includes, as the compiler takes it."""
    text = source.with_suffix(".i")
    _compile([*compiler.command, *flags, "-E", "-P", str(source), "-o", str(text)])
    if not text.is_file():
        raise EngineError("the compiler failed: it preprocesses nothing", compiler.command[0])
    return text.read_text(encoding="utf-8", errors="replace")


def _compile(*commands: Sequence[str]) -> None:
    for words, done in zip(commands, _call(MOST_SECONDS, *commands), strict=True):
        if done.returncode != 0:
            said = [line for line in done.stderr.splitlines() if "error" in line] or [done.stderr]
            why = one_line(said[0].strip())[:MOST_SAID] or f"exit status {done.returncode}"
            raise EngineError(f"the compiler failed: {why}", words[0])


def _call(seconds: float, *commands: Sequence[str]) -> list[subprocess.CompletedProcess[str]]:
    """Run commands side by side, without input and without a shell."""
    running: list[subprocess.Popen[str]] = []
    try:
        with ExitStack() as stack:
            try:
                for words in commands:
                    running.append(stack.enter_context(subprocess.Popen(words, **_ALONE)))
                said = [process.communicate(timeout=seconds) for process in running]
            except BaseException:  # it takes too long, or Ctrl-C: its children hold the pipes, too
                for process in (one for one in running if one.returncode is None):
                    with suppress(ProcessLookupError):
                        os.killpg(process.pid, signal.SIGKILL)
                raise
        done = zip(commands, running, said, strict=True)
        return [subprocess.CompletedProcess(w, p.returncode, *texts) for w, p, texts in done]
    except subprocess.TimeoutExpired as error:
        what = f"the compiler takes more than {seconds:g} s"
        raise EngineError(what, commands[0][0]) from error
    except (OSError, subprocess.SubprocessError) as error:
        why = getattr(error, "strerror", None) or type(error).__name__
        raise EngineError(f"the compiler does not run ({why})", commands[0][0]) from error


@cache
def processor() -> str:
    """Return the kind and instructions of the processor, on which compiled code depends."""
    kind = [sys.platform, platform.machine(), platform.processor()]
    try:
        cpuinfo = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return "\n".join(kind)
    first: dict[str, str] = {}  # of the first processor listed
    for line in cpuinfo.splitlines():
        key, _, value = line.partition(":")
        if key.strip().lower() in _INSTRUCTIONS:
            first.setdefault(key.strip().lower(), value.strip())
    return "\n".join([*kind, *(f"{key}: {value}" for key, value in sorted(first.items()))])
