"""What the functions of a printed C file have in common, and what they may call.

Input: none; this is the type.  Output: `File`, to which `c_reader` adds the file's helpers.
"""

import ast
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import final

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.translation.known import Proved

CALLS = {record.in_c: name for name, record in RECORDS.items() if record.smooth}
CALLS |= {"pow": "pow", "fabs": "abs", "copysign": "copysign"}
#: What the step's own words for comparisons stand for.
COMPARISONS: dict[str, ast.cmpop] = {"is_above": ast.Gt(), "is_at_least": ast.GtE()}


@final
@dataclass(frozen=True)
class Helper:
    """A function of the file's own: its parameters and their types, and what it returns."""

    parameters: tuple[tuple[str, str], ...]
    value: ast.expr


@final
@dataclass(frozen=True)
class File:
    """What the functions of a C file have in common.

    Attributes
    ----------
    model : with its name the name of each function begins.
    signatures : of each function, what its arguments are.
    record : the ending of the type that holds parameters.
    calls : the functions of the library that may be called, and what they are.
    results : of a function and an argument, which rows are written to it; else the function's.
    """

    known: Proved
    model: str
    signatures: Mapping[str, str]
    record: str
    calls: Mapping[str, str]
    results: Mapping[str, str] = field(default_factory=dict)
    helpers: dict[str, Helper] = field(default_factory=dict)
