"""Every notebook runs, without a warning, and shows what is committed.

One test a notebook, in a process of its own: a notebook's kernel is none of the test's.
"""

import ast
import json
import re
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "notebooks"
EXECUTE = FOLDER / "execute.py"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
#: Not executed in the fast tier: what they show has tests of its own: derivations, the paper's
#: claims, banks beside NumPy, speeds, sweeps beside single runs, devices beside closed forms.
LONG = {
    "01-framework",
    "03-proofs",
    "04-figures",
    "05-many-hysterons",
    "06-paper-and-software",
    "07-sweeps",
    "08-speed",
    "09-devices",
    "10-hysteresis",
}


def execute(*words, script=EXECUTE):
    """Run the script; return its exit code and what it says."""
    command = [sys.executable, script, *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def executed():
    for path in NOTEBOOKS:
        marks = [pytest.mark.long] if path.stem in LONG else []
        yield pytest.param(path, id=path.stem, marks=marks)


@pytest.mark.parametrize("path", [*executed()])
def test_a_notebook_shows_what_it_shows_when_executed(path):
    code, said = execute("--check", path.stem)
    assert code == 0, said


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_what_a_notebook_imports_is_there(path):
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            lines = [line for line in cell["source"] if not line.startswith("%")]
            tree = ast.parse("".join(lines))
            tree.body = [n for n in tree.body if isinstance(n, ast.Import | ast.ImportFrom)]
            exec(compile(tree, path.name, "exec"), {})


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_committed_in_normal_form(path):
    text = path.read_text(encoding="utf-8")
    data = json.loads(text)
    nbformat.validate(nbformat.reads(text, as_version=4))
    assert text == json.dumps(data, indent=1, ensure_ascii=False, sort_keys=True) + "\n"
    assert [cell["id"] for cell in data["cells"]] == [
        f"cell-{n:02}" for n, _ in enumerate(data["cells"], start=1)
    ]
    assert all(cell["metadata"] == {} for cell in data["cells"])
    assert set(data["metadata"]) == {"kernelspec", "language_info"}


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_has_outputs_and_no_path_or_time_of_a_machine(path):
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert code
    assert any(cell["outputs"] for cell in code)
    for cell in code:
        assert cell["execution_count"] is None
        for output in cell["outputs"]:
            data = output.get("data", {"text/plain": output.get("text", [])})
            text = json.dumps({kind: v for kind, v in data.items() if kind != "image/png"})
            assert not re.search(r"/(home|root|tmp|work|Users|usr)/|0x[0-9a-f]{8}", text)


def test_there_is_a_notebook_to_look_at():
    assert NOTEBOOKS


@pytest.fixture
def folder(tmp_path):
    """Return a folder with the script and room for notebooks."""
    (tmp_path / EXECUTE.name).write_bytes(EXECUTE.read_bytes())
    return tmp_path


def succeed(folder, *words):
    """Run the planted script, which has to succeed."""
    code, said = execute(*words, script=folder / EXECUTE.name)
    assert code == 0, said


def plant(folder, *sources):
    cells = [nbformat.v4.new_code_cell(source) for source in sources]
    path = folder / "01-planted.ipynb"
    nbformat.write(nbformat.v4.new_notebook(cells=cells), path)
    return path


@pytest.mark.long
def test_a_notebook_is_written_the_same_twice_and_a_changed_output_is_seen(folder):
    picture = "import matplotlib.pyplot as plt\nplt.plot([1, 2]);"
    path = plant(folder, "print('one')\nprint('tw' + 'o')", "1 + 1", picture)
    succeed(folder)
    text = path.read_text(encoding="utf-8")
    succeed(folder)
    assert path.read_text(encoding="utf-8") == text
    printed, result, shown = (cell["outputs"][0] for cell in json.loads(text)["cells"])
    assert printed["text"] == ["one\n", "two\n"]
    assert result["data"] == {"text/plain": ["2"]}
    assert "image/png" in shown["data"]
    changed = text.replace('"two', '"three').replace('"image/png', '"image/x')
    path.write_text(changed, encoding="utf-8")
    code, said = execute("--check", "01", script=folder / EXECUTE.name)
    assert code == 1
    assert '-      "three' in said
    assert "image/x" in said
    assert "python notebooks/execute.py 01-planted" in said
    assert path.read_text(encoding="utf-8") == changed  # a check writes nothing


@pytest.mark.some(1)
@pytest.mark.parametrize(
    "source",
    ["import warnings\nwarnings.warn('too old')", "import sys\nsys.stderr.write('odd')", "1/0"],
    ids=["warning", "error stream", "error"],
)
def test_a_cell_that_fails_or_warns_is_an_error(folder, source):
    path = plant(folder, source)
    before = path.read_bytes()
    code, said = execute(script=folder / EXECUTE.name)
    assert code == 1
    assert "Error" in said
    assert path.read_bytes() == before


def test_an_unknown_name_says_which_there_are(folder):
    plant(folder, "1")
    code, said = execute("02", script=folder / EXECUTE.name)
    assert (code, said.strip()) == (1, "no notebook is called '02'; notebooks: 01-planted")
