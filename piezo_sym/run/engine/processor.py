"""What this processor can do: code compiled for it may not run on another.

Input: nothing.  Output: text that differs between processors with different instructions.
"""

import platform
import subprocess
import sys
from functools import cache
from pathlib import Path

#: Lines of /proc/cpuinfo that name instructions, on x86, ARM, RISC-V and POWER.
KEYS = ("flags", "features", "isa", "cpu", "cpu part", "model name")


@cache
def processor() -> str:
    """Return the processor's kind and its instructions."""
    found = [sys.platform, platform.machine(), platform.processor()]
    try:
        found += _lines(Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace"))
    except OSError:
        found += _asked()
    return "\n".join(found)


def _lines(cpuinfo: str) -> list[str]:
    """Return what the first processor listed says of its instructions."""
    known: dict[str, str] = {}
    for line in cpuinfo.splitlines():
        key, _, value = line.partition(":")
        if key.strip().lower() in KEYS:
            known.setdefault(key.strip().lower(), value.strip())
    return [f"{key}: {value}" for key, value in sorted(known.items())]


def _asked() -> list[str]:
    """Return what macOS says of its processor; nothing elsewhere."""
    if sys.platform != "darwin":
        return []
    try:
        words = ["/usr/sbin/sysctl", "machdep.cpu", "hw.optional"]
        done = subprocess.run(words, capture_output=True, text=True, timeout=10, check=False)
    except (OSError, subprocess.SubprocessError):
        return []
    return done.stdout.splitlines()
