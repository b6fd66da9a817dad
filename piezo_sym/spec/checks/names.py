"""Names of a spec: well formed, not reserved, and unique; texts of the law language."""

import re
from collections.abc import Iterable, Iterator
from fractions import Fraction
from keyword import iskeyword

from piezo_sym.errors import SpecError, quote
from piezo_sym.expressions.grammar import LARGEST, SMALLEST
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.fields import Tables
from piezo_sym.spec.names import check_name, check_symbol
from piezo_sym.spec.problems import all_faults
from piezo_sym.spec.tables import bank_of, bank_states, banks, bodies, laws

#: Variables of every result; see `run`.
RESULTS = frozenset({"time", "energy", "entropy", "energy_residual", "entropy_residual"})
#: What generated modules import.
IMPORTS = frozenset({"numpy", "typing", "dataclasses", "math"})
PREFIXES = ("y_", "supplied_", "heat_", "produced_", "entropy_exchanged_")


def check_texts(spec: Tables) -> None:
    """Check that each law can be parsed; later errors could not name its place."""
    with all_faults() as kept:
        for law in laws(spec):
            with kept():
                parse_law(law.text, law.where)


def check_names(spec: Tables) -> None:
    """Check the model's name, every symbol, every element's name and every unit."""
    check_model_name(spec.model.name, "model.name")
    for name in spec.elements:
        check_name(name, f"elements.{name}")
    _check_banks(spec)
    _check_case((*spec.elements, *banks(spec)))
    symbols = list(_symbols(spec))
    taken = {symbol for symbol, _ in symbols}
    for symbol, where in symbols:
        check_symbol(symbol, where, taken)
    _check_unique(spec, symbols)
    _check_reserved(spec, symbols)
    with all_faults() as kept:
        for name, parameter in spec.parameters.items():
            given = parameter.value if isinstance(parameter.value, tuple) else (parameter.value,)
            with kept():
                _check_unit(parameter.unit, given, f"parameters.{name}")
        for name, entry in spec.inputs.items():
            with kept():
                _check_unit(entry.unit, (entry.default,), f"inputs.{name}")


def check_model_name(word: str, where: str) -> str:
    """Return `word` if it can name a model, and so a generated module.

    Raises `SpecError` if it cannot be a file's name, or a module of that name would hide one of
    Python's.
    """
    check_name(word, where)
    if iskeyword(word) or word in IMPORTS:
        what = f"{quote(word)} is a word of Python's that the module would hide"
        raise SpecError(what, where, remedy=f"call it '{word}_model'")
    return word


def _check_unit(text: str, values: tuple[float, ...], where: str) -> None:
    """Check a unit, and that the values given in it exist in SI."""
    unit = parse_unit(text, f"{where}.unit", values[0] if len(values) == 1 else None)
    for value in values:
        size = abs(Fraction(repr(value)) * unit.factor)
        if size and not SMALLEST <= size <= LARGEST:
            what = f"{value} {quote(text)} is beyond all numbers in SI"
            raise SpecError(what, where, "1e-300 to 1e300 in SI", "check the unit")


def _symbols(spec: Tables) -> Iterator[tuple[str, str]]:
    yield from ((name, f"parameters.{name}") for name in spec.parameters)
    yield from ((name, f"inputs.{name}") for name in spec.inputs)
    for name, element in spec.elements.items():
        yield from ((symbol, f"elements.{name}") for symbol in element.own_states(name))


def _check_case(elements: Iterable[str]) -> None:
    seen: dict[str, str] = {}
    for name in elements:
        other = seen.setdefault(name.lower(), name)
        if other != name:
            what = f"{quote(name)} and {quote(other)} differ only by case"
            raise SpecError(what, f"elements.{name}", remedy="rename one: names become files")


def _check_banks(spec: Tables) -> None:
    """Check that no bank has an element's name, and that its elements agree in their count."""
    same = {bank: name for name, bank in bank_of(spec).items()}
    for name, bank in bank_of(spec).items():
        where = f"elements.{name}"
        check_name(bank, f"{where}.bank")
        if bank != name and bank in spec.elements:
            what = f"bank {quote(bank)} has the name of an element"
            raise SpecError(what, where, remedy="rename one of them")
        for field in ("count", "series"):
            given, other = (getattr(spec.elements[n], field) for n in (name, same[bank]))
            if given != other:
                what = f"bank {quote(bank)} has another {field} in {quote(same[bank])}"
                raise SpecError(what, f"{where}.{field}", f"{other}, not {given}")
    for name, element in spec.elements.items():
        for field in ("bank", "series") if getattr(element, "count", None) is None else ():
            if getattr(element, field, None) is not None:
                raise SpecError(f"{field} is given without count", f"elements.{name}", "both")


def _quantities(spec: Tables) -> Iterator[tuple[str, str]]:
    """Yield the names of the quantities that banks have per lane, and their banks."""
    for name, bank in bank_of(spec).items():
        for port in spec.elements[name].ports(name):
            words = (getattr(port, field, "") for field in ("costate", "output", "effort", "rate"))
            yield from ((word, bank) for word in words if word)


def _check_unique(spec: Tables, symbols: list[tuple[str, str]]) -> None:
    seen: dict[str, str] = {}
    for symbol, where in symbols:
        if symbol in seen:
            what = f"symbol {quote(symbol)} is already that of {seen[symbol]}"
            remedy = "give one of them another name"
            if where.startswith("elements."):
                states = getattr(spec.elements[where.removeprefix("elements.")], "states", None)
                remedy = f"set 'state' in {where} to another symbol"
                remedy = f"call it otherwise in {where}.states and energy" if states else remedy
            raise SpecError(what, where, remedy=remedy)
        seen[symbol] = where


def _check_reserved(spec: Tables, symbols: list[tuple[str, str]]) -> None:
    """Refuse symbols that are names of results, lanes, temperatures or bank sizes."""
    sizes = banks(spec)
    results = {f"{prefix}{name}" for prefix in PREFIXES for name in spec.elements}
    uses = dict.fromkeys(RESULTS | results, "a variable of every result")
    uses |= {f"{name}_count": f"the size of bank '{name}'" for name in (*spec.elements, *sizes)}
    uses |= dict.fromkeys(sizes, "the dimension of a bank")
    uses |= {f"T_{name}": f"the temperature of '{name}'" for name in bodies(spec)}
    lanes = {s: f"bank state '{s}'" for s in bank_states(spec)}
    lanes |= {p: f"'{p}'" for p, entry in spec.parameters.items() if isinstance(entry.value, tuple)}
    lanes |= {word: f"bank '{bank}'" for word, bank in _quantities(spec)}
    taken = {symbol for symbol, _ in symbols}
    for symbol, where in symbols:
        use, remedy = uses.get(symbol), "rename it"
        base, _, lane = symbol.rpartition("_")
        if base in lanes and re.fullmatch(r"j|[1-9]\d*", lane):  # lanes are counted from 1
            use = f"a lane of {lanes[base]}, called {base}_1, {base}_2 ... in results and equations"
            offers = (f"{base}{lane}{more}" for more in ("", "a", "b", "c"))
            free = next((offer for offer in offers if offer not in taken), "")
            remedy = f"call it '{free}'" if free else remedy
        if use:
            raise SpecError(f"symbol {quote(symbol)} is {use}", where, remedy=remedy)
