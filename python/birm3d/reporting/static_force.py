"""Words about the equivalent static force: what it is made from, and its band."""

from __future__ import annotations

from ..assessment.design_remarks import ASSUMED, greatest_of_periods
from ..assessment.design_table import DesignLoad
from ..assessment.element_design import ElementDesign

__all__ = ["band_of_design", "made_by"]


def made_by(loads: DesignLoad) -> str:
    """Return what stands behind the 50-ms moment of the governing element in a line.

    It says that this moment has no dynamic factor, names the equivalent static moment, and tells how that and
    the equivalent static force are made.
    """
    row = loads.governing
    moment = row.design["equivalent_static_moment"] / 1e3
    moments = f"a 50-ms mean without dynamic factor; equivalent static moment {moment:,.0f} kN m"
    if row.has_yielded:
        return (
            f"{moments}, from what the post resists; a stronger post or foundation than given asks for more"
        )
    period = f"{moments}, natural period {loads.natural_period:g} s{_assumed(loads)}"
    if not row.can_yield:
        return f"{period}, ductility {loads.ductility:g}"
    if not row.exceeds_yield:
        return f"{period}, elastic"
    return (
        f"{period}, elastic: its force is more than the {row.yield_force / 1e3:,.0f} kN that the post resists"
    )


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
