"""``python -m piezo_sym``: the command ``piezo-sym``."""

from piezo_sym.cli import main

main()
