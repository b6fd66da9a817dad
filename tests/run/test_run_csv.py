"""Samples from text files: what is read, and every fault by name."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym import samples_from_csv, simulate, sweep
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
        (b"t,V\n0,\xff\n", {}, FileError, "line 2: '\xff' is not a number (column 'V')"),
        (b"t,V\n0,\x81\n", {}, FileError, "is not text in UTF-8"),
        ("t,V\n0,1\n1,x\n", {}, FileError, "line 3: 'x' is not a number (column 'V')"),
        ("t;V\n0;1\n1;2,500\n", {}, FileError, "; write decimals with a point"),
        ("t;V\n0;1\n1;2\n", {"column": "t"}, UsageError, "column 't' has the times; expected a"),
        ("t,V\n0,1\n# x,2\n", {}, FileError, "delete lines that begin with '#'"),
        ("# a,b\n# c\n0,1\n1,2\n", {}, FileError, "line 2 has one name; expected a header line"),
        ("# a\nt,V\n0,1\n1,x\n", {}, FileError, "line 4: 'x' is not a number (column 'V')"),
        ("t,V\ns,V\n0,1\n0.5,x\n", {}, FileError, "line 4: 'x' is not a number (column 'V')"),
        ("t;V\n0;1\n1;1.234,5\n", {}, FileError, "expected a number like 1.5e-3; write 1234.5"),
        ("t,V\n0,1\n% x,2\n", {}, FileError, "delete lines that begin with '%'"),
        ("t,V\n\n0,1\n\n2,1\n1,1\n", {}, UsageError, "time 1 in line 6 follows 2"),
        ("\nt,V\n0,1\n1,2\n", {}, FileError, "line 1 is empty; expected a header line"),
        ("t V\n0 1\n1 2\n", {}, FileError, "separate times and values by a comma, semicolon"),
        (
            "t,V\n0,1\n1,1\n1,2\n1,3\n2,3\n",
            {},
            UsageError,
            "in line 5 follows 1 twice; expected increasing",
        ),
        ("t,V\n0,1\n\n1\n", {}, FileError, "line 4: '' is not a number"),
        ("t,V\n0,1\n1,1_0\n", {}, FileError, "line 3: '1_0' is not a number"),
        (
            "t,V\n0,1\n1,2,5\n2,3\n",
            {},
            FileError,
            "line 3: has 3 cells; expected 2; write decimals",
        ),
        ("t,V,W\n0,1,2\n1,2,3,x\n", {"column": "V"}, FileError, "line 3: has 4 cells; expected 3"),
        ("t,V\n0,1\n1,nan\n", {}, FileError, "line 3: 'nan' is not finite (column 'V')"),
        ("t,V\n0,1\n", {"column": "W"}, UsageError, "no column 'W'; known: t, V"),
        ("t,Volt\n0,1\n", {"column": "volt"}, UsageError, "did you mean 'Volt'?"),
        ("t,V\n0,1\n", {"time_column": "s"}, UsageError, "time_column: no column 's'"),
        ("t,V\n0,1\n", {"column": 1}, UsageError, "1 is no header; expected the text over"),
        ("t,V\n0,1\n", {"time_column": 0}, UsageError, "time_column: 0 is no header"),
        ("t,V,V\n0,1,2\n", {"column": "V"}, UsageError, "two columns are named 'V'"),
        ("t,V,W\n0,1,2\n", {}, UsageError, "V, W; expected one; in Python say which, column='V'"),
        ("t,V\n0,1\n", {}, UsageError, "1 row of a time and a value; expected at least two rows"),
        ("t,V\n0,1\n1,\n", {}, FileError, "line 3: '' is not a number (column 'V'); expected a nu"),
        ("t,V\n0,1\n1,\n", {}, FileError, "; delete the line: samples are joined by straight lin"),
        ("t,V\n0,1\n1,nan\n", {}, FileError, "; delete the line: samples are joined by straight "),
        ("t,V\n0,1\n1,-1'000.5\n", {}, FileError, "expected a number like 1.5e-3; write -1000.5"),
        ("t,V\n1,1\n0,1\n", {}, UsageError, "time 0 in line 3 follows 1"),
        ("t,V\n0,1\n1,1\n2,1\n1,1\n", {}, UsageError, "time 1 in line 5 follows 2"),
        ("t [mm],V\n0,1\n1,1\n", {}, UsageError, "'t' is in mm; expected a time, such as in s"),
        ("t [ms],V [vlot]\n0,1\n1,1\n", {}, UsageError, "header: unknown unit 'vlot'"),
        ("0,1\n1,2\n2,3\n", {}, FileError, "line 1 has numbers where names are expected"),
        ("t,V\nms,some\n0,1\n", {}, FileError, "units go into the header: t [ms]"),
        ("t (degC),T (K)\n0,1\n1,1\n", {}, UsageError, "unit 'degC' has an offset"),
        ("t,V [V],V [A]\n0,1,2\n", {"column": "V"}, UsageError, "two columns are named 'V'"),
    ],
)
def test_faults(write, text, more, kind, words):
    path = write(text)
    with pytest.raises(kind) as error:
        samples_from_csv(path, **more)
    assert words in str(error.value)
    assert "drive.csv" in str(error.value)


def test_samples_are_shown_by_their_span(write):
    signal = samples_from_csv(write("t,V [kV]\n0,1\n1,3\n"))
    assert repr(signal) == "<Samples: 2 from 0 s to 1 s, values 1000 to 3000 V>"


def test_missing_file(tmp_path):
    with pytest.raises(FileError, match=r"none.csv: cannot be read: No such file"):
        samples_from_csv(tmp_path / "none.csv")


def test_what_is_no_path_is_refused():
    with pytest.raises(UsageError, match=r"^samples_from_csv.path: 5 is no path; expected"):
        samples_from_csv(5)


def test_units_of_the_header_are_converted(write):
    path = write("t [ms],V_in [kV], F_ext [N]\n0,0,1\n10,0.1,2\n")
    for column in ("V_in", "V_in [kV]"):
        signal = samples_from_csv(path, column)
        assert signal.times.tolist() == [0.0, 0.01]
        assert signal.values.tolist() == [0.0, 100.0]
        assert (signal.unit, signal.assumed) == ("V", "")
    assert samples_from_csv(path, "V_in", "t [ms]").times[1] == 0.01


@pytest.mark.parametrize("header", ["t (ms),V (kV)", "t/ms,V/kV", "t / ms,V / kV", "t [ms],V [kV]"])
def test_headers_of_instruments_say_units_in_their_ways(write, header):
    signal = samples_from_csv(write(header + "\n0,1\n20,2\n"), column="V")
    assert np.allclose(signal.times, [0, 0.02], rtol=1e-15)
    assert np.allclose(signal.values, [1e3, 2e3], rtol=1e-15)
    assert (signal.unit, signal.assumed) == ("V", "")


@pytest.mark.parametrize(
    "text",
    [
        "# Oscilloscope\n# 2026-01-01, channel 1\nt [ms],V [kV]\n0,1\n20,2\n",
        "# t [ms],V [kV]\n0,1\n20,2\n",
        "% made by hand\n% t/ms\tV/kV\n0\t1\n20\t2\n",
        "t,V\nms,kV\n0,1\n20,2\n",
        "t;V\n[ms];[kV]\n0,0;1,0\n20,0;2,0\n",
        "# a, b, c\nt,V\n(ms),(kV)\n\n0,1\n20,2\n",
        "t [ms],V [kV],\n0,1,\n20,2,\n",
        "t,V,\nms,kV,\n0,1,\n20,2,\n",
        "t [ms],V [kV]\n0,1\n20,2\n".encode("utf-16"),
        "t [ms];V [kV];\xb5\n0;1;2\n20;2;3\n".encode("cp1252"),
    ],
)
def test_files_of_instruments_are_read_as_they_are(write, text):
    signal = samples_from_csv(write(text), column="V")
    assert np.allclose(signal.times, [0, 0.02], rtol=1e-15)
    assert np.allclose(signal.values, [1e3, 2e3], rtol=1e-15)
    assert (signal.unit, signal.assumed) == ("V", "")


@pytest.mark.parametrize("unit", ["µs", "us", "\u03bcs"])
def test_a_micro_in_a_header_is_that_of_instruments(write, unit):
    assert samples_from_csv(write(f"t [{unit}],V\n0,1\n20,2\n")).times[1] == pytest.approx(2e-5)


@pytest.mark.parametrize("mark", [";", "\t"])
@pytest.mark.parametrize("first", ["0", "0,0", ",0", "-0,000"])
def test_decimal_commas_stand_between_semicolons_and_tabs(write, mark, first):
    text = f"t [ms]{mark}V [kV]\n{first}{mark}1\n12,5{mark}-2,25e-3\n1000{mark}3,125\n"
    signal = samples_from_csv(write(text))
    assert np.allclose(signal.times, [0, 0.0125, 1])
    assert np.allclose(signal.values, [1e3, -2.25, 3125])


def test_what_other_columns_say_decides_no_decimal_sign(write):
    text = 't;V;note\n0;1000;"12,5 h"\n1;2.5;1,5\n'
    assert samples_from_csv(write(text), "V").values.tolist() == [1000.0, 2.5]
    quoted = 't;V\n"0";"1,5"\n"1";"1234,567"\n'
    assert samples_from_csv(write(quoted)).values.tolist() == [1.5, 1234.567]


def test_what_stands_in_brackets_and_is_no_unit_is_part_of_a_name(write):
    signal = samples_from_csv(write("t,V (measured)\n0,1\n1,2\n"), column="V (measured)")
    assert signal.assumed == "t in s and V (measured) in the input's SI unit"


def test_a_header_without_units_says_what_was_assumed(write):
    both = samples_from_csv(write("t,V_in\n0,0\n1,1\n"))
    assert both.assumed == "t in s and V_in in the input's SI unit"
    assert samples_from_csv(write("t [s],V_in\n0,0\n1,1\n")).assumed.startswith("V_in in")


def test_a_run_refuses_samples_of_another_dimension(write):
    drive = samples_from_csv(write("t [ms],V_in [mA]\n0,0\n10,1\n"))
    with pytest.raises(
        UsageError, match=r"V_in: the samples are in A .*column 'V_in'.*samples in V"
    ):
        simulate("piezo_stack", inputs={"V_in": drive}, duration=0.01)
    drive = samples_from_csv(write("t [ms],V_in [N*m/C]\n0,0\n10,1\n"))
    run = simulate("piezo_stack", inputs={"V_in": drive}, duration=0.01)
    assert float(run.V_in[-1]) == pytest.approx(1.0, rel=1e-12)
    wrong = samples_from_csv(write("t [ms],V_in [K]\n0,0\n10,1\n"))
    with pytest.raises(UsageError, match="expected samples in V"):
        sweep("piezo_stack", over={"V_in": [wrong]}, duration=0.01)


def test_rows_that_pandas_does_not_take_are_read_all_the_same(write):
    long_row = samples_from_csv(write('t,V,note\n0,1,\n"1",2,more\n'), "V")
    assert long_row.values.tolist() == [1.0, 2.0]


@given(
    numbers=st.lists(
        st.floats(allow_nan=False, allow_infinity=False, width=64), min_size=2, max_size=20
    )
)
def test_numbers_are_read_to_round_off(numbers, tmp_path_factory):
    path = tmp_path_factory.mktemp("csv") / "drive.csv"
    path.write_text("t,V\n" + "".join(f"{n},{x!r}\n" for n, x in enumerate(numbers)))
    assert samples_from_csv(path).values.tolist() == pytest.approx(numbers, rel=1e-15)


@pytest.mark.parametrize("header", ["T_e [degC]", "T_e (degC)", "T_e [\N{DEGREE SIGN}C]"])
def test_temperatures_in_celsius_are_read(header, tmp_path):
    path = tmp_path / "room.csv"
    path.write_text(f"t [s],{header}\n0,20\n1,25.5\n", encoding="utf-8")
    read = samples_from_csv(path)
    assert np.array_equal(read.values, [293.15, 298.65])
    assert read.unit == "K"


def test_cells_that_are_empty_or_quoted_are_none_too_many(write):
    signal = samples_from_csv(write('t,V,note\n0,1,"a, b",\n1,2,c, ,\n'), column="V")
    assert np.array_equal(signal.values, [1, 2])
