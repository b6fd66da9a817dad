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
from contextlib import suppress
from dataclasses import replace
from time import monotonic

from piezo_sym.processes import THRESHOLDS
from piezo_sym.verification.process import END, answer, packed
from piezo_sym.verification.protocol import Progress

#: The limit of the address space [byte], more than any system needs that is decided in time.
MEMORY = 8 << 30
#: The shortest time limit [s].
LEAST = 0.1


def main() -> None:
    """Answer until stdin ends; Ctrl-C is left to the parent process, which ends stdin."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    limit = MEMORY if most == resource.RLIM_INFINITY else min(MEMORY, most)
    resource.setrlimit(resource.RLIMIT_AS, (limit, most))
    gc.set_threshold(*THRESHOLDS)
    given, out = sys.stdin.buffer, sys.stdout.buffer
    sys.stdout = sys.stderr
    import piezo_sym.verification.examine  # noqa: F401  # now: the caller still reads its spec
    from piezo_sym.proofs.solvers import solver
    from piezo_sym.report import Report
    from piezo_sym.version import sources_hash

    with suppress(OSError):  # the first query tries again
        solver("z3").worker.start()  # imports z3 meanwhile

    sources = sources_hash()
    for number, line in enumerate(given):
        request, begun = pickle.loads(base64.b64decode(line)), monotonic()
        for message in answer(request):
            if isinstance(message, Report):
                message = replace(message, sources=sources)
            out.write(packed(message) + b"\n")
            out.flush()
            if isinstance(message, Progress):
                left = begun + request.seconds - monotonic()
                end_after(left * message.part if message.part < 1 else 0.0)
        end_after(0.0)
        out.write(END)
        out.flush()
        if number == 0:  # imported modules stay: later collections skip them
            del message
            gc.collect()
            gc.freeze()


def end_after(seconds: float) -> None:
    """End this process after some seconds, unless this is called again before; 0 for never.

    The operating system ends it: Python cannot interrupt one long operation, as a large power.
    """
    signal.setitimer(signal.ITIMER_REAL, max(seconds, LEAST) if seconds else 0.0)


if __name__ == "__main__":
    main()
