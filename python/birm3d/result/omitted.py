"""What a run did not compute because no result depends on it, and why: counts of the core in words."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from .. import _core
from .event import DECIDED
from .metrics import METRIC_UNITS

if TYPE_CHECKING:
    from ..barrier.barrier import Barrier
    from .analysis import RunAnalysis

__all__ = ["omitted_lines"]


def omitted_lines(result: RunAnalysis) -> list[str]:
    """Return what was left out, in groups: a line for each thing, how many of how many, and (why).

    Nodes, elements, steps and tyres are counted by the core in the steps that were accepted
    (:attr:`birm3d.Result.statistics`). A thing of which nothing was left out has no line.
    """
    groups = {
        "skin": [*_nodes(result), *_skin(result)],
        "rigid bodies": [*_body(result)],
        "barrier": [*_barrier(result)],
        "ground and tyres": [*_ground(result)],
        "output": [*_output(result)],
        "the run": [*_end(result)],
        "the model": ["a driver who steers, occupants (not part of it)"],
    }
    return [
        line for name, lines in groups.items() if lines for line in (name, *(f"  {each}" for each in lines))
    ]


def _of(count: int, total: int) -> str:
    return f"all {total:,}" if count == total else f"{count:,} of {total:,}"


def _never_met(result: RunAnalysis) -> str:
    """Return why a node of the skin met nothing."""
    scene = result.scene
    ground = scene.settings.ground and any(scene.vehicle.core.stands_on_wheels)
    met = [name for name, there in (("the barrier", scene.barrier), ("the ground", ground)) if there]
    return "never met by " + " or ".join(met) if met else "there is nothing to meet"


def _nodes(result: RunAnalysis) -> Iterator[str]:
    scene, statistics = result.scene, result.statistics
    treads = int((scene.vehicle.wheel_of_node >= 0).sum())
    skin = scene.vehicle.n_nodes - treads
    if scene.barrier is None:
        yield f"barrier contact of all {scene.vehicle.n_nodes:,} nodes (there is no barrier)"
    if statistics.skin_nodes < skin:
        yield f"{_of(skin - statistics.skin_nodes, skin)} nodes of the skin ({_never_met(result)})"
    if scene.barrier is not None and statistics.tread_nodes < treads:
        left = _of(treads - statistics.tread_nodes, treads)
        yield f"{left} nodes of tyres (never met by the barrier)"
    tests = (statistics.steps + statistics.rejected) * scene.vehicle.n_nodes
    if statistics.node_evaluations < tests:
        share = 1.0 - statistics.node_evaluations / tests
        yield f"{share:.1%} of {tests:,} node tests (their blocks were out of reach in that step)"
    peaks = [result.unit(u).peak_deflection for u in range(len(scene.vehicle.units))]
    idle, trusses = sum(int((peak <= 0.0).sum()) for peak in peaks), sum(len(peak) for peak in peaks)
    if idle:
        yield f"the crush of {_of(idle, trusses)} trusses (never pressed)"


def _body(result: RunAnalysis) -> Iterator[str]:
    statistics = result.statistics
    if statistics.body_steps < statistics.steps:
        left = _of(statistics.steps - statistics.body_steps, statistics.steps)
        yield f"their own contact in {left} steps (no truss was bottomed out)"
    if result.scene.vehicle.joint is None:
        yield "joints (the vehicle is one unit)"
    else:
        yield "contact of the two units with each other, but through their joint"


def _barrier(result: RunAnalysis) -> Iterator[str]:
    scene = result.scene
    barrier = scene.barrier
    if barrier is None:
        return
    elements = len(barrier.element_names)
    far = elements - result.statistics.near_elements
    if far:
        yield f"{_of(far, elements)} elements (never within reach of the vehicle)"
    loaded = len(result._history.elements)
    if loaded < elements:
        yield f"histories of {_of(elements - loaded, elements)} elements (never touched)"
    free = getattr(barrier, "free_standing", None)
    if barrier.core.yielding_posts:
        yield "buckling, tearing and springing back of its posts (their plastic moments are constant)"
    elif free is None:
        yield f"its motion (fixed: {elements:,} {'element' if elements == 1 else 'elements'})"
    else:
        through = "but through pins, " if free.joint == "pinned" else "(loose ends), "
        yield f"contact of its segments with each other {through}and their tipping"
        if free.ground_friction == 0.0:
            yield "friction of the segments on the ground (ground_friction is 0)"
    if barrier.friction == 0.0:
        yield "friction (its coefficient is 0)"
    if not (scene.vehicle.wheel_of_node >= 0).any():
        yield "tyres at the barrier (the vehicle has none that meet it)"
    elif scene.mu_tire_barrier == 0.0:
        yield "friction of tyres at the barrier (its coefficient is 0)"


def _skin(result: RunAnalysis) -> Iterator[str]:
    vehicle, barrier, statistics = result.scene.vehicle, result.scene.barrier, result.statistics
    if statistics.free_steps:
        yield (
            f"all its forces in {_of(statistics.free_steps, statistics.steps)} steps, "
            f"{statistics.free_time:.4g} s (no node within reach of anything)"
        )
    if barrier is not None:
        yield from _indentation(barrier, [unit.indentation_length for unit in vehicle.units])
    if all(unit.rate_sensitivity == 0.0 for unit in vehicle.units):
        yield "growth of forces with the rate of crush (rate_sensitivity is 0)"


def _indentation(barrier: Barrier, lengths: list[float]) -> Iterator[str]:
    if not barrier.draws_in_skin:
        yield f"indentation beside posts ({barrier.why_no_indentation})"
    elif 0.0 in lengths:
        units = "" if not any(lengths) else f" of {_of(lengths.count(0.0), len(lengths))} units"
        yield f"indentation beside posts{units} (indentation_length is 0)"


def _ground(result: RunAnalysis) -> Iterator[str]:
    scene, settings, statistics = result.scene, result.scene.settings, result.statistics
    vehicle = scene.vehicle
    wheels = len(vehicle.wheels)
    if settings.gravity == 0.0:
        yield "gravity (it is 0)"
    if not settings.ground:
        yield "the ground: ground=False"
        return
    if wheels == 0:
        yield "the ground: the vehicle has no wheels, nothing holds it up against gravity"
        return
    stands = vehicle.core.stands_on_wheels
    if not all(stands):
        left = _of(stands.count(False), len(stands))
        yield f"ground under the skin of {left} units (without wheels, or below the ground from the start)"
    elif settings.mu_body == 0.0:
        yield "friction of the body on the ground (mu_body is 0)"
    instants = wheels * statistics.steps
    if statistics.wheels_on_ground < instants:
        left = _of(instants - statistics.wheels_on_ground, instants)
        yield f"forces of tyres in {left} wheel steps (in the air)"
    if settings.mu_tire == 0.0:
        yield "friction of tyres on the ground (mu_tire is 0)"
    elif settings.braking == 0.0:
        yield "brakes (braking is 0: wheels roll)"


def _output(result: RunAnalysis) -> Iterator[str]:
    if result.frames is None:
        yield "places of the skin over time (no frames were asked for)"
    absent = [name for name in METRIC_UNITS if name not in result.metrics]
    if absent:
        names = ", ".join(absent)
        yield f"{_of(len(absent), len(METRIC_UNITS))} metrics (the run does not have them): {names}"


def _end(result: RunAnalysis) -> Iterator[str]:
    end = f"all that comes after {result.time[-1]:.4f} s"
    if result.end_reason in DECIDED:
        tail = _core.tail_duration
        yield f"{end} (the outcome was known {tail:g} s before: a tail in which filters settle)"
    elif result.end_reason == "duration":
        yield f"{end} (the duration asked for)"
    elif result.end_reason == "longest":
        yield f"{end} (no run without a duration is longer)"
