"""Records of C lie in Python as the compiler lays them out."""

import ctypes
from dataclasses import replace
from pathlib import Path

import pytest

from piezo_sym.modules import module_of
from piezo_sym.run.engine.compiler import FLAGS, build, compilers
from piezo_sym.run.engine.library import DRIVER, LAWS, Sources
from piezo_sym.run.engine.records import LONG, ParameterRecords, c_record

STEPS = ("signal", "segment", "run", "tape", "task", "stepper")


def layout_in_c(kind: str, fields: list[str], name: str = "layout") -> str:
    """Return C that says where fields lie, and how long the record is."""
    places = ", ".join(f"(long)offsetof({kind}, {field})" for field in fields)
    return f"\n#include <stddef.h>\nconst long {name}[] = {{{places}, (long)sizeof({kind})}};\n"


def layout_in_python(structure) -> list[int]:
    places = [getattr(structure, name).offset for name, *_ in structure._fields_]
    return [*places, ctypes.sizeof(structure)]


def compiled(folder: Path, sources: Sources, driver: str) -> ctypes.CDLL:
    for name, text in {**sources.files(), DRIVER: driver}.items():
        (folder / name).write_text(text, encoding="utf-8")
    file = folder / "layout.so"
    flags = [flag for flag in FLAGS[-1] if flag != "-O2"]
    files = [path for name in (LAWS, DRIVER) if (path := folder / name).is_file()]
    build(next(compilers()), flags, files, file)
    return ctypes.CDLL(str(file))


def sources_of(module) -> Sources:
    paths = [Path(module.__file__).with_name(f"{module.NAME}{e}") for e in (".h", ".c", "_step.c")]
    header, source, step = (path.read_text(encoding="utf-8") for path in paths)
    return Sources(module.NAME, header, source, step, stages=1)


@pytest.mark.parametrize(("layout", "names"), [("one", STEPS), ("slopes", ("direction",))])
def test_a_record_has_the_layout_of_c(layout, names, tmp_path):
    module, structures = module_of("piezo_stack"), [c_record(name) for name in names]
    driver = replace(sources_of(module), layout=layout).files()[DRIVER]
    for name, structure in zip(names, structures, strict=True):
        fields = [field for field, _ in structure._fields_]
        driver += layout_in_c(f"MODEL({name})", fields, f"layout_{name}")
    library = compiled(tmp_path, sources_of(module), driver)
    for name, structure in zip(names, structures, strict=True):
        wanted = layout_in_python(structure)
        assert list((LONG * len(wanted)).in_dll(library, f"layout_{name}")) == wanted, name


def test_parameters_have_the_layout_of_the_header(tmp_path):
    module = module_of("piezo_stack")
    structure = type(ParameterRecords(module)(module.Parameters()).value)
    fields = [r.name for r in module.PARAMETERS] + [f"{bank}_count" for bank in module.BANKS]
    text = f'#include "{module.NAME}.h"' + layout_in_c(f"{module.NAME}_parameters", fields)
    library = compiled(tmp_path, sources_of(module), text)
    wanted = layout_in_python(structure)
    assert list((LONG * len(wanted)).in_dll(library, "layout")) == wanted
