"""The axes of a sweep: a dimension for each key of `over`, and the quantities that vary along it.

Input: a generated module, a user's mapping `over`, the length of a run.  Output: `Axis` records
with `Target`s: parameters, sizes of banks, inputs and initial values, by name.  A name of several
quantities needs a prefix: "parameters.x", "inputs.x", "initial.x".  A key is a name, or a tuple of
names whose values are zipped (one dimension, `L_T_e`).
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, Literal, Self, TypeAlias, final

import numpy as np

from piezo_sym.errors import UsageError, listing, nearest, quote
from piezo_sym.run.checks import FloatArray, integer, is_number, number
from piezo_sym.run.functions import InputFunction
from piezo_sym.run.inputs import read_signal
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.parameters import lane_value
from piezo_sym.run.samples import Samples
from piezo_sym.run.signals import Signal

WHERE = "sweep.over"
EXPECTED = "a list or array of values, or a mapping of labels to values"

Kind: TypeAlias = Literal["parameters", "inputs", "initial"]
Value: TypeAlias = float | int | tuple[float, ...] | Signal
WORDS = {"parameters": "a parameter", "inputs": "an input", "initial": "a state"}
MOST_TEXT = 60
Attributed: TypeAlias = tuple[Any, dict[str, str]]


@final
@dataclass(frozen=True)
class Target:
    """A quantity and its values along an axis."""

    kind: Kind
    name: str
    unit: str
    doc: str
    bank: str | None  # its bank, or the one whose size it is
    is_size: bool = False  # whether it is the number of lanes of a bank
    values: FloatArray | tuple[Value, ...] = ()  # one per point; tuples of one per lane
    texts: tuple[str, ...] = ()  # labels of the values, if not all are numbers

    @property
    def coordinate(self) -> str:
        """The name of the coordinate that holds its values."""
        return f"initial_{self.name}" if self.kind == "initial" else self.name

    @property
    def divides(self) -> bool:
        """Whether runs with different values need separate calls of C."""
        return self.is_size or self.kind == "inputs"

    def along(self, values: FloatArray | tuple[Value, ...]) -> Self:
        """Return the target with values, one per point."""
        numbers = isinstance(values, np.ndarray) or all(map(is_number, values))
        texts = [] if numbers else [label(value) for value in values]
        if len(set(texts)) < len(texts):
            texts = [f"{n}: {text}" for n, text in enumerate(texts)]
        return replace(self, values=values, texts=tuple(texts))

    def part(self, points: slice) -> Self:
        """Return the target with the values at some points."""
        return replace(self, values=self.values[points], texts=self.texts[points])

    def labels(self) -> Any:
        """Return its values as numbers (points,), or as texts."""
        return self.texts or np.asarray(self.values)


def find(module: GeneratedModule, word: object, where: str) -> Target:
    """Return the target, without values, that a user's name means."""
    known = list(targets(module))
    kind, dot, name = word.partition(".") if isinstance(word, str) else ("", "", word)
    matching = [t for t in known if ((t.kind, t.name) == (kind, name) if dot else t.name == word)]
    if not matching:
        names = [t.name for t in known] + [f"{t.kind}.{t.name}" for t in known if dot]
        raise UsageError(f"unknown name {quote(word)}", where, remedy=nearest(str(word), names))
    if len(matching) > 1:
        kinds = " and ".join(WORDS[target.kind] for target in matching)
        spelled = " or ".join(f"'{target.kind}.{word}'" for target in matching)
        raise UsageError(f"{quote(word)} is {kinds}", where, remedy=f"write {spelled}")
    return matching[0]


def targets(module: GeneratedModule) -> Iterator[Target]:
    """Yield every quantity that can be swept."""
    for record in module.PARAMETERS:
        yield Target("parameters", record.name, record.unit, record.doc, record.bank)
    for bank in module.BANKS:
        doc = f"number of lanes of bank '{bank}'"
        yield Target("parameters", f"{bank}_count", "1", doc, bank, is_size=True)
    for record in module.INPUTS:
        yield Target("inputs", record.name, record.unit, record.doc, None)
    for record in module.STATES:
        doc = f"at t = 0: {record.doc}"
        yield Target("initial", record.name, record.unit, doc, record.bank)
    states = {record.name for record in module.STATES}
    for record in (r for r in module.BODIES if f"T_{r.name}" not in states):
        yield Target("initial", f"T_{record.name}", record.unit, f"at t = 0: {record.doc}", None)


