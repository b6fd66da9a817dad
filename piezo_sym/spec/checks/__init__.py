"""Checks of a spec's tables against each other: names, references, laws, lanes, values."""
