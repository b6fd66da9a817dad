"""Imports go strictly downward, lazy ones included, and each stage knows its own libraries only.

The floors, two towers on one ground:

    errors < expressions < spec < algebra < network < iphs < derivation
        < {proofs, codegen} < {translation, falsify} < verification < module_cache < build
        < modules < {sweeps, linearization} < api < bench < cli
    the checker imports nothing of the package, and nothing imports it
    errors < expressions < {run, progress} < {sweeps, analysis, module_cache} < build < modules
        < {linearization, api} < bench < cli
"""

from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
from import_graph import foreign, import_graph, imported, modules, nearest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "piezo_sym"
GENERATED = sorted((ROOT / "generated").rglob("*.py"))

GROUND = {"version", "errors", "files", "interrupts", "processes", "report"}
TOP = ({"cli"}, {"__main__"})
PROVING = (
    GROUND,
    {"expressions"},
    {"spec"},
    {"algebra"},
    {"network"},
    {"iphs"},
    {"derivation"},
    {"proofs", "codegen", "checker"},
    {"translation", "falsify"},
    {"verification"},
    {"module_cache"},
    {"build"},
    {"modules"},
    {"sweeps", "linearization"},
    {"api"},
    {"bench"},
    *TOP,
)
RUNNING = (
    GROUND,
    {"expressions"},
    {"run", "progress"},
    {"sweeps", "analysis", "module_cache"},
    {"build"},
    {"modules"},
    {"linearization", "api"},
    {"bench"},
    *TOP,
)
SYMBOLIC = {"sympy", "pydantic", "pint", "z3", "tomli_w", "typer", "rich"}


def stage(module: str) -> str:
    """Return the first name below the package, the package's own for its face."""
    return module.split(".")[1] if "." in module else ""


def floor(tower: tuple[set[str], ...], name: str) -> int:
    return next((n for n, names in enumerate(tower) if name in names), -1)


def may_import(upper: str, lower: str) -> bool:
    """Return whether a stage may import another: itself, or what is below; some may use errors."""
    peer = (upper, lower) in {("files", "errors"), ("report", "errors")}
    towers = (PROVING, RUNNING)
    below = (floor(tower, upper) > floor(tower, lower) >= 0 for tower in towers)
    return upper == lower or peer or any(below)


def upward(package: Path) -> set[tuple[str, str]]:
    """Return the imports of a package that do not go downward."""
    return {
        (module, other)
        for module, others in import_graph(package).items()
        for other in others
        if stage(module) and stage(other) and not may_import(stage(module), stage(other))
    }


def shadowed(names: list[str], package: Path) -> set[str]:
    """Return the names that a module of the package has, too: importing it would replace them."""
    return set(names) & {path.stem for path in package.iterdir()}


def from_face(package: Path) -> set[tuple[str, str]]:
    """Return who imports which name that is no module but the package's own."""
    files = modules(package)
    names = {(m, n) for m, path in files.items() for n in imported(path, m)}
    return {(m, n) for m, n in names if n.split(".")[0] == "piezo_sym" == nearest(n, files)}


def plant(folder: Path, **files: str) -> Path:
    """Return a package ``piezo_sym`` with these modules; ``a__b`` is ``a/b.py``."""
    for name, text in {"__init__": "", **files}.items():
        path = folder / "piezo_sym" / f"{name}.py"
        if name.count("__") == 1:
            path = folder / "piezo_sym" / f"{name.replace('__', '/')}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder / "piezo_sym"


def test_no_module_imports_one_above_it():
    assert upward(PACKAGE) == set()


def test_no_module_imports_itself_by_a_detour():
    order = tuple(TopologicalSorter(import_graph(PACKAGE)).static_order())
    assert set(order) == set(modules(PACKAGE))


def test_every_module_has_a_floor():
    known = set().union({""}, *PROVING, *RUNNING)
    assert {stage(module) for module in modules(PACKAGE)} == known


def test_the_face_is_asked_for_nothing_but_the_version():
    """Any other name of it would be loaded from above when it is first used."""
    assert {name for _, name in from_face(PACKAGE)} == {"piezo_sym.__version__"}


def test_only_the_face_imports_by_text():
    """An import by text is seen by no check of this file; the checker's is of its own rows."""
    users = {m for m, path in modules(PACKAGE).items() if "import_module" in path.read_text()}
    assert users == {"piezo_sym", "piezo_sym.checker.__main__"}


@pytest.mark.parametrize("name", ["run", "analysis"])
def test_running_needs_no_library_of_the_derivation(name):
    for path in (PACKAGE / name).rglob("*.py"):
        assert foreign(path).isdisjoint(SYMBOLIC), path


@pytest.mark.parametrize("path", GENERATED, ids=lambda path: path.stem)
def test_a_generated_module_imports_numpy_alone(path):
    assert foreign(path) == {"dataclasses", "typing", "numpy"}


def test_there_is_a_generated_module_to_look_at():
    assert "piezo_stack" in [path.stem for path in GENERATED]


@pytest.mark.parametrize("name", ["expressions", "spec"])
def test_specs_need_no_sympy(name):
    for path in (PACKAGE / name).rglob("*.py"):
        assert "sympy" not in foreign(path), path


def test_no_public_name_is_also_a_module():
    import piezo_sym

    assert shadowed(piezo_sym.__all__, PACKAGE) == set()


PLANTED = [
    ({"run__simulate": "import piezo_sym.spec.load"}, ("run.simulate", "spec.load")),
    ({"spec__load": "def f():\n    from piezo_sym import lanes"}, ("spec.load", "lanes")),
    ({"proofs__exact": "from piezo_sym.codegen import lower"}, ("proofs.exact", "codegen.lower")),
    ({"codegen__lower": "from ..proofs import exact"}, ("codegen.lower", "proofs.exact")),
    ({"analysis__figures": "from piezo_sym import cli"}, ("analysis.figures", "cli")),
    ({"run__loop": "from piezo_sym import api"}, ("run.loop", "api")),
    ({"errors": "from piezo_sym import files"}, ("errors", "files")),
]


@pytest.mark.parametrize(("files", "edge"), PLANTED)
def test_an_import_that_goes_up_is_seen(tmp_path, files, edge):
    named = {edge[1].replace(".", "__"): ""}
    assert upward(plant(tmp_path, **named, **files)) == {tuple(f"piezo_sym.{n}" for n in edge)}


def test_imports_for_types_are_free(tmp_path):
    text = (
        "if TYPE_CHECKING:\n    from piezo_sym import cli\nelse:\n    from piezo_sym import errors"
    )
    assert upward(plant(tmp_path, run=text, cli="", errors="")) == set()


def test_a_cycle_is_seen(tmp_path):
    package = plant(
        tmp_path,
        lanes="def f():\n    from piezo_sym.linear import solve",
        linear="from piezo_sym import nodes",
        nodes="import piezo_sym.lanes",
    )
    with pytest.raises(CycleError):
        TopologicalSorter(import_graph(package)).prepare()


def test_a_shadowed_name_is_seen(tmp_path):
    assert shadowed(["derive", "load"], plant(tmp_path, derive="")) == {"derive"}


@pytest.mark.parametrize("text", ["from piezo_sym import derive", "import piezo_sym as p"])
def test_a_detour_over_the_face_is_seen(tmp_path, text):
    assert [module for module, _ in from_face(plant(tmp_path, run=text))] == ["piezo_sym.run"]


def test_a_lazy_import_of_a_library_is_seen(tmp_path):
    package = plant(tmp_path, run="def f():\n    import sympy.core as s\n    from z3 import Solver")
    assert foreign(package / "run.py") == {"sympy", "z3"}
