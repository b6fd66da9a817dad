"""The data of a printed step: the record of parameters, the functions that fill it, and tables.

Input: the tokens of ``<model>_step.c``.  The record and what fills it are taken word for word.  Of
the tables it matters which margins of a stage have to be positive; the others serve Newton's method
alone, and only have to be tables.
"""

from piezo_sym.spec.model import Model
from piezo_sym.spec.tables import banks, lane_parameters
from piezo_sym.translation.c_text import Tokens
from piezo_sym.translation.field import NotShownError

Tables = dict[str, list[int]]


def take_record(tokens: Tokens, model: Model) -> dict[str, str]:
    """Take the record ``<model>_reals``; return its fields by the names of the spec."""
    fields, own = dict[str, str](), lane_parameters(model)
    counts = [f"{bank}_count" for bank in banks(model)]
    tokens.take("typedef", "struct", "{")
    for name in (*model.parameters, *counts):
        words = "double *" if name in own else "long" if name in counts else "double"
        tokens.take(*words.split())
        fields[name] = tokens.word()
        if fields[name].rstrip("_") != name.rstrip("_"):
            raise NotShownError(f"the record of parameters has no {name} at its place")
        tokens.take(";")
    if not fields:
        tokens.take("char", "none", ";")
    tokens.take("}", f"{model.name}_reals", ";")
    return fields


def take_place(tokens: Tokens, model: Model, fields: dict[str, str]) -> None:
    """Take the function that says where the parameters of lanes stand."""
    counts = [fields[f"{bank}_count"] for bank in banks(model)]
    words = [] if counts else ["( void ) to ; ( void ) from ;"]
    words += ["double * const begin = at ;"]
    words += [f"to -> {count} = from -> {count} ;" for count in counts]
    for name, bank in lane_parameters(model).items():
        words.append(f"to -> {fields[name]} = at ;")
        words.append(f"at += from -> {fields[f'{bank}_count']} ;")
    _take(tokens, model, "long", "place_reals", "double * at", [*words, "return at - begin ;"])


def take_give(tokens: Tokens, model: Model, fields: dict[str, str]) -> None:
    """Take the function that gives a lane the parameters of a run."""
    words, own = ["( void ) lane ;"], lane_parameters(model)
    for name in model.parameters:
        place = ""
        if name in own:
            count, place = fields[f"{own[name]}_count"], "[ j ] "
            words.append(f"for ( long j = 0 ; j < from -> {count} ; ++ j )")
        words.append(f"OF ( to -> {fields[name]} {place}, lane ) = from -> {fields[name]} {place};")
    words += [] if model.parameters else ["( void ) to ; ( void ) from ;"]
    _take(tokens, model, "void", "give", "int lane", words)


def _take(tokens: Tokens, model: Model, kind: str, name: str, last: str, words: list[str]) -> None:
    head = f"{kind} {model.name}_{name} ( {model.name}_reals * to , "
    head += f"const {model.name}_parameters * from , {last} )"
    tokens.take(*head.split(), "{", *" ".join(words).split(), "}")


def take_enumeration(tokens: Tokens) -> Tables:
    """Take what stands behind ``enum``: whole numbers by name."""
    found = Tables()
    tokens.take("{")
    while not tokens.taken("}"):
        name = tokens.word()
        tokens.take("=")
        found[name] = [_number(tokens)]
        if tokens.peek() != "}":
            tokens.take(",")
    tokens.take(";")
    return found


def take_table(tokens: Tokens) -> Tables:
    """Take what stands behind ``static const``: a list of whole numbers."""
    tokens.take("int")
    name, numbers = tokens.word(), list[int]()
    tokens.take("[", "]", "=", "{")
    while not tokens.taken("}"):
        numbers.append(_number(tokens))
        tokens.take(",")
    tokens.take(";")
    return {name: numbers}


def _number(tokens: Tokens) -> int:
    turn, text = (-1 if tokens.taken("-") else 1), tokens.next()
    if not text.isdecimal() or (text[0] == "0" and text != "0"):
        raise NotShownError(f"the step has {text[:20]!r} where a whole number should be")
    return turn * int(text)


def strict(tables: Tables, model: str) -> list[int]:
    """Return of each margin of a stage whether it has to be positive; else it may be zero."""
    limits, found = tables.get(f"{model}_limits"), tables.get(f"{model}_strict")
    if not limits or found is None or len(found) != max(1, *limits):
        raise NotShownError("the step does not say which of its limits are strict")
    return found[: limits[0]]
