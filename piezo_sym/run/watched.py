"""What a user asks of a run by name: quantities of elements, events, the condition that ends it.

Input: names, as `damper.heat`; texts in the language of laws over states, inputs, `y_<port>`,
`T_<body>`, `<element>.<quantity>` and parameters.  Output: names in the module's order; `Watched`.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from typing import final

from piezo_sym.errors import PiezoError, UsageError, listing, nearest, quote, similar
from piezo_sym.expressions.dimensions import dimension
from piezo_sym.expressions.incomplete import CONSTANTS, OR, conditions_of
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ZERO, Add, Call, Expr, Mul, Neg, Num, names, rename, walk
from piezo_sym.run.checks import is_vector
from piezo_sym.run.dataset import Named, Trajectory, named_rows
from piezo_sym.run.module import GeneratedModule, row_names
from piezo_sym.run.system import DrivenModule

#: The argument that selects quantities of elements, and its value for all of them.
OUTPUTS, EVERY = "simulate.outputs", "all"
KNOWN = "a state, input, y_<port>, T_<body> or parameter"
#: A quantity of an element, as `spring.effort`: no name of the language of laws.
QUANTITY = re.compile(r"\b([A-Za-z_]\w*)\.([A-Za-z_]\w*)")
#: A number with a unit, which the language does not have either.
WITH_UNIT = re.compile(r"(?<![\w.])(\d+\.?\d*(?:[eE][-+]?\d+)?) ?([^\W\d_]+(?:/[^\W\d_]+)*)")
#: Two sides of a condition are equal if they differ by this part: an effort stays at its limit.
ROUND_OFF = Fraction(1, 2**49)


@final
@dataclass(frozen=True)
class Watched:
    """Events (name -> expression), and the condition that ends a run.

    `stop` is positive where `condition`, its text, holds, and zero at its edge, which belongs to it
    if it is `closed`. `signs` are those of the events, and of `stop` as "", at the last sample so
    far, with which the next window of a run goes on.
    """

    event: Mapping[str, Expr]
    stop: Expr | None
    condition: str = ""
    closed: bool = False
    signs: dict[str, float] = field(default_factory=dict)

    def __bool__(self) -> bool:
        """Return whether there is an event or a condition."""
        return bool(self.event) or self.stop is not None


def read_outputs(module: GeneratedModule, outputs: object) -> tuple[str, ...]:
    """Return the selected quantities of elements, in the module's order."""
    names = tuple(record.name for record in module.ELEMENTS)
    if outputs is None:
        return ()
    if outputs == EVERY:
        return names
    if isinstance(outputs, str):
        outputs = [outputs]
    if not is_vector(outputs):
        expected = f"'{EVERY}', or a list of elements and quantities such as 'damper.heat'"
        raise UsageError(f"{quote(outputs)} is no list of names", OUTPUTS, expected)
    wanted = set[str]()
    for output in outputs:  # type: ignore[attr-defined]  # a vector
        matching = [name for name in names if output in (name, name.rpartition(".")[0])]
        if not matching:
            remedy = element_remedy(str(output), names)
            expected = "elements and their quantities, beside what every run has, as y_<port>"
            raise UsageError(f"unknown name {quote(output)}", OUTPUTS, expected, remedy)
        wanted.update(matching)
    return tuple(name for name in names if name in wanted)


def element_remedy(output: str, names: tuple[str, ...]) -> str:
    """Return what to write for an unknown element or quantity of one: the known `names`."""
    element = output.rpartition(".")[0]
    known = [name.rpartition(".") for name in names]
    if quantities := [quantity for other, _, quantity in known if other == element]:
        return f"'{element}' has {listing(quantities)}"
    elements = [*dict.fromkeys(other for other, _, _ in known)]
    return nearest(output, [*elements, *names] if similar(output, names) else elements)


def element_variables(
    system: DrivenModule, run: Trajectory, names: tuple[str, ...]
) -> Iterator[Named]:
    """Yield the quantities of elements with these names over a run."""
    if names:
        module = system.module
        values = module.elements(run.states, run.inputs, system.parameters)
        for name, variable in named_rows(system, ("time",), module.ELEMENTS, values):
            if name in names:
                yield name, variable


def read_watched(system: DrivenModule, events: object, stop: object, step: object) -> Watched:
    """Return a user's events and condition; raise `UsageError` for a run with a fixed step."""
    given = {} if events is None else events
    if not isinstance(given, Mapping):
        expected = 'name -> expression, such as {"hit": "q - 1e-3"}'
        raise UsageError(f"{quote(given)} is no mapping", "simulate.events", expected)
    if step is not None and (given or stop is not None):
        what = "with a fixed step, events are not located"
        raise UsageError(what, "simulate.step", "rtol", "leave out step, or events and stop")
    if not given and stop is None:
        return Watched({}, None)
    known = quantities(system)
    laws = {}
    for name, text in given.items():
        where = f"simulate.events.{name}"
        if not isinstance(name, str) or not name.isidentifier() or name in {*known, "time"}:
            taken = ": a quantity or a parameter has that name"
            why = taken if name in {*known, "time"} else ""
            what = f"{quote(name)} cannot name an event{why}"
            raise UsageError(what, "simulate.events", "a new name of letters, digits and _")
        law = _parsed(parse_law, text, where, '"q - 1e-3"', "{}")
        laws[name] = _checked(law, known, where)
    if stop is None:
        return Watched(laws, None)
    where = "simulate.stop"
    margin = _parsed(_to_round_off, stop, where, '"T_body > 350"', "{} > 0")
    closed = "=" in parse_condition(_plain(str(stop)), where).op
    return Watched(laws, _checked(margin, known, where), str(stop), closed)


