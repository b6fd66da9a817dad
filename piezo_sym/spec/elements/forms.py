"""The forms of dissipation, sources and couplings, each for any domain.

Each function defines fields, docstring and ports once for all domains; see `stores` and `thermal`
for the other forms.
"""

from dataclasses import replace
from typing import Any

from piezo_sym.spec.elements.base import Form
from piezo_sym.spec.elements.domains import PhysicalDomain, PhysicalVariable, PowerVariable
from piezo_sym.spec.elements.marks import (
    BodyName,
    Fields,
    InputName,
    Jumps,
    Node,
    OptionalBody,
    OptionalPair,
    Pair,
    law_field,
)
from piezo_sym.spec.elements.ports import Branch, Coupling, DissipativePort, Port, Source


def dissipation(domain: PhysicalDomain, symbol: str, *gives: PowerVariable) -> Form:
    """Return the form of a law from one variable of a branch to the other; the power heats a body.

    Parameters
    ----------
    symbol : the law in the example, for the first of `gives`.
    gives : the variables that a law may give.
    """
    pairs = {which: (domain.variable(which), domain.variable(which.other)) for which in gives}
    default, laws = None if len(gives) > 1 else ..., Fields()
    for out, given in pairs.values():
        letters, sample = {given.letter: given.unit, "T": "K"}, "" if laws else symbol
        laws[out.name] = law_field(out.unit, letters, sample, default, sees=True)
    words = ", or ".join(
        f"its {out.word} [{out.unit}] is a law of {given.letter}, "
        f"the {with_sense(given)} [{given.unit}]"
        for out, given in pairs.values()
    )
    out, given = pairs[gives[0]]

    def ports(element: Any, name: str, branch: Branch) -> tuple[Port, ...]:
        """Return the process, in the causality in which the law is given."""
        imposes = next(w for w in gives if getattr(element, pairs[w][0].name) is not None)
        output, effort = pairs[imposes]
        port = DissipativePort(
            letter=effort.letter,
            law=element.law(output.name),
            field=output.name,
            output=f"{output.prefix}_{name}",
            effort=f"{effort.prefix}_{name}",
            branch=branch,
            domain=domain,
            imposes=imposes,
            heats=element.heats,
        )
        return (port,)

    heats = {"heats": (BodyName, ..., "body"), "discontinuous": (Jumps, False, None)}
    return Form(
        fields={**places(domain), **laws, **heats},
        doc=f"{words[0].upper()}{words[1:]}; T [K] is the temperature of the body that it `heats` "
        f"with {out.word} times {given.word}.",
        ports=ports,
        role=("dissipation", domain),
        one_of=tuple(laws) if len(gives) > 1 else (),
        has_lanes=True,
    )


def imposed(domain: PhysicalDomain, imposes: PowerVariable, symbol: str) -> Form:
    """Return the form of a source: an input imposes a variable; `symbol` is that of the example."""
    given, output, at = domain.variable(imposes), domain.variable(imposes.other), domain.mechanical
    across, node = imposes is PowerVariable.ACROSS, "its node" if at else "its first node"
    relative = f"is that of {node}{'' if at else ' relative to its second'}"
    verb = relative if across else f"is given into {node}"

    def ports(element: Any, name: str, branch: Branch) -> tuple[Port, ...]:
        pair = placed(element, branch, domain)
        doc = f"{output.word} {'given by' if across else 'at'} {element.kind} '{name}'"
        return (Source(element.input, pair, domain, imposes, given.unit, output.unit, doc),)

    return Form(
        fields={**places(domain, at), "input": (InputName, ..., symbol)},
        doc=f"Its input, a {given.word} [{given.unit}], {verb}; output is the {output.word} "
        f"[{output.unit}], so that output times input is the power put in.",
        ports=ports,
    )


