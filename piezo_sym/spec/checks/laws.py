"""References and laws of a spec: the names in them exist."""

from collections import ChainMap
from collections.abc import Collection, Mapping
from contextlib import suppress

from piezo_sym.errors import SpecError, listing, nearest, quote
from piezo_sym.expressions.incomplete import CONSTANTS
from piezo_sym.expressions.tree import Mul, Node, Num, Sym, names, walk
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.elements import KINDS, LETTERS
from piezo_sym.spec.elements.base import ENTROPY_UNIT, Element, state_symbol
from piezo_sym.spec.elements.marks import LawField
from piezo_sym.spec.elements.ports import Exchange, HeatInput, Source
from piezo_sym.spec.fields import Tables
from piezo_sym.spec.names import NAME
from piezo_sym.spec.problems import all_faults
from piezo_sym.spec.tables import (
    Condition,
    bank_of,
    bank_states,
    banks,
    bodies,
    condition_text,
    conditions,
    heat_names,
    initial_laws,
    meanings,
    orders,
    seen,
    states,
    temperatures,
)

#: The states of each bank, which only laws of the same bank may use.
Cells = dict[str, dict[str, None]]


def check_references(spec: Tables) -> None:
    """Check that there are elements, and that inputs and bodies they name are declared."""
    if not spec.elements:
        raise SpecError("has no elements", "elements", "at least one", f"kinds: {listing(KINDS)}")
    known = {"thermal_mass": dict.fromkeys(bodies(spec)), "input": spec.inputs}
    with all_faults() as kept:
        for name, element in spec.elements.items():
            for to, field, given in ((role, *row) for role in known for row in element.named(role)):
                where = f"elements.{name}.{field}"
                with kept():
                    if given not in known[to]:
                        raise _unknown_reference(where, to, given, tuple(known[to]), spec, element)
                    if getattr(element, field) == (given, given):
                        what = f"both ends are at body {quote(given)}"
                        remedy = "name another thermal_mass"
                        raise SpecError(what, where, "two different bodies", remedy)


