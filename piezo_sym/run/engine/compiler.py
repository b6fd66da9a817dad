"""The C compilers of this machine, one call of them, and the processor that they compile for.

Input: the environment.  Output: `Compiler` records in the order in which they are tried: ``$CC``,
cc, gcc, clang, then the one of the `zig` extra; and shared libraries.
"""

import os
import platform
import shlex
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import final

from piezo_sym.errors import EngineError, one_line

#: No contraction: a product and a sum are rounded apart, as in NumPy, so that a residual and what
#: the ledger books are the same number, and a state at rest stays there.  Fused: 5 % less time.
COMMON = ("-std=c99", "-fPIC", "-shared", "-ffp-contract=off")
#: Functions of one library call each other directly: nobody replaces them.
DIRECT = "-fno-semantic-interposition"
#: For gcc: loops of a known number of turns, such as those over stages, are written out if small;
#: 8 % less time.
WRITTEN_OUT = (
    *("--param", "max-completely-peeled-insns=1000"),
    *("--param", "max-completely-peel-times=32"),
)
#: Nobody looks at the processor's flags of exceptions: both sides of a choice may be computed, so
#: that loops with choices become vectors. No number changes.
FASTEST = ("-O3", "-march=native", "-fopenmp-simd", "-fno-math-errno", "-fno-trapping-math")
#: Without the vectors of members, which not every compiler knows.
PLAIN = "-DPLAIN"
#: Flags, best first; the next are tried where a compiler refuses some.
FLAGS: tuple[tuple[str, ...], ...] = (
    (*FASTEST, DIRECT, *WRITTEN_OUT, *COMMON),
    (*FASTEST, DIRECT, *COMMON),
    ("-O3", "-fopenmp-simd", "-fno-math-errno", *COMMON),
    ("-O2", PLAIN, *COMMON),
)
#: Bounds on a compiler that hangs: asked for its version, and at work.
VERSION_SECONDS, MOST_SECONDS = 10.0, 120.0
#: How much of what a compiler says is told: a path, and the reason after it.
MOST_SAID = 400
#: Lines of /proc/cpuinfo that name instructions, on x86, ARM, RISC-V and POWER.
_INSTRUCTIONS = ("flags", "features", "isa", "cpu", "cpu part", "model name")


@final
@dataclass(frozen=True)
class Compiler:
    """A command that compiles C, and what it says of itself."""

    command: tuple[str, ...]
    version: str


def compilers() -> Iterator[Compiler]:
    """Yield the compilers that there are and that answer, best first."""
    commands = [*map(_found, (os.environ.get("CC", ""), "cc", "gcc", "clang"))]
    if find_spec("ziglang") is not None:
        commands.append((sys.executable, "-m", "ziglang", "cc"))
    for command in filter(None, dict.fromkeys(commands)):
        if version := _version(command):
            yield Compiler(command, version)


def passed_by(taken: Compiler) -> str:
    """Return what ``$CC`` says if it is not the compiler that was taken; nothing otherwise."""
    wanted = os.environ.get("CC", "").strip()
    return wanted if wanted and _found(wanted) != taken.command else ""


def _found(text: str) -> tuple[str, ...]:
    """Return a command with the path of its program, or nothing if there is none."""
    try:
        program, *options = shlex.split(text)
    except ValueError:  # no words, or a quote that is not closed
        return ()
    path = shutil.which(program)
    return (path, *options) if path else ()


@lru_cache(maxsize=16)
def _version(command: tuple[str, ...]) -> str:
    try:
        done = _call([*command, "--version"], VERSION_SECONDS)
    except EngineError:
        return ""
    return done.stdout if done.returncode == 0 else ""


def build(compiler: Compiler, flags: Sequence[str], sources: Sequence[Path], library: Path) -> None:
    """Compile source files into a shared library."""
    words = [*compiler.command, *flags, *map(str, sources), "-o", str(library), "-lm"]
    done = _call(words, MOST_SECONDS)
    if done.returncode != 0 or not library.is_file():
        said = [line for line in done.stderr.splitlines() if "error" in line] or [done.stderr]
        why = one_line(said[0].strip())[:MOST_SAID] or f"exit status {done.returncode}"
        raise EngineError(f"the compiler failed: {why}", compiler.command[0])


def _call(words: Sequence[str], seconds: float) -> subprocess.CompletedProcess[str]:
    """Run a command without input; its words are never read by a shell."""
    try:
        with subprocess.Popen(
            words,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            start_new_session=True,
        ) as running:
            try:
                out, err = running.communicate(timeout=seconds)
            except BaseException:  # it takes too long, or Ctrl-C: its children hold the pipes, too
                with suppress(ProcessLookupError):
                    os.killpg(running.pid, signal.SIGKILL)
                raise
        return subprocess.CompletedProcess(words, running.returncode, out, err)
    except subprocess.TimeoutExpired as error:
        raise EngineError(f"the compiler takes more than {seconds:g} s", words[0]) from error
    except (OSError, subprocess.SubprocessError) as error:
        why = getattr(error, "strerror", None) or type(error).__name__
        raise EngineError(f"the compiler does not run ({why})", words[0]) from error


@cache
def processor() -> str:
    """Return the kind and instructions of the processor, which compiled code depends on."""
    found = [sys.platform, platform.machine(), platform.processor()]
    try:
        cpuinfo = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return "\n".join(found)
    known: dict[str, str] = {}  # of the first processor listed
    for line in cpuinfo.splitlines():
        key, _, value = line.partition(":")
        if key.strip().lower() in _INSTRUCTIONS:
            known.setdefault(key.strip().lower(), value.strip())
    return "\n".join([*found, *(f"{key}: {value}" for key, value in sorted(known.items()))])
