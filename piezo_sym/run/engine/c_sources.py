"""The C that is compiled: a module's functions over many states, a module's steps, a step alone.

Input: a model's name, and for a step alone the text of ``<model>_step.c``.  Output: text, made of
the generated text and the files of this folder, which are the same for every model.
"""

import re
from functools import cache
from pathlib import Path

from piezo_sym.expressions.calculus import rule
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.text import ATOM, Style, piece
from piezo_sym.expressions.tree import Sym

#: Collocation steps of runs in lanes, behind a model's own text and the tables of their stages.
_COLLOCATION = (
    *("newton.c", "residual.c", "nodes.c", "waves.c", "inputs.c"),
    *("trajectory.c", "predict.c"),
    *("error.c", "crossings.c", "replay.c", "samples.c", "lengths.c", "outcome.c", "plan.c"),
    *("dispatch.c", "batch.c", "survey.c", "step_once.c"),
)
#: Nodes for means over a step, beyond its stages.
_MORE_NODES = 2

#: What a standalone step replaces of real.h.
_STANDALONE_HEAD = """
#if defined(ALONE) /* the engine has a step of its own, of any order and for vectors */
#include "{model}_step.h"

#include <string.h>

#define MODEL(name) {model}_##name
#define LANE(array, k, lane) ((array)[(k) + (lane)])
#define any(where) (where)
#define none_of(where) (!(where))
#define size_of fabs
#define nowhere 0
typedef int mask; /* 0 or 1 */

static inline real largest_of(real a, real b)
{{
    return a > b || a != a ? a : b;
}}
"""
#: What is for more stages, for stages in vectors, and for dissipative steps.
_LEFT_OUT = (
    r"#if PAIRS\n.*?#endif /\* PAIRS \*/\n",
    r"#if defined\(LANES\).*?#endif /\* LANES \*/\n",
    r"#if LOSSY.*?#endif\n",
    r"#if defined\(COSTATES\).*?#endif /\* COSTATES \*/\n\n?",
)
#: What few models need: kinks in energies, and path functionals; a step says so.
_PARTS = {"BENDS": ("bends.c",), "PATHS": ("coordinate.c", "stop.c", "paths.c")}
#: How the slope of a function is spelled.
_SLOPE = Style(
    lambda value: (repr(float(value)), ATOM),
    lambda name: (name, ATOM),
    lambda base, exponent: (f"pow({base[0]}, {float(exponent)})", ATOM),
    lambda name, args: (f"{RECORDS[name].in_c}({', '.join(text for text, _ in args)})", ATOM),
    lambda then, test, other: (f"({test} ? {then[0]} : {other[0]})", ATOM),
    lambda arg, bank: (f"{bank}({arg[0]})", ATOM),
)
_TABLE = re.compile(r"static const double (\w+)\[[^;]*;\n?", re.DOTALL)


@cache
def c_source(*names: str) -> str:
    """Return files of this folder, one after another."""
    folder = Path(__file__).parent
    return "\n".join(folder.joinpath(name).read_text(encoding="utf-8") for name in names)


def tables(stages: int, nodes: int, *kinds: str) -> str:
    """Return the numbers of Gauss collocation, its means taken at `nodes` nodes.

    `kinds`: "lossy" for those of a dissipative step; "lanes" for some once more, as vectors that
    hold all stages take them, behind the others. `tests/run/tableau.py` writes the files.
    """
    names = [f"{stages}_{nodes}{'_lossy' if 'lossy' in kinds else ''}"]
    names += [f"{stages}_{nodes}_lanes"] if "lanes" in kinds else []
    return "\n".join(c_source(f"tables/{name}.c").removesuffix("\n") for name in names)


@cache
def numbers_source(header: str) -> str:
    """Return ``real.h`` or ``dual.h``, with the smooth functions that it does not define itself."""
    text, x, y = c_source(header), Sym("x"), Sym("y")
    smooth = [record for record in RECORDS.values() if record.smooth]
    slopes = {r.in_c: piece(rule(r.slopes[0], x, value=y), _SLOPE)[0] for r in smooth}
    lines = [f"FUNCTION({f}, {slope})" for f, slope in slopes.items() if f"{f}_of(" not in text]
    return "\n".join([text, *lines])


def functions_source(model: str) -> str:
    """Return the file to compile for the functions of a module."""
    return "\n".join([f'#include "{model}.c"', _prefix(model), c_source("columns.c")])


def stage_lanes(stages: int, layout: str, *, lossy: bool) -> int:
    """Return the number of lanes of vectors that hold the stages of a step; 0 if none do."""
    several = layout == "one" and stages > 1 and not lossy
    return 1 << (stages - 1).bit_length() if several else 0


