"""Verdicts as JUnit XML, which continuous integration shows.

Input: reports.  Output: the text of the file: a suite a model, a case a property.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from piezo_sym.version import VERSION

if TYPE_CHECKING:
    from piezo_sym.errors import PiezoError
    from piezo_sym.proofs.report import Report, Row


def junit_xml(reports: Iterable[Report], errors: Iterable[PiezoError] = ()) -> str:
    """Return JUnit XML: REFUTED is a failure, OPEN an error, unless it is only information.

    A spec that could not be read is a suite of its own, with one error.
    """
    root = ET.Element("testsuites", name=f"piezo-sym {VERSION}")
    for report in reports:
        failed = [row.verdict.value for row in report.failures]
        suite = ET.SubElement(
            root,
            "testsuite",
            name=report.model,
            tests=str(len(report.rows)),
            failures=str(failed.count("REFUTED")),
            errors=str(failed.count("OPEN")),
        )
        for row in report.rows:
            _case(suite, report, row)
    for error in errors:
        suite = ET.SubElement(
            root, "testsuite", name=error.where or "spec", tests="1", failures="0", errors="1"
        )
        case = ET.SubElement(suite, "testcase", classname=error.where or "spec", name="load")
        ET.SubElement(case, "error", message=str(error), type=type(error).__name__)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


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
