"""``piezo-sym verify SPEC...``: prove the physics of specs."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Annotated

import typer

from piezo_sym.cli.output import STYLES, console, table

if TYPE_CHECKING:
    from piezo_sym.proofs.report import Report


def verify(
    specs: Annotated[list[str], typer.Argument(metavar="SPEC...", help="Paths or shipped names.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the rows as JSON.")] = False,
) -> None:
    """Prove every property of specs, or show where one fails.

    Exit code 0 if every required property is proved, 1 if one is refuted or open, 2 if a spec is
    wrong.
    """
    from piezo_sym.derivation import derive
    from piezo_sym.proofs import verify as prove
    from piezo_sym.spec.load import load

    reports = [prove(derive(load(spec))) for spec in specs]
    if as_json:
        rows = [row.as_dict(report.model) for report in reports for row in report.rows]
        typer.echo(json.dumps(rows, indent=2))
    else:
        for report in reports:
            _print(report)
    if not all(report.proved for report in reports):
        raise typer.Exit(1)


def _print(report: Report) -> None:
    columns = table(
        f"{report.model}: {report.summary()}", "property", "element", "statement", "verdict"
    )
    for row in report.rows:
        verdict = f"[{STYLES[row.verdict.value]}]{row.verdict.value}[/]"
        columns.add_row(row.id, row.element, row.statement, verdict)
    console().print(columns)
    for row in report.rows:
        at = ", ".join(f"{name} = {value}" for name, value in (row.witness or {}).items())
        if row.reason:
            text = f"{row.id}: {row.reason}" + (f"\n  at {at}" if at else "")
            console().print(text, markup=False, highlight=False)
