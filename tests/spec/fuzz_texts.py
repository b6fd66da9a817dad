"""Hostile and damaged texts from a seed: laws, and whole specs."""

import random
import re
from collections.abc import Iterator

from piezo_sym.spec.source import MODELS

_PLAIN = r"""i v T f q Q S p phi np d rho i_0 T_0 c_0 x 0 1 2 0.5 1e3 1e-300 1e300 1_000 0x10 1j
    9999999999999999 1e999999999 007 + - * / ** // % @ ^ ~ & | << ( ) [ ] { } , ; : . := = == != <
    <= > >= -> ! if else and or not in is for while lambda def class return yield await import del
    pass None True False __import__ __class__ __builtins__ os.system open eval exec compile getattr
    breakpoint exit exp log sqrt sin cos tanh abs sign min max deadzone saturate sum pow factorial
    ' " \ # $ ` ? _ e"""
_ODD = r"\u03b1 \uff34 \u200b \u0410 \x00 \n \t \x1b \U0001f600 \u00b2 \u0660 \u202e \ud800"
WORDS = [*_PLAIN.split(), " ", *(word.encode().decode("unicode_escape") for word in _ODD.split())]
TWO = ["+", "-", "*", "/"]
POWERS = ["2", "3", "16", "(1/3)", "-1", "0.5", "17", "(-2/3)"]
ONE = ["-", "+", "exp", "log", "sqrt", "sin", "cos", "tanh", "abs", "sign"]
OPENINGS = ["exp(", "min(", "-(", "1/(", "**", " if v<1 else "]
PAIR = ["min", "max", "deadzone", "saturate"]
LEAVES = ["v", "T", "d", "i", "1", "2", "0.5", "16", "0", "1e300", "(1+v)", "(v+T+d)", "(1/3)"]
ATTACKS = [
    "__import__('os').system('touch canary')",
    "open('canary', 'w')",
    "().__class__.__base__.__subclasses__()",
    "[x for x in (1).__class__.__mro__]",
    "exec('import os')",
    "eval('1')",
    "lambda: 1",
    "f'{1}'",
    "9**9**9",
    "1e999999999",
    "factorial(10000)",
    "exp(exp(exp(exp(1000))))",
    "i if i else 0",
    "i<1<2",
    "T:=3",
    "exp(",
    "i**T",
    "sqrt(-1)",
    "1/0",
]
_VALUES = """nan inf -inf true false 0 -1 1e400 1e-400 "1" "" [] [[]] {} [1,2] "d*v" ["a","b"]
    ["a"] ["gnd","wall"] ["wall","wall"]
    1979-05-27 07:32:00 0x1F 1_0 +1 'x' "in" "gnd" "wall"
    "tip" "kg" "degC" "m**9**9**9" "N*s/m" "body" "spring" "mass" "hysteron" "resistor" "ambient"
    9999999999999999999"""
VALUES = _VALUES.split()
PIECES = re.compile(r'"[^"\n]*"|\w+|[^\w\s]|\s+')
QUOTED = re.compile(r'(?<=")[^"\n]*[*/+(][^"\n]*(?=")')


def nested(rng: random.Random, depth: int) -> str:
    """Return a law of some depth, mostly of the grammar."""
    if depth <= 0 or rng.random() < 0.1:
        return rng.choice(LEAVES)
    part = nested(rng, depth - 1)
    match rng.randrange(7):
        case 0:
            return f"{rng.choice(ONE)}({part})"
        case 1:
            return f"{rng.choice(PAIR)}({part}, {nested(rng, depth // 2)})"
        case 2:
            return f"({part})**{rng.choice(POWERS)}"
        case 3:
            return f"({part} if {nested(rng, depth // 2)} < {rng.choice(LEAVES)} else v)"
        case 4:
            return f"({rng.choice(TWO).join([part] * rng.randint(1, 4))})"
        case 5:
            return f"({part}{rng.choice(TWO)}{nested(rng, depth // 2)})"
    return part if rng.random() < 0.98 else f"{part}("


def damaged(rng: random.Random, pieces: list[str], words: list[str]) -> str:
    """Return a text some of whose pieces are lost, doubled, exchanged or replaced."""
    found = list(pieces)
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        if not found:
            break
        at, other = rng.randrange(len(found)), rng.randrange(len(found))
        match rng.randrange(6):
            case 0:
                del found[at : at + rng.randint(1, 6)]
            case 1:
                found[at:at] = found[at : at + rng.randint(1, 30)]
            case 2:
                found[at], found[other] = found[other], found[at]
            case 3:
                found[at] = rng.choice(words)
            case 4:
                found.insert(at, rng.choice(words))
            case _:
                found[at] = found[other]
    return "".join(found)


def law_texts(seed: int, count: int) -> Iterator[str]:
    """Yield texts that stand where a law should."""
    rng = random.Random(seed)
    for _ in range(count):
        match rng.randrange(5):
            case 0:
                yield rng.choice(["", " "]).join(rng.choices(WORDS, k=rng.randint(0, 16)))
            case 1:
                yield nested(rng, rng.randint(1, 45))[: rng.choice([60, 300, 1000, 5000])]
            case 2:
                law = nested(rng, rng.randint(1, 8))
                yield damaged(rng, PIECES.findall(law), WORDS)
            case 3:
                piece = rng.choice(
                    WORDS + TWO + LEAVES + ["exp(", "min(", "-(", "1/(", "**", " if v<1 else "]
                )
                yield "v" + piece * rng.choice([3, 12, 45, 300]) + "v"
            case _:
                attack = rng.choice(ATTACKS)
                yield damaged(rng, list(attack), WORDS) if rng.random() < 0.5 else attack


def spec_texts(seed: int, count: int) -> Iterator[str]:
    """Yield texts that stand where a spec should: damaged versions of the shipped ones."""
    rng = random.Random(seed)
    shipped = [path.read_text(encoding="utf-8") for path in sorted(MODELS.glob("*.toml"))]
    pieces = {text: PIECES.findall(text) for text in shipped}
    blocks = {text: re.split(r"(?<=\n\n)", text) for text in shipped}
    lines = {text: text.splitlines(keepends=True) for text in shipped}
    words = sorted({piece for found in pieces.values() for piece in found}) + VALUES + WORDS
    for _ in range(count):
        text = rng.choice(shipped)
        match rng.randrange(5):
            case 0:
                yield damaged(rng, blocks[text], blocks[text])
            case 1:
                yield damaged(rng, lines[text], lines[text])
            case 2:
                at = rng.choice(list(re.finditer(r"(?<== )[^,\n}]+", text)))
                yield text[: at.start()] + rng.choice(VALUES) + text[at.end() :]
            case 3:
                at = rng.choice(list(QUOTED.finditer(text)))
                (law,) = law_texts(rng.randrange(2**32), 1)
                yield text[: at.start()] + law + text[at.end() :]
            case _:
                yield damaged(rng, pieces[text], words)
