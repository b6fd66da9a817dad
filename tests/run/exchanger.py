# ruff: noqa: ARG001 - functions take what the interface gives them
"""Two bodies in contact, in the interface of a generated module, written by hand; no input at all.

T_i = T_0 exp(S_i/c_i), lam (T_1 - T_2) flows from 1 to 2:
T_1 - T_2 = 60 exp(-lam (1/c_1 + 1/c_2) t).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "exchanger"
SPEC_SHA256 = "1" * 64


class Record(NamedTuple):
    name: str
    unit: str
    doc: str
    bank: str | None = None


class Condition(NamedTuple):
    text: str
    strict: bool


STATES = (Record("S_1", "J/K", "entropy of body 1"), Record("S_2", "J/K", "entropy of body 2"))
INPUTS = ()
INPUT_DEFAULTS = ()
OUTPUTS = ()
ELEMENTS = ()
PROCESSES = (Record("wall", "W/K", "conduction 'wall'"),)
BODIES = (Record("1", "K", "body 1"), Record("2", "K", "body 2"))
BANKS = ()
PARAMETERS = (
    Record("c_1", "J/K", ""),
    Record("c_2", "J/K", ""),
    Record("lam", "W/K", ""),
    Record("T_0", "K", ""),
    Record("gap", "K", ""),
)
DOMAIN = (Condition("lam >= 0", False), Condition("T_1 - T_2 > gap", True))


@dataclass(frozen=True)
class Parameters:
    c_1: float = 2.0
    c_2: float = 3.0
    lam: float = 0.5
    T_0: float = 300.0
    gap: float = 0.0


def initial_state(u, p, /):
    return np.array([p.c_1 * np.log(350 / p.T_0), p.c_2 * np.log(290 / p.T_0)])


def temperatures(x, p, /):
    x = np.asarray(x, dtype=float)
    return np.stack([p.T_0 * np.exp(x[0] / p.c_1), p.T_0 * np.exp(x[1] / p.c_2)])


def heat(x, u, p, /):
    hot, cold = temperatures(x, p)
    return (p.lam * (hot - cold))[None]


def entropy_production(x, u, p, /):
    hot, cold = temperatures(x, p)
    return (p.lam * (hot - cold) ** 2 / (hot * cold))[None]


def rhs(x, u, p, /):
    hot, cold = temperatures(x, p)
    flow = p.lam * (hot - cold)
    return np.stack([-flow / hot, flow / cold])


def jacobian(x, u, p, /):
    hot, cold = temperatures(x, p)
    return np.stack(
        [
            np.stack([-p.lam * cold / hot / p.c_1, p.lam * cold / hot / p.c_2]),
            np.stack([p.lam * hot / cold / p.c_1, -p.lam * hot / cold / p.c_2]),
        ]
    )


def outputs(x, u, p, /):
    return np.empty((0, *np.shape(x)[1:]))


supply = outputs


def energy(x, p, /):
    hot, cold = temperatures(x, p)
    return p.c_1 * hot + p.c_2 * cold


def entropy(x, p, /):
    return np.sum(x, axis=0)


def elements(x, u, p, /):
    return np.empty((0, *np.shape(x)[1:]))


def margins(x, u, p, /):
    hot, cold = temperatures(x, p)
    return np.stack([np.full_like(hot, p.lam), hot - cold - p.gap])
