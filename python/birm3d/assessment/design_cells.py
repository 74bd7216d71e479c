"""Cells of a table of design loads: numbers as they are printed, the safe one first."""

from __future__ import annotations

from ..base.shown_numbers import kilo_number
from .criteria import without_sign_of_zero
from .element_design import DESIGNED, ElementDesign

__all__ = ["is_loaded", "load_cell", "load_text", "side_cell"]

_SHOWN = 0.005  # kN, kN s, kN m: less is shown as 0
_FORMS = {"height": "{:.2f}", "dynamic_load_factor": "{:.2f}", "direction": "{:.0f}"}


def is_loaded(row: ElementDesign) -> bool:
    """Return whether an element carries as much as the table shows, in this vehicle's run."""
    return row.force_50ms >= 1e3 * _SHOWN


def load_text(name: str, value: float) -> str:
    """Return a value as the table prints it, in kN, kN m, kN s, m or deg, by its name."""
    if name in _FORMS:
        return without_sign_of_zero(_FORMS[name].format(value))
    return "0" if abs(value) < 1e3 * _SHOWN else kilo_number(value)


def load_cell(row: ElementDesign, name: str) -> str:
    """Return a load or its height: the design value; in brackets this vehicle's, and the band if any."""
    assert name in DESIGNED
    if name == "height" and row.design[name] == 0.0:
        return "–"
    text = load_text(name, row.design[name])
    if name not in row.band:
        return text
    cell = f"{text} [{load_text(name, getattr(row, name))}; {_band(row, name)}]"
    return "0" if cell == "0 [0; 0 to 0]" else cell


def side_cell(row: ElementDesign, name: str) -> str:
    """Return a value of which neither a greater nor a lesser one asks for more; in brackets its band."""
    text = load_text(name, getattr(row, name))
    if name not in row.band:
        return text
    band = _band(row, name)
    return text if band == f"{text} to {text}" else f"{text} [{band}]"  # of walls the direction is the normal


def _band(row: ElementDesign, name: str) -> str:
    return " to ".join(load_text(name, end) for end in row.band[name])
