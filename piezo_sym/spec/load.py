"""A spec file to a `Model`, and the text of a first spec.

Input: a path, the name of a shipped spec, or text.  Output: a `Model`, or one error with the file's
name.
"""

from pathlib import Path

from piezo_sym.errors import SpecError, quote
from piezo_sym.spec.checks.names import check_model_name
from piezo_sym.spec.model import Model, Reader
from piezo_sym.spec.source import find, read, real, shipped

STARTER = Path(__file__).with_name("starter.toml")
OWN_NAME = 'name  = "starter"'


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
        If it, or a component, is not a spec; the message names the place.
    UsageError
        If `spec` is neither text nor a path.
    """
    path = find(spec)
    return of_file(path, read(path))


def of_file(path: Path, text: str) -> Model:
    """Return the model of a spec file with this text; its components are read. Raises as `load`."""
    return Reader().text(text, path.name, path.parent, (real(path),))


def parse(text: str, source: str = "spec") -> Model:
    """Return the model of a spec's text.

    Raises
    ------
    SpecError
        If the text is not a spec; the message begins with `source`.
    """
    return Reader().text(text, source, None)


def starter(name: str, where: str = "name") -> str:
    """Return the text of a first spec called `name`.

    Raises `SpecError` if `name` cannot name a model, or names a shipped one, whose module it would
    hide.
    """
    check_model_name(name, where)
    taken = next((known for known in shipped() if known.lower() == name.lower()), None)
    if taken is not None:
        remedy = f"call it 'my_{taken}'"
        raise SpecError(f"{quote(name)} is the name of a shipped spec", where, remedy=remedy)
    return STARTER.read_text(encoding="utf-8").replace(OWN_NAME, f'name  = "{name}"', 1)
