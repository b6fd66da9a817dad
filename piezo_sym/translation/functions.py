"""Powers, exponentials, logarithms and other smooth functions in normal form.

Input: values.  Output: values.  What a function needs of its argument is noted in `Field.needs`.
Identities used, and their premises:
exp(a + b) = exp(a) exp(b); exp(c log x) = x**c (of `raised` 0 where x = 0); log(exp z) = z;
log(c + c exp(2 z)) = log(2 c) + z + log(cosh z) for c > 0 (`by_cosh`);
log(a b) = log a + log b and (a b)**c = a**c b**c for a, b > 0, and log(a b) = log(-a) + log(-b)
for a, b < 0; (x**(1/n))**n = x for x >= 0;
(x**2)**(1/2) = abs(x); f(-x) = -f(x) or f(x) where a record says that f is odd or even.
"""

from collections.abc import Iterator
from fractions import Fraction
from functools import partial

from sympy import factorint

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.translation.field import Exponent, GeneratorField, Need, NotShownError, Value
from piezo_sym.translation.signs import compare, factors, lifted, primitive, side_of, sign

MOST_FACTOR = 10**12


def power(base: Value, exponent: Exponent) -> Value:
    """Return a rational power."""
    if exponent.denominator == 1 and exponent >= 0:
        return base.field.whole_power(base, exponent.numerator)
    if exponent.denominator != 1 and exponent < 0:  # 1/root, as laws and printed text write it
        return power(power(base, -exponent), -1)
    q = exponent.numerator if exponent.denominator == 1 else exponent
    return lifted(partial(_power, q), base)


def _power(q: Exponent, base: Value) -> Value:
    """Return a power of a value without signs, the exponent a fraction or negative."""
    field, root = base.field, q.denominator != 1
    size, common, rest = primitive(base, partly=root) if base.terms else (Fraction(1), (), base)
    if not rest.terms:
        return rest if q > 0 else _undefined(field, "nonzero")
    made = _root(field, size, q)
    for g, e in common:
        made = made * field.raised(g, e * q)
        for divisor in divisors(field, g) if q < 0 else ():
            _needs("nonzero", divisor)
    if root:
        rest, even = _even(rest, q)
        made = made * even
        _needs("nonnegative", rest if sign(Value(field, {common: 1})) == 2 else base)
    for factor, times in ([(rest, 1)] if rest != field.one else []) if root else factors(rest):
        made = made * _generated(factor, times * q)
        if q < 0:
            _needs("nonzero", factor)
    return made


def divisors(field: GeneratorField, g: int) -> Iterator[Value]:
    """Yield the values that must not be zero where a generator divides; letters are written out."""
    gen = field.gens[g]
    if gen.kind != "letter" or gen.arg is None:
        yield _base(field, g)
        return
    _, common, rest = primitive(gen.arg, partly=False)
    for other, _ in common:
        yield from divisors(field, other)
    yield from (factor for factor, _ in factors(rest))


def _generated(arg: Value, q: Exponent) -> Value:
    """Return a power of a sum as a generator."""
    ((mono, _),) = arg.field.generator("power", arg).terms.items()
    return arg.field.raised(mono[0][0], q) * arg.field.one


def _root(field: GeneratorField, size: Fraction, q: Exponent) -> Value:
    """Return a power of a number, positive if the exponent is a fraction."""
    if q.denominator == 1:
        return field.number(size**q.numerator)
    if max(size.numerator, size.denominator) > MOST_FACTOR:
        raise NotShownError("a root of a long number")
    made = field.one
    for part, turn in ((size.numerator, 1), (size.denominator, -1)):
        for prime, times in factorint(part).items():
            made = made * _generated(field.number(prime), turn * times * q)
    return made


def _even(value: Value, q: Exponent) -> tuple[Value, Value]:
    """Return a value without even factors such as x**2, and their power q, such as ``abs(x)``."""
    field, made = value.field, value.field.one
    for g in value.generators():
        e = min(dict(mono).get(g, 0) for mono in value.terms)
        if e and e % 2 == 0 and (e * q).denominator == 1:
            value = value * field.raised(g, -e)
            made = made * power(size_of(field.raised(g, 1)), e * q)
    return value, made


def _needs(kind: str, value: Value) -> None:
    field, enough = value.field, 2 if kind != "nonnegative" else 1
    below = kind == "nonzero" and sign(-value) == 2
    if field.path is not None and sign(value) < enough and not below:
        field.needs[Need(kind, value, field.path, field.derived, field.outside)] = None


