"""The parameters of a step in C: a record of `real`, and the functions that fill it.

Input: a `Program` and the C names of its fields.  Output: text of ``<model>_step.c``.
"""

from collections.abc import Mapping

from piezo_sym.codegen.c.head import comment
from piezo_sym.codegen.c.lines import indented
from piezo_sym.codegen.program import Program


def record_text(program: Program, names: Mapping[str, str]) -> str:
    """Return the record of parameters, as the functions of a step take them."""
    lines = ["/* The parameters as `real`: of one run, or in vectors of one run per lane. */"]
    lines += ["typedef struct {"]
    for field in program.parameters:
        lines.append(f"    {'real *' if field.bank else 'real '}{names[field.name]};")
    lines += [f"    long {bank}_count;" for bank in program.counts]
    if not program.parameters and not program.counts:
        lines.append("    char none;")
    return "\n".join([*lines, f"}} {program.name}_reals;"])


def place_text(program: Program, names: Mapping[str, str]) -> str:
    """Return the function that places the arrays for parameters of banks."""
    body = [] if program.counts else ["(void)to;", "(void)from;"]
    body += ["real *const begin = at;"]
    body += [f"to->{bank}_count = from->{bank}_count;" for bank in program.counts]
    for field in program.parameters:
        if field.bank:
            body.append(f"to->{names[field.name]} = at;")
            body.append(f"at += from->{field.bank}_count;")
    doc = (
        "Copy the sizes of banks; place arrays for their parameters from `at` on, return their size"
    )
    head = f"static long {program.name}_place_reals({program.name}_reals *to, "
    head += f"const {program.name}_parameters *from, real *at)"
    return "\n".join([*comment(doc), head, "{", *indented([*body, "return at - begin;"]), "}"])


def give_text(program: Program, names: Mapping[str, str]) -> str:
    """Return the function that copies the parameters of a run into a lane of the vectors."""
    body = ["(void)lane;"]
    for field in program.parameters:
        name = names[field.name]
        if field.bank:
            body.append(f"for (long j = 0; j < from->{field.bank}_count; ++j)")
            body.append(f"    OF(to->{name}[j], lane) = from->{name}[j];")
        else:
            body.append(f"OF(to->{name}, lane) = from->{name};")
    body += [] if program.parameters else ["(void)to;", "(void)from;"]
    head = f"static void {program.name}_give({program.name}_reals *to, "
    head += f"const {program.name}_parameters *from, int lane)"
    doc = "Copy the parameters of a run into one lane of the vectors"
    return "\n".join([*comment(doc), head, "{", *indented(body), "}"])
