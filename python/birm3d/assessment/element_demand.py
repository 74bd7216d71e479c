"""What the load history of one run asks of an element of a barrier."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from ..barrier.yielding import Weaker
from ..result.element_loads import ElementLoad, overturning, resultant_height
from ..signals.filters import cfc, moving_average
from .element_design import (
    WINDOW,
    ElementDesign,
    System,
    degrees_between,
    design_direction,
    lateral_level,
    peak_filter,
)
from .oscillator import resistance

__all__ = ["element_design", "static_force"]

Floats = npt.NDArray[np.float64]

_AT_ROW = 1e-6  # an instant that is so near to a row, in intervals, is the row's
_MOST_OF_ONE_PULSE = 2.0  # no single pulse has a greater dynamic load factor


def element_design(
    load: ElementLoad,
    normal: Floats,
    system: System,
    end: float = math.inf,
    weaker: Weaker | None = None,
    has_yielded: bool = False,
) -> ElementDesign:
    """Return what an element has to carry in one scene; ``normal`` is that into the barrier, system in SI.

    The impulse is that up to the ``end`` of the impact [s]. ``weaker``: what gives way of posts that yield;
    ``has_yielded``: whether this one does.
    """
    if not load.touched:
        return ElementDesign(load.index, load.name)
    direction = design_direction(load, normal)
    force = moving_average(load.force, WINDOW, load.interval)
    moment = moving_average(load.moment, WINDOW, load.interval)
    level = lateral_level(force, load, normal)
    row = int(np.argmax(level))
    filtered = (
        load.force if peak_filter(load.interval) == "unfiltered" else cfc(load.force, 60, load.interval)
    )
    # The first row is the mean over the second one's interval.
    rows = math.ceil(min(end / load.interval - _AT_ROW, len(load.force)))
    impulse = load.interval * load.force[1 : rows + 1].sum(axis=0)
    height = float(resultant_height(force, moment, load.line)[row])
    peak = float(lateral_level(filtered, load, normal).max())
    most = math.inf if weaker is None else weaker.greatest_load(height)
    most_moment = float(overturning(moment, load.line).max())
    if has_yielded:
        static = min(most, _MOST_OF_ONE_PULSE * peak)
        static_moment = static * height if height > 0.0 else most_moment
    else:
        static = static_force(load, direction, system, yields=weaker is not None)
        static_moment = _static_moment(load, direction, system, yields=weaker is not None)
    return ElementDesign(
        load.index,
        load.name,
        impulse=float(impulse @ normal),
        impulse_vector=impulse,
        peak_force=peak,
        force_50ms=float(level[row]),
        longitudinal_force_50ms=float(np.abs(force @ _left_of(normal)).max()),
        height=height,
        direction=degrees_between(normal, direction),
        moment=most_moment,
        equivalent_static_force=static,
        equivalent_static_moment=static_moment,
        yield_force=most,
        has_yielded=has_yielded,
        touched=True,
    )


def static_force(load: ElementLoad, direction: Floats, system: System, *, yields: bool) -> float:
    """Return the equivalent static force of an element that has not yielded [N].

    A post that could yield (``yields``) counts as elastic.
    """
    return _response(load.force[1:] @ direction, load.interval, system, yields=yields)


def _static_moment(load: ElementLoad, direction: Floats, system: System, *, yields: bool) -> float:
    """Return the equivalent static moment of an element that has not yielded, about its foot [N m].

    It is that of the moments with which forces along the direction turn the element.
    """
    return _response(load.moment[1:] @ _left_of(direction), load.interval, system, yields=yields)


def _response(history: Floats, interval: float, system: System, *, yields: bool) -> float:
    ductility = 1.0 if yields else system.ductility
    return resistance(history, interval, system.natural_period, ductility, system.damping)


def _left_of(direction: Floats) -> Floats:
    """Return the horizontal unit vector to the left of another, shape (3,).

    About it a force in that direction turns an element.
    """
    return np.array([-direction[1], direction[0], 0.0])
