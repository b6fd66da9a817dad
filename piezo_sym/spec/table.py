"""A frozen, ordered mapping: the tables of a spec, whose order means something.

Input: pairs.  Output: a mapping that cannot change, is hashable, and equals another only if their
order is the same too (states follow the order of elements).
"""

from collections.abc import ItemsView, Iterator, Mapping
from typing import Any, Generic, TypeVar, final, get_args

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from piezo_sym.errors import UnknownNameError, nearest, quote

Value = TypeVar("Value")


@final
class Table(Mapping[str, Value], Generic[Value]):
    """An immutable mapping from names to values that remembers and compares its order."""

    __slots__ = ("_items",)

    def __init__(self, items: Mapping[str, Value] | None = None) -> None:
        self._items = dict(items or {})

    def __getitem__(self, name: str) -> Value:
        try:
            return self._items[name]
        except KeyError:
            what, remedy = f"unknown name {quote(name)}", nearest(str(name), self._items)
            raise UnknownNameError(what, remedy=remedy) from None

    def __contains__(self, name: object) -> bool:
        return name in self._items  # the mapping's own makes an error, as does its get

    def get(self, name: str, default: Any = None, /) -> Value | Any:
        """Return the value of a name, or the default."""
        return self._items.get(name, default)

    def __iter__(self) -> Iterator[str]:
        return iter(self._items)

    def items(self) -> ItemsView[str, Value]:
        """Return the names and values in order; the mapping's own is several times slower."""
        return self._items.items()

    def __len__(self) -> int:
        return len(self._items)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Mapping):
            return NotImplemented
        return list(self.items()) == list(other.items())

    def __hash__(self) -> int:
        return hash(tuple(self._items.items()))

    def __repr__(self) -> str:
        return f"Table({self._items!r})"

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Validate as a dict of the value type, freeze it; serialise as a plain dict."""
        (value,) = get_args(source)
        inner = handler.generate_schema(dict[str, value])  # type: ignore[valid-type]
        plain = core_schema.no_info_before_validator_function(_plain, inner)
        return core_schema.no_info_after_validator_function(
            cls,
            plain,
            serialization=core_schema.plain_serializer_function_ser_schema(dict),
        )


def _plain(value: Any) -> Any:
    return dict(value) if isinstance(value, Table) else value
