"""A printed C file, read back: rows of its functions as values in normal form.

Input: the text of ``<model>.c`` without the step, and the proved system, for names and places.
Output: values by function and row.  The grammar:

    file        comments, ``#include "<model>.h"``, ``#include <math.h>``, functions
    helper      static double NAME(double or int NAME, ...) { return expression; }
    part        static void FUNCTION_part_N(as the function, which calls it) { ... }

and for the rest see `c_function`.  Helpers mean what their text says.  Nothing is compiled.
"""

import ast
import re

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.translation.c_function import CFunction
from piezo_sym.translation.c_scope import File, kind_of
from piezo_sym.translation.c_text import python_of
from piezo_sym.translation.expressions import refused
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import Key, Proved
from piezo_sym.translation.signs import reading

_STATE = ["rhs", "jacobian", "margins", "outputs", "supply", "elements"]
SIGNATURES = dict.fromkeys([*_STATE, "heat", "entropy_production"], "x u p out")
SIGNATURES |= {"initial_state": "u p out", "temperatures": "x p out"}
SIGNATURES |= {"energy": "x p", "entropy": "x p", "states": "p", "processes": "p"}
_HELPERS = r"pick|sign|min|max|saturate|deadzone|power_[2-8]"
CALLS = {record.in_c: name for name, record in RECORDS.items() if record.smooth}
CALLS |= {"pow": "pow", "fabs": "abs", "copysign": "copysign"}


def read_c(text: str, known: Proved) -> dict[Key, Value]:
    """Return every row that the functions of a C file write."""
    file = File(known, "double", "parameters", SIGNATURES, CALLS)
    rows, seen = dict[Key, Value](), set[str]()
    for node in python_of(text, known.iphs.model.name).body:
        if not isinstance(node, ast.FunctionDef):
            raise refused(node, "a table")
        if kind_of(node.returns) == "static double":
            add_helper(node, file, _HELPERS)
            continue
        if is_part(node):
            add_part(node, file)
            continue
        function = CFunction(node, file)
        if function.name in seen:
            raise NotShownError(f"{function.name} is defined twice")
        seen.add(function.name)
        with reading(known.field, function.name):
            rows |= function.rows()
    check_parts(file)
    if seen != SIGNATURES.keys():
        raise NotShownError("the C file lacks a function")
    return rows


def is_part(node: ast.FunctionDef) -> bool:
    """Return whether a function computes part of the rows of another function."""
    return kind_of(node.returns) == "static void" and bool(re.search(r"_part_\d+$", node.name))


def add_part(node: ast.FunctionDef, file: File) -> None:
    """Record a part, which a later function calls."""
    if node.name in file.parts:
        raise NotShownError(f"{node.name} is defined twice")
    file.parts[node.name] = node


def check_parts(file: File) -> None:
    """Refuse parts that no function calls."""
    if left := file.parts.keys() - file.called:
        raise NotShownError(f"{min(left)} is never called")


def add_helper(node: ast.FunctionDef, file: File, allowed: str) -> None:
    """Record a helper that the file defines; refuse one whose name does not match `allowed`."""
    known = node.name in file.helpers or node.name in file.calls
    kinds = {kind_of(arg.annotation) for arg in node.args.args}
    if known or not re.fullmatch(allowed, node.name) or not kinds <= {file.number, "int"}:
        raise NotShownError(f"a function {node.name} of the C file's own")
    file.helpers[node.name] = node
