"""References and laws of a spec: what they name exists, and the text is of the law language."""

from collections import ChainMap
from collections.abc import Collection, Mapping

from piezo_sym.errors import SpecError, listing, nearest, quote
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import Node, names
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.elements import KINDS, LETTERS
from piezo_sym.spec.elements.base import Element, state_symbol
from piezo_sym.spec.elements.marks import LawField
from piezo_sym.spec.elements.ports import Exchange, HeatInput, Source
from piezo_sym.spec.fields import Tables
from piezo_sym.spec.names import NAME
from piezo_sym.spec.tables import (
    Condition,
    bank_of,
    bank_states,
    banks,
    bodies,
    conditions,
    initial_laws,
    laws,
    meanings,
    orders,
    seen,
    states,
    temperatures,
)

#: The states of each bank, which the laws of its own lanes see.
Cells = dict[str, dict[str, None]]


def check_texts(spec: Tables) -> None:
    """Check that the text of each law can be read; what uses it does not know its place."""
    for law in laws(spec):
        parse_law(law.text, law.where)


def check_references(spec: Tables) -> None:
    """Check that there are elements, and that inputs and bodies they name are declared."""
    if not spec.elements:
        raise SpecError("has no elements", "elements", "at least one", f"kinds: {listing(KINDS)}")
    known = {"thermal_mass": dict.fromkeys(bodies(spec)), "input": spec.inputs}
    for name, element in spec.elements.items():
        for to, field, given in ((role, *row) for role in known for row in element.named(role)):
            where = f"elements.{name}.{field}"
            if given not in known[to]:
                raise _unknown_reference(where, to, given, tuple(known[to]), element)
            if getattr(element, field) == (given, given):
                what, remedy = f"both ends are at body {quote(given)}", "name another thermal_mass"
                raise SpecError(what, where, "two different bodies", remedy)


def _unknown_reference(
    where: str, to: str, given: str, known: tuple[str, ...], element: Element
) -> SpecError:
    what = f"{quote(given)} is no {to} of this spec"
    if to == "input":
        meant = f"{nearest(given, known)}; or " if known else ""
        ports = element.ports("")
        unit = next(p.input_unit for p in ports if isinstance(p, Source | Exchange | HeatInput))
        remedy = f'{meant}declare it in [inputs]: {given} = {{ unit = "{unit}" }}'
        return SpecError(what, where, remedy=remedy)
    if known:
        return SpecError(what, where, remedy=nearest(given, known))
    if to == "thermal_mass":
        name = given if NAME.fullmatch(given) else "body"
        body = f'{name} = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c_0)" }}'
        remedy = f"add one to [elements]: {body}"
        return SpecError(what, where, "a body for the heat", remedy)
    return SpecError(what, where)


#: What a law may not name: it enters through inputs.
TIME = ("t", "time")


def check_laws(spec: Tables) -> None:
    """Parse every law, initial value and condition, and check the names in them."""
    one_body = len(bodies(spec)) == 1
    hot = {body: word for word, body in temperatures(spec).items()}
    every, owners, cells = dict.fromkeys((*spec.parameters, *seen(spec))), bank_of(spec), Cells()
    for symbol, bank in bank_states(spec).items():
        cells.setdefault(bank, {})[symbol] = None
    for name, element in spec.elements.items():
        own = {state_symbol(element, name): None} if element.letter else {}
        own = own | cells.get(owners.get(name, ""), {})
        for law in element.laws(name):
            words: Collection[str] = ChainMap(own, every) if law.mark.sees else spec.parameters
            _check_words(spec, law.tree, law.where, law.letters, words, name)
            warm = "T" in law.letters and "T" in names(law.tree)
            if warm and not one_body and not any(element.named("thermal_mass")):
                remedy = "add to the element: temperature = '<name of a thermal_mass>'"
                what = "'T' is the temperature of no body"
                raise SpecError(what, law.where, "a body named", remedy)
            _check_letters(law, words, meanings(spec, law, hot))
    _check_initial(spec)
    for order in orders(spec):
        _check_words(spec, order.tree, f"a knot of a table in {order.where}", (), spec.parameters)
    hot_names = (*temperatures(spec), *(f"T_{body}" for body in bodies(spec)))
    words = dict.fromkeys([*spec.parameters, *spec.inputs, *states(spec), *hot_names])
    lanes = bank_states(spec)
    for condition in conditions(spec):
        _check_words(spec, condition.tree, condition.where, (), words)
        _check_banks(condition, lanes)
        _check_temperature(spec, condition)


def _check_letters(law: LawField, words: Collection[str], meant: Mapping[str, str]) -> None:
    """Refuse a letter that is also another quantity's name, and could mean either."""
    for word in names(law.tree):
        if word in law.letters and word in words and meant.get(word) != word:
            what = f"{quote(word)} is a letter of this law, and a name of this spec"
            remedy = "rename the parameter or state"
            raise SpecError(what, law.where, "one meaning", remedy)


def _check_banks(condition: Condition, lanes: Mapping[str, str]) -> None:
    """Refuse a condition on the states of two banks, whose lanes have nothing in common."""
    mixed = {lanes[word] for word in names(condition.tree) if word in lanes}
    if len(mixed) > 1:
        what = f"mixes states of the banks {listing(sorted(mixed))}"
        raise SpecError(what, condition.where, "states of one bank", "write a condition for each")


