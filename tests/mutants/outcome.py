"""What became of a mutant: what it says wrongly, and who notices.

Input: what is said of its spec without it, and with it.  Output: one line.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tests.mutants.mutant import Mutant

Said = Mapping[str, Any]
ROWS = ("system", "energy", "all rows")


def outcome(mutant: Mutant, was: Said, now: Said) -> str:
    """Return the line of a mutant: its file and name, what is wrong, and what notices it."""
    return f"{mutant.file} | {mutant.name} | {' | '.join(_found(was, now))}"


def _found(was: Said, now: Said) -> tuple[str, str]:
    """Return what is wrongly proved or derived, and what notices it."""
    if "crash" in now:
        return "-", f"CRASH {now['crash']}"
    proved, before = (_proved(said) for said in (now, was))
    wrong = [key for key in now["rows"] if key in proved and key not in before]
    missing = [key for key in was["rows"] if _words(key) not in map(_words, now["rows"])]
    what = [_words(key) for key in wrong] + [f"{_words(key)} is missing" for key in missing]
    what += ["another system"] * (now["system"] != was["system"])
    if "refused" in was:
        what = ["a system that is refused"]
    if not what:
        return "-", "HARMLESS" if before - proved else "NOTHING"
    return ", ".join(what), ", ".join(_killers(now, what)) or "SURVIVED"


def _proved(said: Said) -> set[tuple[str, str]]:
    rows = {key for key, verdict in said["rows"].items() if verdict == "PROVED"}
    return {key for key in rows if key[0] != "program"}


def _killers(now: Said, what: list[str]) -> Iterator[str]:
    """Yield what notices that something is wrong."""
    if now["net"]:
        yield "net"
    refused = list(now["checked"]["refused"])
    claimed = [words for words in refused if f"{words}, ".startswith(tuple(_claims(what)))]
    if claimed:
        yield "checker"
    if now["rows"].get(("program", "")) != "PROVED":
        yield "program"
    refuted = [k for k, v in now["rows"].items() if v == "REFUTED" and k[0] != "program"]
    if "system" in " ".join(what) and refuted:
        yield f"own row {_words(refuted[0])}"


def _claims(what: list[str]) -> Iterator[str]:
    """Yield the rows that the checker must not confirm."""
    for words in what:
        if words.endswith(" is missing"):
            yield f"{words.removesuffix(' is missing')}, "
        elif words.endswith(("another system", "is refused")):
            yield from ROWS
        else:
            yield f"{words}, "


def _words(key: tuple[str, str]) -> str:
    return " ".join(key).rstrip()
