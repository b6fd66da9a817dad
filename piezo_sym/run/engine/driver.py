"""The C file that is compiled: a module, loops over the columns of a batch, and runs of steps.

Input: a model's name, and whether it has a dissipative step.  Output: text.  A column is one state;
columns lie one after another.
"""

from piezo_sym.run.engine.texts import COLLOCATION, STEPS, texts

#: Nodes for means over a step, beyond its stages.
MORE_NODES = 2

#: Functions of (x, u, p) and of (x, p), and those that give one number.
DRIVEN = ("rhs", "jacobian", "outputs", "supply", "heat", "entropy_production", "margins")
PLAIN = ("temperatures",)
SCALARS = ("energy", "entropy")

HEAD = '#include "{model}.c"\n\n#include <string.h>\n'
#: Columns of x, u and the result are n, m and rows apart; m is 0 where all columns share u.
LOOP = """
void {model}_{name}_columns(
    const double *x, const double *u, const {model}_parameters *p, double *out,
    long columns, long n, long m, long rows);
void {model}_{name}_columns(
    const double *x, const double *u, const {model}_parameters *p, double *out,
    long columns, long n, long m, long rows)
{{
    {idle}
    for (long column = 0; column < columns; ++column) {{
        {call}
    }}
}}
"""
#: One of these loops for many members: columns of x are shared by none, those of u by all.
MEMBERS = """
typedef void {model}_loop(
    const double *x, const double *u, const {model}_parameters *p, double *out,
    long columns, long n, long m, long rows);
void {model}_of_members(
    {model}_loop *loop, const {model}_parameters *const *p, long members,
    const double *x, const double *u, double *out, long columns, long n, long m, long rows);
void {model}_of_members(
    {model}_loop *loop, const {model}_parameters *const *p, long members,
    const double *x, const double *u, double *out, long columns, long n, long m, long rows)
{{
    for (long k = 0; k < members; ++k)
        loop(x + k*columns*n, u, p[k], out + k*columns*rows, columns, n, m, rows);
}}
"""
#: Who compiled the file, for the attributes of a run.
MAKER = """
#if defined(__clang__)
#define MAKER "clang " __clang_version__
#elif defined(__GNUC__)
#define MAKER "gcc " __VERSION__
#else
#define MAKER "a C compiler"
#endif
extern const char {model}_compiler[];
const char {model}_compiler[] = MAKER;
"""


def driver(model: str, *, starts: bool) -> str:
    """Return the text of the file to compile."""
    at = "x + column*n, u + column*m, p, out + column*rows"
    parts = [HEAD.format(model=model), MAKER.format(model=model)]
    for name in DRIVEN:
        parts.append(_loop(model, name, f"{model}_{name}({at});", ""))
    for name in PLAIN:
        call = f"{model}_{name}(x + column*n, p, out + column*rows);"
        parts.append(_loop(model, name, call, "(void)u; (void)m;"))
    for name in SCALARS:
        call = f"out[column*rows] = {model}_{name}(x + column*n, p);"
        parts.append(_loop(model, name, call, "(void)u; (void)m;"))
    parts.append(MEMBERS.format(model=model))
    parts.append(f"\n#define MODEL(name) {model}_##name\n#define STARTS {int(starts)}\n")
    return "".join([*parts, texts(*STEPS)])


def collocation(model: str, stages: int, layout: str) -> str:
    """Return the text of the file to compile for collocation steps of so many stages.

    Parameters
    ----------
    layout : of `Sources`.
    """
    from piezo_sym.run.engine.tableau import tableau  # loads mpmath, once a compilation

    head = [
        "#if defined(PLAIN)" if layout == "many" else "#if 1",
        "#define REAL_WIDTH 1",
        "#endif",
        texts("real.h"),
        f'#include "{model}_step.c"',
        f"#define MODEL(name) {model}_##name",
        "extern const long MODEL(width);",
        "const long MODEL(width) = REAL_WIDTH;",
    ]
    return "\n".join([*head, tableau(stages, stages + MORE_NODES), texts(*COLLOCATION)])


def _loop(model: str, name: str, call: str, idle: str) -> str:
    return LOOP.format(model=model, name=name, call=call, idle=idle)