def _plain(text: str) -> str:
    """Return a text with names in place of quantities of elements; no spec has such names."""
    return QUANTITY.sub(r"_\1_\2", text)


def _to_round_off(text: str, where: str) -> Expr:
    """Return the margin of a comparison; of `>=` and `<=`, with the round-off of its terms."""
    margin = _margin(text, where)
    if parse_condition(text, where).op in {">", "<"} or not isinstance(margin, Add):
        return margin
    sizes = Add(tuple(Call("abs", (term,)) for term in margin.terms))
    return Add((margin, Mul(Num(ROUND_OFF), sizes)))


def _margin(text: str, where: str) -> Expr:
    """Return what is positive where a comparison holds."""
    condition = parse_condition(text, where)
    sides = condition.left, condition.right
    more, less = sides if condition.op in {">", ">="} else sides[::-1]
    return more if less == ZERO else Add((more, Neg(less)))


def _margin_of_several(text: str, where: str) -> Expr:
    """Return what is positive where comparisons hold that are joined by 'and' or 'or'."""
    for function, parts in (("max", OR.split(text, maxsplit=1)), ("min", conditions_of(text))):
        if len(parts) > 1:
            return Call(function, tuple(_margin_of_several(part, where) for part in parts))
    return _margin(text, where)


def _parsed(
    read: Callable[[str, str], Expr], text: object, where: str, such: str, form: str
) -> Expr:
    """Return the parsed text; if only a condition may stand there, the remedy has it in `form`."""
    if not isinstance(text, str):
        raise UsageError(f"{quote(text)} is no text", where, f"text such as {such}")
    plain = _plain(text)
    spelled = {
        f"_{element}_{word}": f"{element}.{word}" for element, word in QUANTITY.findall(text)
    }
    try:
        return rename(read(plain, where), spelled)
    except PiezoError as error:
        said = [error.what, error.expected, error.remedy]
        with suppress(PiezoError):
            said[2] = _in_si(text, where) or said[2]
        with suppress(PiezoError):
            said[2] = f"write '{form.format(spell(_margin_of_several(plain, where)))}'"
        for name, own in spelled.items():
            said = [part.replace(name, own) for part in said]
        what, expected, remedy = said
        raise UsageError(what, where, expected, remedy) from error


def _in_si(text: str, where: str) -> str:
    """Return how to write the first number with a unit, as in q > 1um, or ''."""
    found = WITH_UNIT.search(text)
    if found is None:
        return ""
    from piezo_sym.expressions.units import parse_unit, to_si

    value = to_si(float(found[1]), parse_unit(found[2], where))
    return f"write numbers in SI: {value:g} for {found[0]}"


def _checked(tree: Expr, words: Mapping[str, str], where: str) -> Expr:
    """Return a tree whose names are known, and whose sums have terms of equal units."""
    for name in names(tree):
        if name not in words:
            dotted = tuple(word for word in words if "." in word)
            own = (word for word in words if word not in dotted)
            remedy = element_remedy(name, dotted) if "." in name else ""
            remedy = remedy or CONSTANTS.get(name) or nearest(name, own)
            what = f"events and stop know no {quote(name)}"
            expected = f"{KNOWN}, or a quantity of an element, such as '{dotted[0]}'"
            raise UsageError(what, where, expected, remedy)
    _check_sums(tree, words, where)
    return tree


def _check_sums(tree: Expr, units: Mapping[str, str], where: str) -> None:
    """Refuse sums and comparisons of quantities of different units; a number may have any."""
    from piezo_sym.expressions.units import parse_unit

    known = {name: parse_unit(units[name]).dimension for name in names(tree)}
    for total in (part for part in walk(tree) if isinstance(part, Add)):
        terms = [t for t in total.terms if not any(isinstance(part, Num) for part in walk(t))]
        for one, other in pairwise(terms):
            if dimension(one, known) != dimension(other, known):
                told = (f"{name} in {units[name]}" for name in (*names(one), *names(other)))
                what = f"adds or compares what has different units: {listing(dict.fromkeys(told))}"
                raise UsageError(what, where, "equal units")


def quantities(system: DrivenModule) -> dict[str, str]:
    """Return the unit of all that may be watched by name, in the order of its values."""
    module, p = system.module, system.parameters
    tables = (
        (module.STATES, ""),
        (module.INPUTS, ""),
        (module.OUTPUTS, "y_"),
        (module.BODIES, "T_"),
        (module.PARAMETERS, ""),
        (module.ELEMENTS, ""),
    )
    return {
        f"{prefix}{name}": record.unit
        for records, prefix in tables
        for record in records
        for name in row_names([record], p)
    }
