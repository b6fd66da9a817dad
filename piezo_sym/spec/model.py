"""The spec as one frozen value: what a user declares.

Input: TOML data, or Python arguments of the same shape.  Output: a `Model`, immutable, hashable,
and equal to another exactly if both say the same in the same order.  What its components and banks
are, written out, is `flatten`'s; the later stages know of neither.
"""

from __future__ import annotations

from typing import Any, cast, final

from pydantic import PrivateAttr, ValidationError, model_validator

from piezo_sym.errors import PiezoError
from piezo_sym.spec.checks.energies import check_energies
from piezo_sym.spec.checks.laws import check_laws, check_references
from piezo_sym.spec.checks.names import check_names
from piezo_sym.spec.checks.values import check_values
from piezo_sym.spec.components import Reader
from piezo_sym.spec.fields import Tables
from piezo_sym.spec.flatten import flattened
from piezo_sym.spec.problems import first_problem
from piezo_sym.spec.write import spec_hash, to_toml


@final
class Model(Tables):
    """A declarative list of physical elements, and the parameters and inputs of their laws.

    Attributes
    ----------
    model : `Header`: name, title, source.
    parameters, inputs : tables of `Parameter` and `Input`, by symbol.
    domain : `Domain`: conditions that values, inputs and states keep.
    initial : initial states by symbol, 0 where nothing is said.
    components : table of `Component`: other models as parts; their `spec` may be a `Model`, too.
    elements : table of elements by name; states and processes follow its order.
    banks : table of `Bank`: cells of elements, many alike; after the elements in order.

    Raises
    ------
    SpecError
        With one line that says what is wrong, where, what was expected, and what to do.
    """

    _flat: Model | None = PrivateAttr(None)

    def __init__(self, /, **data: Any) -> None:
        """Check the data; a fault becomes one `SpecError`."""
        try:
            super().__init__(**Reader(Model).complete(data))
        except ValidationError as error:
            raise first_problem(error) from None

    @model_validator(mode="after")
    def _checked(self) -> Model:
        """Check the tables against each other: names first, values last."""
        if self.flatten() is self:
            check_names(self)
            check_energies(self)
            check_references(self)
            check_laws(self)
            check_values(self)
        return self

    def flatten(self) -> Model:
        """Return the model with its components and banks written out as elements of its own.

        Raises
        ------
        SpecError
            If they do not fit together; the message names things as they were written.
        """
        if (self.components or self.banks) and self._flat is None:
            self._flat = self._flattened()
        return self._flat or self

    def _flattened(self) -> Model:
        models = (cast(Model, c.spec.model).flatten() for c in self.components.values())
        made = flattened(self, models)
        try:
            return Model(**made.tables)
        except PiezoError as error:
            error.where = made.origin(error.where)
            raise

    @property
    def name(self) -> str:
        """The model's name."""
        return self.model.name

    @property
    def sha256(self) -> str:
        """SHA-256 of the canonical spec, all written out; generated modules carry it."""
        return spec_hash(self.flatten().model_dump())

    def to_toml(self) -> str:
        """Return the spec as TOML text; loading it gives an equal model.

        Paths of components are as they were written, for a file in the same folder.  Where a
        component is a `Model` made in Python, which no text can name, all are written out.
        """
        if not all(component.spec.text for component in self.components.values()):
            return self.flatten().to_toml()
        data = self.model_dump(exclude_defaults=True)
        for name, element in self.elements.items():
            data["elements"][name] = {"kind": element.kind} | data["elements"][name]
        for name, bank in self.banks.items():
            rows = data["banks"][name]["elements"]
            for own, element in bank.elements.items():
                rows[own] = {"kind": element.kind} | rows[own]
        return to_toml(data)
