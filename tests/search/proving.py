"""The package in a process of its own, which may hang, crash or be killed.

Input: a spec's text.  Output: the rows of `verify`, or why there are none.  Run as a program
(``python -m tests.search.proving``) it answers one request per line.
"""

import json
import os
import queue
import signal
import subprocess
import sys
import threading
import time
from itertools import pairwise
from pathlib import Path

ROOT = Path(__file__).parents[2]


class Prover:
    """A process that derives and verifies; it is started anew after it was killed."""

    def __init__(self, limit, stage="decide"):
        self.limit, self.stage, self.process, self.lines = limit, stage, None, None

    def rows(self, text):
        """Return {"rows": ...}, or {"error": type, "text": ..., "stage": ...}, and the seconds."""
        if self.process is None or self.process.poll() is not None:
            self._start()
        self.process.stdin.write(json.dumps([text, self.stage]) + "\n")
        self.process.stdin.flush()
        try:
            line = self.lines.get(timeout=self.limit)
        except queue.Empty:
            self.close()
            return {"error": "time", "text": f"over {self.limit} s", "stage": "verify"}
        if not line:
            self.close()
            return {"error": "died", "text": "the process ended", "stage": "verify"}
        return json.loads(line)

    def _start(self):
        words = [sys.executable, "-m", "tests.search.proving"]
        pipe = subprocess.PIPE
        env = {**os.environ, "PYTHONPATH": str(ROOT)}
        self.process = subprocess.Popen(
            words, stdin=pipe, stdout=pipe, text=True, cwd=ROOT, env=env, start_new_session=True
        )
        self.lines = queue.Queue()
        threading.Thread(target=_read, args=(self.process.stdout, self.lines), daemon=True).start()
        self.lines.get(timeout=60)  # it has imported what it needs

    def cpu(self):
        """Return the seconds of processor that the process and its solvers have used so far."""
        ticks = 0
        for stat in Path("/proc").glob("[0-9]*/stat") if self.process else ():
            try:
                fields = stat.read_text().rpartition(")")[2].split()
            except OSError:  # it ended meanwhile
                continue
            if int(fields[2]) == self.process.pid:
                ticks += int(fields[11]) + int(fields[12])
        return ticks / os.sysconf("SC_CLK_TCK")

    def close(self):
        """End the process and the solvers that it started."""
        if self.process is not None:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()
            self.process.stdin.close()
            self.process = None


def _read(stream, lines):
    for line in stream:
        lines.put(line)
    lines.put("")
    stream.close()


def proved(text, until="decide"):
    """Return what the package says of a spec: the prover alone ("decide"), or all ("verify")."""
    from piezo_sym import derive, verify
    from piezo_sym.errors import PiezoError
    from piezo_sym.proofs import decide
    from piezo_sym.spec.load import parse

    times, stage = [time.perf_counter()], "load"
    try:
        model = parse(text)
        stage = "derive"
        iphs = derive(model)
        times.append(time.perf_counter())
        stage = "verify"
        rows = (decide if until == "decide" else verify)(iphs).rows
    except PiezoError as error:
        return {"error": type(error).__name__, "text": str(error), "stage": stage}
    except Exception as error:  # whatever happens is a finding
        return {"error": f"crash: {type(error).__name__}", "text": str(error), "stage": stage}
    times.append(time.perf_counter())
    plain = [
        {
            "id": row.id,
            "element": row.element,
            "verdict": row.verdict.value,
            "witness": dict(row.witness) if row.witness else None,
            "reason": row.reason,
        }
        for row in rows
        if row.id != "units"
    ]
    return {"rows": plain, "seconds": [b - a for a, b in pairwise(times)]}


def main():
    """Answer requests until there are no more."""
    import piezo_sym.proofs  # noqa: F401 - before the clock runs

    print(json.dumps("ready"), flush=True)
    for line in sys.stdin:
        print(json.dumps(proved(*json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
