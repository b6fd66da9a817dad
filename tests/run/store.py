# ruff: noqa: ARG001 - functions take what the interface gives them
"""A store that adds up its inputs, in the interface of a generated module, written by hand.

dx/dt = power + other, U = x: what a signal's integral is, the state is.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "store"
SPEC_SHA256 = "2" * 64


class Record(NamedTuple):
    name: str
    unit: str
    doc: str
    bank: str | None = None


class Condition(NamedTuple):
    text: str
    strict: bool


STATES = (Record("x", "J", "energy stored"),)
INPUTS = (Record("power", "W", "power put in"), Record("other", "W", "more power"))
INPUT_DEFAULTS = (0.0, 0.0)
OUTPUTS = (Record("feed", "1", "1 at 'feed'"), Record("more", "1", "1 at 'more'"))
ELEMENTS = ()
PROCESSES = ()
BODIES = ()
BANKS = ()
PARAMETERS = (Record("x_max", "J", "what fits in"),)
DOMAIN = (Condition("x < x_max", True),)


@dataclass(frozen=True)
class Parameters:
    x_max: float = 1e9


def initial_state(u, p, /):
    return np.zeros(1)


def rhs(x, u, p, /):
    return np.zeros_like(x) + u[0] + u[1]


def jacobian(x, u, p, /):
    return np.zeros((1, *np.shape(x)))


def outputs(x, u, p, /):
    return np.ones((2, *np.shape(x)[1:]))


def supply(x, u, p, /):
    return np.array(u)


def energy(x, p, /):
    return x[0]


def entropy(x, p, /):
    return np.zeros(np.shape(x)[1:])


def temperatures(x, p, /):
    return np.empty((0, *np.shape(x)[1:]))


def heat(x, u, p, /):
    return np.empty((0, *np.shape(x)[1:]))


entropy_production = heat


def elements(x, u, p, /):
    return np.empty((0, *np.shape(x)[1:]))


def margins(x, u, p, /):
    return p.x_max - x
