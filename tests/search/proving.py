"""The package in a process of its own, which may hang, crash or be killed.

Input: a spec's text.  Output: the rows of `verify`, or why there are none.  Run as a program
(``python -m tests.search.proving``) it answers one request per line.
"""

import json
import os
import queue
import resource
import signal
import subprocess
import sys
import threading
from pathlib import Path

#: Rows about laws; the others cost more than they tell, or follow from these.
ROWS = ("temperature", "welldef", "continuous", "passive")
#: Seconds for one answer of a solver in the stage "laws".
PATIENCE = 1.0
ROOT = Path(__file__).parents[2]


class Prover:
    """A process that derives and verifies; it is started anew after it was killed."""

    def __init__(self, limit, stage="laws"):
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


def used():
    """Return the seconds of processor of this process and of its solvers, ended or not."""
    own = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    ticks = 0
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:  # it ended meanwhile
            continue
        if int(fields[1]) == os.getpid():
            ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK") + sum(part.ru_utime + part.ru_stime for part in own)


def of_laws(iphs):
    """Return the rows about laws, by solvers that are given little time each."""
    from piezo_sym.proofs import obligations, prove
    from piezo_sym.proofs.solvers import Opinions, solver

    asked, rows = Opinions(solver("z3", PATIENCE), solver("cvc5", PATIENCE)), []
    for obligation in obligations(iphs):
        if obligation.id in ROWS:
            rows.append(prove(obligation, iphs, rows, asked))
    return rows


def proved(text, until="laws"):
    """Return what the package says of a spec.

    Parameters
    ----------
    until : "laws", the prover on laws alone; "decide", the prover; "verify", all of it.
    """
    from piezo_sym import PiezoError, derive, verify
    from piezo_sym.proofs import decide
    from piezo_sym.spec.load import parse

    stages = {
        "laws": of_laws,
        "decide": lambda i: decide(i).rows,
        "verify": lambda i: verify(i).rows,
    }
    stage, began = "load", used()
    try:
        model = parse(text)
        stage = "derive"
        iphs = derive(model)
        stage = "verify"
        rows = stages[until](iphs)
    except PiezoError as error:
        return {"error": type(error).__name__, "text": str(error), "stage": stage}
    except Exception as error:  # whatever happens is a finding
        return {"error": f"crash: {type(error).__name__}", "text": str(error), "stage": stage}
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
    return {"rows": plain, "seconds": used() - began}


def main():
    """Answer requests until there are no more."""
    import piezo_sym.proofs  # noqa: F401 - before the clock runs

    print(json.dumps("ready"), flush=True)
    for line in sys.stdin:
        print(json.dumps(proved(*json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
