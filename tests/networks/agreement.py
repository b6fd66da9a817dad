"""What must hold of one network: a good refusal, or proofs and a module that agree with references.

Input: a spec as plain data and a seed for states.  Output: the name of the outcome.  There are two
references: SymPy's own mathematics of the derived system, with 40 digits, and the numeric solution
of Kirchhoff's and Newton's laws from the spec alone (`tableau`).
"""

import itertools
from dataclasses import replace
from functools import partial
from unittest.mock import patch

import mpmath as mp
import numpy as np
from element_balances import check_elements
from kinds import KINDS
from law_values import value
from network_tableau import Tableau, entropy_of, pairs_of, state
from precise import DIGITS, all_measured

from piezo_sym import Model, PiezoError, derive
from piezo_sym.build import files_of
from piezo_sym.codegen import template_of
from piezo_sym.errors import NetworkError
from piezo_sym.falsify import module_from
from piezo_sym.proofs import Verdict, decide, obligations, prove
from piezo_sym.spec.load import parse
from piezo_sym.spec.tables import banks
from piezo_sym.translation import field, program_row
from piezo_sym.verification.examine import examine, examined

DERIVED, REFUSED = "derived", "refused"
PROVED = ("skew", "casimir", "energy", "entropy")
TOLERANCE = 1e-12
STEP = mp.mpf(10) ** -15
POINTS = 2
#: Points of the attack on proofs, and of how many networks one is attacked: it takes half the time.
FEW, ATTACKED = 2_000, 4
#: What reading back may take: seconds.
WORK = 1_000_000


def check(spec, seed=0):
    """Check one network, and return whether it was derived or refused."""
    return check_laws(spec, seed, more=partial(check_examination, spec))


def check_laws(spec, seed=0, more=None):
    """Check the laws of one network, by algebra and by numbers, and `more`.

    Return whether it was derived or refused.
    """
    try:
        model = Model(**spec)
        iphs = derive(model)
    except PiezoError as error:
        check_refusal(error, spec)
        return REFUSED
    assert parse(model.to_toml()) == model
    systems = [iphs.expand()]
    systems += [iphs] if banks(model) else []
    balances = (o for o in obligations(systems[0]) if o.id in PROVED)
    check_proved((prove(o, systems[0]) for o in itertools.islice(balances, len(PROVED))), PROVED)
    template = template_of(iphs)
    if more:
        more(iphs, template, seed)
    module = module_from(template.filled(model.flatten().model_dump())[".py"])
    points = [point(spec, systems[0].x, seed + n) for n in range(POINTS)]
    for x, u in points:
        for system in systems:
            check_against_sympy(module, system, x, u)
        check_against_tableau(module, spec, x, u)
        check_entropy(module, spec, x, u)
        check_elements(module, spec, x, u)
    check_batch(module, points)
    return DERIVED


def check_proved(rows, wanted):
    """Check that rows are PROVED, or rest on a temperature that is not known to be positive."""
    rows = {row.id: row for row in rows if not row.reason.startswith("it rests on temperature of")}
    assert all(row.verdict is Verdict.PROVED for name, row in rows.items() if name in wanted)


def check_examination(spec, iphs, template, seed):
    """Check the report on a network, and that its files are the same when written again."""
    report = report_on(iphs, template, attacked=seed % ATTACKED == 0)
    assert all(r.verdict is not Verdict.REFUTED for r in report.rows if r.id == "program")
    read_back = () if may_stay_open(spec) or may_stay_unread(report) else ("program",)
    check_proved(report.rows, (*PROVED, *read_back))
    if seed % 4 == 1:
        made = (template_of(derive(iphs.model)) for _ in range(2))
        first, again = (files_of(iphs.model, report, template) for template in made)
        assert all(one.splitlines() == again[name].splitlines() for name, one in first.items())


