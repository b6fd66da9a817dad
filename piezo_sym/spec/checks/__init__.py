"""What must hold between the tables of a spec: names, references, laws, lanes, values.

Input: the tables of a spec, each right in itself.  Output: nothing, or one `SpecError`.
"""

from piezo_sym.spec.checks.laws import check_laws, check_references
from piezo_sym.spec.checks.names import check_model_name, check_names
from piezo_sym.spec.checks.values import check_values
from piezo_sym.spec.tables import Tables

__all__ = ["check", "check_model_name"]


def check(spec: Tables) -> None:
    """Check the tables of a spec against each other, names first and values last."""
    check_names(spec)
    check_references(spec)
    check_laws(spec)
    check_values(spec)
