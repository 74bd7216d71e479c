"""What a caller guesses wrong is answered with what was meant."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import birm3d
import pytest
from birm3d import Barrier, Simulation, Vehicle, rate, scenes

POSTS = Barrier.bollards()
CAR = Vehicle.preset("passenger_car", mesh_density=0.05)
SIMULATION: Any = Simulation(scenes.elastic_block(6), Barrier.rigid_wall(), 5.0)
NAME: Any = "pickup"
simulate: Any = Simulation
bollards: Any = Barrier.bollards


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: simulate(CAR, POSTS, speed=10.0), "got 'speed', did you mean 'impact_speed'?"),
        (lambda: simulate(CAR, POSTS, 10.0, angle=60.0), "got 'angle', did you mean 'impact_angle'?"),
        (lambda: simulate(CAR, POSTS, 10.0, offset=0.2), "got 'offset', did you mean 'impact_offset'?"),
        (
            lambda: bollards(gap=0.9),
            "got 'gap', did you mean 'spacing' (from axis to axis: the clear gap plus the diameter)?",
        ),
        (lambda: bollards(radius=0.1), "got 'radius', did you mean 'diameter' (twice the radius)?"),
        (lambda: bollards(colour="red"), "bollards() must be given arguments among count, diameter, height"),
    ],
)
def test_a_guessed_argument(call: Callable[[], object], message: str) -> None:
    with pytest.raises(TypeError) as caught:
        call()
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rate(SIMULATION, "MASH"), "got Simulation; its run() returns one"),
        (lambda: birm3d.occupant_risk(SIMULATION), "got Simulation; its run() returns one"),
        (
            lambda: rate(SIMULATION, "MASH"),
            "result must be a birm3d.Result, a birm3d.Study, a birm3d.Prediction, a list of birm3d.Result or "
            "a list of birm3d.Study or birm3d.Prediction, got",
        ),
        (
            lambda: Simulation(NAME, POSTS, 10.0),
            "vehicle must be a birm3d.Vehicle, got 'pickup'; Vehicle.preset('pickup') returns one",
        ),
        (
            lambda: Simulation(CAR, NAME, 10.0),
            "got 'pickup'; Barrier.bollards() and others like it return one",
        ),
    ],
)
def test_an_argument_of_another_kind(call: Callable[[], object], message: str) -> None:
    with pytest.raises(TypeError) as caught:
        call()
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("guess", "meant"),
    [("TL-4", "MASH TL-4"), ("tl4", "MASH TL-4"), ("N2", "EN 1317 N2"), ("mash 3-11", "MASH 3-11")],
)
def test_a_level_without_its_standard(guess: str, meant: str) -> None:
    with pytest.raises(ValueError, match=rf"got '{guess}', did you mean '{meant}'\?"):
        birm3d.test_matrix(guess)


def test_a_level_of_a_security_barrier_without_its_standard() -> None:
    with pytest.raises(ValueError, match=r"named beside the standard in a matrix \('ASTM F2656 M50'\)"):
        birm3d.test_matrix("M50")
