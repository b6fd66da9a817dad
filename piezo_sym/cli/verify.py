"""``piezo-sym verify SPEC...``: prove the physics of specs."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Annotated

import typer
from rich.text import Text

from piezo_sym.cli.output import STYLES, about, console, table
from piezo_sym.cli.output import row as add_row
from piezo_sym.errors import PiezoError

if TYPE_CHECKING:
    from piezo_sym.proofs.report import Report


def verify(
    specs: Annotated[list[str], typer.Argument(metavar="SPEC...", help="Paths or shipped names.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the rows as JSON.")] = False,
) -> None:
    """Prove the structural properties of specs, or show where one fails.

    Exit code 0 if every required property is proved, 1 if one is refuted or open, 2 if a spec is
    wrong; the others are looked at all the same.
    """
    reports, errors = _reports(specs)
    if as_json:
        rows = [row.as_dict(report.model) for report in reports for row in report.rows]
        typer.echo(json.dumps(rows, indent=2))
    else:
        for report in reports:
            _print(report)
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


def _print(report: Report) -> None:
    columns = table(
        f"{report.model}: {report.summary()}", "property", "element", "statement", "verdict"
    )
    for row in report.rows:
        verdict = Text(row.verdict.value, style=STYLES[row.verdict.value])
        add_row(columns, row.id, row.element, row.statement, verdict)
    console().print(columns)
    for row in report.rows:
        at = ", ".join(f"{name} = {value}" for name, value in (row.witness or {}).items())
        if row.reason:
            text = f"{row.id}: {row.reason}" + (f"\n  at {at}" if at else "")
            console().print(text, markup=False, highlight=False)
