"""Studies: tables of many runs, and how accurate, how fast and how stable the program is."""

from __future__ import annotations

from .table import Study, Summary

__all__ = ["Study", "Summary"]
