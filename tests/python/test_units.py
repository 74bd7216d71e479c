"""Units: sizes, both ways, and the texts that are read."""

from __future__ import annotations

import pytest
from birm3d import units
from hypothesis import given
from hypothesis import strategies as st

ALL = [
    getattr(units, name)
    for name in units.__all__
    if name not in ("Measure", "Quantity", "Stated", "Unit", "measure", "parse", "quantity_in", "si")
]


@pytest.mark.parametrize(
    ("unit", "size"),
    [
        (units.mph, 1609.344 / 3600.0),  # the international mile, hour
        (units.km_h, 1000.0 / 3600.0),
        (units.inch, 0.0254),
        (units.ft, 12 * 0.0254),
        (units.lb, 0.45359237),
        (units.lbf, 0.45359237 * 9.80665),
        (units.kgf, 9.80665),
        (units.g, 9.80665),
        (units.kN, 1000.0),
        (units.mm, 0.001),
        (units.m, 1.0),
        (units.s, 1.0),
        (units.kg, 1.0),
        (units.m_s, 1.0),
    ],
)
def test_sizes(unit: units.Unit, size: float) -> None:
    # Exact by definition (international yard and pound, 1959; standard gravity, 1901), so only rounding.
    assert float(unit) == pytest.approx(size, rel=1e-15)


@given(value=st.floats(-1e12, 1e12), unit=st.sampled_from(ALL))
def test_there_and_back(value: float, unit: units.Unit) -> None:
    assert unit(value) == value * unit
    assert unit(value) / unit == pytest.approx(value, rel=1e-15)


def test_values_of_the_paper() -> None:
    assert units.mph(50) == pytest.approx(22.352, rel=1e-12)
    assert units.lb(15000) == pytest.approx(6803.88555, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "quantity", "value"),
    [
        ("50mph", "speed", 22.352),
        (" 50 mph ", "speed", 22.352),
        ("36 km/h", "speed", 10.0),
        ("36kmh", "speed", 10.0),
        ("10", "speed", 10.0),
        ("10 m/s", "speed", 10.0),
        ("1e1m/s", "speed", 10.0),
        ("2.5t", "mass", 2500.0),
        ("1719 kg", "mass", 1719.0),
        ("100lb", "mass", 45.359237),
        ("12 in", "length", 0.3048),
        ("1 ft", "length", 0.3048),
        ("-3mm", "length", -0.003),
        (".5", "length", 0.5),
        ("10 ms", "time", 0.01),
        ("24deg", "angle", 24.0),
        ("24", "angle", 24.0),
        ("1.5707963267948966rad", "angle", 90.0),
        ("2.4 kg/m^3", "density", 2.4),
        ("3 MPa/m", "pressure per length", 3e6),
    ],
)
def test_parse(text: str, quantity: str, value: float) -> None:
    assert units.parse(text, quantity) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "quantity"),
    [
        ("50kg", "speed"),
        ("50 mph", "mass"),
        ("fast", "speed"),
        ("", "speed"),
        ("mph", "speed"),
        ("50 mph mph", "speed"),
        ("5 0", "mass"),
        ("1,5", "length"),
        ("nan", "speed"),
        ("inf", "speed"),
        ("50 MPH", "speed"),
        ("24 radians", "angle"),
    ],
)
def test_what_is_not_a_quantity_is_refused(text: str, quantity: str) -> None:
    with pytest.raises(
        ValueError, match=rf"{quantity} must be a number with one of the units .*got {text!r}"
    ):
        units.parse(text, quantity)


@given(value=st.floats(1e-6, 1e6), unit=st.sampled_from(["m/s", "km/h", "mph"]))
def test_parse_reads_what_is_printed(value: float, unit: str) -> None:
    sizes = {"m/s": units.m_s, "km/h": units.km_h, "mph": units.mph}
    assert units.parse(f"{value!r} {unit}", "speed") == pytest.approx(sizes[unit](value), rel=1e-15)
