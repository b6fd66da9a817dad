"""Generated C compiles without a warning, in any company, and touches no memory but its own."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from piezo_sym import Model, derive, load
from piezo_sym.codegen import collocation_of, lower, printed
from piezo_sym.codegen.c.style import KEPT
from piezo_sym.errors import SpecError
from piezo_sym.run.engine.c_sources import standalone_step
from piezo_sym.spec.names import check_symbol
from tests.codegen.c_compilers import COMPILERS, SANITIZING

SPECS = sorted((Path(__file__).parents[1] / "networks" / "specs").glob("*.toml"))
STRICT = [
    *("-std=c99", "-O2", "-fopenmp-simd", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wundef"),
    *("-Wconversion", "-Wdouble-promotion", "-Wstrict-prototypes", "-Wmissing-prototypes"),
    *("-Wwrite-strings", "-Wcast-qual", "-Wvla", "-Wfloat-conversion", "-Werror"),
    *("-Wno-unknown-warning-option", "-Wno-pass-failed"),  # clang asks for no vectors: it may fail
]
HEADERS = [
    *("assert", "complex", "ctype", "errno", "fenv", "float", "inttypes", "iso646", "limits"),
    *("locale", "math", "setjmp", "signal", "stdarg", "stdbool", "stddef", "stdint", "stdio"),
    *("stdlib", "string", "tgmath", "time"),
]
SANITIZED = Path(__file__).with_name("sanitized.c")


def called(words, folder):
    """Run a command; return what it says, and fail with it if it fails."""
    environment = {**os.environ, "ASAN_OPTIONS": "detect_leaks=0"}
    done = subprocess.run(
        list(map(str, words)),
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def written(model, folder):
    """Write a model's C files, and return their common name."""
    iphs = derive(model)
    texts = printed(lower(iphs, "verdict"), collocation_of(iphs))
    texts["_step.c"] += standalone_step(model.name, texts["_step.c"])
    for ending, text in texts.items():
        (folder / f"{model.name}{ending}").write_text(text, encoding="utf-8")
    return model.name


@pytest.mark.some(2)
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("path", ["piezo_stack", *SPECS], ids=lambda path: Path(path).stem)
def test_there_is_no_warning(compiler, path, tmp_path):
    name = written(load(path), tmp_path)
    for source in (f"{name}.c", f"{name}_step.c"):
        assert called([*COMPILERS[compiler], *STRICT, "-c", source], tmp_path) == ""


@pytest.mark.parametrize("compiler", COMPILERS)
def test_a_bank_with_calls_of_the_library_has_no_warning(compiler, tmp_path):
    """Such a loop asks for no vectors: a compiler that cannot make them would say so."""
    data = load("piezo_stack").model_dump()
    data["elements"]["hysteron"]["voltage"] = "rho/T_0*i_0*tanh(i/i_0)"
    name = written(Model(**data), tmp_path)
    assert called([*COMPILERS[compiler], *STRICT, "-c", f"{name}.c"], tmp_path) == ""
    text = (tmp_path / f"{name}.c").read_text()
    rates = text[text.index("_rhs(") : text.index("_outputs(")]
    assert "tanh(i_hysteron/i_0[j])" in rates
    assert "#pragma" not in rates


def symbols():
    """The words that C or its headers use and that a spec may use, too."""
    for word in sorted(KEPT):
        try:
            yield check_symbol(word, "test")
        except SpecError:
            continue


def crowded(words):
    """Return a model with those parameters, each used in a law."""
    data = {
        "model": {"name": "crowded"},
        "parameters": {
            "C": {"value": 1.0, "unit": "F"},
            "T_0": {"value": 300.0, "unit": "K"},
            "c": {"value": 1.0, "unit": "J/K"},
            **{word: {"value": 1.0 + n, "unit": "ohm"} for n, word in enumerate(words)},
        },
        "domain": {"assume": [f"{word} > 0" for word in words]},
        "elements": {
            "C1": {"kind": "capacitor", "between": ["n", "gnd"], "capacitance": "C"},
            "body": {"kind": "thermal_mass", "temperature": "T_0*exp(S/c)"},
            **{
                f"R{n}": {
                    "kind": "resistor",
                    "between": ["n", "gnd"],
                    "current": f"v/{word}",
                    "heats": "body",
                }
                for n, word in enumerate(words)
            },
        },
    }
    return Model(**data)


