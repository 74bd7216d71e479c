"""Channels: what they refuse, what each method does, and what their checks say."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from birm3d import Channel, check_channel, units
from birm3d.signals.channel import total
from hypothesis import given
from hypothesis import strategies as st

TIME = np.linspace(-0.05, 0.2, 2501)
SPEED, MASS = 15.0, 1500.0
# A half-sine stop from 15 m/s in 0.1 s: its area is 15 m/s.
PULSE = np.where((TIME >= 0.0) & (TIME <= 0.1), np.sin(math.pi * TIME / 0.1), 0.0) * SPEED * math.pi / 0.2


def make(values: object = PULSE, unit: str = "m/s^2", time: object = TIME, **more: object) -> Channel:
    return Channel("sill", time, values, unit, **more)  # type: ignore[arg-type]


def force(scale: float = MASS, unit: str = "N", shift: float = 0.0) -> Channel:
    return Channel("wall", TIME + shift, scale * PULSE, unit)


@pytest.mark.parametrize(
    ("arguments", "naming"),
    [
        ({"time": [0.0, 1.0, 1.0], "values": [0, 0, 0]}, "increasing, got 1 s and then 1 s at row 2"),
        ({"time": [0.0, 2.0, 1.0], "values": [0, 0, 0]}, "increasing, got 2 s and then 1 s at row 2"),
        ({"time": [0.0, math.nan], "values": [0, 0]}, "time must be finite, got nan at row 1"),
        ({"time": [0.0, 1.0], "values": [math.inf, 0]}, "values must be finite, got inf at row 0"),
        ({"time": [0.0, 1.0], "values": [0, 0, 0]}, "values must be as long as time, 2 rows, got 3 rows"),
        ({"time": [0.0], "values": [0]}, r"time must have the shape \(n,\) with n > 1, got \(1,\)"),
        ({"time": [[0.0, 1.0]], "values": [0, 0]}, r"time must have the shape .* got \(1, 2\)"),
        ({"unit": "kn"}, "unit must be one of s, ms, .*; got 'kn'"),
        ({"cfc": 0.0}, "cfc must be finite and > 0, or None, got 0"),
        ({"cfc": math.nan}, "cfc must be finite and > 0, or None, got nan"),
    ],
)  # fmt: skip
def test_bad_channels_are_refused(arguments: dict, naming: str) -> None:
    with pytest.raises(ValueError, match=naming):
        make(**arguments)


def test_a_channel_can_not_be_changed() -> None:
    mine = PULSE.copy()
    channel = make(mine, info={"sensor": "AC"})
    mine[:] = 0.0
    assert channel.values.max() == PULSE.max()
    for change in (
        lambda c: c.values.__setitem__(0, 1.0),
        lambda c: c.time.__setitem__(0, 1.0),
        lambda c: c.info.__setitem__("sensor", "LC"),
        lambda c: setattr(c, "unit", "g"),
    ):
        with pytest.raises((ValueError, TypeError, AttributeError)):
            change(channel)


def test_pickle_gives_an_equal_channel_that_can_not_be_changed() -> None:
    channel = make(cfc=60.0, source="a file", info={"sensor": "AC"})
    copy = pickle.loads(pickle.dumps(channel))
    assert (copy.name, copy.unit, copy.cfc, copy.source) == ("sill", "m/s^2", 60.0, "a file")
    assert dict(copy.info) == {"sensor": "AC"}
    assert np.array_equal(copy.values, channel.values)
    assert not copy.values.flags.writeable


@pytest.mark.parametrize(
    ("unit", "si", "size"),
    [
        ("kN", "N", 1e3), ("lbf", "N", 0.45359237 * 9.80665), ("g", "m/s^2", 9.80665), ("mm", "m", 1e-3),
        ("mph", "m/s", 0.44704), ("rad/s", "deg/s", 180.0 / math.pi), ("deg", "deg", 1.0),
        ("kN s", "N s", 1e3), ("%", "1", 0.01), ("ft/s", "m/s", 0.3048),
    ],
)  # fmt: skip
def test_to_si(unit: str, si: str, size: float) -> None:
    channel = make(unit=unit).to_si()
    assert channel.unit == si
    assert channel.values == pytest.approx(size * PULSE, rel=1e-14)
    back = channel.to(unit)
    assert back.unit == unit
    assert back.values == pytest.approx(PULSE, rel=1e-14)
    assert make(unit=unit).quantity == units.measure(si).quantity


def test_a_unit_of_another_quantity_is_refused() -> None:
    with pytest.raises(ValueError, match="unit must measure acceleration as 'sill' does, got 'kN'"):
        make().to("kN")


def test_filtered_keeps_area_and_says_its_class() -> None:
    filtered = make().filtered(60)
    assert filtered.cfc == 60.0
    assert filtered.values.sum() == pytest.approx(PULSE.sum(), rel=1e-6)
    assert filtered.values.max() < PULSE.max()
    # Of the class already: not once more, as twice is narrower.
    assert filtered.filtered(60) is filtered
    assert make().filtered(180).filtered(60).cfc == 60.0
    with pytest.raises(ValueError, match="cfc must be at most 60, the class of 'sill', got 180"):
        filtered.filtered(180)


def test_uneven_rows_are_neither_filtered_nor_given_an_interval() -> None:
    uneven = make(time=0.2 * np.linspace(0.0, 1.0, len(TIME)) ** 2)
    assert not uneven.is_even
    with pytest.raises(ValueError, match=r"time of 'sill' must be evenly spaced, got steps from .*resampled"):
        uneven.filtered(60)
    # A file that rounds its time to microseconds is even.
    assert make(time=np.round(TIME / 3.0, 6)).interval == pytest.approx(1e-4 / 3.0, rel=1e-4)


def test_resampled_is_exact_on_lines_and_never_leaves_the_record() -> None:
    line = make(3.0 * TIME + 1.0)
    instants = np.array([-0.05, -0.0123, 0.1, 0.2])
    assert line.resampled(instants).values == pytest.approx(3.0 * instants + 1.0, rel=1e-12)
    for bad, naming in (
        ([0.0, 0.3], "time must lie in the record of 'sill', -0.05 to 0.2 s, got 0 to 0.3"),
        ([-0.06, 0.1], "time must lie in the record .* got -0.06 to 0.1"),
        ([0.1, 0.0], "time must be strictly increasing"),
        ([0.0], r"time must have the shape \(m,\)"),
        ([0.0, math.nan], "time must lie in the record .* nan"),
    ):
        with pytest.raises(ValueError, match=naming):
            line.resampled(bad)


def test_between_shifted_flipped() -> None:
    part = make().between(0.0, 0.1)
    assert part.time[[0, -1]] == pytest.approx([0.0, 0.1], abs=1e-12)
    with pytest.raises(ValueError, match="end must lie in the record"):
        make().between(0.0, 0.21)
    assert make().shifted(0.02).time == pytest.approx(TIME - 0.02, abs=1e-15)
    with pytest.raises(ValueError, match="time_zero must be finite, got nan"):
        make().shifted(math.nan)
    assert make().flipped().values == pytest.approx(-PULSE)


@given(bias=st.floats(-100.0, 100.0))
def test_without_bias_takes_the_bias_and_nothing_else(bias: float) -> None:
    assert make(PULSE + bias).without_bias().values == pytest.approx(PULSE, abs=1e-9)


def test_without_bias_needs_rows() -> None:
    with pytest.raises(
        ValueError, match=r"before must leave at least 10 rows of 'sill' .* got -0.0495 s with 5 rows"
    ):
        make().without_bias(before=-0.0495)


def test_integrated() -> None:
    deceleration = make(-PULSE / units.g, unit="g")
    velocity = deceleration.integrated(initial=SPEED, at=0.0)
    assert velocity.unit == "m/s"
    assert np.interp(0.0, velocity.time, velocity.values) == pytest.approx(SPEED, rel=1e-12)
    assert velocity.values[-1] == pytest.approx(0.0, abs=1e-3)
    # Travel of a half-sine stop: v T / 2.
    travel = velocity.integrated(at=0.0)
    assert travel.unit == "m"
    assert travel.values[-1] == pytest.approx(SPEED * 0.1 / 2.0, rel=1e-3)
    assert force().integrated().values[-1] == pytest.approx(MASS * SPEED, rel=1e-4)
    with pytest.raises(ValueError, match=r"quantity of 'sill' must be one of acceleration, .* got angle"):
        make(unit="deg").integrated()
    with pytest.raises(ValueError, match="at must lie in the record"):
        make().integrated(at=1.0)


def test_total_of_load_cells() -> None:
    cells = [Channel(f"cell {k}", TIME, k * PULSE, unit) for k, unit in ((1, "kN"), (2, "kN"), (500, "N"))]
    wall = total(cells, "wall")
    assert (wall.name, wall.unit) == ("wall", "N")
    assert wall.values == pytest.approx(3500.0 * PULSE, rel=1e-12)
    for others, naming in (
        ([], "channels must be at least one, got none"),
        (
            [cells[0], make()],
            "channels must have one quantity, got force of 'cell 1' and acceleration of 'sill'",
        ),
        (
            [cells[0], cells[1].filtered(60)],
            "channels must have one cfc, got None of 'cell 1' and 60.0 of 'cell 2'",
        ),
        ([cells[0], cells[1].shifted(1e-4)], "channels must have the same instants, got others in 'cell 2'"),
    ):
        with pytest.raises(ValueError, match=naming):
            total(others, "wall")


def test_a_good_record_is_ok() -> None:
    for channel in (make(-PULSE), make(-PULSE / units.g, unit="g"), force(), force(MASS / 1e3, "kN")):
        findings = channel.check(impact_speed=SPEED, mass=MASS)
        assert findings.ok, str(findings)
        assert {finding.about for finding in findings} == {"sampling", "time zero", "bias", "sign and unit"}


@pytest.mark.parametrize(
    ("channel", "severity", "about", "saying"),
    [
        (make(PULSE), "error", "sign", r"changes the velocity by 15 m/s, .* speed of 15 m/s; .*flipped\(\)"),
        (force(-MASS), "error", "sign", r"its impulse is -2.25e\+04 N s, .* 2.25e\+04 N s; .*flipped\(\)"),
        (make(-PULSE, unit="g"), "error", "unit", r"looks like m/s\^2 taken for g \(unit here g\)"),
        (make(-PULSE / units.g), "error", "unit", r"looks like g taken for m/s\^2 \(unit here m/s\^2\)"),
        (force(MASS / 1e3), "error", "unit", r"looks like kN taken for N \(unit here N\)"),
        (force(-MASS, "kN"), "error", "unit", r"looks like N taken for kN .*and the sign is the other one"),
        (force(3.0 * MASS), "error", "sign and unit", "that does not fit"),
        (force(shift=0.03), "warning", "time zero", r"rises at 3[01]\.\d ms; shifted\(0\.03\d*\) makes that"),
        (force(shift=-0.02), "warning", "time zero", r"rises at -(20\.0|1\d\.\d) ms; shifted\(-0\.0"),
        (force(shift=1.0), "warning", "time zero", r"the record, 0.95 to 1.2 s, has none in it; see shifted"),
        (make(-PULSE + 2.0), "warning", "bias", r"impact 2 m/s\^2, .* of the peak; see without_bias"),
        (Channel("v", TIME, np.full(len(TIME), 15.0 * 3.6), "m/s"), "error", "unit", "km/h taken for m/s"),
        (Channel("v", TIME, np.full(len(TIME), -15.0), "m/s"), "error", "sign", r"flipped\(\)"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said(channel: Channel, severity: str, about: str, saying: str) -> None:
    findings = check_channel(channel, impact_speed=SPEED, mass=MASS)
    assert not findings.ok
    found = [f for f in findings if f.severity == severity and f.about == about]
    assert len(found) == 1, str(findings)
    with pytest.raises(ValueError, match=saying):
        raise ValueError(str(found[0]))
    assert str(found[0]) in str(findings)


def test_the_mending_that_a_finding_names_mends() -> None:
    wrong = force(-MASS, shift=0.03)
    mended = wrong.flipped().shifted(0.03)
    assert mended.check(impact_speed=SPEED, mass=MASS).ok
    biased = make(-PULSE + 2.0)
    assert biased.without_bias().check(impact_speed=SPEED).ok


def test_noise_is_no_onset() -> None:
    noise = 0.02 * PULSE.max() * np.random.default_rng(3).normal(size=len(TIME))
    findings = make(-PULSE + noise).check(impact_speed=SPEED)
    assert findings.ok, str(findings)


def test_sampling_is_said() -> None:
    coarse = Channel("f", TIME[::25], PULSE[::25], "N")
    (sampling,) = coarse.check(cfc=60).warnings
    assert str(sampling) == (
        "warning: sampling: rows every 0.0025 s are too far apart for CFC 60, which asks for 0.00166667 s"
    )
    uneven = Channel("x", [0.0, 0.1, 0.3], [0.0, 1.0, 2.0], "mm")
    assert "rows are 0.1 to 0.2 s apart" in str(uneven.check())


def test_what_is_not_known_is_said_not_to_be_checked() -> None:
    assert "not checked: that needs impact_speed and mass" in str(force().check(impact_speed=SPEED))
    assert "not checked: that needs impact_speed" in str(make(-PULSE).check())
    short = make(-PULSE).between(0.0, 0.2)
    assert "note: bias: not checked" in str(short.check(impact_speed=SPEED))


@pytest.mark.parametrize("name", ["impact_speed", "mass", "onset_within"])
@pytest.mark.parametrize("bad", [0.0, -1.0, math.nan])
def test_bad_expectations_are_refused(name: str, bad: float) -> None:
    with pytest.raises(ValueError, match=f"{name} must be finite and > 0, got {bad}"):
        force().check(**{name: bad})


@given(offset=st.floats(-0.04, 0.045))
def test_onset_follows_the_record(offset: float) -> None:
    findings = force(shift=offset).check(impact_speed=SPEED, mass=MASS, onset_within=1e-9)
    (finding,) = (f for f in findings if f.about == "time zero")
    rises = float(finding.message.split("rises at ")[1].split(" ms")[0])
    # A half sine passes 2 % of its peak after 0.6 ms of its 100; the mean is over 1 ms.
    assert rises == pytest.approx(1e3 * offset + 0.6, abs=0.7)
