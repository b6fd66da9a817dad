"""Model to generated files: render, write, and compare.

Input: a `Model`.  Output: the files of its generated module, or a list of what has drifted.
``generate --check`` and its test share `drift`.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import final

from piezo_sym.codegen import (
    MARK,
    c_header,
    c_source,
    c_step,
    lower,
    numpy_module,
    start_of,
    step_of,
)
from piezo_sym.derivation import derive
from piezo_sym.errors import DriftError
from piezo_sym.files import path_of, path_text, read_text, write_together
from piezo_sym.proofs import Report, Verdict, proofs_json, smt2
from piezo_sym.spec.load import load
from piezo_sym.spec.model import Model
from piezo_sym.spec.source import shipped
from piezo_sym.verification import verify
from piezo_sym.version import VERSION

#: What a generated file says of itself; only such files are ever called left over.
MADE = re.compile(rf"^\W*(?:made\W*)?{MARK} \S+; do not edit: ", re.MULTILINE)


@final
@dataclass(frozen=True)
class Drift:
    """A generated file that is not what its spec gives: missing, changed, or left over."""

    path: Path
    fault: str
    diff: str = ""


def shipped_models() -> tuple[Model, ...]:
    """Return the models of all shipped specs."""
    return tuple(load(name) for name in shipped())


def render(
    model: Model, *, allow_unproved: bool = False, report: Report | None = None
) -> dict[str, str]:
    """Return the text of each generated file of a model, by its path below the output folder.

    Parameters
    ----------
    model : from `load`, or made in Python.
    allow_unproved : render even if a required property is not proved.
    report : its verdicts, if they are known already.

    Raises
    ------
    ProofError
        If a required property is refuted or open, unless `allow_unproved`.
    NetworkError, SpecError
        If the model cannot be derived.
    """
    iphs = derive(model)
    report = report or verify(iphs)
    if not allow_unproved:
        report.raise_if_not_proved()
    program = lower(iphs, verdict_line(report))
    step, declared = c_step(program, step_of(iphs, odd_laws(report)), start_of(iphs))
    made = f"{MARK} {VERSION}; do not edit: change the spec, then run `piezo-sym generate`."
    return {
        f"{model.name}/{model.name}.py": numpy_module(program),
        f"{model.name}/{model.name}.h": c_header(program, declared),
        f"{model.name}/{model.name}.c": c_source(program, step),
        f"{model.name}/proofs.json": proofs_json(report, model, made),
        f"{model.name}/proofs.smt2": smt2(report, made),
    }


def odd_laws(report: Report) -> frozenset[str]:
    """Return the elements whose dissipative laws are proved odd: a step averages them."""
    rows = [row for row in report.rows if row.id == "odd" and row.verdict is Verdict.PROVED]
    return frozenset(row.element for row in rows)


def verdict_line(report: Report) -> str:
    """Return the verdict on a model in one line, for the head of its files."""
    failed = [f"{row.id} {row.verdict.value}" for row in report.failures]
    if failed:
        return f"NOT PROVED ({', '.join(failed)})"
    proved = dict.fromkeys(row.id for row in report.rows if row.verdict is Verdict.PROVED)
    return f"{', '.join(proved)} PROVED"


def generate(
    model: Model, out: str | Path = "generated", *, allow_unproved: bool = False
) -> tuple[Path, ...]:
    """Write a model's generated files, and return their paths.

    Parameters
    ----------
    model : from `load`, or made in Python.
    out : folder; the files go to ``<out>/<model>/``.
    allow_unproved : write even if a required property is not proved; the files then say so.

    Raises
    ------
    ProofError
        If a required property is refuted or open; nothing is written then.
    FileError
        If a file cannot be written.
    """
    folder = path_of(out, "generate.out")
    files = render(model, allow_unproved=allow_unproved)
    write_together({folder / name: text.encode() for name, text in files.items()})
    return tuple(folder / name for name in files)


def drift(
    models: Iterable[Model],
    out: str | Path = "generated",
    *,
    complete: bool = False,
    allow_unproved: bool = False,
) -> tuple[Drift, ...]:
    """Return the generated files that are not what the models give.

    Parameters
    ----------
    models : the models whose files to compare.
    out : the folder with the generated files.
    complete : whether files of any other model in `out` are left over, too.
    allow_unproved : as for `generate`.
    """
    expected: dict[Path, str] = {}
    for model in models:
        for name, text in render(model, allow_unproved=allow_unproved).items():
            expected[Path(out) / name] = text
    found = [fault for path, text in expected.items() for fault in _compare(path, text)]
    folders = [Path(out)] if complete else sorted({path.parent for path in expected})
    return tuple([*found, *_left_over(folders, expected)])


def _compare(path: Path, text: str) -> Iterator[Drift]:
    present = read_text(path)
    if present is None:
        yield Drift(path, "is missing")
    elif present != text:
        lines = present.splitlines(), text.splitlines()
        diff = difflib.unified_diff(*lines, f"{path} (present)", f"{path} (from the spec)", n=2)
        yield Drift(path, "differs from its spec", "\n".join(line.rstrip("\n") for line in diff))


def _left_over(folders: Iterable[Path], expected: dict[Path, str]) -> Iterator[Drift]:
    for folder in folders:
        for path in sorted(folder.rglob("*")):
            if path in expected or not path.is_file() or "__pycache__" in path.parts:
                continue
            if MADE.search(_start(path)):
                yield Drift(path, "belongs to no spec given")


def _start(path: Path) -> str:
    try:
        with path.open("rb") as file:
            return file.read(4000).decode("utf-8", errors="replace")
    except OSError:  # a file that cannot be read is none that was made here
        return ""


def raise_if_drifted(found: Iterable[Drift], command: str) -> None:
    """Raise on the first drifted file; `command` is what brings the files up to date.

    Raises
    ------
    DriftError
        Naming the file and the remedy.
    """
    faults = list(found)
    if faults:
        more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
        left = faults[0].fault.startswith("belongs")
        delete = "delete it, or name its spec on the command line"
        remedy = delete if left else f"run `{command}` and commit the result"
        raise DriftError(f"{faults[0].fault}{more}", path_text(faults[0].path), remedy=remedy)
