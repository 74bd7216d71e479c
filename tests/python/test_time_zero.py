"""Occupant risk of measured channels whose time zero is not the first contact: refused, not passed."""

from __future__ import annotations

import re

import numpy as np
import pytest
from birm3d import Channel, occupant_risk

G = 9.80665
PEAK, LENGTH = 25.0, 0.1  # g, s
GAINED = 2.0 * PEAK * G * LENGTH / np.pi  # of a half sine [m/s]
TIME = np.arange(-3000, 3001) * 1e-4


def half_sine(begin: float, time: np.ndarray = TIME) -> np.ndarray:
    """A braking pulse that begins at an instant [g]."""
    return -PEAK * np.sin(np.pi * (time - begin) / LENGTH) * ((time >= begin) & (time < begin + LENGTH))


def channel(values: np.ndarray, time: np.ndarray = TIME) -> Channel:
    return Channel("rail, x", time, values, "g")


@pytest.mark.parametrize("begin", [-0.02, -0.05, -0.09, -0.10, -0.15])
@pytest.mark.parametrize("name", ["x", "y"])
def test_a_pulse_that_begins_before_time_zero_is_refused(begin: float, name: str) -> None:
    """-0.05 s passed MASH with half of the OIV; from -0.1 s on the occupant struck nothing."""
    other = {"x": "y", "y": "x"}[name]
    record = channel(half_sine(begin))
    with pytest.raises(ValueError, match="first contact") as refused:
        occupant_risk(**{name: record, other: 0.0})
    text = str(refused.value)
    assert text.startswith(f"{name} must not change the velocity by more than 0.3 m/s before time zero")
    for word in ("'rail, x'", "Channel.shifted", "an offset"):
        assert word in text
    change, instant = (float(n) for n in re.findall(r"with ([-+.\d]+) m/s .* begins at ([-.\d]+) s", text)[0])
    early = min(-begin, LENGTH)
    assert change == pytest.approx(-0.5 * GAINED * (1.0 - np.cos(np.pi * early / LENGTH)), abs=0.01)
    assert instant == pytest.approx(begin, abs=1e-3)
    # What the message says to do gives the answer of the same pulse at zero.
    there = occupant_risk(**{name: record, other: 0.0}, time_zero=instant)
    here = occupant_risk(**{name: channel(half_sine(0.0)), other: 0.0})
    assert getattr(there, f"oiv_{name}") == pytest.approx(getattr(here, f"oiv_{name}"), rel=5e-3)


def test_vertical_channels_are_looked_at_too() -> None:
    """A gauge that reads 1 g at rest changes the velocity by 2.9 m/s in 0.3 s."""
    with pytest.raises(ValueError, match=r"z must not change .* with \+2.94 m/s"):
        occupant_risk(x=channel(half_sine(0.0)), y=0.0, z=channel(np.ones_like(TIME)))


def test_a_channel_that_begins_earlier_than_the_others_is_looked_at_whole() -> None:
    late = TIME[TIME >= 0.0]
    with pytest.raises(ValueError, match=r"x must not change"):
        occupant_risk(x=channel(half_sine(-0.15)), y=channel(half_sine(0.0, late), late))


@pytest.mark.parametrize("bias", [-0.05, 0.0, 0.05])
def test_noise_before_the_impact_passes(bias: float) -> None:
    """0.05 g of noise, all of it on one side or none, over 0.1 s before the impact."""
    time = TIME[TIME >= -0.1]
    noise = 0.05 * np.random.default_rng(0).normal(size=len(time))
    clean = occupant_risk(x=channel(half_sine(0.0)), y=0.0)
    found = occupant_risk(x=channel(half_sine(0.0, time) + noise + bias, time), y=0.0)
    assert found.oiv_x == pytest.approx(clean.oiv_x, rel=5e-3)
    assert not found.passed("MASH")


def test_the_limit_is_on_the_velocity() -> None:
    """An offset of 0.1 g adds 0.3 m/s in 0.306 s: before and after that."""
    pulse = channel(half_sine(0.0) + 0.1)
    limit = 0.3 / (0.1 * G)
    late = Channel("late", pulse.time + 0.5, pulse.values, "g")  # zero is 0.5 s there
    before = occupant_risk(x=late, y=0.0, time_zero=0.5)  # 0.3 s of it
    assert before.oiv_x == pytest.approx(15.02, abs=0.01)
    longer = np.arange(-round((limit + 1e-3) / 1e-4), 3001) * 1e-4
    with pytest.raises(ValueError, match=r"with \+0.30 m/s"):
        occupant_risk(x=channel(half_sine(0.0, longer) + 0.1, longer), y=0.0)


def test_an_offset_is_named_and_taken_off() -> None:
    record = channel(half_sine(0.0) + 0.4)
    with pytest.raises(ValueError, match=r"\+1.18 m/s .*most likely has an offset \(Channel.without_bias\)"):
        occupant_risk(x=record, y=0.0)
    clean = occupant_risk(x=channel(half_sine(0.0)), y=0.0)
    assert occupant_risk(x=record.without_bias(), y=0.0).oiv_x == pytest.approx(clean.oiv_x, rel=1e-3)


def test_a_tow_before_the_contact_is_left_out() -> None:
    """Towed at 0.3 g until 84 ms before the wall, as offset tests do: 64 km/h over 1.5 m."""
    record = channel(half_sine(0.0) + 0.3 * (TIME < -0.084))
    with pytest.raises(ValueError, match=r"brake or tow act before the contact \(Channel.between"):
        occupant_risk(x=record, y=0.0)
    clean = occupant_risk(x=channel(half_sine(0.0)), y=0.0)
    assert occupant_risk(x=record.between(-0.08, 0.3), y=0.0).oiv_x == pytest.approx(clean.oiv_x, rel=1e-9)


def test_a_pulse_that_a_wrong_bias_hides_is_refused() -> None:
    """The mean before zero of a pulse before zero is no offset of the gauge."""
    with pytest.raises(ValueError, match="must not change the velocity"):
        occupant_risk(x=channel(half_sine(-0.15)).without_bias(), y=0.0)
