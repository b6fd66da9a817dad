"""Helpers, parts of functions and lists of lanes in a printed C file.

Input: functions and expressions as `c_text` gives them.  Output: their meaning, if their form is
one that the grammars of `c_reader` and `c_step` allow.
"""

import ast
import re
from collections import ChainMap
from collections.abc import Callable

from piezo_sym.translation.c_scope import Deferred, File, Scope, kind_of
from piezo_sym.translation.expressions import PLAIN
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.zero import is_zero


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


def helper_is(file: File, name: str, function: Callable[..., Value], count: int) -> bool:
    """Return whether a helper of the file is shown to equal `function` of `count` numbers."""
    if name not in file.helpers:
        return False
    args = [file.known.field.name(f"{n} of {name}") for n in range(count)]
    names = {f"a{n}": (arg, PLAIN) for n, arg in enumerate(args)}
    call = ast.Call(ast.Name(name), [ast.Name(arg) for arg in names], [])
    return is_zero(Scope(file, {}, ChainMap({**names})).read(call)[0] - function(*args))


def lists(node: ast.expr, scope: Scope) -> list[Deferred]:
    """Return the entries of `listed` in ``j < n ? listed[j] : (double)NAN`` of length n, or []."""
    match node:
        case ast.IfExp(
            ast.Compare(ast.Name(j), [ast.Lt()], [ast.Constant(n)]),
            ast.Subscript(ast.Name(name), ast.Name(k)),
            ast.Name("NAN"),
        ) if scope.lanes and j == k == scope.lanes[-1][0]:
            found = scope.names.get(name)
            if isinstance(found, list) and n == len(found) > 1:
                own = {part.scope.banks for part in found} <= {(), scope.banks}
                return found if own else []
    return []
