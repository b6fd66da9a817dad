"""The step of a module as vectors compute it: the generated source, read with vectors for numbers.

Input: the texts of a module's .h and .c.  Output: the text to compile for many states side by side.
The step's part of the source has no conditions of C and no constants without type, so that its text
holds for vectors as it stands; here its numbers get the vector's type, its functions other names.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.run.engine.texts import LANES, VECTORS, texts

#: The line that opens the part of a source that holds for vectors too.
OPENING = "/* The step of the discrete gradient, of one state or of many side by side. */"
#: Functions of a step's text, and those for vectors that compute them; how many arguments.
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
    "atan": ("atan_of", 1),
    "sinh": ("sinh_of", 1),
    "cosh": ("cosh_of", 1),
    "erf": ("erf_of", 1),
    "pow": ("pow_of", 2),
    "min": ("least", 2),
    "max": ("largest", 2),
    "sign": ("sign_of", 1),
    "deadzone": ("deadzone_of", 2),
    "saturate": ("saturate_of", 2),
    "phi3": ("phi3_of", 1),
    "ramp": ("ramp_of", 2),
    "ramp_by_new": ("ramp_by_new_of", 2),
    "mean_deadzone": ("mean_deadzone_of", 3),
    "mean_deadzone_by_new": ("mean_deadzone_by_new_of", 3),
    "mean_deadzone_by_width": ("mean_deadzone_by_width_of", 3),
    "mean_sign": ("mean_sign_of", 2),
    "mean_sign_by_new": ("mean_sign_by_new_of", 2),
    "mean_tanh": ("mean_tanh_of", 2),
    "mean_tanh_by_new": ("mean_tanh_by_new_of", 2),
}
MOST_FACTORS = 8
#: What a step's function computes of the state before the step.
BEGINNING = r"^ */\* before the step \*/\n(?: *const double [^;]+;\n)+"
#: A definition, and its name.
DEFINED = r"^( *const \w+ (?:\*restrict )?(\w+) = [^;]+;)$"
#: An assignment on one line, and what in its right side is a number.
ASSIGNED = r"^( *(?:(?:const )?double \w+|\w+\[[^\]\n]*\]|\w+) =) ([^;\n]+);$"
NUMBER = r"\b\d[\d.]*(?:e[-+]?\d+)?\b\.?|\bHUGE_VAL\b"


def wide_text(model: str, header: str, source: str) -> str:
    """Return what a driver needs in addition to run paths of members side by side."""
    return "\n".join([texts(*VECTORS), wide_source(model, header, source), texts(*LANES)])


def has_step(source: str) -> bool:
    """Return whether the text of a module's .c has a part that holds for vectors."""
    return OPENING in source


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
    fields, counts = _fields(record[1])
    step, reciprocals = _reciprocals(step, fields)
    fields += reciprocals
    step, begun = _beginnings(model, step)
    step = _needed(step)
    for pattern, instead in (
        (r"^#pragma(?:[^\n]*\\\n)*[^\n]*\n", ""),
        (rf"^long {name}_newton_size\(.*?^}}\n", ""),
        (rf"\b{name}_(begin|newton|means|inside|parameters)\b", rf"{model}_wide_\1"),
        (rf"^int ({name}_wide_)", r"static mask \1"),
        (rf"^(void) ({name}_wide_)", r"static \1 \2"),
        (r"return 1;", "return none_of(nowhere);"),
        (ASSIGNED, _numbers_wide),
        (r"\bdouble\b", "real"),
    ):
        step = re.sub(pattern, instead, step, flags=re.MULTILINE | re.DOTALL)
    words, loader = _record(model, fields, counts, begun), _loader(model, fields, counts)
    return "\n".join((defined(), words, step, undefined(), loader))


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


@final
@dataclass(frozen=True)
class _Field:
    """A field of the parameters for vectors.

    Attributes
    ----------
    bank : the bank of which it has a number a lane; "" for a plain number.
    value : what it is of the parameters `p` of one state, of lane j if it has lanes.
    """

    name: str
    bank: str
    value: str


def _fields(record: str) -> tuple[list[_Field], list[str]]:
    """Return the parameters, and the counts of banks, of a record in C."""
    fields, counts = [], []
    for line in record.splitlines():
        found = re.match(
            r"\s*(double |const double \*|long )(\w+);(?:.*one a lane of (\w+))?", line
        )
        if found and found[1] == "long ":
            counts.append(found[2])
        elif found:
            bank = found[3] or ""
            fields.append(_Field(found[2], bank, f"p->{found[2]}{'[j]' if bank else ''}"))
    return fields, counts


