"""Networks: the junction laws of a circuit, solved exactly for its junction structure."""

from piezo_sym.network.inverse import slope_of
from piezo_sym.network.junction import Junction, junction_of
from piezo_sym.network.kirchhoff import Driven, port_order

__all__ = ["Driven", "Junction", "junction_of", "port_order", "slope_of"]