def report_on(iphs, template, *, attacked):
    """Return the proofs of a system and of its printed modules, attacked by numbers or not."""
    if attacked:
        return examined(examine(iphs, points=FEW))
    proved = decide(iphs)
    texts = template.filled(iphs.model.flatten().model_dump())
    with patch.object(field, "MOST_WORK", WORK):
        return replace(proved, rows=(*proved.rows, program_row(iphs, texts)))


def may_stay_open(spec):
    """Return whether a law may have a jump at sums over two banks, or a kink at one of stores."""
    elements = spec["elements"].values()
    jumps = any(element.get("discontinuous") for element in elements)
    banks = [e for e in elements if "count" in e and e["kind"] not in ("hysteron", "stop")]
    words = ("if", "deadzone", "saturate", "abs", "max", "min", "sign")
    kinks = any(word in str(element) for element in elements for word in words)
    return jumps or bool(banks and kinks)


def may_stay_unread(report):
    """Return whether reading back needs a value not to be zero of which no proof says so.

    Or whether the expressions are too large: they grow fast where storages see each other.
    """
    reasons = [row.reason for row in report.rows if row.id == "program"]
    open_laws = any(r.verdict is Verdict.OPEN for r in report.rows if r.id == "welldef")
    large = any("too large" in reason for reason in reasons)
    return large or (open_laws and any("nonzero" in reason for reason in reasons))


def point(spec, symbols, seed):
    """Return a state, currents and entropies inside the domain, and inputs."""
    rng = np.random.default_rng(seed)
    bodies = {entropy_of(n, e) for n, e in spec["elements"].items()}
    x = [rng.uniform(0.05, 1) if s.name in bodies else rng.uniform(-1.5, 1.5) for s in symbols]
    heat = [entry["unit"] == "K" for entry in spec["inputs"].values()]
    return np.array(x), np.array([rng.uniform(2, 5) if h else rng.uniform(-1.5, 1.5) for h in heat])


# Refusals


def check_refusal(error, spec):
    """Check that a refusal is one line that names a place in the spec and says what to do."""
    message = str(error)
    assert error.exit_code == 2, message
    assert message.isprintable(), message
    assert error.remedy or error.expected, message
    elements = spec["elements"]
    nodes = {n for e in elements.values() for ends in ends_of(e) for n in ends}
    names = [*elements, *nodes, *spec["parameters"]]
    assert any(f"'{name}'" in message or f".{name}" in message for name in names), message
    if isinstance(error, NetworkError) and ("fix each other" in message or "nothing" in message):
        laws = generic(spec)
        assert "is of a bank" in message or not laws.is_regular(), message
        if "fix each other" in message and "of parameters alone" not in message:
            assert not laws.joint.joinable, message
    if "determine each other" in message and "none of a bank" not in message:
        assert generic(spec).has_nonlinear_loop(), message


def ends_of(element):
    """Return the nodes of an element."""
    if KINDS[element["kind"]].form == "coupling":
        return pairs_of(element)
    inner = (tuple(entry.get("between", ())) for entry in element.get("states", {}).values())
    return (element.get("between", ()), (element["at"],) if "at" in element else (), *inner)


def generic(spec):
    """Return the laws of a spec at numbers that stand for almost all others."""
    names = [
        f"{state(name, e)}{lane}"
        for name, e in spec["elements"].items()
        if KINDS[e["kind"]].letter
        for lane in ([f"_{n + 1}" for n in range(e["count"])] if "count" in e else [""])
    ]
    names += [symbol for e in spec["elements"].values() for symbol in e.get("states", ())]
    rng = np.random.default_rng(1)
    states = dict(zip(names, rng.uniform(0.1, 0.9, len(names)), strict=True))
    parameters = {
        name: {"value": (np.array(entry["value"]) * rng.uniform(0.8, 1.2)).tolist()}
        for name, entry in spec["parameters"].items()
    }
    return Tableau({**spec, "parameters": parameters}, states, dict.fromkeys(spec["inputs"], 4.0))


# References


