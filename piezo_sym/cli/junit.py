"""Verdicts as JUnit XML, which continuous integration shows.

Input: reports, and the verdicts of the second program.  Output: the text of the file: for each
model a suite with one case per property, and another for the second program.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from piezo_sym.version import VERSION

if TYPE_CHECKING:
    from piezo_sym.errors import PiezoError
    from piezo_sym.report import Report, Row
    from piezo_sym.verification.recheck import Recheck


def junit_xml(
    reports: Iterable[tuple[Report, Recheck | None]], errors: Iterable[PiezoError] = ()
) -> str:
    """Return JUnit XML: REFUTED is a failure, OPEN an error, unless it is only information.

    A row that the second program does not confirm is a failure in the suite ``<model>, rechecked``.
    A spec that could not be read is a suite of its own, with one error.
    """
    root = ET.Element("testsuites", name=f"piezo-sym {VERSION}")
    for report, second in reports:
        failed = [row.verdict.value for row in report.failures]
        counts = len(report.rows), failed.count("REFUTED"), failed.count("OPEN")
        suite = _suite(root, report.model, *counts)
        for row in report.rows:
            _case(suite, report, row)
        if second is not None:
            _rechecked(root, report, second)
    for error in errors:
        suite = _suite(root, error.where or "spec", 1, 0, 1)
        case = ET.SubElement(suite, "testcase", classname=error.where or "spec", name="load")
        ET.SubElement(case, "error", message=str(error), type=type(error).__name__)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _suite(root: ET.Element, name: str, tests: int, failures: int, errors: int) -> ET.Element:
    counts = {"tests": str(tests), "failures": str(failures), "errors": str(errors)}
    return ET.SubElement(root, "testsuite", {"name": name, **counts})


def _rechecked(root: ET.Element, report: Report, second: Recheck) -> None:
    faults = len(second.faults(report.information))
    tests, name = len(second.rows) + bool(second.failed), f"{report.model}, rechecked"
    suite = _suite(root, name, tests, faults, 0)
    for key, word in second.rows.items():
        case = ET.SubElement(suite, "testcase", classname=name, name=" ".join(filter(None, key)))
        if word == "confirmed":
            continue
        kind = "skipped" if word == "stated" or key in report.information else "failure"
        ET.SubElement(case, kind, message=word)
    if second.failed:
        case = ET.SubElement(suite, "testcase", classname=name, name="checker")
        ET.SubElement(case, "failure", message=second.failed)


def _case(suite: ET.Element, report: Report, row: Row) -> None:
    name = f"{row.id} {row.element}".strip()
    case = ET.SubElement(suite, "testcase", classname=report.model, name=name)
    if row.verdict.value == "PROVED":
        return
    if not row.required:
        ET.SubElement(case, "skipped", message=f"information: {row.verdict.value}: {row.reason}")
        return
    kind = "failure" if row.verdict.value == "REFUTED" else "error"
    at = ", ".join(f"{name} = {value}" for name, value in (row.witness or {}).items())
    fault = ET.SubElement(case, kind, message=row.reason, type=row.verdict.value)
    fault.text = f"{row.statement}\n{row.reason}" + (f"\nat {at}" if at else "")
