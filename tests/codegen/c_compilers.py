"""The C compilers of this machine, by name, for tests that are run with each of them.

Output: `COMPILERS`, name to command.  With none there is `cc`, and every such test fails: a test
that is not run is no evidence.
"""

import shutil
import subprocess
import sys
from importlib.util import find_spec
from platform import machine

COMPILERS = {name: (name,) for name in ("gcc", "clang") if shutil.which(name)}
if find_spec("ziglang"):
    COMPILERS["zig"] = (sys.executable, "-m", "ziglang", "cc")
COMPILERS = COMPILERS or {"cc": ("cc",)}

#: Those that come with the address sanitizer.
SANITIZING = [name for name in COMPILERS if name != "zig"]
#: The names of its shared library, which a sanitized one needs when Python loads it.
RUNTIMES = {
    "gcc": ("libasan.so",),
    "cc": ("libasan.so",),
    "clang": (f"libclang_rt.asan-{machine()}.so", "libclang_rt.asan.so"),
}


def runtime(name):
    """Return the path of a compiler's shared library of the address sanitizer, if it has one."""
    for file in RUNTIMES[name]:
        words = [*COMPILERS[name], f"-print-file-name={file}"]
        said = subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip()
        if said != file:
            return said
    return None
