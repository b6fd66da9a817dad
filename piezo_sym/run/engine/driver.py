"""The C files that are compiled: a module with loops over many states, or a module's steps.

Input: a model's name.  Output: text.
"""

from piezo_sym.run.engine.texts import COLLOCATION, texts

#: Nodes for means over a step, beyond its stages.
MORE_NODES = 2

#: Functions of (x, u, p) and of (x, p), and those that give one number.
DRIVEN = ("rhs", "jacobian", "outputs", "supply", "heat", "entropy_production", "margins")
PLAIN = ("temperatures",)
SCALARS = ("energy", "entropy")

HEAD = '#include "{model}.c"\n'
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
#: One of these loops for arrays whose row i lies i*columns further, those of u if `own`: some
#: columns at a time are put where each is one piece, and rows put back.
TILES = """
enum {{ TILE = 16 }};
extern const long {model}_tile;
const long {model}_tile = TILE;
static inline void gather(double *to, const double *from, long rows, long columns, long count)
{{
    for (long i = 0; i < rows; ++i)
        for (long k = 0; k < count; ++k)
            to[k*rows + i] = from[i*columns + k];
}}
void {model}_of_columns(
    {model}_loop *loop, const double *x, const double *u, const {model}_parameters *p, double *out,
    long columns, long n, long m, long rows, int own, double *space);
void {model}_of_columns(
    {model}_loop *loop, const double *x, const double *u, const {model}_parameters *p, double *out,
    long columns, long n, long m, long rows, int own, double *space)
{{
    double *const from = space, *const given = from + TILE*n, *const to = given + TILE*m;
    for (long first = 0; first < columns; first += TILE) {{
        const long count = columns - first < TILE ? columns - first : TILE;
        gather(from, x + first, n, columns, count);
        if (own)
            gather(given, u + first, m, columns, count);
        loop(from, own ? given : u, p, to, count, n, own ? m : 0, rows);
        for (long i = 0; i < rows; ++i)
            for (long k = 0; k < count; ++k)
                out[i*columns + first + k] = to[k*rows + i];
    }}
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


def driver(model: str) -> str:
    """Return the text of the file to compile for the functions of a module."""
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
    return "".join([*parts, MEMBERS.format(model=model), TILES.format(model=model)])


def lanes_of(stages: int, layout: str, *, lossy: bool) -> int:
    """Return how many lanes vectors have that hold the stages of a step, or 0 if none do."""
    several = layout == "one" and stages > 1 and not lossy
    return 1 << (stages - 1).bit_length() if several else 0


def collocation(model: str, stages: int, layout: str, *, lossy: bool = False) -> str:
    """Return the text of the file to compile for collocation steps of so many stages.

    Parameters
    ----------
    layout, lossy : of `Sources`.
    """
    from piezo_sym.run.engine.tableau import tableau  # loads mpmath, once a compilation

    if layout == "slopes":
        model_text = [f'#include "{model}_step.c"', f"#define MODEL(name) {model}_##name"]
        return "\n".join(
            [texts("dual.h"), *model_text, tableau(stages, stages), texts("derivatives.c")]
        )
    lanes = lanes_of(stages, layout, lossy=lossy)
    vectors = ["#if !defined(PLAIN)", f"#define LANES {lanes}", texts("at_once.h"), "#endif"]
    head = [
        "#if defined(PLAIN)" if layout == "many" else "#if 1",
        "#define REAL_WIDTH 1",
        "#endif",
        texts("real.h"),
        *([f'#include "{model}.c"'] if lossy else []),
        f'#include "{model}_step.c"',
        f"#define MODEL(name) {model}_##name",
        "extern const long MODEL(width);",
        "const long MODEL(width) = REAL_WIDTH;",
        *(vectors * bool(lanes)),
    ]
    tables = tableau(stages, 1 if lossy else stages + MORE_NODES, lossy=lossy, lanes=lanes)
    gaps = texts("gaps.c")
    if lanes:
        gaps = f"#if defined(LANES)\n{texts('gaps_at_once.c')}\n#else\n{gaps}\n#endif"
    paths = ["#if defined(PATHS)", texts("stop.c"), "#endif"]
    rest = texts(*COLLOCATION, *(["loss.c"] * lossy))
    return "\n".join([*head, tables, texts("gauss.c", "bends.c"), *paths, gaps, rest])


def at_once(model: str, lanes: int) -> str:
    """Return the text of a file to compile beside that of steps: stages in so many lanes."""
    head = [
        "#if !defined(PLAIN)",
        f"#define REAL_WIDTH {lanes}",
        "#if defined(__GNUC__) /* of what is printed, some is for the engine alone */",
        '#pragma GCC diagnostic ignored "-Wunused-function"',
        '#pragma GCC diagnostic ignored "-Wunused-variable"',
        '#pragma GCC diagnostic ignored "-Wunused-const-variable"',
        "#endif",
        texts("real.h"),
        f'#include "{model}_step.c"',
        f"#define MODEL(name) {model}_##name",
    ]
    rest = ["#else", f"typedef int {model}_has_no_vectors;", "#endif"]
    return "\n".join([*head, texts("at_once.h", "at_once.c"), *rest])


def _loop(model: str, name: str, call: str, idle: str) -> str:
    return LOOP.format(model=model, name=name, call=call, idle=idle)
