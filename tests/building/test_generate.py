"""Generated files: written in one step, the same on every machine, and for every bank size."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from piezo_sym import Model, PiezoError, derive, generate, load
from piezo_sym.build import render
from piezo_sym.codegen import PRINTERS, template_of
from piezo_sym.errors import FileError, ProofError, UsageError
from tests.conftest import full_disk

ROOT = Path(__file__).parents[2]
COMMITTED = ROOT / "generated" / "piezo_stack" / "piezo_stack.py"
FILES = [*sorted(f"piezo_stack{ending}" for ending in PRINTERS), "proofs.json", "proofs.smt2"]


def text_of(model):
    text, *_ = render(model).values()
    return text


def with_count(spec, count):
    spec["elements"]["hysteron"]["count"] = count
    return text_of(Model(**spec)).splitlines()


def test_generate_writes_what_render_gives(model, tmp_path):
    path, *_ = generate(model, tmp_path)
    assert path == tmp_path / "piezo_stack" / "piezo_stack.py"
    assert path.read_text(encoding="utf-8") == text_of(model)


def test_generate_leaves_nothing_else(model, tmp_path):
    generate(model, tmp_path)
    generate(model, str(tmp_path))
    assert sorted(p.name for p in tmp_path.rglob("*") if p.is_file()) == FILES


@pytest.mark.parametrize("made", [str, derive])
def test_what_is_no_model_is_refused(model, made, tmp_path):
    with pytest.raises(UsageError, match=r"^generate: .* is no Model; load it first: generate\(lo"):
        generate(made(model), tmp_path)


def test_a_file_that_cannot_be_replaced_is_named(model, tmp_path):
    path, *_ = generate(model, tmp_path)
    path.unlink()
    path.mkdir()
    with pytest.raises(FileError, match=r"piezo_stack.py': cannot be written \(Is a directory\)"):
        generate(model, tmp_path)
    assert sorted(p.name for p in path.parent.iterdir()) == FILES


@pytest.mark.long
def test_a_full_disk_leaves_the_old_file(model, tmp_path):
    path, *_ = generate(model, tmp_path)
    path.write_text("old")
    with full_disk(), pytest.raises(FileError, match=r"cannot be written \(File too large\)"):
        generate(model, tmp_path)
    assert path.read_text() == "old"
    assert sorted(p.name for p in path.parent.iterdir()) == FILES


def test_a_folder_that_cannot_be_made_is_named(model, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match=r"file/piezo_stack/piezo_stack.py': cannot be written"):
        generate(model, tmp_path / "file")


@pytest.mark.parametrize(("spec", "p"), [("piezo_stack", "p_"), ("dc_motor", "p")])
def test_the_head_of_every_file_explains_what_it_uses(spec, p):
    """The equations, what proofs cover, and what functions call the parameters."""
    texts = [text for path, text in render(load(spec)).items() if "proofs" not in path]
    assert "heat exchange with ambients not" in texts[0]
    for text in texts:
        head = text[:2000]
        assert "dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k" in head
        assert "rows of `piezo-sym verify`; what is PROVED holds for all states" in head
        assert re.search(rf"^[^\w\n]*{p} = \w", head, re.M)  # each file in its language's words
        assert ("tells it from p" in head) == (p == "p_")


def test_what_is_not_proved_is_not_written(unproved, tmp_path):
    with pytest.raises(
        ProofError, match=r"passive is REFUTED: .* at d = -1, v = 1; the condition"
    ) as caught:
        generate(unproved, tmp_path)
    assert caught.value.exit_code == 1
    assert list(tmp_path.iterdir()) == []


def test_what_is_written_all_the_same_says_so(unproved, tmp_path):
    path, *_ = generate(unproved, tmp_path, allow_unproved=True)
    assert (
        "Proofs:  NOT PROVED (passive REFUTED, sigma OPEN, exergy OPEN, environment OPEN)"
        in path.read_text().splitlines()
    )


@pytest.mark.some(1)
@pytest.mark.parametrize("seed", ["0", "1"])
def test_the_text_is_the_same_for_every_hash_seed(seed, model):
    """But for the line on its proofs, which is made of the report alone."""
    wanted = template_of(derive(model)).filled(model.model_dump())[".py"]
    code = """
from piezo_sym.codegen import template_of
from piezo_sym import derive, load
model = load("piezo_stack")
print(template_of(derive(model)).filled(model.model_dump())[".py"], end="")
"""
    environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)}
    words = [sys.executable, "-c", code]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout == wanted
    committed = COMMITTED.read_text(encoding="utf-8").splitlines()
    pairs = [pair for pair in zip(wanted.splitlines(), committed, strict=True) if len({*pair}) > 1]
    assert [(one[:7], other[:7]) for one, other in pairs] == [("Proofs:", "Proofs:")]


@pytest.mark.parametrize("count", [3, pytest.param(20_000, marks=pytest.mark.long)])
def test_the_size_of_a_bank_is_its_default_and_the_hash(spec, count):
    pairs = zip(with_count(spec, 2), with_count(spec, count), strict=True)
    first, second, default = [pair for pair in pairs if pair[0] != pair[1]]
    sha256 = Model(**spec).sha256
    assert first[1].endswith(f" sha256 {sha256}")
    assert second[1] == f'SPEC_SHA256 = "{sha256}"'
    assert default == ("    hysteron_count: int = 2", f"    hysteron_count: int = {count}")


def test_the_head_has_no_date_path_or_host(model):
    import datetime
    import platform

    text = text_of(model)
    year = str(datetime.datetime.now(tz=datetime.UTC).year)
    for word in (year, str(ROOT), str(Path.home()), platform.node()):
        assert word not in text


NAMES = ["../up", "a/b", "..", "", ".", "a b", 'a"b', "a\nb", "a\\b", "é", "con", "_x", "x" * 99]


@pytest.mark.parametrize("name", NAMES)
def test_a_name_that_leads_elsewhere_is_refused(spec, name):
    spec["model"]["name"] = name
    with pytest.raises(PiezoError, match=r"model\.name"):
        Model(**spec)
