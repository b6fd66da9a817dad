"""Property tests draw the same examples in every run; all workers share one cache of their own."""

import gc
import hashlib
import os
import pickle
import resource
import shutil
import signal
import sys
from collections import defaultdict
from contextlib import contextmanager
from pathlib import Path
from zlib import crc32

import pytest
from hypothesis import settings

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.register_profile("quick", settings.get_profile("repeatable"), max_examples=25)

# Modules and tests stay: to look for garbage among them as often as Python does takes long.
gc.set_threshold(50_000, 20, 20)

# Where pytest runs in the background of a shell, SIGINT is ignored, by all that tests start, too.
signal.signal(signal.SIGINT, signal.default_int_handler)


def is_quick(config):
    """Return whether the fast tier runs, and nothing else."""
    return config.option.markexpr == "not long"


def pytest_configure(config):
    """Draw fewer examples in the fast tier."""
    settings.load_profile("quick" if is_quick(config) else "repeatable")


#: Names of the models that are files.
FILES = {path.stem for path in Path(__file__).parents[1].glob("[pt]*/*/**/*.toml")}


def _place(item, n):
    """Return a number by which cases are sorted; of one that is kept, the model's comes first."""
    name = item.name.partition("[")[2]
    words = name.rstrip("]").split("-") if n == 1 else []
    model = next((Path(word).stem for word in words if Path(word).stem in FILES), "")
    return crc32(f"{model}]".encode()), crc32(name.encode())


@pytest.hookimpl(tryfirst=True)  # before `-m "not long"` looks at marks
def pytest_collection_modifyitems(items):
    """Keep ``some(n)`` cases of a test in the fast tier; the others are long.

    They are chosen by their names: of all tests of the same models, the same ones are kept, and
    what is compiled for one serves the others.
    """
    cases = defaultdict(list)
    for item in items:
        if (mark := item.get_closest_marker("some")) and not item.get_closest_marker("long"):
            cases[item.nodeid.split("[")[0], mark.args[0]].append(item)
    for (_, n), found in cases.items():
        found.sort(key=lambda item: _place(item, n))
        for item in found[n:]:
            item.add_marker(pytest.mark.long)


#: Models of which tests take so many steps that some optimization pays.
LONG_RUNS = ("piezo_stack", "stack_bouc_wen", "stack_maxwell", "led", "rubbing")


@pytest.fixture(scope="session")
def shared_folder(tmp_path_factory):
    """A folder of all workers of this run."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


@pytest.fixture(scope="session", autouse=True)
def _shared_cache(shared_folder):
    """Modules and libraries are made once for all workers; nothing is a user's, or left there."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(shared_folder / "cache"))
        yield


#: A compiler whose results are kept: what was compiled once, of the same texts by the same words,
#: is copied, whoever asks. `few` are flags for runs of many steps, `flags` for others.
COMPILES = """
case "$*" in
*/.build-*) ;;
*) exec {real} "$@" ;;
esac
PATH=$PATH:{path}
for word; do
  test "$before" = -o && out=$word
  before=$word
done
folder=${{out%/*}} more="{flags}"
for model in {long}; do
  test -f "$folder/$model.h" && more="{few}"
done
set -- "$@" $more
key=$({{ printf '%s\\n' "$@" | sed "s|$folder||"; cat "$folder"/*.[ch]; }} | {digest})
known={store}/${{key%% *}}
test -f "$known" && exec cp "$known" "$out"
{real} "$@" && cp "$out" "$known.$$" && mv "$known.$$" "$known"
"""


#: Where the compilers of this machine are, before tests put others in their place.
FOUND = {name: path for name in ("cc", "gcc", "clang") if (path := shutil.which(name))}
DIGEST = shutil.which("sha256sum") or shutil.which("shasum")


def write_compiler(folder, name, shared, flags, few):
    """Write a compiler of this machine into a folder, if there is one, with flags added."""
    if name in FOUND and DIGEST:
        (shared / "compiled").mkdir(exist_ok=True)
        folder.mkdir(exist_ok=True)
        script = COMPILES.format(
            long=" ".join(LONG_RUNS),
            **{"few": few, "flags": flags, "real": FOUND[name]},
            **{"path": os.defpath, "digest": DIGEST, "store": shared / "compiled"},
        )
        write_script(folder / f"{name}-{os.getpid()}", script).replace(folder / name)


@pytest.fixture(scope="session", autouse=True)
def _quick_compiler(request, shared_folder):
    """Compile the same texts once, and without optimization, in a fifth of the time.

    Networks as for a user: `test_run_compilers.py`, and all tests with ``-m "long or not long"``.
    """
    flags = ("-O0", "-O1") if is_quick(request.config) else ("", "")
    write_compiler(shared_folder / "quick", "cc", shared_folder, *flags)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", f"{shared_folder / 'quick'}{os.pathsep}{os.environ['PATH']}")
        yield


@pytest.fixture(scope="module")
def known_reports(shared_folder):
    """Examine a model once for all modules of tests that say so: the answer is always the same."""
    from piezo_sym import Model
    from piezo_sym.verification import process
    from piezo_sym.verification.protocol import Progress

    folder, messages = shared_folder / "reports", process.messages
    folder.mkdir(exist_ok=True)

    def known(worker, request):
        if not isinstance(request.subject, Model) or request.late:
            return messages(worker, request)
        path = folder / hashlib.sha256(repr(request.subject.model_dump()).encode()).hexdigest()
        if path.is_file():
            return pickle.loads(path.read_bytes())
        found = [*messages(worker, request)]
        if isinstance(found[-1], Progress):
            made = path.with_suffix(f".{os.getpid()}")
            made.write_bytes(pickle.dumps(found))
            made.replace(path)
        return found

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(process, "messages", known)
        yield


def forget():
    """Forget all libraries that this process has loaded, and every warning given once."""
    from piezo_sym.run.engine import batch, engine, library

    for function in (
        library.warn_once,
        engine._engine,
        batch.collocation_library,
    ):
        function.cache_clear()


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """The package's folder in a cache that is empty, for a process that has compiled nothing."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    forget()
    yield tmp_path / "cache" / "piezo_sym"
    forget()


@pytest.fixture
def no_compiler(cache, tmp_path, monkeypatch):  # noqa: ARG001  # what was compiled is not found
    """A machine without a compiler; the only folder in which commands are found, for others."""
    (tmp_path / "bin").mkdir()
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setitem(sys.modules, "ziglang", None)
    return tmp_path / "bin"


@contextmanager
def full_disk():
    """Let this process, and those it starts, write no byte to any file: "File too large"."""
    usual, most = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, most))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (usual, most))


def write_script(path, text):
    """Write a command for the shell."""
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


@pytest.fixture
def quick_compiler(tmp_path, shared_folder, monkeypatch):
    """Compilers that never optimize: who compiles, where to and how often is the same."""
    if shutil.which("cc"):
        for name in FOUND:
            write_compiler(tmp_path / "quick", name, shared_folder, "-O0", "-O0")
        monkeypatch.setenv("PATH", f"{tmp_path / 'quick'}{os.pathsep}{os.environ['PATH']}")
        monkeypatch.delenv("CC", raising=False)
