"""The imports of a package, read from its source: top-level and lazy ones, not those for types."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path


def modules(package: Path) -> dict[str, Path]:
    """Return the file of every module of a package, by dotted name."""
    found = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package.parent).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def import_graph(package: Path) -> dict[str, set[str]]:
    """Return the modules of a package that each of its modules imports."""
    files = modules(package)
    graph = {}
    for module, path in files.items():
        inside = {n for n in imported(path, module) if n.split(".")[0] == package.name}
        graph[module] = {nearest(name, files) for name in inside}
    return graph


def nearest(name: str, known: dict[str, Path]) -> str:
    """Return the module that a dotted name is, or is found in."""
    while name and name not in known:
        name = name.rpartition(".")[0]
    return name


def foreign(path: Path) -> set[str]:
    """Return the top-level packages that a file imports."""
    return {name.split(".")[0] for name in imported(path, path.stem)}


@cache
def imported(path: Path, module: str) -> frozenset[str]:
    """Return the dotted names a file imports: ``from a import b`` is ``a.b``."""
    found: set[str] = set()
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    for node in executed(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = ".".join(package.split(".")[: len(package.split(".")) + 1 - node.level])
            home = ".".join(filter(None, [base if node.level else "", node.module]))
            found |= {f"{home}.{alias.name}" for alias in node.names}
    return frozenset(found)


def executed(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes below `node`, without the bodies of ``if TYPE_CHECKING:``."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
            for other in child.orelse:
                yield other
                yield from executed(other)
            continue
        yield child
        yield from executed(child)
