"""Slices of the search: specs drawn, verified and judged, counted in one line per slice.

Input: the number of a slice.  Output: a record as plain data, the same for the same number and the
same package.
"""

import time
import tomllib
from collections import Counter

import tomli_w

from piezo_sym import PiezoError
from piezo_sym.expressions.parse import parse_condition, parse_law
from tests.search.judge import Fault, judge
from tests.search.laws import read
from tests.search.shrink import shrunk
from tests.search.specs import LAWS, draw

SPECS = 10
#: Names that are refused together are drawn anew so often.
ATTEMPTS = 8
BAD = ("false PROVED", "false REFUTED", "contradiction", "crash", "false label", "doubtful PROVED")


def fit(text):
    """Return whether the package reads a law or a condition."""
    try:
        compared = read(text)[0] in {"<", "<=", ">", ">="}
        (parse_condition if compared else parse_law)(text, "law")
    except PiezoError:
        return False
    return True


def slice_of(number, prover, specs=SPECS, laws=LAWS):
    """Return the record of a slice."""
    record = {"slice": number, "specs": 0, "laws": 0, "faults": [], "seconds": {}}
    counts, seconds = Counter(), Counter()
    for n in range(specs):
        found = _one(f"{number}.{n}", prover, laws, counts, seconds)
        record["specs"] += 1
        record["laws"] += laws
        record["faults"] += found
    record["counts"] = dict(sorted(counts.items()))
    record["seconds"] = {name: round(value, 2) for name, value in seconds.items()}
    return record


def _one(seed, prover, laws, counts, seconds):
    """Return the faults of one spec."""
    for attempt in range(ATTEMPTS):
        clock = time.process_time()
        made = draw(f"{seed}.{attempt}", fit, laws)
        seconds["draw"] += time.process_time() - clock
        clock = time.perf_counter()
        answer = prover.rows(made.text)
        seconds["prove: wall"] += time.perf_counter() - clock
        seconds["prove"] += answer.get("seconds", 0)
        if answer.get("stage") not in {"load", "derive"} or "crash" in answer["error"]:
            break
        counts["refused"] += 1
        counts[f"refused: {answer['text'][-60:]}"] += 1
    clock = time.process_time()
    faults = verdicts(made.text, answer, counts, made.labels)
    seconds["oracle"] += time.process_time() - clock
    return [{**vars(fault), "seed": f"{seed}.{attempt}", "spec": made.text} for fault in faults]


def verdicts(text, answer, counts, labels=None):
    """Return the faults in an answer on a spec, and count its verdicts."""
    if "rows" in answer:
        faults, found = judge(text, answer["rows"], labels=labels)
        counts.update(found)
        return faults
    kind = answer["error"].split(":")[0]
    counts[kind] += 1
    if kind in {"time", "died"}:
        return [Fault(kind, "", "", answer["text"])]
    if answer["stage"] != "verify" and kind != "crash":
        return []
    kind = "contradiction" if kind == "ContradictionError" else "crash"
    return [Fault(kind, "", "", f"{answer['error']}: {answer['text']}")]


def still_at_fault(fault, prover):
    """Return the test of whether a spec, as data, has a fault of the same kind."""

    def test(data):
        try:
            answer = prover.rows(tomli_w.dumps(data))
            found = verdicts(tomli_w.dumps(data), answer, Counter())
        except (ValueError, KeyError, StopIteration, IndexError):  # not read
            return False
        return any((f.kind, f.id) == (fault["kind"], fault["id"]) for f in found)

    return test


def keep(fault, folder, prover, seconds=120):
    """Write a fault's spec, made small, into a folder, and return its path."""
    still = still_at_fault(fault, prover)
    data = shrunk(tomllib.loads(fault["spec"]), still, seconds, fault["element"])
    text = tomli_w.dumps(data)
    answer = prover.rows(text)
    found = [f for f in verdicts(text, answer, Counter()) if f.kind == fault["kind"]]
    head = f"# {fault['kind']}: {fault['id']} (seed {fault['seed']})\n"
    head += "".join(f"# {f.id} {f.element}: {f.at}\n".replace("\n# ", " ") for f in found[:2])
    name = f"{fault['kind']}_{fault['id']}_{fault['seed']}".replace(" ", "_").replace(".", "_")
    path = folder / f"{name.lower()}.toml"
    path.write_text(head + text)
    return path
