"""The header of a C module: a description, the parameters, and the declarations of functions.

Input: a `Program`.  Output: the text of ``<model>.h``.  Texts of a spec are in comments only,
changed so that they cannot end one.
"""

from collections.abc import Iterator, Mapping, Sequence
from textwrap import wrap

from piezo_sym.codegen.c.style import PART, c_names, fresh_names
from piezo_sym.codegen.layout import size_in_words
from piezo_sym.codegen.program import Described, Program, head_lines
from piezo_sym.errors import one_line

WIDTH = 96
MOST_LANES = 16  # of a bank whose values are in the header
#: Docstrings of functions that the program does not describe.
FUNCTIONS = {
    "states": "Number of states n",
    "processes": "Number of processes, which produce entropy; of a bank, one per lane",
    "jacobian": "Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]",
    "margins": "Margin by which each condition of the domain holds; of a bank, the least one",
}
_ORDER = (
    "states processes initial_state rhs jacobian outputs supply energy entropy temperatures heat "
    "entropy_production elements margins"
)
SCALARS = {"states": "long", "processes": "long", "energy": "double", "entropy": "double"}


def c_header(program: Program) -> str:
    """Return the text of a program's C header."""
    guard = f"PIEZO_SYM_{program.name}_H"
    parts = [
        f"{opening(program)}\n#ifndef {guard}\n#define {guard}",
        '#ifdef __cplusplus\nextern "C" {\n#endif',
        "\n".join(_parameters(program)),
        "\n".join(_numbers(program)),
        *_declarations(program),
        f"#ifdef __cplusplus\n}}\n#endif\n\n#endif /* {guard} */",
    ]
    return "\n\n".join(parts) + "\n"


def text_of(text: str) -> str:
    """Return text from a spec, changed so that it cannot end, open or continue a comment."""
    plain = one_line(text).replace("\\", "/")
    for pair, apart in (("*/", "* /"), ("/*", "/ *"), ("??", "? ?")):
        while pair in plain:
            plain = plain.replace(pair, apart)
    return plain


def opening(program: Program) -> str:
    """Return the comment at the head of both files."""
    notes = ["C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno."]
    p = pointer_name(program)
    lines = head_lines(program, text_of, notes, (p, f"pointer to {program.name}_parameters"))
    return "\n".join(["/*", *(f" * {line}".rstrip() for line in lines), " */"])


def pointer_name(program: Program) -> str:
    """Return the name of the pointer to parameters in functions: p, or p_ if that is taken."""
    return fresh_names(("p",), program, c_names(program))["p"]


def _parameters(program: Program) -> Iterator[str]:
    names = c_names(program)
    yield "/* Parameters in SI units. The caller sets all; comments show the values of the spec. */"
    yield "typedef struct {"
    for field in program.parameters:
        value = program.defaults[field.name]
        spec = "a list" if isinstance(value, tuple) else value
        name = f"*{names[field.name]}" if field.bank else names[field.name]
        lane = f", one per lane of {field.bank}" if field.bank else ""
        renamed = f"{field.name}: " if names[field.name] != field.name else ""
        doc = f"{field.doc} " if field.doc else ""
        note = text_of(f"{renamed}{doc}[{field.unit}]{lane}")
        yield f"    {'const ' if field.bank else ''}double {name}; /* {note}; spec: {spec} */"
    for bank, count in program.counts.items():
        yield f"    long {bank}_count; /* lanes of {bank}, at least 1; spec: {count} */"
    if not program.parameters and not program.counts:
        yield "    char none; /* a model without parameters: C99 has no empty struct */"
    yield f"}} {program.name}_parameters;"
    yield from _defaults(program, names)


def _defaults(program: Program, names: Mapping[str, str]) -> Iterator[str]:
    """Yield the values of the spec as an initializer, unless a bank is large."""
    if has_defaults(program):
        fields = []
        for field in program.parameters:
            value = program.defaults[field.name]
            if field.bank:
                lanes = value if isinstance(value, tuple) else (value,) * program.counts[field.bank]
                value = f"(const double[]){{{', '.join(lanes)}}}"
            fields.append(f".{names[field.name]} = {value}")
        fields += [f".{bank}_count = {count}" for bank, count in program.counts.items()]
        fields += [] if fields else [".none = 0"]
        yield ""
        arrays = "; change a count together with its arrays" if program.counts else ""
        yield f"/* An initializer for parameters: the values of the spec{arrays}. */"
        yield f"#define {program.name}_DEFAULTS {{ \\"
        yield from (f"    {field}, \\" for field in fields)
        yield "}"


