"""A program: read hostile texts while the interpreter reports what it is made to do.

Arguments: a seed, how many laws, how many specs.  Output: JSON, the faults found and the slowest.
"""

import json
import sys
import time

from fuzz_texts import law_texts, spec_texts

from piezo_sym import Model, PiezoError, derive
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import Expr
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.load import parse

SLOW = 5.0  # twenty times what the slowest takes on a quiet machine
EVERY = 40  # an accepted spec in so many is derived
FORBIDDEN = ("os.", "subprocess.", "exec", "import", "socket.", "ctypes.", "shutil.", "code.")
#: What happened while it was watched.
events: list[str] = []
watching = False


def watch(event: str, args: tuple[object, ...]) -> None:
    """Note what no text may make the interpreter do; reading source is what parsing does."""
    if not watching:
        return
    writes = event == "open" and (args[1] is None or set(str(args[1])) & set("wax+"))
    if writes or event.startswith(FORBIDDEN):
        events.append(f"{event} {str(args)[:80]}")


def fault(read, text, kind) -> str:
    """Return what is wrong with the answer to a text, or nothing."""
    global watching
    watching = True
    try:
        found = read(text)
    except PiezoError as error:
        message = str(error)
        good = message.isprintable() and len(message) < 800
        good = good and error.exit_code == 2 and bool(error.where)
        return "" if good else f"message {message[:200]!r}"
    except BaseException as error:  # anything else is what is looked for
        return f"{type(error).__name__}: {str(error)[:200]}"
    finally:
        watching = False
    return "" if isinstance(found, kind) else f"gave {type(found).__name__}"


def later(text: str) -> str:
    """Return what is wrong with the derivation of a spec, or nothing, if it is accepted."""
    try:
        derive(parse(text))
    except PiezoError:
        return ""
    except BaseException as error:
        return f"derive: {type(error).__name__}: {str(error)[:200]}"
    return ""


def main() -> None:
    """Read the texts, and print what was found."""
    seed, laws, specs = map(int, sys.argv[1:])
    for text in spec_texts(seed + 1, 30):  # whatever is imported when first needed is, now
        fault(parse, text, Model)
    parse_unit("inch")  # not in the tables of units: pint knows it
    events.clear()
    sys.addaudithook(watch)
    faults, slowest = [], (0.0, "")
    cases = [(lambda t: parse_law(t, "law"), t, Expr) for t in law_texts(seed, laws)]
    cases += [(parse, text, Model) for text in spec_texts(seed, specs)]
    for read, text, kind in cases:
        start = time.process_time()
        wrong = fault(read, text, kind)
        took = time.process_time() - start
        if kind is Model and len(text) % EVERY == 0:
            wrong = wrong or later(text)
            took = max(took, (time.process_time() - start - took) / 5)
        slowest = max(slowest, (took, text))
        if wrong or events or took > SLOW:
            faults.append([wrong or str(events) or f"took {took:.2f} s", text])
            events.clear()
    sys.stdout.write(json.dumps({"count": len(cases), "faults": faults, "slowest": slowest}))


if __name__ == "__main__":
    main()