def read_values(
    target: Target, given: Sequence[object] | FloatArray, where: str, duration: float
) -> FloatArray | tuple[Value, ...]:
    """Return a target's values, one per point; raise `UsageError` at the first that is invalid."""
    if target.is_size:
        return tuple(integer(value, f"{where}[{n}]", 1) for n, value in enumerate(given))
    plain = isinstance(given, np.ndarray) and given.ndim == 1 and given.dtype.kind in "iuf"
    if plain and np.isfinite(array := np.array(given, dtype=float)).all():
        return array
    listed = enumerate(given.tolist() if isinstance(given, np.ndarray) else given)
    values = tuple(read_value(target, value, f"{where}[{n}]", duration) for n, value in listed)
    numbers = all(isinstance(value, float) for value in values)
    return np.array(values, dtype=float) if numbers else values


def read_value(target: Target, value: object, where: str, duration: float) -> Value:
    """Return one value: a number, a signal, or one number per lane."""
    if is_number(value):
        return number(value, where)
    if target.kind == "inputs":
        return read_signal(value, where, (0.0, duration), target.unit)
    size = len(value) if target.bank and isinstance(value, Sequence | np.ndarray) else None
    return lane_value(value, size, where)


def label(value: Value) -> str:
    """Return one value as a text for a coordinate."""
    if isinstance(value, Samples):
        text = f"samples({value.times.size})"
    elif isinstance(value, InputFunction):
        text = str(getattr(value.function, "__name__", type(value.function).__name__))
    elif is_dataclass(value):
        numbers = ", ".join(f"{getattr(value, field.name):g}" for field in fields(value))
        text = f"{type(value).__name__.lower()}({numbers})"
    elif isinstance(value, tuple):
        text = f"[{', '.join(f'{lane:g}' for lane in value)}]"
    else:
        text = f"{value:g}" if is_number(value) else type(value).__name__
    return text if len(text) <= MOST_TEXT else f"{text[: MOST_TEXT - 3]}..."


@final
@dataclass(frozen=True)
class Axis:
    """A dimension of a sweep."""

    dim: str
    size: int
    targets: tuple[Target, ...]  # what changes along it
    labels: tuple[float | str, ...] | None  # of its points, if the user gave them

    @property
    def divides(self) -> bool:
        """Whether runs at different points need separate calls of C."""
        return any(target.divides for target in self.targets)

    def part(self, points: slice) -> Self:
        """Return some points of the axis."""
        targets = tuple(target.part(points) for target in self.targets)
        labels = None if self.labels is None else self.labels[points]
        return replace(self, size=points.stop - points.start, targets=targets, labels=labels)

    def coordinates(self) -> Iterator[tuple[str, Attributed]]:
        """Yield the name, the values and the attributes of each coordinate along this axis.

        A user's labels are the index of the dimension, and replace the values of a target with
        the same name.
        """
        if self.labels is not None:
            attrs = {"long_name": f"labels of {listing(t.name for t in self.targets)}"}
            yield self.dim, (self.labels, attrs)
        for target in self.targets:
            if self.labels is None or target.coordinate != self.dim:
                values = target.labels()
                attrs = {"units": target.unit} if isinstance(values, np.ndarray) else {}
                yield target.coordinate, (values, {**attrs, "long_name": target.doc})


def read_axes(
    module: GeneratedModule, over: object, duration: float, lanes: Mapping[str, int]
) -> tuple[Axis, ...]:
    """Return the axes of a sweep, in the order given; `lanes` are those of banks not swept."""
    if not isinstance(over, Mapping) or not over:
        what = f"{quote(over)} sweeps nothing" if over in ({}, None) else f"{quote(over)} is no map"
        raise UsageError(what, WHERE, "a mapping of names to lists of values")
    axes = tuple(read_axis(module, key, value, duration) for key, value in over.items())
    seen: set[tuple[str, str]] = set()
    for target in (target for axis in axes for target in axis.targets):
        if (target.kind, target.name) in seen:
            raise UsageError(f"'{target.name}' is swept twice", WHERE, remedy="name it once")
        seen.add((target.kind, target.name))
    refuse_lists(axes, lanes)
    return axes