def _check_temperature(spec: Tables, condition: Condition) -> None:
    """Refuse ``T`` in [domain] where it is a temperature of the spec, and could be the only body's.

    Of another unit it is no letter's twin: then it means what the spec calls so.
    """
    own = (table["T"] for table in (spec.parameters, spec.inputs) if "T" in table)
    alike = any(parse_unit(entry.unit).dimension == parse_unit("K").dimension for entry in own)
    said = condition.where.startswith("domain.") and "T" in names(condition.tree)
    if said and len(bodies(spec)) == 1 and alike:
        (word,) = temperatures(spec)
        what = "'T' is the temperature of the only body, and a name of this spec"
        remedy = f"write {quote(word)} if the body is meant; if not, rename what is called 'T'"
        raise SpecError(what, condition.where, "one meaning", remedy)


def _check_initial(spec: Tables) -> None:
    known, sizes, lanes = states(spec), banks(spec), bank_states(spec)
    words = {**spec.parameters, **spec.inputs}
    for symbol, start in spec.initial.items():
        where = f"initial.{symbol}"
        if symbol not in known:
            what = f"{quote(symbol)} is no state of this spec"
            remedy = _entropy_of(spec, symbol, start) or _meant_state(spec, symbol)
            raise SpecError(what, where, remedy=remedy)
        count = sizes.get(lanes.get(symbol, ""))
        if isinstance(start, tuple) and len(start) != count:
            expected = (
                f"{count} values, one per lane" if count else "one value: no bank has this state"
            )
            raise SpecError(f"{len(start)} values are given", where, expected)
    for where, tree in initial_laws(spec):
        _check_words(spec, tree, where, (), words)


def _check_words(
    spec: Tables,
    tree: Node,
    where: str,
    letters: tuple[str, ...],
    words: Collection[str],
    element: str = "",
) -> None:
    """Refuse names that are neither letters nor words; `element`: whose law it is."""
    for word in names(tree):
        if word in letters or word in words:
            continue
        remedy = _meant_letter(spec, word, letters, element)
        if word in LETTERS:
            expected = f"the letters {listing(letters)}" if letters else "parameters"
            if {*spec.inputs} <= {*words} and states(spec).keys() <= {*words}:
                expected = "parameters, inputs, states and temperatures"
            if not element:
                remedy = _states_of_letter(spec, word, words)
            raise SpecError(f"{quote(word)} has no meaning here", where, expected, remedy)
        if word in spec.inputs:
            what = f"{quote(word)} is an input, and this law sees none"
            raise SpecError(
                what, where, "parameters", "drive it through a source, or take a parameter"
            )
        near = nearest(word, [*letters, *words])
        if word in TIME:
            near = "time enters through an input: declare one, and give the run sine(...) for it"
        elif not near.startswith("did you mean"):
            near = f"declare it in [parameters] with its value and unit; {near}"
        remedy = remedy or near
        raise SpecError(f"unknown name {quote(word)}", where, remedy=remedy)


def _meant_letter(spec: Tables, word: str, letters: tuple[str, ...], element: str) -> str:
    """Return what to write for a state's symbol in a law; nothing if the word is no state's."""
    owner = states(spec).get(word, "")
    if not owner or not element:
        return ""
    letter = spec.elements[owner].letter
    if owner == element and letter in letters:
        return f"a law writes the state of its element as its letter, {quote(letter)}"
    if bank := bank_of(spec).get(owner):
        return f"it is a state of bank {quote(bank)}, whose own laws alone have its lane"
    return f"it is the state of {quote(owner)}, which the law of a store cannot use"


def _states_of_letter(spec: Tables, letter: str, words: Collection[str]) -> str:
    """Return which symbols a letter may stand for, outside of laws, where it has no meaning."""
    if letter == "T" and (hot := [word for word in temperatures(spec) if word in words]):
        return f"temperatures go by their bodies: {listing(hot)}"
    found = [s for s, name in states(spec).items() if spec.elements[name].letter == letter]
    meant = [symbol for symbol in found if symbol in words]
    return f"states go by their own symbols: {listing(meant)}" if meant else ""


def _entropy_of(spec: Tables, word: str, start: object) -> str:
    """Return how a body starts at a temperature, if the word is one."""
    found = [body for body in bodies(spec) if word in (f"T_{body}", "T")]
    if not found or word in spec.parameters or word in spec.inputs:
        return ""
    element = spec.elements[body := found[0]]
    state = next(s.symbol for s in element.own_states(body) if s.is_entropy)
    kelvin = start if isinstance(start, float) else 300.0
    return (
        f"give its entropy {quote(state)} ('c*log(T_start/T_0)' where the temperature is "
        f"'T_0*exp(S/c)'), or the temperature to a run: "
        f"--initial T_{body}={kelvin:g}, simulate(initial={{'T_{body}': {kelvin:g}}})"
    )


def _meant_state(spec: Tables, word: str) -> str:
    """Return which state was meant: by a letter, an element's name, or a symbol like it."""
    known = states(spec)
    if word in spec.parameters or word in spec.inputs:
        table = "parameters" if word in spec.parameters else "inputs"
        return f"its value is given in [{table}]; states: {listing(known)}"
    own = [symbol for symbol, name in known.items() if name == word]
    if own:
        return f"the state of element {quote(word)} is {quote(own[0])}"
    return _states_of_letter(spec, word, known) or nearest(word, known)