def _reciprocals(step: str, fields: Sequence[_Field]) -> tuple[str, list[_Field]]:
    """Return a step that takes reciprocals of parameters from its record, and those fields.

    They are the same in every step, and divisions of vectors take long.
    """
    known = {field.name: field for field in fields}
    found: dict[str, _Field] = {}
    record = _pointer(step)

    def taken(match: re.Match[str]) -> str:
        of = known.get(match[2])
        if not of or bool(match[3]) != bool(of.bank):
            return match[0]
        field = _Field(f"per_{of.name}_", of.bank, f"1.0/{of.value}")
        found[field.name] = field
        return f"{match[1]} {record}->{field.name}{match[3] or ''};"

    text = re.sub(r"^( *const double \w+ =) 1\.0/(\w+)(\[j\])?;$", taken, step, flags=re.MULTILINE)
    return text, list(found.values())


def _beginnings(model: str, step: str) -> tuple[str, list[str]]:
    """Return a step that takes what is known before it from its record, and those fields.

    A function of its own computes them: once a step, not in each iteration.
    """
    record, values = _pointer(step), dict[str, str]()

    def taken(block: re.Match[str]) -> str:
        found = re.findall(r"^( *const double (\w+) =[^;]+;)$", block[0], re.MULTILINE)
        values.update((name, line) for line, name in found)
        return "".join(f"    const double {name} = {record}->{name}_;\n" for _, name in found)

    text = re.sub(BEGINNING, taken, step, flags=re.MULTILINE)
    body = list(values.values())
    lines = {name: line for line, name in re.findall(DEFINED, step, flags=re.MULTILINE)}
    for name, line in reversed(lines.items()):
        if name not in values and any(re.search(rf"\b{name}\b", other) for other in body):
            body.insert(0, line)
    body += [f"    {record}->{name}_ = {name};" for name in values]
    newton = re.search(r"_newton\(const double \*restrict (\w+),", step)
    x = newton[1] if newton else "x"
    head = f"void {model}_begin(const double *restrict {x}, {model}_parameters *restrict {record})"
    unused = [f"    (void){name};" for name in (x, record)]
    return "\n".join([head, "{", *unused, *body, "}\n", text]), [f"{name}_" for name in values]


def _pointer(step: str) -> str:
    """Return what a step's functions call the parameters."""
    found = re.search(r"_parameters \*restrict (\w+)", step)
    return found[1] if found else "p"


def _needed(step: str) -> str:
    """Return a step whose functions are without the parameters that they no longer name."""
    line = rf"^ *const double (?:\*restrict )?(\w+) = {_pointer(step)}->\1;\n"

    def needed(function: str) -> str:
        def kept(match: re.Match[str]) -> str:
            return match[0] if len(re.findall(rf"\b{match[1]}\b", function)) > 2 else ""

        return re.sub(line, kept, function, flags=re.MULTILINE)

    return "".join(map(needed, re.split(r"(?<=^}\n)", step, flags=re.MULTILINE)))


def _numbers_wide(match: re.Match[str]) -> str:
    """Return an assignment, its right side a vector if it is made of numbers alone."""
    left = re.sub(NUMBER, "", match[2])
    return match[0] if re.search(r"[^-+*/ ().]", left) else f"{match[1]} wide({match[2]});"


def _record(
    model: str, fields: Sequence[_Field], counts: Sequence[str], begun: Sequence[str]
) -> str:
    lines = [f"    long {name};" for name in counts]
    lines += [f"    real {'*' if field.bank else ''}{field.name};" for field in fields]
    lines += [f"    real {name};" for name in begun]
    return "\n".join(["typedef struct {", *lines, f"}} {model}_wide_parameters;"])


def _loader(model: str, fields: Sequence[_Field], counts: Sequence[str]) -> str:
    """Return functions that give parameters of banks their room, and put in those of one state."""
    placed, loaded = [f"    w->{name} = p->{name};" for name in counts], []
    for field in fields:
        if not field.bank:
            loaded.append(f"    w->{field.name}[lane] = {field.value};")
            continue
        count = f"p->{field.bank}_count"
        placed += [f"    w->{field.name} = space;", f"    space += {count};"]
        loaded += [
            f"    for (long j = 0; j < {count}; ++j)",
            f"        w->{field.name}[j][lane] = {field.value};",
        ]
    room = " + ".join(["0", *(f"p->{field.bank}_count" for field in fields if field.bank)])
    p, w = f"const {model}_parameters *p", f"{model}_wide_parameters *w"
    return "\n".join(
        [
            f"static long {model}_wide_room({p})",
            *("{", f"    (void)p;\n    return {room};", "}"),
            f"static void {model}_wide_place({w}, {p}, real *space)",
            *("{", "    (void)w;\n    (void)p;\n    (void)space;", *placed, "}"),
            f"static void {model}_wide_load({w}, {p}, int lane)",
            *("{", "    (void)w;\n    (void)p;\n    (void)lane;", *loaded, "}\n"),
        ]
    )
