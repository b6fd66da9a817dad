"""The step of a module as vectors compute it: the generated source, read with vectors for numbers.

Input: the texts of a module's .h and .c.  Output: the text to compile for many states side by side.
The step's part of the source has no conditions of C and no constants without type, so that its text
holds for vectors as it stands; here its numbers get the vector's type, its functions other names.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

#: The line that opens the part of a source that holds for vectors too.
OPENING = "/* The step of the discrete gradient, of one state or of many side by side. */"
#: Functions of a step's text, and those of wide.h that compute them; how many arguments.
CALLS = {
    "pick": ("chosen", 3),
    "fabs": ("size_of", 1),
    "copysign": ("with_sign", 2),
    "exp": ("exp_of", 1),
    "expm1": ("expm1_of", 1),
    "sqrt": ("sqrt_of", 1),
    "log": ("log_of", 1),
    "sin": ("sin_of", 1),
    "cos": ("cos_of", 1),
    "tanh": ("tanh_of", 1),
    "pow": ("pow_of", 2),
    "min": ("least", 2),
    "max": ("largest", 2),
    "sign": ("sign_of", 1),
    "deadzone": ("deadzone_of", 2),
    "saturate": ("saturate_of", 2),
    "phi3": ("phi3_of", 1),
    "ramp": ("ramp_of", 2),
    "ramp_by_new": ("ramp_by_new_of", 2),
    "mean_sign": ("mean_sign_of", 2),
    "mean_sign_by_new": ("mean_sign_by_new_of", 2),
}
MOST_FACTORS = 8
NUMBER = r"(?:[-+*/ ()]|\d[\d.]*(?:e[-+]?\d+)?|HUGE_VAL)+"


def wide_text(model: str, header: str, source: str) -> str:
    """Return what a driver needs in addition to run members side by side."""
    parts = (text_beside("wide.h"), wide_source(model, header, source), text_beside("wide.c"))
    return "\n".join(parts)


def wide_source(model: str, header: str, source: str) -> str:
    """Return the step's functions and the parameters for vectors, named ``<model>_wide_...``.

    Raises
    ------
    ValueError
        If the texts have no such part.
    """
    _, opening, step = source.partition(OPENING)
    name = re.escape(model)
    record = re.search(rf"typedef struct \{{(.*?)\}} {name}_parameters;", header, re.DOTALL)
    if not opening or not record:
        msg = "the module has no step"
        raise ValueError(msg)
    for pattern, instead in (
        (r"^#pragma(?:[^\n]*\\\n)*[^\n]*\n", ""),
        (rf"^long {name}_newton_size\(.*?^}}\n", ""),
        (rf"\b{name}_(newton|means|inside|parameters)\b", rf"{model}_wide_\1"),
        (rf"^int ({name}_wide_)", r"static mask \1"),
        (rf"^(void) ({name}_wide_)", r"static \1 \2"),
        (r"return 1;", "return everywhere;"),
        (rf"^( *(?:(?:const )?double \w+|\w+\[[^\n]*\]|\w+) =) ({NUMBER});$", r"\1 wide(\2);"),
        (r"\bdouble\b", "real"),
    ):
        step = re.sub(pattern, instead, step, flags=re.MULTILINE | re.DOTALL)
    texts = (defined(), _record(model, record[1]), step, undefined(), _loader(model, record[1]))
    return "\n".join(texts)


def defined() -> str:
    """Return definitions by which functions of a text take vectors."""
    lines = []
    for name, (function, arity) in CALLS.items():
        words = ["abc"[n] for n in range(arity)]
        given = words if name != "pick" else words[1:]
        call = ", ".join([*(["(a)"] if name == "pick" else []), *(f"wide({w})" for w in given)])
        lines.append(f"#define {name}({', '.join(words)}) {function}({call})")
    for n in range(2, MOST_FACTORS + 1):
        lines.append(f"#define power_{n}(a) whole_power(wide(a), {n})")
    return "\n".join(f"#undef {line.split('(')[0].split()[1]}\n{line}" for line in lines)


def undefined() -> str:
    """Return the end of those definitions."""
    names = [*CALLS, *(f"power_{n}" for n in range(2, MOST_FACTORS + 1))]
    return "\n".join(f"#undef {name}" for name in names)


def _fields(record: str) -> Iterator[tuple[str, str]]:
    """Yield the kind and the name of each parameter: "number", "bank:<bank>" or "count"."""
    for line in record.splitlines():
        found = re.match(
            r"\s*(double |const double \*|long )(\w+);(?:.*one a lane of (\w+))?", line
        )
        if found:
            kind = {"double ": "number", "long ": "count"}.get(found[1], f"bank:{found[3]}")
            yield kind, found[2]


def _record(model: str, record: str) -> str:
    lines = []
    for kind, name in _fields(record):
        word = {"number": "real ", "count": "long "}.get(kind, "real *")
        lines.append(f"    {word}{name};")
    return "\n".join(["typedef struct {", *lines, f"}} {model}_wide_parameters;"])


def _loader(model: str, record: str) -> str:
    """Return functions that give parameters of banks their room, and put in those of one state."""
    room, placed, loaded = ["0"], [], []
    for kind, name in _fields(record):
        if kind == "number":
            loaded.append(f"    w->{name}[lane] = p->{name};")
        elif kind == "count":
            placed.append(f"    w->{name} = p->{name};")
        else:
            count = f"p->{kind.removeprefix('bank:')}_count"
            placed += [f"    w->{name} = space;", f"    space += {count};"]
            loaded += [
                f"    for (long j = 0; j < {count}; ++j)",
                f"        w->{name}[j][lane] = p->{name}[j];",
            ]
            room.append(count)
    p, w = f"const {model}_parameters *p", f"{model}_wide_parameters *w"
    return "\n".join(
        [
            f"static long {model}_wide_room({p})",
            *("{", f"    (void)p;\n    return {' + '.join(room)};", "}"),
            f"static void {model}_wide_place({w}, {p}, real *space)",
            *("{", "    (void)w;\n    (void)p;\n    (void)space;", *placed, "}"),
            f"static void {model}_wide_load({w}, {p}, int lane)",
            *("{", "    (void)w;\n    (void)p;\n    (void)lane;", *loaded, "}\n"),
        ]
    )


@cache
def text_beside(name: str) -> str:
    """Return the text of a file of this folder."""
    return Path(__file__).with_name(name).read_text(encoding="utf-8")
