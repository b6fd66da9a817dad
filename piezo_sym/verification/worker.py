"""The process in which systems are examined: ``python -m piezo_sym.verification.worker``.

Input: subjects on stdin, each after its length.  Output: messages on stdout in the same form, until
``end``.  What is written to stdout by anything else goes to stderr.
"""

from __future__ import annotations

import gc
import pickle
import resource
import signal
import sys
from itertools import count

from piezo_sym.verification.process import answer, read, write

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

    for number in count():
        try:
            subject = pickle.loads(read(given))
        except EOFError:
            return
        for message in answer(subject):
            write(out, pickle.dumps(message))
        if number == 0:  # imported modules stay: later collections skip them
            del subject, message
            gc.collect()
            gc.freeze()


if __name__ == "__main__":
    main()