@pytest.fixture(scope="module")
def words_of_c(tmp_path_factory):
    """A folder with the files of a model that has them as parameters, and its name."""
    words, folder = list(symbols()), tmp_path_factory.mktemp("words")
    assert {"I", "M_PI", "EOF", "INFINITY", "NAN", "complex", "template", "errno", "pow"} <= {
        *words
    }
    return folder, written(crowded(words), folder)


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("compiler", "standard"),
    [(name, "c99") for name in COMPILERS]
    + [(next(iter(COMPILERS)), standard) for standard in ("gnu99", "gnu17")],
)
def test_words_of_c_and_of_its_headers_are_names_like_others(compiler, standard, words_of_c):
    folder, name = words_of_c
    includes = [f"#include <{header}.h>" for header in HEADERS]
    lines = [*includes, f'#include "{name}.c"', ""]
    (folder / "all.c").write_text("\n".join(lines))
    flags = [flag for flag in STRICT if flag not in {"-std=c99", "-O2", "-Wconversion", "-Wundef"}]
    called(
        [*COMPILERS[compiler], f"-std={standard}", *flags, "-Wno-pedantic", "-c", "all.c"], folder
    )


def test_the_header_is_one_of_cplusplus(words_of_c):
    compiler = shutil.which("g++") or shutil.which("clang++") or "c++"
    folder, name = words_of_c
    (folder / "all.cpp").write_text(f'#include <cmath>\n#include "{name}.h"\n')
    called(
        [compiler, "-std=c++17", "-Wall", "-Wextra", "-Werror", "-c", "all.cpp"],
        folder,
    )


def test_names_that_c_cannot_have_are_told(tmp_path):
    written(crowded(["I", "EOF"]), tmp_path)
    header = (tmp_path / "crowded.h").read_text()
    assert "    double I_; /* I: [ohm]; spec: 1.0 */\n" in header
    assert "    double EOF_; /* EOF: [ohm]; spec: 2.0 */\n" in header


@pytest.mark.some(2)
@pytest.mark.parametrize("words", ["*/ int broken;", "/* open", "/*/ both", "??/", "end\\", "é"])
def test_texts_stay_in_their_comments(words, tmp_path):
    data = load("piezo_stack").model_dump()
    data["model"] |= {"title": words, "source": words}
    data["parameters"]["M"]["doc"] = words
    name = written(Model(**data), tmp_path)
    called(["cc", *STRICT, "-trigraphs", "-c", f"{name}.c"], tmp_path)
    assert (tmp_path / f"{name}.h").read_text().isascii()


def test_nothing_is_allocated_or_kept(tmp_path):
    """The object has no data that can be written, and calls the mathematics library alone."""
    name = written(load("piezo_stack"), tmp_path)
    called(["cc", "-std=c99", "-O1", "-c", f"{name}.c"], tmp_path)
    rows = [line.split()[-2:] for line in called(["nm", f"{name}.o"], tmp_path).splitlines()]
    assert {kind for kind, _ in rows} <= {"T", "t", "U", "r"}
    assert {word for kind, word in rows if kind == "U"} <= {
        "exp",
        "expm1",
        "log",
        "__stack_chk_fail",
    }


def sanitized(compiler, source):
    """Return the command that builds a sanitized program."""
    flags = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-O1", "-g"]
    words = [*COMPILERS[compiler], "-std=c99", *flags, "-fopenmp-simd", source]
    return [*words, "-lm", "-o", "run"]


@pytest.mark.parametrize("compiler", SANITIZING)
def test_no_call_leaves_its_arrays(compiler, tmp_path):
    """Every function, with arrays that end where their rows end, for r = 1, 2, 3 and 17."""
    written(load("piezo_stack"), tmp_path)
    shutil.copy(SANITIZED, tmp_path)
    called(sanitized(compiler, SANITIZED.name), tmp_path)
    assert called(["./run"], tmp_path) == "good 1\ngood 2\ngood 3\ngood 17\n"


@pytest.mark.parametrize("compiler", SANITIZING)
def test_a_call_that_leaves_its_arrays_is_seen(compiler, tmp_path):
    """The check above can fail: with one row too few it does."""
    written(load("piezo_stack"), tmp_path)
    text = SANITIZED.read_text().replace("const long short_of = 0;", "const long short_of = 1;")
    (tmp_path / "short.c").write_text(text)
    called(sanitized(compiler, "short.c"), tmp_path)
    with pytest.raises(AssertionError, match="heap-buffer-overflow"):
        called(["./run"], tmp_path)