def _undefined(field: GeneratorField, kind: str) -> Value:
    """Return 1/0 or log(0) as a new name, and note a need that fails wherever it is chosen."""
    _needs(kind, field.zero)
    return field.generator("name", None, (f"not {kind}", None, 0))


def raised(base: Value, exponent: Value) -> Value:
    """Return base**exponent of a base >= 0 with a positive exponent: 0 where the base is 0."""
    return lifted(partial(_raised, exponent), base)


def _raised(exponent: Value, base: Value) -> Value:
    _needs("positive", exponent)
    _needs("nonnegative", base)
    above = compare(">", base, base.field.zero)
    return above * call("exp", exponent * _log_of_product(base)) if above.terms else above


def call(function: str, arg: Value) -> Value:
    """Return a smooth function of a value."""
    own = {"exp": _exp, "log": _log}.get(function)
    return lifted(own or partial(_even_or_odd, function), arg)


def _exp(arg: Value) -> Value:
    field, made = arg.field, arg.field.one
    for mono, c in arg.terms.items():
        gen = field.gens[mono[0][0]] if len(mono) == 1 and mono[0][1] == 1 else None
        if gen and gen.kind == "log" and gen.arg:
            made = made * power(gen.arg, c)
        else:
            ((inner, _),) = field.generator("exp", Value(field, {mono: 1})).terms.items()
            made = made * field.raised(inner[0][0], c)
    return made


def _log(arg: Value) -> Value:
    field = arg.field
    if not arg.terms:
        return _undefined(field, "positive")
    _needs("positive", arg)
    return _log_of_product(arg)


def _log_of_product(arg: Value) -> Value:
    """Return the sum of the logarithms of factors of known signs; else a logarithm of the product.

    For a factor a < 0 with an integer exponent e it takes log(-a), as a**e = (-1)**e (-a)**e.  If
    the coefficient, with these signs, is not positive, the product is not shown to be positive.
    """
    field, logs = arg.field, list[Value]()
    number, common, rest = primitive(arg, partly=False)
    others = [(rest, 1)] if rest != field.one else []
    for base, e in (*((_base(field, g), e) for g, e in common), *others):
        above = base if sign(base) == 2 else -base
        if not base.terms or sign(above) < 2 or (above != base and Fraction(e).denominator != 1):
            return field.generator("log", arg)
        number = -number if above != base and e % 2 else number
        logs.append(_log_of_positive(above) * field.number(e))
    if number <= 0:
        return field.generator("log", arg)
    whole = ((number.numerator, 1), (number.denominator, -1))
    logs += [field.generator("log", field.number(n)) * field.number(s) for n, s in whole if n != 1]
    return field.total(logs)


def _base(field: GeneratorField, g: int) -> Value:
    """Return a generator as a value in normal form; for a power of a sum, that sum."""
    gen = field.gens[g]
    return gen.arg if gen.kind == "power" and gen.arg else field.raised(g, 1)


def _log_of_positive(base: Value) -> Value:
    """Return the logarithm of a value; log(exp z) = z."""
    field = base.field
    for gen in map(field.gens.__getitem__, base.generators()):
        if gen.kind == "exp" and gen.arg and base == field.generator("exp", gen.arg):
            return gen.arg
    return field.generator("log", base)


def by_cosh(arg: Value) -> Value | None:
    """Return log(2 c) + z + log(cosh z) for the logarithm of c + c exp(2 z), c > 0, or None."""
    field, factor = arg.field, arg.terms.get(())
    others = [mono for mono in arg.terms if mono]
    if factor is None or factor <= 0 or len(others) != 1 or arg.terms[others[0]] != factor:
        return None
    gens = [(field.gens[g], e) for g, e in others[0]]
    if not all(gen.kind == "exp" and gen.arg for gen, _ in gens):
        return None
    z = field.total([gen.arg * field.number(Fraction(e) / 2) for gen, e in gens if gen.arg])
    return field.total([call("log", field.number(2 * factor)), z, call("log", call("cosh", z))])


def _even_or_odd(function: str, arg: Value) -> Value:
    field, record = arg.field, RECORDS[function]
    if not arg.terms and record.known and record.known[0] == 0:
        return field.number(record.known[1])
    if arg.lead > 0 or not record.parity:
        return field.generator(function, arg)
    made = field.generator(function, -arg)
    return made if record.parity == "even" else -made


def size_of(value: Value) -> Value:
    """Return the absolute value."""
    if max(sign(value), sign(-value)) > 0:
        return value if sign(value) else -value
    return value * side_of(value)
