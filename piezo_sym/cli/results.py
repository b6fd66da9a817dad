"""The file of a result: NetCDF, or CSV with a table of its own for the times of each event.

Input: the Dataset of a run, and a path.  Output: the files, replaced together.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from piezo_sym.files import path_text, write_bytes, write_together

if TYPE_CHECKING:
    import xarray


def events_of(result: xarray.Dataset) -> Mapping[str, xarray.DataArray]:
    """Return the times of each event of a run."""
    from piezo_sym.run.events import EVENT

    about = ((str(n), hits, str(hits.attrs.get("long_name"))) for n, hits in result.coords.items())
    return {name: hits for name, hits, text in about if text.startswith(EVENT)}


def write(result: xarray.Dataset, path: Path) -> None:
    """Write a result atomically; its folder is created where it does not exist."""
    if path.suffix == ".nc":
        write_bytes(path, bytes(result.to_netcdf(engine="scipy")))
    else:
        own = tables(result, path)
        texts = ((file, columns(result, over).to_csv(index=False)) for over, file in own.items())
        write_together({file: text.encode() for file, text in texts})
        for file in _of_other_runs(path, own):
            typer.echo(f"piezo-sym: {path_text(file)} has events of an earlier run", err=True)


def tables(result: xarray.Dataset, path: Path) -> Mapping[str, Path]:
    """Return the tables of a .csv: of quantities over time, and over the times of each event."""
    return {"time": path} | {
        name: path.with_stem(f"{path.stem}_{name}") for name in events_of(result)
    }


def _of_other_runs(path: Path, own: Mapping[str, Path]) -> Iterator[Path]:
    """Yield the tables of events beside a .csv that are not its `own`."""
    from piezo_sym.run.text_tables import header_of

    for file in sorted(path.parent.glob("*.csv")):
        name = file.stem.removeprefix(f"{path.stem}_")
        if name != file.stem and file not in own.values():
            with suppress(OSError), file.open(encoding="utf-8", errors="replace") as lines:
                if lines.readline().startswith(f"{header_of(name, 's')},"):
                    yield file


def columns(result: xarray.Dataset, over: str) -> Any:
    """Return what is `over` some times as a table: a column per quantity, for a bank per lane."""
    import pandas as pd

    from piezo_sym.run.text_tables import header_of

    series = {header_of(over, "s"): result[over].to_series()}
    for name, variable in result.data_vars.items():
        if over in variable.dims:
            frame, unit = variable.to_pandas(), str(variable.attrs["units"])
            lanes = {name: frame} if variable.ndim == 1 else frame.add_prefix(f"{name}_")
            series |= {header_of(lane, unit): values for lane, values in lanes.items()}
    return pd.DataFrame(series)
