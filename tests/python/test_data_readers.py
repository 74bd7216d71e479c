"""Files of test data: small ones in each format, read back to the digit; broken ones, refused by line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from birm3d import read_csv_channels, read_iso_mme, read_nhtsa
from birm3d.signals.channel import total
from birm3d.signals.readers.iso_mme import ChannelCode

CSV = """\
# sled 12, filtered by the laboratory
time [ms], wall force (kN), sill [g]

-0.1, 0.0, 0.5
0.0, 1.5, -2
0.1, 3.25e0, -7.5
"""


def write(folder: Path, name: str, text: str, encoding: str = "utf-8") -> Path:
    file = folder / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding=encoding)
    return file


def test_table_with_units_in_its_head(tmp_path: Path) -> None:
    channels = read_csv_channels(write(tmp_path, "sled.csv", CSV), cfc=60)
    assert list(channels) == ["wall force", "sill"]
    force = channels["wall force"]
    assert (force.unit, force.quantity, force.cfc, force.source) == (
        "kN",
        "force",
        60,
        "sled.csv: wall force",
    )
    assert force.time == pytest.approx([-1e-4, 0.0, 1e-4], abs=1e-18)
    assert force.to_si().values == pytest.approx([0.0, 1500.0, 3250.0], rel=1e-15)
    assert channels["sill"].to_si().values == pytest.approx([0.5 * 9.80665, -2 * 9.80665, -7.5 * 9.80665])
    assert list(read_csv_channels(tmp_path / "sled.csv", ["sill"])) == ["sill"]


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_table_with_a_row_of_units(tmp_path: Path, delimiter: str) -> None:
    rows = [["time", "fx", "pitch"], ["s", "N", "rad"], ["0", "1", "0.5"], ["0.1", "2", "0.25"]]
    file = write(tmp_path, "a.csv", "\n".join(delimiter.join(row) for row in rows))
    pitch = read_csv_channels(file)["pitch"].to_si()
    assert pitch.unit == "deg"
    assert pitch.values == pytest.approx(np.degrees([0.5, 0.25]), rel=1e-14)


def test_one_of_two_times_is_chosen_by_name(tmp_path: Path) -> None:
    file = write(tmp_path, "a.csv", "t [ms],clock [s],f [N]\n0,100,1\n1,101,2\n")
    assert read_csv_channels(file, time="t")["f"].time == pytest.approx([0.0, 1e-3])
    assert read_csv_channels(file, ["f"], time="clock")["f"].time == pytest.approx([100.0, 101.0])
    with pytest.raises(ValueError, match=r"a.csv:1: time must be named unless .* got \['t', 'clock'\]"):
        read_csv_channels(file)


@pytest.mark.parametrize(
    ("old", "new", "naming"),
    [
        ("[g]", "[gee]", r":2: column 'sill': unit must be one of s, .*; got 'gee'"),
        (", sill [g]", ", sill", r":2: column 'sill': unit must be one of .*; got ''"),
        ("sill [g]", "wall force [g]", r":2: columns must have names of their own, got 'wall"),
        ("[ms]", "[mm]", r":2: time must be named unless one column is of time, got \[\]"),
        ("0.0, 1.5, -2", "0.0, 1.5", r":5: a row must have 3 cells, got 2"),
        ("0.0, 1.5, -2", "0.0, 1.5, -2, 3", r":5: a row must have 3 cells, got 4"),
        ("3.25e0", "x", r":6: column 'wall force' must be a number, got 'x'"),
        ("3.25e0", "nan", r":6: column 'wall force' must be finite, got 'nan'"),
        ("3.25e0", "", r":6: column 'wall force' must be a number, got ''"),
        ("0.1, 3.25", "-0.05, 3.25", r":6: 'time' must be strictly increasing, got 0 s and then -5e"),
        ("0.0, 1.5, -2\n0.1, 3.25e0, -7.5\n", "", r":4: a table must have at least two rows, got 1"),
        (CSV, "# nothing\n", r": path must have a head and rows, got an empty table"),
        (CSV, "t,f\n", r":1: the head must have units, such as 'force \[kN\]', got none"),
        (CSV, "t,f\ns\n0,1\n1,1\n", r":2: the row of units must have 2 cells, got 1"),
    ],
)  # fmt: skip
def test_broken_tables(tmp_path: Path, old: str, new: str, naming: str) -> None:
    assert old in CSV
    file = write(tmp_path, "sled.csv", CSV.replace(old, new))
    with pytest.raises(ValueError, match=naming):
        read_csv_channels(file)


def test_names_that_a_table_does_not_have(tmp_path: Path) -> None:
    file = write(tmp_path, "sled.csv", CSV)
    with pytest.raises(
        ValueError, match=r"sled.csv:2: columns must be of time, wall force, sill, got 'tilt'"
    ):
        read_csv_channels(file, ["tilt"])
    with pytest.raises(ValueError, match=r"sled.csv:2: time must name a column of time .* got 'sill'"):
        read_csv_channels(file, time="sill")


# The layout of the database's headers, with values of our own.
EV5 = """\
# Source: layout of an NHTSA header
----- EV5 -----
----- TEST -----
V5|TITLE OF A TEST|OBJECTIVES|01/JAN/2020|LAB|CONTRACT|REF|NCA|VTB|CON|DRY|20|OTH|OTH|54.0|0|0|0|4|RECORDER
----- VEHICLE -----
1|16|03|2018|M1|4S|VIN|4CIF|2.5|AF|1500|1400|2800|4900|1840|1200|UN|UNK|P||0
----- BARRIER -----
R|LCB|0|0|LOAD CELL BARRIER
----- INSTRUMENTATION -----
1|1|AC|NA|FLLR|XG|SEC|G'S|2800|MFG: A|01/JAN/2020|800|21|54.0|-2|3|100|AM|P|LEFT REAR SEAT X
0|2|LC|NA|LC0101|XG|SEC|NWT|2800|MFG: B|01/JAN/2020|300000|1|0.0|-2|3|100|AM|P|BARRIER A-01 Fx
0|3|LC|NA|LC0102|XG|SEC|NWT|2800|MFG: B|01/JAN/2020|300000|1|0.0|-2|3|100|AM|P|BARRIER A-02 Fx
0|4|LC|NA|LC0102|YG|SEC|NWM|2800|MFG: B|01/JAN/2020|14025|1|0.0|-2|3|100|CF|P|BARRIER A-02 My: no data
1|5|XX|NA|OTHR|XG|SEC|QQQ|2800|MFG: C|01/JAN/2020|1|1|0.0|-2|3|100|AM|P|STRANGE
"""
INSTANTS = ("-0.000200", "-0.000100", "0.000000", "0.000100", "0.000200", "0.000300")


def curve_file(values: list[float], separator: str = "\t") -> str:
    return "".join(f"{t}{separator}{value:.6f}\n" for t, value in zip(INSTANTS, values, strict=True))


@pytest.fixture
def nhtsa(tmp_path: Path) -> Path:
    write(tmp_path, "v09999.001", curve_file([0.0, 0.1, -0.1, -5.0, -20.0, -40.0]))
    write(tmp_path, "v09999.002", curve_file([0, 0, 1000, 2000, 3000, 4000]))
    write(tmp_path, "v09999_003.tsv", curve_file([0, 0, 10, 20, 30, 40], "  "))
    write(tmp_path, "v09999.005", curve_file([1, 1, 1, 1, 1, 1]))
    return write(tmp_path, "v09999.EV5", EV5)


def test_nhtsa_header(nhtsa: Path) -> None:
    test = read_nhtsa(nhtsa)
    assert test.info["title"] == "TITLE OF A TEST"
    assert (test.info["closing_speed"], test.info["impact_angle"]) == ("54.0", "0")
    assert (test.vehicles[0]["mass"], test.vehicles[0]["wheelbase"], test.vehicles[0]["width"]) == (
        "1500", "2800", "1840",
    )  # fmt: skip
    assert [curve.number for curve in test.curves] == [1, 2, 3, 4, 5]
    assert [c.number for c in test.find(sensor="LC", location="LC", axis="X", unit="NWT")] == [2, 3]
    assert [c.number for c in test.find(vehicle=0)] == [2, 3]
    assert [c.number for c in test.find(vehicle=0, status=None)] == [2, 3, 4]
    assert test.find(sensor="??") == ()
    assert repr(test) == "NhtsaTest(v09999: TITLE OF A TEST, 5 curves)"


def test_nhtsa_curves(nhtsa: Path) -> None:
    test = read_nhtsa(nhtsa)
    sill = test.channel(1)
    assert (sill.name, sill.unit, sill.cfc, sill.source) == ("LEFT REAR SEAT X", "g", None, "v09999, curve 1")
    assert sill.time == pytest.approx(1e-4 * np.arange(-2, 4), abs=1e-15)
    assert sill.values == pytest.approx([0.0, 0.1, -0.1, -5.0, -20.0, -40.0])
    assert (sill.info["sensor"], sill.info["location"], sill.info["axis"]) == ("AC", "FLLR", "XG")
    assert sill.info["prefilter"] == "2800.0"
    wall = total(test.channels(sensor="LC", location="LC", axis="X", unit="NWT"), "wall")
    assert wall.values == pytest.approx([0, 0, 1010, 2020, 3030, 4040])


def test_nhtsa_curves_that_are_not_what_the_header_says(nhtsa: Path) -> None:
    test = read_nhtsa(nhtsa)
    for curve, naming in (
        (4, r"v09999.EV5:13: curve 4 must have the status 'AM', got 'CF' \(BARRIER A-02 My: no data\)"),
        (5, r"v09999.EV5:14: curve 5: unit must be one of G'S, NWT, .* got 'QQQ'; add it by units="),
        (6, "v09999.EV5: curve must be one of its 5, got 6"),
    ):
        with pytest.raises(ValueError, match=naming):
            test.channel(curve)
    with pytest.raises(
        ValueError, match=r"curve 4 must have the file v09999.004 or v09999_004.tsv, got none"
    ):
        test.channel(4, status=None)
    assert read_nhtsa(nhtsa, units={"QQQ": "V"}).channel(5).unit == "V"


ZEROS = curve_file([0] * 6)


@pytest.mark.parametrize(
    ("text", "naming"),
    [
        (ZEROS + "0.000400\t0\n", r"v09999.002: must have 6 rows as v09999.EV5 says, got 7"),
        (ZEROS.replace("0.000300", "0.000400"), r"002:6: time must be 0.0003 s .* got 0.0004 s"),
        (
            ZEROS.replace("0\t0.000000\n0.000000", "0\tnan\n0.000000"),
            r"002:2: value must be finite, got 'nan'",
        ),
        (ZEROS.replace("-0.000200\t", "-0.000200\t1\t"), r"002:1: a row must have time and value, got "),
        (ZEROS.replace("-0.000200", "early"), r"002:1: time must be a number, got 'early'"),
    ],
)
def test_broken_nhtsa_curves(nhtsa: Path, text: str, naming: str) -> None:
    write(nhtsa.parent, "v09999.002", text)
    with pytest.raises(ValueError, match=naming):
        read_nhtsa(nhtsa).channel(2)


@pytest.mark.parametrize(
    ("old", "new", "naming"),
    [
        ("----- INSTRUMENTATION -----", "", "must have a section INSTRUMENTATION with lines, got EV5, "),
        ("----- VEHICLE -----", "----- VEHICEL -----", "section VEHICLE with lines, got EV5, TEST, VEHICEL"),
        ("|AM|P|LEFT REAR SEAT X", "", r"EV5:10: INSTRUMENTATION must have 20 fields or more, got 17"),
        ("|-2|3|100|AM|P|LEFT", "|-2|3|0|AM|P|LEFT", r"EV5:10: interval must be > 0 .* got 0 us, -2 to 3"),
        ("|-2|3|100|AM|P|LEFT", "|-2|x|100|AM|P|LEFT", r"EV5:10: last must be a number, got 'x'"),
        ("|-2|3|100|AM|P|LEFT", "|-2|2.5|100|AM|P|LEFT", r"EV5:10: last must be a whole number, got '2.5'"),
        ("FLLR|XG|SEC", "FLLR|XG|MM", r"EV5:10: curves must be over time \[SEC\], got 'MM'"),
    ],
)  # fmt: skip
def test_broken_nhtsa_headers(nhtsa: Path, old: str, new: str, naming: str) -> None:
    assert old in EV5
    write(nhtsa.parent, "v09999.EV5", EV5.replace(old, new))
    with pytest.raises(ValueError, match=naming):
        read_nhtsa(nhtsa)


CHANNEL = """\
Channel code                :11ENGN000000ACXC
Name of the channel         :Engine top: X
Unit                        :m/(s*s)
Reference channel           :implicit
Reference channel name      :NOVALUE
Time of first sample        :-0.001
Sampling interval           :0.0005
Number of samples           :4
Dimension                   :AC
0.0
-1.5E+1
-2.5
-3
"""
INDEX = """\
Instrumentation standard    :SAE J211
Number of channels          :3
Name of channel 001         :11ENGN000000ACXC / Engine top
Name of channel 002         :11TIRS000000TI00
Name of channel 003         :B0LCWA000000FOX0 / Wall
"""


@pytest.fixture
def mme(tmp_path: Path) -> Path:
    header = "Data format :ISO-MME\nTest number :T1\nComments :first\nComments :18 °C\n"
    write(tmp_path, "T1.mme", header, "iso-8859-1")
    write(tmp_path, "Channel/T1.chn", INDEX)
    write(tmp_path, "Channel/T1.001", CHANNEL)
    time = "Channel code :11TIRS000000TI00\nUnit :ms\nNumber of samples :3\n0\n1\n2.5\n"
    write(tmp_path, "Channel/T1.002", time)
    wall = (
        "Channel code :B0LCWA000000FOX0\nUnit :kN\nReference channel :explicit\n"
        "Reference channel name :11TIRS000000TI00\nNumber of samples :3\n1\n2\n4\n"
    )
    write(tmp_path, "Channel/T1.003", wall)
    return tmp_path


@pytest.mark.parametrize("name", [".", "T1.mme"])
def test_iso_mme(mme: Path, name: str) -> None:
    test = read_iso_mme(mme / name)
    assert test.info["Comments"] == "first\n18 °C"
    assert test.find("??ENGN*") == ["11ENGN000000ACXC"]
    engine = test.channel("11ENGN000000ACXC")
    assert (engine.name, engine.unit, engine.cfc) == ("Engine top: X", "m/s^2", 180.0)
    assert engine.time == pytest.approx([-1e-3, -5e-4, 0.0, 5e-4], abs=1e-15)
    assert engine.values == pytest.approx([0.0, -15.0, -2.5, -3.0])
    assert (engine.info["main_location"], engine.info["direction"]) == ("ENGN", "X")
    assert engine.source == "T1, 11ENGN000000ACXC"


def test_iso_mme_with_a_time_channel(mme: Path) -> None:
    channels = read_iso_mme(mme).channels()
    assert list(channels) == ["11ENGN000000ACXC", "B0LCWA000000FOX0"]
    wall = channels["B0LCWA000000FOX0"]
    assert wall.time == pytest.approx([0.0, 1e-3, 2.5e-3])
    assert wall.to_si().values == pytest.approx([1e3, 2e3, 4e3])
    assert wall.cfc is None


@pytest.mark.parametrize(
    ("letter", "cfc"),
    [("A", 1000.0), ("B", 600.0), ("C", 180.0), ("D", 60.0), ("H", 60.0), ("0", None), ("P", None)],
)
def test_channel_code(letter: str, cfc: float | None) -> None:
    code = ChannelCode.parse(f"B3LCWA010203FOX{letter}")
    assert code == ("B", "3", "LCWA", "010203", "FO", "X", letter)
    assert (code.quantity, code.cfc) == ("force", cfc)
    with pytest.raises(
        ValueError, match="code must be of sixteen capital letters, digits or '\\?', got 'abc'"
    ):
        ChannelCode.parse("abc")


@pytest.mark.parametrize(
    ("file", "old", "new", "naming"),
    [
        ("T1.001", "samples           :4", "samples           :5", r":8: must have 5 values, got 4"),
        ("T1.001", "-2.5", "NaN", r"T1.001:12: value must be finite, got 'NaN'"),
        ("T1.001", "-2.5", "-2,5", r"T1.001:12: value must be a number, got '-2,5'"),
        ("T1.001", "m/(s*s)", "m/(s*h)", r"T1.001:3: unit must be one of .*; got 'm/\(s\*h\)'"),
        ("T1.001", "m/(s*s)", "kN", r":3: unit must measure acceleration as 11ENGN.* does, got 'kN'"),
        ("T1.001", "m/(s*s)", "NOVALUE", r"T1.001: 'Unit' must have a value, got 'NOVALUE'"),
        ("T1.001", "11ENGN000000ACXC", "11ENGN000000ACYC", r":1: code must be '11ENGN000000ACXC' as"),
        ("T1.001", ":0.0005", ":0", r"T1.001:7: sampling interval must be > 0, got 0 s"),
        ("T1.001", "implicit\nReference channel name      :NOVALUE",
         "explicit\nReference channel name      :X",
         r"T1.001:5: reference channel must be indexed, got 'X'"),
        ("T1.001", "implicit\nReference channel name      :NOVALUE",
         "explicit\nReference channel name      :11TIRS000000TI00",
         r"T1.002: must hold 4 instants for T1.001, got 3 values of time"),
        ("T1.chn", ":3\n", ":4\n", r"T1.chn:2: must list 4 channels, got 3"),
        ("T1.chn", "channel 003", "channel 004", r"T1.chn:5: must have the file T1.004, got none"),
        ("T1.chn", "11TIRS000000TI00", "11ENGN000000ACXC", r":4: channels must have codes of their own"),
        ("T1.chn", "standard    :", "standard ", r"T1.chn:1: a line must be 'key :value'"),
    ],
)  # fmt: skip
def test_broken_iso_mme(mme: Path, file: str, old: str, new: str, naming: str) -> None:
    text = (mme / "Channel" / file).read_text(encoding="utf-8")
    assert old in text
    write(mme, f"Channel/{file}", text.replace(old, new))
    with pytest.raises(ValueError, match=naming):
        read_iso_mme(mme).channel("11ENGN000000ACXC")


def test_iso_mme_folders_without_a_test(mme: Path, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"must have one file .mme, got \[\]"):
        read_iso_mme(mme / "Channel")
    with pytest.raises(ValueError, match=r"code must be one of 11ENGN000000ACXC, .* got 'X'"):
        read_iso_mme(mme).channel("X")
    write(tmp_path, "T2.mme", "Data format :ISO-MME\n")
    with pytest.raises(ValueError, match=r"must have one file .mme, got \['T1.mme', 'T2.mme'\]"):
        read_iso_mme(mme)
