"""The kinds of elements, by the name that a spec gives them.

A kind is a class in the file of its domain, listed at the end of that file.
"""

from collections.abc import Mapping

from piezo_sym.spec.elements.base import Element
from piezo_sym.spec.elements.electrical import ELECTRICAL
from piezo_sym.spec.elements.mechanical import MECHANICAL
from piezo_sym.spec.elements.thermal import THERMAL

KINDS: Mapping[str, type[Element]] = {
    kind.model_fields["kind"].default: kind for kind in (*MECHANICAL, *ELECTRICAL, *THERMAL)
}