def derivatives_source(model: str, stages: int) -> str:
    """Return the file to compile for the derivatives of a step."""
    step = [f'#include "{model}_step.c"', _prefix(model), tables(stages, stages)]
    return "\n".join([numbers_source("dual.h"), *step, c_source("derivatives.c")])


def laws_source(model: str, layout: str) -> str:
    """Return the file to compile for the functions of laws, beside that of steps."""
    step = [f'#include "{model}_step.c"', _prefix(model), c_source("law.h")]
    return "\n".join([_numbers_of(layout), *step])


def _numbers_of(layout: str) -> str:
    """Return the definitions of `real` for steps."""
    plain = "#if defined(PLAIN)" if layout == "many" else "#if 1"
    return "\n".join([plain, "#define REAL_WIDTH 1", "#endif", numbers_source("real.h")])


def steps_source(model: str, stages: int, layout: str, *, lossy: bool = False) -> str:
    """Return the file to compile for collocation steps; `layout` and `lossy` as in `Sources`."""
    lanes = stage_lanes(stages, layout, lossy=lossy)
    at_once = ["#if defined(LANES)", c_source("at_once.h"), "#endif"] * bool(lanes)
    head = [
        *(["#if !defined(PLAIN)", f"#define LANES {lanes}", "#endif"] * bool(lanes)),
        _numbers_of(layout),
        *([f'#include "{model}.c"'] if lossy else []),
        "#define LAWS_APART",
        f'#include "{model}_step.c"',
        _prefix(model),
        c_source("law.h"),
        "extern const long MODEL(width);",
        "const long MODEL(width) = REAL_WIDTH;",
        *at_once,
    ]
    nodes, kinds = (1, ["lossy"]) if lossy else (stages + _MORE_NODES, ["lanes"] * bool(lanes))
    numbers = tables(stages, nodes, *kinds)
    gaps = c_source("gaps.c")
    if lanes:
        gaps = f"#if defined(LANES)\n{c_source('gaps_at_once.c')}\n#else\n{gaps}\n#endif"
    paths = ["#if defined(PATHS)", c_source(*_PARTS["PATHS"]), "#endif"]
    rest = c_source(*_COLLOCATION, *(["loss.c"] * lossy))
    return "\n".join([*head, numbers, c_source("gauss.c", "bends.c"), *paths, gaps, rest])


def stages_source(model: str, lanes: int) -> str:
    """Return the file to compile beside that of steps: all stages at once, in `lanes` lanes."""
    unused = ("function", "variable", "const-variable")
    head = [
        "#if !defined(PLAIN)",
        f"#define LANES {lanes}",
        "#define REAL_WIDTH WIDTH",
        "#if defined(__GNUC__) /* of what is printed, some is for the engine alone */",
        *(f'#pragma GCC diagnostic ignored "-Wunused-{what}"' for what in unused),
        "#endif",
        numbers_source("real.h"),
        f'#include "{model}_step.c"',
        _prefix(model),
    ]
    rest = ["#else", f"typedef int {model}_has_no_vectors;", "#endif\n"]
    return "\n".join([*head, c_source("at_once.h", "waves.c", "at_once.c"), *rest])


def standalone_step(model: str, step: str) -> str:
    """Return what stands behind a model's own text in ``<model>_step.c``, for programs in C.

    It is the engine's step of order two, for numbers of one run.
    """
    needed = [word for word in _PARTS if f"#define {word}" in step]
    parts = [file for word in needed for file in _PARTS[word]]
    solver = c_source("gauss.c", *parts, "gaps.c", "newton.c", "nodes.c")
    others = (rf"#if defined\({w}\).*?#endif /\* {w} \*/\n" for w in _PARTS if w not in needed)
    for left_out in (*_LEFT_OUT, *others):
        solver = re.sub(left_out, "", solver, flags=re.DOTALL)
    solver = solver.replace('#include "elimination.c"\n', c_source("elimination.c"))
    text = f"{solver}\n{c_source('standalone.c')}"
    bare = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    numbers = tables(1, 1 + _MORE_NODES)
    for table in _TABLE.finditer(numbers):
        if not re.search(rf"\b{table[1]}\b", bare):
            numbers = numbers.replace(table[0], "")
    head = _STANDALONE_HEAD.format(model=model)
    return "\n".join([head, numbers, text, "#endif /* ALONE */\n"])


def _prefix(model: str) -> str:
    return f"#define MODEL(name) {model}_##name"
