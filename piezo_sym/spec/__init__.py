"""Specs: text to a checked, frozen model.  Nothing here imports SymPy."""
