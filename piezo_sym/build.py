"""Model to generated files: render, write, and compare.

Input: a `Model`.  Output: the files of its generated module, or a list of what has drifted.
``generate --check`` and its test share `drift`.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, final

from piezo_sym.errors import DriftError, ProofError, UsageError, quote
from piezo_sym.files import folder_entries, path_of, path_text, read_bytes, write_together
from piezo_sym.module_cache import MODULE, PROVED, REFUTED, SHAPE, keep, kept
from piezo_sym.report import Report, Verdict, proofs_json, report_of, smt2
from piezo_sym.spec.source import shipped
from piezo_sym.spec.values import Template, shape_hash
from piezo_sym.verification.process import examining
from piezo_sym.version import MADE

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model

#: The path of the verdicts on a model of some name.
PROOFS = "{}/proofs.json"
MISSING, DIFFERS, ENDS = "is missing", "differs from its spec", "has other line ends than \\n"
LINK, LEFT = "is no regular file or folder", "belongs to no spec given"

#: The hash of a spec, which all its files have.
HASH = re.compile(r"\b[0-9a-f]{64}\b")


@final
@dataclass(frozen=True)
class Drift:
    """A path below the output folder that is not what the specs give, and how it differs."""

    path: Path
    fault: str
    diff: str = ""

    def remedy(self, command: str) -> str:
        """Return what to do; `command` is what brings the files up to date."""
        if self.fault == LEFT:
            return "delete it, or name its spec on the command line"
        first = "delete it, then " if self.fault == LINK else ""
        return f"{first}run `{command}` and commit the result"


def shipped_models() -> tuple[Model, ...]:
    """Return the models of all shipped specs."""
    from piezo_sym.spec.load import load

    return tuple(load(name) for name in shipped())


def render(model: Model, *, allow_unproved: bool = False) -> Mapping[str, str]:
    """Return the text of each generated file of a model, by its path below the output folder.

    A model that is not proved is refused, unless `allow_unproved`.
    """
    report, files = report_and_files(model, allow_unproved=allow_unproved)
    if not (allow_unproved and f"{model.name}/{model.name}.py" in files):
        report.raise_if_not_proved()
    return files


def report_and_files(
    model: Model, *, allow_unproved: bool = False
) -> tuple[Report, Mapping[str, str]]:
    """Return the verdicts on a model, and the text of each file that is generated of it.

    Results are kept, so that an equal model is not examined again. There are only the files of
    verdicts if the time was too short to print the module, or if a model is known to be refuted;
    with `allow_unproved` it is printed all the same.
    """
    for kind in (PROVED,) if allow_unproved else (REFUTED, PROVED):
        if found := kept_results(model, kind):
            return found
    report, template = report_and_texts(model)
    return report, keep_results(model, report, template)


def kept_results(model: Model, kind: str) -> tuple[Report, Mapping[str, str]] | None:
    """Return the verdicts on a model, and its files, as they are kept; None if they are not."""
    files = kept(model.key, kind) or {}
    proofs = files.get(PROOFS.format(model.name))
    return (report_of(proofs), files) if proofs else None


def refuse_unproved(report: Report) -> None:
    """Raise if a required property is not proved; the remedy says how to run the model anyway."""
    try:
        report.raise_if_not_proved()
    except ProofError as error:
        command = "piezo-sym generate --allow-unproved"
        error.remedy += f"; or `{command}` writes it all the same, for a run"
        error.remedy += ", which needs --method LSODA where entropy is consumed"
        raise


def report_and_texts(
    model: Model, meanwhile: Callable[[Template], AbstractContextManager[None]] | None = None
) -> tuple[Report, Template | None]:
    """Return the verdicts on a model, and the template of its texts, with the verdict in it.

    The template is None if the time was too short to print the texts.

    Parameters
    ----------
    meanwhile : a context for the time from the texts to the verdicts, such as compiling ahead.
    """
    template = None
    with examining(model) as (texts, verdicts):
        with suppress(ProofError):
            template = _with_standalone_step(texts.result(), model.name)
        with meanwhile(template) if template and meanwhile else nullcontext():
            report = verdicts.result()
    return report, template and replace(template, verdict=verdict_line(report))


def keep_results(model: Model, report: Report, template: Template | None) -> dict[str, str]:
    """Return the text of each generated file of a model; they are kept if it is proved or refuted.

    If a row was not decided in time, the module is kept, but not the verdicts.
    """
    files = files_of(model, report, template)
    if report.refuted:
        keep(model.key, REFUTED, files_of(model, report, None), report.sources)
    if template and report.proved:
        data = model.flatten().model_dump()
        keep(shape_hash(data), SHAPE, asdict(template), report.sources)
        keep(model.sha256, MODULE, template.filled(data), report.sources)
        if report.decided:
            keep(model.key, PROVED, files, report.sources)
    return files


def _with_standalone_step(made: Template, name: str) -> Template:
    """Return the texts of a module as they are written: programs in C can take its step alone."""
    from piezo_sym.run.engine.c_sources import standalone_step

    step = made.files["_step.c"]
    return replace(made, files={**made.files, "_step.c": step + standalone_step(name, step)})


def files_of(model: Model, report: Report, template: Template | None) -> dict[str, str]:
    """Return the text of each generated file of a model; without a template, of its verdicts."""
    texts = template.filled(model.flatten().model_dump()) if template else {}
    return {
        **{f"{model.name}/{model.name}{ending}": text for ending, text in texts.items()},
        PROOFS.format(model.name): proofs_json(report, model, MADE),
        f"{model.name}/proofs.smt2": smt2(report, MADE),
    }


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
    UsageError
        If `model` is no `Model`, or a model whose name differs only by case is there.
    """
    from piezo_sym.spec.model import Model  # loads pydantic

    if not isinstance(model, Model):
        remedy = "load it first: generate(load('piezo_stack'))"
        raise UsageError(f"{quote(model)} is no Model", "generate", remedy=remedy)
    folder = path_of(out, "generate.out")
    refuse_case([model.name], folder)
    files = render(model, allow_unproved=allow_unproved)
    write_together({folder / name: text.encode() for name, text in files.items()})
    return tuple(folder / name for name in files)


