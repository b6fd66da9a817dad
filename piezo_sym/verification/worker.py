"""The process in which systems are examined: ``python -m piezo_sym.verification.worker``.

Input: subjects on stdin, one per line.  Output: messages on stdout in the same form, then an empty
line.  What is written to stdout by anything else goes to stderr.
"""

from __future__ import annotations

import base64
import gc
import pickle
import resource
import signal
import sys

from piezo_sym.verification.process import END, answer, packed

#: Bytes of address space; no system that is decided in time needs as much.
MEMORY = 8 << 30


def main() -> None:
    """Answer until stdin ends; Ctrl-C is left to the parent process, which ends stdin."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    limit = MEMORY if most == resource.RLIM_INFINITY else min(MEMORY, most)
    resource.setrlimit(resource.RLIMIT_AS, (limit, most))
    gc.set_threshold(100_000, 50, 100)  # what is made of a large system is not garbage
    given, out = sys.stdin.buffer, sys.stdout.buffer
    sys.stdout = sys.stderr
    import piezo_sym.verification.examine  # noqa: F401  # while the caller still reads its spec

    for number, line in enumerate(given):
        for message in answer(pickle.loads(base64.b64decode(line))):
            out.write(packed(message) + b"\n")
            out.flush()
        out.write(END)
        out.flush()
        if number == 0:  # imported modules stay: later collections skip them
            del message
            gc.collect()
            gc.freeze()


if __name__ == "__main__":
    main()