def _unknown_reference(
    where: str, to: str, given: str, known: tuple[str, ...], spec: Tables, element: Element
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
    free = NAME.fullmatch(given) and given not in spec.elements
    others = ("body", *(f"body_{n}" for n in range(2, len(spec.elements) + 2)))
    name = given if free else next(other for other in others if other not in spec.elements)
    body = f'{name} = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c_0)" }}'
    remedy = f"add one to [elements]: {body}"
    new = [f"{word} = {entry}" for word, entry in WARM.items() if word not in spec.parameters]
    remedy += f"; and to [parameters]: {' and '.join(new)}" * bool(new)
    remedy += "" if free else f", and name {quote(name)} here instead of {quote(given)}"
    return SpecError(what, where, "a body for the heat", remedy)


#: The parameters of a body's usual law.
WARM = {"T_0": '{ value = 300, unit = "K" }', "c_0": '{ value = 100, unit = "J/K" }'}
DRIVEN = "time enters through an input: declare one, and give the run sine(...) for it"
#: What to write for names that laws do not know in any spec.
WRITTEN = CONSTANTS | dict.fromkeys(("t", "time"), DRIVEN)


def check_laws(spec: Tables) -> None:
    """Parse every law, initial value and condition, and check the names in them."""
    hot = {body: word for word, body in temperatures(spec).items()}
    every, owners, cells = dict.fromkeys((*spec.parameters, *seen(spec))), bank_of(spec), Cells()
    for symbol, bank in bank_states(spec).items():
        cells.setdefault(bank, {})[symbol] = None
    with all_faults() as kept:
        for name, element in spec.elements.items():
            own = {state_symbol(element, name): None} if element.letter else {}
            own |= cells.get(owners.get(name, ""), {})  # the states of this lane
            for law in element.laws(name):
                words: Collection[str] = ChainMap(own, every) if law.mark.sees else spec.parameters
                with kept():
                    _check_law(spec, law, words, hot)
        with kept():
            _check_initial(spec)
    _check_domain(spec)


def _check_law(spec: Tables, law: LawField, words: Collection[str], hot: Mapping[str, str]) -> None:
    """Check the names in a law, which knows `words`; `hot` has the temperature of each body."""
    _check_words(spec, law.tree, law.where, law.letters, words, law.element)
    warm = "T" in law.letters and "T" in names(law.tree)
    if warm and len(hot) != 1 and not any(spec.elements[law.element].named("thermal_mass")):
        remedy = "add to the element: temperature = '<name of a thermal_mass>'"
        raise SpecError("'T' is the temperature of no body", law.where, "a body named", remedy)
    _check_letters(law, words, meanings(spec, law, hot))


def _check_domain(spec: Tables) -> None:
    """Check the names in conditions."""
    domain = conditions(spec)
    for order in orders(spec, domain):
        _check_words(spec, order.tree, f"a knot of a table in {order.where}", (), spec.parameters)
    words = dict.fromkeys([*spec.parameters, *spec.inputs, *states(spec), *heat_names(spec)])
    lanes = bank_states(spec)
    for condition in domain:
        try:
            _check_words(spec, condition.tree, condition.where, (), words)
            _check_banks(condition, lanes)
            _check_temperature(spec, condition)
        except SpecError as error:  # the text says more than the condition's number
            error.what = f"{quote(condition_text(condition.tree))}: {error.what}"
            raise


def _check_letters(law: LawField, words: Collection[str], meant: Mapping[str, str]) -> None:
    """Refuse a letter that is also the name of another quantity, so that it could mean either."""
    for word in names(law.tree):
        if word in law.letters and word in words and meant.get(word) != word:
            what = f"{quote(word)} is a letter of this law, and a name of this spec"
            raise SpecError(what, law.where, "one meaning", "rename the parameter or state")


def _check_banks(condition: Condition, lanes: Mapping[str, str]) -> None:
    """Refuse a condition on the states of two banks, whose lanes have nothing in common."""
    mixed = {lanes[word] for word in names(condition.tree) if word in lanes}
    if len(mixed) > 1:
        what = f"mixes states of the banks {listing(sorted(mixed))}"
        raise SpecError(what, condition.where, "states of one bank", "write a condition for each")


def _check_temperature(spec: Tables, condition: Condition) -> None:
    """Refuse ``T`` in [domain] where it could be a declared temperature or that of the only body.

    A parameter or input called T that is no temperature cannot be confused with it.
    """
    own = (table["T"] for table in (spec.parameters, spec.inputs) if "T" in table)
    alike = any(parse_unit(entry.unit).dimension == parse_unit("K").dimension for entry in own)
    used = condition.where.startswith("domain.") and "T" in names(condition.tree)
    if used and len(bodies(spec)) == 1 and alike:
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
            remedy = _start_entropy(spec, symbol, start) or _meant_state(spec, symbol)
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
    """Refuse names that are neither in `letters` nor in `words`; `element` is the law's."""
    for word in names(tree):
        if word in letters or word in words:
            continue
        remedy = _state_in_law(spec, word, letters, element)
        if word in LETTERS:
            expected = f"the letters {listing(letters)}, parameters" if letters else "parameters"
            if (sight := {*seen(spec)}) <= {*words}:
                expected += f"{'' if element else ', inputs'}, states and temperatures"
                expected += f": {listing(seen(spec))}" * bool(letters and sight)
            if other := next((own for own in letters if own.lower() == word.lower()), ""):
                remedy = f"did you mean {quote(other)}?"
            if not remedy:
                known = {*words, *states(spec)} if element else words
                remedy = _states_of_letter(spec, word, known)
            raise SpecError(f"{quote(word)} has no meaning here", where, expected, remedy)
        if word in spec.inputs:
            what = f"{quote(word)} is an input, and this law sees none"
            raise SpecError(
                what, where, "parameters", "drive it through a source, or take a parameter"
            )
        remedy = remedy or WRITTEN.get(word) or _declared(word, tree, [*letters, *words])
        raise SpecError(f"unknown name {quote(word)}", where, remedy=remedy)


def _declared(word: str, tree: Node, known: Collection[str]) -> str:
    """Return what to do about a name that nothing declares: a unit, behind a number, has none."""
    near, declare = nearest(word, known), "declare it in [parameters] with its value and unit"
    products = (node for node in walk(tree) if isinstance(node, Mul) and node.right == Sym(word))
    if any(isinstance(product.left, Num) for product in products):
        with suppress(SpecError):
            in_si = str(parse_unit(word).factor)
            return f"{declare}; or, if the unit is meant, write {in_si} for it: laws are in SI"
    if near.startswith("did you mean"):
        return near
    meant = next((w for w in known if w in LETTERS and word.isalpha() and word.startswith(w)), "")
    return f"did you mean {quote(meant)}? else {declare}" if meant else f"{declare}; {near}"


def _state_in_law(spec: Tables, word: str, letters: tuple[str, ...], element: str) -> str:
    """Return why a law cannot name this state, and what to write; empty if it is no state."""
    known, (base, _, lane) = states(spec), word.rpartition("_")
    single = word not in known and base in bank_states(spec) and lane.isdigit()
    owner = known.get(base if single else word, "")
    if not owner or not element:
        return ""
    letter = spec.elements[owner].letter
    if single and bank_of(spec)[owner] == bank_of(spec).get(element):
        meant = letter if owner == element else base
        return f"a law in a bank writes the state of its own lane, {quote(meant)}"
    if owner == element and letter in letters:
        return f"a law writes the state of its element as its letter, {quote(letter)}"
    if owner == element:
        return "it is the state of the element itself, which this law cannot use"
    if bank := bank_of(spec).get(owner):
        what = "one lane of a state" if single else "a state"
        why = f"it is {what} of bank {quote(bank)}, whose own laws alone have its lane"
        return f"{why}; {_beside_lane(spec, owner, bank, element)}"
    return ""  # laws of stores with states of others are refused before, by `check_energies`


def _beside_lane(spec: Tables, owner: str, bank: str, element: str) -> str:
    """Return how an element's law can use the state of `owner`, which is in a bank."""
    alone = "write the lanes as elements of their own, without count"
    if not spec.elements[element].form.has_lanes:
        return alone
    made = f"move {quote(element)} to [banks.{bank}.elements]"
    if bank == owner:
        cells = f"[banks.{owner}_cells] with count = {banks(spec)[bank]}"
        made = f"put {quote(owner)} and {quote(element)} into one cell, as the elements of {cells}"
    return f"{made}, so that each lane has its own; or {alone}"


def _states_of_letter(spec: Tables, letter: str, words: Collection[str]) -> str:
    """Return the symbols that a letter may stand for, where laws do not know letters."""
    if letter == "T" and (hot := [word for word in temperatures(spec) if word in words]):
        return f"temperatures go by their bodies: {listing(hot)}"
    owners = states(spec).items()
    meant = [s for s, name in owners if spec.elements[name].letter == letter and s in words]
    return f"states go by their own symbols: {listing(meant)}" if meant else ""


def _start_entropy(spec: Tables, word: str, start: object) -> str:
    """Return how to start a body at a temperature, if `word` is its symbol; else an empty text."""
    body = next((body for body in bodies(spec) if word in (f"T_{body}", "T")), "")
    if not body or word in spec.parameters or word in spec.inputs:
        return ""
    element = spec.elements[body]
    state = next(s for s, unit in element.own_states(body).items() if unit == ENTROPY_UNIT)
    kelvin = start if isinstance(start, float) else 300.0
    return (
        f"give its entropy {quote(state)} ('c*log(T_start/T_0)' where the temperature is "
        f"'T_0*exp(S/c)'), or the temperature to a run: "
        f"--initial T_{body}={kelvin:g}, simulate(initial={{'T_{body}': {kelvin:g}}})"
    )


def _meant_state(spec: Tables, word: str) -> str:
    """Return the state that may be meant by a letter, an element's name or a similar symbol."""
    known = states(spec)
    for table in ("parameters", "inputs"):
        if word in getattr(spec, table):
            return f"its value is given in [{table}]; states: {listing(known)}"
    if symbol := next((symbol for symbol, name in known.items() if name == word), ""):
        return f"the state of element {quote(word)} is {quote(symbol)}"
    return _states_of_letter(spec, word, known) or nearest(word, known)