def read_axis(module: GeneratedModule, key: object, given: object, duration: float) -> Axis:
    """Return the axis of one key."""
    words = key if isinstance(key, tuple) else (key,)
    if not words:
        raise UsageError("a key names nothing", WHERE, "a name, or a tuple of names")
    named = [find(module, word, WHERE) for word in words]
    name = ", ".join(map(str, words))
    labels, points = read_points(given, f"{WHERE}.{name}")
    columns = [points] if not isinstance(key, tuple) else unzip(points, words, name)
    targets = tuple(
        target.along(read_values(target, column, f"{WHERE}.{word}", duration))
        for target, column, word in zip(named, columns, words, strict=True)
    )
    dim = "_".join(target.coordinate for target in targets)
    return Axis(dim, len(points), targets, labels)


def read_points(
    given: object, where: str
) -> tuple[tuple[float | str, ...] | None, Sequence[object] | np.ndarray[Any, Any]]:
    """Return a user's labels, or None, and values, at least one."""
    labels: tuple[float | str, ...] | None = None
    if isinstance(given, Mapping):
        labels, given = read_labels(tuple(given), where), list(given.values())
    if not isinstance(given, list | tuple | range):
        given = np.asarray(given)
    if isinstance(given, np.ndarray) and (given.ndim == 0 or given.dtype.kind not in "iufO"):
        raise UsageError(f"{quote(given.tolist())} is no list of values", where, EXPECTED)
    if not len(given):
        raise UsageError("there are no values", where, "one value at least")
    return labels, given


def read_labels(keys: tuple[object, ...], where: str) -> tuple[float | str, ...]:
    """Return a user's labels: numbers, or texts."""
    if all(isinstance(key, str) for key in keys):
        return tuple(str(key) for key in keys)
    wrong = next((key for key in keys if not is_number(key)), None)
    if wrong is not None:
        raise UsageError(f"label {quote(wrong)} is mixed with others", where, "numbers, or texts")
    return tuple(number(key, f"{where} (label)") for key in keys)


def unzip(
    points: Sequence[object] | np.ndarray[Any, Any], words: tuple[object, ...], name: str
) -> list[Any]:
    """Return the values of each name of a zip from its points, one value per name."""
    if isinstance(points, np.ndarray) and points.ndim == 2 and points.shape[1] == len(words):
        return list(points.T)
    for n, point in enumerate(points):
        if not isinstance(point, tuple | list | np.ndarray) or len(point) != len(words):
            expected = f"a tuple of {len(words)} values, one each for {name}"
            raise UsageError(f"{quote(point)} is no point", f"{WHERE}.{name}[{n}]", expected)
    return [[point[n] for point in points] for n in range(len(words))]  # type: ignore[index]


def refuse_lists(axes: tuple[Axis, ...], lanes: Mapping[str, int]) -> None:
    """Raise `UsageError` where a swept list has not one value per lane of its bank.

    If the size of the bank is swept along another axis, each list has to fit every size.
    """
    sizes = {t.bank: (axis, t) for axis in axes for t in axis.targets if t.is_size}
    for axis in axes:
        for target in (t for t in axis.targets if t.bank and not t.is_size):
            other, size = sizes.get(target.bank, (None, None))
            for n, value in enumerate(target.values):
                counts = size.values if size else (lanes[str(target.bank)],)
                counts = (counts[n],) if size and other is axis else counts
                if isinstance(value, tuple) and any(len(value) != count for count in counts):
                    what = f"{len(value)} values for {listing(map(str, counts), 4)} lanes"
                    remedy = ""
                    if size and other is not axis:
                        remedy = f"zip both: ('{target.name}', '{size.name}')"
                    raise UsageError(what, f"{WHERE}.{target.name}[{n}]", "one per lane", remedy)


def single_numbers(axes: tuple[Axis, ...]) -> dict[str, float]:
    """Return a number for each swept parameter of a bank, in place of a list in the spec.

    A number fits the bank at every size; the spec's list may not.
    """
    targets = [target for axis in axes for target in axis.targets]
    swept = [t for t in targets if t.kind == "parameters" and t.bank and not t.is_size]
    return {t.name: float(np.ravel(t.values[0])[0]) for t in swept}  # type: ignore[arg-type]
