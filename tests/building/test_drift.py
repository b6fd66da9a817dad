"""``generate --check``: what is committed is what the specs give, and every other file is named."""

import os
from functools import cache
from pathlib import Path

import pytest

from piezo_sym import Model, build, generate
from piezo_sym.build import DIFFERS, ENDS, LEFT, LINK, drift, raise_if_drifted, shipped_models
from piezo_sym.errors import DriftError

ROOT = Path(__file__).parents[2]


#: Each model is rendered once: these tests are of what is done with the texts.
rendered = cache(build.render)


@pytest.fixture(autouse=True)
def _rendered_once(monkeypatch):
    monkeypatch.setattr(build, "render", rendered)


@pytest.fixture
def out(model, tmp_path):
    """A folder with the files of piezo_stack."""
    generate(model, tmp_path / "out")
    return tmp_path / "out"


@pytest.fixture
def file(out):
    return out / "piezo_stack" / "piezo_stack.py"


@pytest.mark.long
def test_committed_files_are_what_the_specs_give():
    assert drift(shipped_models(), ROOT / "generated", complete=True) == ()


def test_files_just_generated_have_not_drifted(model, out):
    assert drift([model], out, complete=True) == ()


def test_a_missing_file_is_found(model, file, out):
    file.unlink()
    assert [(d.path, d.fault, d.diff) for d in drift([model], out)] == [(file, "is missing", "")]


def test_a_folder_that_is_not_there_lacks_its_files(model, tmp_path):
    assert {d.fault for d in drift([model], tmp_path / "none", complete=True)} == {"is missing"}


def test_a_changed_file_is_found_with_the_difference(model, file, out):
    file.write_text(file.read_text().replace("d*v_mass\n", "2*d*v_mass\n", 1))
    (found,) = drift([model], out)
    lines = found.diff.splitlines()
    assert found.fault == "differs from its spec"
    assert lines[:2] == [f"--- {file} (present)", f"+++ {file} (from the spec)"]
    assert [line for line in lines[2:] if line[0] in "+-"] == [
        "-    F_damper = 2*d*v_mass",
        "+    F_damper = d*v_mass",
    ]


def test_a_changed_spec_is_found(spec, out):
    spec["parameters"]["M"]["value"] = 4e-3
    found = drift([Model(**spec)], out)  # the queries hold for any
    module, header, source, step_header, step, proofs = found
    assert "+    M: float = 0.004" in module.diff
    assert "+    double M; /* moving mass [kg]; spec: 0.004 */" in header.diff
    assert "sha256" in source.diff
    assert "sha256" in step_header.diff
    assert "sha256" in step.diff
    assert proofs.path.name == "proofs.json"


@pytest.mark.parametrize("name", ["piezo_stack/old_name.py", "removed/removed.py"])
def test_a_left_over_file_is_found(model, file, out, name):
    old = out / name
    old.parent.mkdir(exist_ok=True)
    old.write_text(file.read_text())
    assert [(d.path, d.fault) for d in drift([model], out, complete=True)] == [
        (old, "belongs to no spec given")
    ]


def test_files_of_models_not_given_are_no_drift(model, file, out):
    other = out / "mine" / "mine.py"
    other.parent.mkdir()
    other.write_text(file.read_text())
    assert drift([model], out) == ()


def test_a_left_over_file_is_found_whatever_it_says_of_itself(model, file, out):
    old = out / "removed" / "removed.py"
    old.parent.mkdir()
    text = file.read_text()
    old.write_text(text.replace(text[: text.index("import")], ""))
    assert [(d.path, d.fault) for d in drift([model], out, complete=True)] == [(old, LEFT)]


@pytest.mark.parametrize(
    "name", ["notes.txt", ".hidden", "piezo_stack/photo.png", "a/b/c", "x.pyc"]
)
def test_whatever_else_is_in_the_folder_is_found(model, out, name):
    extra = out / name
    extra.parent.mkdir(parents=True, exist_ok=True)
    extra.write_bytes(bytes(range(256)))
    assert [(d.path, d.fault) for d in drift([model], out, complete=True)] == [(extra, LEFT)]
    own = [extra] if extra.parent.name == "piezo_stack" else []
    assert [d.path for d in drift([model], out)] == own


