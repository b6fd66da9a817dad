"""``piezo-sym verify SPEC...``: prove the physics of specs; verdicts as text, JSON, JUnit XML."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated
from xml.etree import ElementTree as ET

import typer
from rich.text import Text

from piezo_sym.cli.output import STYLES, about, console, print_table
from piezo_sym.errors import ContradictionError, PiezoError, ProofError, legible
from piezo_sym.files import write_text
from piezo_sym.version import VERSION

#: What is said of an input without effect.
UNUSED = "no element uses it; name it in one, as input = '...', or leave it out"

if TYPE_CHECKING:
    from piezo_sym.report import Report, Row
    from piezo_sym.verification.recheck import Recheck


def verify(
    specs: Annotated[list[str], typer.Argument(metavar="SPEC...", help="Paths or shipped names.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the rows as JSON.")] = False,
    junit: Annotated[Path | None, typer.Option(help="Also write JUnit XML to this file.")] = None,
    recheck: Annotated[
        bool, typer.Option("--recheck", help="Check every row by a second program too.")
    ] = False,
) -> None:
    """Prove the physics of specs, or show by numbers where it fails.

    Each property is PROVED for every state, input and parameter value in the domain and for banks
    of any size, REFUTED with a witness, or OPEN with the reason.  Exit code 0 if every required
    property is proved, 1 if one is not (or the second program does not confirm it), 2 if a spec is
    wrong; the others are looked at all the same.  Exit code 3: a proof and a number disagree.

    What is proved is kept in the user's cache, and not proved again before the spec, the package or
    a solver changes.
    """
    if recheck:
        from piezo_sym.verification.recheck import check_installed

        check_installed()
    reports, proved, errors = _reports(specs)
    second = _rechecked(proved) if recheck else {}
    if junit is not None:
        pairs = [(report, second.get(spec)) for spec, report in reports.items()]
        write_text(junit, junit_xml(pairs, errors))
    _show(reports, second, as_json=as_json)
    for spec, opinion in second.items():
        faults = opinion.faults(reports[spec].information)
        errors += [ProofError(faults[0], reports[spec].model)] if faults else []
    for line in (line for error in errors[:-1] for line in error.lines()):
        typer.echo(f"piezo-sym: {line}", err=True)
    if errors:
        raise errors[-1]
    if not all(report.proved for report in reports.values()):
        raise typer.Exit(1)


def _show(reports: dict[str, Report], second: dict[str, Recheck], *, as_json: bool) -> None:
    """Print the verdicts, as tables or as JSON, and those of the second program."""
    for spec, report in reports.items():
        if not as_json:
            _print(report)
        if spec in second:
            typer.echo(f"{report.model}, by a second program:\n{second[spec].said}", err=True)
    if as_json:
        rows = [row for spec, report in reports.items() for row in _rows(report, second.get(spec))]
        typer.echo(json.dumps(rows, indent=2))


def _reports(
    specs: list[str],
) -> tuple[dict[str, Report], dict[str, tuple[str, str]], list[PiezoError]]:
    """Return the verdicts on specs, the texts of each and its ``proofs.json``, and what is wrong.

    The text of a spec is the user's own, as far as a second program reads it.
    """
    from piezo_sym.build import PROOFS, report_and_files
    from piezo_sym.expressions.tree import names
    from piezo_sym.spec.load import of_file
    from piezo_sym.spec.source import find, read
    from piezo_sym.spec.tables import conditions, unused_inputs, unused_parameters

    reports: dict[str, Report] = {}
    proved: dict[str, tuple[str, str]] = {}
    errors: list[PiezoError] = []
    for spec in specs:
        try:
            with about(spec):
                path = find(spec)
                text = read(path)
                model = of_file(path, text)
                flat = model.flatten()
                reports[spec], files = report_and_files(model)
                unused = [f"inputs.{name}: {UNUSED}" for name in unused_inputs(flat)]
                bounds = {word for c in conditions(flat) for word in names(c.tree)}
                bounds |= flat.parameters.keys() - model.parameters.keys()  # of components
                idle = (name for name in unused_parameters(flat) if name not in bounds)
                unused += [f"parameters.{name}: no law uses it" for name in idle]
                for line in unused:
                    typer.echo(f"piezo-sym: {legible(path.name)}: {line}", err=True)
                own = text if flat is model else flat.to_toml()
                proved[spec] = own, files[PROOFS.format(model.name)]
        except ContradictionError:
            raise
        except PiezoError as error:
            errors.append(error)
    return reports, proved, errors


def _rechecked(proved: dict[str, tuple[str, str]]) -> dict[str, Recheck]:
    from piezo_sym.verification.recheck import recheck

    return {spec: recheck(*texts) for spec, texts in proved.items()}


def _rows(report: Report, second: Recheck | None) -> list[dict[str, object]]:
    """Return the rows as plain data, with the second program's verdict if it has run."""
    rows = []
    for row in report.rows:
        rechecked = {"recheck": second.rows.get((row.id, row.element))} if second else {}
        rows.append({**row.as_dict(report.model), **rechecked})
    return rows


