"""Channels of a test in the ISO MME format (ISO/TS 13499).

A test is a folder with a header ``name.mme`` and a folder ``Channel``. That has an index ``name.chn`` and a
file for each channel, ``name.001`` and so on: lines ``key :value`` and then one value a line. Either the time
follows from the keys "Time of first sample" and "Sampling interval", or the reference channel is explicit,
and another channel holds it.

This is a reader of our own. The library of the field, pyisomme 1.1 (MIT licence, maintained), holds numpy
below 2, matplotlib at 3.7 and scipy at 1.12. It cannot share an environment with current releases of what
BIRM3D uses. The letters of the channel code follow the standard's RED B, 1.6.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ... import units
from ...base.frozen_mapping import FrozenMapping
from ...io.file_format import FileFormatError, reading, reads, received
from ..channel import Channel
from ._lines import number, read_text

__all__ = ["ChannelCode", "IsoMmeTest", "read_iso_mme"]

Floats = npt.NDArray[np.float64]

_INDEX_KEY = re.compile(r"Name of channel (\d+)")
_FILTER_CLASSES = {
    "A": 1000.0, "E": 1000.0, "B": 600.0, "F": 600.0, "C": 180.0, "G": 180.0, "D": 60.0, "H": 60.0, "L": 20.0,
}  # fmt: skip
_DIMENSIONS = {
    "AC": "acceleration", "AA": "angular acceleration", "AV": "angular velocity", "AN": "angle",
    "DS": "length", "DC": "length", "DV": "length", "VE": "speed", "VA": "speed", "VD": "speed",
    "FO": "force", "MO": "moment", "IM": "impulse", "EN": "energy", "PR": "pressure", "MA": "mass",
    "TI": "time", "VO": "voltage",
}  # fmt: skip
# Spellings of the standard that units.measure() does not have.
_UNITS = {
    "m/(s*s)": "m/s^2", "rad/(s*s)": "rad/s^2", "deg/(s*s)": "deg/s^2", "kg*m/s": "N s", "degree": "deg",
}  # fmt: skip
_NOTHING = ("", "NOVALUE")


class ChannelCode(NamedTuple):
    """The sixteen characters of a channel's code, in their parts."""

    test_object: str
    position: str
    main_location: str
    fine_location: str
    dimension: str
    direction: str
    filter_class: str

    @classmethod
    def parse(cls, code: str) -> ChannelCode:
        """Take a code apart, such as ``"11ENGN000000ACXA"``.

        Raises
        ------
        ValueError
            If it has not sixteen letters and digits.
        """
        if not re.fullmatch(r"[A-Z0-9?]{16}", code):
            raise ValueError(f"code must be of sixteen capital letters, digits or '?', got {received(code)}")
        return cls(code[0], code[1], code[2:6], code[6:12], code[12:14], code[14], code[15])

    @property
    def quantity(self) -> str | None:
        """What its physical dimension is; None: one that is not among the usual."""
        return _DIMENSIONS.get(self.dimension)

    @property
    def cfc(self) -> float | None:
        """Channel frequency class; None: unfiltered, or a filter that is no class (``"P"``, ``"S"``, ...)."""
        return _FILTER_CLASSES.get(self.filter_class)


@dataclass(frozen=True, eq=False)
class IsoMmeTest:
    """The header and index of a test; channels are read when asked for.

    Attributes
    ----------
    path : Path
        Of the header.
    info : mapping
        Its keys and values; lines with one key are joined by line breaks.
    codes : mapping
        Code of each channel -> its file.
    """

    path: Path
    info: Mapping[str, str]
    codes: Mapping[str, Path]

    def find(self, pattern: str) -> list[str]:
        """Return the codes that match, with ``?`` for any character and ``*`` for any number of them."""
        return [code for code in self.codes if fnmatchcase(code, pattern)]

    def channel(self, code: str) -> Channel:
        """Read one channel.

        Raises
        ------
        FileFormatError
            With file and line. If there is no such channel or file, a key is missing, or the file's code is
            another one. If the unit is unknown or not one of the code's dimension. If the number of values is
            not the one given, or a value is no finite number.
        """
        if code not in self.codes:
            raise FileFormatError.at(
                self.path, None, f"code must be one of {', '.join(self.codes)}, got {code!r}"
            )
        with reading(self.codes[code], "must be a channel in the ISO MME format"):
            return self._channel(code)

    def _channel(self, code: str) -> Channel:
        file = self.codes[code]
        keys, values = _channel_file(file)
        code_in_file = keys.text("Channel code")
        if code_in_file != code:
            raise FileFormatError.at(
                file,
                keys.line("Channel code"),
                f"code must be {code!r} as indexed, got {received(code_in_file)}",
            )
        parts = ChannelCode.parse(code)
        unit = _UNITS.get(keys.text("Unit"), keys.text("Unit"))
        try:
            quantity = units.measure(unit).quantity
        except ValueError as error:
            raise FileFormatError.at(file, keys.line("Unit"), str(error)) from None
        if parts.quantity not in (None, quantity):
            raise FileFormatError.at(
                file, keys.line("Unit"), f"unit must measure {parts.quantity} as {code} does, got {unit!r}"
            )
        return Channel(
            name=keys.texts.get("Name of the channel", code),
            time=self._time(file, keys, len(values)),
            values=values,
            unit=unit,
            cfc=parts.cfc,
            source=f"{self.path.stem}, {code}",
            info={**keys.texts, **parts._asdict()},
        )

    def channels(self, pattern: str = "*") -> dict[str, Channel]:
        """Read all channels whose code matches, except those of time."""
        return {
            code: self.channel(code)
            for code in self.find(pattern)
            if ChannelCode.parse(code).dimension != "TI"
        }

    def _time(self, file: Path, keys: _Keys, rows: int) -> Floats:
        if keys.texts.get("Reference channel", "implicit").lower() == "explicit":
            name = keys.text("Reference channel name")
            if name not in self.codes:
                raise FileFormatError.at(
                    file,
                    keys.line("Reference channel name"),
                    f"reference channel must be indexed, got {name!r}",
                )
            head, time = _channel_file(self.codes[name])
            unit = units.measure(head.text("Unit"))
            if unit.quantity != "time" or len(time) != rows:
                raise ValueError(
                    f"{self.codes[name]}: must hold {rows} instants for {file.name}, got {len(time)} values "
                    f"of {unit.quantity}"
                )
            return np.multiply(time, unit.size)
        interval, first = keys.number("Sampling interval"), keys.number("Time of first sample")
        if not interval > 0.0:
            raise FileFormatError.at(
                file, keys.line("Sampling interval"), f"sampling interval must be > 0, got {interval:g} s"
            )
        return np.asarray(first + interval * np.arange(rows), float)

    def __repr__(self) -> str:
        return f"IsoMmeTest({self.path.stem}, {len(self.codes)} channels)"


