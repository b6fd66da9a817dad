"""A collocation step in C, for every width of ``real``: one number, or a vector of one per run.

Input: a `Program` and its `Collocation`.  Output: the text of ``<model>_step.c``: the integrands of
means, a stage, the slopes, the tables for the elimination, and the record of the parameters with
the functions that copy those of a run into a lane of vectors; `run/engine` drives them.  Branches
are given as numbers: without comparisons, the text holds for vectors too.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.c.frame import FunctionFrame, ends
from piezo_sym.codegen.c.head import comment, opening
from piezo_sym.codegen.c.lines import Words, Write, indented, least_over_lanes, used_only
from piezo_sym.codegen.c.step_parameters import give_text, place_text, record_text
from piezo_sym.codegen.c.style import c_names, calls, fresh_names, powers
from piezo_sym.codegen.collocation import Collocation
from piezo_sym.codegen.coupling import coupling_of, table
from piezo_sym.codegen.layout import places
from piezo_sym.codegen.program import Described, OutputRow, Program, banks_of
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import names

NOTE = """\
/*
 * One step of energy-preserving Gauss collocation. The row `program` of the proofs covers the
 * functions `integrands` and `stage`{costates}; the others and the tables serve Newton's method.
 */"""

#: Encloses the functions of laws: run/engine compiles them apart, so that an edit leaves the rest.
LAWS = "#if !defined(LAWS_APART) /* the functions of laws, which run/engine compiles apart */"
END_OF_LAWS = "#endif /* of the functions of laws */"
#: Encloses a function that is printed for run/engine alone; then what tells run/engine of it.
ENGINE = "#if !defined(ALONE) /* the step alone solves its equations to round-off */"
END_OF_ENGINE = "#endif /* of what run/engine takes */"
COSTATES = "#if !defined(ALONE) /* there are co-states for run/engine */\n#define COSTATES"
END_OF_COSTATES = "#endif /* of what tells of co-states */"

#: The definitions of `real` as one number, if the including file has not defined it.
REAL = """\
#if !defined(REAL_WIDTH) /* numbers of one run; run/engine has vectors of many */
#define REAL_WIDTH 1
#define ALONE
#if !defined(REAL)
#define REAL double /* or float */
#endif
typedef REAL real;
#define zero 0.0
#define wide(value) (value)
#define chosen(condition, then, other) ((condition) ? (then) : (other))
{functions}#define is_above(a, b) ((a) > (b))
#define is_at_least(a, b) ((a) >= (b))
#define least(a, b) ((a) < (b) || (a) != (a) ? (a) : (b))
#define OF(value, lane) (value)
#endif"""
_LIBRARY = tuple(record.in_c for record in RECORDS.values() if record.smooth)


def c_step(program: Program, step: Collocation) -> str:
    """Return the text of a model's collocation step."""
    printer = _Printer(program, step)
    laws = [
        printer.integrands(),
        *printer.bends(),
        printer.stage(),
        *printer.costates(),
        printer.slopes(),
        *printer.paths(),
    ]
    rest = [
        printer.sizes(),
        place_text(program, printer.names),
        give_text(program, printer.names),
        printer.tables(),
    ]
    text = "\n\n".join(laws)
    note = NOTE.replace("{costates}", ", and `costates`" if step.takes_residuals else "")
    head = f'{opening(program)}\n{note}\n#include "{program.name}.h"\n\n#include <math.h>'
    record = record_text(program, printer.names)
    called = calls(text)
    defined = (f"#define {n}_of {n}\n" for n in _LIBRARY if f"{n}_of" in called)
    real = REAL.replace("{functions}", "".join(defined))
    laws = [LAWS, *powers(text, "real"), text, END_OF_LAWS]
    return "\n\n".join([head, real, record, *laws, *rest]) + "\n"


