"""``piezo-sym simulate SPEC``: run a model, print where it ends, keep the result."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import typer

from piezo_sym.cli.output import console, row, table, warnings_as_lines
from piezo_sym.errors import UsageError, listing, nearest, quote
from piezo_sym.files import path_text, write_bytes

if TYPE_CHECKING:
    import xarray

CALL = re.compile(r"(?P<name>[a-z]+)\((?P<numbers>[^()]*)\)")
SIGNALS = ("sine", "step", "ramp", "triangle", "chirp")
ENDINGS = (".nc", ".csv")
METHODS = """discrete_gradient (compiled) if left out; or SciPy's RK23, RK45, DOP853, Radau, BDF or
LSODA."""

InputTexts: TypeAlias = Annotated[
    list[str] | None,
    typer.Option("--input", "-i", help="NAME=NUMBER or NAME=sine(100,100); SI; repeat."),
]
ParameterTexts: TypeAlias = Annotated[
    list[str] | None, typer.Option("--set", "-p", help="PARAMETER=NUMBER; SI; repeat.")
]


def simulate(
    spec: Annotated[str, typer.Argument(metavar="SPEC", help="Path or shipped name.")],
    duration: Annotated[float, typer.Option(help="Length of the run [s].")],
    inputs: InputTexts = None,
    parameters: ParameterTexts = None,
    rtol: Annotated[
        float | None, typer.Option(help="Relative tolerance; 1e-5 if left out.")
    ] = None,
    step: Annotated[float | None, typer.Option(help="A fixed step [s] instead of --rtol.")] = None,
    method: Annotated[str | None, typer.Option(help=METHODS)] = None,
    times: Annotated[int | None, typer.Option(help="Number of samples; 1001 if left out.")] = None,
    every: Annotated[
        int | None, typer.Option(help="With --step: a sample every so many steps.")
    ] = None,
    dissipative_start: Annotated[
        bool, typer.Option("--dissipative-start", help="Damp what rings after a jump of an input.")
    ] = False,
    out: Annotated[Path | None, typer.Option(help="Result as .nc (NetCDF) or .csv.")] = None,
) -> None:
    """Simulate a spec's generated module and print its last values.

    Signals: sine(amplitude, frequency), step(time, before, after), ramp(start, stop, before,
    after), triangle(amplitude, frequency), chirp(amplitude, f_start, f_stop, duration).
    """
    from piezo_sym.api import simulate as run
    from piezo_sym.sweeps.progress import time_bar

    if out is not None and out.suffix not in ENDINGS:
        raise UsageError(f"{path_text(out)} has no known ending", "--out", listing(ENDINGS))
    with warnings_as_lines(), time_bar(duration) as told:
        result = run(
            spec,
            duration=duration,
            inputs=dict(pairs(inputs or (), "--input", signal)),
            parameters=dict(pairs(parameters or (), "--set", _values)),
            rtol=rtol,
            step=step,
            method=method,
            times=times,
            every=every,
            progress=told,
            dissipative_start=dissipative_start,
        )
    _print(result)
    if out is not None:
        _write(result, out)


def pairs(
    texts: Iterable[str], option: str, read: Callable[[str, str], Any]
) -> Iterable[tuple[str, Any]]:
    """Yield the name and value of each ``NAME=VALUE``, read by `read` from text and place."""
    seen: set[str] = set()
    for given in texts:
        name, equals, value = given.partition("=")
        if not equals:
            raise UsageError(f"{quote(given)} has no '='", option, "NAME=VALUE")
        name = name.strip()
        if name in seen:
            raise UsageError(f"{quote(name)} is given twice", option, remedy="give it once")
        seen.add(name)
        yield name, read(value.strip(), f"{option} {name}")


def signal(text: str, where: str) -> Any:
    """Return a number, or a signal such as ``sine(100, 100)``; nothing is evaluated."""
    call = CALL.fullmatch(text)
    if call is None:
        return _number(text, where)
    if call["name"] not in SIGNALS:
        what = f"{quote(call['name'])} is no signal"
        raise UsageError(what, where, remedy=nearest(call["name"], SIGNALS))
    from piezo_sym import run

    numbers = [_number(part, where) for part in call["numbers"].split(",")]
    try:
        return getattr(run, call["name"])(*numbers)
    except TypeError as error:
        what = f"{call['name']} does not take {len(numbers)} numbers"
        raise UsageError(what, where, remedy="see `piezo-sym simulate --help`") from error
    except UsageError as error:
        error.where = f"{where}: {error.where}"
        raise


def _values(text: str, where: str) -> float | list[float]:
    """Return a number, or a list of them for the lanes of a bank."""
    numbers = [_number(part, where) for part in text.split(",")]
    return numbers[0] if len(numbers) == 1 else numbers


def _number(text: str, where: str) -> float:
    try:
        value = float(text.replace("_", "x"))
    except ValueError:
        raise UsageError(f"{quote(text)} is no number", where, "such as 0.5 or 1e-3") from None
    return int(value) if value.is_integer() and text.strip().isdigit() else value


def _print(result: xarray.Dataset) -> None:
    last = result.isel(time=-1)
    columns = table(
        f"{result.attrs['model']} at t = {float(last.time):.6g} s", "", "value", "unit", ""
    )
    for name, variable in last.data_vars.items():
        value = ", ".join(f"{v:.6g}" for v in variable.values.reshape(-1)[:4])
        more = ", ..." if variable.size > 4 else ""
        unit, about = (str(variable.attrs.get(key, "")) for key in ("units", "long_name"))
        row(columns, str(name), value + more, unit, about)
    console().print(columns)


def _write(result: xarray.Dataset, path: Path) -> None:
    """Write a result in one step; its folder is made if need be."""
    if path.suffix == ".nc":
        write_bytes(path, bytes(result.to_netcdf(engine="scipy")))
    else:
        write_bytes(path, columns(result).to_csv(index=False).encode())
    typer.echo(f"{path}")


def columns(result: xarray.Dataset) -> Any:
    """Return a result as a table with one column a quantity, one a lane for banks."""
    import pandas as pd

    found: Mapping[str, Any] = {"time": result.time.values}
    for name, variable in result.data_vars.items():
        if variable.ndim == 1:
            found = {**found, str(name): variable.values}
        else:
            lanes = {f"{name}_{n + 1}": lane for n, lane in enumerate(variable.values.T)}
            found = {**found, **lanes}
    return pd.DataFrame(found)
