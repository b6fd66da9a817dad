"""IPHS to the texts of its module, with places for the values of its spec."""

from piezo_sym.codegen import collocation_of, lower, printed
from piezo_sym.codegen.program import blank
from piezo_sym.codegen.quantities import quantities_of
from piezo_sym.iphs import IPHS
from piezo_sym.spec.checks.values import are_all_margins
from piezo_sym.spec.values import Template


def template_of(iphs: IPHS) -> Template:
    """Return the texts that are proved and written for a system, whatever its values are."""
    q = quantities_of(iphs)
    texts = printed(blank(lower(iphs, "", q)), collocation_of(iphs, q))
    tables = iphs.model.parameters, iphs.model.inputs
    factors = {n: str(entry.dimension.factor) for table in tables for n, entry in table.items()}
    joined = bool(iphs.junction.joints)
    return Template(texts, factors, not joined and are_all_margins(iphs.model), joined)
