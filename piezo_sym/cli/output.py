"""How commands print: one console, plain tables that also read well in a log."""

from __future__ import annotations

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

STYLES = {"PROVED": "green", "REFUTED": "bold red", "OPEN": "yellow"}


def console() -> Console:
    """Return the console for results; wide enough in a log that no row is cut."""
    found = Console()
    return found if found.is_terminal else Console(width=120)


def table(title: str, *columns: str) -> Table:
    """Return an empty table with a title and named columns."""
    made = Table(title=Text(title, style="bold"), title_justify="left", box=box.SIMPLE_HEAD)
    for column in columns:
        made.add_column(column)
    return made