@reads("must be the header or the folder of a test in the ISO MME format")
def read_iso_mme(path: str | Path) -> IsoMmeTest:
    """Read the header and index of a test in the ISO MME format.

    Parameters
    ----------
    path
        The file ``*.mme``, or the folder that it is in.

    Raises
    ------
    FileFormatError
        With file and line. If there is not one header and one index, or a line has no key. If the channels
        are not as many as the index says, or not in files of their own.
    """
    given = Path(path)
    file = _only(given, ".mme") if given.is_dir() else given
    folder = next(
        (p for p in file.parent.iterdir() if p.is_dir() and p.name.lower() == "channel"), file.parent
    )
    index = _only(folder, ".chn")
    keys = _keys(index, read_text(index).splitlines())
    codes: dict[str, Path] = {}
    for key, text in keys.texts.items():
        if (match := _INDEX_KEY.fullmatch(key)) is None:
            continue
        code = text.split("/")[0].strip()
        try:
            ChannelCode.parse(code)
        except ValueError as error:
            raise FileFormatError.at(index, keys.line(key), str(error)) from None
        if code in codes:
            raise FileFormatError.at(
                index, keys.line(key), f"channels must have codes of their own, got {code} twice"
            )
        codes[code] = folder / f"{index.stem}.{match[1]}"
        if not codes[code].is_file():
            raise FileFormatError.at(
                index, keys.line(key), f"must have the file {codes[code].name}, got none"
            )
    number_of = keys.number("Number of channels")
    if len(codes) != number_of:
        raise FileFormatError.at(
            index, keys.line("Number of channels"), f"must list {number_of:g} channels, got {len(codes)}"
        )
    info = _keys(file, read_text(file).splitlines()).texts
    return IsoMmeTest(file, FrozenMapping(info), FrozenMapping(codes))


class _Keys(NamedTuple):
    """Keys of a file with their values and lines."""

    file: Path
    texts: dict[str, str]
    lines: dict[str, int]

    def text(self, key: str) -> str:
        value = self.texts.get(key, "")
        if value in _NOTHING:
            raise FileFormatError.at(self.file, None, f"{key!r} must have a value, got {value or 'none'!r}")
        return value

    def number(self, key: str) -> float:
        return number(self.file, self.line(key), self.text(key), repr(key))

    def line(self, key: str) -> int:
        return self.lines.get(key, 1)


def _keys(file: Path, lines: list[str]) -> _Keys:
    keys = _Keys(file, {}, {})
    for i, line in enumerate(lines, 1):
        if not line.strip():
            continue
        key, colon, text = (part.strip() for part in line.partition(":"))
        if not (key and colon):
            raise FileFormatError.at(file, i, f"a line must be 'key :value', got {received(line.strip())}")
        keys.texts[key] = f"{keys.texts[key]}\n{text}" if key in keys.texts else text
        keys.lines.setdefault(key, i)
    return keys


def _channel_file(file: Path) -> tuple[_Keys, Floats]:
    """Keys and values of a channel's file; the values begin at the first line that has no colon."""
    lines = read_text(file).splitlines()
    start = next((i for i, line in enumerate(lines) if line.strip() and ":" not in line), len(lines))
    keys = _keys(file, lines[:start])
    rows = [(i, line) for i, line in enumerate(lines[start:], start + 1) if line.strip()]
    values = np.array([number(file, i, line.strip(), "value") for i, line in rows])
    expected = keys.number("Number of samples")
    if not math.isclose(expected, len(values)):
        raise FileFormatError.at(
            file, keys.line("Number of samples"), f"must have {expected:g} values, got {len(values)}"
        )
    return keys, values


def _only(folder: Path, suffix: str) -> Path:
    found = sorted(p for p in folder.iterdir() if p.suffix.lower() == suffix)
    if len(found) != 1:
        raise FileFormatError.at(folder, None, f"must have one file {suffix}, got {[p.name for p in found]}")
    return found[0]
