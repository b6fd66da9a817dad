"""The units that specs use most: known without pint, which takes most of a second to load."""

from fractions import Fraction

#: Coherent units as powers of kg, m, s, A, K, mol.
COHERENT = {
    "1": (), "kg": (1,), "m": (0, 1), "s": (0, 0, 1), "A": (0, 0, 0, 1), "K": (0, 0, 0, 0, 1),
    "N": (1, 1, -2), "Pa": (1, -1, -2), "J": (1, 2, -2), "W": (1, 2, -3), "Hz": (0, 0, -1),
    "C": (0, 0, 1, 1), "V": (1, 2, -3, -1), "F": (-1, -2, 4, 2), "ohm": (1, 2, -3, -2),
    "S": (-1, -2, 3, 2), "Wb": (1, 2, -2, -1), "T": (1, 0, -2, -1), "H": (1, 2, -2, -2),
    "mol": (0, 0, 0, 0, 0, 1), "rad": (),
}  # fmt: skip
#: Units with exact factors: the coherent unit of each, the factor to it, and its powers.
EXACT = {name: (name, Fraction(1), powers) for name, powers in COHERENT.items()} | {
    "g": ("kg", Fraction(1, 1000), COHERENT["kg"]),
    "l": ("m**3", Fraction(1, 1000), (0, 3)),
    "bar": ("Pa", Fraction(100_000), COHERENT["Pa"]),
}
#: Prefixes of these, and their powers of ten.
PREFIXES = {"p": -12, "n": -9, "u": -6, "m": -3, "c": -2, "k": 3, "M": 6, "G": 9}
