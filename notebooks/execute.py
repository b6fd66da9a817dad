"""Execute the notebooks of this folder, and keep what they show the same in every run.

    python notebooks/execute.py [NAME...]            execute, write outputs in normal form
    python notebooks/execute.py --check [NAME...]    execute, compare with what is committed

Input: notebooks, all of them where no NAME is given; a NAME is a file's beginning, such as ``02``.
Output: the files, rewritten; with ``--check`` the differences, and exit code 1 if there are any.
Text, LaTeX and HTML are compared word by word; a picture only needs to be there, since its bytes
depend on the version of Matplotlib.  A warning in a notebook is an error.
"""

from __future__ import annotations

import argparse
import difflib
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbformat import NotebookNode

HERE = Path(__file__).resolve().parent
#: What a viewer needs to know; versions of interpreters are left out.
METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"file_extension": ".py", "name": "python"},
}
#: Run before the first cell and after the last; neither is in the file.  That the kernel's own code
#: warns when it stops is no matter of the notebook.
BEFORE = "import warnings\n\nwarnings.simplefilter('error')"
AFTER = "warnings.simplefilter('ignore')"
#: The kernel's log holds errors alone; without it every start says that it listens on TCP.
QUIET = ["--IPKernelApp.log_level=40"]
PICTURE = "image/png"
SECONDS = 120  # for one cell


def read(path: Path) -> NotebookNode:
    """Return a notebook file as a notebook of format 4.5."""
    return nbformat.reads(path.read_text(encoding="utf-8"), as_version=4)


def written(notebook: NotebookNode) -> str:
    """Return the text of a notebook in normal form, the same for the same content."""
    return json.dumps(normal(notebook), indent=1, ensure_ascii=False, sort_keys=True) + "\n"


def normal(notebook: NotebookNode) -> dict[str, object]:
    """Return a notebook as plain data, without anything that a run leaves besides its outputs."""
    cells = [_cell(n, cell) for n, cell in enumerate(notebook.cells, start=1)]
    return {"cells": cells, "metadata": METADATA, "nbformat": 4, "nbformat_minor": 5}


def _cell(n: int, cell: NotebookNode) -> dict[str, object]:
    source = cell.source.strip("\n").splitlines(keepends=True)
    found = {"cell_type": cell.cell_type, "id": f"cell-{n:02}", "metadata": {}, "source": source}
    if cell.cell_type == "code":
        found |= {"execution_count": None, "outputs": list(_outputs(cell.outputs))}
    return found


def _outputs(outputs: list[NotebookNode]) -> Iterator[dict[str, object]]:
    """Yield outputs in normal form; what is printed in pieces becomes one."""
    text: list[str] = []
    for output in outputs:
        if output.output_type == "stream":
            text.append(output.text)
            continue
        yield from _stream(text)
        text = []
        data = {kind: _lines(kind, value) for kind, value in output.data.items()}
        found = {"data": data, "metadata": {}, "output_type": output.output_type}
        if output.output_type == "execute_result":
            found["execution_count"] = None
        yield found
    yield from _stream(text)


def _stream(text: list[str]) -> Iterator[dict[str, object]]:
    if text:
        lines = "".join(text).splitlines(keepends=True)
        yield {"name": "stdout", "output_type": "stream", "text": lines}


def _lines(kind: str, value: str) -> str | list[str]:
    return value.strip() if kind == PICTURE else value.splitlines(keepends=True)


def executed(notebook: NotebookNode) -> NotebookNode:
    """Return a notebook as it is after all its cells ran in a fresh kernel.

    Raises
    ------
    CellExecutionError
        If a cell fails, or writes to the error stream.
    """
    first, last = map(nbformat.v4.new_code_cell, (BEFORE, AFTER))
    ran = nbformat.from_dict({**notebook, "cells": [first, *notebook.cells, last]})
    paths = filter(None, [str(HERE.parent), os.environ.get("PYTHONPATH")])
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    client = NotebookClient(
        ran,
        kernel_name="python3",
        timeout=SECONDS,
        record_timing=False,
        extra_arguments=QUIET,
        resources={"metadata": {"path": str(HERE)}},
    )
    client.execute(env=environment)
    ran.cells = ran.cells[1:-1]
    for cell in ran.cells:
        for output in cell.get("outputs", ()):
            if output.get("name") == "stderr":
                raise CellExecutionError(output.text, "stderr", "a cell wrote to the error stream")
    return ran


def readable(notebook: dict[str, object]) -> list[str]:
    """Return the lines that are compared: everything but the bytes of pictures."""

    def shown(part: object) -> object:
        if isinstance(part, dict):
            return {key: "a picture" if key == PICTURE else shown(part[key]) for key in part}
        return [shown(item) for item in part] if isinstance(part, list) else part

    text = json.dumps(shown(notebook), indent=1, ensure_ascii=False, sort_keys=True)
    return text.splitlines()


def differences(path: Path) -> list[str]:
    """Return what differs between a notebook as committed and as it is when executed now."""
    committed = json.loads(path.read_text(encoding="utf-8"))
    now = json.loads(written(executed(read(path))))
    names = f"{path.name} (committed)", f"{path.name} (executed)"
    return list(difflib.unified_diff(readable(committed), readable(now), *names, lineterm=""))


def rewrite(path: Path) -> None:
    """Execute a notebook and write it with its outputs."""
    path.write_text(written(executed(read(path))), encoding="utf-8")


def chosen(names: list[str], folder: Path = HERE) -> list[Path]:
    """Return the notebooks whose names begin with one of `names`, all of them for none.

    Raises
    ------
    SystemExit
        If a name is no notebook's.
    """
    found = sorted(folder.glob("*.ipynb"))
    for name in names:
        if not any(path.name.startswith(Path(name).name) for path in found):
            known = ", ".join(path.stem for path in found) or "none"
            sys.exit(f"no notebook is called '{name}'; notebooks: {known}")
    wanted = tuple(Path(name).name for name in names) or ("",)
    return [path for path in found if path.name.startswith(wanted)]


def main(words: list[str]) -> int:
    """Run the command; return its exit code."""
    parser = argparse.ArgumentParser(description="Execute notebooks; write or compare outputs.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="01, 02, ...; all if none")
    parser.add_argument("--check", action="store_true", help="compare, write nothing")
    asked = parser.parse_args(words)
    drifted = False
    for path in chosen(asked.names):
        found = differences(path) if asked.check else rewrite(path)
        if found:
            drifted = True
            remedy = f"python notebooks/execute.py {path.stem}"
            sys.stdout.write("\n".join([*found, f"write it again with: {remedy}", ""]))
    return int(drifted)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