def refuse_case(models: Sequence[str], out: Path) -> None:
    """Raise `UsageError` where names of models, or folders there, differ only by case."""
    known = [entry.name for entry in folder_entries(out)] if out.is_dir() else []
    for name in models:
        for other in (*known, *models):
            if other != name and other.casefold() == name.casefold():
                what = f"{quote(name)} and {quote(other)} differ only by case"
                remedy = "rename a model: names become files"
                raise UsageError(what, "generate", remedy=remedy)


def drift(
    models: Iterable[Model],
    out: str | Path = "generated",
    *,
    complete: bool = False,
    allow_unproved: bool = False,
) -> tuple[Drift, ...]:
    """Return what is below a folder and is not, byte for byte, what the models give.

    Their own folders are compared, or, if they are `complete`, all that is in `out`.
    """
    root, expected = path_of(out, "generate.out"), {}
    for model in models:
        for name, text in render(model, allow_unproved=allow_unproved).items():
            expected[root / name] = text.encode()
    found = [fault for path, data in expected.items() for fault in _compare(path, data)]
    folders = [root] if complete else sorted({path.parent for path in expected})
    left = [fault for folder in folders for fault in _others(folder, expected)]
    return tuple([*found, *left])


def _compare(path: Path, data: bytes) -> Iterator[Drift]:
    odd = _is_odd(path) or path.is_dir()
    present = None if odd else read_bytes(path)
    if present is None:
        yield Drift(path, LINK if odd else MISSING)
    elif present.splitlines() == data.splitlines() and present != data:
        yield Drift(path, ENDS)
    elif present != data:
        both = [text.decode(errors="replace") for text in (present, data)]
        old, new = (HASH.sub("...", text).splitlines() for text in both)
        diff = [
            *difflib.unified_diff(old, new, f"{path} (present)", f"{path} (from the spec)", n=2)
        ]
        diff += ["the sha256 of its spec differs"] * (
            HASH.findall(both[0]) != HASH.findall(both[1])
        )
        yield Drift(path, DIFFERS, "\n".join(line.rstrip("\n") for line in diff))


def _is_odd(path: Path) -> bool:
    return path.is_symlink() or (path.exists() and not (path.is_file() or path.is_dir()))


def _others(path: Path, expected: Collection[Path]) -> Iterator[Drift]:
    """Yield what is at a path or below it and not expected, but for Python's own caches."""
    if path in expected or (path.suffix == ".pyc" and path.parent.name == "__pycache__"):
        return
    if _is_odd(path):
        yield Drift(path, LINK)
    elif path.is_dir():
        for inner in folder_entries(path):
            yield from _others(inner, expected)
    elif path.exists():
        yield Drift(path, LEFT)


def raise_if_drifted(found: Iterable[Drift], command: str) -> None:
    """Raise on the first drifted file; `command` is what brings the files up to date."""
    faults = list(found)
    if faults:
        more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
        what, remedy = f"{faults[0].fault}{more}", faults[0].remedy(command)
        raise DriftError(what, path_text(faults[0].path), remedy=remedy)
