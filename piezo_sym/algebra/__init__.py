"""SymPy for this package: symbols, sums and matrices over lanes, elimination, notation."""