def _print(report: Report) -> None:
    cells = []
    for row in report.rows:
        points = f"{row.points:,}" if row.points else ""
        verdict = Text(row.verdict.value, style=STYLES[row.verdict.value])
        if not row.required:
            verdict = Text(f"{row.verdict.value} (information)", style="dim")
        cells.append((row.id, row.element, row.statement, points, verdict))
    columns = ("property", "element", "statement", "points", "verdict")
    print_table(f"{report.model}: {report.summary()}", columns, cells)
    for row in sorted(report.rows, key=lambda row: not row.is_cause):
        if row.reason:
            console().print(_why(row), markup=False, highlight=False)


def _why(row: Row) -> str:
    return f"{row.name}: {row.reason}" + (f"\n  at {row.at}" if row.at else "")


def junit_xml(reports: Iterable[tuple[Report, Recheck | None]], errors: list[PiezoError]) -> str:
    """Return JUnit XML: REFUTED is a failure, OPEN an error, unless it is only information.

    For each model it has a suite with one case per property. A row that the second program does not
    confirm is a failure in the suite ``<model>, rechecked``. A spec that could not be read is a
    suite of its own, with one error.
    """
    root = ET.Element("testsuites", name=f"piezo-sym {VERSION}")
    for report, second in reports:
        failed = [row.verdict.value for row in report.failures]
        counts = len(report.rows), failed.count("REFUTED"), failed.count("OPEN")
        suite = _suite(root, report.model, *counts)
        for row in report.rows:
            _verdict(suite, report.model, row)
        if second is not None:
            _opinion(root, report, second)
    for error in errors:
        where = error.where or "spec"
        suite = _suite(root, where, 1, 0, 1)
        _case(suite, where, "load", "error", message=str(error), type=type(error).__name__)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _suite(root: ET.Element, name: str, tests: int, failures: int, errors: int) -> ET.Element:
    counts = {"tests": str(tests), "failures": str(failures), "errors": str(errors)}
    return ET.SubElement(root, "testsuite", {"name": name, **counts})


def _case(suite: ET.Element, model: str, name: str, kind: str, text: str = "", **more: str) -> None:
    """Add a case; `kind` is that of its fault, if it has one, `text` and `more` say what it is."""
    case = ET.SubElement(suite, "testcase", classname=model, name=name)
    if kind:
        ET.SubElement(case, kind, more).text = text or None


def _verdict(suite: ET.Element, model: str, row: Row) -> None:
    name, text, word = f"{row.id} {row.element}".strip(), "", row.verdict.value
    kind, more = {"PROVED": "", "REFUTED": "failure"}.get(word, "error"), {"message": row.reason}
    if kind and not row.required:
        kind, more = "skipped", {"message": f"information: {word}: {row.reason}"}
    elif kind:
        more["type"] = word
        text = f"{row.statement}\n{row.reason}" + (f"\nat {row.at}" if row.at else "")
    _case(suite, model, name, kind, text, **more)


def _opinion(root: ET.Element, report: Report, second: Recheck) -> None:
    """Add the verdicts of the second program."""
    faults = len(second.faults(report.information))
    tests, name = len(second.rows) + bool(second.failed), f"{report.model}, rechecked"
    suite = _suite(root, name, tests, faults, 0)
    for key, word in second.rows.items():
        kind = "skipped" if word == "stated" or key in report.information else "failure"
        fault = "" if word == "confirmed" else kind
        _case(suite, name, " ".join(filter(None, key)), fault, message=word)
    if second.failed:
        _case(suite, name, "checker", "failure", message=second.failed)