def test_pythons_own_caches_and_empty_folders_are_no_drift(model, out):
    cache = out / "piezo_stack" / "__pycache__"
    cache.mkdir()
    (cache / "piezo_stack.cpython-311.pyc").write_text("")
    (out / "removed").mkdir()
    assert drift([model], out, complete=True) == ()
    (cache / "notes.txt").write_text("")
    assert [d.path.name for d in drift([model], out)] == ["notes.txt"]


@pytest.mark.parametrize(("ends", "lines"), [(b"\r\n", 1), (b"\r\n", -1), (b"\r", -1)])
def test_other_line_ends_are_found(model, file, out, ends, lines):
    file.write_bytes(file.read_bytes().replace(b"\n", ends, lines))
    assert [(d.path, d.fault) for d in drift([model], out)] == [(file, ENDS)]


def test_a_last_line_without_an_end_is_found(model, file, out):
    file.write_bytes(file.read_bytes().removesuffix(b"\n"))
    assert [(d.path, d.fault) for d in drift([model], out)] == [(file, ENDS)]


@pytest.mark.parametrize("extra", [b"\xff", b"\n", b" ", b"\x0c", b"\r"])
def test_every_byte_counts(model, file, out, extra):
    file.write_bytes(file.read_bytes() + extra)
    assert [(d.path, d.fault) for d in drift([model], out)] == [(file, DIFFERS)]


@pytest.mark.parametrize("name", ["piezo_stack/piezo_stack.py", "piezo_stack", ""])
@pytest.mark.parametrize("complete", [True, False])
def test_a_link_is_found_even_if_what_it_leads_to_is_right(model, out, name, complete):
    link, moved = out / name, out.parent / "moved"
    link.rename(moved)
    link.symlink_to(moved)
    found = [(d.path, d.fault) for d in drift([model], out, complete=complete)]
    assert found == ([(link, LINK)] if name or complete else [])


def test_links_that_no_spec_gives_are_found_and_not_followed(model, out):
    (out / "loop").symlink_to(out)
    (out / "piezo_stack" / "nowhere").symlink_to("nothing")
    found = [(d.path.name, d.fault) for d in drift([model], out, complete=True)]
    assert found == [("loop", LINK), ("nowhere", LINK)]


def test_a_folder_in_place_of_a_file_is_found(model, file, out):
    file.unlink()
    file.mkdir()
    assert [(d.path, d.fault) for d in drift([model], out)] == [(file, LINK)]


def test_a_pipe_is_found_and_not_read(model, file, out):
    file.unlink()
    os.mkfifo(file)
    os.mkfifo(out / "pipe")
    found = [(d.path, d.fault) for d in drift([model], out, complete=True)]
    assert found == [(file, LINK), (out / "pipe", LINK)]


def test_a_file_in_place_of_a_models_folder_is_found(model, tmp_path):
    (tmp_path / "piezo_stack").write_text("")
    assert {(d.path.name, d.fault) for d in drift([model], tmp_path)} >= {("piezo_stack", LEFT)}


def test_a_check_writes_nothing(model, tmp_path):
    drift([model], tmp_path / "none")
    assert list(tmp_path.iterdir()) == []


def test_no_drift_raises_nothing():
    assert raise_if_drifted((), "piezo-sym generate") is None


def test_drift_names_the_file_the_number_and_the_command(model, file, out):
    old = out / "piezo_stack" / "old_name.py"
    old.write_text(file.read_text())
    file.unlink()
    with pytest.raises(DriftError) as caught:
        raise_if_drifted(drift([model], out), "piezo-sym generate")
    message = f"'{file}': is missing (and 1 more); run `piezo-sym generate` and commit the result"
    assert str(caught.value) == message
    assert caught.value.exit_code == 1


def test_a_left_over_file_is_to_be_deleted(model, file, out):
    (out / "piezo_stack" / "old_name.py").write_text(file.read_text())
    with pytest.raises(DriftError, match="belongs to no spec given; delete it"):
        raise_if_drifted(drift([model], out), "piezo-sym generate")