def close(found, wanted, size, what):
    """Check numbers against references, to 1e-12 of the size that rounding goes with."""
    found = np.asarray(found, dtype=float)
    assert found.shape == (len(wanted),), what
    for n, (a, (b, s)) in enumerate(zip(found, wanted, strict=True)):
        error = abs(mp.mpf(float(a)) - b)
        assert error <= TOLERANCE * (s + size), (what, n, float(a), mp.nstr(b, 17))


def check_against_sympy(module, system, x, u):
    """Check every function of the module against the exact mathematics of a derived system."""
    p = module.Parameters()
    sizes = banks(system.model)
    rows = {name: explicit(getattr(system, name), sizes) for name in ("x", "rhs", "y", "u", "E")}
    names = [symbol.name for symbol in rows["x"]]
    fixed = {**values_of(module), **dict(zip(system.model.inputs, u, strict=True))}
    scalars = {
        name: system.system.E.lanes.expand(getattr(system, name), sizes)
        for name in ("U", "S", "sigma")
    }

    def at(where, expressions):
        values = {**fixed, **dict(zip(names, where, strict=True))}
        return all_measured(expressions, values)

    rates = at(x, rows["rhs"])
    close(module.rhs(x, u, p), rates, 0, "rhs")
    outputs = at(x, rows["y"])
    close(module.outputs(x, u, p), outputs, 0, "outputs")
    powers = [
        (y * v, sy * abs(v) + abs(y) * sv)
        for (y, sy), (v, sv) in zip(outputs, at(x, rows["u"]), strict=True)
    ]
    close(module.supply(x, u, p), powers, 0, "supply")
    close([module.energy(x, p)], at(x, [scalars["U"]]), 0, "energy")
    close([module.entropy(x, p)], at(x, [scalars["S"]]), 0, "entropy")
    produced = module.entropy_production(x, u, p)
    close([produced.sum()], at(x, [scalars["sigma"]]), abs(produced).sum(), "production")
    check_power(module, at, scalars["U"], rows, powers, x, u)
    check_jacobian(module, at, rows["rhs"], x, u)


def check_power(module, at, energy, rows, powers, x, u):
    """Check the first law, dU/dt = y^T u, by the difference of U along the module's rates."""
    p = module.Parameters()
    speed = module.rhs(x, u, p)
    ahead, behind = moved(x, speed)
    with mp.workdps(DIGITS):
        (high, _), (low, _) = at(ahead, [energy])[0], at(behind, [energy])[0]
        growth = (high - low) / (2 * STEP)
        size = sum(s for _, s in powers)
        for (slope, s), (rate, t) in zip(at(x, rows["E"]), at(x, rows["rhs"]), strict=True):
            size += abs(slope) * t + s * abs(rate)
        close([module.supply(x, u, p).sum()], [(growth, size)], 0, "dU/dt = y^T u")


def moved(x, direction):
    """Return the states a little ahead of x and behind it, with 40 digits."""
    with mp.workdps(DIGITS):
        return [
            [mp.mpf(float(v)) + step * mp.mpf(float(d)) for v, d in zip(x, direction, strict=True)]
            for step in (STEP, -STEP)
        ]


def check_jacobian(module, at, rows, x, u):
    """Check the Jacobian in one direction, by differences with 40 digits."""
    p = module.Parameters()
    jacobian = module.jacobian(x, u, p)
    assert jacobian.shape == (len(x), len(x))
    direction = np.cos(np.arange(len(x)) + 1.0)
    ahead, behind = moved(x, direction)
    with mp.workdps(DIGITS):
        pairs = zip(at(ahead, rows), at(behind, rows), strict=True)
        wanted = [((a - b) / (2 * STEP), s + t) for (a, s), (b, t) in pairs]
        sizes = abs(jacobian) @ abs(direction)
        for n, (a, (b, s)) in enumerate(zip(jacobian @ direction, wanted, strict=True)):
            assert abs(a - b) <= 1e-11 * (s + sizes[n]), ("jacobian", n, a, mp.nstr(b, 17))


