"""Samples from text files: what is read, and every fault by name."""

import numpy as np
import pytest

from piezo_sym import samples_from_csv
from piezo_sym.errors import FileError, UsageError


@pytest.fixture
def write(tmp_path):
    def written(text):
        path = tmp_path / "drive.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return written


@pytest.mark.parametrize("mark", [",", ";", "\t", ", "])
def test_delimiters(write, mark):
    path = write(mark.join(["t", "V"]) + "\n" + mark.join(["0", "1.5"]) + f"\n1{mark}-2e-1\n\n")
    signal = samples_from_csv(path)
    assert np.array_equal(signal.times, [0, 1])
    assert np.array_equal(signal.values, [1.5, -0.2])


def test_columns_by_name(write):
    path = write(b"\xef\xbb\xbfV,t,F\r\n5,0,7\r\n6,1,8\r\n")
    assert np.array_equal(samples_from_csv(path, column="F", time_column="t").values, [7, 8])
    assert np.array_equal(samples_from_csv(path, time_column="t", column="V").values, [5, 6])


@pytest.mark.parametrize(
    ("text", "more", "kind", "words"),
    [
        ("", {}, FileError, "is empty; expected a header"),
        (b"t,V\n0,\xff\n", {}, FileError, "is not text in UTF-8"),
        ("t,V\n0,1\n1,x\n", {}, FileError, "line 3: 'x' is not a number"),
        ("t,V\n0,1\n\n1\n", {}, FileError, "line 4: '' is not a number"),
        ("t,V\n0,1\n1,nan\n", {}, FileError, "line 3: 'nan' is not finite"),
        ("t,V\n0,1\n", {"column": "W"}, UsageError, "no column 'W'; known: t, V"),
        ("t,Volt\n0,1\n", {"column": "volt"}, UsageError, "did you mean 'Volt'?"),
        ("t,V\n0,1\n", {"time_column": "s"}, UsageError, "time_column: no column 's'"),
        ("t,V,V\n0,1,2\n", {"column": "V"}, UsageError, "two columns are named 'V'"),
        ("t,V,W\n0,1,2\n", {}, UsageError, "2 columns beside the times: V, W; expected one"),
        ("t,V\n0,1\n", {}, UsageError, "1 times and 1 values"),
        ("t,V\n1,1\n0,1\n", {}, UsageError, "time 0 at entry 1 follows 1"),
    ],
)
def test_faults(write, text, more, kind, words):
    path = write(text)
    with pytest.raises(kind) as error:
        samples_from_csv(path, **more)
    assert words in str(error.value)
    assert "drive.csv" in str(error.value)


def test_missing_file(tmp_path):
    with pytest.raises(FileError, match=r"none.csv: cannot be read: No such file"):
        samples_from_csv(tmp_path / "none.csv")
