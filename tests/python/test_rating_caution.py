"""Cautions of ratings: segments that would tip, low barriers, sloped faces, and what the model is."""

from __future__ import annotations

import birm3d
import pytest
from birm3d import Barrier, Result, Simulation, Vehicle, units
from birm3d.assessment.criteria import Criterion
from birm3d.assessment.rating_caution import fails_clearly, level_cautions, model_cautions, risk_doubts


@pytest.mark.parametrize("standard", ["IWA 14-1", "ISO 22343-1", "ASTM F2656", "PAS 68", "SD-STD-02.01"])
@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_security_standards_tell_of_segments_that_would_tip(heavy_blow: Result, standard: str) -> None:
    """And no free-standing barrier is said to be rigid and not to give way."""
    ratio = heavy_blow.metrics["max_overturning_ratio"]
    code = {"ASTM F2656": "PU", "SD-STD-02.01": "15,000-lb truck"}.get(standard, "N1G")
    caution = birm3d.rate(heavy_blow, standard, vehicle_class=code).caution
    assert f"' is {ratio:.3g} times its restoring one: it would begin to tip" in caution
    assert "modelled as rigid" not in caution
    assert "do not tip or break" in caution


@pytest.fixture(scope="module")
def heavy_blow() -> Result:
    barrier = Barrier.jersey(length=60.0, segments=15, free_standing=True)
    result = Simulation(Vehicle.preset("pickup_4x4_2500", mesh_density=0.1), barrier, 13.33).run()
    assert result.metrics["max_overturning_ratio"] > 2.0
    return result


def test_what_the_model_says_of_a_barrier() -> None:
    tubes = Barrier.bollards(count=3, diameter=0.2, wall_thickness=0.01, yield_stress=3e8)
    rigid = "Barriers that are modelled as rigid do not give way"
    free = Barrier.jersey(length=30.0, segments=5, free_standing=True)
    for barrier, told in ((Barrier.bollards(), True), (None, True), (tubes, False), (free, False)):
        text = " ".join(model_cautions(barrier))
        assert (rigid in text) is told
        assert text.startswith("Indicative: computed, not tested.")
    assert any("Posts yield" in one for one in model_cautions(tubes))


def test_the_caution_of_a_level_says_which_tests_it_is_about() -> None:
    found = level_cautions(
        {"a": ("All.", "Of two.", "Of a."), "b": ("All.", "Of two."), "c": ("All.", "Of c 1.2 m.", "Long.")}
    )
    assert found == ("All.", "Tests a, b: Of two.", "Test a: Of a.", "Test c: Of c 1.2 m. Long.")


@pytest.fixture(scope="module")
def car() -> Vehicle:
    return Vehicle.preset("mash_1100c", mesh_density=0.1)


def rated(vehicle: Vehicle, barrier: Barrier, standard: str, angle: float = 25.0) -> str:
    result = Simulation(vehicle, barrier, units.km_h(100.0), angle).run()
    return birm3d.rate(result, standard, vehicle_class=None).caution


@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")
@pytest.mark.parametrize(
    ("test", "inches", "metres"),
    [
        ("1-10", 27, "0.69"),
        ("2-10", 27, "0.69"),
        ("3-10", 29, "0.74"),
        ("4-10", 36, "0.91"),
        ("5-10", 42, "1.07"),
        ("6-10", 90, "2.29"),
    ],
)
def test_a_barrier_below_the_least_height_of_its_level_is_told(
    car: Vehicle, test: str, inches: int, metres: str
) -> None:
    for lower, told in ((0.02, True), (0.005, False), (-0.05, False)):
        height = inches * 0.0254 - lower
        caution = rated(car, Barrier.rigid_wall(height=height), f"MASH {test}")
        text = f"The barrier ends {height:.2f} m above the ground; at least {metres} m is commonly reported "
        assert (f"{text}for TL-{test[0]} ({inches} in" in caution) is told
        assert ("AASHTO" in caution) is told
        assert ("32 in by NCHRP 350" in caution) is (told and inches == 36)


def test_no_least_height_where_none_is_known(car: Vehicle) -> None:
    small = car.scaled_to(900.0)
    assert "AASHTO" not in rated(small, Barrier.rigid_wall(height=0.6), "EN 1317 TB11", 20.0)
    assert "AASHTO" not in rated(car, Barrier.rigid_wall(), "MASH 6-10")  # without an end above


@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")
def test_roll_of_light_vehicles_at_sloped_faces_is_called_an_estimate(car: Vehicle) -> None:
    told = "do not choose a profile"
    truck = Vehicle.preset("mash_10000s", mesh_density=0.1)
    straight = Barrier.jersey(profile=((0.3, 0.0), (0.3, 1.0)))
    for profile in ("new_jersey", "f_shape", "single_slope"):
        assert told in rated(car, Barrier.jersey(profile=profile, height=0.81), "MASH 3-10")
    for vehicle, barrier in ((car, Barrier.rigid_wall()), (car, straight), (truck, Barrier.jersey())):
        assert told not in rated(vehicle, barrier, "MASH")


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ([Criterion("THIV", 35.2, "km/h", "33 km/h", False)], ["Within 15 % of the limit", "THIV"]),
        ([Criterion("THIV", 30.0, "km/h", "33 km/h", True)], ["Within 15 % of the limit", "THIV"]),
        ([Criterion("THIV", 24.0, "km/h", "33 km/h", True)], []),
        ([Criterion("THIV", 32.0, "km/h", "", None)], []),  # MASH reports it
        ([Criterion("ASI", 1.899, "", "A 1, B 1.4, C 1.9", True, "class C")], ["Within 15 %", "ASI"]),
        ([Criterion("H: OIV, lateral", 13.9, "m/s", "", False)], ["H: OIV, lateral"]),
        ([Criterion("I: ridedown, lateral", 26.0, "g", "", False)], ["171 %", "I: ridedown, lateral"]),
        ([Criterion("I: ridedown, lateral", 12.0, "g", "", True)], []),
    ],
)
def test_verdicts_within_the_error_of_occupant_risk_say_so(rows: list[Criterion], said: list[str]) -> None:
    """A New Jersey barrier failed EN 1317 TB11 by a THIV of 35 km/h without a word."""
    text = " ".join(doubt.sentence for doubt in risk_doubts(rows))
    assert bool(text) is bool(said)
    assert all(part in text for part in said)
    failed = [row for row in rows if row.passed is False]
    assert not fails_clearly(failed)  # all that fail here are within the error
    assert fails_clearly([*rows, Criterion("upright", "rolled over", "", "", False)])


@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning", "ignore::birm3d.LowBarrierWarning")
@pytest.mark.parametrize(
    ("level", "test", "like", "metres"), [("H2", "TB51", "TL-4", 0.91), ("H4b", "TB81", "TL-5", 1.07)]
)
def test_a_low_barrier_for_buses_and_trucks_is_told_by_analogy(
    level: str, test: str, like: str, metres: float
) -> None:
    """EN 1317 TB81 passed at 0.81 m without a word; it has no height of its own."""
    for height, told in ((metres, False), (metres - 0.1, True)):
        barrier = Barrier.jersey(profile="f_shape", height=height)
        (crash,) = birm3d.test_matrix(f"EN 1317 {test}", barrier=barrier, mesh_density=0.3)
        rating = birm3d.rate(crash.run(), f"EN 1317 {level}")
        assert rating.test == test
        assert (
            f"By analogy alone, taking {level} as MASH {like}, at least {metres} m" in rating.caution
        ) is told