def coupling(
    ratio: str,
    symbol: str,
    first: PhysicalDomain,
    *second: tuple[PhysicalDomain, str],
    alias: str = "",
    gyrates: bool = False,
    warm: bool = False,
) -> Form:
    """Return the form of a coupling of two pairs of nodes, named by their domains.

    Parameters
    ----------
    ratio, symbol : the field of its ratio, and the law for it in the example.
    first : the domain of its first pair.
    second : the domains that its second pair may have, with the unit of the ratio for each.
    alias : another name of the second pair.
    gyrates : whether through_1 = ratio*across_2, not across_1 = ratio*across_2.
    warm : whether the ratio may depend on the temperature of a body.
    """
    inside, unit = first == second[0][0], second[0][1]
    one = "first" if inside else first.name
    pairs = [("second" if inside else domain.name, domain, own) for domain, own in second]
    pairs += [(alias, *second[0])] if alias else []
    choices = tuple(field for field, *_ in pairs) if len(pairs) > 1 else ()
    fields: Fields = {}
    for field, domain in ((one, first), *(pair[:2] for pair in pairs)):
        sample = [f"{domain.node}_{len(fields) + 1}", domain.reference] * (len(fields) < 2)
        fields[field] = (OptionalPair, None, sample) if field in choices else (Pair, ..., sample)
    instead = {field: other for field, _, other in pairs if other != unit}
    fields[ratio] = law_field(unit, {"T": "K"} if warm else {}, symbol, sees=True, **instead)
    if warm:
        fields["temperature"] = (OptionalBody, None, "body")

    def ports(element: Any, name: str, _: Branch) -> tuple[Port, ...]:
        given = ((getattr(element, field), domain) for field, domain, _ in pairs)
        other, domain = next(pair for pair in given if pair[0] is not None)
        pair, law = getattr(element, one), element.law(ratio)
        named = f"{'alpha' if gyrates else 'n'}_{name}"
        return (Coupling(pair, first, other, domain, law, ratio, named, gyrates),)

    equations = [_equations(ratio, (one, first), pair, gyrates) for pair in pairs[: len(second)]]
    equations += [f"`{alias}` is another name of `{pairs[0][0]}`: give one."] if alias else []
    return Form(
        fields=fields,
        doc="\n\n".join(equations),
        ports=ports,
        role=("gyrator" if gyrates else "transformer",),
        one_of=choices,
        ratios=tuple((first, domain, ratio_unit) for domain, ratio_unit in second),
    )


def series(first: Form, second: Form) -> Form:
    """Return the form of a store and a dissipation in series, joined at an inner node."""

    def ports(element: Any, name: str, branch: Branch) -> tuple[Port, ...]:
        (start, end), inner = branch, f"{name}:inner"
        one, two = first.ports(element, name, (start, inner)), second.ports
        return *one, *two(element, name, (inner, end))

    fields, doc = {**first.fields, **second.fields}, f"{first.doc}\n\n{second.doc}"
    return replace(first, fields=fields, doc=doc, ports=ports, role=())


def _equations(
    ratio: str,
    first: tuple[str, PhysicalDomain],
    second: tuple[str, PhysicalDomain, str],
    gyrates: bool,
) -> str:
    one, two = first[1], second[1]
    given, taken = (one.through, one.across) if gyrates else (one.across, one.through)
    return (
        f"With the pairs `{first[0]}` (1) and `{second[0]}` (2): "
        f"{given.prefix}_1 = {ratio}*{two.across.prefix}_2 and "
        f"{two.through.prefix}_2 = -{ratio}*{taken.prefix}_1. {one.through.prefix}_1 and "
        f"{two.through.prefix}_2 run from the first to the second node of their pair inside "
        f"the element, so it gives {ratio}*{taken.prefix}_1 to the first node of pair 2."
    )


def with_sense(variable: PhysicalVariable, at: bool = False) -> str:
    """Return a variable with its sign convention, in words; `at` one node or along a branch."""
    return f"{variable.word} {'at its node' if at else variable.sense}"


def places(domain: PhysicalDomain, at: bool = False) -> Fields:
    """Return the field for an element's node (`at`), or for its two nodes."""
    if at:
        return {"at": (Node, ..., domain.node)}
    return {"between": (Pair, ..., [domain.node, domain.reference])}


def placed(element: Any, branch: Branch, domain: PhysicalDomain) -> Branch:
    """Return the branch of an element; one that stands at a node ends at the reference."""
    return (element.at, domain.reference) if hasattr(element, "at") else branch
