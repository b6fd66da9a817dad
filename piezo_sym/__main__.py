"""The process of the command ``piezo-sym``, from its start to its exit.

Input: the words of a command line.  Output: what `piezo_sym.cli` makes of them.
"""

import gc
import os
import signal
import sys
from contextlib import suppress
from pathlib import Path

from piezo_sym.errors import PiezoError
from piezo_sym.interrupts import STOPPED
from piezo_sym.processes import THRESHOLDS


def main() -> None:
    """Run the command line and exit with its code; SIGTERM stops it as Ctrl-C does."""
    gc.set_threshold(*THRESHOLDS)
    sys.stdout = sys.stdout or open(os.devnull, "w")  # noqa: SIM115 - it was closed
    try:
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        start_examiner(sys.argv[1:])
        from piezo_sym.cli import run

        code = run(sys.argv[1:])
    except KeyboardInterrupt:  # before the command has begun
        sys.exit(STOPPED)
    except RuntimeError as error:  # or while a class was made
        if not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        sys.exit(STOPPED)
    gc.freeze()  # the system takes back the memory of all objects at once
    sys.exit(code)


def start_examiner(words: list[str]) -> None:
    """Start the process that proves, if a command will need it: it imports while this one does."""
    if "--help" in words:
        return
    file = next((word for word in words if word.endswith(".toml")), "")
    if words[:1] in (["verify"], ["generate"]) or (words[:1] == ["simulate"] and _is_new(file)):
        from piezo_sym.verification.process import started

        with suppress(OSError):  # the command tries again
            started()


def _is_new(file: str) -> bool:
    """Return whether a spec file was never loaded, nor one that differs from it in values alone."""
    from piezo_sym.module_cache import was_loaded
    from piezo_sym.spec.source import MODELS, data, read
    from piezo_sym.spec.values import without_values

    path = Path(file)
    with suppress(PiezoError, OSError, ValueError):  # the command says so
        if path.is_file() and path.parent != MODELS:  # a pipe can be read once
            content = data(read(path))
            return not (was_loaded(content) or was_loaded(without_values(content)))
    return False


if __name__ == "__main__":
    main()
