"""``piezo-sym reproduce``: the paper's figures, from the spec to files."""

from pathlib import Path
from types import ModuleType
from typing import Annotated, Any

import typer

from piezo_sym.cli.output import printed_at_the_end, warnings_as_lines
from piezo_sym.progress import tracked


def reproduce(
    out: Annotated[Path, typer.Option(help="Folder for the figures.")] = Path("figures"),
) -> None:
    """Draw Figures 2 to 6 of the paper, each as PNG, SVG and CSV.

    2: the operator w_T. 3: hysteresis at 25, 30, 35, 40 degC. 4: steady temperature over frequency
    and inductance, with its jumps. 5: step response. 6: hysteresis at 10, 50, 100, 200 Hz. Loops
    are those of the tenth period after a start in thermal equilibrium; notebook 4 says why.

    The module is the committed one of piezo_stack; it is compared with its spec first. A C compiler
    is needed.
    """
    from piezo_sym.modules import module_of
    from piezo_sym.run.engine.engine import engine_of

    module = module_of("piezo_stack")
    engine_of(module)  # raises without a compiler: figure 4 takes thousands of runs
    with warnings_as_lines():
        _write(module, out)


def _write(module: ModuleType, out: Path) -> None:
    """Write each figure once its curves are computed."""
    from piezo_sym.analysis.figures import FIGURES
    from piezo_sym.analysis.style import save

    jobs = [(figure, value) for figure in FIGURES for value in figure.values]
    done = {figure: list[Any]() for figure in FIGURES}
    with printed_at_the_end() as lines:
        for figure, value in tracked(jobs, "curves"):
            done[figure].append(figure.curve(module, value))
            if len(done[figure]) < len(figure.values):
                continue
            data = figure.joined(done[figure])
            lines += map(str, save(figure.draw(data), data, out, figure.name))
