"""A spec to start from: small, commented, and right as it stands.

Input: a name.  Output: the text of ``starter.toml``, which lies beside this file, under that name.
"""

from pathlib import Path

from piezo_sym.errors import SpecError, quote
from piezo_sym.spec.checks import check_model_name
from piezo_sym.spec.source import shipped

STARTER = Path(__file__).with_name("starter.toml")
OWN_NAME = 'name  = "starter"'


def starter(name: str, where: str = "name") -> str:
    """Return the text of a first spec called `name`.

    Raises
    ------
    SpecError
        If `name` cannot name a model, or names a shipped one, whose module it would hide.
    """
    check_model_name(name, where)
    taken = next((known for known in shipped() if known.lower() == name.lower()), None)
    if taken is not None:
        remedy = f"call it 'my_{taken}'"
        raise SpecError(f"{quote(name)} is the name of a shipped spec", where, remedy=remedy)
    return STARTER.read_text(encoding="utf-8").replace(OWN_NAME, f'name  = "{name}"', 1)