@final
class _Printer:
    """Prints the functions of one model's step."""

    def __init__(self, program: Program, step: Collocation) -> None:
        self.program, self.step, self.name = program, step, program.name
        stage, slopes = step.stage, step.slopes
        self.means = [Described(mean.name, "", "", mean.bank) for mean in step.means]
        self.given = [*self.means, *(field for path in step.paths for field in path.given())]
        self.branches = [Described(s.branch, "", "", s.bank) for s in stage.switches]
        both = {q.name: q for q in (*stage.quantities, *slopes.quantities)}
        extended = replace(
            program,
            states=(*program.states, *self.given, *self.branches),
            quantities=tuple(both.values()),
            taken=stage.taken | slopes.taken,
        )
        self.names = c_names(extended)
        words = ("x", "g", "b", "u", "p", "out", "rows", "s", "m", "j")
        self.words = fresh_names(words, extended, self.names)
        self.banks = banks_of((*program.parameters, *extended.states))
        arrays = {"x": program.states, "g": self.given, "b": self.branches, "u": program.inputs}
        lines = Words(self.names, self.banks, self.words["j"], "real")
        self.frame = FunctionFrame(program, arrays, self.words, lines, extended.taken)
        self.coupling = coupling_of(program, slopes)

    def integrands(self) -> str:
        """Return the function of the integrands, whose means are given to a stage."""
        rows = [OutputRow(Slot(mean.name, mean.bank), mean.value) for mean in self.step.means]
        doc = "Functions of the state whose weighted means over a step are the means g of a stage"
        return self._of_state("integrands", doc, rows)

    def bends(self) -> Iterator[str]:
        """Yield the function whose zeros are the kinks of integrands, if there are kinks."""
        if self.step.stage.bends:
            doc = "Functions of the state that change their sign where integrands have kinks"
            yield self._of_state("bends", doc, self.step.stage.bends)

    def paths(self) -> Iterator[str]:
        """Yield the functions of parameters and drives of path functionals, if there are any."""
        paths = self.step.paths
        if not paths:
            return
        values = [(path, value) for path in paths for value in (path.stiffness, path.limit)]
        rows = [OutputRow(Slot(path.inner, path.bank), value) for path, value in values]
        doc = "Stiffness and limit of each path functional"
        yield self._of_state("path_parameters", doc, rows)
        drives = [OutputRow(Slot(p.slip, p.bank if p.own else None), p.drive) for p in paths]
        writes, local = self.frame.writes("out", drives)
        body = self.frame.computed(self.step.stage.quantities, writes)
        doc = "Drives of path functionals: the rates of their coordinates"
        words = ("x", "g", "b", "u", "p", "out")
        yield self.frame.function("drives", words, doc, body, local)

    def _of_state(self, name: str, doc: str, rows: Sequence[OutputRow]) -> str:
        writes, local = self.frame.writes("out", rows)
        body = self.frame.computed((), writes)
        return self.frame.function(name, ("x", "p", "out"), doc, body, local)

    def stage(self) -> str:
        """Return the function of a stage: rates, rows of the ledger, switching functions."""
        stage = self.step.stage
        switches = [OutputRow(Slot(s.branch, s.bank), s.value) for s in stage.switches]
        rows = {"s": switches, "out": stage.rates, "rows": stage.booked}
        results = [self.frame.writes(word, values) for word, values in rows.items()]
        lanes = banks_of(stage.quantities) | self.banks
        margins = least_over_lanes(self.words["m"], stage.limits, lanes)
        writes = [*(write for group, _ in results for write in group), *margins]
        doc = (
            "A stage, for the state x, means g, branches b of laws, and inputs u. Writes the rates "
            "of the state to out; to rows, for the ledger, the power of ports, heat and entropy "
            "production of processes, and entropy rate of heat exchanges; to s the switching "
            "functions, whose signs decide the branches; to m the margins of those conditions of "
            "the domain that depend on the state"
        )
        return self.frame.writing(
            "stage",
            ["x", "g", "b", "u", "p", "out", "rows", "s", "m"],
            doc,
            stage.quantities,
            writes,
            local=[end for _, group in results for end in group],
        )

    def costates(self) -> Iterator[str]:
        """Yield the function of the co-states, if the engine asks for them."""
        if not self.step.takes_residuals:
            return
        stage = self.step.stage
        writes, local = self.frame.writes("out", stage.costates)
        doc = "Co-states dU/dx of a stage, of all states; then the rows of entropies"
        words = ["x", "g", "p", "out"]
        text = self.frame.writing("costates", words, doc, stage.quantities, writes, local=local)
        yield f"{ENGINE}\n{text}\n{END_OF_ENGINE}"

    def slopes(self) -> str:
        """Return the Jacobian of the rates, in the places of `coupling`."""
        out, lanes, values = self.words["out"], dict[str, int](), self.coupling.entries.values()
        writes = [Write(f"{out}[{n}]", value) for n, value in enumerate(values)]
        for bank in self.coupling.banks:
            for n, value in enumerate(bank.slopes):
                target = self._at({**lanes, bank.name: n}, self.words["j"])
                writes.append(Write(f"{out}[{target}]", value, bank.name))
            lanes[bank.name] = len(bank.slopes)
        computed = {quantity.name for quantity in self.step.slopes.quantities}
        means = {field.name for field in self.given} & computed
        banks = {name: bank for name, bank in self.banks.items() if name not in means}
        lines, known = replace(self.frame.lines, arrays=banks), {self.names[name] for name in means}
        doc = "Derivative of the rates by the state, on branches b; the tables tell its entries"
        words = ["x", "g", "b", "u", "p", "out"]
        frame = replace(self.frame, lines=lines, known=known)
        return frame.writing("slopes", words, doc, self.step.slopes.quantities, writes)

    def sizes(self) -> str:
        """Return the function of the sizes of arrays, numbers of lanes and first rows."""
        stage, out, program = self.step.stage, self.words["out"], self.program
        counted = {
            "states": [field.slot for field in program.states],
            "means": [field.slot for field in self.means],
            "branches": [field.slot for field in self.branches],
            "booked": [row.slot for row in stage.booked],
            "processes": [field.slot for field in program.processes],
            "bends": [row.slot for row in stage.bends],
        }
        at = {what: places(slots, f"end_{what}", stage.taken) for what, slots in counted.items()}
        *numbers, bends = ((each.size, what) for what, each in at.items())
        numbers += [(self._at({b.name: len(b.slopes) for b in self.coupling.banks}), "slopes")]
        numbers += [(f"{bank}_count", "lanes") for bank in program.counts]
        numbers += [(place, "first row") for place in at["states"].positions[:-1]]
        numbers += [bends] if stage.bends else []
        body = [f"{out}[{n}] = {size}; /* {what} */" for n, (size, what) in enumerate(numbers)]
        local = [end for each in at.values() for end in ends(each)]
        doc = "How many numbers there are of each kind; lanes of each bank; first row of each state"
        p = self.words["p"]
        kept = used_only(body, [*self.frame.sizes(), *local], [p])
        head = f"static void {self.name}_sizes(const {self.name}_reals *{p}, long *{out})"
        return "\n".join([*comment(doc), head, "{", *indented([*kept, *body]), "}"])

    def tables(self) -> str:
        """Return the tables by which the equations of a step are solved."""
        limits = [int(limit.strict) for limit in self.step.stage.limits]
        head = ["/* Integrands have kinks: see run/engine. */", "#define BENDS"]
        head = [*self._path_table(), *(head if self.step.stage.bends else []), *self._bodies()]
        head += ["enum {", f"    {self.name}_limits = {len(limits)}, /* margins of a stage */"]
        records = len(self.program.states)
        used = {name for mean in self.step.means for name in names(mean.value)}
        read = [n for n, state in enumerate(self.program.states) if state.name in used]
        head += [f"    {self.name}_reads = {len(read)}, /* states that integrands read */"]
        head += [f"    {self.name}_records = {records}, /* states, a bank's counted once */"]
        taker = f"{self.name}_heated = {self.step.heated}"
        head += [f"    {taker}, /* the state that takes a dissipative step's loss */"]
        head += [f"    {self.name}_jumps = {int(self.step.jumps)} /* whether a law jumps */", "};"]
        head += [*table(f"{self.name}_strict", limits), *table(f"{self.name}_read", read)]
        return "\n".join([*head, *self.coupling.tables(self.name)])

    def _path_table(self) -> Iterator[str]:
        """Yield the table of path functionals, if there are any."""
        paths, states = self.step.paths, [state.name for state in self.program.states]
        if paths:
            banks = [None, *self.program.counts]
            doc = (
                "Path functionals: bank or -1, drives of lanes, inner state, if drives depend on it"
            )
            yield from comment(doc)
            yield f"#define PATHS {len(paths)}\nstatic const int {self.name}_path[PATHS][4] = {{"
            for p in paths:
                row = banks.index(p.bank) - 1, int(p.own), states.index(p.inner), int(p.seen)
                yield f"    {{{', '.join(map(str, row))}}},"
            yield "};"

    def _bodies(self) -> Iterator[str]:
        """Yield which states are entropies of bodies, if the engine asks for co-states."""
        if self.step.takes_residuals:
            yield COSTATES
            yield f"enum {{ {self.name}_bodies = {len(self.step.bodies)} }};"
            yield from table(f"{self.name}_body", self.step.bodies)
            yield END_OF_COSTATES

    def _at(self, lanes: Mapping[str, int], lane: str = "") -> str:
        """Return the place after the shared slopes and some rows of lanes."""
        shared = len(self.coupling.entries)
        terms = [str(shared)] if shared or not lanes else []
        terms += [
            f"{n}*{name}_count" if n > 1 else f"{name}_count" for name, n in lanes.items() if n
        ]
        return " + ".join([*terms, *filter(None, [lane])]) or "0"
