"""The functions of a state as vectors compute them: the generated source, read with vectors.

Input: the texts of a module's .h and .c.  Output: the file to compile for arrays of many states.
The source has no conditions of C there, and parameters are the same for all states of a call.
"""

import re

from piezo_sym.errors import EngineError
from piezo_sym.run.engine.driver import PLAIN, SCALARS
from piezo_sym.run.engine.texts import VECTORS, texts
from piezo_sym.run.engine.vector import NUMBER, defined, undefined

#: Functions of (x, u, p) that are computed so; those of (x, p) come on top.
DRIVEN = ("rhs", "outputs", "supply", "heat", "entropy_production")
WIDE = (*DRIVEN, *PLAIN, *SCALARS)

_HEAD = '#include "{model}.h"\n\n{vectors}\n#define MODEL(name) {model}_##name\n'
_ENTRY = """
static void {model}_wide_each_{name}(
    const real *x, const real *u, const {model}_parameters *p, real *out)
{{
    (void)u;
    {call};
}}
void {model}_{name}_wide(
    const double *x, const double *u, const {model}_parameters *p, double *out,
    long columns, const long *sizes, int own, real *space);
void {model}_{name}_wide(
    const double *x, const double *u, const {model}_parameters *p, double *out,
    long columns, const long *sizes, int own, real *space)
{{
    {model}_tiles({model}_wide_each_{name}, x, u, p, out, columns, sizes, own, space);
}}
"""
_POINTER = re.compile(r" *const double \*restrict (\w+) = \w+->\w+;")
_RULES = (
    (r"^( *const double \w+ =) (\w+->\w+);$", r"\1 wide(\2);"),
    (rf"^( *(?:(?:const )?double \w+ =|\w+\[.*\] =|\w+ =|return)) ({NUMBER});$", r"\1 wide(\2);"),
    (r"\bdouble\b", "real"),
)


def rates_text(model: str, source: str) -> str:
    """Return the text of the file to compile.

    Raises
    ------
    EngineError
        If the source lacks one of the functions.
    """
    functions = [_wide_function(model, name, source) for name in WIDE]
    head = _HEAD.format(model=model, vectors=texts(*VECTORS))
    entries = [_ENTRY.format(model=model, name=name, call=_call(model, name)) for name in WIDE]
    return "\n".join([head, defined(), *functions, undefined(), texts("rates.c"), *entries])


def _call(model: str, name: str) -> str:
    if name in SCALARS:
        return f"out[0] = {model}_wide_{name}(x, p)"
    return f"{model}_wide_{name}({'x, u, p, out' if name in DRIVEN else 'x, p, out'})"


def _wide_function(model: str, name: str, source: str) -> str:
    """Return one function with vectors for numbers; parameters stay numbers where they lie."""
    head = rf"^(void|double) {re.escape(model)}_{name}\("
    found = re.search(rf"{head}.*?^}}\n", source, re.DOTALL | re.MULTILINE)
    if not found:
        raise EngineError(f"the module has no function {name}", model, remedy="generate it again")
    text = re.sub(head, rf"static \1 {model}_wide_{name}(", found[0])
    lines = _without_directives(text.splitlines())
    lanes = [match[1] for line in lines if (match := _POINTER.fullmatch(line))]
    text = "\n".join(line if _POINTER.fullmatch(line) else _wide_line(line) for line in lines)
    for word in lanes:
        text = re.sub(rf"\b({word}\[\w+\])", r"wide(\1)", text)
    return f"{text}\n"


def _without_directives(lines: list[str]) -> list[str]:
    """Return lines without directives and the lines that continue them."""
    kept, inside = [], False
    for line in lines:
        inside = inside or line.startswith("#")
        if not inside:
            kept.append(line)
        inside = inside and line.endswith("\\")
    return kept


def _wide_line(line: str) -> str:
    for pattern, instead in _RULES:
        line = re.sub(pattern, instead, line)
    return line
