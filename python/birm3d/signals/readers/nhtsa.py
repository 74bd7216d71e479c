"""Channels of the NHTSA vehicle crash test database: the EV5 header and its x-y files.

A test has a header such as ``v10146.EV5``, in sections of lines with fields between ``|``. Each curve is a
file of two columns, time in s and value: ``v10146.001``, or ``v10146_001.tsv``. Fields are in the order of
the headers of tests 7292 and 10146, version 5 of the format of the NHTSA Test Reference Guide, volume 1.

The curves are as NHTSA has them. Axes are those of SAE J211, x forward, y to the right, z down, so a frontal
impact is an acceleration along -x. Loads are signed as the laboratory did it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...base.frozen_mapping import FrozenMapping
from ...io.file_format import FileFormatError, reading, reads, received
from ..channel import Channel
from ._lines import number, read_text

__all__ = ["NhtsaCurve", "NhtsaTest", "read_nhtsa"]

_SECTION = re.compile(r"-+ *(\w+) *-+")
# Places of fields in the sections TEST, VEHICLE and INSTRUMENTATION, and how many a line has at least.
_TEST = {"title": 1, "date": 3, "closing_speed": 14, "impact_angle": 15, "curves": 18}
_VEHICLE = {"vehicle": 0, "year": 3, "mass": 10, "wheelbase": 12, "length": 13, "width": 14}
_CURVE = {
    "vehicle": 0, "curve": 1, "sensor": 2, "occupant": 3, "location": 4, "axis": 5, "x_unit": 6, "unit": 7,
    "prefilter": 8, "first": 14, "last": 15, "interval": 16, "status": 17, "kind": 18, "comment": 19,
}  # fmt: skip
_LEAST = {"TEST": 19, "VEHICLE": 15, "INSTRUMENTATION": 20}
# Codes of units met in the headers read so far; others are the caller's to add.
_UNITS = {"G'S": "g", "NWT": "N", "NWM": "N m", "MM": "mm", "DPS": "deg/s", "DEG": "deg"}
# Place of an instant in its file, rounded to microseconds, against the header [s].
_TIME = 2e-6


@dataclass(frozen=True)
class NhtsaCurve:
    """One line of the section INSTRUMENTATION.

    Codes are NHTSA's: sensor ``"AC"`` (accelerometer), ``"LC"`` (load cell); axis ``"XG"`` (global) or
    ``"XL"`` (local); status ``"AM"`` (as measured) or what is wrong; kind ``"P"`` (primary), ``"R"``
    (redundant). ``vehicle`` 0 is the barrier. ``prefilter`` is the corner of the recorder's filter [Hz]: no
    class.
    """

    number: int
    line: int
    vehicle: int
    sensor: str
    occupant: str
    location: str
    axis: str
    unit: str
    prefilter: float
    first: int
    last: int
    interval: float
    status: str
    kind: str
    comment: str


@dataclass(frozen=True, eq=False)
class NhtsaTest:
    """The header of a test; curves are read when asked for.

    Attributes
    ----------
    path : Path
        Of the header.
    info : mapping
        Title, date, ``closing_speed`` [km/h], ``impact_angle`` [deg], as in the section TEST.
    vehicles : tuple of mapping
        ``mass`` as tested [kg], ``wheelbase``, ``length``, ``width`` [mm], ``year``: the section VEHICLE.
    curves : tuple of NhtsaCurve
    """

    path: Path
    info: Mapping[str, str]
    vehicles: tuple[Mapping[str, str], ...]
    curves: tuple[NhtsaCurve, ...]
    units: Mapping[str, str]

    def find(
        self,
        *,
        sensor: str | None = None,
        location: str | None = None,
        axis: str | None = None,
        unit: str | None = None,
        vehicle: int | None = None,
        kind: str | None = None,
        status: str | None = "AM",
    ) -> tuple[NhtsaCurve, ...]:
        """Return the curves with the codes named; `location` and `axis` are the start of theirs.

        The cells of a load-cell wall in 10146 are ``find(sensor="LC", location="LC", axis="X", unit="NWT")``.
        Only curves with status ``"AM"`` (as measured) unless told; None: any.
        """
        wanted = {"sensor": sensor, "unit": unit, "vehicle": vehicle, "kind": kind, "status": status}
        starts = {"location": location, "axis": axis}
        return tuple(
            curve
            for curve in self.curves
            if all(value is None or getattr(curve, name) == value for name, value in wanted.items())
            and all(text is None or getattr(curve, name).startswith(text) for name, text in starts.items())
        )

    def channel(self, curve: int | NhtsaCurve, *, status: str | None = "AM") -> Channel:
        """Read one curve.

        Parameters
        ----------
        curve
            Its number in the header, or the line itself.
        status
            That it must have; None: any, for a record that is good in part, see its comment.

        Raises
        ------
        FileFormatError
            With file and line. If there is no such curve or file, its status is another one, or its unit is
            not known. If the file is not what its header line says: rows, first instant, interval.
        """
        line = curve if isinstance(curve, NhtsaCurve) else self._curve(curve)
        with reading(self.path, "must be the header of a test of NHTSA (EV5)"):
            return self._channel(line, status)

    def _channel(self, line: NhtsaCurve, status: str | None) -> Channel:
        curve = f"curve {line.number}"
        if status is not None and line.status != status:
            raise FileFormatError.at(
                self.path,
                line.line,
                f"{curve} must have the status {status!r}, got {line.status!r} ({line.comment[:60]})",
            )
        if line.unit not in self.units:
            raise FileFormatError.at(
                self.path,
                line.line,
                f"{curve}: unit must be one of {', '.join(self.units)}, got {line.unit!r}; add it by units=",
            )
        file = self._file(line.number)
        time, values = _columns(file)
        rows, start = line.last - line.first + 1, line.first * line.interval
        if len(time) != rows:
            raise FileFormatError.at(
                file, None, f"must have {rows} rows as {self.path.name} says, got {len(time)}"
            )
        expected = np.asarray(start + line.interval * np.arange(rows), float)
        off = np.flatnonzero(np.abs(time - expected) > _TIME)
        if len(off):
            raise FileFormatError.at(
                file,
                int(off[0]) + 1,
                f"time must be {expected[off[0]]:g} s as {self.path.name} says, got {time[off[0]]:g} s",
            )
        details = (
            "sensor",
            "occupant",
            "location",
            "axis",
            "prefilter",
            "status",
            "kind",
            "comment",
            "vehicle",
        )
        return Channel(
            name=line.comment or f"curve {line.number}",
            time=expected,
            values=values,
            unit=self.units[line.unit],
            source=f"{self.path.stem}, curve {line.number}",
            info={name: str(getattr(line, name)) for name in details},
        )

    def channels(self, **codes: str | int | None) -> list[Channel]:
        """Read all curves that :meth:`find` finds."""
        status = codes.get("status", "AM")
        found = self.find(**codes)  # type: ignore[arg-type]
        return [self.channel(curve, status=None if status is None else str(status)) for curve in found]

    def _curve(self, wanted: int) -> NhtsaCurve:
        for curve in self.curves:
            if curve.number == wanted:
                return curve
        raise FileFormatError.at(
            self.path, None, f"curve must be one of its {len(self.curves)}, got {wanted}"
        )

    def _file(self, wanted: int) -> Path:
        stem = self.path.stem
        names = [f"{stem}.{wanted:03}", f"{stem}_{wanted:03}.tsv"]
        for name in names:
            file = self.path.with_name(name)
            if file.is_file():
                return file
        raise FileFormatError.at(
            self.path, None, f"curve {wanted} must have the file {' or '.join(names)}, got none"
        )

    def __repr__(self) -> str:
        return f"NhtsaTest({self.path.stem}: {self.info['title']}, {len(self.curves)} curves)"


@reads("must be the header of a test of NHTSA (EV5)")
def read_nhtsa(path: str | Path, *, units: Mapping[str, str] | None = None) -> NhtsaTest:
    """Read the header of a test of the NHTSA vehicle crash test database.

    Parameters
    ----------
    path
        The file ``*.EV5``, with the files of its curves beside it.
    units
        NHTSA codes of units to the ones of :func:`birm3d.units.measure`, beyond those known.

    Raises
    ------
    FileFormatError
        With file and line, if a section is missing, a line has too few fields, or a number is none.
    """
    file = Path(path)
    sections: dict[str, list[tuple[int, list[str]]]] = {}
    rows: list[tuple[int, list[str]]] = []
    for i, line in enumerate(read_text(file).splitlines(), 1):
        if (section := _SECTION.fullmatch(line.strip())) is not None:
            rows = sections.setdefault(section[1], [])
        elif line.strip() and not line.startswith("#"):
            rows.append((i, [cell.strip() for cell in line.split("|")]))
    for name, least in _LEAST.items():
        if not sections.get(name):
            raise FileFormatError.at(
                file, None, f"must have a section {name} with lines, got {', '.join(sections) or 'none'}"
            )
        for i, cells in sections[name]:
            if len(cells) < least:
                raise FileFormatError.at(
                    file, i, f"{name} must have {least} fields or more, got {len(cells)}"
                )
    _, test = sections["TEST"][0]
    return NhtsaTest(
        path=file,
        info=FrozenMapping({name: test[place] for name, place in _TEST.items()}),
        vehicles=tuple(
            FrozenMapping({name: cells[place] for name, place in _VEHICLE.items()})
            for _, cells in sections["VEHICLE"]
        ),
        curves=tuple(_parse_curve(file, i, cells) for i, cells in sections["INSTRUMENTATION"]),
        units=FrozenMapping({**_UNITS, **(units or {})}),
    )


def _parse_curve(file: Path, line: int, cells: list[str]) -> NhtsaCurve:
    texts = {name: cells[place] for name, place in _CURVE.items()}
    if texts["x_unit"] != "SEC":
        raise FileFormatError.at(file, line, f"curves must be over time [SEC], got {texts['x_unit']!r}")

    def integer(name: str) -> int:
        value = number(file, line, texts[name], name)
        if value != int(value):
            raise FileFormatError.at(file, line, f"{name} must be a whole number, got {texts[name]!r}")
        return int(value)

    interval = number(file, line, texts["interval"], "interval") * 1e-6  # microseconds
    first, last = integer("first"), integer("last")
    if not (interval > 0.0 and last > first):
        raise FileFormatError.at(
            file,
            line,
            f"interval must be > 0 and last beyond first, got {texts['interval']} us, {first} to {last}",
        )
    return NhtsaCurve(
        number=integer("curve"), line=line, vehicle=integer("vehicle"), sensor=texts["sensor"],
        occupant=texts["occupant"], location=texts["location"], axis=texts["axis"], unit=texts["unit"],
        prefilter=number(file, line, texts["prefilter"], "prefilter"), first=first, last=last,
        interval=interval, status=texts["status"], kind=texts["kind"], comment=texts["comment"],
    )  # fmt: skip


def _columns(file: Path) -> tuple[np.ndarray, np.ndarray]:
    """Time and values of an x-y file."""
    rows = []
    for i, line in enumerate(read_text(file).splitlines(), 1):
        if not line.strip():
            continue
        cells = line.replace(",", " ").split()
        if len(cells) != 2:
            raise FileFormatError.at(file, i, f"a row must have time and value, got {received(line.strip())}")
        rows.append(
            [number(file, i, cell, name) for cell, name in zip(cells, ("time", "value"), strict=True)]
        )
    table = np.array(rows, float).reshape(-1, 2)
    return table[:, 0], table[:, 1]
