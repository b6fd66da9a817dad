"""A step that works alone: what stands behind a model's own text in ``<model>_step.c``.

Input: a model's name.  Output: text, the engine's step of order two for numbers of one run.  The
engine itself, which has its own, passes over it.
"""

import re

from piezo_sym.run.engine.driver import MORE_NODES
from piezo_sym.run.engine.tableau import tableau
from piezo_sym.run.engine.texts import texts

_TABLE = re.compile(r"static const double (\w+)\[[^;]*;\n?", re.DOTALL)
_INCLUDE = '#include "elimination.c"\n'
_HEAD = """
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
)
#: What few models need: kinks in energies, and path functionals; a step says so.
_PARTS = {"BENDS": "bends.c", "PATHS": "stop.c"}


def step_alone(model: str, step: str) -> str:
    """Return what makes a model's step one for programs in C, to stand behind its own text."""
    needed = {word: file for word, file in _PARTS.items() if f"#define {word}" in step}
    solver = texts("gauss.c", *needed.values(), "gaps.c", "newton.c", "nodes.c")
    others = (rf"#if defined\({w}\).*?#endif /\* {w} \*/\n" for w in _PARTS if w not in needed)
    for left_out in (*_LEFT_OUT, *others):
        solver = re.sub(left_out, "", solver, flags=re.DOTALL)
    solver = solver.replace(_INCLUDE, texts("elimination.c"))
    text = f"{solver}\n{texts('alone.c')}"
    bare = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    tables = tableau(1, 1 + MORE_NODES)
    for table in _TABLE.finditer(tables):
        if not re.search(rf"\b{table[1]}\b", bare):
            tables = tables.replace(table[0], "")
    return "\n".join([_HEAD.format(model=model), tables, text, "#endif /* ALONE */\n"])
