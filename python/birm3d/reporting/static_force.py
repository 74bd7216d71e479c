"""Words about the equivalent static force: what it is made from, and its band."""

from __future__ import annotations

import math

from ..assessment.design_remarks import ASSUMED, greatest_of_periods
from ..assessment.design_table import DesignLoad
from ..assessment.element_design import ElementDesign

__all__ = ["band_of_design", "made_by"]


def made_by(loads: DesignLoad) -> str:
    """Return the moment of the equivalent static force of the governing element, and what both are made from.

    It follows the 50-ms moment in a line, and says that this has no dynamic factor.
    """
    row = loads.governing
    moment = row.design["equivalent_static_moment"] / 1e3
    moments = f"a 50-ms mean without dynamic factor; equivalent static moment {moment:,.0f} kN m"
    if row.has_yielded:
        return f"{moments}, from the moment that the post resists; what is stronger than given asks for more"
    period = f"{moments}, natural period {loads.natural_period:g} s{_assumed(loads)}"
    if not math.isfinite(row.yield_force):
        return f"{period}, ductility {loads.ductility:g}"
    if not row.exceeds_yield:
        return f"{period}, elastic"
    return f"{period}, elastic: more than the {row.yield_force / 1e3:,.0f} kN that the post resists"


def _assumed(loads: DesignLoad) -> str:
    """Return that the period is assumed, and what another one may ask for."""
    if ASSUMED not in loads.caution:
        return ""
    found = greatest_of_periods(loads)
    own = loads.governing.equivalent_static_force
    more = "" if found is None else f"; up to {found[0] / own:.2f} times as much at {found[1]:.2g} s"
    return f" (assumed{more})"


def band_of_design(row: ElementDesign) -> str:
    """Return this vehicle's force and the band over the class, as the end of a line; "" without a band."""
    if "equivalent_static_force" not in row.band:
        return ""
    own, *ends = (row.equivalent_static_force, *row.band["equivalent_static_force"])
    low, high = (f"{end / 1e3:,.0f}" for end in ends)
    return f"; this vehicle {own / 1e3:,.0f} kN, 80 % of the class {low} to {high} kN"