def has_defaults(program: Program) -> bool:
    """Return whether the header has an initializer, which it has if no bank is large."""
    return all(count <= MOST_LANES for count in program.counts.values())


def _numbers(program: Program) -> Iterator[str]:
    """Yield the sizes that do not depend on the sizes of banks."""
    sizes = {
        "input": program.inputs,
        "output": program.outputs,
        "body": program.bodies,
        "condition": program.limits,
    }
    yield "/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */"
    yield "enum {"
    for word, fields in sizes.items():
        yield f"    {program.name}_{word}_count = {len(fields)},"
    yield "};"


def declaration(
    program: Program,
    name: str,
    arguments: Sequence[str],
    words: Mapping[str, str],
    number: str = "",
) -> str:
    """Return the first lines of a function, without body and semicolon.

    `number` is the type in which a definition computes; it is empty in a declaration for callers.
    """
    restrict = "restrict " if number else ""
    record = "reals" if number == "real" else "parameters"
    types = dict.fromkeys("xgbu", f"const {number or 'double'} *{restrict}")
    types |= dict.fromkeys(("out", "rows", "s", "m"), f"{number or 'double'} *{restrict}")
    types["p"] = f"const {program.name}_{record} *{restrict}"
    static = "static " if number == "real" or PART.search(name) else ""
    start = f"{static}{SCALARS.get(name, 'void')} {program.name}_{name}("
    texts = [f"{types[argument]}{words[argument]}" for argument in arguments]
    line = f"{start}{', '.join(texts)})"
    if len(line) <= WIDTH:
        return line
    return start + f",\n{' ' * len(start)}".join(texts) + ")"


def _declarations(program: Program) -> Iterator[str]:
    docs = {**FUNCTIONS, **{function.name: function.doc for function in program.functions}}
    takes = {f.name: (*f.arguments, *([] if f.scalar else ["out"])) for f in program.functions}
    takes |= dict.fromkeys(("states", "processes"), ("p",))
    words = fresh_names(("x", "u", "p", "out", "n", "j", "l", "left"), program, c_names(program))
    for name in filter(docs.__contains__, _ORDER.split()):
        arguments = takes.get(name, ("x", "u", "p", "out"))
        lines = [*wrapped(f"{docs[name]}."), *_argument_lines(program, name, arguments, words)]
        head = declaration(program, name, arguments, words)
        yield "\n".join(["/*", *(f" * {line}".rstrip() for line in lines), " */", f"{head};"])


def wrapped(text: str) -> list[str]:
    """Return the lines of a text in a comment."""
    return wrap(text_of(text), WIDTH - 4, subsequent_indent="    ")


def _argument_lines(
    program: Program, name: str, arguments: Sequence[str], words: Mapping[str, str]
) -> Iterator[str]:
    """Yield the description of each argument, with units."""
    processes = f"{program.name}_processes({words['p']})"
    elements = size_in_words([field.slot for field in program.elements])
    results = {
        "initial_state": ("n", program.states),
        "temperatures": (f"{program.name}_body_count", program.bodies),
        "outputs": (f"{program.name}_output_count", program.outputs),
        "heat": (processes, ()),
        "entropy_production": (processes, ()),
        "supply": (f"{program.name}_output_count", ()),
        "rhs": ("n", ()),
        "jacobian": ("n*n", ()),
        "elements": (elements, program.elements),
        "margins": (f"{program.name}_condition_count", ()),
    }
    layouts: dict[str, tuple[str, Sequence[Described]]] = {
        "x": ("n", program.states),
        "u": (f"{program.name}_input_count", program.inputs),
        "out": results.get(name, ("", ())),
    }
    for argument in (word for word in arguments if word != "p"):
        size, fields = layouts[argument]
        listed = ", ".join(f"{field.spread} [{field.unit}]" for field in fields)
        role = "written; must not overlap another argument" if argument == "out" else "read"
        units = f": {listed}" if listed else ""
        yield from wrapped(f"{words[argument]}[{size}], {role}{units}")
    if name == "margins":
        for n, limit in enumerate(program.limits):
            inside = "> 0" if limit.strict else ">= 0"
            yield from wrapped(f"{words['out']}[{n}] {inside} where {limit.text}")


def comment(doc: str) -> list[str]:
    """Return the lines of a comment."""
    lines = wrap(text_of(f"{doc}."), WIDTH - 4)
    if len(lines) == 1:
        return [f"/* {lines[0]} */"]
    return ["/*", *(f" * {line}" for line in lines), " */"]
