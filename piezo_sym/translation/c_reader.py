"""A printed C file, read back: rows of its functions as values in normal form.

Input: the text of ``<model>.c`` without the step, and the proved system, for names and places.
Output: values by function and row.  The grammar:

    file        comments, ``#include "<model>.h"``, ``#include <math.h>``, functions
    helper      static double NAME(double or int NAME, ...) { return expression; }

and for the rest see `c_function`.  Helpers mean what their text says.  Nothing is compiled.
"""

import re
from collections import ChainMap

from piezo_sym.translation.c_function import CFunction
from piezo_sym.translation.c_scope import Meaning, Scope
from piezo_sym.translation.c_text import CALLS, File, Helper, Tokens
from piezo_sym.translation.expressions import PLAIN
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import Key, Proved
from piezo_sym.translation.signs import reading

_STATE = ["rhs", "jacobian", "margins", "outputs", "supply", "elements"]
SIGNATURES = dict.fromkeys([*_STATE, "heat", "entropy_production"], "x u p out")
SIGNATURES |= {"initial_state": "u p out", "temperatures": "x p out"}
SIGNATURES |= {"energy": "x p", "entropy": "x p", "states": "p", "processes": "p"}
_HELPERS = r"pick|sign|min|max|saturate|deadzone|power_[2-8]"


def read_c(text: str, known: Proved) -> dict[Key, Value]:
    """Return every row that the functions of a C file write."""
    name = known.iphs.model.name
    tokens, file = Tokens(text, name), File(known, name, SIGNATURES, "parameters", CALLS)
    rows, seen = dict[Key, Value](), set[str]()
    while tokens.peek():
        if tokens.taken("static"):
            add_helper(tokens, file, _HELPERS)
            continue
        function = CFunction(tokens, file)
        if function.name in seen:
            raise NotShownError(f"{function.name} is defined twice")
        seen.add(function.name)
        with reading(known.field, function.name):
            rows |= function.rows()
    if seen != SIGNATURES.keys():
        raise NotShownError("the C file lacks a function")
    return rows


def add_helper(tokens: Tokens, file: File, allowed: str) -> str:
    """Take a function of the file's own, one of those allowed; return its name."""
    tokens.take("double")
    name, parameters = tokens.word(), dict[str, str]()
    tokens.take("(")
    while not parameters or tokens.taken(","):
        kind = tokens.one_of("double", "int")
        parameters[tokens.word()] = kind
    tokens.take(")", "{", "return")
    names: ChainMap[str, Meaning] = ChainMap({})
    names |= dict.fromkeys(parameters, (file.known.field.zero, PLAIN))
    value = Scope(file, {}, names).defer(tokens.expression()).node
    tokens.take(";", "}")
    if name in file.helpers or name in CALLS or not re.fullmatch(allowed, name):
        raise NotShownError(f"a function {name} of the C file's own")
    file.helpers[name] = Helper(tuple(parameters.items()), value)
    return name
