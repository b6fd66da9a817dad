"""A step: what one step of the discrete gradient computes, before any language.

Input: nothing; these are the types.  Output: frozen records that `newton` fills and printers read.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from piezo_sym.codegen.program import Quantity, Row
from piezo_sym.expressions.tree import Expr, Sym


@final
@dataclass(frozen=True)
class Change:
    """What Newton's method takes from a state: ``free - sum of reaction*unknown``.

    Attributes
    ----------
    free : a value; of a bank, one a lane.
    reactions : pairs of a quantity and the unknown it goes with; none for a shared state.
    """

    free: Expr
    reactions: tuple[tuple[Sym, Sym], ...] = ()


@final
@dataclass(frozen=True)
class Step:
    """What a step computes.

    Attributes
    ----------
    h, after : the names of the step size and of each state after the step, in state order.
    quantities : in an order in which they can be computed.
    pivots : quantities that have to be positive, or else the step is too long.
    changes : of each state, in state order.
    supplies, entropies : power and entropy rate that ports put in, a row a port and an exchange.
    heats, productions : heat and entropy production of each process, a bank's one a lane.
    taken : every name in use.
    numerical : of a dissipative step, heat and entropy production of its numerical loss.
    """

    h: str
    after: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    pivots: tuple[Sym, ...]
    changes: tuple[Change, ...]
    supplies: tuple[Row, ...]
    entropies: tuple[Row, ...]
    heats: tuple[Row, ...]
    productions: tuple[Row, ...]
    taken: frozenset[str]
    numerical: tuple[Row, ...] = ()
