"""The header of a model's step in C.

Input: a `Program` and its `Collocation`.  Output: the text of ``<model>_step.h``.
"""

from collections.abc import Iterator

from piezo_sym.codegen.c.head import has_defaults, opening, pointer_name, wrapped
from piezo_sym.codegen.collocation import Collocation
from piezo_sym.codegen.program import Program

_TEXT = """{opening}
#ifndef PIEZO_SYM_{model}_STEP_H
#define PIEZO_SYM_{model}_STEP_H

#include "{model}.h"

#ifdef __cplusplus
extern "C" {{
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long {model}_step_size(const {model}_parameters *{p});

/*
{doc}{example}
 */
int {model}_step(double *x,
{indent}const double *u,
{indent}double h,
{indent}const {model}_parameters *{p},
{indent}double *booked,
{indent}double *space);

#ifdef __cplusplus
}}
#endif

#endif /* PIEZO_SYM_{model}_STEP_H */
"""

_EXAMPLE = """Example: cc -O3 -fopenmp-simd example.c {model}.c {model}_step.c -lm

    #include <stdio.h>
    #include <stdlib.h>

    #include "{model}_step.h"

    int main(void)
    {{
        const {model}_parameters p = {model}_DEFAULTS;
        const double u[] = {{{inputs}}};
        const size_t size = (size_t){model}_step_size(&p);
        double x[{n}], booked[{booked}], *space = calloc(size, sizeof *space);

        if (!space)
            return 1;
        {model}_initial_state(u, &p, x);
        for (int step = 0; step < 1000; ++step)
            if (!{model}_step(x, u, 1e-6, &p, booked, space))
                return 1;
        printf("U = %.17g J\\n", {model}_energy(x, &p));
        free(space);
        return 0;
    }}
"""


def c_step_header(program: Program, step: Collocation) -> str:
    """Return the text of the header of a model's step."""
    doc = "\n".join(f" * {line}".rstrip() for line in _doc(program, step))
    indent = " " * len(f"int {program.name}_step(")
    example = _example(program, step) if has_defaults(program) else ""
    words = {"opening": opening(program), "model": program.name, "p": pointer_name(program)}
    return _TEXT.format(**words, doc=doc, indent=indent, example=example)


def _example(program: Program, step: Collocation) -> str:
    """Return a program that takes a thousand steps, as part of a comment."""
    name, counts = program.name, program.counts
    inputs = ", ".join(str(program.defaults[field.name]) for field in program.inputs) or "0.0"
    sizes = {
        "n": sum(counts[field.bank] if field.bank else 1 for field in program.states),
        "booked": sum(counts[r.slot.bank] if r.slot.bank else 1 for r in step.stage.booked),
    }
    text = _EXAMPLE.format(model=name, inputs=inputs, **sizes)
    return "\n *\n" + "\n".join(f" * {line}".rstrip() for line in text.splitlines())


def _doc(program: Program, step: Collocation) -> Iterator[str]:
    """Yield the description of the function, and of each argument with its unit."""
    yield from wrapped(
        "Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's "
        "method. The booked energies and entropies close both balances to round-off. Returns 1 if "
        "the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the "
        "domain was found: a shorter one may exist. Most steps take two or three iterations, the "
        "hardest some thousand."
    )
    states = ", ".join(f"{field.spread} [{field.unit}]" for field in program.states)
    inputs = ", ".join(f"{field.name} [{field.unit}]" for field in program.inputs)
    yield from wrapped(f"x[n], read and written: {states}")
    yield from wrapped(
        f"u[{program.name}_input_count], read: {inputs or 'none'}; constant during the step"
    )
    yield from wrapped("h, read: the length of the step [s]")
    ports = ", ".join(field.name for field in program.outputs)
    processes = ", ".join(field.spread for field in program.processes)
    known = len(program.outputs) + 2 * len(program.processes)
    bodies = ", ".join(record.slot.label for record in step.stage.booked[known:])
    yield from wrapped(
        f"booked, written: energy supplied [J] by {ports or 'no port'}; then heat [J], and then "
        f"entropy produced [J/K], by {processes or 'no process'}"
        + (f"; then entropy [J/K] that heat exchange brings to {bodies}" if bodies else "")
    )
    size = f"{program.name}_step_size({pointer_name(program)})"
    yield from wrapped(
        f"space[{size}], read and written: set it to zero before the first step, then leave it "
        "as it is; it keeps the largest magnitude of each state, with which rounding errors are "
        "compared"
    )
