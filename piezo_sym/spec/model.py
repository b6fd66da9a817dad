"""The spec as one frozen value.

Input: TOML data, or Python arguments of the same shape.  Output: a `Model`, immutable, hashable,
and equal to another exactly if both say the same in the same order.  `flatten` writes components
and banks out as elements; the later stages know of neither.  A component is a shipped name, a path
below the folder of the spec that names it, or, in Python, a `Model`.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, cast, final

from pydantic import PrivateAttr, ValidationError, model_validator

from piezo_sym.errors import PiezoError, SpecError, quote
from piezo_sym.spec.checks.energies import check_energies
from piezo_sym.spec.checks.laws import check_laws, check_references
from piezo_sym.spec.checks.names import check_names, check_texts
from piezo_sym.spec.checks.values import check_values
from piezo_sym.spec.fields import Included, Tables
from piezo_sym.spec.flatten import flattened
from piezo_sym.spec.names import MAX_NAME
from piezo_sym.spec.problems import all_problems
from piezo_sym.spec.source import component_file, data, read, real
from piezo_sym.spec.write import spec_hash, to_toml

#: Each model around another makes its names two characters longer, at least.
MOST_DEEP = MAX_NAME // 2
Chain = tuple[Path, ...]


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

    def __init__(self, /, **tables: Any) -> None:
        """Check the data; a fault becomes one `SpecError`."""
        try:
            super().__init__(**Reader().complete(tables))
        except ValidationError as error:
            raise all_problems(error, tables) from None

    @model_validator(mode="after")
    def _checked(self) -> Model:
        """Check the tables against each other: texts and names first, values last."""
        if self.flatten() is self:
            check_texts(self)
            check_names(self)
            check_energies(self)
            check_references(self)
            check_laws(self)
            check_values(self)
        return self

    def flatten(self) -> Model:
        """Return the model with its components and banks written out as elements.

        Raises
        ------
        SpecError
            If they do not fit together; the message names things as they were written.
        """
        if (self.components or self.banks) and self._flat is None:
            models = (cast(Model, c.spec.model).flatten() for c in self.components.values())
            flat = flattened(self, models)
            try:
                made = Model(**flat.tables)
            except PiezoError as error:
                flat.origins.put_in(error)
                raise
            made._origins = flat.origins
            self._flat = made
        return self._flat or self

    @property
    def name(self) -> str:
        """The model's name."""
        return self.model.name

    @property
    def sha256(self) -> str:
        """SHA-256 of the flat spec in canonical form; generated modules carry it."""
        return self._hash

    @cached_property
    def _hash(self) -> str:  # without the underscore it would be among the tables of dict(self)
        return spec_hash(self.flatten().model_dump())

    @property
    def key(self) -> str:
        """SHA-256 of all that the flat spec says, in its order: only equal models have the same."""
        return hashlib.sha256(json.dumps(self.flatten().model_dump()).encode()).hexdigest()

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Model:
        """Return a model with some tables exchanged, checked as any other."""
        del deep  # nothing in it can be changed
        return Model(**{**dict(self), **(update or {})})

    def to_toml(self) -> str:
        """Return the spec as TOML text; loading it gives an equal model.

        Paths of components are as they were written, for a file in the same folder.  If a component
        is a `Model` made in Python, which no text can name, the flat spec is returned.
        """
        if not all(component.spec.text for component in self.components.values()):
            return self.flatten().to_toml()
        return to_toml(self.model_dump(exclude_defaults=True))


@final
@dataclass(frozen=True)
class Reader:
    """Reads specs with the models of their components, each file once."""

    _known: dict[Path, Model] = field(default_factory=dict)

    def file(self, path: Path, chain: Chain = ()) -> Model:
        """Return the model of a file; `chain` are the files around it."""
        key = real(path)
        if key in chain:
            names = " -> ".join(p.name for p in (*chain[chain.index(key) :], key))
            remedy = (
                f"leave it out of {quote(chain[-1].name)}, or move what both need to a third file"
            )
            what = f"{quote(path.name)} is a component of itself: {names}"
            raise SpecError(what, expected="components without a cycle", remedy=remedy)
        if len(chain) > MOST_DEEP:
            expected = f"at most {MOST_DEEP} models around another"
            raise SpecError(f"{quote(path.name)} is too deep inside", expected=expected)
        if key not in self._known:
            self._known[key] = self.text(read(path), path.name, path.parent, (*chain, key))
        return self._known[key]

    def text(self, text: str, source: str, folder: Path | None, chain: Chain = ()) -> Model:
        """Return the model of a text; messages begin with `source`."""
        try:
            return Model(**self.complete(data(text), folder, chain))
        except PiezoError as error:
            error.put_in(source)
            raise

    def complete(
        self, content: Mapping[str, Any], folder: Path | None = None, chain: Chain = ()
    ) -> dict[str, Any]:
        """Return the tables of a spec with the models of its components.

        Raises
        ------
        FileError, SpecError
            If a component cannot be read, is no spec, contains itself, or is outside `folder`.
        """
        table = content.get("components")
        if not isinstance(table, Mapping):
            return dict(content)
        rows = {}
        for name, row in table.items():
            given = row.get("spec") if isinstance(row, Mapping) else None
            if given is not None and not isinstance(given, Included):
                where = f"components.{name}"
                row = {**row, "spec": self._included(given, where, folder, chain)}
            rows[name] = row
        return {**content, "components": rows}

    def _included(self, given: object, where: str, folder: Path | None, chain: Chain) -> Included:
        if isinstance(given, Tables):
            return Included(given)
        path = component_file(given, f"{where}.spec", folder)
        try:
            return Included(self.file(path, chain), str(given))
        except PiezoError as error:
            error.put_in(where)
            raise
