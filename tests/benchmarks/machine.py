"""Where a benchmark was measured.

Input: this machine.  Output: a `Machine`: processor, cores, system, compiler, versions, date.
"""

from __future__ import annotations

import os
import platform
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import final

from piezo_sym.run.engine.compiler import compilers
from piezo_sym.version import VERSION

ALWAYS = ("numpy", "scipy", "sympy", "xarray")


@final
@dataclass(frozen=True)
class Machine:
    """A machine, and the versions of what was measured on it, as (name, version)."""

    processor: str
    cores: int
    system: str
    compiler: str
    python: str
    versions: tuple[tuple[str, str], ...]
    date: str


def machine(packages: Iterable[str] = ()) -> Machine:
    """Return this machine, with the versions of packages where they are installed."""
    compiler = next(compilers(), None)
    return Machine(
        processor=_processor(),
        cores=_cores(),
        system=f"{platform.system()} {platform.machine()}",
        compiler=compiler.version.splitlines()[0] if compiler else "none",
        python=platform.python_version(),
        versions=(("piezo_sym", VERSION), *_versions((*ALWAYS, *packages))),
        date=datetime.now(tz=UTC).date().isoformat(),
    )


def installed(package: str) -> str:
    """Return the version of a package, or nothing if it is not installed."""
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


def _versions(packages: Iterable[str]) -> tuple[tuple[str, str], ...]:
    found = ((name, installed(name)) for name in dict.fromkeys(packages))
    return tuple((name, number) for name, number in found if number)


def _processor() -> str:
    """Return the processor's name: Linux tells it in a file, others through Python."""
    path = Path("/proc/cpuinfo")
    lines = path.read_text(encoding="utf-8").splitlines() if path.is_file() else []
    named = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return next(iter(named), platform.processor() or platform.machine())


def _cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
