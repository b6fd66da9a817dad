"""The version of the package, which generated files name as their generator."""

VERSION = "0.1.0"
#: How a generated file begins.
MADE = f"Made by piezo_sym {VERSION}; do not edit: change the spec, then run `piezo-sym generate`."
