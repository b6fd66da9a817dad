"""``piezo-sym simulate SPEC``: run a model, print the final values, keep the result."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from piezo_sym.cli.output import about, named_as_options, print_table, warnings_as_lines
from piezo_sym.cli.results import events_of, tables, write
from piezo_sym.cli.words import Units, in_unit, pairs
from piezo_sym.errors import (
    FileError,
    NetworkError,
    ProofError,
    RunError,
    SpecError,
    UsageError,
    listing,
)
from piezo_sym.files import near_file, path_text, zarr_library

if TYPE_CHECKING:
    import xarray

STORE = ".zarr"
#: Digits of printed values; and how much larger than a change a value is, if that is round-off.
DIGITS, ROUND_OFF = 6, 1e12
#: Of signals; and samples that show a period.
FREQUENCIES, SHOWN = ("frequency", "f_start", "f_stop"), 20
ENDINGS = (".nc", ".csv", STORE)
METHODS = """discrete_gradient (compiled) if left out; or SciPy's RK23, RK45, DOP853, Radau, BDF or
LSODA."""
ORDER = "With --step: its order, 2 (if left out), 4, 6, 8, 10 or 12."
TIMES = "Number of samples; 1001, or ends of steps, if left out."
EVENTS = "NAME=EXPRESSION, located where its sign changes; repeat."
STOP = "A comparison, such as 'T_body > 350', that ends the run."
T0 = "When the run starts [s]; 0, or where it goes on."
OUT = """A .nc or .csv, which is replaced, or a new .zarr, written as it goes; folders are made.
Beside x.csv, x_NAME.csv has the times of each event."""
DURATION = "Length of the run [s], or with a unit: 20ms."
STEP = "A fixed step [s] instead of --rtol."
OUTPUTS = "Quantities of elements: all, or spring,damper.heat,..."
CONTINUE = "Go on from the end of this run (.nc or .zarr); inputs are given anew."
INITIAL = """STATE=NUMBER or T_<body>=KELVIN at t = 0; units as for --set; of joined
stores one state, see show; repeat."""
SIGNALS = "NAME=NUMBER, NAME=sine(100V,50Hz) or NAME=@FILE.csv; units as for --set; repeat."
SET = "PARAMETER=NUMBER in SI, whatever unit the spec has, or with its unit: L=1.2mH; repeat."


def option(about: str, *names: str) -> Any:
    """Return an option of the command."""
    return typer.Option(*names, help=about)


def time(about: str, name: str) -> Any:
    """Return an option that is a time, in s or in its own unit."""

    def read(text: str | float) -> float:  # a default is a number
        return float(in_unit(str(text), name, "s", name.strip("-")))

    return typer.Option(name, help=about, metavar="TIME", parser=read)


def simulate(
    spec: Annotated[str, typer.Argument(metavar="SPEC", help="Path or shipped name.")],
    duration: Annotated[float, time(DURATION, "--duration")],
    inputs: Annotated[list[str] | None, option(SIGNALS, "--input", "-i")] = None,
    parameters: Annotated[list[str] | None, option(SET, "--set", "-p")] = None,
    initial: Annotated[list[str] | None, option(INITIAL, "--initial")] = None,
    continued: Annotated[Path | None, option(CONTINUE, "--continue")] = None,
    t0: Annotated[float | None, time(T0, "--t0")] = None,
    rtol: Annotated[float | None, option("Relative tolerance; 1e-5 if left out.")] = None,
    step: Annotated[float | None, time(STEP, "--step")] = None,
    order: Annotated[int | None, option(ORDER)] = None,
    method: Annotated[str | None, option(METHODS)] = None,
    times: Annotated[int | None, option(TIMES)] = None,
    events: Annotated[list[str] | None, option(EVENTS, "--event")] = None,
    stop: Annotated[str | None, option(STOP)] = None,
    outputs: Annotated[str | None, option(OUTPUTS)] = None,
    dissipative_start: Annotated[
        bool, option("Damp what rings after a jump of an input.", "--dissipative-start")
    ] = False,
    out: Annotated[Path | None, option(OUT)] = None,
) -> None:
    """Simulate a spec's generated module and print its last values.

    Signals: sine(amplitude, frequency [Hz], offset=0, phase=0 [rad]), square(amplitude, frequency
    [Hz], offset=0), triangle(amplitude, frequency [Hz], offset=0), chirp(amplitude, f_start [Hz],
    f_stop [Hz], duration [s], offset=0), step(time [s], before, after), ramp(start [s], stop [s],
    before, after), whose other numbers are values of the input; or @FILE, a table, times in its
    first column, joined by straight lines, whose header may say units: t [ms],V_in [kV]. Of several
    columns the one named like the input counts.
    """
    made = _check_out(out, continued)
    units = Units(spec)
    signals = dict(pairs(inputs or (), "--input", units.signal))
    starts = dict(pairs(initial or (), "--initial", units.initial))
    span = {"duration": duration, "t0": t0, "times": times, "stop": stop}
    solver = {"rtol": rtol, "step": step, "order": order, "method": method, "outputs": outputs}
    result = _run(
        spec,
        out,
        inputs=signals,
        parameters=dict(pairs(parameters or (), "--set", units.numbers)),
        initial=_start(continued, starts),
        events=dict(pairs(events or (), "--event", lambda text, _: text)),
        dissipative_start=dissipative_start,
        **span,
        **solver,
    )
    unmet = [f"stop: {stop} never holds"] if stop and "stopped" not in result.attrs else ()
    _report(result, [*units.assumed, *_assumed(signals), *made, *unmet], out, signals)


def _run(spec: str, out: Path | None, **options: Any) -> xarray.Dataset:
    from piezo_sym.api import simulate as run

    of_spec = about(spec, SpecError, NetworkError, ProofError)
    if options["outputs"] not in (None, "all"):
        options["outputs"] = [name.strip() for name in options["outputs"].split(",")]
    if _is_store(out):
        options["store"] = out
    start = "--initial" if isinstance(options["initial"], dict) else "--continue"
    with warnings_as_lines(), keeping(out), of_spec, named_as_options(start):
        return run(spec, **options, progress=sys.stderr.isatty())


def _is_store(out: Path | None) -> bool:
    """Return whether a result is a store, which the run itself writes as it goes."""
    return out is not None and out.suffix == STORE


def _assumed(signals: Mapping[str, Any]) -> Iterator[str]:
    """Yield a line for each file of samples that says no units."""
    for name, value in signals.items():
        if assumed := getattr(value, "assumed", ""):
            yield f"{name}: its file names no units; read {assumed}"


def _aliased(signals: Mapping[str, Any], result: xarray.Dataset) -> Iterator[str]:
    """Yield a line for each input that has less than two samples in a period."""
    span = float(result.time[-1] - result.time[0])
    apart = span / max(1, result.time.size - 1)
    for name, signal in signals.items():
        frequency = max(getattr(signal, field, 0.0) for field in FREQUENCIES)
        if frequency * apart > 0.5:
            text = f"{name}: samples {apart:.3g} s apart alias its period of {1 / frequency:.3g} s"
            yield f"{text}; --times {math.ceil(SHOWN * frequency * span) + 1} show it"


def _report(
    result: xarray.Dataset, said: Iterable[str], out: Path | None, signals: Mapping[str, Any]
) -> None:
    """Write a result, then print it, so that a closed pipe does not lose it."""
    if out is not None and not _is_store(out):
        write(result, out)
    _print(result)
    for line in _event_lines(result):
        typer.echo(line)
    if "stopped" in result.attrs:
        typer.echo(f"stopped: {result.attrs['stopped']}")
    aliased = _aliased(signals, result) if out else ()  # printed are the last values alone
    for line in (*said, *aliased):
        typer.echo(line)
    if out is not None:
        _, *others = tables(result, out).values() if out.suffix == ".csv" else (out,)
        typer.echo(f"{out}" + f"; events: {listing(map(str, others))}" * bool(others))


def _event_lines(result: xarray.Dataset) -> Iterator[str]:
    """Yield a line for each event of a run: how often it happens, and when at first."""
    for name, hits in events_of(result).items():
        first = ", ".join(f"{t:.9g}" for t in hits.values[:4]) + ", ..." * (hits.size > 4)
        yield f"event {name}, {hits.size} in all: t = {first or 'never'}"


def _start(path: Path | None, initial: Mapping[str, Any]) -> Any:
    if path is None:
        return initial
    import xarray

    if initial:
        raise UsageError("--initial is given too", "--continue", "one of them")
    if not path.exists():
        what = "there is no such file or store"
        raise FileError(what, path_text(path), remedy=near_file(path))
    try:
        if _is_store(path):
            zarr_library("--continue")
            return xarray.open_dataset(path, engine="zarr", consolidated=False)
        return xarray.load_dataset(path, engine="scipy")
    except (OSError, ValueError, TypeError) as cause:
        remedy = "give what --out wrote as .nc or .zarr"
        raise FileError("is no run that can go on", path_text(path), remedy=remedy) from cause


def _check_out(out: Path | None, continued: Path | None) -> list[str]:
    """Check where a result is to be written; return what is said of a folder that is made."""
    if out is not None and continued is not None and out.resolve() == continued.resolve():
        what = f"{path_text(out)} is what --continue goes on from, and would be lost"
        raise UsageError(what, "--out", "another file")
    if out is not None and out.suffix not in ENDINGS:
        raise UsageError(f"{path_text(out)} has no known ending", "--out", listing(ENDINGS))
    if out is None or out.parent.exists():
        return []
    return [f"made the folder {path_text(out.parent)}"]


@contextmanager
def keeping(out: Path | None) -> Iterator[None]:
    """Print the events of a run that stops inside, write its partial result, and say so."""
    try:
        yield
    except (RunError, KeyboardInterrupt) as stopped:
        partial = getattr(stopped, "partial", None)
        for line in () if partial is None else _event_lines(partial):
            typer.echo(line)
        if out is None and partial is not None and not isinstance(stopped, RunError):
            reached = f"the run is at t = {float(partial.time[-1]):.6g} s"
            typer.echo(f"{reached}; --out would keep it until here", err=True)
        if out is not None and partial is not None:
            if not _is_store(out):
                write(partial, out)
            until = f"{path_text(out)} holds the run until t = {float(partial.time[-1]):.6g} s"
            if isinstance(stopped, RunError):
                stopped.remedy = f"{stopped.remedy}; {until}" if stopped.remedy else until
            else:
                typer.echo(until, err=True)
        raise


def _print(result: xarray.Dataset) -> None:
    end, rows = float(result.time.values[-1]), []
    for name, variable in result.data_vars.items():
        if "time" not in variable.dims:  # at the times of an event, which have a line of their own
            continue
        first, last = variable.isel(time=[0, -1]).values.reshape(2, -1)
        pairs_of = zip(last[:4].tolist(), first[:4].tolist(), strict=True)
        value = ", ".join(f"{v:.{_digits(v, v - before)}g}" for v, before in pairs_of)
        more = ", ..." if last.size > 4 else ""
        unit, about = (str(variable.attrs.get(key, "")) for key in ("units", "long_name"))
        rows.append((str(name), value + more, unit, about))
    print_table(f"{result.attrs['model']} at t = {end:.6g} s", ("", "value", "unit", ""), rows)


def _digits(value: float, change: float) -> int:
    """Return how many digits show a value, and three of its change unless it is round-off."""
    ratio = abs(value / change) if change else 0.0
    return DIGITS + max(0, math.ceil(math.log10(ratio)) - 3) if 1 < ratio < ROUND_OFF else DIGITS
