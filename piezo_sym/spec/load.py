"""A spec file to a `Model`: the one way in for text from strangers.

Input: a path, the name of a shipped spec, or text.  Output: a `Model`, or one error with the file's
name.
"""

from pathlib import Path

from piezo_sym.errors import PiezoError
from piezo_sym.spec.model import Model
from piezo_sym.spec.source import data, find, read


def load(spec: str | Path) -> Model:
    """Return the model of a spec file, or of a shipped spec.

    Parameters
    ----------
    spec : path of a TOML file, or the name of a shipped spec such as ``"piezo_stack"``.

    Raises
    ------
    FileError
        If the file cannot be read.
    SpecError
        If it is not a spec; the message names the place.
    UsageError
        If `spec` is neither text nor a path.
    """
    path = find(spec)
    return parse(read(path), path.name)


def parse(text: str, source: str = "spec") -> Model:
    """Return the model of a spec's text.

    Raises
    ------
    SpecError
        If the text is not a spec; the message begins with `source`.
    """
    try:
        return Model(**data(text))
    except PiezoError as error:
        error.where = f"{source}: {error.where}" if error.where else source
        raise
