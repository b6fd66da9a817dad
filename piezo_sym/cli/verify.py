"""``piezo-sym verify SPEC...``: prove the physics of specs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.text import Text

from piezo_sym.cli.junit import junit_xml
from piezo_sym.cli.output import STYLES, about, console, table
from piezo_sym.cli.output import row as add_row
from piezo_sym.errors import PiezoError, ProofError
from piezo_sym.files import write_text

if TYPE_CHECKING:
    from piezo_sym.proofs.report import Report, Row


def verify(
    specs: Annotated[list[str], typer.Argument(metavar="SPEC...", help="Paths or shipped names.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the rows as JSON.")] = False,
    junit: Annotated[Path | None, typer.Option(help="Also write JUnit XML to this file.")] = None,
    recheck: Annotated[
        bool, typer.Option("--recheck", help="Ask cvc5 every query too, and compare.")
    ] = False,
) -> None:
    """Prove the physics of specs, or show by numbers where it fails.

    Each property is PROVED for every state, input and parameter value in the domain and for banks
    of any size, REFUTED with a witness, or OPEN with the reason.  Exit code 0 if every required
    property is proved, 1 if one is not (or cvc5 does not agree), 2 if a spec is wrong; the others
    are looked at all the same.
    """
    reports, errors = _reports(specs)
    if as_json:
        rows = [row.as_dict(report.model) for report in reports for row in report.rows]
        typer.echo(json.dumps(rows, indent=2))
    else:
        for report in reports:
            _print(report)
    if junit is not None:
        write_text(junit, junit_xml(reports, errors))
    if recheck:
        errors += _rechecked(reports)
    for error in errors[:-1]:
        typer.echo(f"piezo-sym: {error}", err=True)
    if errors:
        raise errors[-1]
    if not all(report.proved for report in reports):
        raise typer.Exit(1)


def _reports(specs: list[str]) -> tuple[list[Report], list[PiezoError]]:
    """Return the verdicts on the specs that are right, and the errors of the others."""
    from piezo_sym.derivation import derive
    from piezo_sym.proofs import verify as prove
    from piezo_sym.spec.load import load

    reports, errors = [], []
    for spec in specs:
        try:
            with about(spec):
                reports.append(prove(derive(load(spec))))
        except PiezoError as error:
            errors.append(error)
    return reports, errors


def _rechecked(reports: list[Report]) -> list[PiezoError]:
    """Return an error for each model on which cvc5 does not say the same; print the others."""
    from piezo_sym.proofs import recheck as compare

    errors: list[PiezoError] = []
    for report in reports:
        asked, found = compare(report)
        agreed = f"cvc5 agrees on {asked - len(found)} of {asked} queries"
        whole = sum(row.method == "intervals" for row in report.rows)
        agreed += f"; rows decided by intervals, without a query: {whole}" if whole else ""
        typer.echo(f"{report.model}: {agreed}", err=True)
        if found:
            first = found[0]
            said = f"z3 says {first.answers[0]}, cvc5 says {first.answers[1]}"
            errors.append(ProofError(f"{said}: {first.label}", report.model))
    return errors


def _print(report: Report) -> None:
    columns = table(
        f"{report.model}: {report.summary()}", "property", "element", "statement", "verdict"
    )
    for row in report.rows:
        verdict = Text(row.verdict.value, style=STYLES[row.verdict.value])
        if not row.required:
            verdict = Text(f"{row.verdict.value} (information)", style="dim")
        add_row(columns, row.id, row.element, row.statement, verdict)
    console().print(columns)
    for row in report.rows:
        if row.reason:
            console().print(_why(row), markup=False, highlight=False)


def _why(row: Row) -> str:
    at = ", ".join(f"{name} = {value}" for name, value in (row.witness or {}).items())
    name = f"{row.id} of {row.element}" if row.element else row.id
    return f"{name}: {row.reason}" + (f"\n  at {at}" if at else "")
