"""What to write where a spec's text is no TOML, but that of another habit.

Input: the text, and the fault that the TOML parser found, with its line and column.  Output: the
remedy, or nothing.
"""

import re

#: How many characters before and behind the fault are looked at.
NEAR = 150
#: Patterns of a line in which ! marks the fault, and what to write there; the first one counts.
HINTS = tuple(
    (re.compile(pattern), hint)
    for pattern, hint in (
        (r"= *([+-]?\d+)!?,!?(\d+)", r"write \1.\2, with a point"),
        (r"!(%|//)", "a comment begins with #"),
        (r"!(True|False)\b", "write true or false"),
        (r"!['\"]?.*[\u201c\u201d\u201e\u2018\u2019]", 'write straight quotes, as in unit = "N/m"'),
        (r"[\w.-]*![^\x00-\x7f]", "write a name in Latin letters, as alpha"),
        (r"!([+-]?)\.(\d+)", r"write \g<1>0.\2, with a digit before the point"),
        (r"(\d)!\.(?!\d)", r"write a digit behind the point, as in \1.0"),
        (r"[=,{ ]!(\w+)\s*=", r"separate entries by commas: one is missing before '\1'"),
        (r"(\d[\d.eE+-]*) !([A-Za-z][\w/*()-]*)", r'write { value = \1, unit = "\2" }'),
        (r"\d *!([*/^]|\*\*)", "write a value as one number, and a law as a text in quotes"),
        (r"[=\[,] *!([A-Za-z][^,;}\]#\"']*?) *(?![^,;}\]#\"'])", r'write texts in quotes: "\1"'),
        (r"!;", "separate entries by commas"),
        (r"!:", "write = between a key and its value"),
        (r"\w *!\{", "write = between a key and its value"),
        (r"=!=", "write one ="),
        (r"= *\"[^\"]*\"!,", 'write several values as a list: ["a", "b"]'),
        (r", *!\}", "take out the last comma"),
        (r"^\[[^\]]*!", "close the name of a table with ], without blanks: [elements.spring]"),
        (r"\{[^}]*!$", "close the braces on the same line: }"),
        (r"['\"][^'\"]*!$", "close the quotes on the same line"),
    )
)


def remedy_at(text: str, fault: str) -> str:
    """Return what to write at the place that a fault of the TOML parser names, or ''."""
    place = re.search(r"at line (\d+), column (\d+)", fault)
    lines = text.split("\n")
    number, column = (int(place[1]), int(place[2])) if place else (len(lines), len(lines[-1]) + 1)
    line = lines[min(number, len(lines)) - 1]
    first = max(0, column - 1 - NEAR)  # of a hostile text, a line may be all of it
    marked = f"{line[first : column - 1]}!{line[column - 1 : column - 1 + NEAR]}".rstrip()
    found = ((pattern.search(marked), hint) for pattern, hint in HINTS)
    return next((match.expand(hint).strip() for match, hint in found if match), "")