def explicit(matrix, sizes):
    return list(matrix.explicit(sizes) if hasattr(matrix, "explicit") else matrix)


def values_of(module):
    """Return the module's parameters by name, those listed by lane."""
    values = vars(module.Parameters())
    listed = {
        f"{name}_{n + 1}": v
        for name, value in values.items()
        if isinstance(value, tuple)
        for n, v in enumerate(value)
    }
    return listed | {name: v for name, v in values.items() if not isinstance(v, tuple)}


def check_against_tableau(module, spec, x, u):
    """Check rates, outputs and productions against the numeric solution from the spec alone."""
    p = module.Parameters()
    states = dict(zip(spread(module.STATES, p), x, strict=True))
    wanted = Tableau(spec, states, dict(zip(spec["inputs"], u, strict=True))).answer()
    found = {
        "rates": (module.rhs(x, u, p), module.STATES),
        "outputs": (module.outputs(x, u, p), module.OUTPUTS),
        "productions": (module.entropy_production(x, u, p), module.PROCESSES),
    }
    for what, (numbers, records) in found.items():
        reference = getattr(wanted, what)
        names = spread(records, p)
        assert set(names) == set(reference), what
        given = np.array([reference[name] for name in names])
        size = 1e-9 * wanted.size ** (1 if what == "outputs" else 2)
        assert np.allclose(numbers, given, rtol=1e-8, atol=size), (what, names, numbers, given)


def spread(records, p):
    """Return the names of rows; of a bank, one per lane."""
    lanes = {r.bank: getattr(p, f"{r.bank}_count") for r in records if r.bank}
    return list(
        itertools.chain.from_iterable(
            [f"{r.name}_{n + 1}" for n in range(lanes[r.bank])] if r.bank else [r.name]
            for r in records
        )
    )


def check_entropy(module, spec, x, u):
    """Check that entropy grows by what is produced and by what environments and heaters bring."""
    p = module.Parameters()
    names, given = spread(module.STATES, p), dict(zip(spec["inputs"], u, strict=True))
    bodies = [s for n, e in spec["elements"].items() if (s := entropy_of(n, e))]
    rates = dict(zip(names, module.rhs(x, u, p), strict=True))
    hot = dict(zip((r.name for r in module.BODIES), module.temperatures(x, p), strict=True))
    produced = module.entropy_production(x, u, p)
    seen = Tableau(spec, dict(zip(names, x, strict=True)), given).seen()
    airs = [
        (e["conductance"], hot[e["body"]], given[e["input"]])
        for e in spec["elements"].values()
        if e["kind"] == "ambient"
    ]
    brought = [value(law, {**seen, "T": T, "T_e": T_e}) * (T_e / T - 1) for law, T, T_e in airs]
    heaters = [e for e in spec["elements"].values() if e["kind"] == "heat_source"]
    brought += [given[e["input"]] / hot[e["into"]] for e in heaters]
    terms = [*produced, *brought]
    growth = sum(rates[s] for s in bodies)
    size = sum(map(abs, terms)) + sum(abs(rates[s]) for s in bodies)
    assert abs(growth - sum(terms)) <= 1e-12 * max(size, 1e-6)


def check_batch(module, points):
    """Check that states side by side give what single states give."""
    p = module.Parameters()
    x, u = (np.stack(parts, axis=1) for parts in zip(*points, strict=True))
    for name in ("rhs", "outputs", "supply", "entropy_production", "elements", "jacobian"):
        function = getattr(module, name)
        together = function(x, u, p)
        for n, (one, given) in enumerate(points):
            single = function(one, given, p)
            assert together.shape == (*single.shape, len(points)), name
            size = abs(single).max(initial=1e-30)
            assert np.allclose(together[..., n], single, rtol=1e-12, atol=1e-13 * size), name
