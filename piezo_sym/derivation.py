"""Model to irreversible port-Hamiltonian system: the table of contents of the derivation.

    stage        from -> to                    what happens                           in
    flatten      Model -> Model                components become elements             spec
    circuit      Model -> Circuit              elements state their ports             spec
    symbols      Circuit -> SymbolTable        names become SymPy symbols             algebra
    junction     Circuit -> Junction           Kirchhoff's and Newton's laws solved   network
    system       Junction -> IPHS              Definition 1, and what follows         iphs

Laws are trees of `expressions`, from the spec to the printers.  Banks stay symbolic in their size r
throughout (`algebra.lanes`); `IPHS.expand` writes them out.
"""

from piezo_sym.algebra.symbols import symbol_table
from piezo_sym.errors import PiezoError, UsageError, quote
from piezo_sym.iphs import IPHS, iphs_of
from piezo_sym.network import junction_of
from piezo_sym.spec.circuit import circuit_of
from piezo_sym.spec.model import Model


def derive(model: Model) -> IPHS:
    """Return the irreversible port-Hamiltonian system of a model.

    Parameters
    ----------
    model : from `load`, or made in Python.

    Returns
    -------
    IPHS
        With ``.x .u .U .S .E .J0 .processes .J_ir .g .y .y_s .rhs .sigma``; see there for shapes.

    Raises
    ------
    UsageError
        If `model` is no `Model`.
    NetworkError
        If the network's laws have no, or more than one, solution; names the elements at fault.
    SpecError
        If a storage law has no energy in closed form.
    """
    if not isinstance(model, Model):
        remedy = "load it first: derive(load('piezo_stack'))"
        raise UsageError(f"{quote(model)} is no Model", "derive", remedy=remedy)
    flat = model.flatten()
    try:
        circuit = circuit_of(flat)
        symbols = symbol_table(circuit)
        junction = junction_of(circuit, symbols)
        return iphs_of(symbols, junction)
    except PiezoError as error:
        flat.origins.put_in(error)
        raise
