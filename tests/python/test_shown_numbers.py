"""Numbers and units as engineers read them."""

from __future__ import annotations

import pytest
from birm3d.base.shown_numbers import plain_number, shown_value
from birm3d.vehicle.title import title_of_name, without_mass


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (6.01e4, "N", "60.1 kN"),
        (0.008, "m", "0.008 m"),
        (1.234e6, "N per m^2", "1.234 MPa"),
        (5.2e6, "N/m per m^2", "5.2 MPa/m"),
        (0.00001234, "m", "0.00001234 m"),
        (123456.7, "kg", "123,500 kg"),
        (0.0, "", "0"),
    ],
)
def test_values_have_the_units_of_practice(value: float, unit: str, text: str) -> None:
    assert shown_value(value, unit) == text


def test_beyond_what_is_read_a_number_has_a_power_of_ten() -> None:
    assert plain_number(3.2e-16) == "3.2e-16"


@pytest.mark.parametrize(
    ("title", "words"),
    [
        ("Cargo truck, 15,000 lb", "Cargo truck"),
        ("Pickup, three-quarter ton, 2,910 kg", "Pickup, three-quarter ton"),
        ("Semi-trailer of the semi truck, 53,000 lb loaded", "Semi-trailer of the semi truck"),
        ("Truck of 9,000 kg", "Truck"),
        ("MASH pickup 2270P", "MASH pickup 2270P"),
    ],
)
def test_titles_leave_the_mass_to_the_vehicle(title: str, words: str) -> None:
    assert without_mass(title) == words


def test_a_name_without_a_file_is_read_as_words() -> None:
    assert title_of_name("laboratory_block") == "Laboratory block"
    assert title_of_name("mash_36000v") == "MASH tractor and van trailer 36000V"
