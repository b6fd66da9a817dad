"""``piezo-sym schema``: what an editor needs to complete and check specs."""

import json

import typer


def schema() -> None:
    """Print the JSON Schema (draft 2020-12) of specs.

    Editors complete and check specs with it (Even Better TOML, Taplo). Once in a folder:

    piezo-sym schema > piezo-sym.schema.json

    and as the first line of each spec, where `piezo-sym new` writes it:

    #:schema ./piezo-sym.schema.json
    """
    from piezo_sym.spec.schema import schema as of_specs

    typer.echo(json.dumps(of_specs(), indent=2))
