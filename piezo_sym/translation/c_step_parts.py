"""Parts of a step's text that are checked word for word: macros, records, preprocessor lines.

Input: the text of ``<model>_step.c``, and the proved stage.  Output: the macros that it begins
with, the functions that they name, and the fixed parts, which are not read as C.
"""

import re
from collections.abc import Iterator, Mapping

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.spec.circuit import Circuit
from piezo_sym.spec.tables import banks
from piezo_sym.translation.known import Proved

_LIBRARY = {record.in_c: name for name, record in RECORDS.items() if record.smooth}
#: The macros of a step for numbers of one run; a line is added per library function called.
MACROS = """\
#if !defined(REAL_WIDTH) /* numbers of one run; run/engine has vectors of many */
#define REAL_WIDTH 1
#define ALONE
#if !defined(REAL)
#define REAL double /* or float */
#endif
typedef REAL real;
#define zero 0.0
#define wide(value) (value)
#define chosen(condition, then, other) ((condition) ? (then) : (other))
{functions}#define is_above(a, b) ((a) > (b))
#define is_at_least(a, b) ((a) >= (b))
#define least(a, b) ((a) < (b) || (a) != (a) ? (a) : (b))
#define OF(value, lane) (value)
#endif
"""
DATA = """\
typedef struct {{
{fields}}} {model}_reals;
--
static long {model}_place_reals({model}_reals *to, const {model}_parameters *from, real *at)
{{
{unused}    real *const begin = at;
{places}    return at - begin;
}}
--
static void {model}_give({model}_reals *to, const {model}_parameters *from, int lane)
{{
    (void)lane;
{given}}}
"""
BENDS = "#define BENDS\n"
#: Encloses the functions of laws, which run/engine compiles apart.
LAWS = (
    "#if !defined(LAWS_APART) /* the functions of laws, which run/engine compiles apart */\n",
    "#endif /* of the functions of laws */\n",
)
#: Encloses a function that is for run/engine alone, and the lines that tell of it.
COSTATES = (
    "#if !defined(ALONE) /* the step alone solves its equations to round-off */\n",
    "#endif /* of what run/engine takes */\n",
)
TELLS = (
    "#if !defined(ALONE) /* there are co-states for run/engine */\n#define COSTATES\n",
    "#endif /* of what tells of co-states */\n",
)
#: The section in which a function or table stands, by its name without the model's; others stand in
#: "laws" if they are functions, and behind that section if they are tables.
SECTION = {"sizes": "", "costates": "costates", "bodies": "bodies", "body": "bodies"}


def macros_of(text: str) -> tuple[str, Mapping[str, str]]:
    """Return the macros of a step, and the functions of laws by the names that macros give them."""
    lines = {f"#define {name}_of {name}\n": name for name in _LIBRARY}
    lines = {line: name for line, name in lines.items() if line in text}
    calls = {f"{name}_of": _LIBRARY[name] for name in lines.values()}
    return MACROS.replace("{functions}", "".join(lines)), calls


def fixed_parts(text: str, known: Proved) -> Iterator[tuple[str, str]]:
    """Yield what a step has besides macros, functions, enumerations and tables, in its order.

    Each is given with the name of the section that begins behind it: what stands in another one
    would be left out of a program, or of a part that is compiled apart.
    """
    record, *copies = _data(text, known.iphs.circuit)
    has_costates = "costates" in known.slots
    yield record, "record"
    yield LAWS[0], "laws"
    if has_costates:
        yield from zip(COSTATES, ("costates", "laws"), strict=True)
    rest = [LAWS[1], *copies, *_path_table(known), *([BENDS] if BENDS in text else [])]
    yield from ((part, "") for part in rest)
    if has_costates:
        yield from zip(TELLS, ("bodies", ""), strict=True)


def _data(text: str, circuit: Circuit) -> list[str]:
    """Return the record of parameters and the functions that fill it, with the text's own names."""
    model, own = circuit.model, circuit.lane_parameters
    counts = {f"{bank}_count": "" for bank in banks(model)}
    fields, places, given = "", "", ""
    for count in counts:
        places += f"    to->{count} = from->{count};\n"
    for spec in model.parameters:
        name = next(iter(re.findall(rf"^    real \*?({spec}_*);$", text, re.M)), spec)
        size, place = f"{own.get(spec)}_count", "[j]" if spec in own else ""
        fields += f"    real {'*' if spec in own else ''}{name};\n"
        if spec in own:
            places += f"    to->{name} = at;\n    at += from->{size};\n"
            given += f"    for (long j = 0; j < from->{size}; ++j)\n    "
        given += f"    OF(to->{name}{place}, lane) = from->{name}{place};\n"
    fields += "".join(f"    long {count};\n" for count in counts)
    unused = "    (void)to;\n    (void)from;\n"
    words = {"fields": fields or "    char none;\n", "places": places, "given": given or unused}
    words["unused"] = "" if counts else unused
    return DATA.format(model=model.name, **words).split("--\n")


def _path_table(known: Proved) -> Iterator[str]:
    """Yield the lines of the table of stops in a step, if the system has stops."""
    banks, name = [*known.sizes], known.iphs.model.name
    states = [slot.label for slot in known.iphs.system.states]
    lines = [
        f"    {{{banks.index(bank) if bank else -1}, {own:d}, {states.index(inner)}, {seen:d}}},\n"
        for inner, bank, own, seen in known.paths
    ]
    if lines:
        head = f"#define PATHS {len(lines)}\nstatic const int {name}_path[PATHS][4] = {{\n"
        yield f"{head}{''.join(lines)}}};\n"
